// OUT/report.html: says what the summary says, in one file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "command.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool holds(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

/// Nothing that a browser would fetch. Its one script may name addresses: the page's policy lets nothing be fetched.
void expect_alone(std::string page) {
  EXPECT_TRUE(holds(page, "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none';img-src data:;"));
  for (std::size_t begin; (begin = page.find("<script>")) != std::string::npos;) {
    const std::size_t end = page.find("</script>", begin);
    const std::string script = page.substr(begin + 8, end - begin - 8);
    EXPECT_TRUE(script == content(HOSEL_SOURCE_DIR "/post/viewer/viewer.js") ||
                script == content(HOSEL_SOURCE_DIR "/post/viewer/sliders.js"));
    page.erase(begin, end - begin);
  }
  for (std::size_t begin; (begin = page.find("<script type='application/json'")) != std::string::npos;)
    page.erase(begin, page.find("</script>", begin) - begin);
  EXPECT_FALSE(std::regex_search(page, std::regex("<(script|link|iframe)|(src|href)=.?(https?:|//)|@import|url\\(")));
  // By its attributes: no style of a page may stretch it.
  EXPECT_FALSE(std::regex_search(page, std::regex("<svg[^>]*style=|[^>]svg,img\\{")));
  EXPECT_TRUE(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
}

TEST(RunPage, SaysWhatABlowAndItsFlightCameTo) {
  const fs::path dir = fresh_directory("page_blow");
  std::string text = kEccentricBlow;
  text.replace(text.find("club_speed_mps = 45.0"), 21, "club_speed_mph = 100.0");
  write(dir / "case.toml", "title = \"it's <b>mine</b>\"\n" + text + "[flight]\nlaw = \"ferguson-2022\"\n");
  const std::string typed = "run " + dir.string() + " --quiet --set ball.mass_g=45.9 --out " + (dir / "out").string();
  const Outcome o = command(typed);
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string page = content(dir / "out/report.html");
  const json summary = json::parse(content(dir / "out/summary.json"));
  const double speed = summary["models"]["rigid-eccentric"]["ball_speed_mps"];
  const double carry = summary["flights"]["rigid-eccentric"]["carry_yd"];
  ASSERT_GT(speed, 50) << "the ball was struck";
  expect_alone(page);
  EXPECT_TRUE(holds(page, "What does the ball do after this blow?"));
  EXPECT_TRUE(holds(page, fmt::format("<b>{:.1f} mph</b>", speed / 0.44704))) << "in the case's own unit";
  EXPECT_TRUE(holds(page, fmt::format("smash factor</span><b>{:.3f}</b>", speed / 44.704)));
  EXPECT_TRUE(holds(page, fmt::format("carry</span><b>{:.1f} yd</b>", carry)));
  EXPECT_TRUE(holds(page, "it&#39;s &lt;b&gt;mine")) << "a title is no markup";
  EXPECT_TRUE(holds(page, "<td>club speed<td>100 mph")) << "inputs with their units";
  EXPECT_TRUE(holds(page, "hosel " + typed)) << "the command as it was typed";
  EXPECT_TRUE(holds(page, "class='curves'")) << "side and top view of the flight";
}

/// Computed, measured and flown: the side is a word, and no number beside it has a sign.
TEST(RunPage, SaysTheSideInWords) {
  const fs::path dir = fresh_directory("page_side");
  write(dir / "case.toml", kEccentricBlow + "[flight]\nlaw = \"ferguson-2022\"\n[measured]\nazimuth_deg = -1.25\n");
  const Outcome o =
      command("run " + dir.string() + " --quiet --set delivery.face_angle_deg=3 --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const json summary = json::parse(content(dir / "out/summary.json"));
  const double azimuth = summary["models"]["rigid-eccentric"]["azimuth_deg"],
               side = summary["flights"]["rigid-eccentric"]["side_yd"];
  ASSERT_GT(std::abs(azimuth), 0.1);
  ASSERT_GT(std::abs(side), 1);
  const auto word = [](double x) { return x < 0 ? "left of the target" : "right of the target"; };
  const std::string page = content(dir / "out/report.html");
  EXPECT_TRUE(holds(
      page,
      fmt::format("direction</span><b>{:.2f}°</b><small style='display:block'>{}; measured 1.25° left of the target",
                  std::abs(azimuth), word(azimuth))));
  EXPECT_TRUE(holds(
      page, fmt::format("side</span><b>{:.1f} yd</b><small style='display:block'>{}", std::abs(side), word(side))));
}

/// A ball against a wall: what it is thrown for, in the frame in which the wall rests.
/// A face that yields is offered where the model that answers knows one.
TEST(RunPage, OffersNoFaceToAModelThatKnowsNone) {
  const fs::path dir = fresh_directory("page_face");
  write(dir / "case.toml", kEccentricBlow + "[volumetric]\npublished = \"driver\"\n");
  const auto page = [&](const std::string& models) {
    const Outcome o = command("run " + dir.string() + " --quiet --force --set 'models=" + models + "' --out " +
                              (dir / "out").string());
    EXPECT_EQ(o.status, 0) << o.text;
    return content(dir / "out/report.html");
  };
  EXPECT_TRUE(holds(page("[\"rigid-eccentric\",\"volumetric\"]"), "--set face.name=modern-driver"));
  for (const char* model : {"rigid-eccentric", "stick-slip"})
    EXPECT_FALSE(holds(page("[\"volumetric\",\"" + std::string(model) + "\"]"), "face.name=modern-driver")) << model;
}

TEST(RunPage, AnswersABounceInTheWallsFrame) {
  const fs::path dir = fresh_directory("page_wall");
  write(dir / "case.toml", R"(kind = "impact"
models = ["rigid-planar"]
[delivery]
club_speed_mps = 40.0
[head]
mass_kg = inf
[contact]
restitution = 0.8
restitution_slope_s_per_m = 0.0
)");
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string page = content(dir / "out/report.html");
  ASSERT_NEAR(json::parse(content(dir / "out/summary.json"))["models"]["rigid-planar"]["ball_speed_mps"].get<double>(),
              72, 1e-6);
  EXPECT_TRUE(holds(page, "restitution</span><b>0.8000</b>"));
  EXPECT_TRUE(holds(page, "rebound speed</span><b>32.00 m/s</b>"));
  EXPECT_FALSE(holds(page, "How far the ball goes")) << "of a ball that leaves a wall";
  EXPECT_FALSE(holds(page, "nearer the toe"));
  EXPECT_TRUE(holds(page, "the ball rests before the blow and the wall moves"));
  EXPECT_FALSE(holds(page, "direction</span>"));
}

TEST(RunPage, SpeaksTheUnitsThatWereAskedFor) {
  const fs::path dir = fresh_directory("page_units");
  write(dir / "case.toml", kEccentricBlow + "[flight]\nlaw = \"ferguson-2022\"\n");
  const auto asked = [&](const std::string& units) {
    const Outcome o = command("run " + dir.string() + " --force --units " + units + " --out " + (dir / "out").string());
    EXPECT_EQ(o.status, 0) << o.text;
    return o.text + content(dir / "out/report.html");
  };
  const std::string golf = asked("golf"), metric = asked("metric");
  const double speed =
      json::parse(content(dir / "out/summary.json"))["models"]["rigid-eccentric"]["ball_speed_mps"].get<double>();
  EXPECT_TRUE(std::regex_search(golf, std::regex(fmt::format("ball speed \\[mph\\] +{:.2f}", speed / 0.44704))));
  EXPECT_TRUE(std::regex_search(metric, std::regex(fmt::format("ball speed \\[m/s\\] +{:.2f}", speed))));
  EXPECT_TRUE(holds(golf, "carry [yd]") && !holds(golf, "carry [m]"));
  EXPECT_TRUE(holds(metric, "carry [m]") && !holds(metric, "carry [yd]"));
  EXPECT_TRUE(holds(golf, fmt::format("<b>{:.1f} mph</b>", speed / 0.44704)));
  EXPECT_TRUE(holds(metric, fmt::format("<b>{:.2f} m/s</b>", speed)));
  EXPECT_EQ(command("run " + dir.string() + " --units furlongs").status, 2);
  const Outcome modes = command("run shaft-modes --quiet --units golf --out " + (dir / "modes").string());
  EXPECT_EQ(modes.status, 0);
  EXPECT_TRUE(holds(modes.text, "--units changes nothing here")) << modes.text;
}

TEST(RunPage, ShowsTheLargestForceAndTheLedger) {
  const fs::path out = fresh_directory("page_fe") / "out";
  const Outcome o =
      command("run driver-toe --quiet --set 'models=[\"fe-free-body\"]' --set accuracy=look --out " + out.string());
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string page = content(out / "report.html");
  const json solution = json::parse(content(out / "summary.json"))["models"]["fe-free-body"]["solution"];
  const double force = solution["peak_force_N"], time = solution["peak_time_ms"];
  ASSERT_GT(force, 5000) << "ball and face met";
  expect_alone(page);
  EXPECT_TRUE(holds(page, fmt::format("{:.2f} kN at {:.3f} ms</text>", 1e-3 * force, time))) << "marked in the curve";
  EXPECT_TRUE(holds(page, fmt::format("at the largest force, {:.2f} kN after {:.3f} ms", 1e-3 * force, time)));
  EXPECT_TRUE(holds(page, fmt::format("unaccounted for<td>{:.4f}", solution["energy_J"]["closure"].get<double>())));
  EXPECT_TRUE(holds(page, "data:image/png;base64,")) << "the patch";

  // What moves: every body in every frame, 16 bits a number in base64.
  EXPECT_LT(page.size(), 6e6);
  const std::size_t begin = page.find('>', page.find("<script type='application/json'")) + 1;
  const json blow = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  const std::vector<double> times = blow["time_ms"], forces = blow["force_kN"];
  ASSERT_GE(times.size(), 24u);
  ASSERT_LE(times.size(), 48u);
  EXPECT_TRUE(std::ranges::is_sorted(times));
  EXPECT_EQ(std::ranges::max_element(forces) - forces.begin(), blow["start"].get<long>());
  EXPECT_NEAR(std::ranges::max(forces), 1e-3 * force, 0.02 * 1e-3 * force) << "a frame near the largest force";
  std::vector<std::string> bodies;
  for (const json& body : blow["bodies"]) {
    bodies.push_back(body["name"]);
    const std::size_t bytes = times.size() * body["points"].get<std::size_t>() * 3 * 2;
    EXPECT_EQ(body["place"].get<std::string>().size(), (bytes + 2) / 3 * 4) << bodies.back();
  }
  EXPECT_EQ(bodies, (std::vector<std::string>{"ball", "section", "face", "head"}));
  const double pressure = blow["bodies"][0]["fields"]["pressure"]["most"];
  EXPECT_GT(pressure, 10) << "MPa";
  EXPECT_LT(pressure, 100);
}

/// Of a club with its shaft: the energy that hands and gravity bring is a row, and the balance closes. The other runs
/// that the page proposes have names of their own.
TEST(RunPage, TellsTheShaftsEffectAndAClosedBalance) {
  const fs::path out = fresh_directory("page_shaft") / "toe";
  const Outcome o = command("run driver-toe --units golf --set 'models=[\"fe-free-body\",\"fe-full-club\"]' --set " +
                            ("accuracy=look --out " + out.string()) + "/");
  ASSERT_EQ(o.status, 0) << o.text;
  const std::string page = content(out / "report.html");
  const json models = json::parse(content(out / "summary.json"))["models"];
  const auto speed = [&](const char* model) { return models[model]["ball_speed_mps"].get<double>(); };
  const std::string effect = fmt::format("The shaft changes this blow by {:+.2f} mph of ball speed",
                                         (speed("fe-full-club") - speed("fe-free-body")) / 0.44704);
  EXPECT_TRUE(holds(page, effect) && holds(o.text, effect)) << effect << "\n" << o.text;

  std::vector<double> energy;
  const std::string table = page.substr(page.find("Where the energy went"));
  const std::regex row("<tr><td>[^<]+<td>[^<]+<td>(-?[0-9.]+)");
  for (std::sregex_iterator it(table.begin(), table.begin() + long(table.find("</table>")), row), end; it != end; ++it)
    energy.push_back(std::stod((*it)[1]));
  ASSERT_EQ(energy.size(), 9u);
  EXPECT_NEAR(energy[1], models["fe-full-club"]["solution"]["energy_J"]["external"].get<double>(), 1e-4);
  EXPECT_GT(std::abs(energy[1]), 0.01) << "gravity and hands do work";
  double after = 0;
  for (std::size_t r = 2; r < energy.size(); ++r) after += energy[r];
  EXPECT_NEAR(energy[0] + energy[1], after, 1e-3);

  for (const char* word : {"finer", "toe", "again"})
    EXPECT_TRUE(holds(page, fmt::format("--out {}-{}", out.string(), word))) << word;
  EXPECT_TRUE(holds(page, fmt::format("hosel diff {0}/ {0}-toe", out.string())) ||
              holds(page, fmt::format("hosel diff {0} {0}-toe", out.string())));
  EXPECT_TRUE(holds(page, "<code>look</code> has none"));
}

TEST(RunPage, AnswersBeforeItPrintsAndShowsAFigure) {
  for (const std::string run : {"ball-modes --set count=1", "calibrate-face", "characteristic-time", "material-point",
                                "restitution-face", "rollback", "shaft-modes --set count=2", "tangential-stiffness"}) {
    const fs::path out = fresh_directory("page_answers") / "out";
    const Outcome o = command("run " + run + " --quiet --out " + out.string());
    ASSERT_EQ(o.status, 0) << o.text;
    const std::string page = content(out / "report.html");
    expect_alone(page);
    const std::size_t answer = std::min(page.find("<div class='answers'>"), page.find("<table>"));
    const std::size_t question = page.find("<p class='lead'>"),
                      figure = std::min(page.find("data:image/svg"), page.find("class='curves'"));
    ASSERT_NE(question, std::string::npos) << run;
    EXPECT_TRUE(question < answer && answer < page.find("<pre")) << run;
    EXPECT_TRUE(answer < figure || run == "restitution-face") << run << ": its maps are points";
    EXPECT_LT(std::min(figure, page.find("data:image/png")), page.find("<h2>Inputs</h2>")) << run;
  }
}

}  // namespace
}  // namespace hosel::test
