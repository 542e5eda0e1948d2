#include "loop/flights/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "golf/data_error.hpp"
#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "loop/deviation.hpp"
#include "loop/fit.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kMostLookedAt = 60;  // flights
constexpr int kReweighted = 6;             // times, in a robust fit,
constexpr int kLinearPasses = 3;           // and of its slopes

/// Readings of so many flights, evenly spread: the others have none.
FlightCase some_of(FlightCase c, const std::vector<int>& usable) {
  const std::vector<int> looked_at = evenly(usable, kMostLookedAt);
  for (std::size_t i = 0; i < c.shots.rows(); ++i) {
    if (std::ranges::count(looked_at, int(i))) continue;
    for (Column& column : c.shots.columns)
      if (const auto o = output_of(column.stem); column.numeric && o && of_flight(*o)) column.value[i] = kNaN;
    if (c.positions.size()) c.positions.row(Eigen::Index(i)).setConstant(kNaN);
  }
  c.split = {.holdout_fraction = 0};
  return c;
}

/// The values of `column` that are looked at as they would have to be read; a cell without one stays so. `recorded`,
/// `other`: of all rows.
void set_right(Column& column, const Column& recorded, const ColumnSlip& slip, const Column* other) {
  const auto n = std::ptrdiff_t(recorded.value.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double& x = column.value[std::size_t(i)];
    if (!std::isfinite(x)) continue;
    if (slip.finding == "swapped") {
      x = other->value[std::size_t(i)] * (recorded.si / other->si);
    } else if (slip.rows != 0) {
      const std::ptrdiff_t at = i + slip.rows;
      if (at >= 0 && at < n && std::isfinite(recorded.value[std::size_t(at)])) x = recorded.value[std::size_t(at)];
    } else {
      x = slip.factor * x + slip.offset;
    }
  }
}

/// A column of the launch: which unknown of a shot it is, and how far it may be off [SI].
struct OfLaunch {
  Output output;
  models::ShotUnknown unknown;
  double most, scale;
};
constexpr std::array kOfLaunch = {OfLaunch{Output::ball_speed, models::kOwnSpeed, 15, 0.5},
                                  OfLaunch{Output::launch_angle, models::kOwnAngle, 0.4, 0.01},
                                  OfLaunch{Output::azimuth, models::kOwnAzimuth, 0.4, 0.01},
                                  OfLaunch{Output::spin_rate, models::kLogSpin, 150, 5},
                                  OfLaunch{Output::spin_axis, models::kAxis, 0.4, 0.01}};

/// A launch whose record is off by a size, or by a share of it: as it was.
Parametrisation launch_as_it_was(const OfLaunch& of, bool share) {
  Parameter size{.name = "size", .unit = "1", .min = -of.most, .max = of.most, .scale = of.scale};
  if (share) size.min = -0.6, size.max = 1.5, size.scale = 0.02;
  Parametrisation form{.what = "reads otherwise", .parameters = {size}};
  form.seen = [of, share](std::span<const double> p, Launch& l) {
    const double more = share ? p[0] * get(l, of.output) : p[0];
    models::ShotUnknowns own = models::ShotUnknowns::Zero();
    own[of.unknown] = of.unknown == models::kLogSpin ? std::log(std::max(1e-3, 1 + more / l.spin_rate())) : more;
    l = models::launched(l, own);
  };
  return form;
}

/// A reading that shows so much more than there is, or such a share more. `off`: what the shots ask for.
Parametrisation shown_otherwise(Output of, bool share, double off, double noise) {
  const double wide = 4 * std::max(std::abs(off), noise);
  Parameter size{.name = "size", .unit = "1", .min = -wide, .max = wide, .scale = noise};
  if (share) size.min = -0.9, size.max = 9, size.scale = 0.01;
  Parametrisation form{.what = "reads otherwise", .parameters = {size}, .starts = {{off}}};
  form.reading = [of, share](std::span<const double> p, const Shot&, Output o, double x) {
    return o != of ? x : share ? (1 + p[0]) * x : x + p[0];
  };
  return form;
}

