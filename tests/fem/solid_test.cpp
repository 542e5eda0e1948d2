#include "fem/materials/solid.hpp"
#include "fem/materials/gent.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "fem/materials/linear_elastic.hpp"
#include "fem/materials/ogden.hpp"
#include "fem/materials/st_venant_kirchhoff.hpp"
#include "fem/materials/time_temperature.hpp"
#include "golf/units.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>

namespace hosel::fem {
namespace {

Mat3 random_gradient(std::mt19937& g, double size) {
  std::uniform_real_distribution<double> u(-size, size);
  Mat3 F = Mat3::Identity();
  for (double& x : F.reshaped()) x += u(g);
  return F;
}

struct Named {
  const char* name;
  Solid solid;
};

std::vector<Named> materials() {
  const Lame l = Lame::of(100e6, 0.49);
  const std::vector<MaxwellBranch> two{{20e6, 1e-4}, {15e6, 3e-5}};
  return {
      {"linear", {.elastic = LinearElastic{Lame::of(60e6, 0.3)}, .branches = {}, .density = 1100}},
      {"st-venant-kirchhoff", {.elastic = StVenantKirchhoff{Lame::of(60e6, 0.3)}, .branches = {}, .density = 1100}},
      {"neo-hooke", {.elastic = Hyperelastic::neo_hooke(l), .branches = {}, .density = 1100}},
      {"mooney-rivlin",
       {.elastic = Hyperelastic{.c10 = 10e6, .c01 = 4e6, .bulk = 1e9}, .branches = {}, .density = 1100}},
      {"yeoh",
       {.elastic = Hyperelastic{.c10 = 10e6, .c20 = -1e6, .c30 = 2e6, .bulk = 1e9}, .branches = {}, .density = 1100}},
      {"ogden", {.elastic = Ogden{.powers = {{15e6, 1.8}, {4e6, -2.5}}, .bulk = 1e9}, .branches = {}, .density = 1100}},
      {"gent", {.elastic = Gent(GentEnergy{20e6, 5, 1e9}), .branches = {}, .density = 1100}},
      {"gent with branches", {.elastic = Gent(GentEnergy{20e6, 5, 1e9}), .branches = two, .density = 1100}},
      {"neo-hooke with branches", {.elastic = Hyperelastic::neo_hooke(l), .branches = two, .density = 1100}},
      {"ogden with branches", {.elastic = Ogden{.powers = {{15e6, 3}}, .bulk = 1e9}, .branches = two, .density = 1100}},
      {"yeoh with branches",
       {.elastic = Hyperelastic{.c10 = 10e6, .c01 = 2e6, .c20 = -1e6, .c30 = 2e6, .bulk = 1e9},
        .branches = two,
        .density = 1100}}};
}

Solid named(const std::string& name) {
  for (const auto& [own, solid] : materials())
    if (own == name) return solid;
  throw std::invalid_argument(name);
}

/// Every direction alike.
Mat3 random_turn(std::mt19937& g) {
  std::normal_distribution<double> n;
  return Eigen::Quaterniond(n(g), n(g), n(g), n(g)).normalized().toRotationMatrix();
}

TEST(Solid, EnergyStressTangentAgree) {
  std::mt19937 g(1);
  for (const auto& [name, solid] : materials())
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<double> history(static_cast<std::size_t>(solid.history_size()));
      solid.start(history);
      update_internal_variables(solid, random_gradient(g, 0.2), 3e-5, history);
      update_internal_variables(solid, random_gradient(g, 0.2), 3e-5, history);
      const Mat3 F = random_gradient(g, 0.2), Q = random_turn(g);
      const Mat3 D = random_gradient(g, 1) - Mat3::Identity();
      const double h = 2e-6;
      // With dt = 0 the history is frozen and P is the energy's gradient; with dt > 0 the tangent is
      // that of the update.
      PointResponse at, plus, minus;
      evaluate(solid, F, Q, 0, history, true, at);
      evaluate(solid, F + h * D, Q, 0, history, false, plus);
      evaluate(solid, F - h * D, Q, 0, history, false, minus);
      const double slope = (plus.energy - minus.energy) / (2 * h), product = at.stress.cwiseProduct(D).sum();
      EXPECT_NEAR(slope, product, 1e-7 * (std::abs(product) + at.stress.norm() * D.norm())) << name;
      for (double dt : {0.0, 5e-5}) {
        evaluate(solid, F, Q, dt, history, true, at);
        evaluate(solid, F + h * D, Q, dt, history, false, plus);
        evaluate(solid, F - h * D, Q, dt, history, false, minus);
        const Eigen::Matrix<double, 9, 1> difference = ((plus.stress - minus.stress) / (2 * h)).reshaped();
        const Eigen::Matrix<double, 9, 1> predicted = at.tangent * D.reshaped();
        EXPECT_LE((difference - predicted).norm(), 1e-7 * predicted.norm()) << name << " dt " << dt;
      }
    }
}

/// Ogden's powers 2 and -2 are Mooney-Rivlin, also where stretches coincide.
TEST(Solid, OgdenHoldsMooneyRivlin) {
  const Solid ogden{.elastic = Ogden{.powers = {{20e6, 2}, {8e6, -2}}, .bulk = 1e9}, .branches = {}, .density = 1},
      mooney{.elastic = Hyperelastic{.c10 = 10e6, .c01 = 4e6, .bulk = 1e9}, .branches = {}, .density = 1};
  std::mt19937 g(3);
  const Mat3 twice = Vec3(1.2, 1.2, 0.7).asDiagonal();
  for (const Mat3& F : {Mat3(Mat3::Identity()), twice, random_gradient(g, 0.2), random_gradient(g, 0.2)}) {
    PointResponse a, b;
    evaluate(ogden, F, Mat3::Identity(), 0, {}, true, a);
    evaluate(mooney, F, Mat3::Identity(), 0, {}, true, b);
    EXPECT_NEAR(a.energy, b.energy, 1e-10 * (b.energy + 1e6));
    EXPECT_LT((a.stress - b.stress).norm(), 1e-10 * (b.stress.norm() + 1e6));
    EXPECT_LT((a.tangent - b.tangent).norm(), 1e-9 * b.tangent.norm());
  }
}

/// The energies of laws whose tangents are written by hand.
struct YeohEnergy : Hyperelastic {
  template <class X, class Y, class Z>
  auto energy(const X& I1, const Y& I2, const Z& J) const {
    const X x = I1 - 3.0;
    return x * (c10 + x * (c20 + x * c30)) + c01 * (I2 - 3.0) + 0.5 * bulk * (J - 1.0) * (J - 1.0);
  }
};

/// A law by automatic differentiation of its energy is the law by hand: to round-off.
TEST(Solid, ALawFromItsEnergyIsTheLawByHand) {
  const Hyperelastic by_hand{.c10 = 10e6, .c01 = 4e6, .c20 = -1e6, .c30 = 2e6, .bulk = 1e9};
  const Solid written{.elastic = by_hand, .branches = {}, .density = 1},
      differentiated{.elastic = EnergyLaw(YeohEnergy{by_hand}), .branches = {}, .density = 1};
  std::mt19937 g(5);
  for (int i = 0; i < 20; ++i) {
    const Mat3 F = random_gradient(g, 0.25);
    PointResponse a, b, only_stress;
    evaluate(written, F, Mat3::Identity(), 0, {}, true, a);
    evaluate(differentiated, F, Mat3::Identity(), 0, {}, true, b);
    evaluate(differentiated, F, Mat3::Identity(), 0, {}, false, only_stress);
    ASSERT_GT(a.stress.norm(), 1e5);
    EXPECT_NEAR(a.energy, b.energy, 1e-12 * a.energy);
    EXPECT_LE((a.stress - b.stress).norm(), 1e-12 * a.stress.norm());
    EXPECT_LE((a.stress - only_stress.stress).norm(), 1e-12 * a.stress.norm());
    EXPECT_LE((a.tangent - b.tangent).norm(), 1e-12 * a.tangent.norm());
  }
}

/// Uniaxial tension of an incompressible Gent rubber: P = mu (l - 1/l^2) L / (L - I1 + 3) [A.N. Gent 1996]; K of 1e6 mu
/// leaves some 1e-5 of it.
TEST(Solid, GentLocks) {
  const double mu = 1e6, limit = 3;
  const Solid gent{.elastic = Gent(GentEnergy{mu, limit, 1e6 * mu}), .branches = {}, .density = 1};
  for (const double l : {0.6, 1.5, 2.0}) {
    double across = 1 / std::sqrt(l);
    PointResponse r;
    for (int i = 0; i < 20; ++i) {
      evaluate(gent, Vec3(l, across, across).asDiagonal(), Mat3::Identity(), 0, {}, true, r);
      across -= r.stress(1, 1) / (r.tangent(4, 4) + r.tangent(4, 8));
    }
    const double exact = mu * (l - 1 / (l * l)) * limit / (limit - (l * l + 2 / l) + 3);
    EXPECT_NEAR(r.stress(0, 0), exact, 1e-4 * std::abs(exact)) << l;
  }
  PointResponse beyond;  // I1 - 3 = 3.67
  evaluate(gent, Vec3(2.5, 1 / std::sqrt(2.5), 1 / std::sqrt(2.5)).asDiagonal(), Mat3::Identity(), 0, {}, false,
           beyond);
  EXPECT_TRUE(std::isnan(beyond.energy));
}

/// Time and temperature: what a rubber at T answers in a time t is what it answers where its constants hold in t /
/// a(T), times the ratio of the absolute temperatures.
TEST(Solid, ColdIsSlowAndSoft) {
  const TimeTemperature law{.measured = 296.15};
  // By hand at 278.15 and 313.15 K, of T0 = 298 K.
  const auto by_hand = [](double T) { return -3.44 * (T - 298) / (196.6 + T - 298); };
  for (const double T : {278.15, 313.15}) EXPECT_NEAR(std::log10(law.shift(T)), by_hand(T) - by_hand(296.15), 1e-12);
  EXPECT_GT(law.shift(278.15), 2);
  EXPECT_LT(law.shift(313.15), 0.6);
  EXPECT_EQ(law.shift(law.measured), 1);
  EXPECT_FALSE(law.faults(100).empty());
  EXPECT_TRUE(law.faults(278.15).empty());
  EXPECT_THROW(at_temperature(materials().back().solid, law, 90), std::invalid_argument);

  // Neither bulk modulus nor density follows: an isochoric path is compared.
  const Solid warm{.elastic = Hyperelastic{.c10 = 10e6, .bulk = 1e9}, .branches = {{20e6, 1e-4}}, .density = 1100};
  const double T = 278.15, a = law.shift(T);
  const Solid cold = at_temperature(warm, law, T);
  const auto stress_after = [](const Solid& solid, double time) {
    std::vector<double> history(std::size_t(solid.history_size()));
    solid.start(history);
    Mat3 F = Mat3::Identity();
    PointResponse r;
    for (int i = 1; i <= 50; ++i) {
      F(0, 1) = 0.2 * i / 50;
      evaluate(solid, F, Mat3::Identity(), time / 50, history, false, r);
      update_internal_variables(solid, F, time / 50, history);
    }
    return r.stress(0, 1);
  };
  const double now = stress_after(cold, 2e-4), then = stress_after(warm, 2e-4 / a);
  EXPECT_NEAR(now, then * T / law.measured, 1e-12 * then);
  EXPECT_GT(now, 1.05 * stress_after(warm, 2e-4));  // within an impact's time the cold rubber is the stiffer one
}

/// Every law with all its branches, by constants of another rubber, along a path that keeps the volume: at T the stress
/// after a time t is T / Tm of that at Tm after t / a, log10 a = -c1 (T - T0) / (c2 + T - T0) less the same of Tm.
TEST(Solid, EveryBranchFollowsTheTemperature) {
  const TimeTemperature law{.measured = 293.15, .c1 = 8.86, .c2 = 101.6, .origin = 323.15};
  const auto log_a = [](double T) { return -8.86 * (T - 323.15) / (101.6 + T - 323.15); };
  const double T = 278.15, a = std::pow(10, log_a(T) - log_a(293.15)), entropic = T / 293.15;
  ASSERT_GT(a, 10);
  int laws = 0;
  for (const auto& [name, solid] : materials()) {
    if (solid.branches.empty()) continue;
    ++laws;
    const Solid cold = at_temperature(solid, law, T);
    ASSERT_EQ(cold.branches.size(), solid.branches.size());
    for (std::size_t i = 0; i < solid.branches.size(); ++i) {
      EXPECT_NEAR(cold.branches[i].modulus, entropic * solid.branches[i].modulus, 1e-12 * solid.branches[i].modulus);
      EXPECT_NEAR(cold.branches[i].time, a * solid.branches[i].time, 1e-12 * a * solid.branches[i].time);
    }
    EXPECT_EQ(cold.density, solid.density);
    const auto after = [](const Solid& of, double time) {
      std::vector<double> history(static_cast<std::size_t>(of.history_size()));
      of.start(history);
      PointResponse r;
      for (int i = 1; i <= 20; ++i) {
        const double x = 0.02 * i, y = 1 + 0.01 * i;
        const Mat3 F = (Mat3() << y, x, 0, 0, 1 / y, 0.5 * x, 0, 0, 1).finished();
        evaluate(of, F, Mat3::Identity(), time / 20, history, false, r);
        update_internal_variables(of, F, time / 20, history);
      }
      return r.stress;
    };
    const Mat3 now = after(cold, 3e-3), then = entropic * after(solid, 3e-3 / a);
    // Round-off of the volume, under a bulk modulus of 1e9 and more.
    EXPECT_LT((now - then).norm(), 1e-12 * (then.norm() + solid.bulk())) << name;
    EXPECT_GT((now - entropic * after(solid, 3e-3)).norm(), 0.05 * then.norm()) << name << ": times matter";
  }
  EXPECT_GE(laws, 4);
}

/// [@neo-hooke]: stretch, lateral stretch, Cauchy stress of uniaxial tension, W = mu/2 (I1'-3) + K/2 (J-1)^2.
TEST(Solid, NeoHookeUniaxial) {
  Hyperelastic law{.c10 = 33.5570469798658e6 / 2, .bulk = 1666.66666666667e6};
  const Solid solid{.elastic = law, .branches = {}, .density = 1};
  const double table[6][3] = {{.5, 1.40583200, -5.909099e7}, {.7, 1.19145481, -3.152400e7},
                              {.9, 1.05303128, -1.006309e7}, {1.1, .95441588, 1.000321e7},
                              {1.5, .82073098, 5.199507e7},  {2, .71503833, 1.127982e8}};
  for (const auto& row : table) {
    double lateral = 1 / std::sqrt(row[0]);
    PointResponse r;
    for (int i = 0; i < 30; ++i) {  // lateral stress to zero
      evaluate(solid, Vec3(row[0], lateral, lateral).asDiagonal(), Mat3::Identity(), 0, {}, true, r);
      lateral -= r.stress(1, 1) / (r.tangent(4, 4) + r.tangent(4, 8));
    }
    EXPECT_NEAR(lateral, row[1], 1e-8);
    const double cauchy = r.stress(0, 0) / (lateral * lateral);
    EXPECT_NEAR(cauchy, row[2], 1e-6 * std::abs(row[2]));
  }
  Mat3 shear = Mat3::Identity();
  shear(0, 1) = 0.5;
  PointResponse r;
  evaluate(solid, shear, Mat3::Identity(), 0, {}, false, r);
  const Mat3 sigma = r.stress * shear.transpose();
  EXPECT_NEAR(sigma(0, 1), 16778523.49, 0.01);
  EXPECT_NEAR(sigma(0, 0), 5592841.16, 0.01);
  EXPECT_NEAR(sigma(1, 1), -2796420.58, 0.01);
  evaluate(solid, Vec3(.9, 1, 1).asDiagonal(), Mat3::Identity(), 0, {}, false, r);
  EXPECT_NEAR(r.stress(0, 0), -1.7173317268e8, 1);
}

/// [@prony]: G = 20 + 10 e^(-t/1e-4) + 10 e^(-t/1e-3) MPa in shear. Strains are scaled down so far
/// that the finite-strain terms (of relative size strain^2) fall below the tolerance.
class Prony : public testing::Test {
 protected:
  Solid solid{
      .elastic = Hyperelastic{.c10 = 10e6, .bulk = 4e9}, .branches = {{10e6, 1e-4}, {10e6, 1e-3}}, .density = 1};
  static constexpr double scale = 1e-5;
  std::vector<double> history = std::vector<double>(static_cast<std::size_t>(solid.history_size()));
  double work = 0;

