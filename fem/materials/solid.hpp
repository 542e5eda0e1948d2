/// A solid material: an elastic law, Maxwell branches in parallel with it, a density.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fem/materials/elastic_law.hpp"
#include "fem/materials/maxwell.hpp"

namespace hosel::fem {

struct Solid {
  Elastic elastic;  ///< of the long term
  std::vector<MaxwellBranch> branches;
  double density = 0;  ///< [kg/m^3]

  /// Sentences naming what no material can have; empty if all is well.
  std::vector<std::string> faults() const;
  double shear() const { return elastic.shear(); }        ///< long-term shear modulus at zero strain [Pa]
  double instant_shear() const;                           ///< with all branches [Pa]
  double bulk() const { return elastic.bulk_modulus(); }  ///< [Pa]

  /// Numbers of history at a point: C' (6) and, per branch, B (6) and the dissipation rate (1), all
  /// as of the last accepted state.
  int history_size() const { return branches.empty() ? 0 : 6 + 7 * static_cast<int>(branches.size()); }
  int start_size() const { return 7 * static_cast<int>(branches.size()); }  ///< see start_step
  bool in_lanes() const { return !elastic.corotated() && !elastic.bears_inversion(); }
  void start(std::span<double> history) const;
};

/// Response to F at the end of a step of `dt` from the history's state. `frame` turns the local
/// reference frame to the body's mean attitude; only a CorotatedLaw looks at it.
void evaluate(const Solid& solid, const Mat3& F, const Mat3& frame, double dt, std::span<const double> history,
              bool tangent, PointResponse& out);

/// The same at `kLanes` points, energy and stress alone; of a law that neither is corotated nor bears inversion.
/// `starts`: see start_step.
void evaluate(const Solid& solid, const Mat3Lanes& F, const double* starts, std::ptrdiff_t stride, Mat3Lanes& stress,
              Lanes& energy);

/// What of a step of `dt` does not depend on its end, from the history at its start: per branch base (6) and gain (1),
/// number k at out[k stride], so that points lie side by side.
void start_step(const Solid& solid, double dt, std::span<const double> history, double* out, std::ptrdiff_t stride);

/// Moves the history over the step; returns the energy dissipated in it [J/m^3] (trapezoidal in time).
double update_internal_variables(const Solid& solid, const Mat3& F, double dt, std::span<double> history);
/// The same at `kLanes` points, of which the first `count` are there: theirs lie one behind the other in `history`.
/// Returns the sum over them.
double update_internal_variables(const Solid& solid, const Mat3Lanes& F, const double* starts, std::ptrdiff_t stride,
                                 double dt, int count, std::span<double> history);

}  // namespace hosel::fem