/// The least deviance of whitened residuals z + J p, and that p.
std::pair<double, Eigen::VectorXd> linear(const Eigen::VectorXd& z, const Eigen::MatrixXd& J,
                                          const solvers::Loss& loss) {
  std::pair<double, Eigen::VectorXd> best{loss.sum(z), Eigen::VectorXd::Zero(J.cols())};
  Eigen::VectorXd p = best.second, at = z, weight(z.size());
  for (int pass = 0; pass < kReweighted && J.cols(); ++pass) {
    for (Eigen::Index i = 0; i < z.size(); i += loss.block)
      weight.segment(i, loss.block).setConstant(loss.weight(at.segment(i, loss.block).squaredNorm()));
    Eigen::MatrixXd normal = J.transpose() * weight.asDiagonal() * J;
    normal.diagonal().array() += 1e-9;
    p -= dense::Ldlt(normal).solve(Eigen::VectorXd(J.transpose() * weight.cwiseProduct(at)));
    at = z + J * p;
    if (const double value = loss.sum(at); value < best.first) best = {value, p};
  }
  return best;
}

solvers::Loss loss_of(const FlightProblem& problem) { return problem.stages().back().loss.uncapped(); }

/// Whether a slip could be seen in a column: zeros are zeros in any unit. The answers to a noisy record are those of a
/// narrower one, by the share of noise in its variance and what else that share makes uncertain.
bool tells(const ColumnSlip& slip, const std::vector<double>& read, double noise) {
  if (slip.factor == 1) return true;
  if (std::ranges::all_of(read, [](double x) { return x == 0; })) return false;
  const Eigen::Map<const Eigen::ArrayXd> x(read.data(), Eigen::Index(read.size()));
  const double share = noise * noise / (x - x.mean()).square().mean();
  return slip.finding != "scale" || !(slip.factor < 1 && slip.factor > 1 - 2 * share);
}

std::vector<double> finite(const std::vector<double>& values) {
  std::vector<double> all;
  std::ranges::copy_if(values, std::back_inserter(all), [](double x) { return std::isfinite(x); });
  return all;
}

}  // namespace

FlightColumns::FlightColumns(const FlightCase& c, const std::vector<int>& usable)
    : given_(c), case_(some_of(c, usable)) {
  for (const Column& column : given_.shots.columns)
    if (column.numeric && column.role == Role::output && output_of(column.stem)) columns_.push_back(&column);
  problem_.emplace(case_, FlightProblem::About::record);
  forms_ = problem_->forms();
  const auto others = std::ranges::stable_partition(
      forms_, [&](const Parametrisation& f) { return std::ranges::count(case_.effects, f.effect) > 0; });
  for (const Parametrisation& f : forms_) {
    if (&f == others.data()) declared_ = effects_.size();
    effects_ = effects_.with(&f);
  }
  by_effects_ = by_effects(*problem_);
  recorded_ = deviance(*problem_, by_effects_, 0);
  scale_ = -2 * problem_->density(Part::train).log_whitening;
  lost_ = recorded_ - scale_ - beside_one(whitened(*problem_, Part::train, {}, {}), by_effects_, 0, 0).deviance;
  try_constants();
  try_sizes();
  std::ranges::stable_sort(slips_, {}, &ColumnSlip::criterion);
}

/// `price`: of an effect beside a slip, or alone, besides its parameters.
FlightColumns::Judged FlightColumns::beside_one(const Eigen::VectorXd& z, const Eigen::MatrixXd& J, Eigen::Index sizes,
                                                double price) const {
  const solvers::Loss loss = loss_of(*problem_);
  const Eigen::Index own = sizes + declared_;
  auto [least, p] = linear(z, J.leftCols(own), loss);
  Judged best{least, p.head(sizes)};
  Eigen::Index first = sizes;
  for (const Parametrisation* form : effects_.forms) {
    const auto n = Eigen::Index(form->parameters.size());
    first += n;
    if (first <= own) continue;  // declared
    Eigen::MatrixXd with(z.size(), own + n);
    with << J.leftCols(own), J.middleCols(first - n, n);
    std::tie(least, p) = linear(z, with, loss);
    bool plausible = true;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Parameter& q = form->parameters[std::size_t(k)];
      const double size = p[own + k] * q.scale;
      plausible = plausible && size > q.min && size < q.max;
    }
    least += case_.rules.parameter_cost * double(n) + price;
    if (plausible && least < best.deviance) best = {least, p.head(sizes)};
  }
  return best;
}

