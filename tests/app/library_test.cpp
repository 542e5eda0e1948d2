// The library: every shipped entry is read, a case takes its values, and what an entry did not see is refused.
#include "app/library.hpp"
#include "app/asked_model.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "app/job.hpp"
#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "build_info.hpp"
#include "command.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "golf/face_library.hpp"
#include "models/registry.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hosel;
using namespace hosel::app;
using hosel::test::command;
using hosel::test::content;
using hosel::test::fresh_directory;
using hosel::test::kEccentricBlow;
using hosel::test::Outcome;
using hosel::test::write;

/// A library of the user's own for the length of a test.
struct OwnLibrary {
  fs::path home;
  explicit OwnLibrary(const std::string& name) : home(fresh_directory(name) / "library") {
    setenv("HOSEL_LIBRARY", home.c_str(), 1);
  }
  ~OwnLibrary() { unsetenv("HOSEL_LIBRARY"); }
};

const std::string kBlow = R"(kind = "impact"
models = ["rigid-eccentric"]
[delivery]
club_speed_mps = 45.0
)";

CaseFile case_of(const fs::path& dir, const std::string& text, const std::vector<std::string>& set = {}) {
  write(dir / "case.toml", text);
  return CaseFile(dir, set);
}

std::string refusal(const fs::path& dir, const std::string& text, const std::vector<std::string>& models,
                    const std::vector<std::string>& set = {}) {
  CaseFile file = case_of(dir, text, set);
  try {
    Blow blow = read_blow(file.root(), models);
    read_options(file.root(), models, blow);
  } catch (const InputError& e) { return e.what(); }
  return {};
}

TEST(Library, EveryShippedEntryIsRead) {
  const OwnLibrary own("library_shipped");
  for (const Shelf shelf : {Shelf::balls, Shelf::faces, Shelf::heads, Shelf::contacts})
    for (const LibraryEntry& e : library(shelf)) {
      EXPECT_TRUE(e.shipped) << e.name;
      EXPECT_FALSE(e.what.empty() || e.what.starts_with("(unreadable")) << e.name << e.what;
      EXPECT_NO_THROW(check_entry(shelf, e.file)) << e.name;
    }
  EXPECT_GE(library(Shelf::balls).size(), 4u);
  EXPECT_GE(library(Shelf::heads).size(), 2u);
}

/// What the floors without a reader know is the same file, read by CMake: bit for bit.
TEST(Library, ConstantsAreWhatTheReaderReads) {
  std::size_t faces = 0;
  for (const LibraryEntry& e : library(Shelf::faces)) {
    if (!e.shipped) continue;
    const FaceCompliance read = library_face(e.name).face;
    const NamedFace* constant = find_face(e.name);
    ASSERT_NE(constant, nullptr) << e.name;
    for (const auto value : {&FaceCompliance::mass, &FaceCompliance::stiffness, &FaceCompliance::damping,
                             &FaceCompliance::half_width, &FaceCompliance::half_height})
      EXPECT_EQ(read.*value, constant->face.*value) << e.name;
    ++faces;
  }
  EXPECT_GE(faces, 3u);
  ASSERT_GE(models::ball_library().size(), 4u);
  for (const models::FeBall& constant : models::ball_library()) {
    const models::FeBall read = library_ball(constant.name).layers;
    ASSERT_EQ(read.layers.size(), constant.layers.size()) << constant.name;
    for (std::size_t k = 0; k < read.layers.size(); ++k) {
      const fem::Solid &a = read.layers[k].material, &b = constant.layers[k].material;
      EXPECT_EQ(read.layers[k].radius, constant.layers[k].radius);
      EXPECT_EQ(a.density, b.density);
      const auto *x = a.elastic.as<fem::Hyperelastic>(), *y = b.elastic.as<fem::Hyperelastic>();
      ASSERT_TRUE(x && y);
      EXPECT_EQ(x->c10, y->c10);
      EXPECT_EQ(x->bulk, y->bulk);
      ASSERT_EQ(a.branches.size(), b.branches.size());
      EXPECT_EQ(a.branches[0].modulus, b.branches[0].modulus);
      EXPECT_EQ(a.branches[0].time, b.branches[0].time);
    }
  }
}

