#include "loop/flights/problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>
#include <ranges>

#include "golf/data_error.hpp"
#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "golf/units.hpp"
#include "loop/deviation.hpp"
#include "loop/flights/columns.hpp"
#include "loop/shots/inputs.hpp"
#include "loop/shots/scatter.hpp"
#include "loop/shots/split.hpp"
#include "loop/verdict.hpp"
#include "solvers/errors.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kFewestFlights = 8;  // training flights that can test anything
constexpr std::size_t kRivals = 12;        // of a slip of a column, the likeliest
constexpr double kIntegrationStep = 0.05;  // [s]: differences of flights are taken, so that they are smooth

/// Steps of the differences, by ShotUnknown, then of a group's unknowns: a reading moves by far more than the
/// integration's error and by little of what is unknown.
constexpr std::array<double, models::kShotUnknowns> kOwnStep = {1e-2, 1e-2, 1e-2, 1e-2, 0.1, 1e-3, 1e-3, 0.1, 0.1};
constexpr std::array<double, 3> kGroupStep = {0.1, 0.1, 1e-3};

const char* path_axis(int axis) { return axis == 0 ? "along" : axis == 1 ? "right" : "up"; }

}  // namespace

FlightProblem::FlightProblem(const FlightCase& c, About about) : case_(c) {
  read();
  split();
  estimate_noise(nullptr);
  if (about == About::likeliest) expand({}, {});
  else slopes({}, {});
  estimate_noise(nullptr);
  factor();
}

FlightProblem FlightProblem::with_readings(const FlightCase& c) const {
  FlightProblem other = *this;
  for (int k = 0; k < width(); ++k)
    if (readings_[std::size_t(k)].answer >= 0)
      for (std::size_t i = 0; i < trials_.size(); ++i)
        if (double& y = other.measured_(Eigen::Index(i), k); std::isfinite(y))
          y = c.shots.find(channel(k).name)->native(std::size_t(trials_[i].row));
  other.estimate_noise(nullptr);
  other.train_blocks_ = other.blocks(train_);
  other.held_blocks_ = other.blocks(holdout_);
  return other;
}

void FlightProblem::hold_noise(const FlightProblem& as) {
  if ((noise() == as.noise()).all()) return;
  for (int k = 0; k < width(); ++k)
    if (Channel& ch = channels_[std::size_t(k)]; !ch.trusted()) ch.noise = as.channel(k).noise;
  train_blocks_ = blocks(train_);
  held_blocks_ = blocks(holdout_);
}

bool FlightProblem::Reading::aside() const {
  return answer >= 0 ? answer == flight_answer(Output::side) : point.axis != 2;
}

std::vector<Parametrisation> FlightProblem::forms() const {
  std::vector<Parametrisation> all;
  for (const EffectEntry& e : effects_with(case_.own))
    for (Parametrisation& f : e.forms(Setting{.flies = true, .no_blow = true}))
      if (!f.before && !f.after && !f.reading && (f.seen || f.flight)) all.push_back(std::move(f));
  return all;
}

