// Keys that stand beside each other in a table: each value arrives where its key says.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "app/read_plate.hpp"
#include "app/read_series.hpp"
#include "app/read_shaft.hpp"
#include "app/read_solid.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "tests/app/command.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

CaseFile written(const std::string& name, const std::string& text) {
  const fs::path dir = test::fresh_directory(name);
  test::write(dir / "case.toml", text);
  return CaseFile(dir);
}

/// Linear between the stations of the offsets, held beyond them.
TEST(ReadTables, EachOffsetOfAShaftIsItsOwnCentre) {
  CaseFile file = written("read_offsets", R"([shaft.table]
arc_length_mm = [0, 500, 1000]
bending_stiffness_N_m2 = [60, 40, 20]
torsional_stiffness_N_m2 = [40, 30, 20]
mass_per_length_g_per_m = [60, 55, 50]
mean_radius_mm = [7, 6, 4]
[shaft.offsets]
arc_length_mm = [200, 800]
elastic_centre_y_mm = [0.1, 0.3]
elastic_centre_z_mm = [0.2, 0.6]
shear_centre_y_mm = [0.3, 0.9]
shear_centre_z_mm = [0.4, 1.2]
mass_centre_y_mm = [0.5, 1.5]
mass_centre_z_mm = [0.6, 1.8]
)");
  const Shaft shaft = read_shaft(file.root().table("shaft"));
  int key = 0;
  for (const auto of : {&CentreOffsets::elastic, &CentreOffsets::shear, &CentreOffsets::mass})
    for (const std::size_t axis : {0u, 1u}) {
      const double first = 1e-4 * ++key;
      for (const auto& [s, times] : {std::pair{0.0, 1.0}, {0.5, 2.0}, {1.0, 3.0}})
        EXPECT_NEAR((shaft.at(s).centres.*of)[axis], times * first, 1e-15) << key << " at " << s;
    }
}

/// A shell leans as its own springs do; a spring that the case states stands by itself, unless it says how it leans.
TEST(ReadTables, AShellsRimLeansWhereItsSpringsAreItsOwn) {
  const auto rim = [](const std::string& keys) {
    CaseFile file =
        written("read_rim", "[face.plate.thickness]\nvalue_mm = 2.8\n[face.plate.rim]\nradius_mm = 40\n" + keys);
    return read_plate(file.root().table("face").table("plate")).rim;
  };
  const fem::RimSupport shell = rim("");
  EXPECT_NEAR(shell.lean, std::pow(3 * (1 - 0.34 * 0.34), 0.25) / std::sqrt(0.04 * 0.8e-3), 1e-9 * shell.lean);
  EXPECT_EQ(rim("deflection_GPa = 1").lean, shell.lean);
  EXPECT_EQ(rim("rotation_N = 3000").lean, 0);
  EXPECT_EQ(rim("stretch_GPa = 0.1").lean, 0);
  EXPECT_EQ(rim("rotation_N = 3000\nlean_per_m = 200").lean, 200);
  EXPECT_THROW(rim("rotation_N = inf\nlean_per_m = 200"), InputError);
}

TEST(ReadTables, AForcedGripHasAForce) {
  const fs::path dir = test::fresh_directory("read_forced");
  const auto checked = [&](const std::string& grip) {
    return test::command("check driver-toe --set 'grip=" + grip + "'");
  };
  const test::Outcome none = checked("{hold=\"forced\"}");
  test::expect_refused(none, "give its force and moment");
  const test::Outcome some = checked("{hold=\"forced\", force_N=[-55, 2, 332], moment_N_m=[-1, 40, -1]}");
  EXPECT_EQ(some.status, 0) << some.text;
}

/// Nothing says what a shaft is before its first station.
TEST(ReadTables, AShaftBeginsAtItsButt) {
  const auto refused = [](const std::string& text) -> std::string {
    CaseFile file = written("read_butt", text);
    try {
      read_shaft(file.root().table("shaft"));
    } catch (const InputError& e) { return e.what(); }
    return "";
  };
  const std::string
      table =
          "[shaft.table]\narc_length_mm = [FIRST, 1000]\nbending_stiffness_N_m2 = [60, 20]\n"
          "torsional_stiffness_N_m2 = [40, 20]\nmass_per_length_g_per_m = [60, 50]\nmean_radius_mm = [7, 4]\n",
      tube =
          "[shaft.tube]\narc_length_mm = [FIRST, 1000]\nouter_radius_mm = [7, 4]\nwall_mm = [1, 1]\nshear_factor = "
          "0.5\n"
          "[[shaft.tube.layer]]\nE_GPa = 190\nG_GPa = 73\ndensity_kg_per_m3 = 7850\n";
  for (const std::string& text : {table, tube}) {
    const auto from = [&](const char* first) { return std::regex_replace(text, std::regex("FIRST"), first); };
    EXPECT_EQ(refused(from("0")), "");
    EXPECT_NE(refused(from("200")).find("the first station is the butt"), std::string::npos) << refused(from("200"));
    EXPECT_NE(refused(from("-10")).find("the first station is the butt"), std::string::npos);
  }
}

