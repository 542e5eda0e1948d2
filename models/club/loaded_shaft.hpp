/// A shaft at first contact with the deflection, velocity and supports of the swing.
#pragma once

#include <vector>

#include "fem/supports.hpp"
#include "golf/blow.hpp"
#include "models/club/swing.hpp"

namespace hosel::models {

/// Seen from the head: face axes, origin at the hosel (the shaft's tip, but for a joint that gives).
struct LoadedShaft {
  struct Node {
    Vec3 position = Vec3::Zero();                                  ///< [m]
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< from the straight shaft on the head
    /// Over what a shaft rigid with the head would do: face axes [m/s]; the node's own axes [rad/s].
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  };
  std::vector<Node> nodes;      ///< butt to tip, those of the beam that the state was found on
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
  fem::Wrench grip,
      grip_rate;  ///< hands on the butt at contact, and per second: force in face axes, moment in the butt's
  /// Of the butt, and of the head's cg, if no blow came: face axes (angular: the body's own).
  Vec3 grip_acceleration = Vec3::Zero(), grip_angular_acceleration = Vec3::Zero();
  Vec3 head_acceleration = Vec3::Zero(), head_angular_acceleration = Vec3::Zero();
};

/// The end of a swing: `state`, a joint's turn included, with the samples at it and one step before, from which the
/// grip's wrench is extrapolated over the impact. Throws std::invalid_argument where the shaft has no head.
LoadedShaft loaded_by_swing(const Swing& swing, const fem::State& state, const SwingSample& before,
                            const SwingSample& last);

/// A delivery that was measured together with the hands' wrench on the butt, both in the axes of the grip as it is
/// then (XG lead, YG droop, ZG to the butt).
struct GripLoad {
  Vec3 force = Vec3::Zero();             ///< [N]
  Vec3 moment = Vec3::Zero();            ///< about the butt [N m]
  Vec3 gravity = Vec3(0, 0, -kGravity);  ///< global [m/s^2]
};

/// The steady shaft behind a head that has the delivery's velocity and spin: the club accelerates as a rigid
/// body under wrench and gravity, and the shaft is bent as it must be for that (no vibration; deflection,
/// velocity field and acceleration iterated until they agree). Throws NonConvergence.
LoadedShaft loaded_by_grip(const Blow& blow, const GripLoad& load, double grip_point, int elements, double growth,
                           bool shear);

}  // namespace hosel::models
