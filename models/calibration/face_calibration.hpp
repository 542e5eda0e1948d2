/// Calibration of a yielding face to laboratory measurements.
#pragma once

#include "models/reduced/face_strike.hpp"
#include "solvers/least_squares.hpp"

namespace hosel::models {

/// Values with standard deviations.
struct FaceTarget {
  struct Tap {
    double toe = 0, high = 0;  ///< [m]
    double time = 0;           ///< characteristic [s]
  };
  std::vector<Tap> taps;
  double tap_sigma = 2e-6;          ///< [s]
  double restitution = 0.83;        ///< at the centre [-]
  double restitution_sigma = 2e-3;  ///< [-]
  double speed = 48.77;             ///< of that [m/s]
  double mass = 0, mass_sigma = 0;  ///< effective, from the plate [kg]
};

struct FaceCalibration {
  FaceCompliance face;
  std::vector<double> sd;  ///< of mass, stiffness, damping, half width, half height; infinite where the data are blind
  std::vector<bool> at_bound;   ///< of the same: at an end of what a face is allowed
  Eigen::MatrixXd correlation;  ///< of the same
  double cost = 0;              ///< half the sum of squares in units of the standard deviations
};
/// Throws solvers::NonConvergence.
FaceCalibration calibrate_face(const Head& head, const Striker& sphere, const Striker& ball, const FaceTarget& target);

}  // namespace hosel::models
