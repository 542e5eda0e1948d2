#include "models/reduced/face_strike.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "golf/face_library.hpp"
#include "golf/units.hpp"
#include "solvers/peak.hpp"
#include "solvers/rosenbrock_w.hpp"

namespace hosel::models {
namespace {

constexpr double kBallStiffness = 1.68e6;  // effective, fitted [N/m]

/// The equations of strike() for solvers::RosenbrockW; with A = 0 its steps are explicit.
struct Strike {
  using Scalar = double;
  struct Instant {
    double depth = 0;
    void take(const Instant& other, bool lane) {
      if (lane) *this = other;
    }
  };
  enum : int { kStriker, kStrikerVelocity, kTravel, kTravelRate, kHead, kHeadVelocity, kSize };
  Striker striker;
  double head_mass;
  FaceCompliance face;
  bool yields;
  double shape, speed;

  int size() const { return kSize; }
  double depth(const double* y) const { return y[kHead] - shape * y[kTravel] - y[kStriker]; }
  void at(const double* y, Instant& i) const { i.depth = depth(y); }
  double gap(const Instant& i) const { return i.depth; }
  double force(const double* y) const {
    const double d = depth(y), rate = y[kHeadVelocity] - shape * y[kTravelRate] - y[kStrikerVelocity];
    if (!(d > 0)) return 0;
    return std::max(0.0, striker.stiffness * std::pow(d, striker.exponent) * (1 + striker.damping * rate));
  }
  void rate(const double* y, const Instant&, double* dy) const {
    const double F = force(y), m = face.mass;
    double travel = 0, head = -F / head_mass;
    if (yields) {
      // m (w'' - X'') and M X'' - m w'' solved for w'' and X''.
      const double on_face = shape * F - face.stiffness * y[kTravel] - face.damping * y[kTravelRate];
      head = (on_face - F) / (head_mass - m);
      travel = on_face / m + head;
    }
    dy[kStriker] = y[kStrikerVelocity];
    dy[kStrikerVelocity] = F / striker.mass;
    dy[kTravel] = y[kTravelRate];
    dy[kTravelRate] = travel;
    dy[kHead] = y[kHeadVelocity];
    dy[kHeadVelocity] = head;
  }
  void linearise(const Instant&) const {}
  void factor(double) const {}
  void solve(double*) const {}
  double scale(int i) const { return i % 2 == 1 ? speed : speed * 1e-4; }
};

/// Static compliance of the face at a point [m/N].
double give(const std::optional<FaceCompliance>& face, double shape) {
  return face ? shape * shape / face->stiffness : 0;
}

/// Contact time of an elastic striker on a spring: twice the time to rest. With d = D sin(a) the integrand of
/// dx / v, x = d + give F, is smooth.
double contact_time(const Striker& s, double mass, double compliance, double speed) {
  const double K = s.stiffness, n = s.exponent, energy = 0.5 * mass * speed * speed;
  const auto stored = [&](double d) {
    const double F = K * std::pow(d, n);
    return F * d / (n + 1) + 0.5 * compliance * F * F;
  };
  double low = 0, high = std::pow((n + 1) * energy / K, 1 / (n + 1));
  for (int i = 0; i < 100; ++i) (stored(0.5 * (low + high)) < energy ? low : high) = 0.5 * (low + high);
  const double deepest = high;
  constexpr int kPoints = 400;  // midpoint rule: 1e-5 of the time
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = (i + 0.5) / kPoints * kPi / 2, d = deepest * std::sin(angle);
    const double x_rate = 1 + compliance * n * K * std::pow(d, n - 1);
    sum += x_rate * deepest * std::cos(angle) / std::sqrt(2 * (energy - stored(d)) / mass);
  }
  return 2 * sum * kPi / 2 / kPoints;
}

}  // namespace

Striker steel_sphere(double radius) {
  const double modulus = 1 / ((1 - 0.3 * 0.3) / 200e9 + (1 - 0.33 * 0.33) / 110e9);
  return {7850 * 4.0 / 3 * kPi * radius * radius * radius, 4.0 / 3 * modulus * std::sqrt(radius), 1.5, 0};
}

