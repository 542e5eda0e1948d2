// The bench against the full finite-element eigenproblem, against beam theory, and against statics.
#include "models/modal/bench.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/rigid_body.hpp"
#include "fem/supports.hpp"
#include "golf/shaft_library.hpp"
#include "models/club/swing.hpp"
#include "solvers/modes.hpp"

namespace hosel::models {
namespace {

Club bench_driver() {
  Club club;
  club.shaft = shaft_library().front().make();
  for (const NamedShaft& s : shaft_library())
    if (s.name == "composite-bench_driver") club.shaft = s.make();
  club.head.mass = 0.204;
  club.head.cg = Vec3(-0.0423, 0.001, 0.0029);
  club.head.inertia << 2.843e-4, 0.53e-4, -0.733e-4, 0.53e-4, 4.085e-4, 0.0005e-4, -0.733e-4, 0.0005e-4, 5.679e-4;
  club.geometry.hosel = Vec3(-0.02, 0.055, 0.02);
  club.geometry.shaft_axis = Vec3(0, std::cos(1.01229), std::sin(1.01229));
  return club;
}

/// Modes of the whole finite-element model, springs at clamp and hosel included.
std::vector<double> reference(const Club& declared, const ClubChange& c, int count) {
  fem::System system;
  Club club = declared;
  club.shaft = scaled(*declared.shaft, std::exp(c.bending), std::exp(c.torsion));
  club.head = changed(club.head, c);
  const auto line = mesh::straight(mesh::graded(club.shaft->length(), 12), Vec3::Zero(),
                                   mesh::frame_along(-Vec3::UnitZ(), Vec3::UnitX()));
  auto owned = std::make_unique<fem::Beam>(system.dof_map, line, fem::shaft_sections(*club.shaft), fem::BeamOptions{});
  const fem::Beam& beam = *owned;
  system.terms.push_back(std::move(owned));
  const auto compliant = [](const Vec3& v) {
    fem::JointStiffness k;
    k.translation = Vec3::Constant(1e9);
    for (int a = 0; a < 3; ++a) k.rotation[a] = v[a] > 0 ? 1 / v[a] : 1e7;
    return k;
  };
  if (c.clamp.norm() > 0)
    system.terms.push_back(std::make_unique<fem::SpringJoint>("hands", fem::at_rest(Vec3::Zero()), beam.nodes().front(),
                                                              compliant(c.clamp)));
  else
    system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(beam.nodes().front(), fem::at_rest(Vec3::Zero())));
  fem::Node head = beam.nodes().back();
  if (c.hosel.norm() > 0) {
    head = {system.dof_map.add_vector(3), system.dof_map.add_rotation()};
    system.terms.push_back(std::make_unique<fem::SpringJoint>("hosel", beam.nodes().back(), head, compliant(c.hosel)));
  }
  const Mat3 R = face_to_grip(club.geometry);
  system.terms.push_back(
      std::make_unique<fem::RigidBody>("head", head.translation, head.rotation,
                                       fem::RigidBodyProperties{club.head.mass, R * club.head.inertia * R.transpose(),
                                                                R * (club.head.cg - club.geometry.hosel)}));
  if (c.tip_mass > 0)
    system.terms.push_back(std::make_unique<fem::RigidBody>(
        "weight", head.translation, head.rotation, fem::RigidBodyProperties{c.tip_mass, Mat3::Zero(), Vec3::Zero()}));
  fem::State rest = system.dof_map.rest();
  beam.place(rest);
  if (c.hosel.norm() > 0) rest.q.segment<3>(head.translation.q) = line.back().position;
  return solvers::modes(system, rest, count).omega;
}

TEST(Bench, ModesOfEveryChangeAreThoseOfTheWholeModel) {
  const Club club = bench_driver();
  const Bench bench(club, true, {}, {});
  const std::vector<ClubChange> changes = {
      {},
      {.bending = 0.4},
      {.torsion = -0.3},
      {.clamp = Vec3(0, 2e-3, 0)},
      {.clamp = Vec3(1e-2, 1e-2, 1e-2)},
      {.hosel = Vec3(2e-3, 2e-3, 2e-3)},
      {.tip_mass = 0.02},
      {.cg = Vec3(0.01, -0.005, 0.01)},
      {.inertia = Vec3(0.3, -0.2, 0.1)},
      {.bending = -0.2, .clamp = Vec3(3e-3, 1e-3, 0), .tip_mass = 0.05},
  };
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const auto whole = reference(club, changes[k], 7);
    const BenchModes fast = bench.modes(changes[k]);
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(fast.omega[i] / whole[std::size_t(i)], 1, 2e-5) << "change " << k << ", mode " << i;
  }
}

