// Where an impact's time goes, and how it grows with the mesh. Ratios within one run.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include <Eigen/LU>

#include "bench/cpu_time.hpp"
#include "golf/face_library.hpp"
#include "golf/units.hpp"
#include "models/fe/impact.hpp"
#include "solvers/contact_newton.hpp"

namespace {
using namespace hosel;
using namespace hosel::models;
using bench::seconds;

Blow oblique() {
  Blow b;
  b.club.head.mass = INFINITY;
  b.delivery = {.club_speed = 40, .club_path = radians(25)};
  return b;
}

FeImpactOptions options(int sector, int harmonics) {
  FeImpactOptions o;
  o.harmonics = harmonics;
  o.mesh = {.sector = sector, .rings = sector, .pole = 0.5, .skin = 0.5, .core = 0.4};
  o.steps_per_contact = 60;
  return o;
}

/// A blow and its system at the largest force, with what is kept of the tangent there.
struct AtPeak {
  AtPeak(const FeImpactOptions& o, const Blow& blow)
      : impact(Impact(o).assemble(blow)),
        smooth(impact.system, solvers::SparseTangent::Terms::smooth),
        abrupt(smooth),
        inertia(fem::Vector::Zero(impact.system.dof_map.size())),
        internal(inertia) {
    double force = 0;
    const auto at_peak = [&](const ImpactView& view) {
      if (view.report.normal_force > force) force = view.report.normal_force, peak = view.state;
    };
    whole = seconds(1, [&] { counts = Impact(o).run(blow, at_peak).result.counts; });
    impact.contact->start(impact.initial);
    touch();
    assemble();
    apart = solvers::weakly_coupled(impact.system, smooth);
    definite = factorise();
  }
  void ball_residual() { impact.ball->residual(peak, inertia, internal); }
  void contact_residual() { impact.contact->residual(peak, inertia, internal); }
  void energies() { benchmark::DoNotOptimize(impact.ball->energies(peak)); }
  void touch() {
    abrupt.clear();
    impact.contact->tangent(peak, weights, abrupt);
  }
  void assemble() { smooth.assemble(impact.system, peak, weights); }
  bool factorise() { return factors.factorise(smooth, abrupt.touched(), apart); }
  void dense_factors() {
    const auto kept = static_cast<Eigen::Index>(factors.kept().size());
    benchmark::DoNotOptimize((factors.schur() + abrupt.on(factors.places(), kept)).partialPivLu().matrixLU().sum());
  }
  void solve(const fem::Vector& right) {
    const Eigen::VectorXf half = factors.eliminate(right);
    benchmark::DoNotOptimize(factors.recover(half, factors.condensed(half)));
  }

