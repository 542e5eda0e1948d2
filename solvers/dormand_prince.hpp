/// Ordinary differential equations that are smooth in pieces and not stiff, of a size known when compiled.
#pragma once

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <cstddef>
#include <utility>

#include "solvers/errors.hpp"

namespace hosel::solvers {

/// Fifth order with an error estimate of the fourth, an answer of the fourth at any time inside the last step. The
/// formulas are those of Boost.Odeint, the choice of steps is ours: the largest error of a component against its
/// tolerance. No step goes across a corner of the rate: `piece(y)` numbers the parts in which it is smooth, and
/// `rate(y, dy, piece)` is the rate of one, also a little beyond its edge.
/// Source: Dormand and Prince (1980), J. Comput. Appl. Math. 6:19.
template <std::size_t N, class Rate, class Piece>
class DormandPrince {
 public:
  using State = std::array<double, N>;

  /// An error of a component counts against `relative` times its size plus its `absolute`.
  DormandPrince(Rate rate, Piece piece, double relative, const State& absolute)
      : rate_(std::move(rate)), piece_of_(std::move(piece)), relative_(relative), absolute_(absolute) {}

  /// From here on. `first` is tried as the first step.
  void start(double t, const State& y, double first) {
    piece_ = next_piece_ = piece_of_(y);
    to_ = {t, y, {}};
    rate_(to_.y, to_.slope, piece_);
    from_ = to_;
    next_ = first;
    steps = 0;
  }

  /// One step on, at most to `latest`. Throws NonConvergence where it would have to be shorter than 1e-13 of the time.
  void step(double latest) {
    from_ = to_;
    if (next_piece_ != piece_) {
      piece_ = next_piece_;
      rate_(from_.y, from_.slope, piece_);
    }
    for (;;) {
      const bool last = next_ >= (latest - from_.t) * (1 - 1e-9);  // no sliver remains
      const double h = last ? latest - from_.t : next_;
      if (!(h > 1e-13 * std::max(1.0, from_.t)))
        throw NonConvergence("Dormand and Prince: the step has shrunk to nothing");
      const double error = take(h);
      // Of the fifth order; a margin, and no jumps. What is not finite fails.
      const double change = std::isfinite(error) ? 0.9 * std::pow(std::max(error, 1e-10), -0.2) : 0;
      next_ = h * std::clamp(change, 0.2, error <= 1 ? 5.0 : 0.9);
      if (!(error <= 1)) continue;
      if (last) to_.t = latest;  // the sum of start and step may miss it by rounding
      break;
    }
    ++steps;
    stop_at_corner();
  }

  /// The last step once more, only to a time inside it.
  void retake(double t) { take(t - from_.t); }

  double time() const { return to_.t; }
  const State& state() const { return to_.y; }
  double before() const { return from_.t; }              ///< where the last step began
  const State& state_before() const { return from_.y; }  ///< there
  /// At a time inside the last step.
  State at(double t) const {
    State y;
    stepper_.calc_state(t, y, from_.y, from_.slope, from_.t, to_.y, to_.slope, to_.t);
    return y;
  }

  long steps = 0;  ///< since start()

 private:
  struct Node {
    double t = 0;
    State y{}, slope{};
  };

  /// From `from_` by h; the error in units of the tolerance.
  double take(double h) {
    State error;
    stepper_.do_step([this](const State& y, State& dy, double) { rate_(y, dy, piece_); }, from_.y, from_.slope, from_.t,
                     to_.y, to_.slope, h, error);
    to_.t = from_.t + h;
    double most = 0;
    for (std::size_t i = 0; i < N; ++i) {
      const double size = std::max(std::abs(from_.y[i]), std::abs(to_.y[i]));
      const double e = std::abs(error[i]) / (relative_ * size + absolute_[i]);
      if (std::isnan(e)) return e;
      most = std::max(most, e);
    }
    return most;
  }

  /// Where the step leaves its piece: back to there. Seen at its quarters, since it may come back.
  void stop_at_corner() {
    constexpr int parts = 4;
    // This long by the wrong formulas costs its square, since the rate has a corner and no jump.
    constexpr double close = 1e-7;
    const double h = to_.t - from_.t;
    for (int k = 1; k <= parts; ++k) {
      double low = from_.t + h * (k - 1) / parts, high = k == parts ? to_.t : from_.t + h * k / parts;
      if (piece_of_(k == parts ? to_.y : at(high)) == piece_) continue;
      while (high - low > close) {
        const double middle = 0.5 * (low + high);
        (piece_of_(at(middle)) == piece_ ? low : high) = middle;
      }
      next_piece_ = piece_of_(at(high));
      if (high < to_.t) take(high - from_.t);
      return;
    }
  }

  Rate rate_;
  Piece piece_of_;
  double relative_, next_ = 0;
  State absolute_;
  Node from_, to_;
  long piece_ = 0, next_piece_ = 0;  ///< of the last step, of the next
  boost::numeric::odeint::runge_kutta_dopri5<State, double, State, double, boost::numeric::odeint::array_algebra>
      stepper_;
};

}  // namespace hosel::solvers
