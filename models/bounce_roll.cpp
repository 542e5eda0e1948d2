#include "hosel/models/bounce_roll.hpp"

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

}  // namespace

Run run_out(const FlightPoint& landing, const Ball& ball, const Ground& ground, const BounceRoll& turf) {
  if (ground.slope != 0) throw std::invalid_argument("bounce and roll are for level ground: the landing has a slope");
  constexpr double last_hop = 5e-3;
  Run out;
  Body b{landing.position, landing.velocity, landing.spin};
  out.path.push_back(b.position);
  for (;;) {
    bounce(b, ball, turf);
    const double up = b.velocity.z();
    if (up * up / (2 * kGravity) < last_hop) break;
    ++out.bounces;
    const double hop = 2 * up / kGravity;
    const Vec3 from = b.position;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double t = share * hop;
      b.position = from + t * b.velocity - Vec3(0, 0, 0.5 * kGravity * t * t);
      out.path.push_back(b.position);
    }
    b.velocity.z() = -up;
  }
  const Vec3 level(b.velocity.x(), b.velocity.y(), 0);
  const auto rest = [&](double rolling) -> Vec3 {
    return b.position + level * level.norm() / (2 * 5.0 / 7.0 * rolling * kGravity);
  };
  const auto distance = [](const Vec3& x) { return std::hypot(x.x(), x.y()); };
  out.path.push_back(rest(turf.rolling));
  out.total = distance(out.path.back());
  out.side = -out.path.back().y();
  out.total_firm = distance(rest(turf.rolling_low));
  out.total_slow = distance(rest(turf.rolling_high));
  return out;
}

}  // namespace hosel::models
