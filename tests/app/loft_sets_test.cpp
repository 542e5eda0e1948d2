// A ball of several sets of reduced parameters, of which the loft chooses one: where the loft itself is sought, and
// where a study moves it.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;

const std::string kTourBlow = R"([delivery]
club_speed_mps = 40.0
dynamic_loft_deg = 20.0
[head]
name = "iron-7"
[face]
name = "rigid"
[ball]
model = "tour"
)";

/// A face that nobody asks of is no key of the case.
std::string without_face(std::string blow) { return blow.erase(blow.find("[face]"), 22); }

Outcome matched(const fs::path& dir, double start, double launch, const std::string& more = "") {
  return command(
      fmt::format("run {} --force --out {} --set delivery.dynamic_loft_deg={} --set "
                  "measured.launch_angle_deg={} {}",
                  (dir / "case").string(), (dir / "out").string(), start, launch, more));
}

TEST(LoftSets, TheLoftThatIsFoundDoesNotDependOnItsStart) {
  const fs::path dir = fresh_directory("loft_sets_matched");
  write(
      dir / "case/case.toml",
      "kind = \"impact\"\nmodels = [\"rigid-eccentric\"]\nmatched_launch = true\n[measured]\nlaunch_angle_deg = 15\n" +
          kTourBlow);
  // `fairway` saw a spin loft of up to 22 deg, and is not asked above.
  const auto loft = [&](double start, double launch, const std::string& more = "") {
    const Outcome o = matched(dir, start, launch, more);
    EXPECT_EQ(o.status, 0) << o.text;
    return nlohmann::json::parse(content(dir / "out/summary.json"))["models"]["rigid-eccentric"]["dynamic_loft_deg"]
        .get<double>();
  };
  const double low = loft(12, 16), high = loft(33, 16);
  EXPECT_LT(low, 22);
  EXPECT_NEAR(low, high, 0.1);  // the launch angle is met within 0.03 deg, some 0.05 deg of loft
  EXPECT_NEAR(loft(12, 19), loft(33, 19), 0.1);
  // Where each of two sets leads to a loft of its own, the case has to say which is meant.
  for (const double start : {12.0, 33.0}) {
    const Outcome both = matched(dir, start, 18);
    EXPECT_EQ(both.status, 3) << both.text;
    EXPECT_NE(both.text.find("'fairway' 21.9"), std::string::npos) << both.text;
    EXPECT_NE(both.text.find("'irons' 24."), std::string::npos) << both.text;
    EXPECT_NE(both.text.find("say which by ball.reduced"), std::string::npos) << both.text;
  }
}

TEST(LoftSets, AMatchedLoftBeyondWhatWasSeenIsADoubt) {
  const fs::path dir = fresh_directory("loft_sets_beyond");
  write(
      dir / "case/case.toml",
      "kind = \"impact\"\nmodels = [\"rigid-eccentric\"]\nmatched_launch = true\n[measured]\nlaunch_angle_deg = 15\n" +
          without_face(kTourBlow) + "reduced = \"fairway\"\n");
  const Outcome inside = matched(dir, 20, 15), beyond = matched(dir, 20, 19);
  ASSERT_EQ(inside.status, 0) << inside.text;
  EXPECT_EQ(inside.text.find("warning"), std::string::npos) << inside.text;
  ASSERT_EQ(beyond.status, 0) << beyond.text;
  EXPECT_NE(beyond.text.find("saw spin lofts of 10 to 22 deg"), std::string::npos) << beyond.text;
  EXPECT_EQ(matched(dir, 20, 19, "--strict").status, 3);
  EXPECT_EQ(matched(dir, 20, 19, "--strict --set ball.extrapolate=true").status, 0);
}

TEST(LoftSets, AStudyMatchesAsABlowDoes) {
  const fs::path dir = fresh_directory("loft_sets_study");
  const auto study = [&](double start, double launch) {
    write(dir / "case/case.toml",
          fmt::format("kind = \"study\"\nmodels = [\"rigid-eccentric\"]\nmatched_launch = true\noutputs = "
                      "[\"spin_rate_rpm\"]\n[measured]\nlaunch_angle_deg = {}\n[[axis]]\nkey = "
                      "\"delivery.club_speed_mps\"\nvalues = [40.0]\n",
                      launch) +
              std::string(kTourBlow).replace(kTourBlow.find("club_speed_mps = 40.0\ndynamic_loft_deg = 20.0"), 45,
                                             fmt::format("club_speed_mps = 40.0\ndynamic_loft_deg = {:.1f}", start)));
    return command("run " + (dir / "case").string() + " --force --out " + (dir / "out").string());
  };
  const auto spin = [&](double start, double launch) {
    const Outcome o = study(start, launch);
    EXPECT_EQ(o.status, 0) << o.text;
    return nlohmann::json::parse(content(dir / "out/summary.json"))["range"]["spin_rate_rpm"][0].get<double>();
  };
  EXPECT_NEAR(spin(12, 16) / spin(33, 16), 1, 0.005);
  const Outcome both = study(20, 18);
  EXPECT_EQ(both.status, 3) << both.text;
  EXPECT_NE(both.text.find("say which by ball.reduced"), std::string::npos) << both.text;
}

