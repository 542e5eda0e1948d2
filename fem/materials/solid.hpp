/// A solid material: an elastic law, Maxwell branches beside it, a density.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "hosel/fem/materials/maxwell.hpp"
#include "hosel/fem/materials/ogden.hpp"

namespace hosel::fem {

struct Solid {
  std::variant<LinearElastic, StVenantKirchhoff, Hyperelastic, Ogden> elastic;
  std::vector<MaxwellBranch> branches;
  double density = 0;  ///< [kg/m^3]

  /// Sentences naming what no material can have; empty if all is well.
  std::vector<std::string> faults() const;
  double shear() const;          ///< long-term shear modulus at zero strain [Pa]
  double instant_shear() const;  ///< with all branches [Pa]
  double bulk() const;           ///< [Pa]
  bool linear() const { return std::holds_alternative<LinearElastic>(elastic); }

  /// Numbers of history at a point: C' (6) and, per branch, B (6) and the dissipation rate (1), all
  /// as of the last accepted state.
  int history_size() const { return branches.empty() ? 0 : 6 + 7 * static_cast<int>(branches.size()); }
  void start(std::span<double> history) const;
};

/// What a material says at a point. F has rows in the global and columns in the local reference frame.
struct PointResponse {
  double energy = 0;  ///< [J/m^3]
  Mat3 stress;        ///< first Piola-Kirchhoff P = dW/dF [Pa]
  Mat9 tangent;       ///< dP/dF, index i + 3 I for component (i, I) [Pa]
};

/// Response to F at the end of a step of `dt` from the history's state. `frame` turns the local
/// reference frame to the body's mean attitude; only LinearElastic looks at it.
void respond(const Solid& solid, const Mat3& F, const Mat3& frame, double dt, std::span<const double> history,
             bool tangent, PointResponse& out);

/// Moves the history over the step; returns the energy dissipated in it [J/m^3] (trapezoidal in time).
double move_history(const Solid& solid, const Mat3& F, double dt, std::span<double> history);

}  // namespace hosel::fem
