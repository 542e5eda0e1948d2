// A face with a thickness under ball and pendulum: condensation against more modes, the ledger, and its limits.
#include "models/fe/plate_face.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include "models/fe/plate_strike.hpp"
#include "tests/support/coarse_impact.hpp"

namespace hosel::models {
namespace {

using Eigen::Vector2d;

/// Titanium, 90 by 50 mm, thicker in the middle; its rim turns on springs.
PlateDesign plate_design() {
  PlateDesign d;
  d.thickness.map = mesh::PlateThickness::Bulge{3.2e-3, 2.4e-3, 0.03, 0.018};
  d.rim.rotation = 6e3;
  d.mesh = {.core = 4, .rings = 2};
  return d;
}

FeImpactOptions with_plate(const PlateDesign& d) {
  FeImpactOptions o = test::coarse_impact(2);
  o.face = std::make_shared<const PlateOnDemand>(d);
  return o;
}

/// By formulas: pi a b t of an ellipse, pi w h / 3 times what a bulge rises, 4 a b t of a rectangle. 240 rays miss a
/// rectangle's corners by (2 pi / 240)^2 of their sectors.
TEST(PlateDesign, MassIsDensityTimesVolume) {
  PlateDesign d = plate_design();
  const double a = d.outline.half_width, b = d.outline.half_height;
  EXPECT_NEAR(d.mass(), d.material.density * kPi * (2.4e-3 * a * b + 0.8e-3 * 0.03 * 0.018 / 3), 2e-4 * d.mass());
  d.thickness.map = mesh::PlateThickness::Constant{2e-3};
  EXPECT_NEAR(d.mass(), d.material.density * kPi * 2e-3 * a * b, 1e-9);
  d.outline.form = mesh::PlateOutline::Form::rectangle;
  EXPECT_NEAR(d.mass(), d.material.density * 4 * 2e-3 * a * b, 2e-3 * d.mass());
  d.outline = {.form = mesh::PlateOutline::Form::polygon, .corners = {{a, b}, {-a, b}, {-a, -b}, {a, -b}}};
  EXPECT_NEAR(d.mass(), d.material.density * 4 * 2e-3 * a * b, 2e-3 * d.mass());
}

/// The static shape about the place is among the condensed ones: compliance there is the plate's own.
TEST(PlateFace, CondensationKeepsTheComplianceWhereItIsStruck) {
  const PlateFace plate(plate_design(), {0.3, 0.3});
  for (const Vector2d& place : {Vector2d(0, 0), Vector2d(0.018, -0.009)}) {
    const CondensedPlate condensed = plate.condensed(place);
    const double exact = plate.compliance(place, 9e-3);
    const fem::Vector load = plate.patch_load(place, 9e-3);
    const Eigen::VectorXd on = condensed.fields.transpose() * load;
    double found = 0;
    for (Eigen::Index j = 0; j < on.size(); ++j) found += on[j] * on[j] / condensed.face.stiffness(j, j);
    EXPECT_NEAR(found, exact, 1e-6 * exact);
    double modes = 0;
    for (int j = 0; j < plate.design().modes; ++j)
      modes += std::pow(plate.modes().col(j).dot(load) / plate.omega()[std::size_t(j)], 2);
    EXPECT_LT(modes, 0.99 * exact);  // modes alone do not
    // The spline carries the shapes: their sum under the load is the plate's deflection, but for the kinks of its
    // slope between elements of this mesh, which the spline rounds.
    const fem::SurfaceUnknowns w = on.cwiseQuotient(condensed.face.stiffness.diagonal());
    EXPECT_NEAR(condensed.shapes->sum(place, w), plate.plate().deflection(plate.solve(load), place), 4e-3 * exact);
  }
}

TEST(PlateFace, SplineDerivatives) {
  const CondensedPlate condensed = PlateFace(plate_design(), {0.3, 0.3}).condensed({0.01, 0.005});
  fem::SurfaceUnknowns w = fem::SurfaceUnknowns::Zero(condensed.face.size());
  for (Eigen::Index j = 0; j < w.size(); ++j) w[j] = 1.0 / double(j + 1);
  const double h = 1e-6;
  for (const Vector2d& x : {Vector2d(0.0132, -0.0071), Vector2d(-0.0301, 0.0043)}) {
    const fem::Travel at = condensed.shapes->at(x, w);
    EXPECT_NEAR(at.value, condensed.shapes->sum(x, w), 1e-12);
    for (int i = 0; i < 2; ++i) {
      const Vector2d d = h * Vector2d::Unit(i);
      const fem::Travel up = condensed.shapes->at(x + d, w), down = condensed.shapes->at(x - d, w);
      EXPECT_NEAR(at.slope[i], (up.value - down.value) / (2 * h), 1e-5 * at.slope.norm());
      EXPECT_NEAR((at.second.col(i) - (up.slope - down.slope) / (2 * h)).norm(), 0, 1e-4 * at.second.norm());
      EXPECT_NEAR((at.shape_slope.row(i).transpose() - (up.shape - down.shape) / (2 * h)).norm(), 0,
                  1e-5 * at.shape_slope.norm());
    }
  }
}

/// Off centre, with friction and a curved face. The largest stress is that of one of the steps, and no step has a
/// larger one; a face that is no plate has none. Of the same blow, which is costly: the ledger closes as that of the
/// rigid face does; modes beyond those kept are worth 0.05 % of ball speed and 0.5 % of spin.
TEST(PlateFace, StressOfABlowIsTheLargestOfItsSteps) {
  const Blow blow = test::driver_blow(0.015, 0.006);
  FeImpactOptions rigid = with_plate(plate_design());
  rigid.face = nullptr;
  FaceStress stress, none;
  std::vector<FacePeak> steps;
  const auto watch = [&](const ImpactView& v) {
    stress.see(v);
    if (v.bodies.face_stresses) steps.push_back(v.bodies.face_stresses()(v.bodies.face->unknowns(v.state)));
  };
  const FeOutcome a = Impact(with_plate(plate_design())).run(blow, watch),
                  b = Impact(rigid).run(blow, [&](const ImpactView&v) { none.see(v); });
  ASSERT_GT(a.result.face_travel, 2e-4);
  ASSERT_GT(a.result.face_energy, 0);
  EXPECT_LT(std::abs(a.result.ledger.closure), 2 * std::abs(b.result.ledger.closure) + 1e-4 * a.result.ledger.initial);
  EXPECT_GT(a.launch.velocity.norm(), b.launch.velocity.norm() * 1.005);

  const auto largest = std::ranges::max_element(steps, {}, &FacePeak::stress);
  ASSERT_GT(std::distance(steps.begin(), largest), 5) << "the stress rises at first";
  ASSERT_LT(largest + 5, steps.end()) << "and falls again";
  ASSERT_TRUE(stress.peak());
  EXPECT_EQ(stress.peak()->stress, largest->stress);
  EXPECT_EQ(stress.peak()->place, largest->place);
  EXPECT_GT(stress.peak()->stress, 5e8);
  // It is beside the place struck: y points to the heel.
  EXPECT_LT((stress.peak()->place - Vector2d(-0.015, 0.006)).norm(), 0.012);
  EXPECT_FALSE(none.peak());

  PlateDesign all = plate_design(), few = all;
  all.modes = 27;
  few.modes = 1;
  const Launch &kept = a.launch, whole = Impact(with_plate(all)).run(blow).launch,
               one = Impact(with_plate(few)).run(blow).launch;
  EXPECT_NEAR(kept.ball_speed(), whole.ball_speed(), 5e-4 * whole.ball_speed());
  EXPECT_NEAR(kept.spin_rate(), whole.spin_rate(), 5e-3 * whole.spin_rate());
  EXPECT_GT(std::abs(one.ball_speed() - whole.ball_speed()), std::abs(kept.ball_speed() - whole.ball_speed()));
}

/// A face of so few elements that all of its flexural modes can be kept is its own unreduced face: what the other modes
/// carry, shear through the thickness, is less than 0.1 % of its static compliance.
TEST(PlateFace, AgreesWithTheUnreducedFace) {
  const Blow blow = test::driver_blow(0.015, 0.006);
  PlateDesign reduced = plate_design();
  reduced.outline = {.form = mesh::PlateOutline::Form::rectangle, .half_width = 0.040, .half_height = 0.022};
  reduced.thickness.map = mesh::PlateThickness::Constant{2.8e-3};
  reduced.rim = {};
  reduced.mesh = {.core = 2, .rings = 1};
  PlateDesign whole = reduced;
  whole.modes = 27;
  const PlateFace flat(whole, Face{});
  ASSERT_EQ(flat.modes().cols(), 63);  // three unknowns at 21 free nodes
  const Vector2d place(-0.015, 0.006);
  const fem::Vector load = flat.patch_load(place, 9e-3);
  double kept = 0;
  for (int j = 0; j < whole.modes; ++j)
    kept += std::pow(flat.modes().col(j).dot(load) / flat.omega()[std::size_t(j)], 2);
  ASSERT_NEAR(kept, flat.compliance(place, 9e-3), 1e-3 * kept);
  const FeOutcome a = Impact(with_plate(reduced)).run(blow), b = Impact(with_plate(whole)).run(blow);
  ASSERT_GT(b.result.face_travel, 1e-4);
  EXPECT_NEAR(a.launch.ball_speed(), b.launch.ball_speed(), 5e-4 * b.launch.ball_speed());
  EXPECT_NEAR(a.launch.spin_rate(), b.launch.spin_rate(), 5e-3 * b.launch.spin_rate());
}

/// A blow with a plane of symmetry meets the shapes that are their own mirror image; all of them give the same.
TEST(PlateFace, HalfOfASymmetricBlowIsTheWhole) {
  Blow blow = test::driver_blow(0, 0.004);
  blow.club.head.cg.y() = 0;
  blow.club.head.inertia = Mat3(blow.club.head.inertia.diagonal().asDiagonal());
  Blow aside = blow;
  aside.delivery.impact_toe = 1e-7;
  FeImpactOptions o = with_plate(plate_design());
  o.newton_relative = 1e-8;
  const FeOutcome half = Impact(o).run(blow), whole = Impact(o).run(aside);
  ASSERT_LT(half.result.last.q.size(), whole.result.last.q.size());
  EXPECT_LT((half.launch.velocity - whole.launch.velocity).norm(), 1e-4 * half.launch.velocity.norm());
  EXPECT_LT((half.launch.spin - whole.launch.spin).norm(), 1e-3 * half.launch.spin.norm());
}

/// The rigid face is the limit of a stiff plate.
TEST(PlateFace, RigidIsItsLimit) {
  const Blow blow = test::driver_blow(0.015, 0.006);
  PlateDesign d = plate_design();
  d.material.young = 1e20;
  d.rim = {};
  d.damping = 0;
  FeImpactOptions stiff = with_plate(d);
  stiff.newton_relative = 1e-9;
  FeImpactOptions rigid = stiff;
  rigid.face = nullptr;
  const Launch a = Impact(stiff).run(blow).launch, b = Impact(rigid).run(blow).launch;
  ASSERT_GT(b.peak_force, 5e3);
  EXPECT_LT((a.velocity - b.velocity).norm(), 1e-7 * b.velocity.norm());
  EXPECT_LT((a.spin - b.spin).norm(), 1e-6 * b.spin.norm());
}

Head bare_driver() {
  return {
      .mass = 0.2, .cg = Vec3(-0.035, 0, 0.004), .inertia = Vec3(2e-4, 3e-4, 4.5e-4).asDiagonal(), .face = {0.3, 0.3}};
}

/// A plate without mass follows the pendulum at rest: the lumped face as stiff as it is there.
TEST(PlateStrike, PendulumOnAMasslessPlateIsThatOnASpring) {
  PlateDesign light = plate_design();
  light.material.density *= 1e-3;
  const PlateStrike strike(std::make_shared<const PlateFace>(light, bare_driver().face), bare_driver());
  const Striker sphere = steel_sphere(0.011);
  for (const Vector2d& place : {Vector2d(0, 0), Vector2d(0.02, 0.006)}) {
    const auto at = strike.at(place, pendulum_patch(strike.plate(), place));
    EXPECT_NEAR(at.mass, mass_at(bare_driver(), place.x(), place.y()), 1e-3 * at.mass);
    const FaceCompliance spring{.mass = 1e-6, .stiffness = 1 / at.compliance};
    const CharacteristicTime wanted = characteristic_time(sphere, at.mass, spring, 1, pendulum_speeds()),
                             found = strike.characteristic_time(sphere, place, pendulum_speeds());
    const auto tap = strike.strike(sphere, at, 1.3);
    ASSERT_EQ(tap.touches, 1);
    EXPECT_NEAR(tap.contact_time, wanted.times[3], 3e-3 * wanted.times[3]);
    // The rise of a pulse that is no half sine gives its length to 2 %.
    EXPECT_NEAR(found.time, wanted.time, 0.02 * wanted.time);
  }
}

/// A light face still vibrates when the sphere leaves and touches it again: the time is that of the first touch, and
/// goes on evenly with the thickness where the second touch comes.
TEST(PlateStrike, SecondTouchDoesNotMoveTheCharacteristicTime) {
  std::vector<double> times;
  bool again = false;
  for (const double centre : {2.62e-3, 2.7e-3, 2.8e-3}) {
    PlateDesign d = plate_design();
    d.mesh = {};
    d.outline.half_width = 0.042;
    d.outline.half_height = 0.0272;
    d.thickness.map = mesh::PlateThickness::Bulge{centre, 2.42e-3, 0.03, 0.018};
    d.rim = fem::RimSupport::of_shell(d.material, 0.8e-3, 0.04, 0.1);
    const PlateStrike strike(std::make_shared<const PlateFace>(d, bare_driver().face), bare_driver());
    const Vector2d middle(0, 0);
    const auto tap = strike.strike(steel_sphere(0.011), strike.at(middle, pendulum_patch(strike.plate(), middle)), 1.3);
    again = again || tap.touches > 1;
    times.push_back(strike.characteristic_time(steel_sphere(0.011), middle, pendulum_speeds()).time);
  }
  ASSERT_TRUE(again) << "no face that touches twice";
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i], times[i - 1], 0.04 * times[i]);
}

