// The same impacts by CalculiX (`ccx`, package calculix-ccx) and by the ball, in one run: cost as CPU seconds of one
// core, and what each finds. The peer's mesh is the ball's own meridian swept about its axis: quadratic bricks
// (C3D20R), wedges at the axis; a wedge of 4 degrees for the normal blow, half a sphere for the oblique one.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <fmt/os.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "bench/calculix.hpp"
#include "fem/materials/linear_elastic.hpp"
#include "fem/materials/st_venant_kirchhoff.hpp"
#include "tests/support/elastic_sphere.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;
namespace fs = std::filesystem;

constexpr double kYoung = 60e6, kRadius = 0.021335, kMass = 0.04593;

struct ThrownSphere {
  double nu = 0.3, v_n = 0, v_t = 0, friction = 0;  ///< [-, m/s, m/s, -]
  bool finite = false;                              ///< St Venant-Kirchhoff, else linear
  mesh::MeridianOptions mesh;
  int sectors = 1;      ///< of the peer's sweep
  double span = kPi;    ///< of the sweep [rad]
  double duration = 0;  ///< [s]
  int steps = 0;        ///< of the duration
};

/// After contact, in the wall's frame.
struct Answer {
  double v_n = 0, v_t = 0, rim = 0, peak = 0;  ///< [m/s, m/s, R omega in m/s, N]
  double cpu = 0;                              ///< [s]
};

