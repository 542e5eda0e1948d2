#include "models/flight/flight.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "solvers/cvode.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

constexpr int kPosition = 0, kVelocity = 3, kSpinLeft = 6, kStates = 7;
constexpr double kLatest = 60;  // [s]

using Jet = ceres::Jet<double, kLaunchQuantities>;
template <class T>
using Vector = Eigen::Matrix<T, 3, 1>;

double value(double x) { return x; }
double value(const Jet& x) { return x.a; }

/// The launch as the flight's start, in the quantities by which it is differentiated.
template <class T>
struct Departure {
  Vector<T> velocity, spin;
};

Departure<double> start_of(const Launch& launch) { return {launch.velocity, launch.spin}; }

Departure<Jet> dual_start_of(const Launch& launch) {
  const Jet speed(launch.ball_speed(), kBallSpeed), angle(launch.launch_angle(), kLaunchAngle),
      azimuth(launch.azimuth(), kAzimuth);
  return {Vector<Jet>(speed * cos(angle) * cos(azimuth), -speed * cos(angle) * sin(azimuth), speed * sin(angle)),
          Vector<Jet>(Jet(launch.riflespin(), kRiflespin), -Jet(launch.backspin(), kBackspin),
                      -Jet(launch.sidespin(), kSidespin))};
}

template <class T>
class Motion {
 public:
  Motion(const Departure<T>& start, const Ball& ball, const FlightConditions& c)
      : c_(c), ball_(ball), spin_(start.spin), spin_rate_(0), axis_(Vector<T>::Zero()) {
    const double area = kPi * ball.radius * ball.radius;
    pressure_ = 0.5 * c.air.density * area / ball.mass;
    reynolds_ = 2 * ball.radius * c.air.density / c.air.viscosity;
    torque_ = c.air.density * area * ball.radius * ball.radius / ball.inertia();
    slope_ = std::tan(c.ground.slope);
    per_log_ = 1 / std::log1p(c.wind.reference / c.wind.roughness);
    wind_ = c.wind.speed * Vec3(std::cos(c.wind.towards), -std::sin(c.wind.towards), 0);
    using std::sqrt;
    if (const T square = spin_.squaredNorm(); value(square) > 0) {
      spin_rate_ = sqrt(square);
      axis_ = spin_ / spin_rate_;
    }
  }

  /// The air past the ball.
  struct Stream {
    Vector<T> velocity;
    T speed, reynolds, spin_ratio;
  };
  Stream through_air(const T* y) const {
    const Vector<T> v(y[kVelocity], y[kVelocity + 1], y[kVelocity + 2]);
    const Vector<T> u = v - wind_share(y) * wind_.template cast<T>();
    using std::sqrt;
    const T speed = sqrt(u.squaredNorm());
    return {u, speed, reynolds_ * speed, spin_rate_ * y[kSpinLeft] * ball_.radius / speed};
  }

  void rate(const T* y, T* dy) const {
    const Stream u = through_air(y);
    const Coefficients<T> k = c_.law.at(u.reynolds, u.spin_ratio);
    const Vector<T> lift = axis_.cross(u.velocity);
    for (int i = 0; i < 3; ++i) {
      dy[kPosition + i] = y[kVelocity + i];
      dy[kVelocity + i] = pressure_ * u.speed * (k.lift * lift[i] - k.drag * u.velocity[i]);
    }
    dy[kVelocity + 2] -= c_.gravity;
    const SpinDecay& decay = c_.law.decay;
    dy[kSpinLeft] = -(decay.rate + (decay.travel / ball_.radius + decay.moment * torque_) * u.speed) * y[kSpinLeft];
  }

  /// Height of the ball over the ground on which it lands.
  T clearance(const T* y) const { return y[kPosition + 2] - c_.ground.height - slope_ * y[kPosition]; }

