/// The deformable ball as data: concentric layers of solid materials.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hosel/fem/materials/solid.hpp"
#include "hosel/golf/ball.hpp"

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
};

/// One elastic layer; for comparison with theory.
FeBall elastic_ball(std::string name, fem::Solid material);
struct NamedFeBall {
  std::string_view name;
  std::string_view what;  ///< one sentence for `hosel list`
  FeBall (*make)();
};
/// Balls by name, each calibrated to normal restitution and contact time alone.
std::span<const NamedFeBall> ball_library();

/// Nearly incompressible neo-Hooke with one Maxwell branch in each layer.
FeBall range_ball();
FeBall two_piece_ball();

}  // namespace hosel::models
