// Normal contact of elastic and viscoelastic spheres: benchmarks 2.5 and 2.6.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "solvers/statics.hpp"
#include "tests/support/elastic_sphere.hpp"

namespace hosel::models {
namespace {

constexpr double kRadius = 0.021335, kMass = 0.04593;

double plane_modulus(double young, double nu) { return young / (1 - nu * nu); }

/// A ball between two plates that come nearer by `approach` each; harmonic 0.
class Squeeze {
 public:
  Squeeze(fem::Solid material, const mesh::MeridianOptions& mesh, double penalty)
      : meridian_(mesh::sphere_meridian({kRadius}, mesh)), material_(std::move(material)), penalty_(penalty) {}

  /// Force on each plate [N] at rest `after` the last call [s]; the material's history moves.
  double force(double approach, double after = 0) {
    fem::System system;
    auto ball = std::make_unique<fem::HarmonicSolid>(system.layout, meridian_, fem::axisymmetric_family(),
                                                     fem::SolidQuadrature{fem::single_angle(), 2},
                                                     std::vector<fem::Solid>{material_}, fem::Placement{});
    fem::HarmonicSolid* solid = ball.get();
    system.terms.push_back(std::move(ball));
    fem::State state = system.layout.rest();
    if (q_.size() > 0) state.q = q_;
    std::span<const double> history = history_;
    if (!history_.empty()) solid->restore(history);
    fem::ContactFace* plate = nullptr;
    for (const double side : {1.0, -1.0}) {
      fem::FaceCarrier carrier;
      carrier.position = Vec3(side * (kRadius - approach), 0, 0);
      carrier.attitude = side < 0 ? Mat3(Mat3::Identity()) : Eigen::AngleAxisd(kPi, Vec3::UnitZ()).toRotationMatrix();
      auto contact = std::make_unique<fem::ContactFace>(
          *solid, Face{}, carrier, fem::ContactLawAtPoint{.normal_stiffness = penalty_ * material_.instant_shear() / kRadius},
          fem::single_angle(), fem::Symmetry::axis);
      contact->start(state);
      plate = contact.get();
      system.terms.push_back(std::move(contact));
    }
    state.time = time_ += after;
    const auto found = solvers::solve_static(
        system, state,
        {.newton = {.residual_relative = 1e-7, .increment_vector = 1e-5 * approach, .increment_rotation = 1, .max_iterations = 60,
                    .acceleration = 10}});
    solid->accept(found.state);
    q_ = found.state.q;
    history_.clear();
    solid->save(history_);
    return plate->report(found.state).normal_force;
  }