  ImpactBodies impact;
  solvers::SparseTangent smooth;
  solvers::DenseTangent abrupt;
  solvers::CondensedFactorisation factors;
  fem::Vector inertia, internal;
  fem::Weights weights{1, 0, 1e10};
  solvers::GeneralizedAlpha::Counts counts;
  fem::State peak;
  std::vector<char> apart;
  double whole = 0;       ///< CPU time of the blow [s]
  bool definite = false;  ///< the ball's tangent is positive definite
};

/// Unit costs at largest force times how often each was needed, over the time of the whole run (one factorisation more
/// than counted: the first accelerations); and one solution of the linear system by LU of the whole tangent, as it was
/// once done, over one by what is kept of it.
void Shares(benchmark::State& state) {
  for (auto _ : state) {
    AtPeak at(options(3, 3), oblique());
    if (!at.definite) return state.SkipWithError("the ball's tangent is not positive definite");
    solvers::SparseTangent all(at.impact.system);
    solvers::Factorisation lu;
    all.assemble(at.impact.system, at.peak, at.weights);
    lu.factorise(all);
    const double whole = at.whole;
    const double ball = seconds(20, [&] { at.ball_residual(); });
    const double contact = seconds(20, [&] { at.contact_residual(); });
    const double assembly = seconds(5, [&] { at.assemble(); });
    const double factorisation = seconds(5, [&] { at.factorise(); });
    const double dense = seconds(20, [&] {
      at.touch();
      at.dense_factors();
    });
    const double stock = seconds(5, [&] { at.energies(); });
    const fem::Vector right = at.smooth.gather(at.internal);
    const double solve = seconds(20, [&] { at.solve(right); });
    const auto n = double(at.counts.iterations), f = double(at.counts.factorisations),
               d = double(at.counts.dense_factorisations), steps = double(at.counts.steps);
    state.counters["share_ball_residual"] = (n + steps) * ball / whole;
    state.counters["share_contact"] = (n + steps) * contact / whole;
    state.counters["share_tangent_assembly"] = f * assembly / whole;
    state.counters["share_factorisation"] = f * factorisation / whole;
    state.counters["share_contact_tangent"] = d * dense / whole;
    state.counters["share_solves"] = n * solve / whole;
    // An accepted step looks at every element twice: for its energies and for its history.
    const double accepted = 2 * steps * stock;
    state.counters["share_accepted_steps"] = accepted / whole;
    state.counters["share_of_elements_factors_solves"] =
        ((n + steps) * ball + n * solve + (f + 1) * (assembly + factorisation) + d * dense + accepted) / whole;
    state.counters["lu_over_kept_factorisation"] = seconds(2, [&] { lu.factorise(all); }) / factorisation;
    state.counters["lu_over_kept_solve"] = seconds(20, [&] { benchmark::DoNotOptimize(lu.solve(right)); }) / solve;
    state.counters["seconds"] = whole;
  }
}
BENCHMARK(Shares)->Iterations(1)->Unit(benchmark::kSecond);

/// cases/iron7-trackman.
Blow iron7() {
  Blow blow;
  blow.delivery = {.club_speed = 36.747,
                   .attack_angle = radians(-1.9),
                   .club_path = radians(0.4),
                   .dynamic_loft = radians(22.06),
                   .face_angle = radians(-1.1),
                   .impact_toe = -0.005,
                   .impact_high = -0.004};
  blow.club.head.mass = 0.2643;
  blow.club.head.cg = Vec3(-0.0011, 0, 0);
  blow.club.head.inertia = Vec3(2.752e-4, 0.577e-4, 2.889e-4).asDiagonal();
  return blow;
}

/// `accuracy` of a case, 0 look, 1 default, 2 reference: what it costs, and how far it is from the last.
void AccuracyLevels(benchmark::State& state) {
  const Blow blow = iron7();
  for (auto _ : state) {
    Launch launch[2];
    double cost[2];
    for (int i = 0; i < 2; ++i) {
      FeImpactOptions o;
      o.resolve(i ? Accuracy::reference : static_cast<Accuracy>(state.range(0)));
      cost[i] = seconds(1, [&] { launch[i] = Impact(o).run(blow).launch; });
    }
    const auto angle = [](const Launch& l) { return std::atan2(l.velocity.z(), l.velocity.x()); };
    state.counters["seconds"] = cost[0];
    state.counters["reference_over_this"] = cost[1] / cost[0];
    state.counters["ball_speed_off_%"] = 100 * (launch[0].velocity.norm() / launch[1].velocity.norm() - 1);
    state.counters["launch_angle_off_%"] = 100 * (angle(launch[0]) / angle(launch[1]) - 1);
    state.counters["spin_off_%"] = 100 * (launch[0].spin.norm() / launch[1].spin.norm() - 1);
  }
}
BENCHMARK(AccuracyLevels)->Arg(0)->Arg(1)->ArgName("level")->Iterations(1)->Unit(benchmark::kSecond);

/// Multiplications and additions a second, of a matrix product that fits the core's cache.
double peak_operations() {
  constexpr Eigen::Index n = 192;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n), b = a;
  Eigen::MatrixXd c(n, n);
  double best = 0;
  for (int i = 0; i < 5; ++i)
    best = std::max(best, 2.0 * n * n * n / seconds(40, [&] {
                            c.noalias() = a * b;
                            benchmark::DoNotOptimize(c.data());
                          }));
  return best;
}

/// Bytes a second, read again and again from a field of this size.
double read_rate(std::size_t bytes) {
  const Eigen::VectorXf field = Eigen::VectorXf::Ones(Eigen::Index(bytes / sizeof(float)));
  double best = 0;
  for (int i = 0; i < 5; ++i)
    best = std::max(best, double(bytes) / seconds(20, [&] { benchmark::DoNotOptimize(field.sum()); }));
  return best;
}

