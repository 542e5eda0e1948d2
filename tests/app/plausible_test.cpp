// No nonsense with status 0: what no club, ball or blow can be is refused where it stands, with the reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <random>

#include "app/output.hpp"
#include "command.hpp"
#include "models/checked_launch.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/rigid_planar.hpp"
#include "models/rigid/stick_slip.hpp"
#include "solvers/errors.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel::test;
using namespace hosel;

struct Nonsense {
  const char* name;
  const char* set;   ///< overrides, each in quotes
  const char* says;  ///< part of the one line of the error
  int status = 2;
};
void PrintTo(const Nonsense& n, std::ostream* out) { *out << n.name; }

class Implausible : public testing::TestWithParam<Nonsense> {};

TEST_P(Implausible, IsRefusedInOneLine) {
  const Nonsense& n = GetParam();
  const fs::path dir = fresh_directory(std::string("implausible_") + n.name);
  write(dir / "case.toml", kEccentricBlow);
  const Outcome o = command("run " + dir.string() + " " + n.set + " --quiet --out " + (dir / "out").string());
  EXPECT_EQ(o.status, n.status) << o.text;
  EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << o.text;
  EXPECT_NE(o.text.find(n.says), std::string::npos) << o.text;
  EXPECT_FALSE(fs::exists(dir / "out" / "summary.json"));
}

