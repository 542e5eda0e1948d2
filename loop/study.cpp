#include "hosel/loop/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>

#include "hosel/loop/scatter.hpp"

namespace hosel::loop {

Study::Study(const LoopCase& c, const std::vector<DerivedColumn>& derived, std::optional<std::set<int>> held,
             std::optional<Input> doubted)
    : loop_case(c), held_rows(std::move(held)) {
  result.title = c.title;
  result.base = c.base;
  result.seed = c.split.seed;
  result.read = int(c.shots.rows());
  result.derived = derived;
  result.selection.clean = true;
  prepare(doubted);
  if (problem) work();
}

void Study::flag_early(int row, std::string column, std::string reason, int shot) {
  early.push_back({.shot = shot, .row = row, .column = std::move(column), .reason = std::move(reason), .slip = false});
}

void Study::prepare(std::optional<Input> doubted) {
  const Shots& shots = loop_case.shots;
  std::map<std::string, double> input_noise;
  for (const auto& [header, value] : loop_case.input_noise)
    if (const Column* c = shots.find(header)) input_noise[header] = value * c->si;
  inputs = make_inputs(shots, loop_case.blow, loop_case.head_mass_declared, input_noise);
  result.unused = inputs.unused;
  result.notes = loop_case.notes;
  result.notes.insert(result.notes.end(), inputs.notes.begin(), inputs.notes.end());
  if (doubted) distrust(*doubted);

  // Cells that are no numbers, and values no blow has: flagged before anything is fitted.
  std::set<int> bad;
  for (const Column& c : shots.columns)
    for (const std::size_t row : c.broken)
      if (bad.insert(int(row)).second) flag_early(int(row), c.name, "not a finite number");
  for (const auto& [row, what] : inputs.impossible)
    if (bad.insert(row).second) flag_early(row, what.substr(0, what.find('|')), what.substr(what.find('|') + 1));

  std::vector<Channel> channels;
  std::vector<const Column*> columns;
  std::set<std::string> redundant;
  for (const DerivedColumn& d : result.derived)
    if (!d.input) redundant.insert(d.column);
  for (int o = 0; o < 7; ++o) {
    const Column* c = shots.find_stem(stem(Output(o)));
    if (!c || c->role != Role::output || redundant.contains(c->name)) continue;
    double seen = 0;
    for (const double x : c->value) seen += std::isfinite(x);
    if (seen < 1) continue;
    Channel ch{.name = c->name, .output = Output(o), .si = c->si, .resolution = c->resolution / c->si};
    if (const auto it = loop_case.noise.find(c->name); it != loop_case.noise.end()) {
      ch.noise = it->second;
      ch.declared = true;
    }
    channels.push_back(ch);
    columns.push_back(c);
  }
  if (channels.empty() && std::ranges::any_of(shots.columns, [](const Column& k) { return k.role == Role::output; })) {
    result.verdict = Verdict::insufficient;
    result.notes.push_back("no launch quantity has a value");
    return;
  }
  if (channels.empty())
    throw DataError(fmt::format("{}:1: no measured launch quantity (ball_speed_*, launch_angle_*, ...)", shots.file));

  std::vector<Trial> trials;
  std::vector<int> row_of;
  std::vector<Eigen::MatrixXd> covariance;
  for (std::size_t i = 0; i < inputs.trials.size(); ++i) {
    if (bad.contains(inputs.row_of[i])) continue;
    trials.push_back(inputs.trials[i]);
    row_of.push_back(inputs.row_of[i]);
    if (!inputs.covariance.empty()) covariance.push_back(inputs.covariance[i]);
  }
  inputs.row_of = row_of;
  inputs.covariance = covariance;
  if (trials.empty()) {
    result.verdict = Verdict::insufficient;
    result.notes.push_back("no row can be used");
    return;
  }
  Eigen::MatrixXd measured(std::ptrdiff_t(trials.size()), std::ptrdiff_t(channels.size()));
  for (std::size_t i = 0; i < trials.size(); ++i)
    for (std::size_t k = 0; k < channels.size(); ++k)
      measured(std::ptrdiff_t(i), std::ptrdiff_t(k)) = columns[k]->native(std::size_t(row_of[i]));
  // The record's last digit rounds: that much is added to the noise.
  for (Channel& ch : channels) ch.noise = std::hypot(ch.noise, ch.declared ? ch.resolution / std::sqrt(12.0) : 0.0);
  problem =
      std::make_unique<Problem>(*loop_case.model, loop_case.direct, std::move(trials), channels, std::move(measured));
  for (const Channel& ch : channels) result.channel_names.push_back(ch.name);
  for (const Channel& ch : channels) declared_noise.push_back(ch.declared ? ch.noise : 0);

  Setting setting;
  setting.head_turns = loop_case.head_turns;
  setting.inertia_declared = loop_case.inertia_declared;
  for (const Channel& ch : channels) setting.outputs.push_back(ch.output);
  for (const EffectEntry& e : effects())
    for (Form& f : e.forms(setting)) {
      // Rows without a shot number may stand in any order: that it is the session's is an assumption more.
      if (f.effect == "session-drift" && !shots.has_shot_column) f.rarity += 10;
      result.forms.push_back(std::move(f));
    }
  for (const std::string& e : loop_case.effects) {
    bool found = false;
    for (const Form& f : result.forms)
      if (f.effect == e && !found) {
        base_forms.push_back(&f);
        found = true;
      }
  }
  for (const Form& f : result.forms)
    if (!std::ranges::count(loop_case.effects, f.effect)) candidate_forms.push_back(&f);

  for (int k = 0; k < kInputs; ++k)
    if (const Column* c = shots.find_stem(stem(Input(k)))) uses.push_back({c, k, -1});
  for (std::size_t k = 0; k < columns.size(); ++k) uses.push_back({columns[k], -1, int(k)});

  std::vector<double> out(channels.size());
  for (int i = 0; i < problem->shots(); ++i) {
    if (problem->predict(i, Model{}, nullptr, out.data())) usable.push_back(i);
    else flag_early(row_of[std::size_t(i)], "", "the base model has no answer: the head moves away from the ball", i);
  }
  const boost::math::chi_squared law(problem->width());
  loss.knee = quantile(law, 0.999);
  loss.cap = 12 * loss.knee;
}

/// Every shot's value of this input may be anything: its direction is projected out of the shot's channels.
void Study::distrust(Input input) {
  if (inputs.covariance.empty())
    inputs.covariance.assign(inputs.trials.size(), Eigen::MatrixXd::Zero(kInputs, kInputs));
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (const Trial& t : inputs.trials) {
    lo = std::min(lo, get(t.blow, input));
    hi = std::max(hi, get(t.blow, input));
  }
  for (Eigen::MatrixXd& cov : inputs.covariance)
    cov(int(input), int(input)) += std::pow(10 * std::max(hi - lo, 1e-3), 2);
}

void Study::split(const std::set<int>& without) {
  std::vector<int> kept;
  for (const int i : usable)
    if (!without.contains(i)) kept.push_back(i);
  if (held_rows) {
    rows = {};
    for (const int i : kept)
      (held_rows->contains(inputs.row_of[std::size_t(i)]) ? rows.holdout : rows.train).push_back(i);
  } else {
    // The split is made over all usable rows, so that screening does not reshuffle it.
    const Rows all = split_rows(loop_case, *problem, inputs.row_of, usable);
    rows = {};
    for (const int i : all.train)
      if (!without.contains(i)) rows.train.push_back(i);
    for (const int i : all.holdout)
      if (!without.contains(i)) rows.holdout.push_back(i);
  }
}

/// Noise that is not declared (or contradicted), from the residuals of a fit.
void Study::estimate_noise(const Fit* at) {
  const Eigen::VectorXd none;
  const Eigen::MatrixXd r = at ? problem->residuals(at->model, at->p.data()) : problem->residuals(Model{}, nullptr);
  for (int c = 0; c < problem->width(); ++c) {
    const Channel& ch = problem->channels()[std::size_t(c)];
    const bool refuted = std::ranges::count(contradicted, ch.name) > 0;
    if (ch.declared && !refuted) continue;
    const double smooth = smooth_scatter(*problem, rows.train, c, r);
    double sd = smooth;
    if (at) {
      const Scatter s = scatter(*problem, rows.train, c, r, at->size());
      const double whole = s.ratio * [&] {
        double sum = 0;
        for (const int i : rows.train) sum += problem->sigma(i, c) * problem->sigma(i, c);
        return std::sqrt(sum / std::max<double>(1, double(rows.train.size())));
      }();
      sd = refuted || smooth <= 0 ? whole : std::min(whole, 1.3 * smooth);
    }
    // What noisy inputs contribute is counted separately.
    double from_inputs = 0;
    if (at && !inputs.covariance.empty()) {
      double sum = 0;
      for (const int i : rows.train)
        sum += std::max(0.0, problem->sigma(i, c) * problem->sigma(i, c) - ch.noise * ch.noise);
      from_inputs = sum / std::max<double>(1, double(rows.train.size()));
    }
    const double floor = std::max({ch.resolution / std::sqrt(12.0), 1e-3 * sd, 1e-9});
    problem->set_noise(c, std::max(std::sqrt(std::max(sd * sd - from_inputs, 0.09 * sd * sd)), floor));
  }
}

void Study::set_covariance(const Fit* at) {
  if (at) problem->set_covariance(inputs.covariance, at->model, at->p.data());
  else problem->set_covariance(inputs.covariance, Model{}, nullptr);
}

/// Per channel: the noise is declared and not contradicted.
std::vector<char> Study::declared() const {
  std::vector<char> all;
  for (const Channel& c : problem->channels()) all.push_back(c.declared && !std::ranges::count(contradicted, c.name));
  return all;
}

void Study::select(bool deep) {
  result.selection = loop::select(*problem, thinned(rows.train), base_forms, candidate_forms, regressors, loss,
                                  declared(), loop_case.rules, deep);
}

void Study::work() {
  split({});
  std::set<int> out;
  estimate_noise(nullptr);
  set_covariance(nullptr);
  regressors = loop::regressors(loop_case.shots, inputs.row_of, thinned(rows.train), *problem);
  if (rows.train.size() < 4) return;
  for (int pass = 0; pass < 4; ++pass) {
    select(pass > 0);
    const Fit& at = result.selection.chosen;
    Screening screening = screen(*problem, loop_case.shots, inputs.row_of, uses, at, result.selection.clean, early);
    // A drift can follow a club that recorded something else: what leaves structure must not hide such a club.
    if (!result.selection.clean && result.selection.level > 0 &&
        std::ranges::none_of(screening.flags, &RowFlag::cluster)) {
      Screening bare = screen(*problem, loop_case.shots, inputs.row_of, uses, result.selection.base, false, early);
      if (std::ranges::any_of(bare.flags, &RowFlag::cluster)) screening = std::move(bare);
    }
    flags = screening.flags;
    widespread = screening.widespread;
    std::set<int> now;
    for (const RowFlag& f : flags)
      if (f.shot >= 0) now.insert(f.shot);
    std::vector<int> changed;
    std::ranges::set_symmetric_difference(now, out, std::back_inserter(changed));
    const bool settled_rows = changed.size() * 500 <= std::size_t(problem->shots());
    out = now;
    split(out);
    if (rows.train.size() < 4) return;
    std::vector<double> before;
    for (const Channel& ch : problem->channels()) before.push_back(ch.noise);
    contradict(at);
    estimate_noise(&at);
    bool settled_noise = true;
    for (int c = 0; c < problem->width(); ++c)
      settled_noise = settled_noise &&
                      std::abs(problem->channels()[std::size_t(c)].noise / before[std::size_t(c)] - 1) < 0.03;
    const bool first_covariance = pass == 0 && !inputs.covariance.empty() && !at.model.forms.empty();
    set_covariance(&at);
    regressors = loop::regressors(loop_case.shots, inputs.row_of, thinned(rows.train), *problem);
    if (settled_rows && settled_noise && !first_covariance) {
      if (pass == 0 && !result.selection.clean && result.selection.level == 2) select(true);
      break;
    }
    if (pass == 3) select(true);
  }
}

/// Declared noise that the scatter about a clean fit contradicts.
void Study::contradict(const Fit& at) {
  if (!result.selection.clean) return;
  const Eigen::MatrixXd r = problem->residuals(at.model, at.p.data());
  for (int c = 0; c < problem->width(); ++c) {
    const Channel& ch = problem->channels()[std::size_t(c)];
    if (!ch.declared || std::ranges::count(contradicted, ch.name)) continue;
    const Scatter s = scatter(*problem, rows.train, c, r, at.size());
    if (std::abs(std::log(s.ratio)) > 4.2 * s.error && (s.ratio > 1.25 || s.ratio < 0.8))
      contradicted.push_back(ch.name);
  }
}

}  // namespace hosel::loop