void FlightProblem::read() {
  const Shots& shots = case_.shots;
  for (const Column& c : shots.columns) {
    const auto output = c.role == Role::output ? output_of(c.stem) : std::nullopt;
    if (!output || !of_flight(*output)) continue;
    Channel ch{.name = c.name, .si = c.si, .resolution = c.resolution / c.si};
    if (const auto it = case_.noise.find(c.name); it != case_.noise.end())
      ch.declared = std::hypot(it->second, rounding_deviation(ch.resolution));
    channels_.push_back(std::move(ch));
    readings_.push_back({.answer = flight_answer(*output)});
  }
  for (const PathPoint& p : case_.points) {
    channels_.push_back({.name = fmt::format("{}_at_{:g}_s_m", path_axis(p.axis), p.time),
                         .declared = case_.position_noise > 0 ? std::optional(case_.position_noise) : std::nullopt});
    readings_.push_back({.point = p});
    if (std::ranges::find(instants_, p.time) == instants_.end()) instants_.push_back(p.time);
  }
  std::ranges::sort(instants_);
  if (channels_.empty())
    throw DataError(
        fmt::format("{}: no reading of a flight: carry, side, apex, flight_time, landing_angle or a path", shots.file));

  const auto noise_of = [&](Output o) {  // SI
    const Column* c = shots.find_stem(stem(o));
    return c && case_.noise.contains(c->name)
               ? std::hypot(case_.noise.at(c->name) * c->si, rounding_deviation(c->resolution))
               : 0.0;
  };
  const auto has = [&](Output o, std::size_t row) { return recorded(shots, row, o).has_value(); };
  std::vector<int> rows(shots.rows());
  std::iota(rows.begin(), rows.end(), 0);
  const std::vector<double> order = session_order(shots, rows);
  std::vector<Eigen::VectorXd> measured;
  for (std::size_t row = 0; row < shots.rows(); ++row) {
    Trial t{.row = int(row), .order = order[row], .by_own = {}, .by_group = {}};
    models::ShotUnknowns& sd = t.shot.sd;
    sd[models::kOwnDrag] = case_.unknown.drag;
    sd[models::kOwnLift] = case_.unknown.lift;
    sd[models::kGustAlong] = sd[models::kGustRight] = case_.unknown.gust;
    sd[models::kOwnSpeed] = noise_of(Output::ball_speed);
    sd[models::kOwnAngle] = noise_of(Output::launch_angle);
    sd[models::kOwnAzimuth] = noise_of(Output::azimuth);
    const bool components = has(Output::backspin, row) && (has(Output::sidespin, row) || !has(Output::spin_rate, row)),
               rate = has(Output::spin_rate, row) || components;
    const bool axis = (components && has(Output::sidespin, row)) || has(Output::spin_axis, row);
    if (!has(Output::ball_speed, row) || !has(Output::launch_angle, row)) {
      ++unused_["no launch"];
      continue;
    }
    if (!rate && !(case_.unknown.spin_rate > 0)) {
      ++unused_["no spin, and none is told in [unknown]"];
      continue;
    }
    const auto seen = seen_launch(shots, row);
    if (seen) {
      t.shot.launch = *seen;
    } else {
      const auto value = [&](Output o) { return recorded(shots, row, o).value_or(0); };
      const double tilt = value(Output::spin_axis);
      t.shot.launch.velocity = value(Output::ball_speed) *
                               direction(value(Output::launch_angle), value(Output::azimuth));
      t.shot.launch.spin = case_.unknown.spin_rate * Vec3(0, -std::cos(tilt), -std::sin(tilt));
    }
    const double spin = t.shot.launch.spin_rate();
    if (!(spin > 0)) {
      ++unused_["a spin of zero: the lift has no direction"];
      continue;
    }
    if (!rate) sd[models::kLogSpin] = case_.unknown.spin_rate_sd;
    else sd[models::kLogSpin] = (components ? noise_of(Output::backspin) : noise_of(Output::spin_rate)) / spin;
    if (!axis) sd[models::kAxis] = case_.unknown.axis;
    else
      sd[models::kAxis] = components && has(Output::sidespin, row) ? noise_of(Output::sidespin) / spin
                                                                   : noise_of(Output::spin_axis);
    if (!case_.deviations.empty()) sd = case_.deviations[row];
    t.shot.air = case_.air.empty() ? case_.conditions.air : case_.air[row];
    std::string group;
    for (const std::string& name : case_.group_by) {
      const Column* c = shots.find(name);
      if (!c) throw DataError(fmt::format("{}:1: no column '{}' to group by", shots.file, name));
      group += (group.empty() ? "" : "/") + (c->numeric ? fmt::format("{:.12g}", c->native(row)) : c->text[row]);
    }
    Eigen::VectorXd y(width());
    bool any = false, unaimed = false;
    for (int c = 0; c < width(); ++c) {
      const Reading& r = readings_[std::size_t(c)];
      if (r.answer >= 0) {
        const Column& column = *shots.find(channels_[std::size_t(c)].name);
        y[c] = column.numeric ? column.native(row) : kNaN;
      } else {
        y[c] = case_.positions(Eigen::Index(row), c - Eigen::Index(channels_.size() - case_.points.size()));
      }
      if (std::isfinite(y[c]) && r.aside() && !has(Output::azimuth, row)) y[c] = kNaN, unaimed = true;
      any = any || std::isfinite(y[c]);
    }
    unaimed_ += unaimed;
    if (!any) {
      ++unused_["no reading of the flight"];
      continue;
    }
    const auto known = std::ranges::find(groups_, group);
    t.shot.group = int(known - groups_.begin());
    if (known == groups_.end()) groups_.push_back(group);
    if (const Eigen::VectorXd f = predict(t, {}, nullptr, t.own, GroupUnknowns::Zero()); !f.allFinite()) {
      ++unused_[kNoFlight];
      continue;
    }
    t.shot.id = shots.id[row];
    trials_.push_back(std::move(t));
    measured.push_back(std::move(y));
  }
  if (trials_.empty())
    throw DataError(fmt::format("{}: no row holds a launch and a reading of its flight", shots.file));
  measured_.resize(Eigen::Index(trials_.size()), width());
  for (std::size_t i = 0; i < trials_.size(); ++i) measured_.row(Eigen::Index(i)) = measured[i].transpose();
  group_.assign(groups_.size(), GroupUnknowns::Zero());
}

