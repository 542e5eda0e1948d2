/// What the ball does after the blow, at the instant contact ends.
#pragma once

#include <optional>

#include "golf/vector.hpp"

namespace hosel {

struct Launch {
  Vec3 velocity = Vec3::Zero();            ///< of the ball's centre of mass, global frame [m/s]
  Vec3 spin = Vec3::Zero();                ///< angular velocity of the ball, global frame [rad/s]
  Vec3 head_velocity = Vec3::Zero();       ///< of the head's centre of gravity, global frame [m/s]
  Vec3 head_spin = Vec3::Zero();           ///< angular velocity of the head, global frame [rad/s]
  std::optional<double> contact_time;      ///< [s]; absent where the model's blow has no duration
  std::optional<double> peak_force;        ///< largest normal force [N]; absent likewise
  std::optional<double> peak_compression;  ///< largest approach of ball and face [m]; absent likewise

  double ball_speed() const;    ///< [m/s]
  double launch_angle() const;  ///< upwards positive [rad]
  double azimuth() const;       ///< right of target positive [rad]
  double backspin() const;      ///< about -Y [rad/s]
  double sidespin() const;      ///< about -Z, fade positive [rad/s]
  double riflespin() const;     ///< about +X [rad/s]
  double spin_rate() const;     ///< magnitude [rad/s]
  double spin_axis() const;     ///< tilt, atan2(sidespin, backspin) [rad]
};

}  // namespace hosel
