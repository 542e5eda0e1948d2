// What a run doubts of its own numbers, by whichever kind of case they come.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/study/solve.hpp"
#include "command.hpp"
#include "solvers/errors.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;
using hosel::app::StudySolve;

std::size_t doubts_in(const std::string& text) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find("warning: ", at)) != text.npos; at += 9) ++n;
  return n;
}

TEST(Doubts, AJumpOverTheWantedValueIsNoSolution) {
  StudySolve s{.name = "loft",
               .key = "delivery.dynamic_loft_deg",
               .low = 10,
               .high = 30,
               .output = {},
               .value = 5000,
               .set = {},
               .variants = {}};
  s.output.name = "spin_rate_rpm";
  const auto with_jump = [](double jump) {
    return [jump](double x) { return std::optional(200 * x + (x > 22.5 ? jump : 0.0)); };
  };
  EXPECT_NEAR(hosel::app::solve(s, with_jump(0)), 25, 1e-6);
  s.value = 4501;  // a bounce more or less
  EXPECT_NEAR(hosel::app::solve(s, with_jump(2)), 22.5, 1e-6);
  s.value = 5000;
  try {
    hosel::app::solve(s, with_jump(1530));
    FAIL() << "there is no such spin";
  } catch (const hosel::solvers::NonConvergence& e) {
    EXPECT_NE(std::string(e.what()).find("it jumps from 4500 to 6030"), std::string::npos) << e.what();
  }
}

/// Between two ends on one side of the wanted value there may be one on the other: nothing is said of what lies
/// between.
TEST(Doubts, EndsThatDoNotEncloseAValueAreSaidToBeEnds) {
  StudySolve s{.name = "loft",
               .key = "delivery.dynamic_loft_deg",
               .low = 5,
               .high = 50,
               .output = {},
               .value = 180,
               .set = {},
               .variants = {}};
  s.output.name = "carry_yd";
  try {
    hosel::app::solve(s, [](double x) { return std::optional(200 - (x - 20) * (x - 20) / 5); });
    FAIL() << "the ends do not enclose it";
  } catch (const hosel::solvers::NonConvergence& e) {
    EXPECT_EQ(std::string(e.what()),
              "loft: carry_yd is 155 and 20 at the ends of the range of delivery.dynamic_loft_deg: they do not enclose "
              "180; a narrower range may");
  }
}

/// One branch a layer knows its losses at one frequency: far from the measured temperature it predicts no speed.
TEST(Doubts, AColdBallOfOneBranchIsNoPrediction) {
  const std::string check = "check driver-toe --set ball.temperature.now_C=";
  EXPECT_NE(command(check + "3").text.find("# in doubt: [ball.temperature] a layer with one Maxwell branch"),
            std::string::npos)
      << command(check + "3").text;
  EXPECT_EQ(command(check + "24").text.find("Maxwell branch"), std::string::npos);
}

/// A sphere on an elastic plate is solved as any other blow: its penetration is doubted.
TEST(Doubts, AStudyOfAPlateTellsThePenetration) {
  const fs::path dir = fresh_directory("doubts_plate");
  const std::string text = R"(kind = "study"
models = ["fe-free-body"]
outputs = ["normal_restitution"]
figures = false
accuracy = "look"
[[axis]]
key = "contact.penalty"
values = [5, 2000]
[delivery]
club_speed_mps = 3.9
[head]
mass_kg = inf
[ball]
mass_kg = 0.2618e-3
radius_mm = 2.5
[[ball.layers]]
law = "linear"
young_GPa = 380
poisson = 0.23
[plate]
young_GPa = 70
poisson = 0.25
[contact]
face_friction = 0.09
)";
  write(dir / "case.toml", text);
  expect_refused(command("check " + dir.string() +
                         " --set head.mass_kg=0.2 --set 'head.cg_mm=[-35,0,0]' --set "
                         "'head.inertia_kg_m2=[[3.7e-4,0,0],[0,2.9e-4,0],[0,0,4.8e-4]]'"),
                 "head.mass_kg: 0.2 kg beside [plate], which is a wall");
  expect_refused(command("check " + dir.string() + " --set plate.young_GPa=380 --set plate.poisson=0.23"),
                 "plate.young_GPa: elastic plate: like bodies");
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("1 of 2 points: fe-free-body: the penetration, of the compression, is above 0.02"),
            std::string::npos)
      << o.text;
}

