#include "loop/shots/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loop/deviation.hpp"
#include "loop/rules.hpp"
#include "loop/shots/attenuation.hpp"
#include "loop/shots/between.hpp"
#include "loop/shots/experiment.hpp"
#include "loop/shots/mechanism.hpp"
#include "loop/shots/mixture.hpp"
#include "loop/shots/remainder.hpp"
#include "loop/shots/scatter.hpp"
#include "loop/shots/slips.hpp"
#include "models/reduced/face_strike.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kMostToSelect = 450;  // what names an effect does not need thousands, whose cost would be felt
constexpr double kMixture = 20;             // least gain of two populations over one

/// Whether a row's reading is compared: a side hangs on the direction of the launch, from which the ball is followed.
bool judged(const Shots& shots, const Column& c, std::size_t row) {
  return std::isfinite(c.value[row]) && (output_of(c.stem) != Output::side || recorded(shots, row, Output::azimuth));
}

}  // namespace

ShotProblem::ShotProblem(const ShotCase& c, const std::vector<DerivedColumn>& derived,
                         std::optional<std::set<int>> held_rows, std::optional<Input> doubted)
    : case_(c), held_rows_(std::move(held_rows)) {
  read(derived, doubted);
  split({});
  estimate_noise(nullptr);
  set_covariance(Model{}, nullptr);
  regressors_ = regressors(case_.shots, inputs_.row_of, select_, *model_);
}

