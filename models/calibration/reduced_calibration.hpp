/// Calibration of the models without a deformable ball to blows of the finite-element ball.
#pragma once

#include <string>
#include <vector>

#include "models/fe/impact.hpp"
#include "models/reduced/volumetric.hpp"
#include "models/rigid/hertz_maw.hpp"

namespace hosel::models {

/// How far a reduced model is from the finite elements over the blows: root mean square and largest difference.
struct ReducedBand {
  std::string model;
  double ball_speed_rms = 0, ball_speed_max = 0;      ///< [m/s]
  double launch_angle_rms = 0, launch_angle_max = 0;  ///< [rad]
  double azimuth_rms = 0, azimuth_max = 0;            ///< [rad]
  double spin_rms = 0, spin_max = 0;                  ///< length of the difference of the spin vectors [rad/s]
};

struct ReducedCalibration {
  ContactLaw law;        ///< of the rigid models
  VolumetricLaw volume;  ///< its face is that of the blows
  HertzMawLaw hertz;
  std::vector<Launch> launches;  ///< of the finite elements, free body, in the order of the blows
  std::vector<ReducedBand> bands;
  std::vector<std::string> at_bound;  ///< model and parameter, of those at an end of what the search allows
};

/// Least squares over the blows: restitution (level and slope), tangential restitution; stiffness, damping, joint and
/// cover of the volumetric ball; modulus, damping and Poisson's ratio of Hertz and Maw. Coulomb's coefficient is that
/// of the finite elements in all of them. Differences are measured against 0.5 % of ball speed, 0.3 deg of direction,
/// 3 % of the mean spin and 3 % of contact time. Throws what the models throw, std::invalid_argument where there are
/// fewer than four blows.
ReducedCalibration calibrate_reduced(const FeImpactOptions& fe, const std::vector<Blow>& blows);

}  // namespace hosel::models
