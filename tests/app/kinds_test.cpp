// Kinds of cases that no other test runs, against what is known without them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "app/kinds/kinds.hpp"
#include "command.hpp"
#include "csv_file.hpp"
#include "golf/units.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;

/// An elastic sphere thrown so flat that it slides all the time: Coulomb's impulse, mu (1 + e) of the normal one with
/// e = 1, slows it and spins it (Maw, Barber and Fawcett 1976, Wear 38:101). Friction as small as here begins to stick
/// at tan(angle) = 7/2 mu (1 + e), 18 degrees.
TEST(Bounce, AThrowThatSlidesIsCoulombs) {
  const fs::path dir = fresh_directory("bounce");
  constexpr double mu = 0.092, speed = 3.9, radius = 2.5e-3;
  write(dir / "case.toml", R"(kind = "study"
models = ["hertz-maw"]
outputs = ["normal_restitution", "tangential_ratio", "spin_rate_rad_per_s", "rebound_angle_deg"]
[[axis]]
key = "delivery.club_path_deg"
values = [30.0, 45.0, 60.0]
[delivery]
club_speed_mps = 3.9
[head]
mass_kg = inf
[ball]
mass_kg   = 0.2618e-3
radius_mm = 2.5
[hertz_maw]
modulus_GPa = 59.1
poisson  = 0.247
friction = 0.092
damping_s_per_m = 0.0
)");
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const CsvFile s(dir / "out/points.csv");
  ASSERT_EQ(s.rows(), 3u);
  const auto at = [&](const char* column, std::size_t row) { return s.number(column, row); };
  for (std::size_t i = 0; i < s.rows(); ++i) {
    const double angle = radians(at("delivery.club_path_deg", i)), normal = speed * std::cos(angle),
                 along = speed * std::sin(angle);
    // Six digits are written; the steps of the contact leave some 3e-4 of the impulse.
    EXPECT_NEAR(at("normal_restitution", i), 1, 1e-5);
    EXPECT_NEAR(at("tangential_ratio", i), 1 - 2 * mu * normal / along, 3e-4);
    EXPECT_NEAR(at("spin_rate_rad_per_s", i), 2.5 * 2 * mu * normal / radius, 5e-4 * 2.5 * 2 * mu * normal / radius);
    EXPECT_NEAR(at("rebound_angle_deg", i), degrees(std::atan2(along - 2 * mu * normal, normal)), 0.02);
  }
}

/// What a swing of the project's own deflects, measured: the stiffness that made it is found, and the swing followed.
TEST(IdentifyShaft, TheShaftOfASwingIsFoundFromItsDeflection) {
  const fs::path dir = fresh_directory("identify"), shipped = fs::path(HOSEL_SOURCE_DIR) / "cases/swing-driver";
  const std::string coarse = " --set solution.elements=8 --set solution.step_ms=2.0 --quiet --out ";
  const Outcome swung =
      command("run " + shipped.string() + " --set output.vtk=false" + coarse + (dir / "swing").string());
  ASSERT_EQ(swung.status, 0) << swung.text;
  std::string text = content(shipped / "case.toml");
  text.replace(text.find("kind  = \"swing\""), 15, "kind  = \"identify-shaft\"");
  text.replace(text.find("bending_scale        = 1.5"), 26, "bending_scale        = 1.0");
  const auto from = text.find("[motion]"), to = text.find("[shaft]");
  text.erase(from, to - from);
  text += "\n[[swing]]\ndeflection = \"swing.csv\"\n[swing.motion]\nfile = \"grip.csv\"\nsmoothing_ms = 0.0\n";
  write(dir / "case/case.toml", text);
  fs::copy_file(shipped / "grip.csv", dir / "case/grip.csv");
  // A row without a reading is left out.
  std::string record = content(dir / "swing/swing.csv");
  std::size_t at = 0;
  for (int line = 0; line < 50; ++line) at = record.find('\n', at) + 1;
  const std::size_t lead = record.find(',', at) + 1;
  record.erase(lead, record.find(',', lead) - lead);
  write(dir / "case/swing.csv", record);
  const Outcome o = command("run " + (dir / "case").string() + coarse + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("swing.csv: 1 of "), std::string::npos) << o.text;
  const auto told = nlohmann::json::parse(content(dir / "out/summary.json"));
  const auto& found = told.at("identified");
  // The deflection is written with nine digits: 1e-7 mm.
  EXPECT_NEAR(found.at("bending_scale").get<double>(), 1.5, 1e-6);
  EXPECT_NEAR(found.at("damping_time_s").get<double>(), 2 * 0.01 / (2 * kPi * 4), 1e-9);  // a ratio of 1 % at 4 Hz
  const double before = found.at("train_rms_mm").at("before"), after = found.at("train_rms_mm").at("after");
  EXPECT_GT(before, 2);
  EXPECT_LT(after, 1e-5);
  EXPECT_GT(told.at("rigid_rms_mm").at("train").get<double>(), before);
  EXPECT_TRUE(found.at("holdout_rms_mm").is_null()) << "every swing was fitted";
}

