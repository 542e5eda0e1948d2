// From a finished run to an entry of the library, and on into a case of another kind.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "app/library.hpp"
#include "app/offer.hpp"
#include "app/parse_toml.hpp"
#include "command.hpp"
#include "golf/units.hpp"
#include "models/registry.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel;
using namespace hosel::app;
using hosel::test::command;
using hosel::test::content;
using hosel::test::expect_refused;
using hosel::test::fresh_directory;
using hosel::test::kEccentricBlow;
using hosel::test::Outcome;
using hosel::test::write;

struct Adopt : testing::Test {
  fs::path dir = fresh_directory(testing::UnitTest::GetInstance()->current_test_info()->name());
  void SetUp() override { setenv("HOSEL_LIBRARY", (dir / "library").c_str(), 1); }
  void TearDown() override { unsetenv("HOSEL_LIBRARY"); }
  fs::path finished(const std::string& shipped_case, const std::string& more = "") {
    const fs::path out = dir / shipped_case;
    const Outcome o = command("run " + shipped_case + " --quiet --out " + out.string() + more);
    EXPECT_EQ(o.status, 0) << o.text;
    return out;
  }
  Outcome adopt(const fs::path& out, const std::string& more) { return command("adopt " + out.string() + " " + more); }
};

/// A face that laboratory data calibrated yields in a blow of another kind as the calibration found it; its name is its
/// own.
TEST_F(Adopt, ACalibratedFaceIsStruckAndKeepsItsName) {
  const fs::path out = finished("calibrate-face");
  const Outcome made = adopt(out, "--as my-face");
  ASSERT_EQ(made.status, 0) << made.text;
  const fs::path file = dir / "library" / "faces" / "my-face.toml";
  EXPECT_NE(made.text.find("face 'my-face': " + file.string()), std::string::npos) << made.text;
  const std::string entry = content(file);
  for (const char* part :
       {"case = \"a driver's face at the rules' limit", "inputs = ", "build = ", "covariance = ", "not_for = "})
    EXPECT_NE(entry.find(part), std::string::npos) << part << entry;
  const auto summary = nlohmann::json::parse(content(out / "summary.json"));
  double stiffness = 0;
  for (const auto& p : summary.at("parameters"))
    if (p.at("name") == "stiffness_N_per_m") stiffness = p.at("value");
  ASSERT_GT(stiffness, 1e6);
  EXPECT_NEAR(library_face("my-face").face.stiffness, stiffness, 1e-9 * stiffness);
  // Another kind, and another model than the calibration's.
  write(dir / "blow" / "case.toml",
        kEccentricBlow + "[face]\nname = \"my-face\"\n[volumetric]\npublished = \"driver\"\n");
  const std::string blow = "run " + (dir / "blow").string() + " --set 'models=[\"volumetric\"]' --quiet --out ";
  const Outcome struck = command(blow + (dir / "a").string());
  EXPECT_EQ(struck.status, 0) << struck.text;
  const Outcome rigid = command(blow + (dir / "b").string() + " --set 'face={name=\"rigid\"}'");
  EXPECT_EQ(rigid.status, 0) << rigid.text;
  const auto speed = [&](const char* run) {
    return nlohmann::json::parse(content(dir / run / "summary.json"))
        .at("models")
        .at("volumetric")
        .at("ball_speed_mps")
        .get<double>();
  };
  EXPECT_GT(speed("a"), speed("b") + 0.2) << "the face gives something back";
  // Faster than the restitution was measured at.
  const Outcome fast = command(blow + (dir / "c").string() + " --set delivery.club_speed_mps=70");
  expect_refused(fast, "'my-face' saw impact speeds");
  EXPECT_NE(fast.text.find("`extrapolate = true`"), std::string::npos) << fast.text;
  const std::string listed = command("list").text;
  EXPECT_NE(listed.find(file.string()), std::string::npos) << listed;
  EXPECT_EQ(adopt(out, "--as 'My Face'").status, 2);
  EXPECT_NE(adopt(out, "--as modern-driver").text.find("shipped library has a face of this name"), std::string::npos);
  const Outcome again = adopt(out, "--as my-face");
  expect_refused(again, "--force replaces it");
  EXPECT_EQ(adopt(out, "--as my-face --force").status, 0);
}

