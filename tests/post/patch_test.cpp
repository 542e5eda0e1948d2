// The patch series of an oblique blow, read back and compared with what the contact reported.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "fem/traction_field.hpp"
#include "golf/units.hpp"
#include "post/impact_recorder.hpp"
#include "post/patch_figure.hpp"
#include "tests/support/coarse_impact.hpp"
#include "tests/support/fresh_directory.hpp"

namespace hosel::post {
namespace {

namespace fs = std::filesystem;

TEST(PatchSeries, ReadsBackWhatTheContactDid) {
  Blow blow;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = 30;
  blow.delivery.club_path = radians(30);
  blow.contact.patch.coefficient = 0.3;
  const test::FreshDirectory home("patch");
  const fs::path& dir = home.path();
  ImpactRecorder recorder(dir, blow, {.steps_per_frame = 2, .angles = 8}, "patch");
  struct Seen {
    std::vector<fem::ContactPoint> points;
    fem::TractionField field;
  };
  std::map<double, Seen> seen;
  const models::FeOutcome outcome =
      models::Impact(test::coarse_impact(2)).run(blow, [&](const models::ImpactView& view) {
        recorder(view);
        const auto points = view.contact.points(view.state);
        seen.insert({view.state.time, Seen{points, {view.ball, points}}});
      });
  ASSERT_GT(outcome.result.peak_force, 1e3);
  const Mat3& axes = outcome.frame.ball_axes;
  const PatchHistory patch = read_patch(dir / "vtk", axes, outcome.mesh_axes);
  ASSERT_GT(patch.time.size(), 20u);
  ASSERT_GT(patch.position.size(), 6u);
  EXPECT_TRUE(std::ranges::is_sorted(patch.position));
  EXPECT_LT(patch.position.front(), -2e-3);  // the patch lies on both sides of the first point of contact
  EXPECT_GT(patch.position.back(), 2e-3);

  const std::size_t frames = patch.time.size();
  double pull = 0, push = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    ASSERT_TRUE(seen.contains(patch.time[i]));
    for (std::size_t j = 0; j < patch.position.size(); ++j) {
      const std::size_t k = j * frames + i;
      // The contact's own point at this place: in front or behind, nearest the plane of slip.
      const Vec3 there = blow.ball.radius * (std::cos(patch.position[j] / blow.ball.radius) * axes.col(0) +
                                             std::sin(patch.position[j] / blow.ball.radius) * axes.col(1));
      const auto& [points, field] = seen.at(patch.time[i]);
      const auto& nearest = *std::ranges::min_element(
          points, {}, [&](const fem::ContactPoint& p) { return (p.reference - there).norm(); });
      const fem::TractionField::Value there_acts = field.at(nearest.reference);
      EXPECT_EQ(patch.pressure[k], there_acts.pressure);
      EXPECT_NEAR(patch.traction[k], there_acts.traction.dot(axes.col(1)), 1e-9 * there_acts.pressure);
      EXPECT_EQ(patch.slip[k], nearest.slip);
      EXPECT_LE(std::abs(patch.traction[k]), blow.contact.patch.coefficient * patch.pressure[k] * (1 + 1e-9));
      EXPECT_GE(patch.slip[k], patch.slip[i > 0 ? k - 1 : k]);
      pull = std::max(pull, patch.traction[k]);
      push = std::min(push, patch.traction[k]);
    }
  }
  EXPECT_GT(pull, 1e6);
  EXPECT_LT(push, -1e6);  // the traction reverses somewhere: the grip
  // From its largest value the pressure falls to either side, in every frame: nothing alternates from edge to edge.
  for (std::size_t i = 0; i < frames; ++i) {
    int turns = 0;
    for (std::size_t j = 2; j < patch.position.size(); ++j) {
      const auto at = [&](std::size_t n) { return patch.pressure[n * frames + i]; };
      turns += (at(j) - at(j - 1)) * (at(j - 1) - at(j - 2)) < 0;
    }
    EXPECT_LE(turns, 1) << patch.time[i];
  }
}

TEST(PatchSeries, SaysWhereNothingTouched) { EXPECT_TRUE(patch_figure({}, "").panels.empty()); }

}  // namespace
}  // namespace hosel::post
