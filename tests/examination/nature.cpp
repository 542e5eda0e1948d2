#include "nature.hpp"

#include <cmath>
#include <stdexcept>

namespace examination {
namespace {

Matrix3d cross(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Matrix3d turn_y(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix(); }
Matrix3d turn_z(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix(); }

/// Head with a point mass at the hosel (30 mm heelwards of the cg, on the face plane) and inertia across the
/// shaft.
Head with_shaft(Head head, const Nature& nature) {
  if (nature.shaft_inertia != 0) {
    const Vector3d axis(0, std::cos(58 * M_PI / 180), std::sin(58 * M_PI / 180));
    const Matrix3d across = Matrix3d::Identity() - axis * axis.transpose();
    head.inertia_kg_m2 += nature.shaft_inertia * head.inertia_kg_m2.trace() / 3 * across;
  }
  if (nature.shaft_kg != 0) {
    const Vector3d hosel(-0.012, 0.042, 0.01);
    const double mass = head.mass_kg + nature.shaft_kg;
    const Vector3d lever = hosel - head.cg_m;
    const double reduced = head.mass_kg * nature.shaft_kg / mass;
    head.inertia_kg_m2 += reduced * (lever.squaredNorm() * Matrix3d::Identity() - lever * lever.transpose());
    head.cg_m += nature.shaft_kg / mass * lever;
    head.mass_kg = mass;
  }
  return head;
}

}  // namespace

Flight strike(const Swing& swing, const Head& declared, const Ball& ball, const Nature& nature) {
  const double loft = swing.loft * (1 + nature.loft_gain) + nature.loft_bias +
                      nature.loft_per_speed * (swing.speed - 40);
  const Matrix3d to_global = turn_z(-swing.face) * turn_y(-loft);
  Head head = with_shaft(declared, nature);
  head.mass_kg *= nature.mass_factor;
  head.cg_m += nature.cg_shift_m;
  const Vector3d root = nature.inertia_factor.cwiseSqrt();
  head.inertia_kg_m2 = (root.asDiagonal() * head.inertia_kg_m2 * root.asDiagonal()).eval();

  // Contact point and normal on the face surface.
  const double y = -swing.toe, z = swing.high;
  const double by = nature.planar && nature.turning == 0 ? 0 : 1 / head.bulge_m;
  const double bz = nature.planar && nature.turning == 0 ? 0 : 1 / head.roll_m;
  const Vector3d point(-(y * y * by + z * z * bz) / 2, y, z);
  const Vector3d n = Vector3d(1, y * by, z * bz).normalized();
  const Vector3d lever = point - head.cg_m;
  const double mobility = nature.planar ? nature.turning : 1.0;

  const Vector3d velocity = to_global.transpose() *
                            Vector3d(swing.speed * std::cos(swing.attack) * std::cos(swing.path),
                                     -swing.speed * std::cos(swing.attack) * std::sin(swing.path),
                                     swing.speed * std::sin(swing.attack));
  const Vector3d shaft(0, std::cos(58 * M_PI / 180), std::sin(58 * M_PI / 180));
  const Vector3d omega = to_global.transpose() * (nature.spin_of_head + nature.closure_per_speed * swing.speed * shaft);

  const Vector3d surface = velocity + omega.cross(lever);  // the face at the contact point; the ball rests
  const double approach = surface.dot(n);
  if (!(approach > 0)) throw std::domain_error("the surfaces do not approach");
  const Vector3d across = surface - approach * n;
  const double oblique = across.norm() / approach;

  double e = nature.level - nature.slope * approach;
  e -= nature.curvature * (approach - 35) * (approach - 35);
  if (nature.power != 0) e *= std::pow(approach / 30, -nature.power);
  const double ref = 0.02;
  e -= nature.falloff_toe * (y / ref) * (y / ref) + nature.falloff_high * (z / ref) * (z / ref) +
       nature.falloff_cone * std::hypot(y, z) / ref;
  const double rebound = nature.rebound + nature.rebound_per_speed * approach / 35 +
                         nature.rebound_oblique * oblique / 0.4;
  const Vector3d shift = nature.offset_m + Vector3d(0, 0, nature.offset_oblique * oblique);

  // Unknowns: ball velocity and spin, change of head velocity and spin, impulse on the ball.
  const double ball_inertia = ball.inertia_factor * nature.ball_inertia_factor * ball.mass_kg * ball.radius_m *
                              ball.radius_m;
  const Matrix3d normal_part = n * n.transpose();
  const Matrix3d ball_moment = cross(-ball.radius_m * n) + cross(shift) * normal_part;
  const Matrix3d head_moment = -(cross(lever) + cross(shift) * normal_part);
  Eigen::Matrix<double, 15, 15> k = Eigen::Matrix<double, 15, 15>::Zero();
  Eigen::Matrix<double, 15, 1> rhs = Eigen::Matrix<double, 15, 1>::Zero();
  const auto I = Matrix3d::Identity();
  k.block<3, 3>(0, 0) = ball.mass_kg * I;
  k.block<3, 3>(0, 12) = -I;
  k.block<3, 3>(3, 3) = ball_inertia * I;
  k.block<3, 3>(3, 12) = -ball_moment;
  k.block<3, 3>(6, 6) = head.mass_kg * I;
  k.block<3, 3>(6, 12) = I;
  k.block<3, 3>(9, 9) = head.inertia_kg_m2;
  k.block<3, 3>(9, 12) = -mobility * head_moment;
  const auto separation_law = [&](const Vector3d& target) {
    k.block<3, 3>(12, 0) = I;
    k.block<3, 3>(12, 3) = cross(ball.radius_m * n);  // spin x (-r n) = cross(r n) spin
    k.block<3, 3>(12, 6) = -I;
    k.block<3, 3>(12, 9) = cross(lever);
    rhs.tail<3>() = target + surface;
  };
  separation_law(e * approach * n + rebound * across);
  Eigen::Matrix<double, 15, 1> x = k.partialPivLu().solve(rhs);

  Vector3d impulse = x.tail<3>();
  const double jn = impulse.dot(n);
  const double cap = nature.slip > 0 ? 1 / nature.slip : std::numeric_limits<double>::infinity();
  if ((impulse - jn * n).norm() > cap * jn) {
    // Sliding: step along the normal impulse (Routh's method) until the normal separation is reached; the
    // slip direction is followed, and the ball sticks for the rest where the slip dies out.
    const auto respond = [&](const Vector3d& j) {
      const Vector3d v = j / ball.mass_kg, w = ball_moment * j / ball_inertia;
      const Vector3d dv = -j / head.mass_kg;
      const Vector3d dw = mobility == 0 ? Vector3d(Vector3d::Zero())
                                        : Vector3d(mobility * head.inertia_kg_m2.ldlt().solve(head_moment * j));
      return Vector3d(v + w.cross(-ball.radius_m * n) - dv - dw.cross(lever));
    };
    Matrix3d map;
    for (int i = 0; i < 3; ++i) map.col(i) = respond(Vector3d::Unit(i));
    Vector3d u = -surface, total = Vector3d::Zero();
    const int steps = 16;
    const double target = e * approach, span = target + approach;
    bool stuck = false;
    for (int i = 0; i < steps && !stuck; ++i) {
      const auto direction = [&](const Vector3d& at) {
        Vector3d t = at - at.dot(n) * n;
        const double slip = t.norm();
        const double mu = cap * (1 + nature.stribeck * std::exp(-slip / 3));
        Vector3d d = n - (slip > 0 ? Vector3d(mu / slip * t) : Vector3d(Vector3d::Zero()));
        return Vector3d(d / (map * d).dot(n));  // per unit of normal separation speed
      };
      const double h = span / steps;
      const Vector3d half = u + map * direction(u) * (h / 2);
      const Vector3d step = h * direction(half);
      const Vector3d next = u + map * step;
      const Vector3d before = u - u.dot(n) * n, after = next - next.dot(n) * n;
      if (before.dot(after) <= 0) {
        stuck = true;
        break;
      }
      u = next;
      total += step;
    }
    // Stuck on the way: the ball leaves rolling, or rebounds along the face as far as friction carries.
    const bool rebounds = stuck && rebound > 0;
    if (rebounds) total = jn * n + cap * jn * (impulse - jn * n).normalized();
    if (!stuck || rebounds) {
      impulse = total;
      x.segment<3>(0) = impulse / ball.mass_kg;
      x.segment<3>(3) = ball_moment * impulse / ball_inertia;
    }
  }

  Vector3d v = to_global * x.segment<3>(0), w = to_global * x.segment<3>(3);
  // A turned monitor sees the ball's vectors in axes turned the other way.
  if (nature.monitor != Vector3d::Zero()) {
    const double angle = nature.monitor.norm();
    const Matrix3d seen = Eigen::AngleAxisd(-angle, nature.monitor / angle).toRotationMatrix();
    v = seen * v;
    w = seen * w;
  }
  const double speed = v.norm();
  return {speed, std::asin(v.z() / speed), std::atan2(-v.y(), v.x()), -w.y(), -w.z(), w.x()};
}

}  // namespace examination