void FlightProblem::split() {
  const Column* by = case_.split.by.empty() ? nullptr : case_.shots.find(case_.split.by);
  if (!by && !case_.split.by.empty())
    throw DataError(fmt::format("{}:1: no column '{}' to split by", case_.shots.file, case_.split.by));
  const Groups g = by ? groups(*by) : Groups{};
  std::vector<std::vector<std::size_t>> clusters;  // in order of appearance; a trial without a name is its own
  std::map<int, std::size_t> place;
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    const int name = by ? g.of_row[std::size_t(trials_[i].row)] : -1;
    const std::size_t k = name < 0 ? clusters.size() : place.try_emplace(name, clusters.size()).first->second;
    if (k == clusters.size()) clusters.emplace_back();
    clusters[k].push_back(i);
  }
  std::mt19937_64 random(case_.split.seed);
  const std::vector<char> held = hold_out(clusters, trials_.size(), case_.split.holdout_fraction, random);
  for (std::size_t i = 0; i < trials_.size(); ++i) (held[i] ? holdout_ : train_).push_back(int(i));
}

Eigen::VectorXd FlightProblem::predict(const Trial& t, const Model& model, const double* p,
                                       const models::ShotUnknowns& own, const GroupUnknowns& group) const {
  Launch launch = t.shot.launch;
  models::FlightConditions c = case_.conditions;
  c.air = t.shot.air;
  model.each(p, [&](const Parametrisation& f, std::span<const double> q) {
    if (f.seen) f.seen(q, launch);
    if (f.flight) f.flight(q, c);
  });
  launch = models::launched(launch, own);
  c = models::with_own(std::move(c), own, group.head<2>());
  c.ground.slope += group[2];
  Eigen::VectorXd out = Eigen::VectorXd::Constant(width(), kNaN);
  try {
    if (channels_.size() > case_.points.size()) {
      const models::FlightAnswers a = models::answers(models::fly_in_steps(launch, case_.ball, c, kIntegrationStep));
      for (int k = 0; k < width(); ++k)
        if (const int answer = readings_[std::size_t(k)].answer; answer >= 0)
          out[k] = a[answer] / channels_[std::size_t(k)].si;
    }
    if (!instants_.empty()) {
      const auto path = models::follow_in_steps(launch, case_.ball, c, instants_, kIntegrationStep);
      for (int k = 0; k < width(); ++k) {
        const Reading& r = readings_[std::size_t(k)];
        if (r.answer >= 0) continue;
        const Vec3& x = path[std::size_t(std::ranges::find(instants_, r.point.time) - instants_.begin())];
        out[k] = r.point.axis == 0 ? x.x() : r.point.axis == 1 ? -x.y() : x.z();
      }
    }
  } catch (const std::invalid_argument&) { out.setConstant(kNaN); } catch (const solvers::NonConvergence&) {
    out.setConstant(kNaN);
  }
  static const Shot no_blow;
  model.each(p, [&](const Parametrisation& f, std::span<const double> q) {
    for (int k = 0; f.reading && k < width(); ++k)
      if (readings_[std::size_t(k)].answer >= 0) {
        const auto& [name, si] = std::tie(channel(k).name, channel(k).si);
        out[k] = f.reading(q, no_blow, *output_of(split_unit(name).stem), out[k] * si) / si;
      }
  });
  return out;
}

