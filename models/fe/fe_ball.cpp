#include "models/fe/fe_ball.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "fem/harmonic_solid.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "golf/units.hpp"

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

namespace {

/// Sum of density times the difference of that power of a layer's radii, relative to the ball's [kg/m^3].
double of_density(const std::vector<BallLayer>& layers, int power) {
  double sum = 0, inner = 0;
  for (const auto& layer : layers) {
    sum += layer.material.density * (std::pow(layer.radius, power) - std::pow(inner, power));
    inner = layer.radius;
  }
  return sum;
}

}  // namespace

double FeBall::inertia_factor() const { return 0.4 * (of_density(layers, 5) / of_density(layers, 3)); }

double FeBall::mass(double radius) const { return 4.0 / 3.0 * kPi * std::pow(radius, 3) * of_density(layers, 3); }

MeshedBall meshed(const FeBall& ball, const Ball& body, const mesh::MeridianOptions& options) {
  std::vector<double> radii;
  std::vector<fem::Solid> materials;
  for (const BallLayer& layer : ball.layers) {
    radii.push_back(layer.radius * body.radius);
    materials.push_back(layer.material);
  }
  MeshedBall out{mesh::sphere_meridian(radii, options), std::move(materials)};
  const double scale = body.mass / fem::HarmonicSolid::mass(out.mesh, out.materials);
  for (fem::Solid& m : out.materials) m.density *= scale;
  return out;
}

FeBall elastic_ball(std::string name, fem::Solid material) { return {std::move(name), {{1, std::move(material)}}}; }

namespace {

/// As a file of the library has it.
struct Layer {
  double radius, c10, bulk, density, branch_modulus, branch_time;  // moduli in MPa, time in ms
};
struct NamedBall {
  const char* name;
  std::vector<Layer> layers;
};

std::vector<FeBall> shipped_balls() {
  const std::vector<NamedBall> named = {
#include "library/balls.inc"  // written by cmake/HoselLibrary.cmake
  };
  std::vector<FeBall> out;
  for (const NamedBall& ball : named) {
    out.push_back({ball.name, {}});
    for (const Layer& l : ball.layers)
      out.back().layers.push_back({l.radius,
                                   {.elastic = fem::Hyperelastic{.c10 = l.c10 * 1e6, .bulk = l.bulk * 1e6},
                                    .branches = {{l.branch_modulus * 1e6, l.branch_time * 1e-3}},
                                    .density = l.density}});
  }
  return out;
}

const FeBall& shipped_ball(std::string_view name) {
  const auto all = ball_library();
  return *std::ranges::find(all, name, &FeBall::name);
}

}  // namespace

std::span<const FeBall> ball_library() {
  static const std::vector<FeBall> all = shipped_balls();
  return all;
}

FeBall range_ball() { return shipped_ball("range-one-piece"); }
FeBall two_piece_ball() { return shipped_ball("two-piece"); }

}  // namespace hosel::models
