#include "models/flight/flight.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

#include "solvers/dormand_prince.hpp"
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
  Stream through_air(const T* y) const { return through_air(y, over_landing(y)); }
  Stream through_air(const T* y, bool over_landing) const {
    const Vector<T> v(y[kVelocity], y[kVelocity + 1], y[kVelocity + 2]);
    const Vector<T> u = v - wind_share(y, over_landing) * wind_.template cast<T>();
    using std::sqrt;
    const T speed = sqrt(u.squaredNorm());
    return {u, speed, reynolds_ * speed, spin_rate_ * y[kSpinLeft] * ball_.radius / speed};
  }

  void rate(const T* y, T* dy) const { rate(y, dy, piece(y)); }
  /// By the formulas of that piece, also beyond its edges.
  void rate(const T* y, T* dy, long piece) const {
    const Stream u = through_air(y, piece % 2);
    const Coefficients<T> k = c_.law.at(u.reynolds, u.spin_ratio, piece / 2);
    const Vector<T> lift = axis_.cross(u.velocity);
    for (int i = 0; i < 3; ++i) {
      dy[kPosition + i] = y[kVelocity + i];
      dy[kVelocity + i] = pressure_ * u.speed * (k.lift * lift[i] - k.drag * u.velocity[i]);
    }
    dy[kVelocity + 2] -= c_.gravity;
    const SpinDecay& decay = c_.law.decay;
    dy[kSpinLeft] = -(decay.rate + (decay.travel / ball_.radius + decay.moment * torque_) * u.speed) * y[kSpinLeft];
  }

  /// Numbers the part in which `rate` is smooth.
  long piece(const T* y) const {
    const bool over = over_landing(y);
    const Stream u = through_air(y, over);
    return 2 * c_.law.piece(value(u.reynolds), value(u.spin_ratio)) + over;
  }

  /// Height of the ball over the ground on which it lands.
  T clearance(const T* y) const { return y[kPosition + 2] - c_.ground.height - slope_ * y[kPosition]; }

  FlightPoint point(double time, const T* y) const {
    const Stream u = through_air(y);
    const Coefficients<double> k = c_.law.at(value(u.reynolds), value(u.spin_ratio));
    FlightPoint p{time, {}, {}, {}, value(u.reynolds), value(u.spin_ratio), k};
    for (int i = 0; i < 3; ++i) {
      p.position[i] = value(y[kPosition + i]);
      p.velocity[i] = value(y[kVelocity + i]);
      p.spin[i] = value(spin_[i] * y[kSpinLeft]);
    }
    return p;
  }

 private:
  /// The wind's heights count from the lower of the launch and the landing ground: whether from this.
  bool over_landing(const T* y) const { return c_.wind.speed != 0 && value(clearance(y)) > value(y[kPosition + 2]); }
  /// Of the wind's speed, where the ball is.
  T wind_share(const T* y, bool over_landing) const {
    const Wind& w = c_.wind;
    if (w.profile == WindProfile::uniform || w.speed == 0) return T(1);
    const T height = over_landing ? clearance(y) : y[kPosition + 2];
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

/// Whether it goes down from here: it comes no higher.
template <class T>
bool sinks(const Motion<T>& motion, const T* y) {
  if (value(y[kVelocity + 2]) != 0) return value(y[kVelocity + 2]) < 0;
  std::array<T, kStates> rate;
  motion.rate(y, rate.data());
  return value(rate[kVelocity + 2]) <= 0;
}

/// Where it ends.
void land_at(const FlightPoint& p, Flight& out) {
  out.landing = p;
  out.time = p.time;
  if (p.position.z() > out.apex) out.apex = p.position.z(), out.apex_time = p.time;  // up a slope, still climbing
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
template <std::size_t N>
std::array<double, N> absolute_tolerance(double tolerance) {
  std::array<double, N> absolute;
  absolute.fill(0.1 * tolerance);
  std::fill_n(absolute.begin(), kSpinLeft, 10 * tolerance);
  absolute[kSpinLeft] = tolerance;
  return absolute;
}

constexpr double kFirstStep = 2e-3;  // [s]: a wind begins steeply over the ground

/// The integration of `rate(y, dy, piece)`, whose first components are the state of `motion`.
template <std::size_t N, class Rate>
auto integration(const Motion<double>& motion, Rate rate, const FlightOptions& options) {
  const auto piece = [&motion](const std::array<double, N>& y) { return motion.piece(y.data()); };
  return solvers::DormandPrince<N, Rate, decltype(piece)>(std::move(rate), piece, options.tolerance,
                                                          absolute_tolerance<N>(options.tolerance));
}

/// Where f falls through zero between a and b, with f(b) <= 0; never outside (TOMS 748). A zero of a ball that takes
/// off at `a` is not meant.
template <class F>
double falls(const F& f, double a, double b) {
  double at_a = f(a), at_b = f(b);
  for (double part = 0.5 * (b - a); at_a <= 0 && part > 1e-15 * (b - a); part /= 2) {
    const double s = a + part, at = f(s);
    if (at > 0) a = s, at_a = at;
    else b = s, at_b = at;
  }
  if (at_a <= 0 || at_b >= 0) return b;
  std::uintmax_t passes = 100;
  const auto [low, high] =
      boost::math::tools::toms748_solve(f, a, b, at_a, at_b, boost::math::tools::eps_tolerance<double>(), passes);
  return 0.5 * (low + high);
}

using Plain = std::array<double, kStates>;

/// Of the tolerance: the errors of a flight's steps add up to some ten times that of one.
constexpr double kOfDerivative = 0.1;

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

/// The part of a step after which `miss` has fallen to zero, and the state there.
template <class Miss>
std::pair<double, Plain> part_of_step(const Motion<double>& motion, const Plain& y, double h, Miss miss) {
  const double s = falls([&](double part) { return miss(stepped(motion, y, part)); }, 0, h);
  return {s, stepped(motion, y, s)};
}

void check_step(double step) {
  if (!(step > 0)) throw std::invalid_argument("flight: a step is above zero");
}

void check(const Launch& launch) {
  if (!(launch.ball_speed() > 0)) throw std::invalid_argument("flight: the ball has no speed");
}

/// Whether the last step met the ground; it then ends there. The time in between is right to the order of what lies
/// between steps, the step up to it to that of steps: once more, by its own miss.
template <class Solver>
bool land_on(const Motion<double>& motion, const Ground& ground, Solver& solver) {
  const auto clearance = [&](const auto& y) { return motion.clearance(y.data()); };
  if (!(clearance(solver.state_before()) >= 0 && clearance(solver.state()) < 0)) return false;
  const double t = falls([&](double s) { return clearance(solver.at(s)); }, solver.before(), solver.time());
  solver.retake(t);
  const auto& y = solver.state();
  const double late = clearance(y) / (y[kVelocity + 2] - std::tan(ground.slope) * y[kVelocity]);
  if (std::abs(late) < 0.1 * (t - solver.before())) solver.retake(t - late);
  return true;
}

/// When the last step went over the top; none: it did not.
template <class Solver>
std::optional<double> topped(const Solver& solver) {
  constexpr int climb = kVelocity + 2;
  if (!(solver.state_before()[climb] > 0 && solver.state()[climb] <= 0)) return {};
  return falls([&](double t) { return solver.at(t)[climb]; }, solver.before(), solver.time());
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
  if (sinks(motion, y0.data())) check_height(motion, y0.data());

  auto solver = integration<kStates>(
      motion, [&](const Plain& y, Plain& dy, long piece) { motion.rate(y.data(), dy.data(), piece); }, options);
  double unknown = 0;
  // What it goes through, at the ends of quarter steps.
  const auto watch = [&](double from, double to) {
    constexpr int parts = 4;
    for (int k = 1; k <= parts; ++k) {
      const auto u = motion.through_air(solver.at(from + k * (to - from) / parts).data());
      out.reynolds = {std::min(out.reynolds.low, u.reynolds), std::max(out.reynolds.high, u.reynolds)};
      out.spin = {std::min(out.spin.low, u.spin_ratio), std::max(out.spin.high, u.spin_ratio)};
      if (!conditions.law.holds(u.reynolds, u.spin_ratio)) unknown += (to - from) / parts;
    }
    if (!(options.sample > 0)) return;
    for (double next; (next = options.sample * double(out.path.size())) < to;)
      out.path.push_back(motion.point(next, solver.at(next).data()));
  };
  if (options.sample > 0) out.path.push_back(first);
  solver.start(0, y0, kFirstStep);
  while (solver.time() < kLatest) {
    solver.step(kLatest);
    const bool landed = land_on(motion, conditions.ground, solver);
    if (const auto top = topped(solver)) {
      const Plain y = solver.at(*top);
      check_height(motion, y.data());
      if (y[kPosition + 2] > out.apex) {
        out.apex = y[kPosition + 2];
        out.apex_time = *top;
      }
    }
    watch(solver.before(), solver.time());
    if (!landed) continue;
    land(motion.point(solver.time(), solver.state().data()));
    out.outside = unknown / out.time;
    out.steps = solver.steps;
    return out;
  }
  still_up();
}

std::vector<FlightPoint> follow(const Launch& launch, const Ball& ball, const FlightConditions& conditions,
                                std::span<const double> times, const FlightOptions& options) {
  check(launch);
  const Departure<double> start = start_of(launch);
  const Motion<double> motion(start, ball, conditions);
  const auto y0 = state_of(start);
  std::vector<FlightPoint> out;
  if (times.empty()) return out;
  auto solver = integration<kStates>(
      motion, [&](const Plain& y, Plain& dy, long piece) { motion.rate(y.data(), dy.data(), piece); }, options);
  while (out.size() < times.size() && times[out.size()] <= 0) out.push_back(motion.point(times[out.size()], y0.data()));
  solver.start(0, y0, kFirstStep);
  while (out.size() < times.size()) {
    solver.step(times.back());
    for (; out.size() < times.size() && times[out.size()] <= solver.time();)
      out.push_back(motion.point(times[out.size()], solver.at(times[out.size()]).data()));
  }
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
  if (sinks(motion, y.data())) check_height(motion, y.data());
  double t = 0, unknown = 0;
  while (t < kLatest) {
    const double h = step_size(step, int(out.steps++));
    const Plain next = stepped(motion, y, h);
    if (y[kVelocity + 2] > 0 && next[kVelocity + 2] <= 0) {
      const auto [s, top] = part_of_step(motion, y, h, [](const Plain& at) { return at[kVelocity + 2]; });
      check_height(motion, top.data());
      if (top[kPosition + 2] > out.apex) {
        out.apex = top[kPosition + 2];
        out.apex_time = t + s;
      }
    }
    if (motion.clearance(y.data()) >= 0 && motion.clearance(next.data()) < 0) {
      const auto [s, down] = part_of_step(motion, y, h, [&](const Plain& at) { return motion.clearance(at.data()); });
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
  const Departure<double> start = start_of(launch);
  const Motion<double> motion(start, ball, conditions);
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
  if (sinks(motion, first.data())) check_height(motion, first.data());

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
  const Motion<double> path(start_of(launch), ball, conditions);
  using Flat = std::array<double, kDual>;
  const auto rate = [&](const Flat& flat, Flat& of_flat, long piece) {
    const State y = unpack(flat.data());
    State dy;
    motion.rate(y.data(), dy.data(), piece);
    pack(dy, of_flat.data());
  };
  auto solver = integration<kDual>(path, rate, {.tolerance = kOfDerivative * options.tolerance});
  Flat flat0;
  pack(first, flat0.data());
  solver.start(0, flat0, kFirstStep);
  double apex = 0;
  while (solver.time() < kLatest) {
    solver.step(kLatest);
    const bool landed = land_on(path, conditions.ground, solver);
    if (const auto top = topped(solver)) {
      const Flat at = solver.at(*top);
      check_height(path, at.data());
      if (at[kPosition + 2] > apex) {
        // The height is stationary in time there: the event's motion adds nothing.
        apex = at[kPosition + 2];
        out.row(kApex) = unpack(at.data())[kPosition + 2].v.transpose();
      }
    }
    if (!landed) continue;
    State y = unpack(solver.state().data());
    State dy;
    motion.rate(y.data(), dy.data());
    // A launch that differs lands at another time: g(y(t)) = 0 makes t a dual number, too.
    const Jet miss = motion.clearance(y.data());
    const double fall = y[kVelocity + 2].a - std::tan(conditions.ground.slope) * y[kVelocity].a;
    const Jet time = Jet(solver.time()) - (miss - miss.a) / fall;
    const Jet late = time - solver.time();
    for (int i = 0; i < kStates; ++i) y[std::size_t(i)] += dy[std::size_t(i)].a * late;
    const Jet across = sqrt(y[0] * y[0] + y[1] * y[1]), level = sqrt(y[3] * y[3] + y[4] * y[4]);
    if (y[kPosition + 2].a > apex) out.row(kApex) = y[kPosition + 2].v.transpose();
    out.row(kCarry) = across.v.transpose();
    out.row(kSide) = -y[1].v.transpose();
    out.row(kTime) = time.v.transpose();
    out.row(kLandingAngle) = atan2(-y[5], level).v.transpose();
    return out;
  }
  still_up();
}

}  // namespace hosel::models