  FlightPoint point(double time, const T* y) const {
    const Stream u = through_air(y);
    const Coefficients<T> k = c_.law.at(u.reynolds, u.spin_ratio);
    FlightPoint p{time, {}, {}, {}, value(u.reynolds), value(u.spin_ratio), {value(k.drag), value(k.lift)}};
    for (int i = 0; i < 3; ++i) {
      p.position[i] = value(y[kPosition + i]);
      p.velocity[i] = value(y[kVelocity + i]);
      p.spin[i] = value(spin_[i] * y[kSpinLeft]);
    }
    return p;
  }

 private:
  /// Of the wind's speed, where the ball is. Heights count from the lower of the launch and the landing ground.
  T wind_share(const T* y) const {
    const Wind& w = c_.wind;
    if (w.profile == WindProfile::uniform || w.speed == 0) return T(1);
    const T z = y[kPosition + 2], over = clearance(y), height = over > z ? over : z;
    // Steps try the other side of the ground: smooth across it.
    using std::log;
    const T share = per_log_ * log(1.0 + (height < 0.0 ? T(-height) : height) / w.roughness);
    return height < 0.0 ? T(-share) : share;
  }

  const FlightConditions& c_;
  const Ball& ball_;
  Vector<T> spin_;
  T spin_rate_;
  Vector<T> axis_;
  double pressure_, reynolds_, torque_, slope_, per_log_;
  Vec3 wind_;
};

/// A launch that the ground stops at once: it lies on the plane and does not rise from it.
template <class T>
bool grounded(const Motion<T>& motion, const T* y, const Ground& ground) {
  if (value(motion.clearance(y)) != 0) return false;
  std::array<T, kStates> dy;
  motion.rate(y, dy.data());
  const auto climb = [&](const T* of) { return value(of[2]) - std::tan(ground.slope) * value(of[0]); };
  const double speed = climb(y + kVelocity);
  return speed != 0 ? speed < 0 : climb(dy.data() + kVelocity) <= 0;
}

/// At its apex, and from there on, the ball must be over the ground.
template <class T>
void check_height(const Motion<T>& motion, const T* y) {
  if (value(motion.clearance(y)) < 0)
    throw std::invalid_argument("flight: the ball does not rise to the ground on which it should land");
}

/// Where it ends.
void land_at(const FlightPoint& p, Flight& out) {
  out.landing = p;
  out.time = p.time;
  out.carry = std::hypot(p.position.x(), p.position.y());
  out.side = 0 - p.position.y();  // no minus zero
  out.landing_speed = p.velocity.norm();
  out.landing_angle = std::atan2(-p.velocity.z(), std::hypot(p.velocity.x(), p.velocity.y()));
}

template <class T>
std::array<T, kStates> state_of(const Departure<T>& start) {
  return {T(0), T(0), T(0), start.velocity[0], start.velocity[1], start.velocity[2], T(1)};
}

/// Of the state, and of its derivatives behind it where there are any. Where a component is small its error counts
/// against 10 m, 10 m/s and the whole spin: the first metres of height need not be known to a micrometre.
solvers::CvodeOptions solution(const FlightOptions& options, int size) {
  std::vector<double> absolute(std::size_t(size), 0.1 * options.tolerance);
  std::fill_n(absolute.begin(), kSpinLeft, 10 * options.tolerance);
  absolute[kSpinLeft] = options.tolerance;
  return {
      .method = solvers::CvodeMethod::adams, .relative_tolerance = options.tolerance, .absolute = std::move(absolute)};
}

using Plain = std::array<double, kStates>;