/// The unknowns' most likely values under a model, the slopes there, and the factors of the covariances.
void FlightProblem::expand(const Model& model, const Eigen::VectorXd& p) {
  std::vector<int> all = train_;
  all.insert(all.end(), holdout_.begin(), holdout_.end());
  std::ranges::sort(all);
  constexpr int most = 12, halvings = 6;
  Eigen::MatrixXd e;
  if (!errors(all, model, p, e)) throw DataError("the model has no answer for these data");
  for (int pass = 0; pass < most; ++pass) {
    slopes(model, p);
    if (!errors(all, model, p, e)) break;
    std::vector<models::ShotUnknowns> own_before;
    for (const Trial& t : trials_) own_before.push_back(t.own);
    const std::vector<GroupUnknowns> group_before = group_;
    double change = 0;
    const GroupUnknowns of_group = group_sd();
    for (const Block& b : blocks(all)) {
      Eigen::VectorXd r = b.of(e);
      const auto L = b.factor.triangularView<Eigen::Lower>();
      L.solveInPlace(r);
      L.transpose().solveInPlace(r);
      GroupUnknowns group = GroupUnknowns::Zero();
      std::vector<models::ShotUnknowns> own(b.trials.size(), models::ShotUnknowns::Zero());
      for (std::size_t k = 0; k < b.readings.size(); ++k) {
        const auto [i, c] = b.readings[k];
        const Trial& t = trials_[std::size_t(b.trials[std::size_t(i)])];
        group -= r[Eigen::Index(k)] * of_group.cwiseAbs2().cwiseProduct(t.by_group.row(c).transpose());
        own[std::size_t(i)] -= r[Eigen::Index(k)] * t.shot.sd.cwiseAbs2().cwiseProduct(t.by_own.row(c).transpose());
      }
      const auto moved = [&](const auto& from, const auto& to, const auto& sd) {
        for (Eigen::Index k = 0; k < from.size(); ++k)
          if (sd[k] > 0) change = std::max(change, std::abs(to[k] - from[k]) / sd[k]);
      };
      GroupUnknowns& known = group_[std::size_t(trials_[std::size_t(b.trials.front())].shot.group)];
      moved(known, group, of_group);
      known = group;
      for (std::size_t i = 0; i < b.trials.size(); ++i) {
        Trial& t = trials_[std::size_t(b.trials[i])];
        moved(t.own, own[i], t.shot.sd);
        t.own = own[i];
      }
    }
    // A step may ask for unknowns with which no ball flies: it is halved in that group, in the end not taken.
    for (int k = 0; !errors(all, model, p, e); ++k) {
      const double way = k < halvings ? 0.5 : 0;
      std::set<int> without;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (e.row(Eigen::Index(i)).array().isInf().any()) without.insert(trials_[std::size_t(all[i])].shot.group);
      for (const int i : all)
        if (Trial& t = trials_[std::size_t(i)]; without.contains(t.shot.group)) {
          const auto& before = own_before[std::size_t(i)];
          t.own = before + way * (t.own - before);
        }
      for (const int g : without) {
        const auto& before = group_before[std::size_t(g)];
        group_[std::size_t(g)] = before + way * (group_[std::size_t(g)] - before);
      }
      if (way == 0) break;
    }
    if (change < case_.rules.noise_change) break;
  }
  slopes(model, p);
  factor();
}

void FlightProblem::slopes(const Model& model, const Eigen::VectorXd& p) {
  for_all(std::size_t(0), trials_.size(),
          [&](std::size_t i) { slopes(trials_[i], group_[std::size_t(trials_[i].shot.group)], model, p); });
}

/// Of one trial, about its unknowns and these of its group.
void FlightProblem::slopes(Trial& t, const GroupUnknowns& group, const Model& model, const Eigen::VectorXd& p) const {
  const GroupUnknowns sd = group_sd();
  t.by_own = Eigen::MatrixXd::Zero(width(), models::kShotUnknowns);
  t.by_group = Eigen::MatrixXd::Zero(width(), kGroup);
  const auto difference = [&](const auto& at, double step, auto into) {
    const Eigen::VectorXd d = (at(step) - at(-step)) / (2 * step);
    if (d.allFinite()) into = d;
  };
  for (int k = 0; k < models::kShotUnknowns; ++k)
    if (t.shot.sd[k] > 0)
      difference(
          [&](double h) {
            models::ShotUnknowns own = t.own;
            own[k] += h;
            return predict(t, model, p.data(), own, group);
          },
          kOwnStep[std::size_t(k)], t.by_own.col(k));
  for (int k = 0; k < kGroup; ++k)
    if (sd[k] > 0)
      difference(
          [&](double h) {
            GroupUnknowns g = group;
            g[k] += h;
            return predict(t, model, p.data(), t.own, g);
          },
          kGroupStep[std::size_t(k)], t.by_group.col(k));
}