TEST(IdentifyShaft, WhatIsPredictedComesAfterWhatIsFitted) {
  const fs::path dir = fresh_directory("identify_spans");
  const std::string text =
      "kind = \"identify-shaft\"\n[shaft]\nname = \"composite-driver\"\ndamping_ratio = 0.01\ndamping_frequency_Hz = "
      "4\n"
      "[head]\nmass_kg = 0.2\ncg_mm = [-40, 0, 0]\ninertia_kg_m2 = [[3e-4, 0, 0], [0, 4e-4, 0], [0, 0, "
      "5e-4]]\n[markers]\nfile = \"not/there.csv\"\nsmoothing_ms = 5\n";
  const auto check = [&](const std::string& train, const std::string& test) {
    write(dir / "case.toml", text + "train_s = " + train + "\ntest_s = " + test + "\n");
    return command("check " + dir.string());
  };
  const Outcome good = check("[0.9, 1.2]", "[1.2, 1.3]");
  EXPECT_EQ(good.status, 0) << good.text;
  for (const auto& [train, test, says] : {std::tuple{"[1.2, 0.9]", "[1.2, 1.3]", "the first instant comes before"},
                                          {"[0.9, 1.2]", "[1.3, 1.2]", "the first instant comes before"},
                                          {"[0.9, 1.25]", "[1.2, 1.3]", "comes after what is fitted"}}) {
    const Outcome o = check(train, test);
    EXPECT_EQ(o.status, 2) << train << test << o.text;
    EXPECT_NE(o.text.find(says), std::string::npos) << o.text;
  }
}

/// The summary of a case of this text, run.
nlohmann::json summary_of(const fs::path& dir, const std::string& text, const std::string& more = "") {
  write(dir / "case.toml", text);
  const Outcome o = command("run " + dir.string() + " --quiet --force --out " + (dir / "out").string() + more);
  EXPECT_EQ(o.status, 0) << o.text;
  return o.status ? nlohmann::json() : nlohmann::json::parse(content(dir / "out/summary.json"));
}

/// Numbers of a column of the points of that run.
std::vector<double> points_of(const fs::path& dir, const char* column) {
  return CsvFile(dir / "out/points.csv").numbers(column);
}

/// A number of a TOML file that stands behind its key.
double of_toml(const fs::path& file, const std::string& key) {
  const std::string text = "\n" + content(file);
  const auto at = text.find("\n" + key + " = ");
  EXPECT_NE(at, std::string::npos) << key;
  return at == std::string::npos ? NAN : std::strtod(text.c_str() + at + key.size() + 4, nullptr);
}