TEST(Bench, BareUniformShaftIsTheCantileverOfBeamTheory) {
  // EI = 40 N m^2, 60 g/m, 1 m; thin, so that shear and rotary inertia do not count.
  Club club;
  club.shaft = composite_shaft({{0, 40, 40, 0.06, 1e-3}, {1, 40, 40, 0.06, 1e-3}});
  const Bench bench(club, false, {.elements = 16, .shear = false},
                    {{BenchSensor::Quantity::lead, 1.0},
                     {BenchSensor::Quantity::strain_lead, 0.25},
                     {BenchSensor::Quantity::droop, 1.0}});
  const BenchModes m = bench.modes({}, 100);
  const double unit = std::sqrt(40 / 0.06);
  for (const auto& [k, root] : {std::pair{0, 1.8751040687}, {2, 4.6940911330}, {4, 7.8547574382}})
    EXPECT_NEAR(m.omega[k] / (root * root * unit), 1, 2e-4);
  // Pushed sideways at the tip with 3 N: sum over modes of the static answer.
  double lead = 0, strain = 0;
  for (int k = 0; k < m.omega.size(); ++k) {
    const double amplitude = 3 * m.tip(0, k) / (m.omega[k] * m.omega[k]);
    lead += m.sensors(0, k) * amplitude;
    strain += m.sensors(1, k) * amplitude;
  }
  EXPECT_NEAR(lead, 3.0 / (3 * 40), 1e-5);
  EXPECT_NEAR(strain, -3 * 0.75 / 40 * 1e-3, 2e-3 * 3 * 0.75 / 40 * 1e-3);  // a point load is no sum of inertia forces
}

/// Lead bends the shaft about YG, which is local z, droop about XG, local y: strain is moment over that stiffness.
TEST(Bench, StrainOfAShaftThatIsStifferOneWay) {
  Club club;
  club.shaft = composite_shaft({{0, 40, 40, 0.06, 1e-3}, {1, 40, 40, 0.06, 1e-3}});
  for (ShaftStation& s : club.shaft->stations) s.bending_stiffness_z = 80;
  using Quantity = BenchSensor::Quantity;
  const Bench bench(
      club, false, {.elements = 16, .shear = false},
      {{Quantity::lead, 1.0}, {Quantity::strain_lead, 0.25}, {Quantity::droop, 1.0}, {Quantity::strain_droop, 0.25}});
  const BenchModes m = bench.modes({}, 100);
  // Pushed sideways at the tip with 3 N, along XG and along YG.
  for (const int way : {0, 1}) {
    double place = 0, strain = 0;
    for (int k = 0; k < m.omega.size(); ++k) {
      const double amplitude = 3 * m.tip(way, k) / (m.omega[k] * m.omega[k]);
      place += m.sensors(2 * way, k) * amplitude;
      strain += m.sensors(2 * way + 1, k) * amplitude;
    }
    const double stiffness = way == 0 ? 80 : 40, expected = 3 * 0.75 / stiffness * 1e-3;
    EXPECT_NEAR(place, 3.0 / (3 * stiffness), 1e-5) << way;
    EXPECT_NEAR(std::abs(strain), expected, 2e-3 * expected) << way;  // a point load is no sum of inertia forces
  }
}

