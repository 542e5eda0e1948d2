#include "loop/shots/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "golf/dense.hpp"
#include "loop/deviation.hpp"
#include "loop/shots/model.hpp"
#include "solvers/random.hpp"

namespace hosel::loop {
namespace {

/// The loft at which the closed form shows a launch angle.
double loft_of(Blow blow, double launch_angle) {
  constexpr double heavy = 1e3;  // kg m^2: of a head that the base does not let turn
  if (!blow.club.head.inertia.allFinite()) blow.club.head.inertia = heavy * Mat3::Identity();
  double& loft = blow.delivery.dynamic_loft;
  loft = launch_angle;
  for (int k = 0; k < 8; ++k) loft += (launch_angle - closed_form().launch(blow).launch_angle()) / kLaunchPerLoft;
  return loft;
}

}  // namespace

std::vector<double> session_order(const Shots& shots, const std::vector<int>& rows) {
  const Column* shot = shots.find("shot");
  const bool numbered = shot && shot->numeric &&
                        std::ranges::all_of(rows, [&](int row) { return std::isfinite(shot->value[row]); });
  std::vector<double> place;
  for (const int row : rows) place.push_back(numbered ? shot->value[row] : double(row));
  if (place.empty()) return place;
  if (const Column* by = sorted_by(shots); by && by->numeric) {
    // The session's order is lost. A drawn one shows nothing that the sorting makes.
    std::mt19937_64 random(1);
    const auto drawn = solvers::shuffled(place.size(), random);
    place.assign(drawn.begin(), drawn.end());
  }
  const auto [first, last] = std::ranges::minmax(place);
  for (double& x : place) x = last > first ? (x - first) / (last - first) : 0.0;
  return place;
}

double error_of(const Column& input, double declared) {
  return declared > 0 ? std::hypot(declared * input.si, rounding_deviation(input.resolution)) : 0;
}

Inputs make_inputs(const Shots& shots, const Blow& blow, bool head_mass_declared,
                   const std::map<std::string, double>& noise, bool loft_unknown) {
  Inputs in;
  std::array<const Column*, kInputs> column{};
  for (int k = 0; k < kInputs; ++k) column[k] = shots.find_stem(stem(Input(k)));
  if (loft_unknown) column[std::size_t(Input::dynamic_loft)] = nullptr;
  std::vector<std::pair<std::string_view, const Column*>> all_needed{
      {stem(Input::club_speed), column[std::size_t(Input::club_speed)]}};
  if (loft_unknown) all_needed.emplace_back(stem(Output::launch_angle), shots.find_stem(stem(Output::launch_angle)));
  else all_needed.emplace_back(stem(Input::dynamic_loft), column[std::size_t(Input::dynamic_loft)]);
  for (const auto& [name, needed] : all_needed)
    if (!needed) throw DataError(fmt::format("{}:1: no column {}_*", shots.file, name));
  const Column* mass = column[std::size_t(Input::head_mass)];
  if (!mass && !head_mass_declared)
    throw DataError(fmt::format("{}:1: no head mass: neither [head] mass_kg nor a column head_mass_*", shots.file));

  for (int k = 0; k < kInputs; ++k)
    if (!column[k] && k != int(Input::head_mass) && !(loft_unknown && Input(k) == Input::dynamic_loft))
      in.notes.push_back(fmt::format("no column {}: taken as zero", stem(Input(k))));

  std::array<int, kInputs> filled{};
  for (std::size_t i = 0; i < shots.rows(); ++i) {
    bool complete = true;
    for (const auto& [name, needed] : all_needed)
      if (complete && std::isnan(needed->value[i])) {
        ++in.unused[fmt::format("no {}", needed->name)];
        complete = false;
      }
    if (complete && mass && std::isnan(mass->value[i]) && !head_mass_declared) {
      ++in.unused["no " + mass->name];
      complete = false;
    }
    bool output = false;
    for (const Column& c : shots.columns)
      output = output || (c.role == Role::output && c.numeric && std::isfinite(c.value[i]));
    if (complete && !output) {
      ++in.unused["no launch recorded"];
      complete = false;
    }
    if (!complete) continue;
    const Column* wrong = nullptr;
    for (int k = 0; k < kInputs && !wrong; ++k)
      if (const Column* c = column[k])
        if (const double x = c->value[i]; x < quantity(Input(k)).low || x > quantity(Input(k)).high) wrong = c;
    if (wrong) {
      in.impossible.push_back(
          {int(i), wrong->name, fmt::format("{:g} is no value that a blow can have", wrong->native(i))});
      continue;
    }
    Shot t;
    t.blow = blow;
    for (int k = 0; k < kInputs; ++k)
      if (const Column* c = column[k]; c && std::isfinite(c->value[i])) set(t.blow, Input(k), c->value[i]);
    if (loft_unknown) t.blow.delivery.dynamic_loft = loft_of(t.blow, all_needed.back().second->value[i]);
    in.trials.push_back(t);
    in.row_of.push_back(int(i));
  }
  const std::size_t n = in.trials.size();
  if (!n) return in;

  const std::vector<double> order = session_order(shots, in.row_of);
  for (std::size_t i = 0; i < n; ++i) in.trials[i].order = order[i];

  // Robust centre and spread of every input.
  std::array<double, kInputs> centre{}, spread{}, sigma{};
  std::array<bool, kInputs> nominal{};
  bool any = false;
  for (int k = 0; k < kInputs; ++k) {
    const Column* c = column[k];
    if (!c) continue;
    std::vector<double> x;
    for (const int row : in.row_of)
      if (std::isfinite(c->value[row])) x.push_back(c->value[row]);
    if (x.empty()) continue;
    const auto [mid, mad] = robust_moments(x);
    const double fence = mad > 0 ? kFence * mad : kInfinity;
    double sum = 0, square = 0, count = 0;
    for (const double v : x)
      if (std::abs(v - mid) <= fence) {
        sum += v;
        ++count;
      }
    centre[k] = sum / count;
    for (const double v : x)
      if (std::abs(v - mid) <= fence) square += (v - sum / count) * (v - sum / count);
    spread[k] = count > 1 ? std::sqrt(square / (count - 1)) : 0;
    if (const auto it = noise.find(c->name); it != noise.end()) sigma[k] = error_of(*c, it->second);
    for (std::size_t i = 0; i < n; ++i)
      if (std::isnan(c->value[in.row_of[i]]) && k != int(Input::head_mass)) ++filled[k];
    any = any || sigma[k] > 0 || filled[k] > 0;
    // What was read with an error scatters at least by it: such a record says what was set, not what was.
    const double variance = spread[k] * spread[k], error = sigma[k] * sigma[k];
    nominal[k] = variance < error * std::max(0.1, 1 - 3 * std::sqrt(2 / count));
    if (nominal[k])
      in.notes.push_back(
          fmt::format("{}: its values differ by less than their declared error. Each is taken as a nominal value, from "
                      "which the true one differs by that error",
                      c->name));
  }
  for (int k = 0; k < kInputs; ++k)
    if (filled[k])
      in.notes.push_back(
          fmt::format("{}: {} missing values are inferred from the row's other inputs; these shots count as uncertain "
                      "by what those leave open",
                      column[k]->name, filled[k]));
  if (!any) return in;

  // Covariance of the record over the complete rows inside the fences, and what is left once the record is known.
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(kInputs, kInputs);
  double count = 0;
  const auto value = [&](std::size_t i, std::size_t k) { return column[k]->value[in.row_of[i]]; };
  const auto outside = [&](std::size_t i, std::size_t k) {
    return std::abs(value(i, k) - centre[k]) > 5 * spread[k];  // no: missing
  };
  const auto varies = [&](std::size_t k) { return column[k] && spread[k] > 0 && !nominal[k]; };
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(kInputs);
    bool inside = true;
    for (std::size_t k = 0; k < kInputs && inside; ++k) {
      if (!varies(k)) continue;
      inside = std::isfinite(value(i, k)) && !outside(i, k);
      if (inside) d[Eigen::Index(k)] = value(i, k) - centre[k];
    }
    if (!inside) continue;
    total += d * d.transpose();
    ++count;
  }
  if (count > 3 * kInputs) total /= count - 1;
  else {
    total.setZero();
    for (std::size_t k = 0; k < kInputs; ++k)
      if (varies(k)) total(Eigen::Index(k), Eigen::Index(k)) = spread[k] * spread[k];
  }
  // Only inputs with noise, or missing, are set to their expectation; the others are known and inform it.
  const Eigen::MatrixXd noise_cov = Eigen::Map<const Eigen::VectorXd>(sigma.data(), kInputs).cwiseAbs2().asDiagonal();
  Eigen::VectorXd unit(kInputs);
  for (int k = 0; k < kInputs; ++k) unit[k] = spread[k] > 0 ? spread[k] : 1;
  const Eigen::MatrixXd scaled_total = unit.cwiseInverse().asDiagonal() * total * unit.cwiseInverse().asDiagonal();
  Eigen::MatrixXd scaled_noise = unit.cwiseInverse().asDiagonal() * noise_cov * unit.cwiseInverse().asDiagonal();
  for (std::size_t k = 0; k < kInputs; ++k)
    if (nominal[k]) scaled_noise(Eigen::Index(k), Eigen::Index(k)) = 0;
  // True spread = total - noise, kept positive: where the noise is all there is, the record says nothing.
  const auto [values, vectors, converged] = dense::eigenpairs(scaled_total - scaled_noise);
  const Eigen::MatrixXd truth = vectors * values.cwiseMax(1e-9).asDiagonal() * vectors.transpose();
  in.covariance.assign(n, Eigen::MatrixXd::Zero(kInputs, kInputs));
  struct Expected {
    Eigen::MatrixXd gain, left;
  };
  std::map<std::vector<int>, Expected> of_record;  // by what is recorded
  for (std::size_t i = 0; i < n; ++i) {
    // Beside the others' spread their moments say nothing: such a record stands as it is, what it lacks is their mean.
    bool beside = false;
    for (std::size_t k = 0; k < kInputs && !beside; ++k) beside = varies(k) && outside(i, k);
    std::vector<int> recorded;
    for (std::size_t k = 0; k < kInputs && !beside; ++k)
      if (varies(k) && std::isfinite(value(i, k))) recorded.push_back(int(k));
    const auto m = std::ptrdiff_t(recorded.size());
    auto at = of_record.find(recorded);
    if (at == of_record.end()) {
      const Eigen::MatrixXd shared = truth(Eigen::all, recorded);
      const Eigen::MatrixXd record = truth(recorded, recorded) + scaled_noise(recorded, recorded) +
                                     1e-12 * Eigen::MatrixXd::Identity(m, m);
      const Eigen::MatrixXd gain = shared * dense::inverse(record);
      const Eigen::MatrixXd left = unit.asDiagonal() * Eigen::MatrixXd(truth - gain * shared.transpose()) *
                                   unit.asDiagonal();
      at = of_record.emplace(recorded, Expected{gain, left}).first;
    }
    const auto& [gain, left] = at->second;
    Eigen::VectorXd d(m);
    for (std::ptrdiff_t j = 0; j < m; ++j) {
      const auto k = std::size_t(recorded[j]);
      d[j] = (value(i, k) - centre[k]) / spread[k];
    }
    const Eigen::VectorXd best = gain * d;
    const auto missing = [&](std::size_t k) { return k != int(Input::head_mass) && !std::isfinite(value(i, k)); };
    for (std::size_t a = 0; a < kInputs; ++a) {
      if (!column[a] || !(missing(a) || sigma[a] > 0)) continue;
      const auto row = Eigen::Index(a);
      if (nominal[a] && missing(a)) set(in.trials[i].blow, Input(int(a)), centre[a]);
      if (nominal[a] || (beside && !missing(a))) {
        in.covariance[i](row, row) = noise_cov(row, row);
        continue;
      }
      set(in.trials[i].blow, Input(int(a)), centre[a] + unit[row] * best[row]);
      for (std::size_t b = 0; b < kInputs; ++b)
        if (column[b] && !nominal[b] && (missing(b) || (sigma[b] > 0 && !beside)))
          in.covariance[i](row, Eigen::Index(b)) = left(row, Eigen::Index(b));
    }
  }
  return in;
}

}  // namespace hosel::loop