 private:
  mesh::Meridian meridian_;
  fem::Solid material_;
  double penalty_, time_ = 0;
  Eigen::VectorXd q_;
  std::vector<double> history_;
};

fem::Solid linear(double nu) { return {.elastic = fem::LinearElastic{fem::Lame::of(100e6, nu)}, .branches = {}, .density = 1129}; }

/// Force between two plates over Hertz's at the approach (a/R)^2 R.
double over_hertz(Squeeze& squeeze, double a, double nu) {
  const double d = a * a * kRadius;
  return squeeze.force(d) / (4.0 / 3 * plane_modulus(100e6, nu) * std::sqrt(kRadius) * std::pow(d, 1.5));
}

/// The finite sphere's departure at a/R = 0.097, and the same answer on two quite different meshes beyond. There the
/// table (1.107, 1.163, 1.243, 1.370 at nu = 0.3) lies 1.6, 2.0, 3.1 and 4.3 % above both.
TEST(Hertz, StaticDepartureOfAFiniteSphere) {
  Squeeze fine(linear(.3), {.sector = 10, .rings = 8, .pole = 0.12, .far = 2, .both_poles = true, .skin = 0.1, .core = 0.4}, 2e4),
      even(linear(.3), {.sector = 12, .rings = 8, .pole = 1, .far = 1, .both_poles = true, .skin = 0.5, .core = 0.4}, 2e4);
  EXPECT_NEAR(over_hertz(fine, .0968, .3), 1.058, 0.015 * 1.058);
  double last = 1.05;
  for (const double a : {.153, .217, .306, .433}) {
    const double one = over_hertz(fine, a, .3), other = over_hertz(even, a, .3);
    EXPECT_NEAR(one, other, 0.01 * one) << a;
    EXPECT_GT(one, last);
    last = one;
  }
}

/// Hertz himself as the contact shrinks: the straight line through 0.018 < a/R < 0.045 starts at one.
TEST(Hertz, LimitOfASmallContact) {
  for (const double nu : {.3, .49}) {
    Squeeze squeeze(linear(nu), {.sector = 16, .rings = 9, .pole = 0.02, .far = 4, .both_poles = true, .skin = 0.02, .core = 0.4}, 1e5);
    constexpr int count = 10;
    Eigen::Matrix<double, count, 2> line;
    Eigen::Matrix<double, count, 1> ratio;
    for (int i = 0; i < count; ++i) {
      const double a = .018 + .003 * i;
      line.row(i) << 1, a;
      ratio[i] = over_hertz(squeeze, a, nu);
    }
    const Eigen::Vector2d fit = line.colPivHouseholderQr().solve(ratio);
    EXPECT_NEAR(fit[0], 1, 0.01) << nu;
    EXPECT_GT(fit[1], 0.2);
    EXPECT_LT(fit[1], 0.9);
  }
}

FeImpactOptions normal(fem::Solid material, double pole) {
  FeImpactOptions o;
  o.ball = elastic_ball("sphere", std::move(material));
  o.harmonics = 0;
  o.mesh = {.sector = 6, .rings = 6, .pole = pole, .far = 2, .skin = pole, .core = 0.4};
  o.penalty = 4000;
  o.steps_per_contact = 200;
  o.rho_inf = 0.8;
  return o;
}

/// Contact time, peak force and restitution of an impact against Hertz's, as a finite sphere has them.
TEST(Hertz, ImpactOfAFiniteSphere) {
  struct Row {
    double nu, v, time, force, loss;
  };
  // At nu = 0.49 and 1 m/s the table's loss of 0.0014 is not met: 0.0008 here on every mesh and step, as the
  // peer's 0.0008 at nu = 0.45 and a speed 1.29 times as high.
  const Row table[] = {{.3, .2, .979, 1.030, NAN}, {.3, 1, .958, 1.056, NAN}, {.3, 3, .938, 1.094, .0015},
                       {.3, 10, .917, 1.154, .006}, {.49, 1, .970, 1.046, NAN}, {.49, 10, .931, 1.089, .011}};
  for (const Row& row : table) {
    const double E = plane_modulus(100e6, row.nu);
    const double a = std::sqrt(.974514960 * std::pow(kMass * kMass * std::pow(row.v, 4) / (kRadius * E * E), .2) / kRadius);
    const test::Bounce b = test::bounce(normal(linear(row.nu), std::min(0.3, 1.2 * a)), row.v, 0);
    EXPECT_NEAR(b.contact_time / (2.868265699 * std::pow(kMass * kMass / (kRadius * E * E * row.v), .2)), row.time, .015 * row.time)
        << row.nu << " " << row.v;
    EXPECT_NEAR(b.peak_force / (1.282689390 * std::pow(std::pow(kMass, 3) * kRadius * E * E * std::pow(row.v, 6), .2)), row.force,
                .015 * row.force) << row.nu << " " << row.v;
    if (std::isfinite(row.loss)) EXPECT_NEAR(1 - b.v_n / row.v, row.loss, .2 * row.loss) << row.nu << " " << row.v;
    EXPECT_LT(b.v_n / row.v, 1);
    RecordProperty("loss", 1 - b.v_n / row.v);
  }
}

/// G = 20 + 20 exp(-t/tau) MPa, nearly incompressible.
fem::Solid zener(double tau) {
  return {.elastic = fem::Hyperelastic{.c10 = 10e6, .bulk = 1e10}, .branches = {{20e6, tau}}, .density = 1129};
}

/// Lee and Radok: held at a depth the force relaxes as the modulus does; under a ramp it is the hereditary integral.
/// Both over the instant elastic force of the same ball, which takes the finite size out.
TEST(Hertz, ViscoelasticIndentation) {
  const mesh::MeridianOptions mesh{.sector = 8, .rings = 6, .pole = 0.06, .far = 3, .both_poles = true, .skin = 0.06, .core = 0.4};
  const double d = 1e-4;
  Squeeze held(zener(1e-3), mesh, 1e4);
  const double instant = held.force(d);
  EXPECT_NEAR(instant / 31.160545, 1.03, 0.02);  // finite size at a/R = 0.068
  double force = 0;
  for (int i = 0; i < 10; ++i) force = held.force(d, 1e-4);
  EXPECT_NEAR(force / instant, 21.311934 / 31.160545, 5e-3);  // strains of a/R, squared

  Squeeze ramp(zener(1e-3), mesh, 1e4), elastic(zener(1e9), mesh, 1e4);
  for (int i = 1; i <= 20; ++i) force = ramp.force(0.1 * 5e-5 * i, 5e-5);
  EXPECT_NEAR(force / elastic.force(d), 26.375543 / 31.160545, 5e-3);
}

/// Benchmark 2.6: the impact of a Zener ball at 1 m/s. Contact time and force depart as the elastic ball's do at
/// that speed, by 0.970 and 1.046.
TEST(Hertz, ZenerImpact) {
  struct Row {
    double tau, e, time, force;
  };
  for (const Row& row : {Row{1e-5, .95772, 1.24079e-3, 132.38}, Row{5e-5, .82929, 1.21176e-3, 125.60}, Row{1e-4, .73615, 1.16070e-3, 126.61},
                         Row{2e-4, .68070, 1.05780e-3, 136.46}, Row{1e-3, .84049, .94152e-3, 164.81}}) {
    const test::Bounce b = test::bounce(normal(zener(row.tau), 0.15), 1, 0);
    EXPECT_NEAR(b.v_n, row.e, 0.01) << row.tau;
    EXPECT_NEAR(b.contact_time / row.time, .970, .02) << row.tau;
    EXPECT_NEAR(b.peak_force / row.force, 1.046, .02) << row.tau;
  }
}

}  // namespace
}  // namespace hosel::models