/// Shear of a neo-Hookean solid with two Maxwell branches, so small that they are linear: held, and at constant rate.
TEST(MaterialPoint, AShearRelaxesAndHeatsAsMaxwellsBranchesDo) {
  const fs::path dir = fresh_directory("material");
  constexpr double shear = 1e-3, time = 0.5e-3, rate = shear / time, mu = 20e6;
  constexpr std::array<std::pair<double, double>, 2> branches = {{{10e6, 0.1e-3}, {5e6, 1e-3}}};
  const std::string text =
      "kind = \"material-point\"\n[material]\nlaw = \"neo-hooke\"\nc10_MPa = 10\nbulk_MPa = 4000\n"
      "branch_moduli_MPa = [10, 5]\nbranch_times_ms = [0.1, 1.0]\n"
      "[path]\nshear = 1e-3\nduration_ms = 0.5\nsteps = 4000\nkind = ";
  double held = mu * shear, ramped = mu * shear, heat = 0;
  for (const auto& [G, tau] : branches) {
    const double left = std::exp(-time / tau), viscous = G * tau * rate;
    held += G * shear * left;
    ramped += viscous * (1 - left);
    heat += viscous * rate * (time - 2 * tau * (1 - left) + tau / 2 * (1 - left * left));
  }
  // Steps of 1/800 of the shorter time, at second order, and the square of the shear.
  EXPECT_NEAR(summary_of(dir, text + "\"relaxation\"\n").at("final_stress_Pa").get<double>(), held, 1e-5 * held);
  const auto ramp = summary_of(dir, text + "\"shear\"\n");
  EXPECT_NEAR(ramp.at("final_stress_Pa").get<double>(), ramped, 1e-5 * ramped);
  EXPECT_NEAR(ramp.at("dissipated_J_per_m3").get<double>(), heat, 1e-5 * heat);
  // What was put in is stored in springs or has become heat.
  double stored = 0.5 * mu * shear * shear;
  for (const auto& [G, tau] : branches) stored += 0.5 * G * std::pow(tau * rate * (1 - std::exp(-time / tau)), 2);
  EXPECT_NEAR(ramp.at("work_J_per_m3").get<double>(), stored + heat, 1e-5 * stored);
}

/// What a face of the library tells by the pendulum and by restitution leads back to it.
TEST(CalibrateFace, TheFaceOfItsOwnTimesIsFound) {
  const fs::path dir = fresh_directory("calibrate_face");
  const std::vector<std::pair<std::string, std::string>> places = {
      {"toe", "20.0"}, {"toe", "-20.0"}, {"high", "10.0"}, {"high", "-10.0"}, {"toe", "0.0"}};
  std::string told =
      "kind = \"study\"\nmodels = [\"volumetric\"]\noutputs = [\"characteristic_time_us\", \"face_restitution\"]\n"
      "[delivery]\nclub_speed_mps = 48.77\n[head]\nname = \"driver-200\"\n[face]\nname = \"modern-driver\"\n"
      "[volumetric]\npublished = \"driver\"\n";
  for (const auto& [way, mm] : places)
    told += "[[variant]]\nname = \"" + way + mm + "\"\nset = [\"delivery.impact_" + way + "_mm=" + mm + "\"]\n";
  summary_of(dir, told);
  const auto times = points_of(dir, "characteristic_time_us"), restitution = points_of(dir, "face_restitution");
  ASSERT_EQ(times.size(), places.size());
  EXPECT_LT(times[0], times[4] - 20) << "the face is stiffer towards its rim";
  const fs::path library = fs::path(HOSEL_SOURCE_DIR) / "library/faces/modern-driver.toml";
  std::string text =
      "kind = \"calibrate-face\"\n[ball]\nmass_kg = 0.04593\nradius_mm = 21.335\ninertia_factor = 0.4\n"
      "[head]\nname = \"driver-200\"\n[sphere]\nradius_mm = 11.0\n";
  for (std::size_t k = 0; k < places.size(); ++k)
    text += fmt::format("[[tap]]\n{}_mm = {}\ntime_us = {:.12g}\n", places[k].first, places[k].second, times[k]);
  text += fmt::format(
      "[target]\ntap_sigma_us = 0.3\nrestitution = {:.12g}\nrestitution_sigma = 2e-4\neffective_mass_g = 10.0\n"
      "effective_mass_sigma_g = 2.0\n",
      restitution[4]);
  const auto found = summary_of(dir, text);
  ASSERT_EQ(found.at("parameters").size(), 5u);
  EXPECT_LT(found.at("cost").get<double>(), 1e-9);
  for (const auto& p : found.at("parameters")) {
    std::string key = p.at("name");
    const std::string listed = content(library);
    const auto at = listed.find("\n" + key);
    ASSERT_NE(at, std::string::npos) << key;
    const double truth = std::strtod(listed.c_str() + listed.find('=', at) + 1, nullptr);
    EXPECT_NEAR(p.at("value").get<double>(), truth, 1e-4 * truth) << key;  // what the fit's tolerance leaves
  }
}