void ShotProblem::read(const std::vector<DerivedColumn>& derived, std::optional<Input> doubted) {
  const Shots& shots = case_.shots;
  inputs_ = make_inputs(shots, case_.blow, case_.head_mass_declared, case_.input_noise, case_.loft_unknown);
  notes_ = case_.notes;
  notes_.insert(notes_.end(), inputs_.notes.begin(), inputs_.notes.end());
  for (const Known& k : case_.known)
    notes_.push_back(fmt::format("{}: {} is zero within {:g} ({})", k.effect, k.parameter, k.sd, k.source));
  if (doubted) distrust(*doubted);

  // Cells that are no numbers, and values no blow has: flagged before anything is fitted.
  std::set<int> bad;
  const auto flag = [&](int row, const std::string& column, const std::string& reason, int shot) {
    early_.push_back({.shot = shot, .row = row, .column = column, .reason = reason, .slip = false});
  };
  for (const Column& c : shots.columns)
    for (const std::size_t row : c.broken)
      if (bad.insert(int(row)).second) flag(int(row), c.name, "not a finite number", -1);
  for (const auto& [row, column, reason] : inputs_.impossible)
    if (bad.insert(row).second) flag(row, column, reason, -1);

  std::vector<ShotChannel> channels;
  std::vector<const Column*> columns;  // of each channel
  std::optional<SeenLaunch> seen;
  const Column* seen_in = nullptr;
  bool any = false;
  for (int o = 0; o < kOutputs; ++o) {
    const Column* c = shots.find_stem(stem(Output(o)));
    if (!c || c->role != Role::output) continue;
    any = true;
    const bool computed = std::ranges::any_of(
        derived, [&](const DerivedColumn& d) { return !d.input && d.share == 1 && d.column == c->name; });
    const bool used_up = case_.loft_unknown && Output(o) == Output::launch_angle;
    if ((computed && !used_up) || std::ranges::none_of(c->value, [](double x) { return std::isfinite(x); })) continue;
    int rows = 0, read = 0, unaimed = 0;
    for (const int row : inputs_.row_of)
      if (!bad.contains(row) && !(held_rows_ && held_rows_->contains(row))) {
        ++rows;
        if (!std::isfinite(c->value[row])) continue;
        if (judged(shots, *c, std::size_t(row))) ++read;
        else ++unaimed;
      }
    if (unaimed > 0)
      notes_.push_back(fmt::format("{}: {} {} no azimuth from which the ball is followed: not judged there", c->name,
                                   unaimed, unaimed == 1 ? "row has" : "rows have"));
    if (unaimed > 0 && read == 0) continue;
    if (!case_.noise.contains(c->name) && !case_.averages && read < kFewestOfRows && read < rows) {
      notes_.push_back(fmt::format("{}: its noise is not declared, and {} readings in {} rows do not tell it: not used",
                                   c->name, read, rows));
      continue;
    }
    ShotChannel ch{{.name = c->name, .si = c->si, .resolution = c->resolution / c->si}, Output(o)};
    if (const auto it = case_.noise.find(c->name); it != case_.noise.end())
      // The record's last digit rounds: that much is added to the noise.
      ch.declared = ch.noise = std::hypot(it->second, rounding_deviation(ch.resolution));
    if (used_up) {
      seen = SeenLaunch{std::move(ch), {}};
      seen_in = c;
      continue;
    }
    channels.push_back(std::move(ch));
    columns.push_back(c);
  }
  if (!any)
    throw DataError(fmt::format("{}:1: no measured launch quantity (ball_speed_*, launch_angle_*, ...)", shots.file));

  Inputs good;
  for (std::size_t i = 0; i < inputs_.trials.size(); ++i) {
    if (bad.contains(inputs_.row_of[i]) || channels.empty()) continue;
    good.trials.push_back(std::move(inputs_.trials[i]));
    good.row_of.push_back(inputs_.row_of[i]);
    if (!inputs_.covariance.empty()) good.covariance.push_back(inputs_.covariance[i]);
  }
  inputs_.row_of = std::move(good.row_of);
  inputs_.covariance = std::move(good.covariance);
  Eigen::MatrixXd measured(std::ptrdiff_t(good.trials.size()), std::ptrdiff_t(channels.size()));
  for (Eigen::Index i = 0; i < measured.rows(); ++i) {
    const std::size_t row = std::size_t(inputs_.row_of[i]);
    if (case_.flight) good.trials[i].seen = seen_launch(shots, row);
    for (Eigen::Index k = 0; k < measured.cols(); ++k)
      measured(i, k) = judged(shots, *columns[k], row) ? columns[k]->native(row) : kNaN;
  }
  if (seen) {
    seen->value.resize(measured.rows());
    for (Eigen::Index i = 0; i < measured.rows(); ++i) seen->value[i] = seen_in->native(std::size_t(inputs_.row_of[i]));
    notes_.push_back(
        fmt::format("the loft of every shot is found from its {}; the recorded one is not used", seen_in->name));
  }
  for (int k = 0; k < kInputs; ++k)
    if (const Column* c = shots.find_stem(stem(Input(k))); c && !(seen && Input(k) == Input::dynamic_loft))
      uses_.push_back({c, k, -1});
  for (std::size_t k = 0; k < columns.size(); ++k) uses_.push_back({columns[k], -1, int(k)});
  model_ = std::make_unique<ShotModel>(*case_.model, case_.direct, std::move(good.trials), std::move(channels),
                                       std::move(measured), case_.surrogate, std::move(seen), case_.flight);
  if (case_.averages) {
    std::vector<int> count;
    for (const int row : inputs_.row_of) count.push_back(case_.averages->count[row]);
    model_->set_scatter(case_.averages->scatter, case_.averages->degrees, std::move(count));
    notes_.insert(notes_.end(), case_.averages->notes.begin(), case_.averages->notes.end());
  }
  const std::vector<Parametrisation> all = case_.varying.empty() ? std::vector<Parametrisation>{} : forms();
  for (const Known& k : case_.varying) vary(all, k);
  std::vector<double> out(static_cast<std::size_t>(width()));
  for (int i = 0; i < model_->shots(); ++i) {
    if (model_->predict(i, Model{}, nullptr, out.data())) usable_.push_back(i);
    else flag(inputs_.row_of[i], "", "the base model has no answer: the head moves away from the ball", i);
  }
}

/// The form with the fewest other parameters stands for it.
void ShotProblem::vary(const std::vector<Parametrisation>& all, const Known& k) {
  const Parametrisation* least = nullptr;
  std::size_t place = 0;
  for (const Parametrisation& f : all) {
    const auto it = std::ranges::find(f.parameters, k.parameter, &Parameter::name);
    if (f.effect != k.effect || it == f.parameters.end()) continue;
    if (least && least->parameters.size() <= f.parameters.size()) continue;
    least = &f;
    place = std::size_t(it - f.parameters.begin());
  }
  if (!least) throw DataError(fmt::format("effect '{}' with a parameter '{}' cannot act here", k.effect, k.parameter));
  model_->vary(*least, place, k.sd * least->parameters[place].si);
  const std::string row = case_.averages ? case_.averages->by : "row";
  notes_.push_back(fmt::format("{}: {} differs from {} to {} by {:g} {} ({})", k.effect, k.parameter, row, row, k.sd,
                               least->parameters[place].unit, k.source));
}