TEST(LoftSets, AnAxisThatPassesFromOneSetToTheNextIsDoubted) {
  const fs::path dir = fresh_directory("loft_sets_axis");
  const auto study = [&](const std::string& values, const std::string& more = "") {
    const std::string blow = more.empty() ? kTourBlow : without_face(kTourBlow);
    write(dir / "case/case.toml",
          "kind = \"study\"\nmodels = [\"rigid-eccentric\"]\noutputs = [\"spin_rate_rpm\"]\n[[axis]]\nkey = "
          "\"delivery.dynamic_loft_deg\"\nvalues = " +
              values + "\n" + blow + more);
    return command("run " + (dir / "case").string() + " --strict --force --out " + (dir / "out").string());
  };
  const Outcome passes = study("[20.0, 22.0, 23.0]");
  EXPECT_EQ(passes.status, 3) << passes.text;
  EXPECT_NE(passes.text.find("'fairway' 20 to 22 deg, 'irons' 23 to 23 deg"), std::string::npos) << passes.text;
  EXPECT_NE(passes.text.find("ball.reduced names one"), std::string::npos) << passes.text;
  EXPECT_EQ(study("[19.0, 20.0, 22.0]").status, 0);
  EXPECT_EQ(study("[20.0, 22.0, 23.0]", "reduced = \"irons\"\n").status, 0);
}

/// Another ball, or another face, has other sets at the same loft.
TEST(LoftSets, BallsThatAreVariedAreNoDoubtOfTheLoft) {
  const fs::path dir = fresh_directory("loft_sets_balls");
  const auto study = [&](const std::string& more = "") {
    write(dir / "case/case.toml", "kind = \"study\"\nmodels = [\"rigid-eccentric\"]\noutputs = [\"spin_rate_rpm\"]\n" +
                                      std::string("[[variant]]\nname = \"tour\"\nset = [\"ball.model='tour'\"]\n"
                                                  "[[variant]]\nname = \"range\"\nset = [\"ball.model='range'\"]\n") +
                                      more + std::string(kTourBlow).replace(kTourBlow.find("20.0"), 4, "22.0"));
    return command("run " + (dir / "case").string() + " --force --out " + (dir / "out").string());
  };
  const Outcome balls = study();
  ASSERT_EQ(balls.status, 0) << balls.text;
  EXPECT_EQ(balls.text.find("the loft chooses between"), std::string::npos) << balls.text;
  const Outcome lofts = study("[[axis]]\nkey = \"delivery.dynamic_loft_deg\"\nvalues = [20.0, 22.0, 23.0]\n");
  EXPECT_NE(lofts.text.find("the loft chooses between 2 sets of the parameters of the ball 'tour'"), std::string::npos)
      << lofts.text;
}

/// A ball chooses its parameters by the loft of [delivery] before a study varies it.
TEST(LoftSets, AStudyOverLoftSaysThatTheDeliveryHasNone) {
  const fs::path dir = fresh_directory("loft_sets_none");
  const auto study = [&](const std::string& loft) {
    write(dir / "case/case.toml",
          "kind = \"study\"\nmodels = [\"rigid-planar\"]\noutputs = [\"spin_rate_rpm\"]\n[[axis]]\nkey = "
          "\"delivery.dynamic_loft_deg\"\nvalues = [11.0, 13.0]\n[delivery]\nclub_speed_mps = 40.0\n" +
              loft + "[head]\nmass_kg = 0.2\n[ball]\nmodel = \"tour\"\n");
    return command("run " + (dir / "case").string() + " --force --out " + (dir / "out").string());
  };
  expect_refused(study(""), "[delivery] has no dynamic_loft_deg to choose one by; a study that varies the loft");
  const Outcome o = study("dynamic_loft_deg = 12\n");
  EXPECT_EQ(o.status, 0) << o.text;
}

}  // namespace