/// log10 a = -c1 (T - 298) / (c2 + T - 298), less the same where the constants hold; moduli go with T.
TEST(ReadTables, ARubberIsAsWarmAsItsTableSays) {
  CaseFile file = written("read_temperature", R"([solid]
c10_MPa = 10
bulk_MPa = 1000
branch_moduli_MPa = [20, 30]
branch_times_ms = [0.1, 0.01]
[solid.temperature]
now_C = 5
measured_C = 30
wlf_c1 = 5
wlf_c2_K = 120
)");
  const fem::Solid solid = read_solid(file.root().table("solid"));
  const auto log_a = [](double T) { return -5 * (T - 298) / (120 + T - 298); };
  const double slower = std::pow(10, log_a(278.15) - log_a(303.15)), softer = 278.15 / 303.15;
  ASSERT_GT(slower, 3);
  EXPECT_NEAR(solid.elastic.as<fem::Hyperelastic>()->c10, softer * 10e6, 1);
  ASSERT_EQ(solid.branches.size(), 2u);
  EXPECT_NEAR(solid.branches[0].modulus, softer * 20e6, 1);
  EXPECT_NEAR(solid.branches[1].modulus, softer * 30e6, 1);
  EXPECT_NEAR(solid.branches[0].time, slower * 1e-4, 1e-9 * slower);
  EXPECT_NEAR(solid.branches[1].time, slower * 1e-5, 1e-10 * slower);
}

models::FeBall changed_by(const std::string& change) {
  CaseFile file = written("read_changes", R"([[ball.layers]]
radius_fraction = 0.8
c10_MPa = 10
bulk_MPa = 1000
branch_moduli_MPa = [20]
branch_times_ms = [0.1]
[[ball.layers]]
c10_MPa = 30
bulk_MPa = 2000
branch_moduli_MPa = [40]
branch_times_ms = [0.01]
)" + change);
  return read_fe_ball(file.root().table("ball"), {});
}

TEST(ReadTables, EachChangeOfABallIsItsOwn) {
  const models::FeBall plain = changed_by("");
  ASSERT_EQ(plain.layers.size(), 2u);
  const auto c10 = [](const models::BallLayer& l) { return l.material.elastic.as<fem::Hyperelastic>()->c10; };
  const models::BallLayer &core = plain.layers[0], &cover = plain.layers[1];

  const models::FeBall stiff = changed_by("[ball.changes]\ncover_moduli_factor = 1.3\n");
  EXPECT_NEAR(c10(stiff.layers[1]), 1.3 * c10(cover), 1e-9 * c10(cover));
  EXPECT_NEAR(stiff.layers[1].material.branches[0].modulus, 52e6, 1);
  EXPECT_EQ(c10(stiff.layers[0]), c10(core));

  const models::FeBall lossy = changed_by("[ball.changes]\nbranch_moduli_factor = 1.5\n");
  EXPECT_NEAR(lossy.layers[0].material.branches[0].modulus, 30e6, 1);
  EXPECT_NEAR(lossy.layers[1].material.branches[0].modulus, 60e6, 1);
  EXPECT_EQ(lossy.layers[1].material.branches[0].time, cover.material.branches[0].time);

  const models::FeBall slow = changed_by("[ball.changes]\nbranch_times_factor = 2\n");
  EXPECT_NEAR(slow.layers[0].material.branches[0].time, 2e-4, 1e-12);
  EXPECT_NEAR(slow.layers[1].material.branches[0].time, 2e-5, 1e-12);

  const models::FeBall thick = changed_by("[ball]\nradius_mm = 20\n[ball.changes]\nadded_cover_mm = 1\n");
  EXPECT_NEAR(thick.layers[0].radius, 0.75, 1e-12);
}

}  // namespace
/// A strain is in the unit that its column says; one that nobody knows is no m/m.
TEST(ReadSeries, AStrainHasAKnownUnit) {
  const auto dir = test::fresh_directory("series_strain");
  const auto si = [&](const std::string& column) {
    test::write(dir / "record.csv", "time_ms," + column + "\n0,1\n1,2\n");
    std::vector<std::string> notes;
    return read_series(dir / "record.csv", nullptr, 1.0, 0.0, 1000, notes).channels.front().si;
  };
  EXPECT_EQ(si("strain_lead"), 1);
  EXPECT_EQ(si("strain_droop_ustrain"), 1e-6);
  EXPECT_EQ(si("strain_gauge2_um_per_m"), 1e-6);
  EXPECT_EQ(si("strain_lead_pct"), 1e-2);
  EXPECT_THROW(si("strain_lead_mV"), InputError);
  EXPECT_THROW(si("strain_lead_microstrain"), InputError);
}

/// Only a strain gauge has a radius.
TEST(ReadSeries, AStrainGaugeHasARadius) {
  const auto dir = test::fresh_directory("series_radius");
  test::write(dir / "record.csv", "time_ms,lead_mm,strain_lead_pct\n0,1,1\n1,2,2\n");
  const auto radius = [&](const std::string& toml) {
    CaseFile file = written("series_radius_case", toml);
    std::optional<Table> sensors = file.root().optional_table("sensors");
    std::vector<std::string> notes;
    const Series s = read_series(dir / "record.csv", sensors ? &*sensors : nullptr, 1.0, 0.0, 1000, notes);
    file.finish();
    return s.channels.back().radius;
  };
  EXPECT_FALSE(radius("").has_value());
  EXPECT_FALSE(radius("[sensors.strain_lead_pct]\narc_length_mm = 100\n").has_value());
  EXPECT_NEAR(radius("[sensors.strain_lead_pct]\nradius_mm = 7.5\n").value(), 7.5e-3, 1e-15);
  EXPECT_THROW(radius("[sensors.strain_lead_pct]\nradius_mm = 0.5\n"), InputError);
  EXPECT_THROW(radius("[sensors.lead_mm]\nradius_mm = 7.5\n"), InputError);
}

}  // namespace hosel::app