std::vector<FlightProblem::Block> FlightProblem::blocks(const std::vector<int>& trials) const {
  std::vector<Block> all(groups_.size());
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const int i = trials[k];
    Block& b = all[std::size_t(trials_[std::size_t(i)].shot.group)];
    for (int c = 0; c < width(); ++c)
      if (std::isfinite(measured_(i, c))) b.readings.emplace_back(int(b.trials.size()), c);
    b.trials.push_back(i);
    b.place.push_back(Eigen::Index(k));
  }
  std::erase_if(all, [](const Block& b) { return b.trials.empty(); });
  const GroupUnknowns sd = group_sd();
  for_all(std::size_t(0), all.size(), [&](std::size_t g) {
    Block& b = all[g];
    const auto n = Eigen::Index(b.readings.size());
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      const auto [i, c] = b.readings[std::size_t(a)];
      const Trial& t = trials_[std::size_t(b.trials[std::size_t(i)])];
      const Eigen::RowVectorXd own = t.by_own.row(c).cwiseProduct(t.shot.sd.cwiseAbs2().transpose()),
                               group = t.by_group.row(c).cwiseProduct(sd.cwiseAbs2().transpose());
      for (Eigen::Index k = 0; k <= a; ++k) {
        const auto [j, d] = b.readings[std::size_t(k)];
        const Trial& u = trials_[std::size_t(b.trials[std::size_t(j)])];
        S(a, k) = group.dot(u.by_group.row(d)) + (i == j ? own.dot(t.by_own.row(d)) : 0.0);
      }
      S(a, a) += std::pow(channel(c).noise, 2);
    }
    const dense::Cholesky factors(S);  // of its lower half
    if (!factors.positive()) throw DataError("the readings' covariance is not positive: declare their noise");
    b.factor = factors.lower();
  });
  return all;
}

void FlightProblem::factor() {
  train_blocks_ = blocks(train_);
  held_blocks_ = blocks(holdout_);
  // What drives a residual: what was seen of the launch, and every column that no model knows.
  std::vector<Line> lines;
  std::vector<int> row_of;
  Eigen::VectorXd order(Eigen::Index(trials_.size()));
  for (std::size_t i = 0; i < trials_.size(); ++i) {
    row_of.push_back(trials_[i].row);
    order[Eigen::Index(i)] = trials_[i].order;
  }
  for (const Column& c : case_.shots.columns) {
    if (!c.numeric || c.role == Role::bookkeeping) continue;
    const auto output = c.role == Role::output ? output_of(c.stem) : std::nullopt;
    if (output && of_flight(*output)) continue;
    Eigen::VectorXd x(order.size());
    for (std::size_t i = 0; i < trials_.size(); ++i) x[Eigen::Index(i)] = c.value[std::size_t(row_of[i])];
    lines.push_back({c.name, !output, std::move(x)});
  }
  regressors_ = regressors(case_.shots, row_of, train_, lines, order);
}

bool FlightProblem::errors(const std::vector<int>& trials, const Model& model, const Eigen::VectorXd& p,
                           Eigen::MatrixXd& e) const {
  e.resize(Eigen::Index(trials.size()), width());
  for_all(std::size_t(0), trials.size(), [&](std::size_t k) {
    const Trial& t = trials_[std::size_t(trials[k])];
    const GroupUnknowns& group = group_[std::size_t(t.shot.group)];
    Eigen::VectorXd f = predict(t, model, p.data(), t.own, group);
    if (t.by_own.size()) f -= t.by_own * t.own + t.by_group * group;
    e.row(Eigen::Index(k)) = f.transpose() - measured_.row(trials[k]);
    // Nothing is measured: no matter what the model says. Else it must say something.
    for (int c = 0; c < width(); ++c)
      if (std::isnan(e(Eigen::Index(k), c)) && std::isfinite(measured_(trials[k], c)))
        e(Eigen::Index(k), c) = kInfinity;
  });
  return (e.array().isNaN() || e.array().isFinite()).all();
}

Eigen::VectorXd FlightProblem::whiten(Part part, const Eigen::MatrixXd& e) const {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(e.rows() * width());
  for (const Block& b : blocks(part)) {
    Eigen::VectorXd r = b.of(e);
    b.factor.triangularView<Eigen::Lower>().solveInPlace(r);
    for (std::size_t k = 0; k < b.readings.size(); ++k) {
      const auto [i, c] = b.readings[k];
      z[b.place[std::size_t(i)] * width() + c] = r[Eigen::Index(k)];
    }
  }
  return z;
}

