/// A linearly implicit one-step method for mildly stiff systems whose stiffness sits in a small block.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "solvers/errors.hpp"

namespace hosel::solvers {

struct RosenbrockStatistics {
  long steps = 0, rejected = 0, rate_calls = 0;
};

/// ROS34PW2: four stages, order 3 with embedded order 2, L-stable, and of order 3 whatever matrix A
/// stands for the Jacobian (a W-method), so that A need hold the stiff block alone.
/// Source: Rang and Angermann (2005), BIT 45:761, table 4; order conditions in the tests.
///
/// System offers
///   int size() const;
///   void rate(const double* y, double* dy);           // y' = f(y)
///   void linearise(const double* y);                  // chooses A here
///   void solve(double s, double* x);                  // x := (1 - s A)^-1 x
///   double scale(int i) const;                        // size of component i; 0: no error control
///   double gap(const double* y);                      // the event: falls through zero
template <class System>
class RosenbrockW {
 public:
  explicit RosenbrockW(System& system) : s_(system), n_(system.size()), k_(n_, 4), y_(n_), work_(n_), next_(n_) {
    weight_.resize(n_);
    for (int m = 0; m < n_; ++m) weight_[m] = s_.scale(m) > 0 ? 1 / s_.scale(m) : 0;
  }

  /// Advances `y` from 0 until the event; returns its time. Throws NonConvergence where the step
  /// shrinks below `latest` * 1e-12 or the event does not come before `latest`.
  template <class Watch>
  double run(double* y, double first_step, double latest, double tolerance, double event_tolerance, Watch&& watch) {
    double t = 0, h = first_step;
    while (true) {
      if (!(h > latest * 1e-12)) throw NonConvergence("rosenbrock: the step has shrunk to nothing");
      if (t > latest) throw NonConvergence("rosenbrock: the event did not come in time");
      s_.linearise(y);
      const double err = step(y, h) / tolerance;
      if (!(err <= 1)) {
        ++statistics.rejected;
        h *= std::isfinite(err) ? std::clamp(0.9 / std::cbrt(err), 0.2, 0.9) : 0.2;
        continue;
      }
      ++statistics.steps;
      if (const double after = s_.gap(next_.data()); after <= 0) {
        h = step_to_event(y, h, s_.gap(y), after, event_tolerance);
        std::copy(next_.begin(), next_.end(), y);
        watch(t + h, y);
        return t + h;
      }
      t += h;
      std::copy(next_.begin(), next_.end(), y);
      watch(t, y);
      h *= std::clamp(0.9 / std::cbrt(std::max(err, 1e-9)), 0.3, 3.0);
    }
  }

  /// One step of size h from y into next(); returns the error estimate in units of the scales.
  double step(const double* y, double h) {
    static constexpr double g = 0.43586652150845900;
    static constexpr double a[4][3] = {
        {}, {0.87173304301691801, 0, 0}, {0.84457060015369423, -0.11299064236484185, 0}, {0, 0, 1}};
    static constexpr double c[4][3] = {{},
                                       {-0.87173304301691801, 0, 0},
                                       {-0.90338057013044082, 0.054180672388095326, 0},
                                       {0.24212380706095346, -1.2232505839045147, 0.54526025533510214}};
    static constexpr double b[4] = {0.24212380706095346, -1.2232505839045147, 1.5452602553351020, 0.43586652150845900};
    static constexpr double d[4] = {b[0] - 0.37810903145819369, b[1] + 0.096042292212423178, b[2] - 0.5,
                                    b[3] - 0.21793326075422950};
    const Eigen::Map<const Eigen::VectorXd> start(y, n_);
    for (int i = 0; i < 4; ++i) {
      double* k = k_.col(i).data();
      if (i == 0) {
        s_.rate(y, k);
        s_.solve(h * g, k);
        continue;
      }
      y_ = start + (h * a[i][0]) * k_.col(0);
      work_ = (c[i][0] / g) * k_.col(0);
      for (int j = 1; j < i; ++j) {
        y_ += (h * a[i][j]) * k_.col(j);
        work_ += (c[i][j] / g) * k_.col(j);
      }
      // (1 - h g A) k = f + h A sum(c k)  <=>  (1 - h g A)(k + w) = f + w with w = sum(c k) / g.
      s_.rate(y_.data(), k);
      k_.col(i) += work_;
      s_.solve(h * g, k);
      k_.col(i) -= work_;
    }
    statistics.rate_calls += 4;
    next_ = start + h * (b[0] * k_.col(0) + b[1] * k_.col(1) + b[2] * k_.col(2) + b[3] * k_.col(3));
    work_ = d[0] * k_.col(0) + d[1] * k_.col(1) + d[2] * k_.col(2) + d[3] * k_.col(3);
    return std::isfinite(next_.sum()) ? h * work_.cwiseProduct(weight_).cwiseAbs().maxCoeff() : INFINITY;
  }
  const double* next() const { return next_.data(); }

  RosenbrockStatistics statistics;

 private:
  /// The step that ends on the event: secant method on the step size, kept inside the bracket.
  double step_to_event(const double* y, double h, double before, double after, double tolerance) {
    double low = 0, high = h, last = 0, f_last = before, f = after;
    for (int i = 0; i < 60 && std::abs(f) > tolerance; ++i) {
      double to = h - f * (h - last) / (f - f_last);
      if (!(to > low && to < high)) to = 0.5 * (low + high);
      last = h;
      f_last = f;
      h = to;
      step(y, h);
      f = s_.gap(next_.data());
      (f > 0 ? low : high) = h;
    }
    return h;
  }

  System& s_;
  int n_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> k_;
  Eigen::VectorXd y_, work_, next_, weight_;  // weight: one over the size of a component, 0: no error control
};

}  // namespace hosel::solvers
