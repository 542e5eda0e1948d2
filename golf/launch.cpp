#include "golf/launch.hpp"

#include <cmath>

namespace hosel {

double Launch::ball_speed() const { return velocity.norm(); }
double Launch::launch_angle() const { return std::atan2(velocity.z(), std::hypot(velocity.x(), velocity.y())); }
double Launch::azimuth() const { return std::atan2(-velocity.y(), velocity.x()); }
double Launch::backspin() const { return -spin.y(); }
double Launch::sidespin() const { return -spin.z(); }
double Launch::riflespin() const { return spin.x(); }
double Launch::spin_rate() const { return spin.norm(); }
double Launch::spin_axis() const { return std::atan2(sidespin(), backspin()); }

}  // namespace hosel