  static Mat3 shear(double gamma) {
    Mat3 F = Mat3::Identity();
    F(0, 1) = scale * gamma;
    return F;
  }
  double stress(double gamma, double dt) {
    PointResponse r;
    evaluate(solid, shear(gamma), Mat3::Identity(), dt, history, false, r);
    return r.stress(0, 1) / scale;
  }
  /// Shear stress after a ramp of `steps` from gamma(t0) to gamma(t1).
  template <class Strain>
  double run(Strain gamma, double t0, double t1, int steps) {
    double tau = 0;
    for (int i = 1; i <= steps; ++i) {
      const double dt = (t1 - t0) / steps, t = t0 + i * dt;
      tau = stress(gamma(t), dt);
      update_internal_variables(solid, shear(gamma(t)), dt, history);
    }
    return tau;
  }
  void SetUp() override { solid.start(history); }
};

TEST_F(Prony, Relaxation) {
  // A step: history sees the strain at once (dt = 0), then holds it.
  const auto hold = [](double) { return 0.01; };
  stress(0.01, 0);
  update_internal_variables(solid, shear(0.01), 0, history);
  EXPECT_NEAR(run(hold, 0, 1e-4, 1), 3.27271686e5, 3.27e5 * 1e-8);
  EXPECT_NEAR(run(hold, 1e-4, 1e-3, 3), 2.36792484e5, 2.36e5 * 1e-8);
}

TEST_F(Prony, ConstantRateIsExactForAnyStep) {
  const auto ramp = [](double t) { return 100 * t; };
  EXPECT_NEAR(run(ramp, 0, 1e-4, 1), 3.58374638e5, 3.58e5 * 1e-8);
  EXPECT_NEAR(run(ramp, 1e-4, 1e-3, 7), 2.73211602e6, 2.73e6 * 1e-8);
}

TEST_F(Prony, HarmonicResponse) {
  // Complex modulus after forty cycles at 2.5 kHz; piecewise-linear strain is exact to O(dt^2), so Richardson's
  // extrapolation of 500 and 1000 steps per cycle leaves (2 pi / 500)^4 / 80 = 3e-10: the transient is more.
  const double f = 2500, w = 2 * M_PI * f;
  const auto modulus = [&](int per_cycle) {
    solid.start(history);
    const auto gamma = [&](double t) { return 0.01 * std::sin(w * t); };
    const int cycles = 40;  // e^(-40 cycles / tau2) = 1e-7 of the transient, and it is not in phase
    run(gamma, 0, cycles / f, cycles * per_cycle);
    double in = 0, out = 0;
    const double dt = 1 / f / per_cycle;
    for (int i = 1; i <= per_cycle; ++i) {
      const double t = cycles / f + i * dt;
      const double tau = stress(gamma(t), dt);
      update_internal_variables(solid, shear(gamma(t)), dt, history);
      in += tau * std::sin(w * t) * 2 / per_cycle / 0.01;
      out += tau * std::cos(w * t) * 2 / per_cycle / 0.01;
    }
    return Eigen::Vector2d(in, out);
  };
  const Eigen::Vector2d coarse = modulus(500), fine = modulus(1000);
  const Eigen::Vector2d best = (4 * fine - coarse) / 3;
  EXPECT_NEAR(best[0], 3.70756307e7, 3.7e7 * 1e-7);
  EXPECT_NEAR(best[1], 5.16423357e6, 5.1e6 * 1e-6);
}

TEST(Solid, DissipationIsNeverNegative) {
  std::mt19937 g(7);
  std::uniform_real_distribution<double> u(0, 1);
  for (const auto& [name, solid] : materials()) {
    if (solid.branches.empty()) continue;
    for (int path = 0; path < 1000; ++path) {
      std::vector<double> history(static_cast<std::size_t>(solid.history_size()));
      solid.start(history);
      const double size = 0.3 * u(g);
      for (int step = 0; step < 8; ++step) {
        const double dt = std::pow(10, -7 + 5 * u(g));
        ASSERT_GE(update_internal_variables(solid, random_gradient(g, size), dt, history), 0) << name;
      }
    }
  }
}

/// Several points at once are the same points one by one: a step of each, its stress, its energy, its history after.
TEST(Solid, LanesAreThePointsOneByOne) {
  std::mt19937 g(11);
  int laws = 0;
  for (const auto& [name, solid] : materials()) {
    if (!solid.in_lanes()) continue;
    ++laws;
    for (const double dt : {0.0, 4e-6, 2e-4}) {
      const auto size = static_cast<std::size_t>(solid.history_size());
      std::vector<double> history(kLanes * size), starts(static_cast<std::size_t>(kLanes * (solid.start_size() + 1)));
      Mat3 F[kLanes];
      Mat3Lanes all;
      for (std::size_t l = 0; l < kLanes; ++l) {
        const auto own = std::span(history).subspan(l * size, size);
        solid.start(own);
        for (int i = 0; i < 2; ++i) update_internal_variables(solid, random_gradient(g, 0.2), 3e-5, own);
        start_step(solid, dt, own, starts.data() + l, kLanes);
        F[l] = random_gradient(g, 0.2);
        for (std::size_t i = 0; i < 9; ++i) all[i][static_cast<int>(l)] = F[l].data()[i];
      }
      Mat3Lanes stress;
      Lanes energy;
      evaluate(solid, all, starts.data(), kLanes, stress, energy);
      std::vector<double> moved = history;
      // The last point is not there: its history stays.
      const double sum = update_internal_variables(solid, all, starts.data(), kLanes, dt, kLanes - 1, moved);
      double expected = 0;
      for (std::size_t l = 0; l < kLanes; ++l) {
        const int lane = static_cast<int>(l);
        const auto own = std::span(history).subspan(l * size, size);
        PointResponse at;
        evaluate(solid, F[l], Mat3::Identity(), dt, own, false, at);
        // Of large parts that cancel (pressure against shear) some ten last digits differ by the order of the sums.
        EXPECT_NEAR(energy[lane], at.energy, 1e-12 * (at.energy + solid.bulk())) << name;
        for (std::size_t i = 0; i < 9; ++i)
          EXPECT_NEAR(stress[i][lane], at.stress.data()[i], 1e-12 * (at.stress.norm() + solid.bulk())) << name;
        if (l + 1 < kLanes) expected += update_internal_variables(solid, F[l], dt, own);
      }
      EXPECT_NEAR(sum, expected, 1e-12 * expected) << name;
      for (std::size_t i = 0; i < history.size(); ++i)
        EXPECT_NEAR(moved[i], history[i], 1e-12 * (1 + std::abs(history[i]))) << name << ' ' << i;
    }
  }
  EXPECT_GE(laws, 8);

  // A point turned inside out spoils itself alone.
  const Solid solid = named("neo-hooke");
  Mat3Lanes all{};
  for (const std::size_t i : {0U, 4U, 8U}) all[i] = Lanes{} + 1.0;
  all[0][1] = -1;
  Mat3Lanes stress;
  Lanes energy;
  evaluate(solid, all, nullptr, 0, stress, energy);
  for (int l = 0; l < kLanes; ++l) EXPECT_EQ(std::isfinite(energy[l]) && std::isfinite(stress[4][l]), l != 1);
}

/// Work of the stress = stored + dissipated over a strain path, to second order in the step.
TEST(Solid, EnergyBalanceClosesAtSecondOrder) {
  double share = 0;  // of the work that is dissipated
  const auto gap = [&](const Solid& solid, int steps) {
    std::vector<double> history(static_cast<std::size_t>(solid.history_size()));
    solid.start(history);
    const auto gradient = [](double t) {
      Mat3 F = Mat3::Identity();
      F(0, 1) = 0.4 * std::sin(7e3 * t);
      F(1, 1) = 1 - 0.2 * std::sin(5e3 * t);
      return F;
    };
    const double dt = 4e-4 / steps;
    double work = 0, dissipated = 0;
    PointResponse before, after;
    evaluate(solid, gradient(0), Mat3::Identity(), 0, history, false, before);
    for (int i = 1; i <= steps; ++i) {
      const Mat3 F0 = gradient((i - 1) * dt), F1 = gradient(i * dt);
      evaluate(solid, F1, Mat3::Identity(), dt, history, false, after);
      work += 0.5 * (before.stress + after.stress).cwiseProduct(F1 - F0).sum();
      dissipated += update_internal_variables(solid, F1, dt, history);
      before = after;
    }
    share = dissipated / work;
    return std::abs(work - dissipated - after.energy) / work;
  };
  int laws = 0;
  for (const auto& [name, solid] : materials()) {
    if (solid.branches.empty()) continue;
    ++laws;
    SCOPED_TRACE(name);
    const double coarse = gap(solid, 400), fine = gap(solid, 800);
    ASSERT_GT(share, 0.05);
    EXPECT_LT(fine, 2e-5);  // a sixtieth of a radian a step: 1/12 of its square
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.3);
  }
  EXPECT_GE(laws, 4);
}

