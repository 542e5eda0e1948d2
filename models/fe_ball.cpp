#include "models/fe_ball.hpp"

#include <array>
#include <utility>

namespace hosel::models {

std::vector<std::string> FeBall::faults() const {
  std::vector<std::string> out;
  if (layers.empty()) out.emplace_back("a ball needs at least one layer");
  double inner = 0;
  for (const auto& layer : layers) {
    if (!(layer.radius > inner)) out.emplace_back("the layers' radii must increase from the inside");
    inner = layer.radius;
    for (const auto& fault : layer.material.faults()) out.push_back(fault);
  }
  if (!layers.empty() && layers.back().radius != 1) out.emplace_back("the outermost layer ends at the ball's radius");
  return out;
}

double FeBall::instant_young() const {
  double sum = 0, inner = 0;
  for (const auto& layer : layers) {
    const double g = layer.material.instant_shear(), k = layer.material.bulk();
    sum += (layer.radius * layer.radius * layer.radius - inner * inner * inner) * 9 * k * g / (3 * k + g);
    inner = layer.radius;
  }
  return sum;
}

FeBall elastic_ball(std::string name, fem::Solid material) { return {std::move(name), {{1, std::move(material)}}}; }

FeBall range_ball() {
  // Shear moduli and times set by hand to a normal restitution near 0.86 - 0.0029 v over 20-50 m/s and a
  // contact of 0.45 ms at 40 m/s on a rigid wall; bulk modulus of a filled rubber.
  fem::Solid rubber{.elastic = fem::Hyperelastic{.c10 = 12.5e6, .bulk = 1.0e9},
                    .branches = {{27e6, 2.0e-5}},
                    .density = 1129};
  return {"range-one-piece", {{1, rubber}}};
}

namespace {
constexpr std::array kBalls = {
    NamedFeBall{"range-one-piece", "one piece of viscoelastic rubber, calibrated by cases/calibrate-range-ball", range_ball},
};
}  // namespace

std::span<const NamedFeBall> ball_library() { return kBalls; }

}  // namespace hosel::models
