#include "hosel/models/fe_ball.hpp"

#include <array>
#include <utility>

#include "hosel/fem/materials/hyperelastic.hpp"

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

namespace {
fem::Solid rubber(double c10, double bulk, double density, double branch) {
  return {.elastic = fem::Hyperelastic{.c10 = c10, .bulk = bulk}, .branches = {{branch, 1e-5}}, .density = density};
}
}  // namespace

FeBall range_ball() { return {"range-one-piece", {{1, rubber(14.6827e6, 1e9, 1129, 56.2497e6)}}}; }

FeBall two_piece_ball() {
  return {"two-piece", {{0.91, rubber(13.3817e6, 1e9, 1150, 51.2032e6)}, {1, rubber(40.1452e6, 1.5e9, 960, 153.61e6)}}};
}

namespace {
FeBall three_piece_ball() {
  return {"three-piece",
          {{0.89, rubber(13.1366e6, 1e9, 1150, 50.1657e6)},
           {0.955, rubber(52.5462e6, 1.5e9, 960, 200.663e6)},
           {1, rubber(13.1366e6, 1.5e9, 1120, 50.1657e6)}}};
}

FeBall range_skin_ball() {
  return {"range-skin",
          {{0.91, rubber(13.9257e6, 1e9, 1129, 53.6697e6)}, {1, rubber(24.693e6, 1.3e9, 1129, 95.1535e6)}}};
}

constexpr std::array kBalls = {
    NamedFeBall{"range-one-piece", "one piece of viscoelastic rubber, as cases/calibrate-range-ball finds it",
                range_ball},
    NamedFeBall{"two-piece", "rubber core under a cover three times as stiff, as cases/calibrate-two-piece finds it",
                two_piece_ball},
    NamedFeBall{"three-piece",
                "rubber core, mantle four times as stiff, soft cover, as cases/calibrate-three-piece finds it",
                three_piece_ball},
    NamedFeBall{"range-skin",
                "one piece with a skin 1.77 times as stiff: saw three irons as well, cases/calibrate-range-skin",
                range_skin_ball},
};
}  // namespace

std::span<const NamedFeBall> ball_library() { return kBalls; }

}  // namespace hosel::models