/// Five parameters: restitution and mass are two data, and each half width wants a tap off the centre its way.
TEST(CalibrateFace, TapsThatCannotTellItsParametersAreRefused) {
  const fs::path dir = fresh_directory("calibrate_face_taps");
  const std::string shipped = content(fs::path(HOSEL_SOURCE_DIR) / "cases/calibrate-face/case.toml");
  for (const char* way : {"high_mm", "toe_mm "}) {
    std::string text = shipped;
    for (std::size_t at; (at = text.find(way)) != std::string::npos;) text.erase(at, text.find('\n', at) - at);
    write(dir / "case.toml", text);
    const Outcome o = command("check " + dir.string());
    expect_refused(o, "at least three [[tap]]");
  }
}

std::string one_piece(double c10, double branch) {
  return fmt::format(
      "[ball]\nmass_kg = 0.04593\nradius_mm = 21.335\n[[ball.layers]]\nlaw = \"neo-hooke\"\nc10_MPa = {}\n"
      "bulk_MPa = 1000\nbranch_moduli_MPa = [{}]\nbranch_times_ms = [0.01]\n",
      c10, branch);
}

/// Restitution and contact time of blows on a wall.
std::string on_wall(const std::string& speeds) {
  return "kind = \"study\"\nmodels = [\"fe-free-body\"]\noutputs = [\"normal_restitution\", \"contact_time_ms\"]\n"
         "[[axis]]\nkey = \"delivery.club_speed_mps\"\nvalues = " +
         speeds + "\n[delivery]\nclub_speed_mps = 20\n[head]\nmass_kg = inf\n[contact]\nface_friction = 0.3\n";
}

/// The bounce of a ball, by blows on a wall, leads back to its moduli from others.
TEST(CalibrateBall, TheBallOfItsOwnBounceIsFound) {
  const fs::path dir = fresh_directory("calibrate_ball");
  const std::string numerics = "[mesh]\nsector = 1\nrings = 1\nharmonics = 0\n[time]\nsteps_per_contact = 200\n";
  summary_of(dir, on_wall("[20.0, 40.0]") + one_piece(14, 60) + numerics);
  const auto e = points_of(dir, "normal_restitution"), time = points_of(dir, "contact_time_ms");
  ASSERT_EQ(e.size(), 2u);
  EXPECT_LT(e[1], e[0] - 0.03) << "a faster blow returns less";
  const double slope = (e[1] - e[0]) / 20;
  const auto found = summary_of(
      dir,
      "kind = \"calibrate-ball\"\n" + one_piece(10, 50) +
          "[mesh]\nsector = 1\nrings = 1\n[time]\nsteps_per_contact = 200\n"
          "[[free]]\nwhat = \"long-term-moduli\"\n[[free]]\nwhat = \"branch-moduli\"\n" +
          fmt::format("[target]\nspeeds_mps = [20, 40]\nrestitution = {:.12g}\nrestitution_slope_s_per_m = {:.12g}\n"
                      "restitution_sigma = 1e-4\ncontact_speed_mps = 40\ncontact_time_ms = {:.12g}\n"
                      "contact_time_sigma_ms = 2e-4\n",
                      e[0] - 20 * slope, slope, time[1]));
  // A contact of 200 steps ends half a step sooner or later: 0.25 % of its time, 0.5 % of the stiffness.
  ASSERT_EQ(found.at("parameters").size(), 2u);
  EXPECT_NEAR(found["parameters"][0].at("value").get<double>(), 28e6, 0.005 * 28e6);
  EXPECT_NEAR(found["parameters"][1].at("value").get<double>(), 60e6, 0.005 * 60e6);
}

