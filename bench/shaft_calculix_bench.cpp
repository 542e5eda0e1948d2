// A clamped, tapered tube by CalculiX (`ccx`, package calculix-ccx) and by the beam, in one run: natural frequencies,
// and the tip's motion after a blow on it. The peer has no beam theory: half the tube in quadratic bricks (C3D20R).
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "bench/calculix.hpp"
#include "solvers/generalized_alpha.hpp"
#include "solvers/modes.hpp"
#include "tests/support/beams.hpp"

namespace {
using namespace hosel;
namespace fs = std::filesystem;

// The tube of test::b2, in mm, t, s, N.
constexpr double kLength = 1000, kWall = 0.4, kYoung = 205e3, kShear = 79e3, kDensity = 7850e-12;
double outer_radius(double x) { return 0.5 * (15.2 + (9.4 - 15.2) * x / kLength); }

// A half-sine push across the tip.
constexpr double kPush = 20, kPushed = 1e-3, kEnd = 20e-3, kStep = 20e-6;  // [N, s, s, s]
double push(double t) { return t < kPushed ? kPush * std::sin(kPi * t / kPushed) : 0; }

/// x along the tube, z across it in the plane of symmetry y = 0. Returns the nodes of the tip's face, each with its
/// share of the end's force and of its mean displacement.
std::map<int, double> write_deck(const fs::path& path, int along, int around, const std::string& step) {
  auto out = fmt::output_file(path.string());
  std::map<std::array<int, 3>, int> ids;
  std::string nodes, elements, clamped, middle;
  std::map<int, double> tip;
  const auto id = [&](int i, int j, int k) {  // half elements along, around, across the wall
    const auto [it, fresh] = ids.try_emplace({i, j, k}, int(ids.size()) + 1);
    if (fresh) {
      const double x = kLength * i / (2 * along), angle = kPi * j / (2 * around),
                   r = outer_radius(x) - kWall * (1 - k / 2.0);
      nodes += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", it->second, x, r * std::sin(angle), r * std::cos(angle));
      if (i == 0) clamped += fmt::format("{},\n", it->second);
      else if (j == 0 || j == 2 * around) middle += fmt::format("{},\n", it->second);
    }
    return it->second;
  };
  for (int a = 0; a < along; ++a)
    for (int b = 0; b < around; ++b) {
      const int i = 2 * a, j = 2 * b;
      // Local axes: along, around (clockwise seen from the butt), outwards: a left-handed triad is turned by order.
      const std::array<std::array<int, 3>, 20> list{
          {{i, j, 0},         {i, j, 2},         {i, j + 2, 2},     {i, j + 2, 0},     {i + 2, j, 0},
           {i + 2, j, 2},     {i + 2, j + 2, 2}, {i + 2, j + 2, 0}, {i, j, 1},         {i, j + 1, 2},
           {i, j + 2, 1},     {i, j + 1, 0},     {i + 2, j, 1},     {i + 2, j + 1, 2}, {i + 2, j + 2, 1},
           {i + 2, j + 1, 0}, {i + 1, j, 0},     {i + 1, j, 2},     {i + 1, j + 2, 2}, {i + 1, j + 2, 0}}};
      // CalculiX wants the first face anticlockwise seen against its outward normal.
      std::vector<int> brick;
      for (const std::size_t n : {0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17})
        brick.push_back(id(list[n][0], list[n][1], list[n][2]));
      elements += bench::element_line(a * around + b + 1, brick);
      if (a + 1 == along)
        for (const std::size_t n : {4, 5, 6, 7, 12, 13, 14, 15}) {
          const auto& c = list[n];
          tip[id(c[0], c[1], c[2])] += (n < 8 ? -1.0 / 12 : 1.0 / 3) / around;
        }
    }
  std::string ends, loads;
  for (const auto& [n, share] : tip) {
    ends += fmt::format("{},\n", n);
    loads += fmt::format("{}, 3, {:.12g}\n", n, 0.5 * kPush * share);  // half the tube, half the force
  }
  out.print("*NODE, NSET=ALL\n{}*ELEMENT, TYPE=C3D20R, ELSET=TUBE\n{}", nodes, elements);
  out.print("*NSET, NSET=BUTT\n{}*NSET, NSET=MIDDLE\n{}*NSET, NSET=TIP\n{}", clamped, middle, ends);
  out.print("*BOUNDARY\nBUTT, 1, 3\nMIDDLE, 2\n");
  out.print("*MATERIAL, NAME=STEEL\n*ELASTIC\n{}, {:.12g}\n*DENSITY\n{:.12g}\n", kYoung, kYoung / (2 * kShear) - 1,
            kDensity);
  out.print("*SOLID SECTION, ELSET=TUBE, MATERIAL=STEEL\n");
  if (step == "modes") {
    out.print("*STEP\n*FREQUENCY\n4\n*END STEP\n");
  } else {
    out.print("*AMPLITUDE, NAME=PUSH\n");
    for (int i = 0; i <= 50; ++i) out.print("{:.9g}, {:.9g}\n", kPushed * i / 50, push(kPushed * i / 50) / kPush);
    out.print("{}, 0\n", kEnd);
    out.print("*STEP, INC=100000\n*DYNAMIC, DIRECT, ALPHA=0\n{}, {}\n*CLOAD, AMPLITUDE=PUSH\n{}", kStep, kEnd, loads);
    out.print("*NODE PRINT, NSET=TIP, FREQUENCY=1\nU\n*END STEP\n");
  }
  return tip;
}

struct Peer {
  std::map<int, double> tip;
  std::string dat;  ///< the text of ccx's results; empty where it failed
};
Peer calculix(int along, int around, const std::string& step) {
  const bench::Calculix ccx("tube");
  Peer out{write_deck(ccx.deck(), along, around, step), {}};
  if (!ccx.run()) return out;
  std::ifstream in(ccx.results());
  out.dat.assign(std::istreambuf_iterator<char>(in), {});
  return out;
}

bool without_peer(benchmark::State& state) {
  if (bench::Calculix::installed()) return false;
  state.SkipWithError("SKIPPED: CalculiX is not installed (apt-get install calculix-ccx)");
  return true;
}

test::BeamSystem tube(int elements) {
  test::BeamSystem b(mesh::straight(mesh::graded(1, elements), Vec3::Zero(), Mat3::Identity()),
                     test::b2(test::Theory::timoshenko));
  b.clamp_first();
  return b;
}

/// The first three frequencies of bending [Hz].
void Frequencies(benchmark::State& state) {
  for (auto _ : state) {
    if (without_peer(state)) return;
    const Peer peer = calculix(int(state.range(0)), 8, "modes");
    std::istringstream in(peer.dat);
    std::vector<double> theirs;
    for (std::string line; std::getline(in, line) && theirs.size() < 3;) {
      std::istringstream row(line);
      int mode = 0;
      double eigenvalue = 0, omega = 0, hertz = 0;
      if (row >> mode >> eigenvalue >> omega >> hertz) theirs.push_back(hertz);
    }
    if (theirs.size() < 3) return state.SkipWithError("ccx has found no modes");
    const test::BeamSystem b = tube(40);
    const std::vector<double> omega = solvers::modes(b.system, b.rest, 6).omega;  // each twice: the tube is round
    const test::BeamSystem fine = tube(80);
    const std::vector<double> finer = solvers::modes(fine.system, fine.rest, 6).omega;
    for (int i = 0; i < 3; ++i) {
      const double ours = omega[std::size_t(2 * i)] / (2 * kPi);
      state.counters[fmt::format("f{}_Hz", i + 1)] = ours;
      state.counters[fmt::format("f{}_finer_percent", i + 1)] =
          100 * (finer[std::size_t(2 * i)] / omega[std::size_t(2 * i)] - 1);
      state.counters[fmt::format("ccx_f{}_Hz", i + 1)] = theirs[std::size_t(i)];
      state.counters[fmt::format("off{}_percent", i + 1)] = 100 * (ours / theirs[std::size_t(i)] - 1);
    }
  }
}
BENCHMARK(Frequencies)->Arg(40)->Arg(80)->ArgName("bricks_along")->Iterations(1)->Unit(benchmark::kSecond);

/// A half-sine push of 1 ms across the tip: the tip's displacement over 20 ms.
void TipResponse(benchmark::State& state) {
  for (auto _ : state) {
    if (without_peer(state)) return;
    const Peer peer = calculix(40, 8, "blow");
    std::map<double, double> theirs;  // mean displacement over time [s, m]
    double time = -1;
    std::istringstream in(peer.dat);
    for (std::string line; std::getline(in, line);) {
      if (const auto at = line.find("time"); at != std::string::npos) time = std::stod(line.substr(at + 4));
      std::istringstream row(line);
      int node = 0;
      Vec3 u;
      if (row >> node >> u.x() >> u.y() >> u.z()) theirs[time] += 1e-3 * peer.tip.at(node) * u.z();
    }
    if (theirs.size() < 100) return state.SkipWithError("ccx has not finished the blow");
    test::BeamSystem b = tube(40);
    b.load(b.tip(), [](double t) { return fem::Wrench{.force = {0, 0, push(t)}}; });
    solvers::GeneralizedAlpha scheme(
        b.system, {.rho_inf = 1, .newton = test::tight(), .step_max = kStep, .step_min = kStep / 64}, b.rest);
    double largest = 0, peer_largest = 0, apart = 0, square = 0;
    for (const auto& [t, u] : theirs) {
      while (scheme.time() < t * (1 - 1e-9)) scheme.advance(t);
      const double ours = b.tip_displacement(scheme.state()).z();
      largest = std::max(largest, ours);
      peer_largest = std::max(peer_largest, u);
      apart = std::max(apart, std::abs(ours - u));
      square += (ours - u) * (ours - u) / double(theirs.size());
    }
    state.counters["largest_mm"] = 1e3 * largest;
    state.counters["ccx_largest_mm"] = 1e3 * peer_largest;
    state.counters["off_percent"] = 100 * (largest / peer_largest - 1);
    state.counters["apart_percent"] = 100 * apart / peer_largest;
    state.counters["rms_percent"] = 100 * std::sqrt(square) / peer_largest;
  }
}
BENCHMARK(TipResponse)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