TEST(Library, ACaseTakesAHeadAndChangesSingleValues) {
  const fs::path dir = fresh_directory("library_head");
  CaseFile file = case_of(dir, kBlow + "[head]\nname = \"driver-460\"\nmass_kg = 0.198\n");
  const Blow blow = read_blow(file.root(), {"rigid-eccentric"});
  const HeadEntry entry = library_head("driver-460");
  EXPECT_EQ(blow.club.head.mass, 0.198);
  EXPECT_EQ(blow.club.head.cg, entry.head.cg);
  EXPECT_EQ(blow.club.head.inertia, entry.head.inertia);
  EXPECT_EQ(blow.club.head.face.bulge, entry.head.face.bulge);
  ASSERT_TRUE(entry.loft && entry.hosel);
  EXPECT_EQ(blow.delivery.dynamic_loft, *entry.loft);
  EXPECT_EQ(blow.club.geometry.hosel, entry.hosel->position);
  // Its face, the case's own, none.
  const auto face = [&](const std::string& more) {
    CaseFile c = case_of(dir, kBlow + "[head]\nname = \"driver-460\"\n[contact]\nface_friction = 0.3\n" + more);
    Blow read;
    read_options(c.root(), {"fe-free-body"}, read);
    return read.club.head.compliance;
  };
  ASSERT_TRUE(face(""));
  EXPECT_EQ(face("")->stiffness, find_face(entry.face)->face.stiffness);
  ASSERT_TRUE(face("[face]\nname = \"steel-iron\"\n"));
  EXPECT_EQ(face("[face]\nname = \"steel-iron\"\n")->stiffness, find_face("steel-iron")->face.stiffness);
  EXPECT_FALSE(face("[face]\nname = \"rigid\"\n"));
}

/// A resolved case with a named head says all that it uses, and is read to the same.
TEST(Library, AResolvedCaseReadsTheSame) {
  const fs::path dir = fresh_directory("library_resolved");
  const auto resolved = [&](const std::string& text) {
    CaseFile file = case_of(dir, text);
    Blow blow = read_blow(file.root(), {"fe-free-body"});
    read_options(file.root(), {"fe-free-body"}, blow);
    return file.resolved();
  };
  const std::string once = resolved(kBlow +
                                    "[head]\nname = \"driver-460\"\n[ball]\nmodel = \"two-piece\"\n[contact]\n"
                                    "face_friction = 0.3\n");
  EXPECT_NE(once.find("stiffness_N_per_m"), std::string::npos) << once;
  EXPECT_NE(once.find("dynamic_loft_deg"), std::string::npos);
  EXPECT_EQ(resolved(once), once);
}

TEST(Library, BeyondWhatABallSawIsRefusedUnlessItIsSaid) {
  const fs::path dir = fresh_directory("library_beyond");
  const std::string text = kBlow +
                           "[head]\nname = \"driver-460\"\n[ball]\nmodel = \"two-piece\"\n[contact]\n"
                           "face_friction = 0.3\n";
  EXPECT_EQ(refusal(dir, text, {"fe-free-body"}), "");
  const std::string fast = refusal(dir, text, {"fe-free-body"}, {"delivery.club_speed_mps=65"});
  EXPECT_NE(fast.find("ball.model: 'two-piece' saw impact speeds"), std::string::npos) << fast;
  EXPECT_NE(fast.find("`extrapolate = true`"), std::string::npos) << fast;
  EXPECT_EQ(refusal(dir, text, {"fe-free-body"}, {"delivery.club_speed_mps=65", "ball.extrapolate=true"}), "");
  EXPECT_EQ(refusal(dir, text, {"rigid-eccentric"}, {"delivery.club_speed_mps=65", "contact.restitution=0.8"}), "")
      << "no layers are asked";
}

TEST(Library, ABallThatSaysNothingOfAContactIsRefusedByTheModelsThatAskIt) {
  const fs::path dir = fresh_directory("library_silent");
  const std::string text = kBlow + "[head]\nname = \"driver-460\"\n[ball]\nmodel = \"two-piece\"\n";
  ASSERT_EQ(refusal(dir, text, {"fe-free-body"}, {"contact.face_friction=0.3"}), "") << "its layers are there";
  const std::string silent = refusal(dir, text, {"rigid-eccentric"});
  EXPECT_NE(silent.find("ball.model: 'two-piece' has no restitution and friction"), std::string::npos) << silent;
  EXPECT_EQ(refusal(dir, text, {"rigid-eccentric"}, {"contact.restitution=0.8"}), "");
  EXPECT_NE(refusal(dir, text, {"hertz-maw"}).find("has no constants of hertz-maw"), std::string::npos);
}