/// What a free-body 7-iron at an accuracy spends its time on, on one core, beside what this machine could do at best:
/// the larger of a unit's operations at the rate of a matrix product and of its factors' bytes at the rate at which as
/// large a field is read. Operations are those of the products of matrices: what materials and gaps take is not
/// counted.
void Roofline(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  FeImpactOptions o;
  o.resolve(static_cast<Accuracy>(state.range(0)));
  for (auto _ : state) {
    AtPeak at(o, iron7());
    if (!at.definite) return state.SkipWithError("the ball's tangent is not positive definite");
    const auto& factors = at.factors;
    const fem::HarmonicSolid& ball = *at.impact.ball;
    constexpr double P = 4;  // Gauss points of an element
    const auto K = double(ball.unknowns()), elements = double(ball.mesh().elements.size()),
               angles = double(2 * o.harmonics + 4);
    double functions[3] = {};  // of each direction
    for (const fem::AngularFunction& f : ball.basis())
      for (int c = 0; c < 3; ++c) functions[c] += f.cosine[c] != 0 || f.sine[c] != 0;
    double pairs = 0;
    for (int c = 0; c < 3; ++c)
      for (int d = c; d < 3; ++d) pairs += functions[c] * functions[d];
    const std::vector<fem::ContactPoint> points = at.impact.contact->points(at.peak);
    const double stations = double(std::ranges::count_if(points, [](const auto& p) { return p.pressure > 0; })) /
                            double(3 * o.harmonics + 8);

    const double rate = peak_operations();
    const auto n = double(at.counts.iterations), f = double(at.counts.factorisations) + 1,
               d = double(at.counts.dense_factorisations), steps = double(at.counts.steps);
    const auto tell = [&](const std::string& unit, double times, double operations, double bytes, double spent) {
      const double limit = std::max(operations / rate, bytes > 0 ? bytes / read_rate(std::size_t(bytes / 2)) : 0.0);
      state.counters[unit + "_share"] = times * spent / at.whole;
      state.counters[unit + "_us"] = 1e6 * spent;
      state.counters[unit + "_limit_us"] = 1e6 * limit;
      state.counters[unit + "_over_limit"] = spent / limit;
    };
    const double gradients = elements * (48 * K * P + 6 * angles * K * P);
    tell("residual", n + steps, 2 * gradients + elements * 128 * K, 0, seconds(50, [&] { at.ball_residual(); }));
    tell("energies", 2 * steps, gradients, 0, seconds(50, [&] { at.energies(); }));
    tell("assembly", f, elements * pairs * 18 * P * (angles + 64), 0, seconds(10, [&] { at.assemble(); }));
    tell("factorisation", f, factors.operations(), 0, seconds(10, [&] { at.factorise(); }));
    const fem::Vector right = at.smooth.gather(at.internal);
    tell("solve", n, 4 * double(factors.entries()), 8 * double(factors.entries()),
         seconds(50, [&] { at.solve(right); }));
    const double columns = K + 6;
    tell("contact", n + steps, stations * 18 * K * (3 * o.harmonics + 8), 0,
         seconds(50, [&] { at.contact_residual(); }));
    tell("contact_tangent", d, stations * 6 * (3 * o.harmonics + 8) * columns * (columns + 3), 0,
         seconds(20, [&] { at.touch(); }));
    tell("dense_factors", d, 2.0 / 3 * std::pow(double(factors.kept().size()), 3), 0,
         seconds(20, [&] { at.dense_factors(); }));
    state.counters["Gflop_per_s"] = 1e-9 * rate;
    state.counters["GB_per_s_of_the_factors"] = 1e-9 * read_rate(4 * factors.entries());
    state.counters["GB_per_s_of_memory"] = 1e-9 * read_rate(std::size_t{1} << 28);
    state.counters["seconds"] = at.whole;
  }
}
BENCHMARK(Roofline)->Arg(0)->Arg(1)->Arg(2)->ArgName("level")->Iterations(1)->Unit(benchmark::kSecond);

/// One blow on one core and on two, in turn. `alone`: by the time that the calling thread worked, which is the wall
/// time where nothing else runs.
void TwoCores(benchmark::State& state) {
  const Blow blow = iron7();
  FeImpactOptions o;
  o.resolve(static_cast<Accuracy>(state.range(0)));
  const auto now = [](clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  };
  constexpr clockid_t kClocks[] = {CLOCK_MONOTONIC, CLOCK_THREAD_CPUTIME_ID, CLOCK_PROCESS_CPUTIME_ID};
  for (auto _ : state) {
    double spent[3][2] = {};
    for (int i = 0; i < 6; ++i) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(1 + i % 2));
      double start[3];
      for (int k = 0; k < 3; ++k) start[k] = now(kClocks[k]);
      benchmark::DoNotOptimize(Impact(o).run(blow).launch);
      for (int k = 0; k < 3; ++k) spent[k][i % 2] += now(kClocks[k]) - start[k];
    }
    state.counters["wall_one_over_two"] = spent[0][0] / spent[0][1];
    state.counters["alone_one_over_two"] = spent[1][0] / spent[1][1];
    state.counters["cpu_two_over_one"] = spent[2][1] / spent[2][0];
  }
}
BENCHMARK(TwoCores)->Arg(0)->Arg(1)->ArgName("level")->Iterations(1)->Unit(benchmark::kSecond);