/// Beside the likeliest effect, with the density's scale; a launch that no ball flies counts as far off.
double FlightColumns::deviance(const FlightProblem& problem, const Eigen::MatrixXd& by_effects, double price) const {
  const Eigen::VectorXd z = whitened(problem, Part::train, {}, {});
  if (!z.size() || z.size() != by_effects.rows()) return kInfinity;
  const auto lost = problem.unused().find(FlightProblem::kNoFlight);
  const double impossible = lost == problem.unused().end() ? 0 : lost->second;
  return beside_one(z, by_effects, 0, price).deviance +
         impossible * loss_of(problem)(std::pow(kNoBlow, 2) * problem.width()) -
         2 * problem.density(Part::train).log_whitening;
}

Eigen::MatrixXd FlightColumns::by_effects(const FlightProblem& problem) const {
  return problem.jacobian(Part::train, effects_, Eigen::VectorXd::Zero(effects_.size()));
}

void FlightColumns::try_constants() {
  std::vector<ColumnSlip> all = constant_slips(columns_);
  for (int k = 0; k < int(columns_.size()); ++k)
    if (columns_[std::size_t(k)]->stem == stem(Output::spin_rate))
      for (const double factor : {2.0, 0.5})
        all.push_back({.finding = "scale", .column = k, .factor = factor, .cost = 2});
  for_all(std::size_t(0), all.size(), [&](std::size_t k) {
    ColumnSlip& slip = all[k];
    slip.deviance = kInfinity;
    FlightCase right = case_;
    double density = 0;
    bool launch = false;
    for (const auto& [column, other] : {std::pair{slip.column, slip.second}, {slip.second, slip.column}}) {
      if (column < 0) continue;
      const Column& recorded = *columns_[std::size_t(column)];
      Column& at = *std::ranges::find(right.shots.columns, recorded.name, &Column::name);
      const std::vector<double> read = finite(at.value);
      if (!tells(slip, read, 0)) return;
      set_right(at, recorded, slip, other < 0 ? nullptr : columns_[std::size_t(other)]);
      const bool shown = of_flight(*output_of(recorded.stem));
      launch = launch || !shown;
      // The density of the written numbers. Beside a declared noise a wider one earns nothing: it is no evidence.
      const double per_reading = std::log(std::abs(slip.factor));
      if (!shown) continue;
      density += double(problem_->measured().col(channel_of(recorded)).array().isFinite().count()) *
                 (case_.noise.contains(recorded.name) ? std::min(0.0, per_reading) : per_reading);
    }
    try {
      FlightProblem problem = launch ? FlightProblem(right, FlightProblem::About::record)
                                     : problem_->with_readings(right);
      if (slip.finding != "unit") problem.hold_noise(*problem_);  // a wrong unit widens what is estimated
      const bool anew = launch || (problem.noise() != problem_->noise()).any();
      slip.deviance = deviance(problem, anew ? by_effects(problem) : by_effects_, case_.rules.further_gain) -
                      2 * density;
    } catch (const DataError&) {}  // no launch is left, or no flight
  });
  std::ranges::move(all, std::back_inserter(slips_));
}

int FlightColumns::channel_of(const Column& column) const {
  int c = 0;
  while (problem_->channel(c).name != column.name) ++c;
  return c;
}

/// Whether the launch is taken from this column: not where the spin is recorded by its components.
bool FlightColumns::reads_launch(Output output) const {
  return !((output == Output::spin_rate || output == Output::spin_axis) &&
           given_.shots.find_stem(stem(Output::backspin)));
}

