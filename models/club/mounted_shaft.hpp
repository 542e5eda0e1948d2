/// A shaft mounted on a head in one fem::System: the difference between full club and free body.
#pragma once

#include <optional>

#include "fem/beam.hpp"
#include "fem/supports.hpp"
#include "golf/blow.hpp"
#include "models/club/loaded_shaft.hpp"

namespace hosel::models {

enum class Grip {
  clamped,  ///< the butt goes on as it moved before the blow
  free,     ///< nothing holds the butt
  forced,   ///< the hands' wrench goes on as it was before the blow
  hands,    ///< that wrench, and springs and dampers to the motion before the blow
};

struct ShaftMount {
  Grip grip = Grip::clamped;
  fem::JointStiffness hands;  ///< for Grip::hands, grip axes
  int elements = 16;
  /// Each element is this many times as long as the one before, butt to tip: the blow is felt first
  /// and shortest at the tip.
  double growth = 0.9;
  bool shear = true;      ///< Timoshenko; false: Rayleigh
  HeadJoint joint;        ///< of a loaded shaft: as in its swing
  double grip_point = 0;  ///< arc length from the butt where the grip holds; the shaft above it is the hands' [m]
  /// The shaft at first contact; absent: straight, moving as one rigid body with the head.
  std::optional<LoadedShaft> loaded = {};
  /// Or what the hands do then: the full club finds the shaft that goes with it.
  std::optional<GripLoad> load = {};
};

/// The line of a mounted shaft in face axes, tip at the origin.
std::vector<mesh::LineNode> shaft_line(const Club& club, double grip_point, int elements, double growth);

/// Adds the shaft and its grip to the system. `head` is the node at the shaft's tip, its frame parallel
/// to the face frame; the club's ClubGeometry::shaft_axis is in that frame. The pose and velocity that
/// `initial` has at the head's node carry the shaft, straight or as `mount.loaded` says; the nodes'
/// entries of `initial` are written accordingly (`initial` grows with the layout). Returns the beam,
/// which the system owns. Throws std::invalid_argument where the loaded shaft has another mesh. Where the joint gives,
/// the loaded shaft's last node is its own, turned against the head as the swing left it.
const fem::Beam& mount_shaft(fem::System& system, fem::State& initial, const fem::Node& head, const Club& club,
                             const ShaftMount& mount);

}  // namespace hosel::models