/// Every shot's value of this input may be anything: its direction is projected out of the shot's channels.
void ShotProblem::distrust(Input input) {
  if (inputs_.covariance.empty())
    inputs_.covariance.assign(inputs_.trials.size(), Eigen::MatrixXd::Zero(kInputs, kInputs));
  const auto [lo, hi] = range_of(inputs_.trials, [&](const Shot& t) { return get(t.blow, input); });
  for (Eigen::MatrixXd& cov : inputs_.covariance)
    cov(int(input), int(input)) += std::pow(10 * std::max(hi - lo, 1e-3), 2);
}

std::vector<Parametrisation> ShotProblem::forms() const {
  Setting setting{.head_turns = case_.head_turns,
                  .inertia_declared = case_.inertia_declared,
                  .hosel_declared = case_.hosel_declared,
                  .outputs = {},
                  .deformable = case_.deformable,
                  .shaft = case_.shaft_declared,
                  .full_club = case_.full_club,
                  .face = models::usual_face(case_.blow.club.head)};
  for (int c = 0; c < width(); ++c) {
    if (of_flight(model_->channel(c).output)) setting.flies = true;
    else setting.outputs.push_back(model_->channel(c).output);
  }
  std::vector<Parametrisation> all;
  for (const EffectEntry& e : effects_with(case_.own)) {
    if (e.name == "session-drift" && sorted_by(as_read(case_))) continue;
    for (Parametrisation& f : e.forms(setting)) {
      // Rows without a shot number may stand in any order: that it is the session's is an assumption more. Likewise
      // where one club was hit after the other: what differs between clubs then follows the order too.
      if (f.effect == "session-drift" && (!case_.shots.has_shot_column || one_club_after_another(as_read(case_))))
        f.complexity += 10;
      for (const Known& k : case_.known)
        for (Parameter& p : f.parameters)
          if (k.effect == f.effect && k.parameter == p.name) p.known = k.sd * p.si;
      all.push_back(std::move(f));
    }
  }
  return all;
}

void ShotProblem::split(const std::set<int>& without) {
  Rows all;
  if (held_rows_) {
    for (const int i : usable_) (held_rows_->contains(inputs_.row_of[i]) ? all.holdout : all.train).push_back(i);
  } else {
    // The split is made over all usable rows, so that screening does not reshuffle it.
    all = split_rows(case_, *model_, inputs_.row_of, usable_);
  }
  const auto flagged = [&](int i) { return without.contains(i); };
  std::erase_if(all.train, flagged);
  std::erase_if(all.holdout, flagged);
  rows_ = std::move(all);
  select_ = evenly(rows_.train, kMostToSelect);
}

std::vector<Problem::Row> ShotProblem::rows() const {
  std::vector<Row> all;
  for (const bool holdout : {false, true})
    for (const int i : holdout ? rows_.holdout : rows_.train) {
      const int row = inputs_.row_of[i];
      all.push_back({i, row, case_.shots.id[row], holdout});
    }
  std::ranges::sort(all, {}, &Row::index);
  return all;
}

/// Findings numbered 1, 2, ... in order of rows.
std::vector<Flag> ShotProblem::flags() const {
  std::vector<Flag> told;
  int own = 0;
  const std::vector<RowFlag>& all = flags_.empty() ? early_ : flags_;
  for (const RowFlag& f : all) own = std::max(own, f.finding);
  for (const RowFlag& f : all)
    told.push_back(
        {f.row, case_.shots.line[f.row], case_.shots.id[f.row], f.column, f.reason, f.finding ? f.finding : ++own});
  std::ranges::stable_sort(told, {}, &Flag::row);
  std::map<int, int> number;
  for (Flag& f : told) f.finding = number.emplace(f.finding, int(number.size()) + 1).first->second;
  return told;
}

std::vector<std::string> ShotProblem::notes() const {
  std::vector<std::string> all = notes_;
  if (const Column* by = sorted_by(as_read(case_)))
    all.push_back(fmt::format(
        "rows stand sorted by {}: the order of the session is not known, and no session-drift is sought", by->name));
  if (select_.size() < rows_.train.size())
    all.push_back(fmt::format("effects selected on {} of {} training rows, then fitted to all", select_.size(),
                              rows_.train.size()));
  return all;
}

std::optional<std::string> ShotProblem::too_few() const {
  if (width() == 0) return "no launch quantity can be used: it has no value, too few, or is computed from others";
  if (model_->shots() == 0) return "no row can be used";
  if (rows_.train.size() < kFewestToTest)
    return fmt::format("{} training rows: too few to test anything", rows_.train.size());
  return {};
}

Problem::Density ShotProblem::density(Part part) const {
  Density d;
  for (const int i : shots(part)) {
    const auto W = model_->whitening(i);
    for (int c = 0; c < width(); ++c)
      if (model_->observed(i, c) && W(c, c) > 0) {
        d.log_whitening += std::log(W(c, c));
        ++d.values;
      }
  }
  return d;
}