/// Finite elements take the friction of a set alone: where the case states it no set is asked for.
TEST(Doubts, NoSetIsAskedForThatNobodyReads) {
  const std::string check =
      "check driver-toe --set 'models=[\"fe-free-body\"]' --set delivery.dynamic_loft_deg=70 --set "
      "delivery.attack_angle_deg=0 --set ball.extrapolate=true";
  expect_refused(command(check), "say which by `reduced`");
  const Outcome o = command(check + " --set contact.face_friction=0.3");
  EXPECT_EQ(o.status, 0) << o.text;
}

TEST(Doubts, AreSaidByAQuietRunToo) {
  const fs::path dir = fresh_directory("doubts_quiet");
  write(dir / "blow/case.toml", kEccentricBlow);
  const Outcome o = command("run " + (dir / "blow").string() + " --quiet --set delivery.impact_toe_mm=90 --out " +
                            (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("warning: the ball is struck off the face"), std::string::npos) << o.text;
  EXPECT_EQ(doubts_in(o.text), 1u) << o.text;
}

const std::string kOfTable = "[flight]\nlaw = \"table\"\nspin_decay_per_s = 0.04\ncoefficients = \"table.csv\"\n";
const std::string kTable =
    "reynolds,spin_ratio,drag,lift\n60000,0.02,0.25,0.1\n60000,0.1,0.26,0.15\n250000,0.02,0.25,0.1\n"
    "250000,0.1,0.26,0.15\n";

TEST(Doubts, AFlightOutsideAUsersTableNamesItsRange) {
  const fs::path dir = fresh_directory("doubts_table");
  write(dir / "case/case.toml", kEccentricBlow + kOfTable);
  write(dir / "case/table.csv", kTable);
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("outside the range of table (Re 60000 to 250000, spin ratio 0.020 to 0.100)"),
            std::string::npos)
      << o.text;
}

TEST(Doubts, EveryModelsFlightIsDoubted) {
  const fs::path dir = fresh_directory("doubts_models");
  write(dir / "case/case.toml", std::string(kEccentricBlow)
                                        .replace(kEccentricBlow.find("[\"rigid-eccentric\"]"), 19,
                                                 "[\"rigid-planar\", \"stick-slip\", \"rigid-eccentric\"]") +
                                    kOfTable);
  write(dir / "case/table.csv", kTable);
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  for (const char* model : {"rigid-planar: ", "stick-slip: ", "rigid-eccentric: "})
    EXPECT_NE(o.text.find(std::string("warning: ") + model), std::string::npos) << model << o.text;
  EXPECT_EQ(doubts_in(o.text), 3u) << o.text;
}

TEST(Doubts, AStudyTellsTheFlightsOfItsPointsOnce) {
  const fs::path dir = fresh_directory("doubts_flights");
  write(dir / "case/case.toml", study_of_blow("[\"carry_m\"]") + kOfTable +
                                    "[[axis]]\nkey = \"delivery.dynamic_loft_deg\"\nvalues = [10.0, 14.0, 18.0]\n");
  const fs::path file = dir / "case/case.toml";
  std::string text = content(file);
  write(file, text.erase(text.find("dynamic_loft_deg = 10.0\n"), 24));
  write(dir / "case/table.csv", kTable);
  const std::string run = "run " + (dir / "case").string() + " --force --out " + (dir / "out").string();
  const Outcome o = command(run);
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_EQ(doubts_in(o.text), 1u) << o.text;
  EXPECT_NE(o.text.find("3 of 3 points: a flight outside the range of table. The worst, dynamic loft 14 deg: "),
            std::string::npos)
      << o.text;
  EXPECT_EQ(command(run + " --strict").status, 3);
}

TEST(Doubts, AStudyTellsThePenetrationOfItsPoints) {
  const fs::path dir = fresh_directory("doubts_penetration");
  write(dir / "case/case.toml", R"(kind = "study"
models = ["fe-free-body"]
outputs = ["ball_speed_mps"]
[[axis]]
key = "delivery.club_speed_mps"
values = [20.0, 30.0]
[delivery]
club_speed_mps = 30.0
dynamic_loft_deg = 10.0
[head]
name = "driver-2024"
[face]
name = "rigid"
[ball]
model = "range"
extrapolate = true
[contact]
face_friction = 0.3
penalty = 5
[mesh]
harmonics = 1
sector = 1
rings = 1
[time]
steps_per_contact = 20
)");
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("2 of 2 points: fe-free-body: the penetration, of the compression, is above 0.02. The worst, "
                        "club speed 20 m/s: "),
            std::string::npos)
      << o.text;
}