/// Three times the modes change the characteristic time by less than 1 us.
TEST(PlateStrike, MoreModesChangeThePendulumLittle) {
  PlateDesign more = plate_design();
  more.modes = 27;
  const PlateStrike few(std::make_shared<const PlateFace>(plate_design(), bare_driver().face), bare_driver()),
      many(std::make_shared<const PlateFace>(more, bare_driver().face), bare_driver());
  const Striker sphere = steel_sphere(0.011);
  for (const Vector2d& place : {Vector2d(0, 0), Vector2d(0.018, -0.009)}) {
    const double time = many.characteristic_time(sphere, place, pendulum_speeds()).time;
    ASSERT_GT(time, 1e-4);
    EXPECT_NEAR(few.characteristic_time(sphere, place, pendulum_speeds()).time, time, 1e-6);
  }
}

/// Along the face the ball's restitution falls evenly: the loss that depends on the rate of indentation stays stable
/// beside the compliance in series.
TEST(PlateStrike, RestitutionFallsEvenlyTowardsTheToe) {
  PlateDesign d = plate_design();
  d.thickness.map = mesh::PlateThickness::Constant{2.8e-3};
  d.rim = fem::RimSupport::of_shell(d.material, 0.8e-3, 0.04, 0.1);
  d.mesh = {};
  const PlateStrike strike(std::make_shared<const PlateFace>(d, bare_driver().face), bare_driver());
  std::vector<double> found;
  for (int i = 0; i <= 8; ++i)
    found.push_back(strike.strike(golf_ball({}), strike.at(Vector2d(3e-3 * i, 0), kBallPatch), 48.77).restitution);
  ASSERT_GT(found.front() - found.back(), 0.01);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LT(found[i], found[i - 1]) << i;
    EXPECT_LT(found[i - 1] - found[i], 0.01) << i;
  }
}