/// Both halves by every input that varies; the session in quarters, where a ramp, a jump and a swing part.
std::vector<std::vector<bool>> ShotProblem::subsets() const {
  const std::vector<int>& rows = rows_.train;
  std::vector<std::vector<bool>> all;
  const auto divide = [&](const auto& value, int pieces) {
    std::vector<double> x, sorted;
    for (const int i : rows) x.push_back(value(model_->trial(i)));
    sorted = x;
    std::ranges::sort(sorted);
    for (int k = 0; k < pieces; ++k) {
      const std::size_t from = sorted.size() * std::size_t(k) / std::size_t(pieces),
                        to = sorted.size() * std::size_t(k + 1) / std::size_t(pieces);
      std::vector<bool> in;
      for (const double v : x) in.push_back((k == 0 || v >= sorted[from]) && (k == pieces - 1 || v < sorted[to]));
      // Where many values are the same there may be no such piece.
      if (2 * std::size_t(pieces) * std::size_t(std::ranges::count(in, true)) >= rows.size())
        all.push_back(std::move(in));
    }
  };
  for (int k = 0; k < kInputs; ++k) {
    const auto input = [&](const Shot& s) { return get(s.blow, Input(k)); };
    const auto [low, high] = std::ranges::minmax(rows, {}, [&](int i) { return input(model_->trial(i)); });
    if (input(model_->trial(high)) > input(model_->trial(low))) divide(input, 2);
  }
  divide([](const Shot& s) { return s.order; }, 4);
  return all;
}

bool ShotProblem::screen(const Selection& selection) {
  const auto look = [&](const Fit& at, bool clean) {
    return loop::screen(*model_, case_.shots, inputs_.row_of, uses_, at, clean, early_);
  };
  Screening screening = look(selection.chosen, selection.clean);
  // A drift can follow a club that recorded something else: what leaves structure must not hide such a club.
  if (!selection.clean && selection.level > 0 && std::ranges::none_of(screening.flags, &RowFlag::cluster)) {
    Screening bare = look(selection.base, false);
    if (std::ranges::any_of(bare.flags, &RowFlag::cluster)) screening = std::move(bare);
  }
  flags_ = std::move(screening.flags);
  if (!selection.clean) put_back_together();
  if (held_rows_) std::erase_if(flags_, [&](const RowFlag& f) { return f.shot >= 0 && held_rows_->contains(f.row); });
  widespread_ = std::move(screening.widespread);
  many_ = screening.many;
  std::set<int> now;
  for (const RowFlag& f : flags_)
    if (f.shot >= 0) now.insert(f.shot);
  std::vector<int> changed;
  std::ranges::set_symmetric_difference(now, out_, std::back_inserter(changed));
  out_ = std::move(now);
  split(out_);
  return changed.size() * 500 <= std::size_t(model_->shots());
}

Scatter ShotProblem::scatter(int channel, const Eigen::MatrixXd& residuals, int fitted) const {
  return loop::scatter(*model_, rows_.train, channel, residuals, fitted);
}

double ShotProblem::update_noise(const Fit& selected, const Fit&) {
  const Eigen::ArrayXd before = noise();
  estimate_noise(&selected);
  set_covariance(selected.model, selected.p.data());
  regressors_ = regressors(case_.shots, inputs_.row_of, select_, *model_);
  // Noisy inputs and launches weigh otherwise once they are carried through the effects.
  const bool anew = !updated_ && (!inputs_.covariance.empty() || case_.flight) && !selected.model.forms.empty();
  updated_ = updated_ || anew;
  return anew ? kInfinity : (noise() / before - 1).abs().maxCoeff();
}

/// Of means the noise is what their rows' scatter does about a model.
void ShotProblem::set_covariance(const Model& model, const double* parameters) {
  model_->set_covariance(inputs_.covariance, model, parameters);
  if (!case_.averages) return;
  for (int c = 0; c < width(); ++c) {
    ShotChannel& ch = model_->channel(c);
    double variance = 0;
    for (const int i : rows_.train) variance += model_->sigma(i, c) * model_->sigma(i, c) / double(rows_.train.size());
    ch.declared = ch.noise = std::sqrt(variance);
    ch.repeated = true;
  }
}