TEST(Library, TheContactThatNobodyStatesIsInTheResolvedCase) {
  const fs::path dir = fresh_directory("library_contact_default");
  write(dir / "case.toml", kEccentricBlow);
  const Outcome o = command("check " + dir.string());
  ASSERT_EQ(o.status, 0) << o.text;
  EXPECT_NE(o.text.find("restitution = 0.86"), std::string::npos) << o.text;
}

TEST(Library, ASwungClubIsAskedAgainstWhatTheEntrySaw) {
  const fs::path dir = fresh_directory("library_swung");
  write(dir / "case.toml", "kind = \"impact\"\nmodels = [\"rigid-eccentric\"]\n[motion]\nfile = \"" +
                               std::string(HOSEL_SOURCE_DIR) +
                               "/cases/swing-driver/grip.csv\"\n[shaft]\nname = \"composite-driver\"\n"
                               "[head]\nname = \"driver-2024\"\n[hosel]\nposition_mm = [-20, 55, 20]\nlie_deg = 58\n"
                               "lean_deg = 0\n[solution]\nelements = 6\nstep_ms = 2\ngrip_point_mm = 230\n"
                               "[ball]\nmodel = \"tour\"\nreduced = \"wedges\"\n");
  const Outcome beyond = command("check " + dir.string());
  EXPECT_EQ(beyond.status, 2) << "wedges saw 30 to 44 deg, and this is a driver";
  EXPECT_NE(beyond.text.find("saw spin lofts"), std::string::npos) << beyond.text;
  const Outcome all_the_same = command("check " + dir.string() + " --set ball.extrapolate=true");
  EXPECT_EQ(all_the_same.status, 0) << all_the_same.text;
}

/// A finite-element ball turns as its layers do: another factor that the case states would be that of another ball.
TEST(Library, AnInertiaThatTheLayersDoNotHaveIsRefused) {
  const fs::path dir = fresh_directory("library_inertia");
  const std::string text = kBlow +
                           "[head]\nname = \"driver-460\"\n[ball]\nmodel = \"two-piece\"\n[contact]\n"
                           "face_friction = 0.3\n";
  CaseFile file = case_of(dir, text);
  Blow blow = read_blow(file.root(), {"fe-free-body"});
  const double layers = read_options(file.root(), {"fe-free-body"}, blow).fe.ball.inertia_factor();
  ASSERT_LT(layers, 0.393);
  ASSERT_EQ(blow.ball.inertia_factor, 0.4) << "the library's, of which nothing is said";
  const std::string said = refusal(dir, text, {"fe-free-body"}, {"ball.inertia_factor=0.44"});
  EXPECT_NE(said.find("ball.inertia_factor: is 0.44, and the layers have 0.391"), std::string::npos) << said;
  EXPECT_EQ(refusal(dir, text, {"fe-free-body"}, {"ball.inertia_factor=0.391"}), "");
  EXPECT_EQ(refusal(dir, text, {"rigid-eccentric"}, {"ball.inertia_factor=0.44", "contact.restitution=0.8"}), "")
      << "no layers are asked";
  EXPECT_EQ(refusal(dir, file.resolved(), {"fe-free-body"}), "");
}

/// The head of a swing is described in a frame turned about the face's normal: a lumped face turns with it, a plate
/// cannot.
TEST(Library, APlateInASwungBlowIsRefused) {
  const fs::path dir = fresh_directory("library_swung_plate");
  const std::string text = kBlow +
                           "[head]\nname = \"driver-460\"\n[contact]\nface_friction = 0.3\n"
                           "[face.plate]\nthickness = {map = \"constant\", value_mm = 2.8}\n";
  EXPECT_EQ(refusal(dir, text, {"fe-free-body"}), "");
  const std::string said = refusal(dir, text + "[motion]\nfile = \"grip.csv\"\n", {"fe-free-body"});
  EXPECT_NE(said.find("face.plate: a swing turns the head about the face's normal"), std::string::npos) << said;
}

const std::string kContact = R"(what = "a driver's contact"
[provenance]
source = "a test"
[saw]
spin_loft_deg = [0, 20]
[volumetric]
stiffness_N_per_m3 = 7e9
damping_s_per_m = 5e-3
friction = 0.3
transition_speed_mps = 0.9
joint_stiffness_N_m_per_rad = 13
joint_damping_N_m_s_per_rad = 2e-3
cover_thickness_mm = 1.3
volume_exponent = 1
)";