Eigen::VectorXd FlightProblem::Block::of(const Eigen::MatrixXd& e) const {
  Eigen::VectorXd r(Eigen::Index(readings.size()));
  for (std::size_t k = 0; k < readings.size(); ++k)
    r[Eigen::Index(k)] = e(place[std::size_t(readings[k].first)], readings[k].second);
  return r;
}

std::vector<Problem::Row> FlightProblem::rows() const {
  std::vector<Row> all;
  for (const auto* of : {&train_, &holdout_})
    for (const int i : *of)
      all.push_back({i, trials_[std::size_t(i)].row, trials_[std::size_t(i)].shot.id, of == &holdout_});
  std::ranges::sort(all, {}, &Row::index);
  return all;
}

std::vector<std::string> FlightProblem::notes() const {
  std::vector<std::string> all;
  if (unaimed_ > 0)
    all.push_back(
        fmt::format("{} {} no azimuth: what hangs on the direction of the launch (side, along and right of a path) is "
                    "not judged there",
                    unaimed_, unaimed_ == 1 ? "row has" : "rows have"));
  if (!(case_.unknown.wind > 0)) return all;
  for (const int k : groups_with_flights()) {
    const auto g = std::size_t(k);
    all.push_back(fmt::format("wind{}: {:+.1f} m/s along, {:+.1f} m/s to the right, under the model that is told",
                              groups_[g].empty() ? "" : " of " + groups_[g], group_[g][0], group_[g][1]));
  }
  return all;
}

std::optional<std::string> FlightProblem::too_few() const {
  if (train_.size() < kFewestFlights)
    return fmt::format("{} flights to learn from: fewer than {} test nothing", train_.size(), kFewestFlights);
  return {};
}

bool FlightProblem::whitened(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                             double) const {
  Eigen::MatrixXd e;
  if (!errors(trials(part), model, p, e)) return false;
  z = whiten(part, e);
  return z.allFinite();
}

bool FlightProblem::linearise(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                              Eigen::MatrixXd& jacobian, double window) const {
  if (!whitened(part, model, p, z, window)) return false;
  jacobian = this->jacobian(part, model, p);
  return true;
}

/// Central, one-sided where a side is out of range or has no answer; zero where neither has one.
Eigen::MatrixXd FlightProblem::jacobian(Part part, const Model& model, const Eigen::VectorXd& p) const {
  constexpr double step = 0.05;  // of a parameter's scale
  Eigen::VectorXd z, low, high, x = p;
  if (!whitened(part, model, p, z)) return {};
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(z.size(), p.size());
  Eigen::Index k = 0;
  for (const Parameter* q : model.parameters()) {
    const auto look = [&](double steps, Eigen::VectorXd& out) {
      x[k] = p[k] + steps * step * q->scale;
      const bool good = x[k] >= q->min && x[k] <= q->max && whitened(part, model, x, out);
      x[k] = p[k];
      return good;
    };
    const bool up = look(1, high), down = look(-1, low);
    if (up && down) J.col(k) = (high - low) / (2 * step);
    else if (up) J.col(k) = (high - z) / step;
    else if (down) J.col(k) = (z - low) / step;
    ++k;
  }
  return J;
}

Eigen::MatrixXd FlightProblem::residuals(const Model& model, const Eigen::VectorXd& p) const {
  std::vector<int> all(trials_.size());
  std::iota(all.begin(), all.end(), 0);
  Eigen::MatrixXd e;
  if (!errors(all, model, p, e)) return {};
  return e;
}

Problem::Density FlightProblem::density(Part part) const {
  Density d;
  for (const Block& b : blocks(part)) {
    d.values += double(b.readings.size());
    d.log_whitening -= b.factor.diagonal().array().log().sum();
  }
  return d;
}

double FlightProblem::sigma(int trial, int c) const {
  const Trial& t = trials_[std::size_t(trial)];
  return std::sqrt(std::pow(channel(c).noise, 2) + t.by_own.row(c).cwiseProduct(t.shot.sd.transpose()).squaredNorm() +
                   t.by_group.row(c).cwiseProduct(group_sd().transpose()).squaredNorm());
}