/// Noise that is not declared (or refuted), from the residuals of a fit.
void ShotProblem::estimate_noise(const Fit* at) {
  if (case_.averages) return;
  const Eigen::MatrixXd r = at ? residuals(at->model, at->p) : model_->residuals(Model{}, nullptr);
  const double rows = std::max<double>(1, double(rows_.train.size()));
  for (int c = 0; c < width(); ++c) {
    ShotChannel& ch = model_->channel(c);
    if (ch.trusted()) continue;
    const double smooth = smooth_scatter(*model_, rows_.train, c, r);
    double sd = smooth, from_inputs = 0;
    if (at) {
      double variance = 0;
      for (const int i : rows_.train) variance += model_->sigma(i, c) * model_->sigma(i, c);
      const double whole = scatter(c, r, at->size()).ratio * std::sqrt(variance / rows);
      sd = ch.refuted || smooth <= 0 ? whole : std::min(whole, 1.3 * smooth);
      // What noisy inputs and launches contribute is counted separately.
      if (!inputs_.covariance.empty() || case_.flight)
        for (const int i : rows_.train)
          from_inputs += std::max(0.0, model_->sigma(i, c) * model_->sigma(i, c) - ch.noise * ch.noise) / rows;
    }
    const double floor = std::max(ch.least_noise(), kNothing * sd);
    ch.noise = std::max(std::sqrt(std::max(sd * sd - from_inputs, 0.09 * sd * sd)), floor);
  }
}

StructureMap ShotProblem::structure(const Fit& fit, const Fit& near, const Eigen::MatrixXd& directions,
                                    const Rules& rules) const {
  Whitened view{.rows = select_, .order = {}, .column = {}};
  for (const int i : select_) view.order.push_back(model_->trial(i).order);
  view.column = [&](int c, const Eigen::VectorXd& value) {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(value.size() * width());
    for (Eigen::Index i = 0; i < value.size(); ++i)
      if (const int shot = select_[i]; model_->observed(shot, c))
        a.segment(i * width(), width()) = model_->whitening(shot).col(c) * value[i];
    return a;
  };
  return loop::structure(*this, view, fit, near, regressors_, directions, rules);
}

/// Whole clusters are held out: whole clusters foretell each other.
std::optional<Remainder> ShotProblem::remainder(const Fit& fit) const {
  std::vector<int> group(static_cast<std::size_t>(model_->shots()));
  const Column* by = case_.split.by.empty() ? nullptr : case_.shots.find(case_.split.by);
  const Groups clusters = by ? groups(*by) : Groups{};
  for (int i = 0; i < model_->shots(); ++i) group[i] = by ? clusters.of_row[inputs_.row_of[i]] : i;
  return loop::remainder(*model_, case_.shots, inputs_.row_of, rows_.train, group, fit);
}

/// A base that answers slowly, means of clubs, lofts that are found and effects that the case declares have no such
/// look.
std::vector<Mechanism> ShotProblem::mechanisms(const Selection& s, const Rules& rules) const {
  if (!case_.direct || case_.averages || case_.loft_unknown || s.base.size() > 0) return {};
  // Where nothing is chosen, nothing was fitted: what was held out may ask as well.
  std::vector<int> rows = s.level == 0 ? rows_.all() : select_;
  std::ranges::sort(rows);
  std::set<std::string> noisy;
  for (const auto& [column, sd] : case_.input_noise)
    if (sd > 0) noisy.insert(column);
  return loop::mechanisms(*model_, case_.shots, inputs_.row_of, rows, in_session(), noisy, s.base, s.chosen, rules);
}

std::vector<Attenuation> ShotProblem::attenuations(const Fit& fit) const {
  return loop::attenuations(*model_, case_.shots, select_, fit, covariance(*this, Part::select, fit));
}

std::optional<Clustered> ShotProblem::clustered(const Fit& base, const Fit& fit) const {
  if (case_.averages) return {};
  return loop::clustered(*model_, case_.shots, inputs_.row_of, select_, case_.split.by, base, fit);
}

/// Neither means of clubs nor a base that answers slowly.
std::vector<GroupSpread> ShotProblem::between_groups(const Fit& fit) const {
  if (!case_.direct || case_.averages) return {};
  return loop::between_groups(*model_, case_.shots, inputs_.row_of, rows_.all(), case_.split.by, in_session(), fit);
}

/// Whether a shot's place in the order says when it was struck.
bool ShotProblem::in_session() const {
  const Shots& shots = as_read(case_);
  return case_.shots.has_shot_column && !sorted_by(shots) && !one_club_after_another(shots);
}

std::vector<Location> ShotProblem::places(const Selection& s) const {
  std::vector<Location> told = plainest_places(*this, s);
  if (const auto two = two_populations(s)) told.push_back(*two);
  return told;
}