TEST_F(Adopt, OnlyWhatAFinishedRunOffers) {
  write(dir / "blow" / "case.toml", kEccentricBlow);
  ASSERT_EQ(command("run " + (dir / "blow").string() + " --quiet --out " + (dir / "out").string()).status, 0);
  const Outcome none = adopt(dir / "out", "--as mine");
  expect_refused(none, "offers nothing to the library");
  EXPECT_NE(adopt(dir / "nowhere", "--as mine").text.find("no finished run"), std::string::npos);
}

/// A loop on rigid bodies finds that the ball gives tangential impulse back; the next case starts from it.
TEST_F(Adopt, ALoopsContactIsAnotherKindsModel) {
  const fs::path out = finished("loop-irons");
  const Outcome made = adopt(out, "--as irons");
  ASSERT_EQ(made.status, 0) << made.text;
  ASSERT_TRUE(fs::exists(dir / "library" / "contacts" / "irons.toml")) << made.text;
  const NamedContact contact = library_contact("irons");
  ASSERT_TRUE(contact.law);
  EXPECT_GT(contact.law->tangential_restitution, 0.2);
  // What is only tied is in the model behind the errors after, and in no entry.
  EXPECT_NE(content(out / "report.html").find("After: with what was adopted and"), std::string::npos);
  EXPECT_EQ(contact.law->restitution, ContactLaw{}.restitution);
  EXPECT_EQ(contact.law->restitution_slope, ContactLaw{}.restitution_slope);
  EXPECT_NE(content(dir / "library" / "contacts" / "irons.toml").find("a claim that needs "), std::string::npos);
  EXPECT_EQ(content(out / "log.txt").find("the head is not offered"), std::string::npos);
  ASSERT_TRUE(contact.seen.spin_loft);
  EXPECT_FALSE(contact.seen.clubs.empty());
  write(dir / "blow" / "case.toml",
        "kind = \"impact\"\nmodels = [\"rigid-eccentric\"]\n[delivery]\nclub_speed_mps = 37\ndynamic_loft_deg = 23\n"
        "[head]\nname = \"iron-7\"\n[contact]\nname = \"irons\"\n");
  const std::string blow = "run " + (dir / "blow").string() + " --quiet --out ";
  ASSERT_EQ(command(blow + (dir / "a").string()).status, 0);
  const Outcome driver =
      command(blow + (dir / "b").string() + " --set delivery.dynamic_loft_deg=3 --set delivery.club_speed_mps=34");
  expect_refused(driver, "contact.name: 'irons' saw spin lofts");
}

/// A law found on fast blows may extrapolate to a restitution above 1 at rest: the run goes on without an offer.
TEST(Offer, WhatTheLibraryRefusesIsNotOffered) {
  const fs::path dir = fresh_directory("offer_refused"), entry = dir / "out" / "entries" / "contact.toml";
  Output out({.directory = dir / "out", .quiet = true}, "title = \"a test\"\n");
  NamedContact contact;
  contact.law = ContactLaw{};
  offer(out, Shelf::contacts, {.what = "a law", .source = "a test"}, contact_tables(contact));
  ASSERT_TRUE(fs::exists(entry));
  contact.law->restitution = 1.2;
  offer(out, Shelf::contacts, {.what = "a law", .source = "a test"}, contact_tables(contact));
  EXPECT_FALSE(fs::exists(entry));
  EXPECT_NE(content(dir / "out" / "log.txt").find("not offered to the library"), std::string::npos);
  EXPECT_NO_THROW(out.write_summary({{"offers", 0}}));  // nobody took the file away
}

/// What no file of TOML holds as it is, is escaped in the entry.
TEST(Offer, AnyTitleIsThatOfAnEntry) {
  const fs::path dir = fresh_directory("offer_title");
  Output out({.directory = dir / "out", .quiet = true},
             "title = \"a\\u007f \\uFFFF \\u2028 \\U0001F3CC \\\" \\\\ ' \\u0000 \\u00e9\"\n");
  NamedContact contact;
  contact.law = ContactLaw{};
  offer(out, Shelf::contacts, {.what = "a law", .source = "a test"}, contact_tables(contact));
  const fs::path file = dir / "out" / "entries" / "contact.toml";
  ASSERT_TRUE(fs::exists(file)) << content(dir / "out" / "log.txt");
  const toml::table entry = parse_toml(content(file), file.string());
  const std::string title("a\x7F \xEF\xBF\xBF \xE2\x80\xA8 \xF0\x9F\x8F\x8C \" \\ ' \0 \xC3\xA9", 26);
  EXPECT_EQ(entry["provenance"]["case"].value_or(std::string()), title);
  EXPECT_EQ(entry["what"].value_or(std::string()), "a law");
}

