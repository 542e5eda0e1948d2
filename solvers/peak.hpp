/// How large something got in a blow: one convention for all models.
#pragma once

#include <array>

namespace hosel::solvers {

/// Largest value of a quantity that is not negative, over the accepted steps: the vertex of the parabola through the
/// largest step and its two neighbours. The largest step alone would depend on the steps: of a half-sine pulse of
/// length T it is low by up to (pi h / 2T)^2 / 2, by 1 % with the eleven steps that an error control may take.
struct Peak {
  double value = 0;  ///< unit of what is added
  double time = 0;   ///< of the vertex; of the step where it is the first or the last

  /// Times must grow.
  void add(double t, double v) {
    times = {times[1], times[2], t};
    values = {values[1], values[2], v};
    if (v > value) value = v, time = t;
    if (++steps < 3 || values[1] < values[0] || values[1] <= values[2]) return;
    const double a = times[0] - times[1], b = times[2] - times[1];
    const double fa = values[0] - values[1], fb = values[2] - values[1];
    const double curvature = (fb / b - fa / a) / (b - a), slope = fa / a - curvature * a;
    const double vertex = values[1] - slope * slope / (4 * curvature);
    if (vertex > value) value = vertex, time = times[1] - slope / (2 * curvature);
  }

  // The last three steps, oldest first.
  std::array<double, 3> times = {}, values = {};
  int steps = 0;
};

}  // namespace hosel::solvers
