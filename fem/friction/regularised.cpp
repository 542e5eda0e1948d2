#include "fem/friction/regularised.hpp"

#include <cmath>

namespace hosel::fem {

Friction RegularisedFriction::at(const Slip& in, bool derivatives) const {
  Friction out;
  const double limit = coefficient_ * in.pressure, speed = in.velocity.norm();
  const double x = 4 * speed / transition_speed_, h = std::tanh(x);
  const Vec3 d = speed > 0 ? Vec3(in.velocity / speed) : Vec3::Zero();
  out.traction = limit * h * d;
  out.slip = in.step.norm();
  out.sliding = true;
  if (derivatives) {
    const Mat3 along = d * d.transpose();
    const double secant = x > 1e-8 ? h / speed : 4 / transition_speed_;
    out.by_pressure = coefficient_ * h * d;
    out.by_velocity = limit * (secant * (in.tangent - along) + 4 / transition_speed_ * (1 - h * h) * along);
  }
  return out;
}

std::vector<std::string> RegularisedFriction::faults() const {
  std::vector<std::string> out;
  if (!(coefficient_ >= 0) || !std::isfinite(coefficient_))
    out.emplace_back("contact: friction must be at least zero and finite");
  if (!(transition_speed_ > 0)) out.emplace_back("contact: the transition speed must be positive");
  return out;
}

}  // namespace hosel::fem
