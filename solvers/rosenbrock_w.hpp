/// A linearly implicit one-step method for mildly stiff systems whose stiffness sits in a small block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "golf/lanes.hpp"
#include "solvers/errors.hpp"

namespace hosel::solvers {

struct RosenbrockStatistics {
  long steps = 0, rejected = 0, rate_calls = 0;
};

struct RosenbrockOptions {
  double first_step = 0;
  double latest = 0;           ///< the event must come before; a step below 1e-12 of it counts as nothing
  double tolerance = 1e-4;     ///< error of a step in units of the scales
  double event_tolerance = 0;  ///< in the unit of the event's gap
};

/// ROS34PW2: four stages, order 3 with embedded order 2, L-stable, and of order 3 whatever matrix A
/// stands for the Jacobian (a W-method), so that A need hold the stiff block alone.
/// Source: Rang and Angermann (2005), BIT 45:761, table 4; order conditions in the tests.
///
/// Several problems of one system go side by side where its scalar has lanes (golf/lanes.hpp): each lane has its own
/// time, step and event, and a lane that has ended takes the next problem. A problem's steps do not depend on its
/// neighbours.
///
/// System offers
///   using Scalar;                                                // double, or Pack
///   struct Instant;                                              // what rates and event share at one state
///   void Instant::take(const Instant& other, Mask lanes);        // those lanes of the other
///   int size() const;
///   void at(const Scalar* y, Instant& i) const;
///   void rate(const Scalar* y, const Instant& i, Scalar* dy) const;  // y' = f(y)
///   void linearise(const Instant& i);                            // chooses A here
///   void factor(const Scalar& s);                                // of 1 - s A
///   void solve(Scalar* x) const;                                 // x := (1 - s A)^-1 x
///   Scalar scale(int i) const;                                   // size of component i; 0: no error control
///   Scalar gap(const Instant& i) const;                          // the event: falls through zero
template <class System>
class RosenbrockW {
 public:
  using Scalar = typename System::Scalar;
  using Instant = typename System::Instant;
  static constexpr int kWidth = LaneTraits<Scalar>::count;

  explicit RosenbrockW(System& system) : s_(system), n_(static_cast<std::size_t>(system.size())) {
    for (auto* v : {&k_[0], &k_[1], &k_[2], &k_[3], &y_, &stage_, &work_, &next_, &weight_}) v->resize(n_, Scalar(0));
  }

  /// Advances problems from time 0 to their events.
  ///   bool take(int lane, Scalar* y)   gives the lane its next problem and its start; false: none is left
  ///   void watch(int lane, double t, const Instant& i)   at the start and after every step
  ///   void end(int lane, double t, const Scalar* y, const RosenbrockStatistics& of, const char* failure)
  /// `failure`: nullptr, or why there is no event: the step has shrunk to nothing, or `latest` is over.
  template <class Take, class Watch, class End>
  void run(const RosenbrockOptions& o, Take&& take, Watch&& watch, End&& end) {
    using Mask = typename LaneTraits<Scalar>::Mask;
    lanes_ = {};
    Instant start, now;
    bool begun = false, any_left = true;
    const auto refill = [&] {
      Mask fresh{};
      bool some = false;
      for (int l = 0; l < kWidth; ++l)
        if (!lanes_[l].busy && any_left) {
          any_left = take(l, y_.data());
          if (!any_left) break;
          lanes_[l] = {.busy = true, .step = o.first_step};
          set_lane(fresh, l, true);
          some = true;
        }
      if (!some) return;
      for (std::size_t m = 0; m < n_; ++m) {
        const Scalar size = s_.scale(int(m));
        weight_[m] = select(size > 0, 1 / size, Scalar(0));
      }
      s_.at(y_.data(), now);
      if (begun) start.take(now, fresh);
      else start = now;
      begun = true;
      for (int l = 0; l < kWidth; ++l)
        if (lane(fresh, l)) watch(l, 0.0, start);
    };
    refill();
    while (std::any_of(lanes_.begin(), lanes_.end(), [](const Lane& l) { return l.busy; })) {
      Scalar h = 0;  // a lane without a problem stands still
      for (int l = 0; l < kWidth; ++l) set_lane(h, l, lanes_[l].busy ? lanes_[l].step : 0);
      s_.linearise(start);
      const Scalar error = step(start, h);
      s_.at(next_.data(), now);
      const Scalar gap = s_.gap(now), gap_before = s_.gap(start);
      Mask moved{};
      std::array<const char*, kWidth> failure{};
      std::array<bool, kWidth> ended{};
      for (int l = 0; l < kWidth; ++l) {
        Lane& a = lanes_[l];
        if (!a.busy) continue;
        a.of.rate_calls += 4;
        const double f = lane(gap, l);
        if (!a.closing) {
          const double e = lane(error, l) / o.tolerance;
          if (!(e <= 1)) {
            ++a.of.rejected;
            a.step *= std::isfinite(e) ? std::clamp(0.9 / std::cbrt(e), 0.2, 0.9) : 0.2;
          } else {
            ++a.of.steps;
            if (f > 0) {
              set_lane(moved, l, true);
              a.time += a.step;
              a.step *= std::clamp(0.9 / std::cbrt(std::max(e, 1e-9)), 0.3, 3.0);
            } else {
              a.closing = true;
              a.high = a.step;
              a.f_last = lane(gap_before, l);
            }
          }
          if (!a.closing) {
            if (!(a.step > o.latest * 1e-12)) failure[l] = "the step has shrunk to nothing";
            else if (a.time > o.latest) failure[l] = "the event did not come in time";
          }
        } else {
          (f > 0 ? a.low : a.high) = a.step;
        }
        if (a.closing) {
          // The step that ends on the event: secant method on the step size, kept inside the bracket.
          const bool last = a.tries++ == 60;
          if (last && !std::isfinite(f)) {
            failure[l] = "the gap at the event is no number";
          } else if (last || std::abs(f) <= o.event_tolerance) {
            set_lane(moved, l, true);
            ended[l] = true;
            a.time += a.step;
          } else {
            double to = a.step - f * (a.step - a.last) / (f - a.f_last);
            if (!(to > a.low && to < a.high)) to = 0.5 * (a.low + a.high);
            a.last = a.step;
            a.f_last = f;
            a.step = to;
          }
        }
      }
      if (any(moved)) {
        for (std::size_t m = 0; m < n_; ++m) replace(moved, y_[m], next_[m]);
        start.take(now, moved);
      }
      bool some_ended = false;
      for (int l = 0; l < kWidth; ++l) {
        if (lane(moved, l)) watch(l, lanes_[l].time, start);
        if (!ended[l] && !failure[l]) continue;
        end(l, lanes_[l].time, y_.data(), lanes_[l].of, failure[l]);
        lanes_[l].busy = false;
        some_ended = true;
      }
      if (some_ended) refill();
    }
  }

