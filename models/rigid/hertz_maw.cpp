#include "models/rigid/hertz_maw.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "solvers/errors.hpp"
#include "solvers/peak.hpp"

namespace hosel::models {
namespace {

/// The tangential springs: displacement of each, and its force limit per mu at a given depth.
class Patch {
 public:
  Patch(double half_width, int springs, double radius, double modulus, double tangential_modulus)
      : dx_(half_width / springs),
        radius_(radius),
        modulus_(modulus),
        stiffness_(2 * tangential_modulus * dx_),
        u1_(springs),
        u2_(springs),
        n1_(springs),
        n2_(springs),
        limit_(springs) {
    for (int i = 0; i <= springs; ++i) cubed_.push_back(std::pow(i * dx_, 3) / (3 * radius));
  }

  /// Elastic normal force of both halves of cell i at this depth: 2 E* integral of (depth - x^2 / R).
  void limits(double depth, double scale) {
    const double a = std::sqrt(std::max(0.0, radius_ * depth));
    // The patch is as wide as the energy at hand can make it; a step that overshoots fills it whole.
    const int whole = a < dx_ * size() ? static_cast<int>(a / dx_) : size();
    for (int i = 0; i < whole; ++i) limit_[i] = scale * 2 * modulus_ * (depth * dx_ - (cubed_[i + 1] - cubed_[i]));
    if (whole < size()) {
      limit_[whole] = scale * 2 * modulus_ *
                      std::max(0.0, depth * (a - whole * dx_) - (a * a * a / (3 * radius_) - cubed_[whole]));
      for (int i = whole + 1; i < size(); ++i) limit_[i] = 0;
    }
  }

  /// Moves the face by (s1, s2) against the ball; returns the mean force over the step
  /// and the frictional loss, force times slip.
  struct Answer {
    double f1, f2, lost;
  };
  Answer move(double s1, double s2) {
    Answer out{0, 0, 0};
    for (int i = 0; i < size(); ++i) {
      double a = u1_[i] + s1, b = u2_[i] + s2;
      const double force2 = stiffness_ * stiffness_ * (a * a + b * b), limit = limit_[i];
      if (force2 > limit * limit) {
        const double share = limit / std::sqrt(force2);
        a *= share;
        b *= share;
      }
      n1_[i] = a;
      n2_[i] = b;
      const double m1 = stiffness_ * (u1_[i] + a) / 2, m2 = stiffness_ * (u2_[i] + b) / 2;
      out.f1 += m1;
      out.f2 += m2;
      out.lost += m1 * (s1 - (a - u1_[i])) + m2 * (s2 - (b - u2_[i]));
    }
    return out;
  }
  void accept() {
    u1_.swap(n1_);
    u2_.swap(n2_);
  }
  double stored() const {
    double sum = 0;
    for (int i = 0; i < size(); ++i) sum += u1_[i] * u1_[i] + u2_[i] * u2_[i];
    return stiffness_ * sum / 2;
  }
  Eigen::Vector2d force() const {
    Eigen::Vector2d f = Eigen::Vector2d::Zero();
    for (int i = 0; i < size(); ++i) f += stiffness_ * Eigen::Vector2d(u1_[i], u2_[i]);
    return f;
  }

