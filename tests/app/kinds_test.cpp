// Kinds of cases that no other test runs, against what is known without them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "golf/units.hpp"
#include "post/csv.hpp"

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
  const post::Sheet s = post::read_csv(dir / "out/points.csv");
  ASSERT_EQ(s.rows(), 3u);
  const auto at = [&](const char* column, std::size_t row) {
    return std::stod(s.columns[std::size_t(std::ranges::find(s.names, column) - s.names.begin())][row]);
  };
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
  fs::copy_file(dir / "swing/swing.csv", dir / "case/swing.csv");
  const Outcome o = command("run " + (dir / "case").string() + coarse + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto told = nlohmann::json::parse(content(dir / "out/summary.json"));
  const auto& found = told.at("identified");
  // The deflection is written with nine digits: 1e-7 mm.
  EXPECT_NEAR(found.at("bending_scale").get<double>(), 1.5, 1e-6);
  EXPECT_NEAR(found.at("damping_time_s").get<double>(), 2 * 0.01 / (2 * kPi * 4), 1e-9);  // a ratio of 1 % at 4 Hz
  const double before = found.at("train_rms_mm").at("before"), after = found.at("train_rms_mm").at("after");
  EXPECT_GT(before, 2);
  EXPECT_LT(after, 1e-5);
  EXPECT_GT(told.at("rigid_rms_mm").at("train").get<double>(), before);
}

}  // namespace
}  // namespace hosel::test
