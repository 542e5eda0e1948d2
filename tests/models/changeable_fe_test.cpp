// What effects change of a finite-element ball and its shaft.
#include "models/fe/changeable_fe.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/rigid_body.hpp"
#include "fem/supports.hpp"
#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "models/calibration/ball_calibration.hpp"
#include "models/club/swing.hpp"
#include "models/parameters.hpp"
#include "solvers/modes.hpp"

namespace hosel::models {
namespace {

constexpr double kRadius = 0.021335, kContact = 0.45e-3;

TEST(ChangeableFe, NoChangeIsTheDeclaredBall) {
  const FeBall ball = two_piece_ball(), same = changed(ball, {}, kRadius);
  ASSERT_EQ(same.layers.size(), ball.layers.size());
  for (std::size_t k = 0; k < ball.layers.size(); ++k) {
    EXPECT_EQ(same.layers[k].radius, ball.layers[k].radius);
    EXPECT_EQ(same.layers[k].material.instant_shear(), ball.layers[k].material.instant_shear());
  }
}

TEST(ChangeableFe, AOnePieceBallGetsTheSkinThatItsCoverEffectStiffens) {
  const FeBall ball = changed(range_ball(), {.cover_stiffness = std::log(2.2), .cover_thickness = 0.3e-3}, kRadius);
  ASSERT_EQ(ball.layers.size(), 2U);
  EXPECT_NEAR((1 - ball.layers[0].radius) * kRadius, kSkin + 0.3e-3, 1e-12);
  EXPECT_NEAR(ball.layers[1].material.instant_shear() / ball.layers[0].material.instant_shear(), 2.2, 1e-12);
  EXPECT_THROW(changed(range_ball(), {.cover_thickness = -2e-3}, kRadius), std::invalid_argument);
}

TEST(ChangeableFe, ABallOfOnePieceChangesAsSmoothlyAsItsSkinDoes) {
  FeImpactOptions options;
  options.resolve(Accuracy::look);
  options.ball = range_ball();
  const ChangeableFe base(options, {}, {}, false);
  Blow blow;
  blow.club.head = {
      .mass = 0.27, .cg = Vec3(-1e-3, 0, 0), .inertia = Vec3(2.8e-4, 1e-4, 2.9e-4).asDiagonal(), .face = {}};
  blow.delivery = {.club_speed = 36, .dynamic_loft = radians(24)};
  const double declared = base.launch(blow, {}).backspin(),
               hardly = base.launch(blow, {.cover_stiffness = 1e-6}).backspin(),
               stiffer = base.launch(blow, {.cover_stiffness = 0.1}).backspin();
  ASSERT_GT(rpm(declared - stiffer), 50);
  EXPECT_LT(std::abs(hardly - declared), 1e-3 * (declared - stiffer));  // no change comes with a mesh of its own
}

/// Storage and loss modulus of small shear at an angular frequency.
std::pair<double, double> dynamic(const fem::Solid& m, double frequency) {
  double storage = m.shear(), loss = 0;
  for (const auto& b : m.branches) {
    const double x = frequency * b.time;
    storage += b.modulus * x * x / (1 + x * x);
    loss += b.modulus * x / (1 + x * x);
  }
  return {storage, loss};
}

TEST(ChangeableFe, SlowerBranchesKeepTheModuliAtTheContactsFrequencyAndTheBounce) {
  const FeBall ball = range_ball(), slower = changed(ball, {.relaxation = 1.5}, kRadius, kContact);
  const auto [storage, loss] = dynamic(ball.layers[0].material, kPi / kContact);
  const auto [storage_after, loss_after] = dynamic(slower.layers[0].material, kPi / kContact);
  EXPECT_NEAR(storage_after / storage, 1, 1e-12);
  EXPECT_NEAR(loss_after / loss, 1, 1e-12);
  EXPECT_LT(dynamic(slower.layers[0].material, 4 * kPi / kContact).second,
            0.95 * dynamic(ball.layers[0].material, 4 * kPi / kContact).second);  // quicker shear loses less

  FeImpactOptions options;
  options.harmonics = 0;
  options.resolve(Accuracy::look);
  options.harmonics = 0;
  const auto bounce = [&](const FeChange& change) {
    FeImpactOptions o = options;
    o.ball = changed(o.ball, change, kRadius);
    return normal_impact(o, {}, 40).restitution;
  };
  const double declared = bounce({}), more_loss = bounce({.losses = 0.3});
  ASSERT_GT(declared - more_loss, 0.03);
  // The contact is no sine of one frequency: a quarter of what the same change of the loss alone would do is allowed.
  EXPECT_NEAR(bounce({.relaxation = 1.5}), declared, 0.25 * 4 * (declared - more_loss));
}

TEST(ChangeableFe, FacesInSeriesAddTheirComplianceAndAStiffOneIsRigid) {
  const Head iron{
      .mass = 0.26, .cg = Vec3(-0.001, 0, 0), .inertia = Vec3(2.8e-4, 0.6e-4, 2.9e-4).asDiagonal(), .face = {}};
  const auto from_rigid = changed(std::optional<FaceCompliance>{}, 50e-9, iron);
  ASSERT_TRUE(from_rigid);
  EXPECT_NEAR(1 / changed(from_rigid, 30e-9, iron)->stiffness, 80e-9, 1e-18);
  EXPECT_FALSE(changed(std::optional<FaceCompliance>{}, 0, iron));
  EXPECT_THROW(changed(from_rigid, -50e-9, iron), std::invalid_argument);

  FeImpactOptions options;
  options.resolve(Accuracy::look);
  const ChangeableFe base(options, {}, {}, false);
  Blow blow;
  blow.club.head = iron;
  blow.delivery = {.club_speed = 36, .dynamic_loft = radians(24)};
  const double rigid = base.launch(blow, {}).ball_speed(),
               yielding = base.launch(blow, {.face_compliance = 80e-9}).ball_speed(),
               stiff = base.launch(blow, {.face_compliance = 1e-13}).ball_speed();
  ASSERT_GT(yielding - rigid, 0.3);  // a yielding face is felt
  EXPECT_LT(std::abs(stiff - rigid), 1e-3 * (yielding - rigid));
}

/// Lowest frequencies of a clamped shaft with nothing at its tip [rad/s].
std::vector<double> clamped(const Shaft& shaft) {
  fem::System system;
  const auto line =
      mesh::straight(mesh::graded(shaft.length(), 10), Vec3::Zero(), mesh::frame_along(-Vec3::UnitZ(), Vec3::UnitX()));
  auto owned = std::make_unique<fem::Beam>(system.dof_map, line, fem::shaft_sections(shaft), fem::BeamOptions{});
  const fem::Beam& beam = *owned;
  system.terms.push_back(std::move(owned));
  system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(beam.nodes().front(), fem::at_rest(Vec3::Zero())));
  fem::State rest = system.dof_map.rest();
  beam.place(rest);
  return solvers::modes(system, rest, 4).omega;
}

/// Bending and mass by one factor: a bare shaft's frequencies stay; bending alone by exp(s): they rise by exp(s / 2).
TEST(ChangeableFe, AShareOfTheShaftKeepsItsFrequenciesAndStiffnessRaisesThem) {
  const Shaft shaft = shaft_library().front().make();
  const auto whole = clamped(shaft), third = clamped(changed(shaft, 1.0 / 3, 0)),
             stiff = clamped(changed(shaft, 1, 0.4));
  ASSERT_GT(whole[0], 5);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_NEAR(third[k] / whole[k], 1, 1e-8) << k;
    EXPECT_NEAR(stiff[k] / whole[k], std::exp(0.2), 1e-8) << k;
  }
}