/// Oblique targets need a ball that can be thrown obliquely, whether or not a case has a [mesh].
TEST(CalibrateBall, ObliqueTargetsHaveHarmonicsWithoutAMesh) {
  const fs::path dir = fresh_directory("calibrate_ball_mesh");
  write(dir / "case.toml",
        "kind = \"calibrate-ball\"\n" + one_piece(10, 50) +
            "[[free]]\nwhat = \"long-term-moduli\"\n[contact]\nface_friction = 0.3\n"
            "[target]\nbounce = {speed_mps = 30, angle_deg = 30, tangential_restitution = 0.2, sigma = 0.05}\n");
  app::CaseFile file(dir);
  app::read_calibrate_ball(file);
  const std::string resolved = file.resolved();
  EXPECT_NE(resolved.find("harmonics = 3"), std::string::npos) << resolved;
}

/// A parameter that ends where the search does is told, and where it is expected beyond the search is refused.
TEST(CalibrateBall, AnEndOfTheSearchIsTold) {
  const fs::path dir = fresh_directory("calibrate_ball_end");
  const std::string text = "kind = \"calibrate-ball\"\n" + one_piece(10, 50) +
                           "[mesh]\nsector = 1\nrings = 1\n[time]\nsteps_per_contact = 60\n"
                           "[[free]]\nwhat = \"branch-moduli\"\n[target]\nspeeds_mps = [30]\n"
                           "contact_speed_mps = 30\nrestitution_slope_s_per_m = 0\ncontact_time_sigma_ms = 10\n";
  // No ball of these moduli loses nothing at all: the losses go to where the search ends.
  const auto far = summary_of(dir, text + "restitution = 1.0\nrestitution_sigma = 1e-4\n");
  ASSERT_EQ(far.at("parameters").size(), 1u);
  EXPECT_TRUE(far["parameters"][0].at("at_bound").get<bool>()) << far["parameters"][0];
  const auto near = summary_of(dir, text + "restitution = 0.75\nrestitution_sigma = 1e-2\n");
  EXPECT_FALSE(near["parameters"][0].at("at_bound").get<bool>()) << near["parameters"][0];
  write(dir / "case.toml",
        text +
            "restitution = 0.75\n[contact]\nface_friction = 0.3\n[[free]]\nwhat = \"head-mass\"\nshots = "
            "[\"s\"]\noffset_g = 40\n[[shots]]\nname = "
            "\"s\"\nlaunch_angle_deg = 10\nspin_rate_rpm = 3000\nspin_sigma = 0.03\n[shots.delivery]\n"
            "club_speed_mps = 40\ndynamic_loft_deg = 14\n[shots.head]\nmass_kg = 0.2\ncg_mm = [-40, 0, 0]\n"
            "inertia_kg_m2 = [[3e-4, 0, 0], [0, 4e-4, 0], [0, 0, 5e-4]]\n");
  const Outcome beyond = command("check " + dir.string());
  expect_refused(beyond, "the search goes no further");
}