/// A step of Runge and Kutta's fourth order.
Plain stepped(const Motion<double>& motion, const Plain& y, double h) {
  Plain k1, k2, k3, k4, at = y;
  const auto go = [&](const Plain& k, double by) {
    for (std::size_t i = 0; i < kStates; ++i) at[i] = y[i] + by * k[i];
  };
  motion.rate(y.data(), k1.data());
  go(k1, h / 2);
  motion.rate(at.data(), k2.data());
  go(k2, h / 2);
  motion.rate(at.data(), k3.data());
  go(k3, h);
  motion.rate(at.data(), k4.data());
  for (std::size_t i = 0; i < kStates; ++i) at[i] = y[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  return at;
}

/// The n-th step: those of the first whole one are halved towards the launch.
double step_size(double whole, int n) {
  constexpr int halvings = 6;
  return n > halvings ? whole : std::ldexp(whole, std::max(n, 1) - 1 - halvings);
}

/// The part of a step after which `miss` is zero, and the state there: Newton's method from the step's end.
template <class Miss, class Rate>
std::pair<double, Plain> part_of_step(const Motion<double>& motion, const Plain& y, double h, Miss miss, Rate rate) {
  double s = h;
  Plain at = stepped(motion, y, s);
  for (int pass = 0; pass < 20; ++pass) {
    const double by = miss(at) / rate(at);
    s -= by;
    at = stepped(motion, y, s);
    if (std::abs(by) < 1e-13 * h || !std::isfinite(by)) break;
  }
  return {s, at};
}

void check_step(double step) {
  if (!(step > 0)) throw std::invalid_argument("flight: a step is above zero");
}

enum Event { kLanding, kTop };

void check(const Launch& launch) {
  if (!(launch.ball_speed() > 0)) throw std::invalid_argument("flight: the ball has no speed");
}

[[noreturn]] void still_up() { throw solvers::NonConvergence("flight: the ball is still in the air after a minute"); }

}  // namespace

Flight fly(const Launch& launch, const Ball& ball, const FlightConditions& conditions, const FlightOptions& options) {
  check(launch);
  const Departure<double> start = start_of(launch);
  const Motion<double> motion(start, ball, conditions);
  const auto y0 = state_of(start);
  Flight out;
  const auto land = [&](const FlightPoint& p) {
    land_at(p, out);
    if (options.sample > 0) out.path.push_back(p);
  };
  const FlightPoint first = motion.point(0, y0.data());
  out.reynolds = {first.reynolds, first.reynolds};
  out.spin = {first.spin_ratio, first.spin_ratio};
  if (grounded(motion, y0.data(), conditions.ground)) return land(first), out;
  if (y0[kVelocity + 2] < 0) check_height(motion, y0.data());

  solvers::Cvode solver(
      kStates, [&](double, const double* y, double* dy) { motion.rate(y, dy); }, 2,
      [&](double, const double* y, double* g) {
        g[kLanding] = motion.clearance(y);
        g[kTop] = y[kVelocity + 2];
      },
      solution(options, kStates));
  double before = 0, unknown = 0;
  const auto watch = [&](double t, const double* y) {
    const auto u = motion.through_air(y);
    out.reynolds = {std::min(out.reynolds.low, u.reynolds), std::max(out.reynolds.high, u.reynolds)};
    out.spin = {std::min(out.spin.low, u.spin_ratio), std::max(out.spin.high, u.spin_ratio)};
    if (!conditions.law.holds(u.reynolds, u.spin_ratio)) unknown += t - before;
    before = t;
    if (!(options.sample > 0)) return;
    for (double next; (next = options.sample * double(out.path.size())) < t;) {
      std::array<double, kStates> between;
      solver.interpolate(next, between);
      out.path.push_back(motion.point(next, between.data()));
    }
  };
  if (options.sample > 0) out.path.push_back(first);
  solver.start(0, y0);
  for (;;) {
    const solvers::Cvode::Stop stop = solver.run(kLatest, watch);
    if (!stop.event) still_up();
    const double* y = solver.state().data();
    if (stop.event == kTop) {
      check_height(motion, y);
      if (y[kPosition + 2] <= out.apex) continue;
      out.apex = y[kPosition + 2];
      out.apex_time = stop.time;
      continue;
    }
    land(motion.point(stop.time, y));
    out.outside = unknown / out.time;
    out.steps = solver.statistics().steps;
    return out;
  }
}

