/// The measured motion of the grip as a smooth function of time.
#pragma once

#include <string>
#include <vector>

#include "fem/supports.hpp"
#include "solvers/spline.hpp"

namespace hosel::models {

/// Samples of position and attitude (grip frame to global).
struct GripTrack {
  std::vector<double> times;    ///< [s]
  std::vector<Vec3> positions;  ///< global [m]
  std::vector<Eigen::Quaterniond> attitudes;

  /// Sentences naming what no motion can have: time backwards, a gap longer than `longest_gap` [s], a
  /// turn of more than an eighth of a circle between neighbours; empty if all is well.
  std::vector<std::string> faults(double longest_gap) const;
  /// Leaves the samples up to the first at `end` [s] or after it.
  void cut(double end);
};

/// Y-X-Z Euler angles: rotation = Ry(a) Rx(b) Rz(c).
Eigen::Quaterniond from_yxz(double a, double b, double c);
/// A frame from two measured axes, third = x cross y. Throws std::invalid_argument where they are not
/// orthonormal to `tolerance`.
Eigen::Quaterniond from_axes(const Vec3& x, const Vec3& y, double tolerance);

/// Position and quaternion components run along one spline; the quaternion is normalised, so that
/// attitude, angular velocity and acceleration are exact derivatives of one another.
class GripMotion {
 public:
  /// `smoothing` is the knot spacing of the least-squares spline [s]; 0 goes through every sample.
  GripMotion(const GripTrack& track, double smoothing);
  fem::Pose at(double time) const;
  double first() const { return spline_.first(); }
  double last() const { return spline_.last(); }

 private:
  solvers::Spline spline_;
};

}  // namespace hosel::models
