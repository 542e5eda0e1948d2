// Files are whole or not there; histories and checkpoints are what they were, or are not gone on from.
#include "post/file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "post/checkpoint.hpp"
#include "tests/support/fresh_directory.hpp"

namespace hosel::post {
namespace {

namespace fs = std::filesystem;

std::size_t entries(const fs::path& dir) {
  return std::size_t(std::distance(fs::directory_iterator(dir), fs::directory_iterator{}));
}

TEST(File, WritersSideBySideLeaveOneOfTheirFiles) {
  const test::FreshDirectory home("file_race");
  const fs::path& dir = home.path();
  const std::string a(300'000, 'a'), b(200'000, 'b');
  std::jthread one([&] {
    for (int i = 0; i < 30; ++i) write_file(dir / "x", a, false);
  });
  for (int i = 0; i < 30; ++i) write_file(dir / "x", b, false);
  one.join();
  const std::string left = read_file(dir / "x");
  EXPECT_TRUE(left == a || left == b);
  EXPECT_EQ(entries(dir), 1u);
}

TEST(File, ARefusedWriteLeavesTheOldFileAndSaysWhy) {
  const test::FreshDirectory home("file_limit");
  const fs::path& dir = home.path();
  write_file(dir / "x", "old");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &small);
  std::string said;
  try {
    write_file(dir / "x", std::string(5000, 'n'));
  } catch (const std::runtime_error& e) { said = e.what(); }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(said.find("File too large"), std::string::npos) << said;
  EXPECT_EQ(read_file(dir / "x"), "old");
  EXPECT_EQ(entries(dir), 1u);
}

TEST(History, GoesOnOnlyWithWhatItWrote) {
  const test::FreshDirectory home("history");
  const fs::path file = home.path() / "history.csv";
  const auto write = [](History& h, int from, int to) {
    for (int i = from; i < to; ++i) h.write(std::vector{0.1 * i, double(i)});
  };
  History::Mark mark;
  std::string whole;
  {
    History h(file, {"time_s", "x_m"});
    write(h, 0, 5);
    mark = h.mark();
    write(h, 5, 9);
    whole = read_file(file);
  }
  {
    History h(file, {"time_s", "x_m"}, &mark);
    write(h, 5, 9);
  }
  EXPECT_EQ(read_file(file), whole);
  ASSERT_TRUE(History::holds(file, mark));
  std::string changed = whole;
  changed[20] ^= 1;
  write_file(file, changed);
  EXPECT_FALSE(History::holds(file, mark));
  write_file(file, whole.substr(0, 30));
  EXPECT_FALSE(History::holds(file, mark));
  fs::remove(file);
  EXPECT_FALSE(History::holds(file, mark));
  EXPECT_THROW(History(file, {"time_s", "x_m"}, &mark), std::runtime_error);
}

/// Every floating-point number of an impact but those of what is drawn.
std::vector<double*> numbers_of(SavedImpact& s) {
  std::vector<double*> out;
  const auto add = [&](auto&& several) {
    for (double& x : several) out.push_back(&x);
  };
  solvers::Checkpoint& solver = s.impact.solver;
  for (Eigen::VectorXd* x : {&solver.state.q, &solver.state.v, &solver.state.a, &solver.auxiliary}) add(*x);
  add(solver.history);
  solvers::Ledger& l = solver.ledger;
  for (auto& [body, energy] : l.strain) out.push_back(&energy);
  for (double* x : {&l.time, &l.kinetic, &l.contact, &l.friction, &l.viscous, &l.numerical, &l.external})
    out.push_back(x);
  for (double* x : {&l.initial, &l.closure, &solver.state.time, &solver.step, &solver.last_step}) out.push_back(x);
  for (double* x : {&solver.friction_before, &solver.viscous_before, &solver.external_before}) out.push_back(x);
  models::FeImpactResult& r = s.impact.so_far;
  for (double* x : {&r.penetration, &r.creep, &r.counts.worst_residual}) out.push_back(x);
  for (double* x : {&s.impact.last_touch, &s.impact.last_nearest, &s.impact.last_gap}) out.push_back(x);
  for (solvers::Peak* p : {&s.impact.force, &s.impact.compression, &s.impact.face_travel}) {
    for (double* x : {&p->value, &p->time}) out.push_back(x);
    add(p->times);
    add(p->values);
  }
  add(s.impact.release.time);
  add(s.impact.release.force);
  add(s.face_centre);
  add(s.face_axes.reshaped());
  return out;
}

/// No number twice, so that none can stand in another's place.
SavedImpact some_impact() {
  SavedImpact s;
  solvers::Checkpoint& solver = s.impact.solver;
  for (Eigen::VectorXd* x : {&solver.state.q, &solver.state.v, &solver.state.a, &solver.auxiliary}) x->resize(40);
  solver.ledger.strain = {{"ball", 0}, {"shaft", 0}};
  solver.history.resize(3);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (double* x : numbers_of(s)) *x = uniform(random);
  s.impact.so_far.counts = {101, 102, 103, 104, 105, s.impact.so_far.counts.worst_residual};
  int steps = 110;
  for (solvers::Peak* p : {&s.impact.force, &s.impact.compression, &s.impact.face_travel}) p->steps = ++steps;
  s.impact.touched = true;
  s.impact.release.apart = true;
  s.impact.release.known = 3;
  s.section = BallSection{.time = 2e-4, .force = 9e3, .points = {{0.01, -0.02}, {0, 0.02}}, .von_mises = {1e6, 2e6}};
  s.section->cells = {{0, 1, 1, 0}};
  s.section->seams = {{1, 0, 1}};
  s.section->face = {{0.03, 0.04}};
  s.moving = {
      .radius = 0.02,
      .bodies = {{"face", 3, {}, {0, 1, 2}, {}}, {"shaft", 2, {}, {}, {0.004, 0.006}}},
      .frames = {{1e-5, 2e3, Vec3(1, 2, 3), {{{0, 0, 0, 1, 0, 0, 0, 1, 0.1f}, {}, {1, 2, 3}}, {{0, 0, 0, 0, 0, 1}}}}},
      .stride = 4};
  s.history = {12, "history"};
  s.series["ball"] = {{0, 1e-5}, "ball"};
  return s;
}

/// The same and the whole numbers, in one row.
std::vector<double> all_numbers(SavedImpact s) {
  std::vector<double> out;
  for (const double* x : numbers_of(s)) out.push_back(*x);
  const solvers::GeneralizedAlpha::Counts& n = s.impact.so_far.counts;
  for (const long x : {n.steps, n.rejected, n.iterations, n.factorisations, n.dense_factorisations})
    out.push_back(double(x));
  for (const solvers::Peak& p : {s.impact.force, s.impact.compression, s.impact.face_travel})
    out.push_back(double(p.steps));
  out.push_back(double(s.impact.release.known));
  return out;
}

TEST(Checkpoint, ReadsBackToTheLastBit) {
  const test::FreshDirectory home("checkpoint");
  const fs::path file = home.path() / "checkpoint.cbor";
  const SavedImpact saved = some_impact();
  save_checkpoint(file, "run", saved);
  const auto back = load_checkpoint(file, "run");
  ASSERT_TRUE(back);
  const std::vector<double> numbers = all_numbers(saved), read = all_numbers(*back);
  ASSERT_EQ(std::set(numbers.begin(), numbers.end()).size(), numbers.size()) << "no number twice";
  ASSERT_EQ(read.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(read[i], numbers[i]) << i;
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(back->impact.solver.ledger.strain[i].first, saved.impact.solver.ledger.strain[i].first);
  EXPECT_TRUE(back->impact.touched && !back->impact.over && back->impact.release.apart);
  ASSERT_TRUE(back->section);
  EXPECT_EQ(svg(*back->section), svg(*saved.section));
  EXPECT_EQ(json_for_viewer(back->moving), json_for_viewer(saved.moving));
  EXPECT_GT(json_for_viewer(back->moving).size(), 300u);
  EXPECT_TRUE(back->moving.wants(8) && !back->moving.wants(6));
  EXPECT_EQ(back->history.rows, 12);
  EXPECT_EQ(back->history.digest, "history");
  EXPECT_EQ(back->series.at("ball").times, saved.series.at("ball").times);
  EXPECT_EQ(back->series.at("ball").digest, "ball");
  const fs::path again = home.path() / "again.cbor";
  save_checkpoint(again, "run", *back);
  EXPECT_EQ(read_file(again), read_file(file));
  EXPECT_FALSE(load_checkpoint(file, "another case")) << "of another case or another build";
}

TEST(Checkpoint, FiveHundredDamagedOnesAreNotGoneOnFrom) {
  const test::FreshDirectory home("checkpoint_bits");
  const fs::path file = home.path() / "checkpoint.cbor";
  save_checkpoint(file, "run", some_impact());
  const std::string good = read_file(file);
  std::mt19937 random(7);
  for (int k = 0; k < 500; ++k) {
    std::string bad = good;
    if (k % 5 == 4) bad.resize(random() % bad.size());
    else bad[random() % bad.size()] ^= char(1 << random() % 8);
    write_file(file, bad, false);
    ASSERT_FALSE(load_checkpoint(file, "run")) << "damage " << k;
  }
  write_file(file, good);
  EXPECT_TRUE(load_checkpoint(file, "run"));
}

TEST(Checkpoint, OnesMadeByHandAreNotGoneOnFrom) {
  const test::FreshDirectory home("checkpoint_hand");
  const fs::path file = home.path() / "checkpoint.cbor";
  save_checkpoint(file, "run", some_impact());
  const std::string good = read_file(file);
  const std::size_t end = good.find('\n'), digest_at = good.rfind(' ', end) + 1;
  const auto made = [&](const std::string& bytes) {
    write_file(file, good.substr(0, digest_at) + digest(bytes) + '\n' + bytes, false);
    return load_checkpoint(file, "run").has_value();
  };
  std::string body = good.substr(end + 1);
  ASSERT_TRUE(made(body)) << "the digest is right";
  EXPECT_FALSE(made(std::string(1'000'000, '\x81'))) << "lists of one list";
  EXPECT_FALSE(made(std::string("\xa1\x63run\x63run"))) << "{run: run}";
  EXPECT_FALSE(made("\x80")) << "a list";
  for (const auto& [where, what] : {std::pair{"/so_far/counts/0", "steps"},
                                    {"/force/4", "steps of a peak"},
                                    {"/release_known", "a count"},
                                    {"/history/0", "rows"}}) {
    nlohmann::json huge = nlohmann::json::from_cbor(body);
    huge.at(nlohmann::json::json_pointer(where)) = 1e25;
    std::string bytes;
    nlohmann::json::to_cbor(huge, bytes);
    EXPECT_FALSE(made(bytes)) << what << " that no integer holds";
  }
  body.replace(body.find("closure"), 7, "closing");
  EXPECT_FALSE(made(body)) << "a key is missing";
}

/// What a killed process wrote stands in the list of the one that goes on, until it is gone.
TEST(WrittenFiles, AListOutlivesItsProcess) {
  const test::FreshDirectory home("written_files");
  const fs::path& dir = home.path();
  const auto list = [&] { return read_file(dir / ".written"); };
  {
    const WrittenFiles killed(dir, ".written");
    write_file(dir / "b.csv", "1");
    write_file(dir / "gone.csv", "1");
    EXPECT_EQ(list(), "b.csv\ngone.csv\n");
  }
  WrittenFiles next(dir, ".written");
  fs::create_directory(dir / "below");
  write_file(dir / "below" / "a.csv", "1");
  fs::remove(dir / "gone.csv");
  next.close_list();
  EXPECT_EQ(list(), "b.csv\nbelow/a.csv\n");
  remove_listed(dir, ".written", {"b.csv"});
  EXPECT_EQ(list(), "b.csv\n");
  EXPECT_TRUE(fs::exists(dir / "b.csv"));
}

TEST(WrittenFiles, WhatStaysIsListedAgainAndWhatIsThrownAwayIsNot) {
  const test::FreshDirectory home("written_files_stay");
  const fs::path& dir = home.path();
  {
    WrittenFiles outer(dir, ".written");
    fs::create_directories(dir / "kept");
    fs::create_directories(dir / "scratch");
    {
      const WrittenFiles inner(dir / "kept", ".written"), passing(dir / "scratch");
      write_file(dir / "kept" / "a.csv", "1");
      write_file(dir / "scratch" / "b.csv", "1");
    }
    write_file(dir / "plan", "1");
    outer.close_list();
  }
  EXPECT_EQ(read_file(dir / ".written"), "kept/.written\nkept/a.csv\nplan\n");
  remove_listed(dir, ".written", {"plan", "scratch"});
  EXPECT_EQ(read_file(dir / ".written"), "plan\n");
  EXPECT_FALSE(fs::exists(dir / "kept"));
  EXPECT_TRUE(fs::exists(dir / "plan") && fs::exists(dir / "scratch" / "b.csv"));
}

}  // namespace
}  // namespace hosel::post
