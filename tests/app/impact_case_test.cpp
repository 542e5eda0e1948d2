// What `hosel run` on an impact leaves on disk, opened as a person would.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <Eigen/Core>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "build_info.hpp"
#include "child.hpp"
#include "command.hpp"
#include "csv_file.hpp"
#include "results.hpp"
#include "tests/support/one_core.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;

/// driver-toe with the full club alone on a coarse mesh: all four bodies in a few seconds.
std::string coarse_full_club() {
  return "run " HOSEL_SOURCE_DIR
         "/cases/driver-toe --quiet --set 'models=[\"fe-full-club\"]' --set mesh.sector=2 "
         "--set mesh.rings=2 --set mesh.harmonics=2 --set mesh.antisymmetric=2 --set time.steps_per_contact=40 --set "
         "output.steps_per_frame=2 --out ";
}

struct Frame {
  double time;
  fs::path file;
};

/// Entries of a .pvd in their order; empty where it is no well-formed collection.
std::vector<Frame> frames(const fs::path& pvd) {
  std::vector<Frame> out;
  auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(pvd.c_str()));
  vtkXMLDataElement* collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
  for (int i = 0; collection && i < collection->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* e = collection->GetNestedElement(i);
    double time = -1;
    EXPECT_TRUE(e->GetScalarAttribute("timestep", time));
    out.push_back({time, pvd.parent_path() / e->GetAttribute("file")});
  }
  return out;
}

vtkSmartPointer<vtkDataSet> read(const fs::path& file) {
  if (file.extension() == ".vtu") {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    EXPECT_EQ(reader->GetErrorCode(), 0u) << file;
    return reader->GetOutput();
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << file;
  return reader->GetOutput();
}

/// Names that docs/outputs.md does not have.
std::set<std::string> not_in_manual(const std::vector<std::string>& names) {
  const std::string page = content(fs::path(HOSEL_SOURCE_DIR) / "docs" / "outputs.md");
  std::set<std::string> out;
  for (const std::string& name : names)
    if (page.find("`" + name + "`") == std::string::npos) out.insert(name);
  return out;
}

/// Of the point, cell and field arrays of the first frame of every series.
std::vector<std::string> array_names(const fs::path& vtk) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(vtk)) {
    if (entry.path().extension() != ".pvd") continue;
    const auto data = read(frames(entry.path()).at(0).file);
    for (vtkFieldData* arrays : {static_cast<vtkFieldData*>(data->GetPointData()),
                                 static_cast<vtkFieldData*>(data->GetCellData()), data->GetFieldData()})
      for (int i = 0; i < arrays->GetNumberOfArrays(); ++i) out.emplace_back(arrays->GetArrayName(i));
  }
  return out;
}

struct Array {
  const char* name;
  int components;
  const char* unit;
};

TEST(ImpactCase, ADriversRigidFaceIsSaidInOneLine) {
  const std::string warning = "the face of this driver-like head is rigid";
  const auto said = [&](const std::string& name, const std::string& set) {
    const Outcome run = command("run " HOSEL_SOURCE_DIR "/cases/" + name +
                                " --set 'models=[\"fe-free-body\"]' --set accuracy=look --set output.vtk=false " + set +
                                " --out " + (fresh_directory("rigid_face_" + name) / "out").string());
    EXPECT_EQ(run.status, 0) << run.text;
    const auto at = run.text.find(warning);
    return at != std::string::npos && run.text.find(warning, at + 1) == std::string::npos;
  };
  EXPECT_TRUE(said("driver-toe", "--set 'face.name=\"rigid\"'"));
  EXPECT_FALSE(said("driver-toe", ""));
  EXPECT_FALSE(said("iron7-trackman", ""));
}