TEST(Library, AContactOfOnesOwnIsTheReducedModels) {
  const OwnLibrary own("library_own");
  write(own.home / "contacts" / "mine.toml", kContact);
  const fs::path dir = fresh_directory("library_own_case");
  const std::string text = kBlow + "[head]\nname = \"driver-460\"\n[contact]\nname = \"mine\"\n";
  CaseFile file = case_of(dir, text);
  Blow blow;
  EXPECT_NO_THROW(blow = read_blow(file.root(), {"volumetric"}));
  EXPECT_EQ(read_options(file.root(), {"volumetric"}, blow).volumetric.stiffness, 7e9);
  EXPECT_EQ(refusal(dir, text, {"volumetric"}), "");
  const std::string iron = refusal(dir, text, {"volumetric"}, {"delivery.dynamic_loft_deg=30"});
  EXPECT_NE(iron.find("contact.name: 'mine' saw spin lofts of 0 to 20 deg and is asked about 30 deg"),
            std::string::npos)
      << iron;
  const std::string law = refusal(dir, text, {"rigid-eccentric"});
  EXPECT_NE(law.find("'mine' has no restitution and friction"), std::string::npos) << law;
  // The digest of what it was stands in the resolved case.
  const std::string resolved = file.resolved();
  EXPECT_NE(resolved.find("digest"), std::string::npos) << resolved;
  EXPECT_EQ(refusal(dir, resolved, {"volumetric"}), "");
  write(own.home / "contacts" / "mine.toml", kContact + "# another\n");
  EXPECT_NE(refusal(dir, resolved, {"volumetric"}).find("'mine' is not what it was"), std::string::npos);
  const std::string faster = refusal(dir, resolved, {"volumetric"}, {"delivery.club_speed_mps=41"});
  EXPECT_NE(faster.find("'mine' is not what it was"), std::string::npos) << faster;
  EXPECT_EQ(refusal(dir, resolved, {"volumetric"}, {"contact.name=mine"}), "") << "named again, it is the present one";
}

TEST(Library, LayersTakeThePlaceOfABallOfOnesOwnAndOfItsDigest) {
  const OwnLibrary own("library_layers");
  write(own.home / "balls" / "mine.toml", content(shipped_library() / "balls" / "tour.toml"));
  const fs::path dir = fresh_directory("library_layers_case");
  const auto resolved = [&](const std::string& text, const std::vector<std::string>& set) {
    CaseFile file = case_of(dir, text, set);
    read_job(file);
    return file.resolved();
  };
  const std::string once = resolved(
      "kind = \"impact\"\nmodels = [\"fe-free-body\"]\n[delivery]\nclub_speed_mps = 45.0\n[head]\nname = "
      "\"driver-460\"\n"
      "[ball]\nmodel = \"mine\"\n[contact]\nfriction = 0.24\nface_friction = 0.24\n",
      {});
  ASSERT_NE(once.find("digest"), std::string::npos) << once;
  const std::string layers =
      resolved(once, {"ball.layers=[{law='neo-hooke', c10_MPa=13.0, bulk_MPa=1000, density_kg_per_m3=1150}]"});
  EXPECT_EQ(layers.find("digest"), std::string::npos) << layers;
  EXPECT_EQ(layers.find("mine"), std::string::npos) << layers;
}

/// Faults of an entry are told with its file and line.
TEST(Library, AFaultyEntryNamesItsLine) {
  const OwnLibrary own("library_faulty");
  write(own.home / "contacts" / "mine.toml", kContact + "stiffnes_N_per_m3 = 1\n");
  const fs::path dir = fresh_directory("library_faulty_case");
  const std::string text = kBlow + "[head]\nname = \"driver-460\"\n[contact]\nname = \"mine\"\n";
  const std::string said = refusal(dir, text, {"volumetric"});
  EXPECT_NE(said.find("mine.toml:15: volumetric.stiffnes_N_per_m3: unknown key"), std::string::npos) << said;
  write(own.home / "contacts" / "mine.toml", "what = \"nothing\"\n[provenance]\nsource = \"a test\"\n");
  EXPECT_NE(refusal(dir, text, {"volumetric"}).find("says nothing of a contact"), std::string::npos);
  write(own.home / "heads" / "driver-460.toml", "");
  EXPECT_NE(refusal(dir, text, {"volumetric"}).find("a shipped head has this name"), std::string::npos);
}