TEST(ChangeableFe, ASmallShareOfTheShaftIsNearTheFreeHead) {
  FeImpactOptions options;
  options.resolve(Accuracy::look);
  Blow blow;
  blow.club.head = {.mass = 0.2, .cg = Vec3(-0.03, 0, 0), .inertia = Vec3(3e-4, 3e-4, 4e-4).asDiagonal(), .face = {}};
  blow.delivery = {.club_speed = 40, .dynamic_loft = radians(15), .impact_toe = 0.01};
  const ChangeableFe base(options, {}, shaft_library().front().make(), false);
  const double free = base.launch(blow, {}).ball_speed(), tenth = base.launch(blow, {.shaft = 0.1}).ball_speed(),
               whole = base.launch(blow, {.shaft = 1}).ball_speed();
  ASSERT_GT(std::abs(whole - free), 0.02);  // a shaft is felt
  EXPECT_LT(std::abs(tenth - free), 0.3 * std::abs(whole - free));
  blow.contact.friction = 0.05;
  EXPECT_LT(
      base.launch(blow, {}).backspin(),
      0.7 *
          Impact(options).launch({.delivery = blow.delivery, .club = blow.club, .ball = {}, .contact = {}}).backspin());
}

/// What holds a point at rest goes with what holds one that slides: a fit may pass where the case's own was.
TEST(ChangeableFe, StaticFrictionKeepsItsRatioToSliding) {
  Options options;
  Blow blow;
  blow.contact.patch = {.coefficient = 0.30, .at_rest = StaticFriction{0.33, 1e-4}};
  find_parameter("common_friction")->set(options, blow, 0.40);
  EXPECT_EQ(blow.contact.patch.coefficient, 0.40);
  EXPECT_NEAR(blow.contact.patch.at_rest->coefficient, 0.44, 1e-15);
  EXPECT_TRUE(blow.contact.patch.faults().empty());
  FeImpactOptions coarse;
  coarse.resolve(Accuracy::look);
  const ChangeableFe base(coarse, {}, {}, false);
  blow.club.head = {.mass = 0.27, .cg = Vec3(-1e-3, 0, 0), .inertia = Vec3(2.8e-4, 1e-4, 2.9e-4).asDiagonal()};
  blow.delivery = {.club_speed = 36, .dynamic_loft = radians(40)};
  const double stated = base.launch(blow, {}).backspin();
  blow.contact.patch = {.coefficient = 0.30, .at_rest = StaticFriction{0.33, 1e-4}};
  blow.contact.friction = 0.40;
  EXPECT_NEAR(base.launch(blow, {}).backspin(), stated, 1e-9 * stated);
}

}  // namespace
}  // namespace hosel::models