/// The restitution of the reduced law of a ball that a wall of 1 and 2 degrees throws back is that of the wall at right
/// angles: with friction, and on a smooth wall, where there is no spin to go by.
TEST(CalibrateReduced, TheLawsRestitutionIsThatOfTheWall) {
  const fs::path dir = fresh_directory("calibrate_reduced");
  const std::string shared = one_piece(14, 60) +
                             "[mesh]\nsector = 1\nrings = 2\nharmonics = 1\n[time]\nsteps_per_contact = 40\n";
  for (const std::string friction : {"0.3", "0.0"}) {
    const std::string set = " --set contact.face_friction=" + friction;
    summary_of(dir, on_wall("[25.0, 40.0]") + shared, set);
    const auto e = points_of(dir, "normal_restitution");
    ASSERT_EQ(e.size(), 2u);
    EXPECT_LT(e[1], e[0] - 0.03);
    const auto found = summary_of(
        dir,
        "kind = \"calibrate-reduced\"\n[delivery]\nclub_speed_mps = 30\ndynamic_loft_deg = 1\n[head]\nmass_kg = inf\n"
        "[contact]\nface_friction = 0.3\n[[sets]]\nname = \"wall\"\nclub_speeds_mps = [25, 40]\nlofts_deg = [1, 2]\n" +
            shared,
        set);
    const double at_rest = of_toml(dir / "out/reduced.toml", "restitution"),
                 slope = of_toml(dir / "out/reduced.toml", "restitution_slope_s_per_m");
    // Two degrees take 0.06 % of the speed, and the slip of such a blow 1e-4 of its energy.
    EXPECT_NEAR(at_rest + 25 * slope, e[0], 1e-3) << friction;
    EXPECT_NEAR(at_rest + 40 * slope, e[1], 1e-3) << friction;
    EXPECT_TRUE(found.at("at_bound").at("wall").is_array());
    // A thousandth of the restitution is 0.04 m/s.
    EXPECT_LT(found["sets"]["wall"]["rigid-eccentric"]["ball_speed_rms_mps"].get<double>(), 0.04) << friction;
  }
}

/// A set names a face that is not the head's own, and not one that the resolved case writes for the head.
TEST(CalibrateReduced, ASetNamesAFaceThatIsNotTheHeads) {
  const fs::path dir = fresh_directory("calibrate_reduced_face");
  const auto set_of = [&](const std::string& face) {
    summary_of(dir,
               "kind = \"calibrate-reduced\"\naccuracy = \"look\"\n[delivery]\nclub_speed_mps = 30\n"
               "dynamic_loft_deg = 20\nattack_angle_deg = -2\n[head]\nname = \"iron-7\"\n" +
                   face +
                   "[ball]\nmodel = \"range\"\n[[sets]]\nname = \"irons\"\nclub_speeds_mps = [30, 34]\n"
                   "lofts_deg = [20, 24]\n");
    return content(dir / "out/reduced.toml");
  };
  const std::string unnamed = set_of(""), own = set_of("[face]\nname = \"hollow-iron\"\n"),
                    other = set_of("[face]\nname = \"forged-iron\"\n");
  EXPECT_EQ(unnamed, own);
  EXPECT_EQ(unnamed.find("faces"), std::string::npos) << unnamed;
  EXPECT_NE(unnamed.find("spin_loft_deg = [22, 26]"), std::string::npos) << unnamed;  // from the path, not from level
  EXPECT_NE(other.find("faces = [\"forged-iron\"]"), std::string::npos) << other;
}