  /// One problem of a system of numbers: advances `y` to the event, and returns its time. watch(t, y).
  template <class Watch>
  double run(double* y, const RosenbrockOptions& o, Watch&& watch) requires(kWidth == 1) {
    bool taken = false;
    double time = 0;
    const char* why = nullptr;
    run(
        o,
        [&](int, double* to) {
          if (std::exchange(taken, true)) return false;
          std::copy_n(y, n_, to);
          return true;
        },
        [&](int, double t, const Instant&) { watch(t, y_.data()); },
        [&](int, double t, const double* at, const RosenbrockStatistics&, const char* failure) {
          std::copy_n(at, n_, y);
          time = t;
          why = failure;
        });
    if (why) throw NonConvergence(std::string("rosenbrock: ") + why);
    return time;
  }

 private:
  struct Lane {
    bool busy = false;
    double time = 0, step = 0;
    // The event lies in the last step.
    bool closing = false;
    double low = 0, high = 0, last = 0, f_last = 0;
    int tries = 0;
    RosenbrockStatistics of;
  };

  /// One step of size h from y_ into next_; returns the error estimate in units of the scales.
  Scalar step(const Instant& start, const Scalar& h) {
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
    s_.factor(h * g);
    s_.rate(y_.data(), start, k_[0].data());
    s_.solve(k_[0].data());
    Instant inner;
    for (int i = 1; i < 4; ++i) {
      for (std::size_t m = 0; m < n_; ++m) {
        Scalar move = a[i][0] * k_[0][m], work = c[i][0] / g * k_[0][m];
        for (int j = 1; j < i; ++j) {
          move += a[i][j] * k_[j][m];
          work += c[i][j] / g * k_[j][m];
        }
        stage_[m] = y_[m] + h * move;
        work_[m] = work;
      }
      // (1 - h g A) k = f + h A sum(c k)  <=>  (1 - h g A)(k + w) = f + w with w = sum(c k) / g.
      s_.at(stage_.data(), inner);
      s_.rate(stage_.data(), inner, k_[i].data());
      for (std::size_t m = 0; m < n_; ++m) k_[i][m] += work_[m];
      s_.solve(k_[i].data());
      for (std::size_t m = 0; m < n_; ++m) k_[i][m] -= work_[m];
    }
    using std::abs;
    Scalar largest = 0, sum = 0;
    for (std::size_t m = 0; m < n_; ++m) {
      const Scalar move = b[0] * k_[0][m] + b[1] * k_[1][m] + b[2] * k_[2][m] + b[3] * k_[3][m];
      const Scalar error = d[0] * k_[0][m] + d[1] * k_[1][m] + d[2] * k_[2][m] + d[3] * k_[3][m];
      next_[m] = y_[m] + h * move;
      sum += next_[m];
      largest = larger(abs(error * weight_[m]), largest);
    }
    return h * largest + (sum - sum);  // not a number where any component is not
  }

  System& s_;
  std::size_t n_;
  std::array<std::vector<Scalar>, 4> k_;
  std::vector<Scalar> y_, stage_, work_, next_,
      weight_;  // weight: one over the size of a component, 0: no error control
  std::array<Lane, kWidth> lanes_;
};

}  // namespace hosel::solvers
