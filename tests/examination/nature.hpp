#pragma once
// The blow as the examination knows it: one impulse between two rigid bodies, solved as a saddle-point
// system in the 12 velocities and the impulse (Lagrange multipliers), and stepped along the normal
// impulse where the ball slides. Written from the specification alone; shares nothing with the project.

#include <Eigen/Dense>
#include <limits>

namespace examination {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// SI; vectors in the face frame (Xc out of the face, Yc to the heel, Zc up), cg from the face centre.
struct Head {
  double mass_kg = 0.2;
  Vector3d cg_m = Vector3d(-0.035, 0, 0);
  Matrix3d inertia_kg_m2 = Vector3d(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal();
  double bulge_m = 0.3, roll_m = 0.3;
};

struct Ball {
  double mass_kg = 0.04593, radius_m = 0.021335, inertia_factor = 0.4;
};

/// Delivery, SI and radians, signs as in the specification.
struct Swing {
  double speed = 0, attack = 0, path = 0, face = 0, loft = 0, toe = 0, high = 0;
};

/// Launch: m/s, radians, rad/s.
struct Flight {
  double speed = 0, launch = 0, azimuth = 0, backspin = 0, sidespin = 0, riflespin = 0;
};

/// Everything that may differ from the declared base. The defaults are the base.
struct Nature {
  bool planar = false;  ///< the head does not turn and its face is flat
  double turning = 0;   ///< planar only: share of the head's rotational mobility that is there
  // normal restitution e = level - slope v_n, and its changes
  double level = 0.86, slope = 0.0029;
  double curvature = 0;                      ///< quadratic in v_n about 35 m/s, 1/(m/s)^2
  double power = 0;                          ///< e (v_n / 30 m/s)^-power
  double falloff_toe = 0, falloff_high = 0;  ///< loss at 20 mm, quadratic in each direction
  double falloff_cone = 0;                   ///< loss at 20 mm, linear in the distance
  // tangential contact
  double rebound = 0;                    ///< tangential restitution
  double rebound_per_speed = 0;          ///< the same, growing as v_n / 35 m/s
  double rebound_oblique = 0;            ///< the same, growing as tan(obliquity) / 0.4
  double slip = 0;                       ///< 1 / friction coefficient; zero never slides
  double stribeck = 0;                   ///< extra share of friction at rest, decaying over 3 m/s of slip
  Vector3d offset_m = Vector3d::Zero();  ///< where the normal force acts, from the contact point, face frame
  double offset_oblique = 0;             ///< offset up the face, m per unit tan(obliquity)
  // bodies
  double mass_factor = 1, ball_inertia_factor = 1;
  Vector3d inertia_factor = Vector3d::Ones();
  double shaft_kg = 0;       ///< mass that goes with the hosel
  double shaft_inertia = 0;  ///< share of inertia added across the shaft
  Vector3d cg_shift_m = Vector3d::Zero();
  Vector3d spin_of_head = Vector3d::Zero();  ///< global, rad/s
  double closure_per_speed = 0;              ///< about the shaft (lie 58 deg), rad/s per m/s
  // instrument
  double loft_bias = 0, loft_gain = 0, loft_per_speed = 0;  ///< rad, -, rad per m/s above 40 m/s
  Vector3d monitor = Vector3d::Zero();                      ///< small turns of the monitor: roll, pitch, yaw, rad
};

/// The ball's flight after the blow. Throws std::domain_error where the surfaces do not approach.
Flight strike(const Swing& swing, const Head& head, const Ball& ball, const Nature& nature);

}  // namespace examination
