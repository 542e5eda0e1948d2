/// The deformable ball as data: concentric layers of solid materials.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fem/materials/solid.hpp"
#include "golf/ball.hpp"
#include "mesh/meridian.hpp"

namespace hosel::models {

struct BallLayer {
  double radius = 1;    ///< outer, as a fraction of the ball's radius; the last layer's is 1
  fem::Solid material;  ///< its density counts relative to the other layers': the ball's mass is kept
};

struct FeBall {
  std::string name;
  std::vector<BallLayer> layers;  ///< from the inside

  /// Sentences naming what no ball can have; empty if all is well.
  std::vector<std::string> faults() const;
  /// Young's modulus at an instant, of the stiffest measure that contact time follows: volume mean [Pa].
  double instant_young() const;
  /// I / (m r^2) of the layers.
  double inertia_factor() const;
  /// By the densities of its layers [kg]; `radius` [m].
  double mass(double radius) const;
};

/// The layers on a mesh that weighs what the ball weighs.
struct MeshedBall {
  mesh::Meridian mesh;
  std::vector<fem::Solid> materials;  ///< of the layers, their densities scaled alike
};
MeshedBall meshed(const FeBall& ball, const Ball& body, const mesh::MeridianOptions& options);

/// One elastic layer; for comparison with theory.
FeBall elastic_ball(std::string name, fem::Solid material);
/// The shipped balls by name, for the floors that read no files: those of library/balls whose layers are neo-Hooke with
/// one Maxwell branch.
std::span<const FeBall> ball_library();

FeBall range_ball();      ///< "range-one-piece"
FeBall two_piece_ball();  ///< "two-piece"

}  // namespace hosel::models