namespace {

/// Two populations of which the second has this effect beside the base, searched from sizes of either sign that part
/// the shots visibly. `of_base`: the base's standardised residuals, `seen`: those of any model.
std::vector<Mixture> parted_by(const Parametrisation& f, const Fit& base, const Eigen::MatrixXd& of_base,
                               const std::function<Eigen::MatrixXd(const Model&, const Eigen::VectorXd&)>& seen,
                               double one) {
  constexpr double visible = 6;  // standard deviations
  const Model with = base.model.with(&f);
  const auto n = Eigen::Index(f.parameters.size());
  Eigen::VectorXd low(n), high(n), scale(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Parameter& q = f.parameters[k];
    scale[k] = q.scale;
    low[k] = q.min / q.scale;
    high[k] = q.max / q.scale;
  }
  const Residuals second = [&](const Eigen::VectorXd& size, Eigen::MatrixXd& z) {
    Eigen::VectorXd p(base.p.size() + n);
    p << base.p, size.cwiseProduct(scale);
    z = seen(with, p);
    return z.allFinite();
  };
  std::vector<Mixture> found;
  for (Eigen::Index k = 0; k < n; ++k)
    for (const double end : {low[k], high[k]}) {
      if (end == 0) continue;
      Eigen::VectorXd size = Eigen::VectorXd::Zero(n);
      Eigen::MatrixXd z;
      size[k] = std::copysign(std::min(1.0, std::abs(end)), end);
      if (!second(size, z)) continue;
      const double apart = std::sqrt((z - of_base).squaredNorm() / double(z.rows()));
      if (!(apart > 0)) continue;
      size[k] = std::clamp(size[k] * visible / apart, low[k], high[k]);
      if (auto two = mixture(of_base, second, size, low, high, one)) found.push_back(std::move(*two));
    }
  return found;
}

}  // namespace

