// A lumped face under a linear ball against the closed solution, and under the finite-element ball.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/contact_method/penalty.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "fem/materials/linear_elastic.hpp"
#include "fem/rigid_body.hpp"
#include "fem/yielding_face.hpp"
#include "golf/face_library.hpp"
#include "golf/units.hpp"
#include "models/club/swing_end.hpp"
#include "models/reduced/volumetric.hpp"
#include "tests/support/coarse_impact.hpp"
#include "tests/support/two_masses.hpp"

namespace hosel::models {
namespace {

constexpr double kBall = 0.04593, kHead = 0.2, kSpeed = 45, kSpring = 2e6;  // [kg], [kg], [m/s], [N/m]

struct Outcome : test::TwoMasses {
  double closure = 0;
};

test::TwoMasses closed_form(const FaceCompliance& face) {
  return test::two_masses(kBall, kSpring, kHead, face, kSpeed);
}

/// Every part of the finite-element contact: a rod, rigid to one part in 10^5, whose flat end meets a
/// flat face: penalty times area is the linear ball.
Outcome finite_elements(const FaceCompliance& face, int steps) {
  const double radius = 0.01, length = 0.02, area = kPi * radius * radius;
  mesh::Meridian rod;
  for (const double s : {-0.5, 0.0, 0.5})
    for (const double rho : {0.0, 0.5, 1.0}) rod.nodes.emplace_back(s * length, rho * radius);
  rod.nodes.erase(rod.nodes.begin() + 4);  // eight-node element: nothing in the middle
  rod.elements = {{0, 5, 7, 2, 3, 6, 4, 1}};
  rod.layer = {0};
  rod.surface = {{5, 7, 6}};
  rod.radius = radius;
  fem::System system;
  Mat3 axes;
  axes << -1, 0, 0, 0, 1, 0, 0, 0, -1;
  const fem::Solid steel{.elastic = fem::LinearElastic{fem::Lame::of(1e5 * kSpring * length / area, 0)},
                         .branches = {},
                         .density = kBall / (area * length)};
  auto ball = std::make_unique<fem::HarmonicSolid>(system.dof_map, rod, fem::axisymmetric_basis(),
                                                   fem::SolidQuadrature{fem::single_angle(), 2},
                                                   std::vector<fem::Solid>{steel}, fem::Placement{Vec3::Zero(), axes});
  const auto x = system.dof_map.add_vector(3), r = system.dof_map.add_rotation(), w = system.dof_map.add_vector(1);
  const fem::SurfaceCarrier carrier{x, r, Vec3(0.03, 0, 0)};
  auto head = std::make_unique<fem::RigidBody>("head", x, r,
                                               fem::RigidBodyProperties{kHead, 3e-4 * Mat3::Identity(), Vec3::Zero()});
  auto spring = std::make_unique<fem::FaceSpring>(fem::ReducedFace::lumped(face), carrier, w);
  auto contact =
      std::make_unique<fem::Contact>(*ball, std::make_unique<fem::YieldingFace>(Face{}, face, w), carrier,
                                     fem::ContactLaws{std::make_unique<fem::Penalty>(kSpring / area), nullptr},
                                     fem::single_angle(), fem::Symmetry::axis);
  const fem::HarmonicSolid& b = *ball;
  const fem::RigidBody& h = *head;
  const fem::FaceSpring& f = *spring;
  auto& c = *contact;
  system.terms.push_back(std::move(ball));
  system.terms.push_back(std::move(head));
  system.terms.push_back(std::move(spring));
  system.terms.push_back(std::move(contact));
  fem::State initial = system.dof_map.rest();
  initial.q.segment<3>(x.q) = Vec3(-length / 2 - carrier.centre.x(), 0, 0);
  initial.v[x.v] = kSpeed;
  c.start(initial);
  const test::TwoMasses exact = closed_form(face);
  const double step = exact.contact_time / steps;
  solvers::GeneralizedAlphaOptions options;
  options.newton.residual_relative = 1e-9;
  options.newton.increment_vector = 1e-9 * length;
  options.newton.increment_rotation = 1e-6;
  options.rho_inf = 0.8;
  options.step_max = step;
  options.step_min = step / 64;
  solvers::GeneralizedAlpha solver(system, options, initial);
  Outcome out;
  double force = 0;
  while (solver.time() < 2 * exact.contact_time) {
    solver.advance(solver.time() + step);
    const fem::ContactReport report = c.report(solver.state());
    force = std::max(force, report.normal_force);
    if (report.points == 0) break;
  }
  EXPECT_GT(force, 8e3);
  // The face is separate from here on: what it does against the head is its own vibration.
  const Vec3 momentum = h.linear_momentum(solver.state());
  const double ball_velocity = b.motion(solver.state()).velocity.x();
  const double head_velocity = (kHead * kSpeed - kBall * ball_velocity) / kHead;
  EXPECT_NEAR(momentum.x() - face.mass * solver.state().v[w.v], kHead * head_velocity, 1e-9 * kHead * kSpeed);
  out.restitution = (ball_velocity - head_velocity) / kSpeed;
  out.contact_time = solver.time();
  out.face_energy = f.vibration(solver.state(), kHead);
  out.closure = solver.ledger().closure / solver.ledger().initial;
  return out;
}

TEST(YieldingFace, AgreesWithTheClosedTwoMassSolution) {
  for (const auto& [mass, stiffness] : {std::pair{0.005, 1e7}, {0.015, 1e7}, {0.02, 7e6}}) {
    SCOPED_TRACE(testing::Message() << mass << " kg, " << stiffness << " N/m");
    const FaceCompliance face{.mass = mass, .stiffness = stiffness};
    const test::TwoMasses exact = closed_form(face);
    const Outcome found = finite_elements(face, 2000);
    ASSERT_GT(exact.face_energy, 0.05);
    EXPECT_NEAR(found.restitution, exact.restitution, 1e-3 * exact.restitution);
    EXPECT_NEAR(found.contact_time, exact.contact_time, 1e-3 * exact.contact_time);
    EXPECT_NEAR(found.face_energy, exact.face_energy, 1e-3 * exact.face_energy);
    EXPECT_LT(std::abs(found.closure), 1e-6);
  }
}

constexpr FaceCompliance kDriverFace{
    .mass = 0.012, .stiffness = 1e7, .damping = 10, .half_width = 0.05, .half_height = 0.028};

/// Off centre, with friction and a curved face: the ledger closes as that of the rigid face does, and the yielding one
/// gives the ball more speed.
TEST(YieldingFace, LedgerClosesOffCentre) {
  const Blow rigid = test::driver_blow(0.015, 0.006);
  Blow yielding = rigid;
  yielding.club.head.compliance = kDriverFace;
  const Impact impact(test::coarse_impact(2));
  double loss = 0, last = 0, time = 0;  // damping times the square of the face's speed, over the blow
  const auto watch = [&](const ImpactView& v) {
    const double travel = v.bodies.face->unknowns(v.state)[0];
    if (v.state.time > time) loss += kDriverFace.damping * (travel - last) * (travel - last) / (v.state.time - time);
    last = travel;
    time = v.state.time;
  };
  const FeOutcome a = impact.run(yielding, watch), b = impact.run(rigid);
  ASSERT_GT(a.result.face_travel, 2e-4);
  // Beside the ball's layers nothing else is viscous than the face's damper.
  const auto by_face = [](const FeImpactResult& r) {
    double ball = 0;
    for (const double layer : r.dissipated) ball += layer;
    return r.ledger.viscous - ball;
  };
  EXPECT_LT(std::abs(by_face(b.result)), 1e-9 * b.result.ledger.viscous);
  ASSERT_GT(loss, 1e-5 * a.result.ledger.initial);
  EXPECT_NEAR(by_face(a.result), loss, 0.02 * loss);  // mean speeds of some hundred steps
  EXPECT_LT(std::abs(a.result.ledger.closure), 2 * std::abs(b.result.ledger.closure) + 1e-4 * a.result.ledger.initial);
  EXPECT_GT(a.launch.velocity.norm(), b.launch.velocity.norm() * 1.005);
}

/// A driver at 112 mph, loft 10 deg, on a face at the rules' limit. The momentum balance of measured tour drives gives
/// 1.48 to 1.50 of the club's speed at the centre: met by a ball at the upper end of what is measured on a wall (0.77;
/// cases/driver-speed), within 2 % of 1.49 not by the library's (0.72), let alone on a rigid face. Look-level numerics:
/// 0.2 % of the speed.
TEST(YieldingFace, DriverAt112MilesPerHour) {
  Blow blow;
  blow.club.head = {
      .mass = 0.2, .cg = Vec3(-0.035, 0, 0.004), .inertia = Vec3(2e-4, 3e-4, 4.5e-4).asDiagonal(), .face = {0.4, 0.35}};
  blow.delivery = {.club_speed = 112 * kMpsPerMph, .dynamic_loft = radians(10)};
  FeImpactOptions o;
  o.resolve(Accuracy::look);
  const auto smash = [&] { return Impact(o).run(blow).launch.velocity.norm() / blow.delivery.club_speed; };
  const double rigid = smash();
  blow.club.head.compliance = find_face("modern-driver")->face;
  const double yielding = smash();
  o.ball = elastic_ball(
      "livelier",
      {.elastic = fem::Hyperelastic{.c10 = 16e6, .bulk = 1e9}, .branches = {{45e6, 1e-5}}, .density = 1129});
  const double livelier = smash();
  EXPECT_NEAR(rigid, 1.368, 0.004);
  EXPECT_NEAR(yielding, 1.456, 0.004);
  EXPECT_GT(livelier, 1.48);
  EXPECT_LT(livelier, 1.50);
}

/// The rigid face is the limit: travel and launch depart from it like 1 / stiffness.
TEST(YieldingFace, RigidIsItsLimit) {
  const Blow rigid = test::driver_blow(0.015, 0.006);
  Blow stiff = rigid;
  stiff.club.head.compliance = kDriverFace;
  stiff.club.head.compliance->stiffness = 1e16;
  stiff.club.head.compliance->damping = 0;
  FeImpactOptions o = test::coarse_impact(2);
  o.newton_relative = 1e-9;  // what Newton leaves is not what is looked for
  const Impact impact(o);
  const Launch a = impact.launch(stiff), b = impact.launch(rigid);
  ASSERT_GT(b.peak_force, 5e3);
  EXPECT_LT((a.velocity - b.velocity).norm(), 1e-8 * b.velocity.norm());
  EXPECT_LT((a.spin - b.spin).norm(), 1e-7 * b.spin.norm());
}

/// An elliptic face keeps its axes in the head: where it was struck it yields as before, whatever frame describes it.
TEST(YieldingFace, ATurnedFaceYieldsWhereItDid) {
  const double lie = radians(4.19);
  Blow blow;
  blow.club = test::driver_club();
  Head& head = blow.club.head;
  head.face = {.bulge = 0.3, .roll = 0.3};
  head.compliance = {.mass = 0.01, .stiffness = 8e6, .half_width = 0.045, .half_height = 0.028};
  blow.delivery = {.club_speed = 45, .impact_toe = 0.02, .impact_high = 0.008};
  Blow turned = blow;
  turned.club = turned_about_normal(blow.club, lie);
  turn_place(lie, turned.delivery);
  const auto shape = [](const FaceCompliance& face, const Delivery& d) {
    return face.shape(-d.impact_toe, d.impact_high);
  };
  const FaceCompliance before = *head.compliance, after = *turned.club.head.compliance;
  const double meant = shape(before, blow.delivery).value;
  ASSERT_GT(std::abs(shape(before, turned.delivery).value - meant), 0.01) << "the turn matters there";
  EXPECT_NEAR(shape(after, turned.delivery).value, meant, 1e-12);
  const FaceCompliance::Shape s = shape(after, turned.delivery);
  const double y = -turned.delivery.impact_toe, z = turned.delivery.impact_high, h = 1e-6;
  for (int k = 0; k < 2; ++k) {
    const auto more = after.shape(y + (k == 0) * h, z + (k == 1) * h),
               less = after.shape(y - (k == 0) * h, z - (k == 1) * h);
    EXPECT_NEAR(s.slope[k], (more.value - less.value) / (2 * h), 1e-6 * s.slope.norm());
    EXPECT_LT((s.second.col(k) - (more.slope - less.slope) / (2 * h)).norm(), 1e-6 * s.second.norm());
  }
  // The blow along the normal is the same one, seen from a frame turned about it.
  const Mat3 turn = Eigen::AngleAxisd(-lie, Vec3::UnitX()).toRotationMatrix();
  FeImpactOptions coarse;
  coarse.harmonics = 2;
  coarse.mesh = {.sector = 2, .rings = 2, .pole = 0.5, .skin = 0.6, .core = 0.4};
  coarse.penalty = 200;
  coarse.steps_per_contact = 30;
  const Volumetric reduced(VolumetricLaw::published_driver());
  const Impact meshed(coarse);
  for (const ImpactModel* model :
       {static_cast<const ImpactModel*>(&reduced), static_cast<const ImpactModel*>(&meshed)}) {
    const Launch a = model->launch(blow), b = model->launch(turned);
    Blow unturned = turned;
    unturned.club.head.compliance = before;
    const Vec3 off = model->launch(unturned).velocity - turn * a.velocity;
    ASSERT_GT(off.norm(), 1e-4 * a.ball_speed());
    EXPECT_LT((b.velocity - turn * a.velocity).norm(), 0.02 * off.norm());
    EXPECT_LT((b.spin - turn * a.spin).norm(), 1e-3 * a.spin_rate());
  }
}

}  // namespace
}  // namespace hosel::models