/// Of what a reading scatters once the others of its group have said what they know: the whitened residuals, which
/// hold no wind and no ball twice.
Scatter FlightProblem::scatter(int c, const Eigen::MatrixXd& residuals, int fitted) const {
  Eigen::MatrixXd e(Eigen::Index(train_.size()), width());
  if (!residuals.size()) return {};
  for (std::size_t k = 0; k < train_.size(); ++k) e.row(Eigen::Index(k)) = residuals.row(train_[k]);
  const Eigen::VectorXd z = whiten(Part::train, e);
  std::vector<double> readings;
  for (std::size_t k = 0; k < train_.size(); ++k)
    if (std::isfinite(measured_(train_[k], c))) readings.push_back(z[Eigen::Index(k) * width() + c]);
  return scatter_of(readings, double(fitted) / width());
}

/// Noise that is not declared, or refuted.
void FlightProblem::estimate_noise(const Fit* at) {
  const Eigen::MatrixXd r = at ? residuals(at->model, at->p) : residuals({}, {});
  for (int c = 0; c < width(); ++c) {
    Channel& ch = channels_[std::size_t(c)];
    if (ch.trusted()) {
      ch.noise = *ch.declared;
      continue;
    }
    double sd = 0;
    if (at && ch.noise > 0) {
      sd = ch.noise * scatter(c, r, at->size()).ratio;
    } else {
      std::vector<double> value;
      for (const int i : train_)
        if (std::isfinite(measured_(i, c))) value.push_back(r(i, c));
      sd = robust_moments(value).second;
      if (trials_.front().by_own.size()) {  // what is unknown is counted separately
        double known = 0;
        for (const int i : train_) known += std::pow(sigma(i, c), 2) - ch.noise * ch.noise;
        sd = std::sqrt(std::max(sd * sd - known / double(train_.size()), 0.04 * sd * sd));
      }
    }
    ch.noise = std::max(sd, ch.least_noise());
  }
}

double FlightProblem::update_noise(const Fit& selected, const Fit&) {
  const Eigen::ArrayXd before = noise();
  estimate_noise(&selected);
  expand(selected.model, selected.p);
  // What is unknown weighs otherwise about an effect.
  const bool anew = !updated_ && !selected.model.forms.empty();
  updated_ = updated_ || anew;
  return anew ? kInfinity : (noise() / before - 1).abs().maxCoeff();
}

StructureMap FlightProblem::structure(const Fit& fit, const Fit& near, const Eigen::MatrixXd& directions,
                                      const Rules& rules) const {
  Whitened view{.rows = train_, .order = {}, .column = {}};
  for (const int i : train_) view.order.push_back(trials_[std::size_t(i)].order);
  view.column = [&](int c, const Eigen::VectorXd& value) {
    Eigen::MatrixXd e = Eigen::MatrixXd::Zero(value.size(), width());
    e.col(c) = value;
    return whiten(Part::select, e);
  };
  return loop::structure(*this, view, fit, near, regressors_, directions, rules);
}

/// Winds that are not of the declared size.
std::vector<Location> FlightProblem::shapes(const Selection&) const {
  const auto wind = wide_winds();
  return wind ? std::vector<Location>{*wind} : std::vector<Location>{};
}

std::vector<Location> FlightProblem::places(const Selection& selection) const {
  std::vector<Location> all = plainest_places(*this, selection);
  if (const auto wind = wide_winds()) all.push_back(*wind);
  return all;
}

std::set<int> FlightProblem::groups_with_flights() const {
  std::set<int> all;
  for (const auto* of : {&train_, &holdout_})
    for (const int i : *of) all.insert(trials_[std::size_t(i)].shot.group);
  return all;
}

/// Winds of the groups that are beyond what is declared of them.
std::optional<Location> FlightProblem::wide_winds() const {
  const double sd = case_.unknown.wind;
  double square = 0, count = 0;
  for (const int g : groups_with_flights()) square += group_[std::size_t(g)].head<2>().squaredNorm(), count += 2;
  if (!(sd > 0) || !(count > 0) ||
      square < sd * sd * boost::math::quantile(boost::math::complement(boost::math::chi_squared(count), kByChance)))
    return {};
  return Location{"", "",
                  fmt::format("the winds of the groups are {:.2g} m/s (RMS, each direction), {:.2g} m/s is declared",
                              std::sqrt(square / count), sd)};
}