/// Offset and scale of every column, the likeliest effect beside them.
void FlightColumns::try_sizes() {
  const Eigen::MatrixXd r = problem_->residuals({}, {});
  std::vector<ColumnSlip> all;
  for (int k = 0; k < int(columns_.size()); ++k) {
    all.push_back({.finding = "offset", .column = k, .cost = 8});
    all.push_back({.finding = "scale", .column = k, .cost = 9});
  }
  for_all(std::size_t(0), all.size(), [&](std::size_t k) {
    ColumnSlip& slip = all[k];
    slip.deviance = kInfinity;
    const Column& column = *columns_[std::size_t(slip.column)];
    const Output output = *output_of(column.stem);
    const bool share = slip.finding == "scale", shown = of_flight(output);
    Parametrisation form;
    if (shown) {
      const int c = channel_of(column);
      std::vector<double> off;
      for (Eigen::Index i = 0; i < r.rows(); ++i)
        if (const double y = problem_->measured()(i, c); std::isfinite(y) && r(i, c) + y != 0)
          off.push_back(share ? -r(i, c) / (r(i, c) + y) : -r(i, c) * column.si);
      if (off.empty()) return;
      form = shown_otherwise(output, share, median(off), problem_->channel(c).noise * column.si);
    } else if (const auto of = std::ranges::find(kOfLaunch, output, &OfLaunch::output);
               of != kOfLaunch.end() && reads_launch(output)) {
      form = launch_as_it_was(*of, share);
    } else {
      return;
    }
    const Model alone{{&form}};
    const Parameter& q = form.parameters.front();
    Eigen::VectorXd size(1);
    for (Eigen::VectorXd p : starts(alone))
      for (int pass = 0; pass <= kLinearPasses && !q.at_edge(p[0]); ++pass) {
        const Eigen::VectorXd z = whitened(*problem_, Part::train, alone, p);
        if (z.size() != by_effects_.rows()) break;
        const double here = scale_ + lost_ + beside_one(z, by_effects_, 0, case_.rules.further_gain).deviance;
        if (here < slip.deviance) slip.deviance = here, size = p;
        Eigen::MatrixXd J(z.size(), 1 + effects_.size());
        J << problem_->jacobian(Part::train, alone, p), by_effects_;
        p[0] = std::clamp(p[0] + beside_one(z, J, 1, case_.rules.further_gain).step[0] * q.scale, q.min, q.max);
      }
    if (!std::isfinite(slip.deviance)) return;
    if (share) slip.factor = shown ? 1 / (1 + size[0]) : 1 + size[0];
    else slip.offset = shown ? -size[0] : size[0];
    const auto noise = case_.noise.find(column.name);
    if (!shown && noise != case_.noise.end() && !tells(slip, finite(column.value), noise->second * column.si))
      slip.deviance = kInfinity;
  });
  std::ranges::move(all, std::back_inserter(slips_));
}

/// The least criterion of the likeliest rivals, fitted to the flights that slips are tried on.
double FlightColumns::library(const std::vector<const Fit*>& rivals) const {
  std::vector<double> found(rivals.size(), kInfinity);
  for_all(std::size_t(0), rivals.size(), [&](std::size_t k) {
    const Model& m = rivals[k]->model;
    const double names = double(m.forms.size()) - double(case_.effects.size());
    const auto z = [&](const Eigen::VectorXd& p, Eigen::VectorXd& out) {
      return problem_->whitened(Part::train, m, p, out);
    };
    found[k] = scale_ + lost_ + case_.rules.parameter_cost * (m.size() - double(declared_)) +
               case_.rules.further_gain * std::max(0.0, names - 1) +
               refitted(m, rivals[k]->p, int(problem_->measured().size()), loss_of(*problem_), z).deviance;
  });
  found.push_back(recorded_);
  return std::ranges::min(found);
}

std::vector<WrongColumn> FlightColumns::judged(double library) const {
  const double values = problem_->density(Part::train).values;
  return told(columns_, slips_, case_.rules.tie,
              [&](const ColumnSlip& s) { return contradicts(s, recorded_, library, scale_, values, case_.rules.tie); });
}

std::vector<WrongColumn> FlightColumns::contradicted(const std::vector<const Fit*>& rivals) const {
  if (slips_.empty() || judged(recorded_).empty()) return {};
  return judged(library(rivals));
}

std::vector<WrongColumn> FlightColumns::beyond_every_name() const {
  if (slips_.empty() || judged(recorded_).empty()) return {};
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(effects_.size()),
                        recorded = whitened(*problem_, Part::train, {}, {});
  const auto z = [&](const Eigen::VectorXd& p, Eigen::VectorXd& out) {
    return problem_->whitened(Part::train, effects_, p, out);
  };
  const double one = beside_one(recorded, by_effects_, 0, 0).deviance,
               all = std::min(linear(recorded, by_effects_, loss_of(*problem_)).first,
                              refitted(effects_, none, int(recorded.size()), loss_of(*problem_), z).deviance);
  return judged(recorded_ + std::min(0.0, all - one));
}

}  // namespace hosel::loop