Striker golf_ball(const Ball& ball) { return {ball.mass, 6.693e6, 1.2, 0.012239}; }

double mass_at(const Head& head, double yc, double zc) {
  if (std::isinf(head.mass)) return head.mass;
  const Vec3 turn = (head.face.point(yc, zc) - head.cg).cross(Vec3::UnitX());
  return 1 / (1 / head.mass + turn.dot(head.inertia.inverse() * turn));
}

bool wants_yielding_face(const Head& head) { return std::isfinite(head.mass) && head.cg.x() < -0.02; }

const FaceCompliance& usual_face(const Head& head) {
  return find_face(wants_yielding_face(head) ? "modern-driver" : "steel-iron")->face;
}

FaceStrike strike(const Striker& striker, double head_mass, const std::optional<FaceCompliance>& face, double shape,
                  double speed) {
  if (face && !(face->mass < head_mass)) throw std::invalid_argument("the face's mass is part of the head's");
  const bool yields = face && shape > 0;
  Strike system{striker, head_mass, yields ? *face : FaceCompliance{}, yields, yields ? shape : 0, speed};
  solvers::RosenbrockW<Strike> solver(system);
  std::array<double, Strike::kSize> y{};
  y[Strike::kHeadVelocity] = speed;
  FaceStrike out;
  // A step of the fastest motion cannot be above a tenth of its period's inverse rate: error control sees to it.
  solvers::Peak force;
  out.contact_time = solver.run(y.data(),
                                {.first_step = 1e-7, .latest = 0.05, .tolerance = 1e-6, .event_tolerance = 1e-12},
                                [&](double t, const double* now) { force.add(t, system.force(now)); });
  out.peak_force = force.value;
  // The head's momentum is what striker and start leave it; its face may still move.
  const double head = speed - striker.mass / head_mass * y[Strike::kStrikerVelocity];
  out.restitution = (y[Strike::kStrikerVelocity] - head) / speed;
  if (yields)
    out.energy = 0.5 * face->mass * (1 - face->mass / head_mass) * y[Strike::kTravelRate] * y[Strike::kTravelRate] +
                 0.5 * face->stiffness * y[Strike::kTravel] * y[Strike::kTravel];
  return out;
}

double loss_on_face(double compliance) {
  const double share = 1 / (1 + kBallStiffness * compliance);
  return share * share;
}

double contact_on_face(double compliance) { return std::sqrt(1 + kBallStiffness * compliance); }

CharacteristicTime characteristic_time(const Striker& sphere, double head_mass,
                                       const std::optional<FaceCompliance>& face, double shape,
                                       std::span<const double> speeds) {
  const double mass = 1 / (1 / sphere.mass + 1 / head_mass);
  std::vector<double> times;
  for (const double v : speeds) times.push_back(contact_time(sphere, mass, give(face, shape), v));
  return characteristic_line(speeds, std::move(times));
}

CharacteristicTime characteristic_line(std::span<const double> speeds, std::vector<double> times) {
  CharacteristicTime out;
  Eigen::MatrixX2d A(static_cast<Eigen::Index>(speeds.size()), 2);
  for (Eigen::Index i = 0; i < A.rows(); ++i) A.row(i) << 1, std::pow(speeds[static_cast<std::size_t>(i)], -0.329);
  const Eigen::VectorXd t = Eigen::Map<const Eigen::VectorXd>(times.data(), A.rows());
  const Eigen::Vector2d line = (A.transpose() * A).inverse() * (A.transpose() * t);
  out.time = line[0];
  out.slope = line[1];
  out.times = std::move(times);
  out.departure = (t - A * line).cwiseAbs().maxCoeff();
  return out;
}

std::vector<double> pendulum_speeds() { return {0.5, 0.7, 0.95, 1.3, 1.8}; }

}  // namespace hosel::models