/// The scatter is not what is declared of noise and unknowns, or too many flights are explained by nothing.
std::vector<Location> FlightProblem::doubts(const Selection& s) const {
  std::vector<Location> told;
  const Eigen::MatrixXd r = residuals(s.chosen.model, s.chosen.p);
  for (int c = 0; c < width(); ++c)
    if (const double ratio = scatter(c, r, s.chosen.size()).ratio; channel(c).trusted() && ratio > kWide)
      told.push_back({channel(c).name, "",
                      fmt::format("scatters {:.1f} times as much as declared noise and unknowns allow", ratio)});
  const Eigen::VectorXd z = loop::whitened(*this, Part::train, s.chosen.model, s.chosen.p);
  const solvers::Loss loss = stages().back().loss;
  double lost = double(flags_.size());
  for (std::size_t k = 0; k < train_.size(); ++k)
    lost += z.segment(Eigen::Index(k) * width(), width()).squaredNorm() > loss.cap;
  if (const double share = lost / double(flags_.size() + train_.size()); share >= kLost)
    told.push_back({"", "", fmt::format("{:.0f} % of the flights are flagged or explained by nothing", 100 * share)});
  return told;
}

NextExperiment FlightProblem::next_experiment(const LoopResult& so_far) const {
  if (too_few()) return {.text = "More flights"};
  if (so_far.verdict == Verdict::ambiguous) {
    const std::string sensor = fmt::format("{}", fmt::join(sensors_of(so_far.ties, case_.own), "; or "));
    return {.text = fmt::format("These flights cannot separate {}: measure {}",
                                fmt::join(so_far.ties | std::views::join, ", "), sensor),
            .sensor = sensor};
  }
  if (so_far.verdict == Verdict::unexplained) {
    if (!so_far.columns.empty())
      return {.text = fmt::format("First mend the file or the instrument, then run the loop again: {}",
                                  so_far.columns.front().text)};
    const auto l = std::ranges::find_if(so_far.unexplained, [](const Location& x) { return !x.regressor.empty(); });
    if (l == so_far.unexplained.end())
      return {
          .text = fmt::format("Measure the wind beside the flights, and note ball and instrument: {}",
                              so_far.unexplained.empty() ? "something remains" : so_far.unexplained.front().detail)};
    const std::string of = l->channel.empty() ? "a reading" : l->channel;
    if (l->regressor == "constant")
      return {.text = fmt::format("Check the zero of {} against another instrument: it is off in the mean", of)};
    const Column* column = case_.shots.find(l->regressor);
    if (l->regressor == "shot")
      return {.text = fmt::format(
                  "Note wind, temperature and ball for every flight: {} follows the order of the flights", of)};
    if (column && !column->numeric)
      return {
          .text = fmt::format("Measure what differs between the values of {} (wind, ground, ball): {} depends on it",
                              l->regressor, of)};
    return {.text = fmt::format("Measure flights that differ in {} alone, since {} depends on it as no candidate does",
                                l->regressor, of)};
  }
  if (so_far.verdict == Verdict::insufficient)
    return {.text = "More flights: the list of smallest effects says what these could have shown"};
  if (so_far.verdict == Verdict::noise_contradicted)
    return {.text = "Launch a ball ten times alike in still air, to find the instrument's own scatter"};
  if (so_far.adopted.empty())
    return {.text = "Nothing is tied. The list of smallest effects says what these flights could have shown"};
  return {.text = "Nothing is tied. Flights at other speeds and spins would narrow the parameters most"};
}

LoopResult run(const FlightCase& c) {
  FlightProblem problem(c);
  LoopResult result(c, c.shots.rows());
  result.unused = problem.unused();
  result.forms = problem.forms();
  result.notes = c.notes;
  std::vector<int> usable;
  for (const Problem::Row& row : problem.rows()) usable.push_back(row.row);
  std::ranges::sort(usable);
  std::optional<FlightColumns> columns;
  if (!problem.too_few()) columns.emplace(c, usable);
  if (columns) result.columns = columns->beyond_every_name();
  if (!result.columns.empty())
    std::erase_if(result.forms, [&](const Parametrisation& f) { return !std::ranges::count(c.effects, f.effect); });
  const Study study(problem, result.forms, c.effects, c.rules, c.told);
  if (columns && result.columns.empty()) {
    std::vector<const Fit*> rivals{&study.selection.chosen, &study.selection.richest};
    for (const Candidate& candidate : study.selection.candidates) rivals.push_back(&candidate.fit);
    if (rivals.size() > kRivals) rivals.resize(kRivals);
    result.columns = columns->contradicted(rivals);
  }
  conclude(study, result);
  return result;
}

}  // namespace hosel::loop