INSTANTIATE_TEST_SUITE_P(
    Blow, Implausible,
    testing::Values(
        Nonsense{"heavy_head", "--set head.mass_kg=200", "a clubhead weighs"},
        Nonsense{"cg_before_face", "--set 'head.cg_mm=[35,0,0]'", "35 mm in front of the face"},
        Nonsense{"cg_far_off", "--set 'head.cg_mm=[-3500,0,0]'", "a clubhead is no larger"},
        Nonsense{"huge_inertia", "--set 'head.inertia_kg_m2=[[2,0,0],[0,2,0],[0,0,2]]'", "radius of gyration"},
        Nonsense{"no_inertia", "--set 'head.inertia_kg_m2=[[1e-9,0,0],[0,1e-9,0],[0,0,1e-9]]'", "radius of gyration"},
        Nonsense{"restitution_creates", "--set contact.restitution=1.2", "creates energy"},
        Nonsense{"restitution_negative",
                 "--set contact.restitution_slope_s_per_m=-0.1 --set delivery.club_speed_mps=50",
                 "coefficient of restitution comes to -"},
        Nonsense{"restitution_above_one", "--set contact.restitution_slope_s_per_m=0.05",
                 "coefficient of restitution comes to"},
        Nonsense{"set_is_named", "--set delivery.club_speed_mps=450", "--set delivery.club_speed_mps=450: "},
        Nonsense{"unknown_unit", "--set delivery.impact_toe_furlongs=1",
                 "no unit 'furlongs' is known, expected a length (impact_toe_m, "},
        Nonsense{"article", "--set delivery.dynamic_loft_mps=1", "is a speed, expected an angle"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Plausible, PoundsAndInchesAreUnits) {
  const fs::path dir = fresh_directory("pounds");
  write(dir / "case.toml", kEccentricBlow);
  const auto ball_speed = [&](const std::string& sets) {
    const Outcome o = command("run " + dir.string() + " --quiet --force --out " + (dir / "out").string() + sets);
    EXPECT_EQ(o.status, 0) << o.text;
    return nlohmann::json::parse(content(dir / "out/summary.json"))["models"]["rigid-eccentric"]["ball_speed_mps"]
        .get<double>();
  };
  EXPECT_NEAR(ball_speed(" --set delivery.impact_toe_in=0.5 --set head.mass_oz=7"),
              ball_speed(" --set delivery.impact_toe_mm=12.7 --set head.mass_g=198.446662"), 1e-6);
  expect_refused(command("check " + dir.string() + " --set delivery.impact_toe_lb=1"), "is a mass, expected a length");
}

TEST(Plausible, MissingTableIsNamedWithoutColons) {
  const fs::path dir = fresh_directory("grammar");
  write(dir / "case.toml", "kind = \"impact\"\nmodels = [\"rigid-planar\"]\n");
  const Outcome o = command("check " + dir.string());
  expect_refused(o, "case.toml:1: table '[head]' is missing");
}

/// What can be meant and is likely a slip of a unit: a warning of the run, and a failure where it is to be strict.
TEST(Plausible, ASlipOfAUnitIsInDoubt) {
  const fs::path dir = fresh_directory("slips");
  const auto shaft = [&](const std::string& tip, const std::string& mass) {
    write(dir / "profile.csv", "arc_length_mm,bending_stiffness_N_m2,torsional_stiffness_N_m2," + mass +
                                   ",mean_radius_mm\n0,60,30,70,7\n" + tip + ",25,12,50,4.5\n");
    write(dir / "case.toml",
          "kind = \"modes\"\nsupport = \"clamped\"\ncount = 2\n[shaft]\ntable = {file = \"profile.csv\"}\n");
    return command("check " + dir.string()).text;
  };
  EXPECT_EQ(shaft("1100", "mass_per_length_g_per_m").find("in doubt"), std::string::npos);
  const std::string metres = shaft("1.1", "mass_per_length_g_per_m"),
                    kilograms = shaft("1100", "mass_per_length_kg_per_m");
  EXPECT_NE(metres.find("# in doubt: [shaft] the length is 0.0011 m"), std::string::npos) << metres;
  EXPECT_NE(kilograms.find("# in doubt: [shaft] the mass is 6.6e+04 g"), std::string::npos) << kilograms;
  const std::string run = "run " + dir.string() + " --out " + (dir / "out").string();
  const Outcome o = command(run);
  ASSERT_EQ(o.status, 0) << o.text;
  const auto doubts = nlohmann::json::parse(content(dir / "out" / "summary.json"))["doubts"];
  ASSERT_FALSE(doubts.empty()) << o.text;
  EXPECT_NE(doubts[0].get<std::string>().find("is a unit wrong?"), std::string::npos);
  EXPECT_EQ(command(run + " --force --strict").status, 3);

  // The mesh has the ball's mass, whatever the densities of its layers.
  const auto layers = [](const std::string& density) {
    return command(
        "check iron7-trackman --set compare=[] --set contact.face_friction=0.3 --set "
        "'ball={layers=[{law=\"neo-hooke\", young_MPa=60, "
        "poisson=0.45, "
        "density_kg_per_m3=" +
        density + "}]}'");
  };
  EXPECT_EQ(layers("1130").text.find("in doubt"), std::string::npos) << layers("1130").text;
  EXPECT_NE(layers("1.13").text.find("every density is multiplied by"), std::string::npos) << layers("1.13").text;
}

/// No model has constants by default: which ball's they are is said in the case.
TEST(Plausible, NobodysConstantsAreADefault) {
  const fs::path dir = fresh_directory("default_table");
  write(dir / "case.toml", kEccentricBlow);
  const std::string check = "check " + dir.string() + " --set 'models=[\"volumetric\"]'";
  const Outcome none = command(check);
  expect_refused(none, "volumetric: whose constants?");
  const Outcome iron = command(check + " --set volumetric.published=iron7");
  EXPECT_EQ(iron.status, 0) << iron.text;
  EXPECT_NE(iron.text.find("friction = 0.489"), std::string::npos) << iron.text;
}

TEST(Plausible, ABlowWithoutAClubHasNoLaunch) {
  Blow blow;
  blow.delivery.club_speed = 45;
  EXPECT_THROW(models::RigidEccentric().launch(blow), std::invalid_argument);
  EXPECT_THROW(models::RigidPlanar().launch(blow), std::invalid_argument);
  EXPECT_THROW(models::HertzMaw({}, {}).launch(blow), std::invalid_argument);
  EXPECT_THROW(models::RigidEccentric().launch(Blow{}), std::invalid_argument);
}

TEST(Plausible, TheGateKeepsOutWhatCreatesEnergy) {
  Blow blow;
  blow.delivery = {.club_speed = 45, .dynamic_loft = 0.2};
  blow.club.head = {.mass = 0.2, .cg = Vec3(-0.035, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal()};
  Launch launch = models::checked_launch(models::RigidEccentric(), blow);
  ASSERT_GT(launch.ball_speed(), 50);
  Launch faster = launch;
  faster.velocity *= 1.5;  // 2.25 times the ball's energy: more than the blow lost
  EXPECT_THROW(models::check_launch(models::RigidEccentric(), blow, faster), solvers::NonConvergence);
  Launch broken = launch;
  broken.spin.x() = NAN;
  EXPECT_THROW(models::check_launch(models::RigidEccentric(), blow, broken), solvers::NonConvergence);
  broken = launch;
  broken.peak_force = INFINITY;
  EXPECT_THROW(models::check_launch(models::RigidEccentric(), blow, broken), solvers::NonConvergence);
  // A wall: the ball leaves it no faster than it came.
  blow.club.head.mass = INFINITY;
  launch = models::checked_launch(models::RigidEccentric(), blow);
  launch.velocity *= 1.3;
  EXPECT_THROW(models::check_launch(models::RigidEccentric(), blow, launch), solvers::NonConvergence);
}

/// What a blow may not gain is judged by what the ball brings, not by what the head has.
TEST(Plausible, TheGateIsAsNarrowForEveryModelThatHasNoShaft) {
  Blow blow;
  blow.delivery = {.club_speed = 45, .dynamic_loft = 0.2};
  blow.club.head = {.mass = 0.2, .cg = Vec3(-0.035, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal()};
  blow.contact.restitution = blow.contact.tangential_restitution = 1;  // nothing is lost
  blow.contact.restitution_slope = blow.contact.restitution_falloff = 0;
  const models::RigidEccentric model;
  Launch launch = models::checked_launch(model, blow);
  // One per cent of the ball's energy too much, which the head pays with its momentum: 0.5 % of all that flies.
  const double gain = 1.01;
  const Vec3 impulse = (std::sqrt(gain) - 1) * blow.ball.mass * launch.velocity;
  launch.velocity *= std::sqrt(gain);
  launch.head_velocity -= impulse / blow.club.head.mass;
  EXPECT_THROW(models::check_launch(model, blow, launch), solvers::NonConvergence);
  // A shaft in the case that the model does not ask opens nothing.
  blow.club.shaft = Shaft{};
  EXPECT_THROW(models::check_launch(model, blow, launch), solvers::NonConvergence);
  // A head that turns turns on after a blow in the plane: what it has is no energy to spend.
  blow.delivery.head_angular_velocity = Vec3(0, 0, 300);
  const models::RigidPlanar planar;
  Launch flat = models::checked_launch(planar, blow);
  EXPECT_EQ(flat.head_spin, blow.delivery.head_angular_velocity);
  flat.velocity *= std::sqrt(1.1);
  EXPECT_THROW(models::check_launch(planar, blow, flat), solvers::NonConvergence);
}

/// Three hundred blows with wide contact laws: a launch that the gate lets through has no energy that was not there.
TEST(Plausible, WideContactLawsCreateNoEnergyOrAreRefused) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto between = [&](double low, double high) { return low + (high - low) * unit(random); };
  const models::RigidPlanar planar;
  const models::RigidEccentric eccentric;
  const models::StickSlip stick_slip;
  int passed = 0, refused = 0;
  for (int k = 0; k < 300; ++k) {
    Blow blow;
    blow.delivery = {.club_speed = between(5, 70), .dynamic_loft = between(0, 1)};
    blow.delivery.impact_toe = between(-0.03, 0.03);
    blow.club.head = {
        .mass = between(0.1, 0.4), .cg = Vec3(-0.03, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal()};
    blow.contact.restitution = between(0.7, 1);
    blow.contact.tangential_restitution = between(0, 1);
    blow.contact.normal_force_offset = between(-0.5, 0.5);
    blow.contact.friction = between(0, 2);
    for (const models::ImpactModel* model :
         std::initializer_list<const models::ImpactModel*>{&planar, &eccentric, &stick_slip}) {
      Launch l;
      try {
        l = models::checked_launch(*model, blow);
      } catch (const std::exception&) {
        ++refused;
        continue;
      }
      ++passed;
      // In the frame of the head before the blow, counted here by itself.
      const Vec3 frame = blow.delivery.velocity();
      const Mat3 axes = blow.delivery.face_to_global();
      const Vec3 turn = axes.transpose() * l.head_spin;
      const double before = 0.5 * blow.ball.mass * frame.squaredNorm(),
                   after = 0.5 * blow.ball.mass * (l.velocity - frame).squaredNorm() +
                           0.5 * blow.ball.inertia() * l.spin.squaredNorm() +
                           0.5 * blow.club.head.mass * (l.head_velocity - frame).squaredNorm() +
                           0.5 * turn.dot(blow.club.head.inertia * turn);
      EXPECT_LT(after, before * 1.0051) << "blow " << k;  // the gate's 0.5 %, and round-off
    }
  }
  EXPECT_GT(passed, 500);
  EXPECT_GT(refused, 10) << "laws that create energy are among them";
}

TEST(Plausible, NoReducedModelTakesARestitutionThatNoContactHas) {
  Blow blow;
  blow.delivery = {.club_speed = 50, .dynamic_loft = 0.2};
  blow.club.head = {.mass = 0.2, .cg = Vec3(-0.035, 0, 0), .inertia = Vec3(3.7e-4, 2.9e-4, 4.8e-4).asDiagonal()};
  const models::RigidPlanar planar;
  const models::RigidEccentric eccentric;
  const models::StickSlip stick_slip;
  for (const models::ImpactModel* model :
       std::initializer_list<const models::ImpactModel*>{&planar, &eccentric, &stick_slip}) {
    blow.contact = {};
    EXPECT_GT(model->launch(blow).ball_speed(), 50);
    for (const double slope : {-0.1, 0.05}) {  // below nought, where Coulomb's limits cross, and above one
      blow.contact.restitution_slope = slope;
      EXPECT_THROW(model->launch(blow), std::invalid_argument) << slope;
    }
  }
}

TEST(Plausible, ASummaryHoldsFiniteNumbersOrIsNotWritten) {
  const fs::path dir = fresh_directory("not_finite") / "out";
  app::Output out({.directory = dir, .quiet = true}, "");
  EXPECT_THROW(out.write_summary({{"launch", {{"speeds", {1.0, INFINITY}}}}}), solvers::NonConvergence);
  EXPECT_FALSE(fs::exists(dir / "summary.json"));
  out.write_summary({{"launch", {{"speeds", {1.0, 2.0}}}}});
  EXPECT_TRUE(fs::exists(dir / "summary.json"));
}

TEST(Plausible, ExtremeLawsEndInALaunchOrASentence) {
  const fs::path dir = fresh_directory("extreme");
  write(dir / "case.toml", kEccentricBlow);
  int refused = 0;
  for (const char* set : {"modulus_MPa=1e-320", "modulus_MPa=1e-300", "modulus_MPa=1e300", "damping_s_per_m=1e300",
                          "friction=1e300", "friction=1e-300", "poisson=0.5"}) {
    const Outcome o = command("run " + dir.string() +
                              " --set 'models=[\"hertz-maw\"]' --set hertz_maw.springs=64 --set " + "hertz_maw." + set +
                              " --quiet --force --out " + (dir / "out").string());
    EXPECT_TRUE(o.status == 0 || o.status == 2 || o.status == 3) << set << ": " << o.status << ' ' << o.text;
    EXPECT_LE(std::ranges::count(o.text, '\n'), 1) << o.text;
    refused += o.status != 0;
  }
  EXPECT_GE(refused, 1);
}

/// The rows of a study with one cell replaced.
class StudyRows : public testing::TestWithParam<const char*> {};

TEST_P(StudyRows, TakeNoCellThatIsNoNumber) {
  const fs::path source = fs::path(HOSEL_SOURCE_DIR) / "cases/rolling-irons";
  const fs::path dir = fresh_directory("clubs_cell");
  fs::copy(source, dir / "case", fs::copy_options::recursive);
  std::string table = content(dir / "case/clubs.csv");
  const auto from = table.find(',', table.find('\n')) + 1;  // the first club's mass
  table.replace(from, table.find(',', from) - from, GetParam());
  write(dir / "case/clubs.csv", table);
  const Outcome o = command("run " + (dir / "case").string() + " --quiet --out " + (dir / "out").string());
  expect_refused(o, "clubs.csv:2: ");
  EXPECT_NE(o.text.find("head.mass_kg"), std::string::npos) << o.text;
  EXPECT_FALSE(fs::exists(dir / "out/summary.json"));
}

INSTANTIATE_TEST_SUITE_P(Cell, StudyRows, testing::Values("", "nan", "-0.25", "0x1p-2", "0.25kg", "25"));

}  // namespace