TEST(ImpactCase, EverySeriesReadsBackWithNamesComponentsUnitsAndTimes) {
  const fs::path out = fresh_directory("read_back") / "out";
  const Outcome run = command(coarse_full_club() + out.string());
  ASSERT_EQ(run.status, 0) << run.text;
  const CsvFile history(out / "history.csv");
  const std::vector<double> force = history.numbers("normal_force_N");
  const auto peak = std::ranges::max_element(force);
  ASSERT_GT(*peak, 8e3);  // the blow happened
  const double peak_time = history.number("time_s", std::size_t(peak - force.begin()));

  const std::map<std::string, std::vector<Array>> expected = {
      {"ball",
       {{"displacement", 3, "m"},
        {"velocity", 3, "m/s"},
        {"contact_traction", 3, "Pa"},
        {"cauchy_stress", 6, "Pa"},
        {"von_mises", 1, "Pa"},
        {"contact_pressure", 1, "Pa"}}},
      {"face", {{"displacement", 3, "m"}, {"velocity", 3, "m/s"}}},
      {"head", {{"displacement", 3, "m"}, {"velocity", 3, "m/s"}}},
      {"shaft",
       {{"displacement", 3, "m"},
        {"velocity", 3, "m/s"},
        {"radius", 1, "m"},
        {"axial_force", 1, "N"},
        {"torque", 1, "N m"},
        {"bending_moment", 1, "N m"}}}};
  for (const auto& [body, arrays] : expected) {
    const std::vector<Frame> series = frames(out / "vtk" / (body + ".pvd"));
    ASSERT_GT(series.size(), 10u) << body;
    double last = -1;
    for (const Frame& frame : series) {
      EXPECT_GT(frame.time, last) << body;
      last = frame.time;
      const auto data = read(frame.file);
      ASSERT_GT(data->GetNumberOfPoints(), 0) << frame.file;
      EXPECT_NEAR(data->GetFieldData()->GetArray("TimeValue")->GetComponent(0, 0), frame.time, 1e-8 * frame.time);
      for (const Array& a : arrays) {
        vtkDataArray* array = data->GetPointData()->GetArray(a.name);
        ASSERT_NE(array, nullptr) << body << ' ' << a.name;
        EXPECT_EQ(array->GetNumberOfComponents(), a.components) << a.name;
        ASSERT_TRUE(array->GetInformation()->Has(vtkDataArray::UNITS_LABEL())) << a.name;
        EXPECT_STREQ(array->GetInformation()->Get(vtkDataArray::UNITS_LABEL()), a.unit);
        for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
          for (int c = 0; c < a.components; ++c) ASSERT_TRUE(std::isfinite(array->GetComponent(i, c))) << a.name;
      }
    }
    EXPECT_GT(last, 0.35e-3);
  }

  // At the largest force the ball is flat against the face: thinner along the blow than across by millimetres.
  const std::vector<Frame> series = frames(out / "vtk" / "ball.pvd");
  const auto at = std::ranges::min_element(series, {}, [&](const Frame& f) { return std::abs(f.time - peak_time); });
  const auto ball = read(at->file);
  vtkDataArray* u = ball->GetPointData()->GetArray("displacement");
  Eigen::Array3d low = Eigen::Array3d::Constant(1e9), high = -low;
  double pressure = 0;
  for (vtkIdType i = 0; i < ball->GetNumberOfPoints(); ++i) {
    const Eigen::Array3d x = Eigen::Map<const Eigen::Array3d>(ball->GetPoint(i)) +
                             Eigen::Array3d(u->GetComponent(i, 0), u->GetComponent(i, 1), u->GetComponent(i, 2));
    low = low.min(x);
    high = high.max(x);
    pressure = std::max(pressure, ball->GetPointData()->GetArray("contact_pressure")->GetComponent(i, 0));
  }
  const Eigen::Array3d size = high - low;
  EXPECT_LT(size.x(), size.y() - 4e-3);
  EXPECT_GT(pressure, 10e6);
  // The face is curved as its radii of 300 mm say: 40 mm towards heel and toe are 2.7 mm lower than the middle.
  const auto face = read(frames(out / "vtk" / "face.pvd").front().file);
  double bounds[6];
  face->GetBounds(bounds);
  EXPECT_GT(bounds[1] - bounds[0], 2e-3);

  // The manual has every name: columns, arrays, members of the summary.
  const std::set<std::string> none;
  const std::vector<std::string> columns = post::read_csv(out / "history.csv").names, arrays = array_names(out / "vtk");
  ASSERT_GT(columns.size(), 20u);
  ASSERT_GT(arrays.size(), 30u);
  EXPECT_EQ(not_in_manual(columns), none);
  EXPECT_EQ(not_in_manual(arrays), none);
  const auto summary = nlohmann::json::parse(content(out / "summary.json"));
  const nlohmann::json &launch = summary.at("models").at("fe-full-club"), &solution = launch.at("solution");
  std::vector<std::string> members;
  for (const nlohmann::json* table :
       {&launch, &solution, &solution.at("energy_J"), &summary.at("flights").at("fe-full-club")})
    for (const auto& [name, value] : table->items()) members.push_back(name);
  ASSERT_GT(members.size(), 40u);
  EXPECT_EQ(not_in_manual(members), none);
}