 private:
  int size() const { return static_cast<int>(u1_.size()); }
  double dx_, radius_, modulus_, stiffness_;
  std::vector<double> u1_, u2_, n1_, n2_, limit_, cubed_;
};

}  // namespace

HertzMawResult hertz_maw_impact(const Blow& blow, const HertzMawLaw& law, const HertzMawOptions& options,
                                const std::function<void(const HertzMawSample&)>& watch) {
  return hertz_maw_impact(blow, impulse_problem(blow), law, options, watch);
}

HertzMawResult hertz_maw_impact(const Blow& blow, const ImpulseProblem& p, const HertzMawLaw& law,
                                const HertzMawOptions& options,
                                const std::function<void(const HertzMawSample&)>& watch) {
  const Face& face = blow.club.head.face;
  const double radius = 1 / (1 / blow.ball.radius + (1 / face.bulge + 1 / face.roll) / 2);
  const double modulus = law.modulus / (1 - law.poisson * law.poisson);
  const double tangential_modulus = modulus * 2 * (1 - law.poisson) / (2 - law.poisson);
  const double potential = 8.0 / 15.0 * modulus * std::sqrt(radius);  // times depth^2.5

  // Axes of the contact: n, t1, t2. Velocity w of the face past the ball, w' = -K F.
  const Vec3 n = p.contact.normal, t1 = n.unitOrthogonal(), t2 = n.cross(t1);
  Mat3 axes;
  axes << n, t1, t2;
  const Mat3 K = axes.transpose() * p.mobility * axes;
  Vec3 w = axes.transpose() * p.contact.approach;
  const double approach = w[0];

  // All the energy of the relative motion in the normal spring bounds the depth.
  const double available = w.dot(K.inverse() * w) / 2;
  const double deepest = std::pow(available / potential, 0.4);
  Patch patch(std::sqrt(radius * deepest), options.springs, radius, modulus, tangential_modulus);
  const double hertz_depth = std::pow(approach * approach / (2 * K(0, 0) * potential), 0.4);
  const double h_full = 2.943275184 * hertz_depth / approach / options.steps;

  HertzMawResult out;
  Vec3 impulse = Vec3::Zero();
  double depth = 0, t = 0;
  solvers::Peak largest_force, largest_depth;
  const auto stored_normal = [&](double d) { return d > 0 ? potential * d * d * std::sqrt(d) : 0.0; };

  struct Step {
    Vec3 w, force;
    double depth, lost_normal, lost_friction;
  };
  // One step of size h by fixed-point iteration on the velocity at its end.
  const auto advance = [&](double h) {
    Vec3 end = w;
    Step s{};
    for (int i = 0; i < 60; ++i) {
      const Vec3 travel = h * (w + end) / 2;
      s.depth = depth + travel[0];
      // Discrete gradient of depth^2.5, written without a difference of near numbers.
      const double x = std::sqrt(depth), y = s.depth > 0 ? std::sqrt(s.depth) : 0;
      const double gradient =
          s.depth <= 0
              ? (depth > 0 ? stored_normal(depth) / (depth - s.depth) : 0.0)
              : potential * (y * y * y * y + y * y * y * x + y * y * x * x + y * x * x * x + x * x * x * x) / (x + y);
      const double rate = travel[0] / h;
      const double factor = std::max(0.0, 1 + law.damping * end[0]);
      patch.limits(s.depth, law.friction * factor);
      const Patch::Answer tangential = patch.move(travel[1], travel[2]);
      s.force = {gradient * (1 + law.damping * rate), tangential.f1, tangential.f2};
      s.lost_normal = gradient * law.damping * rate * travel[0];
      s.lost_friction = tangential.lost;
      const Vec3 next = w - h * (K * s.force);
      const double change = (next - end).norm();
      end = next;
      if (change <= 1e-11 * approach) {
        s.w = end;
        return s;
      }
    }
    throw solvers::NonConvergence("hertz-maw: the step does not converge");
  };

  if (watch) watch({0, 0, 0, Vec3::Zero()});
  while (true) {
    if (t > 10 * options.steps * h_full) throw solvers::NonConvergence("hertz-maw: the ball does not leave the face");
    double h = h_full;
    Step s = advance(h);
    const bool last = s.depth <= 0;
    if (last) {  // shorten to the instant of separation (regula falsi, Illinois)
      double low = 0, high = h, f_low = depth, f_high = s.depth;
      for (int i = 0; i < 60 && std::abs(s.depth) > 1e-14 * deepest; ++i) {
        h = low - f_low * (high - low) / (f_high - f_low);
        s = advance(h);
        if (s.depth > 0) low = h, f_low = s.depth, f_high /= 2;
        else high = h, f_high = s.depth, f_low /= 2;
      }
    }
    patch.accept();
    w = s.w;
    depth = s.depth;
    t += h;
    impulse += h * s.force;
    out.lost_normal += s.lost_normal;
    out.lost_friction += s.lost_friction;
    largest_depth.add(t, depth);
    const double elastic = depth > 0 ? 2.5 * potential * depth * std::sqrt(depth) : 0;
    const double force = elastic * (1 + law.damping * w[0]);
    largest_force.add(t, force);
    if (watch) {
      const Eigen::Vector2d f = patch.force();
      watch({t, depth, force, axes.rightCols<2>() * f});
    }
    if (last) break;
  }

  out.impulse = axes * impulse;
  out.launch = launch_after(blow, p, out.impulse);
  out.launch.contact_time = t;
  out.launch.peak_force = largest_force.value;
  out.launch.peak_compression = largest_depth.value;
  out.stored = patch.stored() + stored_normal(depth);
  // Kinetic energy given up by the bodies: impulse times mean relative velocity at the contact.
  const Vec3 w0 = axes.transpose() * p.contact.approach;
  const double given = (w0 + w).dot(impulse) / 2;
  out.gap = (given - out.stored - out.lost_normal - out.lost_friction) / available;
  return out;
}

}  // namespace hosel::models
