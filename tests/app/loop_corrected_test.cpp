// The corrected finite-element model that a loop leaves behind is a case: it is read again with the effects in it.
#include "app/kinds/loop_corrected.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/job.hpp"
#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "build_info.hpp"
#include "command.hpp"

namespace hosel::app {
namespace {

TEST(LoopCorrected, IsACaseWithTheEffectsInIt) {
  const auto dir = test::fresh_directory("corrected");
  CaseFile own(std::filesystem::path(HOSEL_SOURCE_DIR) / "cases/loop-full-club");
  read_job(own);
  Blow own_blow;
  const models::ChangeableFe base(read_options(own.root(), {"fe-free-body"}, own_blow).fe, {}, {}, false);

  loop::LoopResult result;
  result.base = "fe-free-body";
  result.adopted = {"ball-cover-stiffness"};
  result.corrected.emplace();
  result.corrected->instrument = {"monitor-misalignment"};
  for (const double loft : {12.0, 15.0}) {
    loop::Corrected::Asked asked{fmt::format("{}", loft), {}, {}};
    asked.shot.blow.club.head = {
        .mass = 0.21, .cg = Vec3(-0.04, 0.002, 0.003), .inertia = Vec3(3e-4, 4e-4, 5e-4).asDiagonal(), .face = {}};
    asked.shot.blow.contact.friction = 0.27;
    asked.shot.blow.delivery = {.club_speed = 45, .dynamic_loft = radians(loft), .impact_toe = 0.004};
    asked.shot.blow.delivery.head_angular_velocity = Vec3(0, 0, 12);
    asked.shot.change = {.cover_stiffness = std::log(1.7), .cover_thickness = 0.2e-3, .face_compliance = 80e-9};
    asked.measured = {
        {hosel::Output::ball_speed, 66.0}, {hosel::Output::backspin, 300.0}, {hosel::Output::sidespin, 400.0}};
    result.corrected->shots.push_back(asked);
  }
  {
    Output out({.directory = dir / "out", .quiet = true}, own.resolved());
    write_corrected(out, result, base, false);
    out.write_summary({{"verdict", "explained"}});
  }
  EXPECT_NE(test::content(dir / "out/corrected/case.toml").find("monitor-misalignment"), std::string::npos);

  CaseFile corrected(dir / "out/corrected");
  read_job(corrected);  // every key is known, every value allowed
  Blow declared;
  const models::Options options = read_options(corrected.root(), {"fe-free-body"}, declared);
  ASSERT_EQ(options.fe.ball.layers.size(), 2U);
  const auto& layers = options.fe.ball.layers;
  EXPECT_NEAR(layers[1].material.instant_shear() / layers[0].material.instant_shear(), 1.7, 1e-8);
  EXPECT_NEAR((1 - layers[0].radius) * 0.0213, models::kSkin + 0.2e-3, 1e-9);
  EXPECT_DOUBLE_EQ(declared.contact.patch.coefficient, 0.27);
  ASSERT_TRUE(declared.club.head.compliance);
  EXPECT_NEAR(declared.club.head.compliance->stiffness, 12.5e6, 1e-2);
  CaseFile second(corrected, corrected.root().tables("variant")[1].texts("set"));
  const Blow blow = read_blow(second.root(), {"fe-free-body"});
  EXPECT_NEAR(blow.delivery.dynamic_loft, radians(15), 1e-9);
  EXPECT_DOUBLE_EQ(blow.club.head.mass, 0.21);
  EXPECT_TRUE(blow.club.head.inertia.isApprox(result.corrected->shots[1].shot.blow.club.head.inertia, 1e-8));
  EXPECT_DOUBLE_EQ(blow.delivery.head_angular_velocity.z(), 12);
}

}  // namespace
}  // namespace hosel::app