double cpu_seconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// CalculiX input in mm, N, s, t: z along the ball's axis, the contact pole down, x along the slip, y across it.
/// Returns the places of the plate's nodes.
std::map<int, Vec3> write_deck(const ThrownSphere& impact, const fs::path& path) {
  const mesh::Meridian m = mesh::sphere_meridian({1e3 * kRadius}, impact.mesh);
  const double half = impact.span / (2 * impact.sectors);  // angle between planes of nodes
  const bool wedge = impact.sectors == 1;
  auto out = fmt::output_file(path.string());
  std::map<std::pair<int, int>, int> ids;  // (meridian node, plane): even planes between sectors, odd amid them
  std::string nodes, rims;
  const auto id = [&](int node, int plane) {
    if (m.on_axis(node)) plane = 0;
    const auto [it, fresh] = ids.try_emplace({node, plane}, int(ids.size()) + 1);
    if (fresh) {
      const auto& p = m.nodes[std::size_t(node)];
      const double angle = half * plane, x = p.y() * std::cos(angle), y = p.y() * std::sin(angle);
      nodes += fmt::format("{}, {:.12g}, {:.12g}, {:.12g}\n", it->second, x, y, -p.x());
      const bool axis = m.on_axis(node);
      if (axis && wedge) rims += fmt::format("*BOUNDARY\n{}, 1, 2\n", it->second);
      else if (axis || plane == 0 || (plane == 2 * impact.sectors && !wedge))
        rims += fmt::format("*BOUNDARY\n{}, 2\n", it->second);
      else if (wedge)
        rims += fmt::format("*EQUATION\n2\n{0}, 2, {1:.12g}, {0}, 1, {2:.12g}\n", it->second, std::cos(angle),
                            -std::sin(angle));
    }
    return it->second;
  };
  std::string bricks, wedges, faces;
  int element = 0;
  for (int s = 0; s < impact.sectors; ++s)
    for (const auto& q : m.elements) {
      ++element;
      const int a = 2 * s, c = a + 1, b = a + 2;
      int outer = -1, axis = -1;
      for (int k = 0; k < 4; ++k) {
        if (m.on_axis(q[std::size_t(k)]) && m.on_axis(q[std::size_t((k + 1) % 4)])) axis = k;
        for (const auto& edge : m.surface)
          if (edge[2] == q[std::size_t(4 + k)] && m.nodes[std::size_t(edge[2])].x() > 0.6e3 * kRadius) outer = k;
      }
      std::vector<int> list;
      // The mesh's (s, rho) seen with z = -s: the second plane comes first, so that the volume is positive.
      const auto corner = [&](int k, int plane) { return id(q[std::size_t(k % 4)], plane); };
      const auto middle = [&](int k, int plane) { return id(q[std::size_t(4 + k % 4)], plane); };
      if (axis < 0) {
        for (const int plane : {b, a})
          for (int k = 0; k < 4; ++k) list.push_back(corner(k, plane));
        for (const int plane : {b, a})
          for (int k = 0; k < 4; ++k) list.push_back(middle(k, plane));
        for (int k = 0; k < 4; ++k) list.push_back(corner(k, c));
        if (outer >= 0) faces += fmt::format("{}, S{}\n", element, 3 + outer);
      } else {
        // Axis edge k, k + 1; triangles (k, k + 3 on both planes) and (k + 1, k + 2 on both).
        const int k = axis;
        list = {corner(k, a),     corner(k + 3, b), corner(k + 3, a), corner(k + 1, a), corner(k + 2, b),
                corner(k + 2, a), middle(k + 3, b), corner(k + 3, c), middle(k + 3, a), middle(k + 1, b),
                corner(k + 2, c), middle(k + 1, a), middle(k, a),     middle(k + 2, b), middle(k + 2, a)};
        if (outer >= 0) faces += fmt::format("{}, S{}\n", element, outer == (k + 3) % 4 ? 1 : 2);
      }
      (axis < 0 ? bricks : wedges) += bench::element_line(element, list);
    }
  std::map<int, Vec3> plate;
  const int first = int(ids.size()) + 1;
  const double bottom = -1e3 * kRadius, reach = 0.9e3 * kRadius, wide = wedge ? reach * std::sin(impact.span) : reach;
  for (const double z : {bottom - 2, bottom})
    for (const auto& [x, y] :
         {std::pair{wedge ? 0.0 : -reach, -1.0}, {reach, -1.0}, {reach, wide + 1}, {wedge ? 0.0 : -reach, wide + 1}})
      plate[first + int(plate.size())] = Vec3(x, y, z);
  out.print("*NODE, NSET=NBALL\n{}*ELEMENT, TYPE=C3D20R, ELSET=BALL\n{}*ELEMENT, TYPE=C3D15, ELSET=BALL\n{}", nodes,
            bricks, wedges);
  out.print("*NODE, NSET=NPLATE\n");
  for (const auto& [n, x] : plate) out.print("{}, {:.12g}, {:.12g}, {:.12g}\n", n, x.x(), x.y(), x.z());
  out.print("*ELEMENT, TYPE=C3D8, ELSET=PLATE\n{}", ++element);
  for (const auto& [n, x] : plate) out.print(", {}", n);
  out.print("\n{}*BOUNDARY\nNPLATE, 1, 3\n", rims);
  out.print("*MATERIAL, NAME=RUBBER\n*ELASTIC\n{}, {}\n*DENSITY\n{:.12g}\n", 1e-6 * kYoung, impact.nu,
            1e-3 * kMass / (4.0 / 3 * kPi * std::pow(1e3 * kRadius, 3)));
  out.print("*SOLID SECTION, ELSET=BALL, MATERIAL=RUBBER\n*SOLID SECTION, ELSET=PLATE, MATERIAL=RUBBER\n");
  out.print("*SURFACE, NAME=SBALL, TYPE=ELEMENT\n{}*SURFACE, NAME=SPLATE, TYPE=ELEMENT\n{}, S2\n", faces, element);
  out.print("*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n5000.\n");
  if (impact.friction > 0) out.print("*FRICTION\n{}, 200.\n", impact.friction);
  out.print("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE\nSBALL, SPLATE\n");
  out.print("*INITIAL CONDITIONS, TYPE=VELOCITY\nNBALL, 3, {:.12g}\nNBALL, 1, {:.12g}\n", -1e3 * impact.v_n,
            1e3 * impact.v_t);
  const double step = impact.duration / impact.steps;
  out.print("*STEP, INC=100000{}\n*DYNAMIC, ALPHA=-0.05\n{:g}, {:g}, {:g}, {:g}\n", impact.finite ? ", NLGEOM" : "",
            step, impact.duration, 1e-5 * step, step);
  out.print("*NODE PRINT, NSET=NPLATE, FREQUENCY=1\nRF\n*END STEP\n");
  return plate;
}

/// Momentum and angular momentum from the forces on the plate's nodes.
Answer read_answer(const ThrownSphere& impact, const fs::path& path, const std::map<int, Vec3>& plate) {
  const double share = impact.span / (2 * kPi), mass = kMass * share;
  std::ifstream in(path);
  std::string line;
  double time = 0;
  Vec3 velocity(impact.v_t, 0, -impact.v_n), place = Vec3::Zero(),
                                             spin = Vec3::Zero();  // spin: angular momentum about the origin
  Answer out;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double step = 0;
  const auto apply = [&] {
    velocity += step / mass * force;
    spin += step * moment;
    place += step * velocity;
    out.peak = std::max(out.peak, force.z() / share);
    force = moment = Vec3::Zero();
  };
  while (std::getline(in, line)) {
    if (const auto at = line.find("time"); at != std::string::npos) {
      apply();
      const double now = std::stod(line.substr(at + 4));
      step = now - time;
      time = now;
      continue;
    }
    std::istringstream row(line);
    int node = 0;
    Vec3 f;
    if (!(row >> node >> f.x() >> f.y() >> f.z())) continue;
    force += f;  // what holds the plate is what pushes the ball
    moment += (1e-3 * plate.at(node)).cross(f);
  }
  apply();
  const Vec3 own = spin - place.cross(mass * velocity);
  out.v_n = velocity.z();
  out.v_t = velocity.x();
  out.rim = kRadius * own.y() / (0.4 * mass * kRadius * kRadius);
  return out;
}