/// On a head that does not move, modes and what they leave out make up the static compliance; a heavy one is its limit.
TEST(PlateStrike, ModesAndWhatTheyLeaveOutAreTheStaticCompliance) {
  const auto plate = std::make_shared<const PlateFace>(plate_design(), bare_driver().face);
  Head wall = bare_driver(), heavy = wall;
  wall.mass = INFINITY;
  heavy.mass *= 1e6;
  heavy.inertia *= 1e6;
  const PlateStrike still(plate, wall), hardly(plate, heavy);
  for (const Vector2d& place : {Vector2d(0, 0), Vector2d(0.018, -0.009)}) {
    const auto at = still.at(place, kBallPatch), near = hardly.at(place, kBallPatch);
    const auto modes = [](const PlateStrike& strike, const PlateStrike::Place& p) {
      const Eigen::Map<const Eigen::VectorXd> omega(strike.omega().data(), p.participation.size());
      return p.participation.cwiseQuotient(omega).squaredNorm();
    };
    ASSERT_GT(at.residual, 1e-3 * at.compliance);
    ASSERT_GT(modes(still, at), 0.5 * at.compliance);
    EXPECT_NEAR(modes(still, at) + at.residual, at.compliance, 1e-9 * at.compliance);
    EXPECT_NEAR(modes(hardly, near), modes(still, at), 1e-5 * at.compliance);
  }
}