std::vector<FlightPoint> follow(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                                std::span<const double> times, const FlightOptions& options) {
  check(launch);
  FlightConditions free = conditions;
  free.ground = {};
  const Departure<double> start = start_of(launch);
  const Motion<double> motion(start, ball, free);
  const auto y0 = state_of(start);
  std::vector<FlightPoint> out;
  if (times.empty()) return out;
  solvers::Cvode solver(
      kStates, [&](double, const double* y, double* dy) { motion.rate(y, dy); }, 1,
      [](double, const double*, double* g) {
        g[0] = 1; /* nothing stops it */
      },
      solution(options, kStates));
  while (out.size() < times.size() && times[out.size()] <= 0) out.push_back(motion.point(times[out.size()], y0.data()));
  solver.start(0, y0);
  const auto watch = [&](double t, const double*) {
    for (; out.size() < times.size() && times[out.size()] <= t;) {
      std::array<double, kStates> between;
      solver.interpolate(times[out.size()], between);
      out.push_back(motion.point(times[out.size()], between.data()));
    }
  };
  solver.run(times.back(), watch);
  while (out.size() < times.size()) out.push_back(motion.point(times[out.size()], solver.state().data()));
  return out;
}

Flight fly_in_steps(const Launch& launch, const Ball& ball, const FlightConditions& conditions, double step) {
  check(launch);
  check_step(step);
  const Departure<double> start = start_of(launch);
  const Motion<double> motion(start, ball, conditions);
  Plain y = state_of(start);
  Flight out;
  const FlightPoint first = motion.point(0, y.data());
  out.reynolds = {first.reynolds, first.reynolds};
  out.spin = {first.spin_ratio, first.spin_ratio};
  if (grounded(motion, y.data(), conditions.ground)) return land_at(first, out), out;
  if (y[kVelocity + 2] < 0) check_height(motion, y.data());
  const double slope = std::tan(conditions.ground.slope);
  double t = 0, unknown = 0;
  while (t < kLatest) {
    const double h = step_size(step, int(out.steps++));
    const Plain next = stepped(motion, y, h);
    if (y[kVelocity + 2] > 0 && next[kVelocity + 2] <= 0) {
      const auto [s, top] = part_of_step(
          motion, y, h, [](const Plain& at) { return at[kVelocity + 2]; },
          [&](const Plain& at) {
            Plain rate;
            motion.rate(at.data(), rate.data());
            return rate[kVelocity + 2];
          });
      check_height(motion, top.data());
      if (top[kPosition + 2] > out.apex) {
        out.apex = top[kPosition + 2];
        out.apex_time = t + s;
      }
    }
    if (motion.clearance(y.data()) >= 0 && motion.clearance(next.data()) < 0) {
      const auto [s, down] = part_of_step(
          motion, y, h, [&](const Plain& at) { return motion.clearance(at.data()); },
          [&](const Plain& at) { return at[kVelocity + 2] - slope * at[kVelocity]; });
      land_at(motion.point(t + s, down.data()), out);
      out.outside = unknown / out.time;
      return out;
    }
    y = next;
    t += h;
    const auto u = motion.through_air(y.data());
    out.reynolds = {std::min(out.reynolds.low, u.reynolds), std::max(out.reynolds.high, u.reynolds)};
    out.spin = {std::min(out.spin.low, u.spin_ratio), std::max(out.spin.high, u.spin_ratio)};
    if (!conditions.law.holds(u.reynolds, u.spin_ratio)) unknown += h;
  }
  still_up();
}

std::vector<Vec3> follow_in_steps(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                                  std::span<const double> times, double step) {
  check(launch);
  check_step(step);
  FlightConditions free = conditions;
  free.ground = {};
  const Departure<double> start = start_of(launch);
  const Motion<double> motion(start, ball, free);
  Plain y = state_of(start);
  std::vector<Vec3> out;
  double t = 0;
  for (int n = 0; out.size() < times.size(); ++n) {
    const double h = step_size(step, n);
    while (out.size() < times.size() && times[out.size()] <= t + h) {
      const Plain at = stepped(motion, y, std::max(0.0, times[out.size()] - t));
      out.emplace_back(at[kPosition], at[kPosition + 1], at[kPosition + 2]);
    }
    y = stepped(motion, y, h);
    t += h;
  }
  return out;
}