/// A ball of one piece with the contact's constants, softer for drivers than for irons; `saw`: what both sets saw too.
std::string ball_of_two_sets(const std::string& saw = "") {
  std::string text = content(shipped_library() / "balls" / "range-one-piece.toml");
  for (const auto& [name, lofts, stiffness] : {std::tuple{"driver", "[0, 20]", "7e9"}, {"irons", "[20, 40]", "8e9"}}) {
    std::string parts = kContact.substr(kContact.find("[volumetric]"));
    parts.replace(0, 12, "[reduced.volumetric]");
    parts.replace(parts.find("7e9"), 3, stiffness);
    text += std::string("[[reduced]]\nname = \"") + name + "\"\n[reduced.saw]\n" + saw + "spin_loft_deg = " + lofts +
            "\n" + parts;
  }
  return text;
}

/// A ball's parameters follow its loft: a 7-iron is not struck with a driver's.
TEST(Library, ABallsSetsAreChosenByLoft) {
  const OwnLibrary own("library_sets");
  write(own.home / "balls" / "mine.toml", ball_of_two_sets());
  const fs::path dir = fresh_directory("library_sets_case");
  const std::string blow = kBlow + "[head]\nname = \"iron-7\"\n[ball]\nmodel = \"mine\"\n";
  const auto stiffness = [&](const std::vector<std::string>& set) {
    CaseFile file = case_of(dir, blow, set);
    Blow read;
    return read_options(file.root(), {"volumetric"}, read).volumetric.stiffness;
  };
  EXPECT_EQ(stiffness({}), 8e9);
  EXPECT_EQ(stiffness({"delivery.dynamic_loft_deg=12"}), 7e9);
  EXPECT_EQ(stiffness({"ball.reduced=driver"}), 7e9);
  EXPECT_NE(refusal(dir, blow, {"volumetric"}, {"ball.reduced=driver"}).find("saw spin lofts of 0 to 20 deg"),
            std::string::npos);
  EXPECT_NE(refusal(dir, blow, {"volumetric"}, {"delivery.dynamic_loft_deg=50"}).find("several sets"),
            std::string::npos);
}

/// One model asked about many blows takes each blow's own set, and refuses what the case is refused with.
TEST(Library, AnAskedModelTakesTheSetOfEachBlow) {
  const OwnLibrary own("library_asked");
  write(own.home / "balls" / "mine.toml", ball_of_two_sets("impact_speed_mps = [20, 40]\n"));
  const fs::path dir = fresh_directory("library_asked_case");
  write(dir / "case.toml", kBlow + "[head]\nname = \"iron-7\"\n[ball]\nmodel = \"mine\"\n");
  const std::string only = "models=[\"volumetric\"]";
  const AskedModel model(dir.string(), "", {only});
  ASSERT_EQ(model.name(), "volumetric");
  const std::vector<Input> inputs{Input::club_speed, Input::dynamic_loft};
  const auto launches = [&](const std::vector<double>& values) {
    return model.launches(values.size() / 2, inputs, values);
  };
  const auto alone = [&](double loft, const std::string& set) {
    CaseFile file(dir, {only, "delivery.club_speed_mps=40", "ball.extrapolate=true", "ball.reduced=" + set});
    Blow blow = read_blow(file.root(), {"volumetric"});
    blow.delivery.dynamic_loft = loft;
    const hosel::models::Options options = read_options(file.root(), {"volumetric"}, blow);
    return hosel::models::find("volumetric")->make(options)->launch(blow).ball_speed();
  };
  const double low = radians(12), high = radians(30);
  ASSERT_GT(std::abs(alone(low, "driver") - alone(low, "irons")), 1e-3) << "the sets differ";
  const auto both = launches({40, high, 40, low, 40, high});
  EXPECT_EQ(both[0].value().ball_speed(), alone(high, "irons"));
  EXPECT_EQ(both[1].value().ball_speed(), alone(low, "driver"));
  EXPECT_EQ(both[2].value().ball_speed(), both[0].value().ball_speed());
  const auto refused = [&](const std::vector<double>& values) {
    try {
      launches(values);
    } catch (const InputError& e) { return std::string(e.what()); }
    return std::string();
  };
  const std::string fast = refused({40, low, 40, high, 55, low, 56, low});
  EXPECT_TRUE(fast.starts_with("blow 2: ")) << fast;
  EXPECT_NE(fast.find("'driver' saw impact speeds"), std::string::npos) << fast;
  const std::string steep = refused({40, high, 40, radians(50), 55, low});
  EXPECT_TRUE(steep.starts_with("blow 1: ")) << steep;
  EXPECT_NE(steep.find("several sets"), std::string::npos) << steep;
}

}  // namespace
