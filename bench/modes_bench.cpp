// The lowest modes of a ball of finite elements by shift-and-invert, beside all of them at once (dense). Ratios within
// one run.
#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>

#include "bench/cpu_time.hpp"
#include "fem/harmonic_solid.hpp"
#include "mesh/meridian.hpp"
#include "models/fe/fe_ball.hpp"
#include "solvers/linear.hpp"
#include "solvers/modes.hpp"

namespace {
using namespace hosel;

void Lowest(benchmark::State& state) {
  const int m = 2, count = 10, sector = int(state.range(0));
  const models::FeBall ball = models::range_ball();
  std::vector<double> radii;
  std::vector<fem::Solid> materials;
  for (const auto& layer : ball.layers) {
    radii.push_back(layer.radius * 0.02134);
    materials.push_back(layer.material);
  }
  const auto mesh = mesh::sphere_meridian(radii, {.sector = sector, .rings = sector, .pole = 1, .skin = 1});
  fem::System system;
  system.terms.push_back(std::make_unique<fem::HarmonicSolid>(system.dof_map, mesh, fem::cylindrical_basis(m),
                                                              fem::SolidQuadrature{fem::full_circle(4 * m + 5), 2},
                                                              materials, fem::Placement{}));
  for ([[maybe_unused]] auto _ : state) {
    double lowest = 0, all = 0;
    const double sparse =
        bench::seconds(1, [&] { lowest = solvers::modes(system, system.dof_map.rest(), count).omega.front(); });
    state.counters["equations"] = double(system.dof_map.size());
    state.counters["s"] = sparse;
    if (system.dof_map.size() > 4000) continue;  // dense: a minute and more
    const double dense = bench::seconds(1, [&] {
      solvers::SparseTangent tangent(system);
      tangent.assemble(system, system.dof_map.rest(), {1, 0, 0});
      const Eigen::MatrixXd K = tangent.dense();
      tangent.assemble(system, system.dof_map.rest(), {0, 0, 1});
      all = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(tangent.dense(), K).eigenvalues().tail(1)[0];
    });
    state.counters["dense_over_sparse"] = dense / sparse;
    state.counters["difference"] = std::sqrt(1 / all) / lowest - 1;
  }
}
BENCHMARK(Lowest)->Arg(2)->Arg(4)->Arg(6)->Arg(12)->ArgName("sector")->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