FlightJacobian flight_jacobian(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                               const FlightOptions& options) {
  check(launch);
  if (!(launch.spin_rate() > 0))
    throw std::invalid_argument("flight: without spin the lift has no direction, and the flight no derivative by it");
  const Departure<Jet> start = dual_start_of(launch);
  const Motion<Jet> motion(start, ball, conditions);
  using State = std::array<Jet, kStates>;
  FlightJacobian out = FlightJacobian::Zero();
  const State first = state_of(start);
  if (grounded(motion, first.data(), conditions.ground)) return out;
  if (first[kVelocity + 2].a < 0) check_height(motion, first.data());

  // A dual number is its value, then its derivatives; the values stand first, as in the plain flight.
  constexpr int kDual = kStates * (1 + kLaunchQuantities);
  const auto pack = [](const State& y, double* flat) {
    for (int i = 0; i < kStates; ++i) {
      flat[i] = y[std::size_t(i)].a;
      for (int k = 0; k < kLaunchQuantities; ++k) flat[kStates + kLaunchQuantities * i + k] = y[std::size_t(i)].v[k];
    }
  };
  const auto unpack = [](const double* flat) {
    State y;
    for (int i = 0; i < kStates; ++i) {
      y[std::size_t(i)].a = flat[i];
      for (int k = 0; k < kLaunchQuantities; ++k) y[std::size_t(i)].v[k] = flat[kStates + kLaunchQuantities * i + k];
    }
    return y;
  };
  solvers::Cvode solver(
      kDual,
      [&](double, const double* flat, double* rate) {
        const State y = unpack(flat);
        State dy;
        motion.rate(y.data(), dy.data());
        pack(dy, rate);
      },
      2,
      [&](double, const double* flat, double* g) {
        g[kLanding] = value(motion.clearance(unpack(flat).data()));
        g[kTop] = flat[kVelocity + 2];
      },
      solution(options, kDual));
  std::array<double, kDual> flat0;
  pack(first, flat0.data());
  solver.start(0, flat0);
  double apex = 0;
  for (;;) {
    const solvers::Cvode::Stop stop = solver.run(kLatest);
    if (!stop.event) still_up();
    State y = unpack(solver.state().data());
    State dy;
    motion.rate(y.data(), dy.data());
    if (stop.event == kTop) check_height(motion, y.data());
    if (stop.event == kTop && y[kPosition + 2].a > apex) {
      // The height is stationary in time there: the event's motion adds nothing.
      apex = y[kPosition + 2].a;
      out.row(kApex) = y[kPosition + 2].v.transpose();
    }
    if (stop.event != kLanding) continue;
    // A launch that differs lands at another time: g(y(t)) = 0 makes t a dual number, too.
    const Jet miss = motion.clearance(y.data());
    const double fall = y[kVelocity + 2].a - std::tan(conditions.ground.slope) * y[kVelocity].a;
    const Jet time = Jet(stop.time) - (miss - miss.a) / fall;
    const Jet late = time - stop.time;
    for (int i = 0; i < kStates; ++i) y[std::size_t(i)] += dy[std::size_t(i)].a * late;
    const Jet across = sqrt(y[0] * y[0] + y[1] * y[1]), level = sqrt(y[3] * y[3] + y[4] * y[4]);
    out.row(kCarry) = across.v.transpose();
    out.row(kSide) = -y[1].v.transpose();
    out.row(kTime) = time.v.transpose();
    out.row(kLandingAngle) = atan2(-y[5], level).v.transpose();
    return out;
  }
}

}  // namespace hosel::models
