/// A shaft behind a head, both in one fem::System: what the full club adds to the free body.
#pragma once

#include "fem/beam.hpp"
#include "fem/supports.hpp"
#include "golf/blow.hpp"

namespace hosel::models {

enum class Grip {
  clamped,  ///< the butt goes on as it moved before the blow
  free,     ///< nothing holds the butt
  hands,    ///< springs and dampers to that motion
};

struct ShaftMount {
  Grip grip = Grip::clamped;
  fem::JointStiffness hands;  ///< for Grip::hands
  int elements = 16;
  /// Each element is this many times as long as the one before, butt to tip: the blow is felt first
  /// and shortest at the tip.
  double growth = 0.9;
  bool shear = true;  ///< Timoshenko; false: Rayleigh
};

/// Adds the shaft and its grip to the system. `head` is the node at the shaft's tip, its frame parallel
/// to the face frame; the club's ClubGeometry::shaft_axis is in that frame. Before the blow shaft and head
/// move as one rigid body with the pose and velocity that `initial` has at the head's node; the nodes'
/// entries of `initial` are written accordingly (`initial` grows with the layout). Returns the beam,
/// which the system owns.
const fem::Beam& mount_shaft(fem::System& system, fem::State& initial, const fem::Node& head, const Club& club,
                             const ShaftMount& mount);

}  // namespace hosel::models