/// Every digit of a ball goes through its file.
TEST(Offer, ABallGoesThroughItsFile) {
  const fs::path dir = fresh_directory("offer_ball");
  setenv("HOSEL_LIBRARY", dir.c_str(), 1);
  const BallEntry shipped = library_ball("three-piece");
  write(dir / "balls" / "copy.toml",
        "what = \"a copy\"\n[provenance]\nsource = \"a test\"\n" + ball_tables(shipped.body, shipped.layers));
  const BallEntry copy = library_ball("copy");
  unsetenv("HOSEL_LIBRARY");
  ASSERT_EQ(copy.layers.layers.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(copy.layers.layers[k].radius, shipped.layers.layers[k].radius);
    // Through megapascals and back: a digit of the last place may move.
    EXPECT_NEAR(copy.layers.layers[k].material.instant_shear(), shipped.layers.layers[k].material.instant_shear(),
                1e-15 * shipped.layers.layers[k].material.instant_shear() * 4);
  }
}

/// A head whose centre of gravity a loop corrects keeps its face and its loft; an entry names its face, so that one of
/// the case's own values is refused.
TEST_F(Adopt, AHeadKeepsFaceAndLoft) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double a, double b) { return a + (b - a) * double(random() >> 11) * 0x1.0p-53; };
  Blow blow;
  blow.club.head = library_head("driver-460").head;
  blow.club.head.cg.y() -= 0.006;  // towards the toe of where the case says
  std::string shots =
      "shot,club_speed_mps,attack_angle_deg,club_path_deg,face_angle_deg,dynamic_loft_deg,impact_toe_mm,impact_high_mm,"
      "ball_speed_mps,launch_angle_deg,azimuth_deg,backspin_rpm,sidespin_rpm\n";
  const auto model = models::find("rigid-eccentric")->make({});
  std::normal_distribution<double> normal;
  for (int i = 1; i <= 60; ++i) {
    blow.delivery = {.club_speed = uniform(42, 48),
                     .attack_angle = radians(uniform(-2, 4)),
                     .club_path = radians(uniform(-3, 3)),
                     .dynamic_loft = radians(uniform(9, 15)),
                     .face_angle = radians(uniform(-3, 3)),
                     .impact_toe = uniform(-0.015, 0.015),
                     .impact_high = uniform(-0.008, 0.008)};
    const Launch l = model->launch(blow);
    const Delivery& d = blow.delivery;
    shots += fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f},{:.0f},{:.0f}\n", i,
                         d.club_speed, degrees(d.attack_angle), degrees(d.club_path), degrees(d.face_angle),
                         degrees(d.dynamic_loft), 1e3 * d.impact_toe, 1e3 * d.impact_high,
                         l.ball_speed() + 0.1 * normal(random), degrees(l.launch_angle()) + 0.1 * normal(random),
                         degrees(l.azimuth()) + 0.1 * normal(random), rpm(l.backspin()) + 40 * normal(random),
                         rpm(l.sidespin()) + 40 * normal(random));
  }
  write(dir / "loop/shots.csv", shots);
  write(dir / "loop/case.toml",
        "kind = \"loop\"\n[model]\nbase = \"rigid-eccentric\"\n[head]\nname = \"driver-460\"\n[data]\nshots = "
        "\"shots.csv\"\n[data.noise]\nball_speed_mps = 0.1\nlaunch_angle_deg = 0.1\nazimuth_deg = 0.1\nbackspin_rpm = "
        "40\nsidespin_rpm = 40\n");
  const Outcome o = command("run " + (dir / "loop").string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string entry = content(dir / "out/entries/head.toml");
  EXPECT_NE(entry.find("face = \"modern-driver\""), std::string::npos) << entry << o.text;
  EXPECT_NE(entry.find("loft_deg = 10"), std::string::npos) << entry;
  const Outcome made = adopt(dir / "out", "--as corrected");
  ASSERT_EQ(made.status, 0) << made.text;
  const HeadEntry head = library_head("corrected");
  EXPECT_EQ(head.face, "modern-driver");
  EXPECT_NEAR(head.head.cg.y(), blow.club.head.cg.y(), 2e-3);
}

}  // namespace
