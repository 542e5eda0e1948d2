#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numeric>

#include "golf/dense.hpp"
#include "loop/flights/problem.hpp"
#include "loop/wrong_columns.hpp"

namespace hosel::loop {
namespace {

/// A flight that the others of its group do not foretell.
struct Stranger {
  int flight = 0;
  double squared = 0;        ///< squared distance of its readings from what the others foretell [standard deviations]
  Eigen::Index reading = 0;  ///< the one that is farthest off
};

/// Those of the flights of one group whose squared distance is beyond `limit` of their number of readings, the farthest
/// first. Each is judged by all others that are left, whatever their order, and leaves before the next is.
/// `factor`: L of the residuals' covariance; `of`: the flight of each residual.
template <class Limit>
std::vector<Stranger> strangers(const Eigen::MatrixXd& factor, Eigen::VectorXd residuals, std::vector<int> of,
                                const Limit& limit) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(factor.rows(), factor.cols());
  factor.triangularView<Eigen::Lower>().solveInPlace(P);
  P = (P.transpose() * P).eval();
  std::vector<Eigen::Index> place(of.size());  // of what is left, in the group
  std::iota(place.begin(), place.end(), Eigen::Index(0));
  std::vector<Stranger> all;
  while (!of.empty()) {
    const Eigen::VectorXd v = P * residuals;
    std::map<int, std::vector<Eigen::Index>> flights;
    for (std::size_t k = 0; k < of.size(); ++k) flights[of[k]].push_back(Eigen::Index(k));
    Stranger most;
    double excess = 1;
    for (const auto& [flight, own] : flights) {
      const Eigen::VectorXd vk = v(own);
      const double squared = vk.dot(dense::Cholesky(P(own, own)).solve(vk));
      if (!(squared > excess * limit(own.size()))) continue;
      excess = squared / limit(own.size());
      const Eigen::VectorXd off = vk.cwiseAbs().cwiseQuotient(P.diagonal()(own).cwiseSqrt());
      Eigen::Index worst = 0;
      off.maxCoeff(&worst);
      most = {flight, squared, place[std::size_t(own[std::size_t(worst)])]};
    }
    if (!(most.squared > 0)) break;
    all.push_back(most);
    std::vector<Eigen::Index> left;
    for (std::size_t k = 0; k < of.size(); ++k)
      if (of[k] != most.flight) left.push_back(Eigen::Index(k));
    // What is left without it: the inverse of a part of the covariance.
    const std::vector<Eigen::Index>& gone = flights[most.flight];
    const Eigen::MatrixXd across = P(gone, left);
    P = (P(left, left) - across.transpose() * dense::Cholesky(P(gone, gone)).solve(across)).eval();
    residuals = residuals(left).eval();
    for (std::size_t k = 0; k < left.size(); ++k) {
      of[k] = of[std::size_t(left[k])];
      place[k] = place[std::size_t(left[k])];
    }
    of.resize(left.size());
  }
  return all;
}

/// Slips of one number: another unit, the other sign, counted twice or once in two, a decimal point.
std::vector<ColumnSlip> slips_of_a_number(ColumnList columns) {
  std::vector<ColumnSlip> all = constant_slips(columns);
  std::erase_if(all, [](const ColumnSlip& s) { return s.second >= 0 || s.rows != 0; });
  for (int k = 0; k < int(columns.size()); ++k)
    for (const double factor : {2.0, 0.5, 10.0, 0.1})
      all.push_back({.finding = "scale", .column = k, .factor = factor});
  return all;
}

std::string as_if(const ColumnSlip& slip) {
  if (slip.finding == "unit") return "read in " + slip.what;
  if (slip.finding == "sign") return "of the other sign";
  return slip.factor == 2     ? "twice as large"
         : slip.factor == 0.5 ? "half as large"
                              : fmt::format("times {:g}", slip.factor);
}

}  // namespace