/// An augmented Lagrangian of `contact` against the penalty, by the penetration that it may leave [1e-5 of the radius].
void Multipliers(benchmark::State& state) {
  FeImpactOptions penalty, other;
  penalty.resolve(Accuracy::standard);
  other = penalty;
  other.method = "augmented-lagrangian";
  other.penetration = 1e-5 * double(state.range(0));
  for (auto _ : state) {
    FeOutcome out[2];
    double cpu[2];
    for (int i = 0; i < 2; ++i) cpu[i] = seconds(1, [&] { out[i] = Impact(i ? other : penalty).run(iron7()); });
    state.counters["penetration_um"] = 1e6 * out[1].result.penetration;
    state.counters["penetration_of_the_penalty_um"] = 1e6 * out[0].result.penetration;
    const auto over = [&](auto of) { return 100 * (of(out[1].launch) / of(out[0].launch) - 1); };
    state.counters["ball_speed_over_penalty_%"] = over([](const Launch& l) { return l.ball_speed(); });
    state.counters["spin_over_penalty_%"] = over([](const Launch& l) { return l.spin.norm(); });
    state.counters["time_over_penalty"] = cpu[1] / cpu[0];
    state.counters["iterations_over_penalty"] = double(out[1].result.counts.iterations) /
                                                double(out[0].result.counts.iterations);
  }
}
BENCHMARK(Multipliers)->Arg(20)->Arg(10)->Arg(5)->ArgName("penetration")->Iterations(1)->Unit(benchmark::kSecond);

/// What a face that yields costs: drives 15 mm off the middle on both, in turn; CPU time, since other work may run.
void YieldingFace(benchmark::State& state) {
  Blow blow;
  blow.club.head = {
      .mass = 0.2, .cg = Vec3(-0.035, 0, 0.004), .inertia = Vec3(2e-4, 3e-4, 4.5e-4).asDiagonal(), .face = {0.4, 0.35}};
  blow.delivery = {.club_speed = 50, .dynamic_loft = radians(10), .impact_toe = 0.015, .impact_high = 0.004};
  FeImpactOptions o;
  o.resolve(static_cast<Accuracy>(state.range(0)));
  const Impact impact(o);
  Blow yielding = blow;
  yielding.club.head.compliance = find_face("modern-driver")->face;
  for (auto _ : state) {
    using Counts = solvers::GeneralizedAlpha::Counts;
    double cpu[2] = {};
    Counts counts[2];
    for (int i = 0; i < 8; ++i) {
      cpu[i % 2] += seconds(1, [&] { counts[i % 2] = impact.run(i % 2 ? yielding : blow).result.counts; }) / 4;
    }
    state.counters["rigid_s"] = cpu[0];
    state.counters["yielding_over_rigid"] = cpu[1] / cpu[0];
    const auto over_rigid = [&](auto count) { return double(counts[1].*count) / double(counts[0].*count); };
    state.counters["steps_over_rigid"] = over_rigid(&Counts::steps);
    state.counters["iterations_over_rigid"] = over_rigid(&Counts::iterations);
    state.counters["factorisations_over_rigid"] = over_rigid(&Counts::factorisations);
  }
}
BENCHMARK(YieldingFace)->Arg(0)->Arg(1)->ArgName("level")->Iterations(1)->Unit(benchmark::kSecond);

/// Exponent of the cost over the nodes, from 3 to 6 sectors (54 to 216 elements).
void Growth(benchmark::State& state) {
  for (auto _ : state) {
    double nodes[2], cost[2];
    for (int i = 0; i < 2; ++i) {
      const FeImpactOptions o = options(3 + 3 * i, int(state.range(0)));
      Blow b = oblique();
      if (state.range(0) == 0) b.delivery.club_path = 0;
      cost[i] = seconds(1, [&] {
        Impact(o).run(b, [&](const ImpactView& view) { nodes[i] = double(view.ball.mesh().nodes.size()); });
      });
    }
    state.counters["exponent"] = std::log(cost[1] / cost[0]) / std::log(nodes[1] / nodes[0]);
    state.counters["nodes"] = nodes[1];
    state.counters["seconds"] = cost[1];
  }
}
BENCHMARK(Growth)->Arg(0)->Arg(2)->ArgName("harmonics")->Iterations(1)->Unit(benchmark::kSecond);

/// Exponent of the cost over the number of harmonics, from 3 to 6.
void GrowthOverHarmonics(benchmark::State& state) {
  for (auto _ : state) {
    double cost[2];
    for (int i = 0; i < 2; ++i) cost[i] = seconds(1, [&] { Impact(options(3, 3 + 3 * i)).run(oblique()); });
    state.counters["exponent"] = std::log2(cost[1] / cost[0]);
    state.counters["seconds"] = cost[1];
  }
}
BENCHMARK(GrowthOverHarmonics)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