/// Two populations in the residuals of the chosen model or of the base, on all shots that could be used: nothing is
/// fitted to them here. A regressor that is known and explains as much is the plainer reason.
std::optional<Location> ShotProblem::two_populations(const Selection& s) const {
  bool declared = true, refuted = false;
  for (int c = 0; c < width(); ++c) {
    declared = declared && channel(c).declared.has_value();
    refuted = refuted || channel(c).refuted;
  }
  const auto as_declared = [&](const Mixture& m) { return declared && m.deviation > 0.7 && m.deviation < 1.4; };
  std::set<int> slipped;
  for (const RowFlag& f : flags_)
    if (f.slip) slipped.insert(f.shot);
  std::vector<int> rows;
  for (const int i : usable_)
    if (!slipped.contains(i)) rows.push_back(i);
  rows = evenly(rows, kMostToSelect);
  ShotModel model = *model_;
  if (refuted) {  // what was declared is what either population should show
    for (int c = 0; c < width(); ++c)
      if (channel(c).refuted) model.channel(c).noise = *channel(c).declared;
    model.set_covariance(inputs_.covariance, s.chosen.model, s.chosen.p.data());
  }
  // What was not read is of no population.
  const auto seen = [&](const std::vector<int>& of, const Model& with, const Eigen::VectorXd& p) -> Eigen::MatrixXd {
    Eigen::MatrixXd z = model.whitened(of, with, p).reshaped<Eigen::RowMajor>(std::ptrdiff_t(of.size()), width());
    for (Eigen::Index i = 0; i < z.rows(); ++i)
      for (int c = 0; c < width(); ++c)
        if (!model.observed(of[std::size_t(i)], c)) z(i, c) = kNaN;
    return z;
  };
  std::optional<Mixture> best;
  std::string by;                         // the effect that parts them, where it is one
  const std::vector<int>* among = &rows;  // its rows count in these
  const Eigen::MatrixXd chosen = seen(rows, s.chosen.model, s.chosen.p), base = seen(rows, s.base.model, s.base.p);
  // The chosen one is wrong, or fits with more noise than there is: it may have drawn the two together.
  const bool doubtful = !s.clean || refuted;
  for (const Eigen::MatrixXd* z : {&chosen, &base}) {
    if (z == &base && !doubtful) continue;
    auto two = mixture(*z);
    if (!two || (best && two->gain < best->gain)) continue;
    if (z == &base && s.clean && !as_declared(*two)) continue;
    best = std::move(two);
  }
  if (best && best->gain < (as_declared(*best) ? case_.rules.gain / 2 : kMixture)) best.reset();
  // The same, where the second population has an effect that does not move every shot alike.
  std::vector<int> complete;
  for (const int i : rows)
    if (model.observed(i) == width()) complete.push_back(i);
  if (!best && !complete.empty() && (doubtful || (s.level > 0 && !declared))) {
    const auto of_complete = [&](const Model& with, const Eigen::VectorXd& p) { return seen(complete, with, p); };
    const Eigen::MatrixXd first = of_complete(s.base.model, s.base.p);
    const double one = std::max(one_population(of_complete(s.chosen.model, s.chosen.p)), one_population(first));
    for (const Parametrisation& f : forms()) {
      if (f.threshold || f.effect == "session-drift") continue;
      for (const Mixture& two : parted_by(f, s.base, first, of_complete, one))
        if (two.gain > kMixture && (!best || two.gain > best->gain) && (!declared || as_declared(two))) {
          best = two;
          by = f.effect;
          among = &complete;
        }
    }
  }
  if (!best) return {};
  std::vector<int> shots;
  for (const int i : best->rows) shots.push_back((*among)[std::size_t(i)]);
  // Between the means of the two, of the rows that have it.
  const auto difference = [&](const Eigen::MatrixXd& of, int c) {
    std::array<double, 2> sum{}, values{};
    for (std::size_t i = 0; i < shots.size(); ++i)
      if (const double x = of(std::ptrdiff_t(i), c); std::isfinite(x)) {
        sum[best->second[i]] += x;
        values[best->second[i]] += 1;
      }
    return values[0] > 0 && values[1] > 0 ? std::abs(sum[1] / values[1] - sum[0] / values[0]) : 0.0;
  };
  const Eigen::MatrixXd z = seen(shots, s.base.model, s.base.p);
  int most = 0;
  for (int c = 1; c < width(); ++c)
    if (difference(z, c) > difference(z, most)) most = c;
  // In the channel's own unit.
  const double by_channel = difference(model_->residuals(s.base.model, s.base.p.data())(shots, Eigen::all), most);
  std::string apart = "two balls, players or settings that no column tells apart";
  constexpr double alike = 0.9;
  for (const Column& c : case_.shots.columns) {
    if (c.numeric || c.role == Role::output) continue;
    const Groups g = groups(c);
    for (std::size_t k = 0; k < g.name.size(); ++k) {
      double same = 0;
      for (std::size_t i = 0; i < shots.size(); ++i)
        same += (g.of_row[inputs_.row_of[shots[i]]] == int(k)) == bool(best->second[i]);
      if (std::max(same, double(shots.size()) - same) > alike * double(shots.size()))
        apart = fmt::format("nearly those of {} '{}', and the others", c.name, g.name[k]);
    }
  }
  return Location{
      channel(most).name, "",
      fmt::format(
          "a mixture of two populations, {:.0f} % of the shots {:.1f} standard deviations from the others, {:.3g} in "
          "{}{}: {}",
          100 * best->share, best->apart, by_channel, channel(most).name,
          by.empty() ? "" : fmt::format(", as {} would move them", by), apart)};
}

/// Where the residual is no structure in any regressor and yet no noise: two populations; a channel whose scatter
/// refutes its declared noise follows a regressor at a level that would not count alone, or strikes a share of the
/// shots that is no exception.
std::vector<Location> ShotProblem::shapes(const Selection& s) const {
  if (const auto two = two_populations(s)) return {*two};
  const auto told = [&](const std::string& channel, const std::string& column) {
    return Location{
        channel, column,
        fmt::format("{} of {} shots far off in {}, the others within the noise", many_, model_->shots(), widespread_)};
  };
  for (int c = 0; c < width(); ++c) {
    const std::string& name = channel(c).name;
    if (!channel(c).refuted && name != widespread_) continue;
    for (const Finding& f : s.after.findings)
      if (f.channel == c && f.p_adjusted < kTold) return {place_of(*this, f)};
    if (name == widespread_) {
      Location l = told(name, "");
      for (const StructureMap* map : {&s.after, &s.before})
        for (const Finding& f : map->findings)
          if (f.channel == c && f.p_adjusted < kTold && l.regressor.empty()) l.regressor = f.regressor;
      return {l};
    }
  }
  if (!widespread_.empty()) return {told("", widespread_)};
  return {};
}