TEST(Doubts, AStudyOfACaseTellsWhatTheCaseDoubts) {
  const fs::path dir = fresh_directory("doubts_case");
  write(dir / "blow/case.toml", kEccentricBlow);
  write(
      dir / "study/case.toml",
      "kind = \"study\"\ncase = \"../blow\"\n[[axis]]\nkey = \"delivery.impact_toe_mm\"\nvalues = [0.0, 80.0, 90.0]\n");
  const Outcome o = command("run " + (dir / "study").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_EQ(doubts_in(o.text), 1u) << o.text;
  EXPECT_NE(o.text.find("2 of 3 points: a doubt of the case's own. The worst, impact toe 80 mm: the ball is struck off "
                        "the face"),
            std::string::npos)
      << o.text;
  EXPECT_EQ(content(dir / "out/points.csv").find("doubts"), std::string::npos);
}

/// A ball of one layer and one branch to be calibrated, and what it should do.
const std::string kOneBranch = R"(kind = "calibrate-ball"
[[ball.layers]]
law = "neo-hooke"
c10_MPa = 12
bulk_MPa = 1000
branch_moduli_MPa = [50]
branch_times_ms = [0.01]
)";
const std::string kItsTarget = R"([[free]]
what = "branch-moduli"
[target]
speeds_mps = [30]
restitution = 0.75
restitution_slope_s_per_m = 0
restitution_sigma = 0.01
contact_speed_mps = 30
contact_time_ms = 0.5
contact_time_sigma_ms = 0.2
)";

TEST(Doubts, ABallThatMissesItsTargetIsNotOffered) {
  const fs::path dir = fresh_directory("doubts_ball");
  write(dir / "case/case.toml", kOneBranch + R"([mesh]
sector = 1
rings = 1
[time]
steps_per_contact = 60
)" + kItsTarget);
  const auto run = [&](const std::string& set) {
    return command("run " + (dir / "case").string() + " --force --out " + (dir / "out").string() + set);
  };
  const Outcome met = run(" --strict");
  ASSERT_EQ(met.status, 0) << met.text;
  EXPECT_NE(met.text.find("wanted 0.5 +- 0.2"), std::string::npos) << met.text;
  EXPECT_TRUE(fs::exists(dir / "out/entries/ball.toml"));
  const Outcome far = run(" --set target.contact_time_ms=450");
  ASSERT_EQ(far.status, 0) << far.text;
  EXPECT_NE(far.text.find("contact time at 30 m/s: wanted 450 ms, got 0."), std::string::npos) << far.text;
  EXPECT_NE(far.text.find("nothing is offered to the library"), std::string::npos) << far.text;
  EXPECT_FALSE(fs::exists(dir / "out/entries/ball.toml"));
  EXPECT_EQ(run(" --strict --set target.contact_time_ms=450").status, 3);
  const Outcome end = run(" --set target.restitution=1.0 --set target.restitution_sigma=1e-4");
  ASSERT_EQ(end.status, 0) << end.text;
  EXPECT_NE(end.text.find("is at its bound"), std::string::npos) << end.text;
  EXPECT_FALSE(fs::exists(dir / "out/entries/ball.toml"));
}

