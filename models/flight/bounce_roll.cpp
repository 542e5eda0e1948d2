#include "models/flight/bounce_roll.hpp"

#include <cmath>
#include <stdexcept>

namespace hosel::models {
namespace {

struct Body {
  Vec3 position, velocity, spin;
};

double restitution(double normal_speed) {
  return normal_speed > 20 ? 0.120 : 0.510 - 0.0375 * normal_speed + 0.000903 * normal_speed * normal_speed;
}

/// One bounce of a uniform sphere.
void bounce(Body& b, const Ball& ball, const BounceRoll& turf) {
  const Vec3 level(b.velocity.x(), b.velocity.y(), 0);
  const double across = level.norm(), speed = b.velocity.norm(), phi = std::atan2(across, -b.velocity.z());
  const double tilt = radians(15.4) * (speed / 18.6) * (phi / radians(44.4));
  if (tilt > phi)
    throw std::domain_error("bounce and roll: above 54 m/s the turf's law turns the ball back where it came from");
  const Vec3 along = across > 0 ? Vec3(level / across) : Vec3::UnitX();
  const Vec3 normal = std::cos(tilt) * Vec3::UnitZ() - std::sin(tilt) * along;
  const double approach = -b.velocity.dot(normal), e = restitution(approach);
  const Vec3 slip = b.velocity + approach * normal - ball.radius * b.spin.cross(normal);
  // Rolling takes 2/7 of the slip out of a uniform sphere's motion; friction may not give as much.
  const double needed = 2.0 / 7.0 * slip.norm(), given = turf.friction * (1 + e) * approach;
  const Vec3 push = needed > given ? Vec3(-given * slip.normalized()) : Vec3(-2.0 / 7.0 * slip);
  b.velocity += (1 + e) * approach * normal + push;
  b.spin -= 2.5 / ball.radius * normal.cross(push);
}

/// Rolling on a plane tilted by `slope` about Y, in the plane's own axes (x up the slope): friction against the motion
/// and weight along it, both by 5/7 of what a body that slides would have. Closed form along the slope's line or on
/// level ground, else small steps.
Vec3 rest(Vec3 from, Vec3 velocity, double rolling, double slope) {
  const double friction = 5.0 / 7.0 * rolling * kGravity * std::cos(slope),
               weight = -5.0 / 7.0 * kGravity * std::sin(slope);
  velocity.z() = 0;
  if (slope == 0) return from + velocity * velocity.norm() / (2 * friction);
  if (std::abs(weight) >= friction)
    throw std::invalid_argument("bounce and roll: on this slope a rolling ball does not come to rest");
  constexpr double dt = 1e-3;  // [s]; a ball rolls for some seconds, and errs by a millimetre
  for (double speed; (speed = velocity.norm()) > 0;) {
    const Vec3 rate = -friction / speed * velocity + weight * Vec3::UnitX();
    // Where it slows towards its rest, not through it: the slope alone would not start it again.
    if (speed <= (friction + std::abs(weight)) * dt) break;
    from += dt * (velocity + 0.5 * dt * rate);
    velocity += dt * rate;
  }
  return from;
}

}  // namespace

Run run_out(const FlightPoint& landing, const Ball& ball, const Ground& ground, const BounceRoll& turf) {
  constexpr double last_hop = 5e-3;
  // Down a slope each hop is nearly as high as the one before: 40 bounces on the level, 270 at 3 deg, and from 3.1 deg
  // on the hops keep a height for ever.
  constexpr int most_bounces = 2000;
  Run out;
  // In the axes of the ground: x up the slope, z out of it.
  const Mat3 turn = Eigen::AngleAxisd(ground.slope, Vec3::UnitY()).toRotationMatrix();
  const auto global = [&](const Vec3& x) -> Vec3 { return landing.position + turn.transpose() * x; };
  const Vec3 weight = turn * Vec3(0, 0, -kGravity);
  Body b{Vec3::Zero(), turn * landing.velocity, turn * landing.spin};
  out.path.push_back(landing.position);
  for (;;) {
    bounce(b, ball, turf);
    const double up = b.velocity.z(), hop = -2 * up / weight.z();
    if (up <= 0 || up * hop / 4 < last_hop) break;
    if (++out.bounces > most_bounces)
      throw std::invalid_argument("bounce and roll: on this slope a bouncing ball does not come to rest");
    const Vec3 from = b.position;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double t = share * hop;
      b.position = from + t * b.velocity + 0.5 * t * t * weight;
      out.path.push_back(global(b.position));
    }
    b.velocity += hop * weight;
    b.position.z() = 0;
  }
  const auto distance = [](const Vec3& x) { return std::hypot(x.x(), x.y()); };
  const auto at = [&](double rolling) { return global(rest(b.position, b.velocity, rolling, ground.slope)); };
  out.path.push_back(at(turf.rolling));
  out.total = distance(out.path.back());
  out.side = -out.path.back().y();
  out.total_firm = distance(at(turf.rolling_low));
  out.total_slow = distance(at(turf.rolling_high));
  return out;
}

}  // namespace hosel::models