/// Where structure remains, rows that are far off together along a column show it: they are no slips, and stay in.
void ShotProblem::put_back_together() {
  std::size_t together = 0;
  std::vector<Line> columns = columns_of(case_.shots, inputs_.row_of, *model_);
  columns.pop_back();  // an instrument fails for a while
  const std::vector<RowFlag> single = single_flags();
  if (!stand_together(single, columns, case_.rules.gate, together)) return;
  std::erase_if(flags_, [&](const RowFlag& f) {
    return std::ranges::any_of(single, [&](const RowFlag& s) { return s.row == f.row; });
  });
}

std::vector<RowFlag> ShotProblem::single_flags() const {
  std::map<int, int> of_finding;
  std::set<int> unasked;  // rows that were left out before anything was fitted are far from no model
  for (const RowFlag& f : early_) unasked.insert(f.row);
  for (const RowFlag& f : flags_) ++of_finding[f.finding];
  std::vector<RowFlag> single;
  for (const RowFlag& f : flags_)
    if (of_finding[f.finding] == 1 && !unasked.contains(f.row)) single.push_back(f);
  return single;
}

ShotProblem::FarOff ShotProblem::far_off(const Selection& s) const {
  FarOff out;
  std::map<std::string, int> of_column;
  for (const RowFlag& f : single_flags()) ++out.rows, ++of_column[f.column];
  out.lost = int(flags_.size());
  const std::vector<int> used = rows_.all();
  const Eigen::VectorXd z = model_->whitened(used, s.chosen.model, s.chosen.p);
  const solvers::Loss loss = stages().back().loss;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const double square = z.segment(std::ptrdiff_t(i) * width(), width()).squaredNorm();
    out.lost += square > loss.cap;
    out.rows += square > loss.knee;
  }
  for (const auto& [column, rows] : of_column)
    if (2 * rows > out.rows) out.column = column;
  out.all = int(flags_.size() + used.size());
  out.many = out.rows > std::max(3.0, kMany * out.all);
  return out;
}

std::optional<std::string> ShotProblem::heavy_tails(const Selection& s) const {
  const FarOff far = far_off(s);
  if (s.level > 0 || !far.many || !far.column.empty()) return {};
  return fmt::format("{}, in no one column: the noise has heavier tails than a normal one", far.said());
}

/// A fifth of the rows is flagged or so far off that the loss is flat there, or half of them are off by many noise
/// scales.
std::vector<Location> ShotProblem::doubts(const Selection& s) const {
  constexpr double many = 3;
  const std::vector<int> used = rows_.all();
  const Eigen::VectorXd z = model_->whitened(used, s.chosen.model, s.chosen.p);
  std::vector<Location> told;
  std::vector<std::vector<double>> size(static_cast<std::size_t>(width()));
  for (std::size_t i = 0; i < used.size(); ++i)
    for (int c = 0; c < width(); ++c)
      if (model_->observed(used[i], c)) size[c].push_back(std::abs(z[std::ptrdiff_t(i) * width() + c]));
  // Too few shots to refute the declared noise are too few to call what goes beyond it noise.
  const Eigen::MatrixXd residuals = this->residuals(s.chosen.model, s.chosen.p);
  for (int c = 0; c < width(); ++c)
    if (const double ratio = scatter(c, residuals, s.chosen.size()).ratio; channel(c).trusted() && ratio > kWide)
      told.push_back({channel(c).name, "",
                      fmt::format("scatters {:.1f} times as much as the {}", ratio,
                                  channel(c).repeated ? "rows that it is the mean of tell" : "noise declared")});
  for (int c = 0; c < width(); ++c)
    if (const double middle = median(size[c]); middle > many)
      told.push_back({channel(c).name, "", fmt::format("missed by {:.1f} noise scales on half of the shots", middle)});
  const FarOff far = far_off(s);
  if (const double share = double(far.lost) / far.all; share >= kLost)
    told.push_back({"", "",
                    fmt::format("{:.0f} % of the rows are flagged or explained by nothing: what fits the others "
                                "is no explanation of the set",
                                100 * share)});
  else if (far.many && (s.level > 0 || !far.column.empty())) told.push_back({"", far.column, far.said()});
  else if (s.level == 0)
    if (const auto where =
            no_single_slips(single_flags(), uses_, columns_of(case_.shots, inputs_.row_of, *model_), case_.rules.gate))
      told.push_back(*where);
  return told;
}

std::string ShotProblem::FarOff::said() const {
  return fmt::format("{} of {} shots lie so far from the model that noise puts one shot in a thousand there", rows,
                     all);
}

NextExperiment ShotProblem::next_experiment(const LoopResult& so_far) const {
  if (too_few()) return {.text = "More shots"};
  return design(case_, *this, *model_, select_, so_far);
}

}  // namespace hosel::loop
