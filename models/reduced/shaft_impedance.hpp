/// The shaft as a linear beam condensed to its tip, where it acts on the head.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "golf/blow.hpp"

namespace hosel::models {

/// Craig-Bampton form for the twist u of the head about its centre of gravity (translation, rotation;
/// face frame at first contact), measured from the undisturbed motion of the club:
///   kinetic = u'M u'/2 + u' G q' + q'q'/2,  elastic = u K u/2 + sum w_k^2 q_k^2 / 2,
/// with the shaft's modes q when its tip is held. Craig and Bampton (1968), AIAA J. 6:1313.
struct ShaftImpedance {
  Mat6 mass = Mat6::Zero();                           ///< M
  Mat6 stiffness = Mat6::Zero();                      ///< K
  Eigen::Matrix<double, 6, Eigen::Dynamic> coupling;  ///< G
  Eigen::VectorXd frequency2;                         ///< w_k^2 [1/s^2]
  double damping_time = 0;                            ///< stiffness-proportional: K (u + t u') [s]
  /// Of a club loaded by its swing: how the head's cg and its turning accelerate if no blow comes (linear,
  /// angular; face frame). The undisturbed motion, from which u counts, then is that one.
  std::optional<Vec6> acceleration;
};

struct ShaftImpedanceOptions {
  int functions = 24;     ///< Legendre polynomials per field
  double highest = 15e3;  ///< modes of the held tip above this frequency are left out [Hz]
  /// Which part of the head's motion carries the shaft's tip along: without the head's rotation about
  /// its cg the shaft is added mass alone, without the translation added rotational inertia alone.
  bool feels_translation = true, feels_rotation = true;
  /// The tip turns freely in the head about the axis across shaft and face normal (YG of the grip).
  bool hinged = false;
};

/// The shaft clamped at its butt, straight and linear: bending in two planes (Timoshenko), torsion and
/// axial motion by Ritz functions (x/L) P_k(2x/L - 1), which know the taper exactly between stations.
/// Throws std::invalid_argument where the club has no shaft.
ShaftImpedance shaft_impedance(const Club& club, const ShaftImpedanceOptions& options = {});

}  // namespace hosel::models