/// A small shear gamma sin(w t), once it is steady: a cycle dissipates pi G'' gamma^2, and the stress does as much
/// work; G'' is the sum of G_i w tau_i / (1 + w^2 tau_i^2).
TEST(Solid, ASteadyCycleDissipatesWhatTheLossModulusSays) {
  constexpr double kShear = 1e-3, kOmega = 2e4;  // w tau of 2 and 0.6
  constexpr int kSteps = 500, kCycles = 10;      // 3.1 ms are 31 of the longer relaxation times
  int laws = 0;
  for (const auto& [name, solid] : materials()) {
    if (solid.branches.empty()) continue;
    ++laws;
    SCOPED_TRACE(name);
    double loss = 0;
    for (const MaxwellBranch& b : solid.branches)
      loss += b.modulus * kOmega * b.time / (1 + kOmega * b.time * kOmega * b.time);
    const double exact = kPi * loss * kShear * kShear;
    std::vector<double> history(static_cast<std::size_t>(solid.history_size()));
    solid.start(history);
    const double dt = 2 * kPi / kOmega / kSteps;
    double work = 0, dissipated = 0, last = 0, before = 0;
    for (int i = 1; i <= kCycles * kSteps; ++i) {
      Mat3 F = Mat3::Identity();
      F(0, 1) = kShear * std::sin(2 * kPi * i / kSteps);
      PointResponse r;
      evaluate(solid, F, Mat3::Identity(), dt, history, false, r);
      const double lost = update_internal_variables(solid, F, dt, history);
      if (i > (kCycles - 1) * kSteps) {
        dissipated += lost;
        work += 0.5 * (before + r.stress(0, 1)) * (F(0, 1) - last);
      }
      before = r.stress(0, 1);
      last = F(0, 1);
    }
    // Straight pieces of a sine: (2 pi / 500)^2 / 6 = 3e-5; finite strain: 1e-6.
    EXPECT_NEAR(dissipated, exact, 1e-4 * exact);
    EXPECT_NEAR(work, exact, 1e-4 * exact);
  }
  EXPECT_GE(laws, 4);
}

}  // namespace
}  // namespace hosel::fem