/// A linear spring on an undamped face: until it is let go a linear system, whose modes solve it. What is not in the
/// rebound is left in the vibrations.
TEST(PlateStrike, UndampedBlowOfASpringIsTheExactOneAndKeepsItsEnergy) {
  PlateDesign d = plate_design();
  d.damping = 0;
  const PlateStrike strike(std::make_shared<const PlateFace>(d, bare_driver().face), bare_driver());
  const auto at = strike.at(Vector2d(0.01, 0.004), kBallPatch);
  const Striker spring{0.046, 1e7, 1, 0};
  constexpr double kSpeed = 45;
  const auto found = strike.strike(spring, at, kSpeed);
  ASSERT_EQ(found.touches, 1);

  // Unknowns of unit mass: the gap by the reduced mass, and the vibrations.
  const Eigen::Index n = at.participation.size();
  const double reduced = 1 / (1 / spring.mass + 1 / at.mass), stiffness = 1 / (1 / spring.stiffness + at.residual);
  Eigen::VectorXd approach(n + 1), omega2 = Eigen::VectorXd::Zero(n + 1);
  approach << 1 / std::sqrt(reduced), at.participation;
  omega2.tail(n) = Eigen::Map<const Eigen::VectorXd>(strike.omega().data(), n).cwiseAbs2();
  const Eigen::MatrixXd K = Eigen::MatrixXd(omega2.asDiagonal()) + stiffness * approach * approach.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K);
  const Eigen::ArrayXd frequency = modes.eigenvalues().array().sqrt();
  const Eigen::VectorXd start = kSpeed * std::sqrt(reduced) * Eigen::VectorXd::Unit(n + 1, 0),
                        amplitude = modes.eigenvectors().transpose() * start;
  const auto place = [&](double t) -> Eigen::VectorXd {
    return modes.eigenvectors() * (amplitude.array() * (frequency * t).sin() / frequency).matrix();
  };
  double low = 1e-6;
  while (approach.dot(place(low + 1e-6)) > 0) low += 1e-6;
  double high = low + 1e-6;
  for (int i = 0; i < 60; ++i) (approach.dot(place(0.5 * (low + high))) > 0 ? low : high) = 0.5 * (low + high);
  const Eigen::VectorXd end = place(low),
                        rate = modes.eigenvectors() * (amplitude.array() * (frequency * low).cos()).matrix();
  const double exact = -rate[0] / std::sqrt(reduced) / kSpeed;
  const double vibration = 0.5 * (rate.tail(n).squaredNorm() + omega2.cwiseProduct(end).dot(end)),
               energy = 0.5 * reduced * kSpeed * kSpeed;
  ASSERT_GT(vibration, 0.02 * energy);
  // Steps of a quarter microsecond: the fastest mode is early by (0.04)^2 / 24.
  EXPECT_NEAR(found.restitution, exact, 1e-3 * (1 - exact));
  EXPECT_NEAR(found.restitution * found.restitution + vibration / energy, 1, 1e-3);
  EXPECT_NEAR(found.contact_time, low, 1e-6);
}

}  // namespace
}  // namespace hosel::models
