#include "models/flight/flight_budget.hpp"

#include <cmath>

namespace hosel::models {
namespace {

/// Variance of every answer from one source.
FlightAnswers variance(const Launch& l, const FlightJacobian& by, const LaunchError& e) {
  // All three components go with the rate; the axis' tilt turns the two across the path.
  const double tilt = l.spin_axis(), rate = l.spin_rate(), across = std::hypot(l.backspin(), l.sidespin());
  const FlightAnswers turned = std::cos(tilt) * by.col(kBackspin) + std::sin(tilt) * by.col(kSidespin),
                      along_rate = (across * turned + l.riflespin() * by.col(kRiflespin)) / rate,
                      along_axis = across * (std::cos(tilt) * by.col(kSidespin) - std::sin(tilt) * by.col(kBackspin));
  FlightAnswers out = FlightAnswers::Zero();
  const auto add = [&](const FlightAnswers& slope, double sd) { out += (sd * slope).cwiseAbs2(); };
  add(by.col(kBallSpeed), e.ball_speed);
  add(by.col(kLaunchAngle), e.launch_angle);
  add(by.col(kAzimuth), e.azimuth);
  add(by.col(kBackspin), e.backspin);
  add(by.col(kSidespin), e.sidespin);
  add(by.col(kRiflespin), e.riflespin);
  add(along_rate, e.spin_rate);
  add(along_axis, e.spin_axis);
  return out;
}

/// By the covariance of the law's coefficients, with central differences a tenth of a standard deviation to each side.
FlightAnswers by_law(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                     const FlightOptions& options) {
  constexpr int n = kInferredCoefficients;
  const Eigen::Map<const Eigen::Matrix<double, n, n>> covariance(conditions.law.covariance.data());
  Eigen::Matrix<double, kFlightAnswers, n> by = decltype(by)::Zero();
  const FlightOptions exact{.tolerance = 1e-3 * options.tolerance};
  for (int k = 0; k < n; ++k) {
    const double h = 0.1 * std::sqrt(covariance(k, k));
    if (!(h > 0)) continue;  // told otherwise
    const auto at = [&](double side) {
      FlightConditions c = conditions;
      inferred_coefficient(c.law, k) += side * h;
      return answers(fly(launch, ball, c, exact));
    };
    by.col(k) = (at(1) - at(-1)) / (2 * h);
  }
  return (by * covariance * by.transpose()).diagonal().cwiseSqrt();
}

}  // namespace

FlightAnswers answers(const Flight& f) { return {f.carry, f.side, f.apex, f.time, f.landing_angle}; }

FlightBudget flight_budget(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                           const FlightOptions& options, const std::vector<LaunchError>& errors,
                           const std::vector<FlightLaw>& others) {
  FlightBudget out;
  const Flight flight = fly(launch, ball, conditions, {.tolerance = options.tolerance});
  out.value = answers(flight);
  out.outside = flight.outside;
  out.numerical =
      (answers(fly(launch, ball, conditions, {.tolerance = 1e-4 * options.tolerance})) - out.value).cwiseAbs();
  FlightAnswers total = FlightAnswers::Zero();
  if (!errors.empty()) {
    const FlightJacobian by = flight_jacobian(launch, ball, conditions, options);
    for (const LaunchError& e : errors) {
      const FlightAnswers square = variance(launch, by, e);
      out.launch.push_back(square.cwiseSqrt());
      total += square;
    }
  }
  out.launch_total = total.cwiseSqrt();
  if (!conditions.law.covariance.empty()) out.law = by_law(launch, ball, conditions, options);
  for (const FlightLaw& law : others) {
    FlightConditions c = conditions;
    c.law = law;
    const Flight f = fly(launch, ball, c, {.tolerance = options.tolerance});
    out.laws.push_back({law.name, answers(f), f.outside});
  }
  return out;
}

}  // namespace hosel::models
