// A clamped face of varying thickness, with bulge and roll, by CalculiX (`ccx`, package calculix-ccx) and by the plate,
// in one run: natural frequencies, and the deflection under a ball's patch. A point load has no deflection of its own
// under it: where shear counts, that grows with the logarithm of the mesh.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "bench/calculix.hpp"
#include "golf/units.hpp"
#include "models/fe/plate_face.hpp"
#include "models/fe/plate_strike.hpp"

namespace {
using namespace hosel;
using Eigen::Vector2d;
namespace fs = std::filesystem;

constexpr int kModes = 5;
const Face kCurvature{.bulge = 0.305, .roll = 0.254};
const std::array kPlaces{Vector2d(0, 0), Vector2d(-0.018, 0.009)};  // of the loads

/// 90 x 50 mm of titanium, 3.4 mm at its centre and 2.4 mm at its rim.
models::PlateDesign design(const mesh::PlateMeshOptions& mesh) {
  return {.thickness = {.map = mesh::PlateThickness::Bulge{}}, .rim = {}, .mesh = mesh};
}

/// Of a unit force over models::kBallPatch, at the nodes of quadratic elements without centre [-].
constexpr std::array kRing{0, 2, 8, 6, 1, 5, 7, 3};  // of nine nodes: corners, then the middles behind them
std::map<int, double> patch(const mesh::PlateMesh& m, const Vector2d& place) {
  std::map<int, double> out;
  for (const auto& e : m.elements)
    for (const auto& [xi, wx] : {std::pair{-std::sqrt(0.6), 5.0}, {0.0, 8.0}, {std::sqrt(0.6), 5.0}})
      for (const auto& [eta, wy] : {std::pair{-std::sqrt(0.6), 5.0}, {0.0, 8.0}, {std::sqrt(0.6), 5.0}}) {
        const mesh::Q9 q = mesh::Q9::at(xi, eta);
        Vector2d at = Vector2d::Zero();
        Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
        for (int k = 0; k < 9; ++k) {
          const Vector2d& node = m.nodes[std::size_t(e[std::size_t(k)])];
          at += q.value[k] * node;
          J += node * q.derivative.row(k);
        }
        const double pressure = 1 - (at - place).squaredNorm() / (models::kBallPatch * models::kBallPatch);
        if (pressure <= 0) continue;
        for (std::size_t i = 0; i < 8; ++i) {  // the ninth shape function spread over the eight
          const double share = q.value[kRing[i]] + (i < 4 ? -0.25 : 0.5) * q.value[4];
          out[e[std::size_t(kRing[i])]] += share * pressure * wx * wy * J.determinant();
        }
      }
  double sum = 0;
  for (const auto& [node, share] : out) sum += share;
  for (auto& [node, share] : out) share /= sum;
  return out;
}

/// `layers` of bricks through the thickness, an even number: the middle is a level of nodes; 0: shells.
int node_levels(int layers) { return 2 * layers + 1; }

/// In mm, t, s, N. The first level of nodes is the inner side.
void write_deck(const fs::path& path, const mesh::PlateMesh& m, int layers) {
  const models::PlateDesign d = design({});
  auto out = fmt::output_file(path.string());
  const bool shells = layers == 0;
  const int levels = node_levels(layers), middle = levels / 2;
  const auto id = [&](int node, int level) { return node * levels + level + 1; };
  std::vector<int> used(m.nodes.size() * std::size_t(levels), 0);
  std::string elements, thickness, rim;
  int count = 0;
  for (const auto& e : m.elements)
    for (int layer = 0; layer < std::max(1, layers); ++layer) {
      std::vector<int> nodes;
      const auto add = [&](std::size_t from, std::size_t to, int level) {
        for (std::size_t i = from; i < to; ++i) nodes.push_back(id(e[std::size_t(kRing[i])], level));
      };
      const int low = 2 * layer;
      if (shells) {
        add(0, 8, 0);
      } else {
        add(0, 4, low), add(0, 4, low + 2), add(4, 8, low), add(4, 8, low + 2), add(0, 4, low + 1);
      }
      elements += bench::element_line(++count, nodes);
      for (const int node : nodes) used[std::size_t(node - 1)] = 1;
    }
  out.print("*NODE, NSET=ALL\n");
  for (std::size_t n = 0; n < m.nodes.size(); ++n) {
    const Vector2d& at = m.nodes[n];
    const double t = d.thickness.at(at, std::min(1.0, d.outline.share(at)));
    for (int level = 0; level < levels; ++level) {
      const int own = id(int(n), level);
      if (!used[std::size_t(own - 1)]) continue;
      const double off = levels > 1 ? t * (double(level) / (levels - 1) - 0.5) : 0;
      const Vec3 x = 1e3 * (kCurvature.point(at.x(), at.y()) + off * kCurvature.normal(at.x(), at.y()));
      out.print("{}, {:.12g}, {:.12g}, {:.12g}\n", own, x.x(), x.y(), x.z());
      thickness += fmt::format("{}, {:.12g}\n", own, 1e3 * t);
      if (m.on_rim[n]) rim += fmt::format("{},\n", own);
    }
  }
  out.print("*ELEMENT, TYPE={}, ELSET=FACE\n{}*NSET, NSET=RIM\n{}", shells ? "S8R" : "C3D20R", elements, rim);
  std::string loads[kPlaces.size()];
  for (std::size_t p = 0; p < kPlaces.size(); ++p) {
    out.print("*NSET, NSET=PATCH{}\n", p);
    for (const auto& [node, share] : patch(m, kPlaces[p])) {
      out.print("{},\n", id(node, middle));
      loads[p] += fmt::format("{}, 1, {:.12g}\n", id(node, middle), -1e3 * share);
    }
  }
  out.print("*BOUNDARY\nRIM, 1, {}\n", shells ? 6 : 3);
  out.print("*MATERIAL, NAME=TITANIUM\n*ELASTIC\n{:.9g}, {}\n*DENSITY\n{:.9g}\n", 1e-6 * d.material.young,
            d.material.poisson, 1e-12 * d.material.density);
  if (shells)
    out.print("*NODAL THICKNESS\n{}*SHELL SECTION, ELSET=FACE, MATERIAL=TITANIUM, NODAL THICKNESS\n1\n", thickness);
  else out.print("*SOLID SECTION, ELSET=FACE, MATERIAL=TITANIUM\n");
  out.print("*STEP\n*FREQUENCY\n{}\n*END STEP\n", kModes);
  for (std::size_t p = 0; p < kPlaces.size(); ++p)
    out.print("*STEP\n*STATIC\n*CLOAD, OP=NEW\n{}*NODE PRINT, NSET=PATCH{}\nU\n*END STEP\n", loads[p], p);
}

/// Frequencies [Hz]; mean deflection under each patch of 1 kN, weighed by its pressure [mm].
struct Answer {
  std::vector<double> frequencies, deflections;
};

Answer calculix(const mesh::PlateMesh& m, int layers) {
  const bench::Calculix ccx("face");
  write_deck(ccx.deck(), m, layers);
  if (!ccx.run()) return {};
  Answer out;
  std::ifstream in(ccx.results());
  const int levels = node_levels(layers);
  std::map<int, double> share;
  for (std::string line; std::getline(in, line);) {
    if (const auto at = line.find("PATCH"); at != std::string::npos) {
      share = patch(m, kPlaces.at(std::size_t(line.at(at + 5) - '0')));
      out.deflections.push_back(0);
    }
    std::istringstream row(line);
    int n = 0;
    double a = 0, b = 0, c = 0;
    if (!(row >> n >> a >> b >> c)) continue;
    if (share.empty()) {
      if (out.frequencies.size() < kModes) out.frequencies.push_back(c);
    } else {
      out.deflections.back() -= share.at((n - 1) / levels) * a;
    }
  }
  if (out.frequencies.size() < kModes || out.deflections.size() < kPlaces.size()) out = {};
  return out;
}

Answer plate(const mesh::PlateMeshOptions& mesh) {
  const models::PlateFace face(design(mesh), kCurvature);
  Answer out;
  for (std::size_t i = 0; i < kModes; ++i) out.frequencies.push_back(face.omega()[i] / (2 * kPi));
  for (const Vector2d& at : kPlaces) out.deflections.push_back(1e6 * face.compliance(at, models::kBallPatch));
  return out;
}

void Face90x50(benchmark::State& state) {
  if (!bench::Calculix::installed())
    return state.SkipWithError("SKIPPED: CalculiX is not installed (apt-get install calculix-ccx)");
  const int core = int(state.range(1));
  for (auto _ : state) {
    const Answer theirs = calculix(mesh::plate_mesh(design({}).outline, {core, core / 2}), int(state.range(0)));
    if (theirs.frequencies.empty()) return state.SkipWithError("ccx has not finished");
    const mesh::PlateMeshOptions own;
    const Answer ours = plate(own), finer = plate({2 * own.core, 2 * own.rings});
    const auto tell = [&](const std::string& name, const char* unit, double a, double fine, double b) {
      state.counters[fmt::format("{}_{}", name, unit)] = a;
      state.counters[fmt::format("{}_finer_percent", name)] = 100 * (fine / a - 1);
      state.counters[fmt::format("ccx_{}_{}", name, unit)] = b;
      state.counters[fmt::format("{}_off_percent", name)] = 100 * (a / b - 1);
    };
    for (std::size_t i = 0; i < kModes; ++i)
      tell(fmt::format("f{}", i + 1), "Hz", ours.frequencies[i], finer.frequencies[i], theirs.frequencies[i]);
    for (std::size_t p = 0; p < kPlaces.size(); ++p)
      tell(p == 0 ? "centre" : "aside", "mm_per_kN", ours.deflections[p], finer.deflections[p], theirs.deflections[p]);
  }
}
BENCHMARK(Face90x50)
    ->ArgNames({"layers", "core"})
    ->Args({0, 12})
    ->Args({0, 16})
    ->Args({0, 24})
    ->Args({2, 12})
    ->Args({2, 16})
    ->Args({4, 12})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
