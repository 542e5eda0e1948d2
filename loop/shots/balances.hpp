/// Tests that need no contact law. For every contact law, one impulse J acts at the point of contact: the ball leaves
/// with velocity J / m and spin -(r n) x J / I. If some J removes a residual, its cause is the contact. If no J removes
/// it, it contradicts the kinematics (face direction, the instrument's definitions of speed and spin) or the inertia of
/// the ball.
#pragma once

#include "loop/shots/model.hpp"

namespace hosel::loop {

struct Balance {
  double contact = 0, inertia = 0;               ///< sums of squares of the two parts of the whitened residuals
  int contact_freedom = 0, inertia_freedom = 0;  ///< what they are expected to be where nothing is wrong

  /// Share of the excess over the noise that no contact law can mend; 0 where there is no excess.
  double inertia_share() const;
};

/// Of the rows, for the model's answers at the given parameters.
Balance balance(const ShotModel& shots, const std::vector<int>& rows, const Model& model, const double* parameters);

}  // namespace hosel::loop