std::optional<Answer> calculix(const ThrownSphere& impact) {
  const bench::Calculix ccx("impact");
  const auto plate = write_deck(impact, ccx.deck());
  const double before = cpu_seconds(RUSAGE_CHILDREN);
  const bool done = ccx.run();
  const double cpu = cpu_seconds(RUSAGE_CHILDREN) - before;
  if (!done) return {};
  Answer out = read_answer(impact, ccx.results(), plate);
  out.cpu = cpu;
  return out;
}

Answer hosel(const ThrownSphere& impact, const mesh::MeridianOptions& mesh, int harmonics, int steps, double penalty) {
  FeImpactOptions o;
  const fem::Lame lame = fem::Lame::of(kYoung, impact.nu);
  fem::Solid rubber{.elastic = fem::LinearElastic{lame}, .branches = {}, .density = 1129};
  if (impact.finite) rubber.elastic = fem::StVenantKirchhoff{lame};
  o.ball = elastic_ball("sphere", rubber);
  o.mesh = mesh;
  o.harmonics = harmonics;
  o.steps_per_contact = steps;
  o.penalty = penalty;
  o.newton_relative = 1e-5;
  const double before = cpu_seconds(RUSAGE_SELF);
  const test::Bounce b = test::bounce(o, impact.v_n, impact.v_t, impact.friction);
  return {b.v_n, b.v_t, b.rim, b.peak_force, cpu_seconds(RUSAGE_SELF) - before};
}

void report(benchmark::State& state, const ThrownSphere& impact, const mesh::MeridianOptions& mesh, int harmonics,
            int steps, double penalty) {
  for (auto _ : state) {
    if (!bench::Calculix::installed()) {
      state.SkipWithError("CalculiX is not installed (apt-get install calculix-ccx)");
      return;
    }
    const Answer ours = hosel(impact, mesh, harmonics, steps, penalty);
    const std::optional<Answer> peer = calculix(impact);
    if (!peer) {
      state.SkipWithError("ccx has not finished the impact");
      return;
    }
    for (const auto& [name, a] : {std::pair{"", ours}, {"ccx_", *peer}}) {
      const std::string prefix = name;
      state.counters[prefix + "v_n"] = a.v_n;
      state.counters[prefix + "peak_N"] = a.peak;
      state.counters[prefix + "cpu_s"] = a.cpu;
      if (impact.v_t == 0) continue;
      state.counters[prefix + "v_t"] = a.v_t;
      state.counters[prefix + "R_omega"] = a.rim;
    }
    state.counters["times_cheaper"] = peer->cpu / ours.cpu;
  }
}

/// 10 m/s, linear, nu = 0.45.
void Normal(benchmark::State& state) {
  const int n = int(state.range(0));
  const mesh::MeridianOptions mesh{.sector = n, .rings = n, .pole = 0.5, .skin = 0.5, .core = 0.4};
  report(state,
         {.nu = 0.45, .v_n = 10, .mesh = mesh, .sectors = 1, .span = radians(4), .duration = 0.9e-3, .steps = 180},
         mesh, 0, 120, 1000);
}
BENCHMARK(Normal)->Arg(3)->Arg(4)->ArgName("elements_per_45_degrees")->Iterations(1)->Unit(benchmark::kSecond);

/// 10 m/s at 25 degrees, St Venant-Kirchhoff, nu = 0.3, friction 0.3. An explicit half sphere of 16,740 elements has
/// v_n 9.065, v_t 2.065, R omega 5.014 m/s and 1830 N. Stick at 5000 N/mm^3 as the pressure, ccx does not converge.
void Oblique(benchmark::State& state) {
  const int n = int(state.range(0));
  const mesh::MeridianOptions mesh{.sector = n, .rings = n, .pole = 0.5, .skin = 0.5, .core = 0.4};
  report(state,
         {.nu = 0.3,
          .v_n = 10 * std::cos(radians(25)),
          .v_t = 10 * std::sin(radians(25)),
          .friction = 0.3,
          .finite = true,
          .mesh = mesh,
          .sectors = 4 * n,
          .span = kPi,
          .duration = 0.95e-3,
          .steps = 120},
         mesh, n == 2 ? 2 : 3, n == 2 ? 40 : 80, n == 2 ? 200 : 500);
}
BENCHMARK(Oblique)->Arg(2)->Arg(3)->ArgName("elements_per_45_degrees")->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