/// The picture of the ball at the largest force, in the page of a finished run; empty where it has none.
std::string cut_open(const fs::path& out) {
  const std::string page = content(out / "report.html");
  const std::size_t begin = page.find("aria-label='the ball cut open at the largest force");
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</svg>", begin) - begin);
}

/// What moves in the page of a finished run; empty where nothing does.
std::string moving(const fs::path& out) {
  const std::string page = content(out / "report.html");
  const std::size_t begin = page.find("<script type='application/json'");
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</script>", begin) - begin);
}

/// Starts the coarse full club and ends it by `number` once a frame is there.
int ended_at_frame(const fs::path& out, int frame, int number) {
  Child run(HOSEL_COMMAND " " + coarse_full_club() + out.string());
  const fs::path written = out / fmt::format("vtk/ball/ball_{:04}.vtu", frame);
  EXPECT_TRUE(run.until([&] { return fs::exists(written); }));
  EXPECT_FALSE(run.ended());
  return run.end(number);
}

TEST(ImpactCase, TheErrorOfEveryNumberIsTheDistanceToACoarserRun) {
  const auto run = [](const std::string& name, int sector, int harmonics, int antisymmetric, int steps, bool estimate) {
    const fs::path out = fresh_directory(name) / "out";
    const Outcome o = command(fmt::format(
        "run {}/cases/driver-toe --quiet --set 'models=[\"fe-free-body\"]' --set output.vtk=false --set mesh.sector={} "
        "--set mesh.rings={} --set mesh.harmonics={} --set mesh.antisymmetric={} --set time.steps_per_contact={} --set "
        "error_estimate={} --out {}",
        HOSEL_SOURCE_DIR, sector, sector, harmonics, antisymmetric, steps, estimate, out.string()));
    EXPECT_EQ(o.status, 0) << o.text;
    return nlohmann::json::parse(content(out / "summary.json")).at("models").at("fe-free-body");
  };
  const auto fine = run("fine", 2, 4, 3, 40, true), coarse = run("coarse", 1, 2, 2, 20, false);
  EXPECT_FALSE(coarse.contains("numerical_error"));
  for (const char* key : {"ball_speed_mps", "launch_angle_deg", "spin_rate_rpm"}) {
    const double error = fine.at("numerical_error").at(key);
    EXPECT_GT(error, 0) << key;
    // Printed with all digits: round-off of a difference of near numbers.
    EXPECT_NEAR(error, std::abs(double(fine.at(key)) - double(coarse.at(key))), 1e-9 * double(fine.at(key))) << key;
  }
  EXPECT_LT(double(fine.at("solution").at("worst_residual_of_forces")), 1e-5);
  EXPECT_GT(double(fine.at("solution").at("worst_residual_of_forces")), 0);
  // There is nothing coarser than the coarsest: said, not left out.
  const Outcome none =
      command("check " HOSEL_SOURCE_DIR "/cases/driver-toe --set accuracy=look --set error_estimate=true");
  expect_refused(none, "error_estimate");
}