/// A shot was seen at the loft that meets its launch angle, not where the search for it began.
TEST(Doubts, AnOfferedBallSawTheLoftsThatWereFound) {
  const fs::path dir = fresh_directory("doubts_seen");
  write(dir / "case/case.toml", kOneBranch + R"([contact]
face_friction = 0.3
[mesh]
sector = 1
rings = 1
harmonics = 2
[time]
steps_per_contact = 40
)" + kItsTarget + R"([[shots]]
name = "iron"
launch_angle_deg = 20
spin_rate_rpm = 6000
spin_sigma = 1.0
[shots.delivery]
club_speed_mps = 35
dynamic_loft_deg = 16
[shots.head]
mass_kg = 0.27
cg_mm = [-10, 0, 0]
inertia_kg_m2 = [[3e-4, 0, 0], [0, 1e-4, 0], [0, 0, 3e-4]]
)");
  const Outcome o = command("run " + (dir / "case").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string entry = content(dir / "out/entries/ball.toml");
  const auto at = entry.find("spin_loft_deg = [0, ");
  ASSERT_NE(at, entry.npos) << o.text << entry;
  EXPECT_GT(std::stod(entry.substr(at + 20)), 20) << entry;
}

TEST(Doubts, ASpeedOfTheContactTimeThatIsNoneIsRefusedAtItsKey) {
  const fs::path dir = fresh_directory("doubts_speeds");
  const auto check = [&](const std::string& target) {
    write(dir / "case.toml",
          "kind = \"calibrate-ball\"\n[[ball.layers]]\nlaw = \"neo-hooke\"\nc10_MPa = 12\nbulk_MPa = 1000\n"
          "branch_moduli_MPa = [50]\nbranch_times_ms = [0.01]\n[[free]]\nwhat = \"branch-moduli\"\n[target]\n" +
              target);
    return command("check " + dir.string());
  };
  expect_refused(check("speeds_mps = []\n"), "case.toml:11: target.speeds_mps: name at least one speed");
  expect_refused(check("speeds_mps = [20, 30]\ncontact_speed_mps = 25\n"),
                 "case.toml:12: target.contact_speed_mps: the contact time is wanted at 25 m/s, which is none of the "
                 "speeds (20, 30 m/s)");
  expect_refused(check("speeds_mps = [20, 30]\n"), "case.toml:11: target.speeds_mps: the contact time is wanted at 40");
}

/// A plate ends at its outline, and an ellipse that lies turned on the face at its own.
TEST(Doubts, ABallBesideTheFacesOwnOutlineIsOffTheFace) {
  using namespace hosel;
  Blow blow;
  blow.delivery.impact_toe = 0.052;
  const mesh::PlateOutline plate;  // 45 mm to either side
  EXPECT_EQ(app::off_the_face(blow), "");
  EXPECT_NE(app::off_the_face(blow, &plate).find("52 mm towards the toe and 0 mm up, beside the outline"),
            std::string::npos);
  blow.delivery.impact_toe = 0.044;
  EXPECT_EQ(app::off_the_face(blow, &plate), "");
  FaceCompliance& face = blow.club.head.compliance.emplace();
  face.half_width = 0.045;
  face.half_height = 0.02;
  EXPECT_EQ(app::off_the_face(blow), "");
  face.turn = kPi / 2;
  EXPECT_NE(app::off_the_face(blow), "");
}

/// What a mesh cannot have is refused at its key, once.
TEST(Doubts, ASizeAtTheOtherPoleThatCancelsTheGradingIsRefusedAtItsKey) {
  const fs::path dir = fresh_directory("doubts_far");
  write(dir / "case.toml",
        "kind = \"impact\"\nmodels = [\"fe-free-body\"]\n[delivery]\nclub_speed_mps = 40\n[head]\n"
        "name = \"driver-460\"\n[ball]\nmodel = \"tour\"\n[mesh]\npole = 0.3\nfar = 1.1\n");
  expect_refused(command("check " + dir.string()), "case.toml:11: mesh.far: far must be at least 2 - pole");
}

/// A shaft that is condensed with its butt clamped knows no other hold.
TEST(Doubts, AHoldThatTheModelDoesNotKnowIsRefused) {
  const fs::path dir = fresh_directory("doubts_hold");
  const auto check = [&](const std::string& models, const std::string& hold) {
    write(dir / "case.toml",
          "kind = \"impact\"\nmodels = [" + models +
              "]\n[delivery]\nclub_speed_mps = 40\ndynamic_loft_deg = 12\n[head]\nname = "
              "\"driver-460\"\n[shaft]\nname = \"composite-driver\"\n[ball]\nmodel = \"tour\"\n[grip]\n"
              "hold = \"" +
              hold + "\"\n");
    return command("check " + dir.string());
  };
  EXPECT_EQ(check("\"shaft-coupled\"", "clamped").status, 0);
  expect_refused(check("\"shaft-coupled\"", "free"), "case.toml:13: grip.hold: shaft-coupled condenses a shaft");
  EXPECT_EQ(check("\"shaft-coupled\", \"fe-full-club\"", "free").status, 0);
}

}  // namespace