TEST(Bench, GravityAndTurningStiffenAsThePendulumOnASpring) {
  // A stiff, light stick of 1 m with a point mass, clamped softly about YG.
  Club club;
  club.shaft = composite_shaft({{0, 1e6, 1e6, 1e-4, 5e-3}, {1, 1e6, 1e6, 1e-4, 5e-3}});
  club.head.mass = 0.2;
  club.head.cg = club.geometry.hosel;
  club.head.inertia = 1e-7 * Mat3::Identity();
  const double spring = 50, rate = 12, hub = 0.3;
  const auto first = [&](const BenchOptions& o, double share) {
    ClubChange c{.clamp = Vec3(0, 1 / spring, 0), .stiffening = share};
    const double omega = Bench(club, true, o, {}).modes(c).omega[0];
    return omega * omega;
  };
  const double still = spring / club.head.mass;
  EXPECT_NEAR(first({}, 0), still, 1e-3 * still);
  EXPECT_NEAR(first({.gravity = Vec3(0, 0, -kGravity)}, 0) - first({}, 0), kGravity, 0.01 * kGravity);
  EXPECT_NEAR(first({.gravity = Vec3(0, 0, kGravity)}, 0) - first({}, 0), -kGravity, 0.01 * kGravity);
  // Standing on a clamp softer than the weight of the head times its height, 2 N m, it falls over.
  const ClubChange soft{.clamp = Vec3(0, 1 / 1.5, 0)};
  EXPECT_THROW(Bench(club, true, {.gravity = Vec3(0, 0, kGravity)}, {}).modes(soft), std::invalid_argument);
  EXPECT_GT(Bench(club, true, {.gravity = Vec3(0, 0, -kGravity)}, {}).modes(soft).omega[0], 0);
  // About YG the lead direction lies in the plane of turning: rate^2 hub / L. About XG it does not: rate^2 (hub + L) /
  // L.
  const BenchOptions in_plane{.rotation_rate = rate, .rotation_axis = Vec3::UnitY(), .hub = hub};
  const BenchOptions across{.rotation_rate = rate, .rotation_axis = Vec3::UnitX(), .hub = hub};
  EXPECT_DOUBLE_EQ(first(in_plane, 0), first({}, 0));
  EXPECT_NEAR(first(in_plane, 1) - first({}, 0), rate * rate * hub, 0.01 * rate * rate * hub);
  EXPECT_NEAR(first(across, 1) - first({}, 0), rate * rate * (hub + 1), 0.01 * rate * rate * (hub + 1));
}

/// A field stiffens a mode and damps nothing: the dampers of the shaft take 2 zeta omega, turning or still.
TEST(Bench, AFieldDampsNothing) {
  Club club;
  club.shaft = composite_shaft({{0, 40, 40, 0.06, 1e-3}, {1, 40, 40, 0.06, 1e-3}});
  club.shaft->damping_time = 1e-3;
  const auto modes = [&](const BenchOptions& o) { return Bench(club, false, o, {}).modes({.stiffening = 1}, 1); };
  const BenchModes still = modes({.shear = false});
  const double omega = still.omega[0];
  EXPECT_NEAR(still.ratio[0], 0.5 * omega * 1e-3, 1e-6 * omega * 1e-3);
  // The shape of the first mode is nearly that of the cantilever at rest; omega^2 is a sixth larger.
  for (const BenchOptions& field :
       {BenchOptions{.shear = false, .rotation_rate = omega, .rotation_axis = Vec3::UnitX()},
        BenchOptions{.shear = false, .gravity = Vec3(0, 0, -100 * kGravity)}}) {
    const BenchModes pulled = modes(field);
    ASSERT_GT(pulled.omega[0], 1.08 * omega);
    EXPECT_NEAR(pulled.ratio[0] * pulled.omega[0] / (still.ratio[0] * omega), 1, 0.03);
  }
}

/// The strain is as far from the axis as the gauge: twice the radius, twice the reading. Without one the shaft's.
TEST(Bench, StrainIsThatAtTheGaugesRadius) {
  Club club;
  club.shaft = composite_shaft({{0, 40, 40, 0.06, 4e-3}, {1, 40, 40, 0.06, 4e-3}});
  using Quantity = BenchSensor::Quantity;
  const Eigen::MatrixXd reading = Bench(club, false, {},
                                        {{Quantity::strain_lead, 0.25},
                                         {Quantity::strain_lead, 0.25, 4e-3},
                                         {Quantity::strain_lead, 0.25, 8e-3},
                                         {Quantity::strain_droop, 0.25},
                                         {Quantity::strain_droop, 0.25, 5e-3}})
                                      .modes({}, 4)
                                      .sensors;
  ASSERT_GT(reading.row(0).norm(), 1e-3);
  ASSERT_GT(reading.row(3).norm(), 1e-3);
  EXPECT_LT((reading.row(1) - reading.row(0)).norm(), 1e-12 * reading.row(0).norm());
  EXPECT_LT((reading.row(2) - 2 * reading.row(0)).norm(), 1e-12 * reading.row(0).norm());
  EXPECT_LT((reading.row(4) - 1.25 * reading.row(3)).norm(), 1e-12 * reading.row(3).norm());
}

}  // namespace
}  // namespace hosel::models