TEST(ImpactCase, StoppedRunsGoOnToTheSameBytes) {
  const fs::path whole = fresh_directory("whole") / "out";
  ASSERT_EQ(command(coarse_full_club() + whole.string()).status, 0);
  const auto expected = results_below(whole);
  ASSERT_GT(expected.size(), 60u);

  // Killed outright, then asked to stop, then finished.
  const fs::path out = fresh_directory("stopped") / "out";
  const int killed = ended_at_frame(out, 10, SIGKILL);
  ASSERT_TRUE(WIFSIGNALED(killed)) << "the run had ended before it was killed";
  EXPECT_FALSE(fs::exists(out / "summary.json"));
  for (const char* body : {"ball", "face", "head", "shaft"}) {
    const std::vector<Frame> series = frames(out / "vtk" / (std::string(body) + ".pvd"));
    ASSERT_GE(series.size(), 8u) << body;
    for (const Frame& frame : series) EXPECT_GT(read(frame.file)->GetNumberOfPoints(), 0) << frame.file;
  }
  const int asked = ended_at_frame(out, 17, SIGTERM);
  ASSERT_TRUE(WIFEXITED(asked));
  EXPECT_EQ(WEXITSTATUS(asked), 143);
  EXPECT_NE(content(out / "log.txt").find("goes on from t = "), std::string::npos);
  const std::string version = command("--version").text;  // "hosel 1.0.0 build ..."
  EXPECT_NE(content(out / "checkpoint.cbor").find(version.substr(6, version.find('\n') - 6)), std::string::npos)
      << "a checkpoint of another build is not gone on from";
  const fs::path without = fresh_directory("no_history") / "out";
  fs::copy(out, without, fs::copy_options::recursive);
  ASSERT_EQ(command(coarse_full_club() + out.string()).status, 0);
  const std::string log = content(out / "log.txt"), words = "goes on from t = ";
  ASSERT_NE(log.rfind(words), std::string::npos);
  // It went on when the largest force was over: the page shows it all the same.
  const auto summary = nlohmann::json::parse(content(out / "summary.json"));
  ASSERT_GT(std::stod(log.substr(log.rfind(words) + words.size())),
            double(summary.at("models").at("fe-full-club").at("solution").at("peak_time_ms")));
  EXPECT_GT(cut_open(whole).size(), 1000u);
  EXPECT_EQ(cut_open(out), cut_open(whole));
  EXPECT_GT(moving(whole).size(), 100'000u);
  EXPECT_TRUE(moving(out) == moving(whole));
  expect_same_results(out, expected, "stopped twice");

  // A history that is gone, a frame that is cut: nothing to go on from, the run begins afresh.
  fs::remove(without / "history.csv");
  fs::resize_file(without / "vtk/patch/patch_0003.vtp", 200);
  ASSERT_EQ(command(coarse_full_club() + without.string()).status, 0);
  EXPECT_EQ(content(without / "log.txt").find("goes on from t = "), std::string::npos);
  expect_same_results(without, expected, "begun afresh");
}

TEST(ImpactCase, OneCoreGivesTheBytesOfAll) {
  const fs::path all = fresh_directory("all_cores") / "out", one = fresh_directory("one_core") / "out";
  ASSERT_EQ(command(coarse_full_club() + all.string()).status, 0);
  const OneCore guard;
  if (guard.cores_before() < 2) GTEST_SKIP() << "this machine has one core";
  ASSERT_EQ(command(coarse_full_club() + one.string()).status, 0);
  const auto expected = results_below(all);
  ASSERT_GT(expected.size(), 60u);
  expect_same_results(one, expected, "one core");
}

/// A launch is an answer where its flight has no landing.
TEST(ImpactCase, ABallThatDoesNotReachTheGroundHasALaunch) {
  const fs::path dir = fresh_directory("impact_no_landing");
  write(dir / "case.toml", kEccentricBlow + "[flight]\nlaw = \"ferguson-2022\"\nground.height_m = 400\n");
  const Outcome o = command("run " + dir.string() + " --quiet --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  const auto s = nlohmann::json::parse(content(dir / "out/summary.json"));
  EXPECT_GT(s.at("models").at("rigid-eccentric").at("ball_speed_mps").get<double>(), 40);
  EXPECT_FALSE(s.contains("flights"));
  ASSERT_EQ(s.at("doubts").size(), 1u) << s.dump();
  EXPECT_NE(s["doubts"][0].get<std::string>().find("does not rise to the ground"), std::string::npos);
}

/// Nor does a compared column go without a word: where its ball does not land, and where it is struck off the face.
TEST(ImpactCase, AComparedColumnIsDoubtedToo) {
  const fs::path dir = fresh_directory("impact_compared_doubts");
  write(dir / "case.toml", kEccentricBlow +
                               "[flight]\nground.height_m = 5\n[[compare]]\nname = \"low\"\n"
                               "set = [\"delivery.dynamic_loft_deg=1\"]\n[[compare]]\nname = \"wide\"\n"
                               "set = [\"delivery.impact_toe_mm=80\"]\n");
  const Outcome o = command("run " + dir.string() + " --out " + (dir / "out").string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("warning: low: rigid-eccentric: flight: the ball does not rise to the ground"),
            std::string::npos)
      << o.text;
  EXPECT_NE(o.text.find("warning: wide: the ball is struck off the face: 80 mm towards the toe"), std::string::npos)
      << o.text;
}

TEST(ImpactCase, AComparedColumnIsTheCaseThatItSays) {
  const fs::path dir = fresh_directory("impact_compared");
  const std::string flight = "[flight]\nlaw = \"ferguson-2022\"\n";
  write(dir / "case.toml", kEccentricBlow + flight +
                               "[[compare]]\nname = \"light\"\nset = [\"ball.mass_kg=0.040\"]\n"
                               "[[compare]]\nname = \"high\"\nset = [\"flight.altitude_m=2000\"]\n");
  ASSERT_EQ(command("run " + dir.string() + " --quiet --out " + (dir / "out").string()).status, 0);
  const auto together = nlohmann::json::parse(content(dir / "out/summary.json"))["flights"];
  for (const auto& [name, set] : {std::pair{"light", "ball.mass_kg=0.040"}, {"high", "flight.altitude_m=2000"}}) {
    const fs::path own = dir / name;
    write(own / "case.toml", kEccentricBlow + flight);
    ASSERT_EQ(command("run " + own.string() + " --quiet --set " + set + " --out " + (own / "out").string()).status, 0);
    const auto alone = nlohmann::json::parse(content(own / "out/summary.json"))["flights"]["rigid-eccentric"];
    const auto& column = together[std::string(name) + ": rigid-eccentric"];
    EXPECT_EQ(column["carry_yd"], alone["carry_yd"]) << name << column;
    EXPECT_NE(column["carry_yd"], together["rigid-eccentric"]["carry_yd"]) << "the setting changes the carry";
  }
}

/// What is set for the whole case comes after what a column sets.
TEST(ImpactCase, AComparedColumnKeepsWhatItSets) {
  const fs::path dir = fresh_directory("impact_compared_kept");
  write(dir / "case.toml", kEccentricBlow + "[[compare]]\nname = \"heavy\"\nset = [\"head.mass_g=220\"]\n");
  const auto check = [&](const std::string& set) { return command("check " + dir.string() + " --set '" + set + "'"); };
  EXPECT_EQ(check("delivery.club_speed_mps=44").status, 0);
  for (const char* set : {"head={name=\"driver-2024\"}", "head.mass_kg=0.21"})
    expect_refused(check(set), "compare[1].set: 'head.mass_g' is also set for every column (head");
  EXPECT_EQ(command("check " + dir.string() + " --set compare=[] --set head.mass_kg=0.21").status, 0);
}

TEST(ImpactCase, AComparedColumnTakesNoUnknownKey) {
  const fs::path dir = fresh_directory("impact_compared_key");
  const auto checked = [&](const std::string& set) {
    write(dir / "case.toml", kEccentricBlow + "[[compare]]\nname = \"other\"\nset = [\"" + set + "\"]\n");
    return command("check " + dir.string());
  };
  ASSERT_EQ(checked("delivery.club_speed_mps=20").status, 0);
  const Outcome misspelt = checked("delivery.club_sped_mps=20");
  expect_refused(misspelt, "club_speed_mps");
  const Outcome shared = checked("output.vtk=false");
  expect_refused(shared, "output is the case's own");
  // A table that the case's own model reads, and that of the column does not.
  std::string text = kEccentricBlow +
                     "[contact]\nface_friction = 0.3\n[shaft]\nname = \"steel-7-iron\"\n"
                     "[grip]\nelements = 16\n[[compare]]\nname = \"impulse\"\n";
  text.replace(text.find("[\"rigid-eccentric\"]"), 19, "[\"fe-full-club\"]\naccuracy = \"look\"");
  write(dir / "case.toml", text + "set = [\"ball.mass_kg=0.045\"]\n");
  ASSERT_EQ(command("check " + dir.string()).status, 0);
  write(dir / "case.toml", text + "set = [\"models=['rigid-eccentric']\"]\n");
  const Outcome unread = command("check " + dir.string());
  expect_refused(unread, "grip: unknown table");
  EXPECT_NE(unread.text.find("by the column 'impulse' of [[compare]]"), std::string::npos) << unread.text;
  const Outcome set = command("check reduced-tour --set 'sets[1].set=[\"head.mas_kg=0.3\"]'");
  EXPECT_EQ(set.status, 2) << set.text;
}

TEST(ImpactCase, AMeshTooLargeForTheMachineIsRefused) {
  const double present = 1e-9 * double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  const auto checked = [](const std::string& set) {
    return command("check " HOSEL_SOURCE_DIR "/cases/driver-toe " + set);
  };
  EXPECT_EQ(checked("--set accuracy=look").status, 0);  // some 50 MB
  if (present > 900) GTEST_SKIP() << "this machine has room for the largest mesh";
  const Outcome o = checked("--set mesh.sector=64 --set mesh.rings=64 --set mesh.harmonics=16");
  EXPECT_EQ(o.status, 2);
  const std::string words = "mesh: the solution would take some ";
  const auto at = o.text.find(words);
  ASSERT_NE(at, std::string::npos) << o.text;
  EXPECT_GT(std::stod(o.text.substr(at + words.size())), present);
  EXPECT_NE(o.text.find(fmt::format("this machine has {:.0f} GB", present)), std::string::npos) << o.text;
  EXPECT_NE(o.text.find("fewer sectors, rings or harmonics"), std::string::npos) << o.text;
}

TEST(ImpactCase, TwoRunsInOneDirectoryAreOneTooMany) {
  const fs::path out = fresh_directory("locked") / "out";
  Child first(HOSEL_COMMAND " " + coarse_full_club() + out.string());
  ASSERT_TRUE(first.until([&] { return fs::exists(out / "history.csv"); })) << "the first run had ended";
  const Outcome second = command(coarse_full_club() + out.string());
  expect_refused(second, "process " + std::to_string(first.id()) + " on ");
  const int status = first.end(SIGINT);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
}

TEST(ImpactCase, ADiskThatIsFullIsSaidInWords) {
  const fs::path out = fresh_directory("full") / "out";
  FILE* pipe = popen(("ulimit -f 40; " HOSEL_COMMAND " " + coarse_full_club() + out.string() + " 2>&1").c_str(), "r");
  std::string text;
  for (char buffer[512]; fgets(buffer, sizeof buffer, pipe);) text += buffer;
  EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 1) << text;
  EXPECT_NE(text.find("cannot be written: File too large"), std::string::npos) << text;
  EXPECT_EQ(std::ranges::count(text, '\n'), 1) << text;
}

}  // namespace
}  // namespace hosel::test