/// The one number of a flight that, read otherwise, makes the flight fit: its column, and a sentence. A few readings
/// fit by accident.
std::optional<std::pair<std::string, std::string>> FlightProblem::slip_of(int trial, const Fit& at) const {
  const Trial& t = trials_[std::size_t(trial)];
  std::vector<const Column*> columns;
  for (const Column& c : case_.shots.columns)
    if (c.numeric && c.role == Role::output && std::isfinite(c.value[std::size_t(t.row)])) columns.push_back(&c);
  std::vector<int> read;
  for (int c = 0; c < width(); ++c)
    if (std::isfinite(measured_(trial, c))) read.push_back(c);
  constexpr std::size_t fewest = 3;
  if (read.size() < fewest) return {};
  // About this launch: that of another speed or spin answers otherwise.
  const auto squared = [&](const Launch& launch, const Eigen::VectorXd& y) {
    Trial as = t;
    as.shot.launch = launch;
    as.shot.sd[models::kLogSpin] *= t.shot.launch.spin_rate() / launch.spin_rate();
    as.own = models::ShotUnknowns::Zero();
    slopes(as, GroupUnknowns::Zero(), at.model, at.p);
    Eigen::MatrixXd S = as.by_own * as.shot.sd.cwiseAbs2().asDiagonal() * as.by_own.transpose() +
                        as.by_group * group_sd().cwiseAbs2().asDiagonal() * as.by_group.transpose();
    S.diagonal() += noise().square().matrix();
    const Eigen::VectorXd e = predict(as, at.model, at.p.data(), as.own, GroupUnknowns::Zero()) - y, r = e(read);
    return r.allFinite() ? r.dot(dense::Cholesky(S(read, read)).solve(r)) : kInfinity;
  };
  const Eigen::VectorXd y = measured_.row(trial);
  struct Fits {
    double squared;
    std::string column, how;
  };
  std::vector<Fits> fits;
  const std::vector<ColumnSlip> slips = slips_of_a_number(columns);
  const boost::math::chi_squared by_chance{double(read.size())};
  const double most = std::min(boost::math::quantile(boost::math::complement(by_chance, kTold)),
                               squared(t.shot.launch, y) - 2 * std::log(double(slips.size())));
  Shots shots = case_.shots;
  for (const ColumnSlip& slip : slips) {
    const Column& column = *columns[std::size_t(slip.column)];
    double value = kInfinity;
    if (of_flight(*output_of(column.stem))) {
      Eigen::VectorXd right = y;
      for (const int c : read)
        if (channel(c).name == column.name) right[c] *= slip.factor;
      value = squared(t.shot.launch, right);
    } else {
      const auto there = std::ranges::find(shots.columns, column.name, &Column::name);
      there->value[std::size_t(t.row)] *= slip.factor;
      if (const auto launch = seen_launch(shots, std::size_t(t.row)); launch && launch->spin_rate() > 0)
        value = squared(*launch, y);
      there->value[std::size_t(t.row)] = column.value[std::size_t(t.row)];
    }
    if (value < most) fits.push_back({value, column.name, fmt::format("{} {}", column.name, as_if(slip))});
  }
  if (fits.empty()) return {};
  std::ranges::stable_sort(fits, {}, &Fits::squared);
  const Fits& best = fits.front();
  std::string told = fmt::format("with {}", best.how);
  for (const Fits& f : fits)
    if (f.column != best.column && f.squared < best.squared + case_.rules.tie) {
      told += fmt::format(", or {}", f.how);
      break;
    }
  return std::pair{best.column, told + ", the rest of the flight fits"};
}

/// Flights that no model of the family explains: beyond what the noise allows once in a hundred such sets.
bool FlightProblem::screen(const Selection& selection) {
  const Fit& at = selection.richest;
  std::set<int> now = out_;
  const double n = double(train_.size() + holdout_.size());
  const auto limit = [n, level = case_.rules.gate](std::size_t readings) {
    return boost::math::quantile(boost::math::complement(boost::math::chi_squared(double(readings)), level / n));
  };
  std::vector<Flag> flags = flags_;
  for (const Part part : {Part::train, Part::holdout}) {
    Eigen::MatrixXd e;
    if (trials(part).empty() || !errors(trials(part), at.model, at.p, e)) continue;
    for (const Block& b : blocks(part)) {
      std::vector<int> of;
      for (const auto& [flight, c] : b.readings) of.push_back(flight);
      for (const Stranger& s : strangers(b.factor, b.of(e), of, limit)) {
        const int i = b.trials[std::size_t(s.flight)];
        now.insert(i);
        const Trial& t = trials_[std::size_t(i)];
        const std::size_t line = case_.shots.line[std::size_t(t.row)];
        auto slip = slip_of(i, selection.base);  // what fits best may follow such flights
        if (!slip) slip = slip_of(i, at);
        if (slip) {
          flags.push_back({t.row, line, t.shot.id, slip->first, slip->second, int(flags.size()) + 1});
          continue;
        }
        flags.push_back(
            {t.row, line, t.shot.id, channel(b.readings[std::size_t(s.reading)].second).name,
             fmt::format("nothing explains this flight: {:.1f} standard deviations off", std::sqrt(s.squared)),
             int(flags.size()) + 1});
      }
    }
  }
  if (double(now.size()) > std::max(2.0, kMany * double(trials_.size()))) return true;  // no exceptions: not the rows
  const bool same = now.size() == out_.size();
  out_ = std::move(now);
  flags_ = std::move(flags);
  if (same) return true;
  std::erase_if(train_, [&](int i) { return out_.contains(i); });
  std::erase_if(holdout_, [&](int i) { return out_.contains(i); });
  factor();
  return false;
}

}  // namespace hosel::loop