/// Thrown without air, balls fly 2 v sin(angle) / g. What one site adds is found, and the air carries none of it.
TEST(LandingTimes, WhatASiteAddsToParabolasIsFound) {
  const fs::path dir = fresh_directory("landing_times");
  constexpr double added = 0.25;
  std::string shots = "event,speed_mps,launch_deg,azimuth_deg,landing_time_s,measured_time_s\n";
  for (const char* site : {"low", "high"})
    for (int k = 0; k < 40; ++k) {
      const double v = 60 + 0.5 * k, angle = 9 + 0.1 * (k % 20);
      const double time = 2 * v * std::sin(radians(angle)) / kGravity + (k % 2 ? 0.02 : -0.02) +
                          (*site == 'h' ? added : 0);
      shots += fmt::format("{},{},{},{},{:.9f},{:.9f}\n", site, v, angle, k % 3 - 1, time, time);
    }
  write(dir / "times.csv", shots);
  const auto s = summary_of(
      dir,
      "kind = \"landing-times\"\n[flight]\nlaw = \"ferguson-2022\"\ndrag_scale = 0\nlift_scale = 0\n"
      "[times]\nfile = \"times.csv\"\nspin_rate_rpm = 2600\nball_speed_mps = [50, 90]\nlaunch_angle_deg = [5, 15]\n"
      "time_s = [1, 6]\n[[times.site]]\nevent = \"low\"\nname = \"low\"\naltitude_m = 0\n"
      "[[times.site]]\nevent = \"high\"\nname = \"high\"\naltitude_m = 1600\n");
  // Half the shots are early and half late by 0.02 s: the mean is exact, and its error 0.02 s over the root of 40.
  ASSERT_EQ(s.at("sites").at("low").at("shots"), 40);
  EXPECT_NEAR(s["sites"]["low"]["measured_less_law_s"].get<double>(), 0, 1e-6);
  EXPECT_NEAR(s["sites"]["high"]["measured_less_law_s"].get<double>(), added, 1e-6);
  const auto& d = s.at("differences").at("high");
  EXPECT_NEAR(d.at("measured_s").get<double>(), added, 1e-6);
  EXPECT_NEAR(d.at("density_s").get<double>(), 0, 1e-9);
  EXPECT_NEAR(d.at("left_s").get<double>(), added, 1e-6);
  EXPECT_NEAR(d.at("error_s").get<double>(), std::sqrt(2.0) * 0.02 / std::sqrt(40), 1e-6);
  EXPECT_NE(content(dir / "out" / "report.html").find("the balls at high land 0.250 s later than at low"),
            std::string::npos);
  // Four shots of `high` are off by 1 s: each counts as the knee, and 36 tell the mean. They lie 0.02 s off the
  // median, which is the middle of the two groups.
  for (const char* off : {"1", "-1"}) {
    std::string all;
    int row = 0;
    for (std::size_t from = 0, to; from < shots.size(); from = to + 1) {
      to = shots.find('\n', from);
      std::string line = shots.substr(from, to - from);
      if (++row > 42 && row <= 46) {  // after the heads and the 40 of `low`
        const auto second = line.rfind(','), first = line.rfind(',', second - 1);
        const double time = std::stod(line.substr(second + 1)) + std::stod(off) * (row % 2 ? 1 : -1);
        line = line.substr(0, first) + fmt::format(",{:.9f},{:.9f}", time, time);
      }
      all += line + "\n";
    }
    write(dir / "times.csv", all);
    const Outcome o = command("run " + dir.string() + " --quiet --force --out " + (dir / "out").string());
    ASSERT_EQ(o.status, 0) << o.text;
    const auto strayed = nlohmann::json::parse(content(dir / "out/summary.json"))["sites"]["high"];
    ASSERT_EQ(strayed.at("shots"), 40);
    const double knee = 1.5 * 1.4826 * 0.02;
    EXPECT_NEAR(strayed.at("measured_less_law_s").get<double>(), added, 1e-6);
    EXPECT_NEAR(strayed.at("error_s").get<double>(), std::sqrt(36 * 0.02 * 0.02 + 4 * knee * knee) / 36, 1e-6);
  }
  const Outcome twice = command("check " + dir.string() + " --set times.site[2].name=low");
  expect_refused(twice, "'low' is there twice");
}

}  // namespace
}  // namespace hosel::test
