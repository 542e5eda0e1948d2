// Faults of a computing service during a run: SIGTERM, a disk quota, a clock that is set back, an fsync that writes
// nothing. SECURITY.md promises what is asked here.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/app/child.hpp"
#include "tests/app/command.hpp"
#include "tests/app/results.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;

/// Words before the command: under tests/support/injected_faults.cpp, with these of its variables.
std::string with_faults(const std::string& variables, const fs::path& log) {
  const fs::path library = fs::path(HOSEL_COMMAND).parent_path().parent_path() / "tests/libinjected_faults.so";
  EXPECT_TRUE(fs::exists(library)) << library;
  return fmt::format("env LD_PRELOAD={} ASAN_OPTIONS=verify_asan_link_order=0 FAULT_LOG={} {} ", library.string(),
                     log.string(), variables);
}

/// A blow that keeps checkpoints, and a study that keeps points.
const std::vector<std::string> kLongRuns = {"blow", "study"};

void write_long_run(const fs::path& dir, const std::string& which) {
  const std::string blow = R"([delivery]
club_speed_mps = 45.0
dynamic_loft_deg = 12.0
[head]
name = "driver-2024"
[ball]
model = "tour"
)";
  const std::string elements = R"([mesh]
harmonics = 1
sector = 1
rings = 1
[time]
steps_per_contact = 20
)";
  if (which == "blow") {
    write(dir / "case.toml",
          "kind = \"impact\"\nmodels = [\"fe-free-body\"]\n" + blow + elements + "[output]\nsteps_per_frame = 3\n");
    return;
  }
  // A point of finite elements takes some 70 ms: longer than a thread waits for a core before the signal reaches it.
  std::string values;
  for (int i = 0; i < 12; ++i) values += fmt::format("{}{:.1f}", i ? ", " : "", 8 + 0.4 * i);
  write(dir / "case.toml",
        "kind = \"study\"\nmodels = [\"fe-free-body\"]\noutputs = [\"ball_speed_mps\", \"spin_rate_rpm\"]\n" + blow +
            elements + "[[axis]]\nkey = \"delivery.dynamic_loft_deg\"\nvalues = [" + values + "]\n");
}

struct LongRun {
  fs::path dir, out;
  std::string line;  ///< what is typed, but for what stands before
  std::map<std::string, std::string> whole;
};

/// A case with the results of a run that nothing befell.
LongRun long_run(const std::string& test, const std::string& which) {
  LongRun r;
  r.dir = fresh_directory(test + "_" + which);
  r.out = r.dir / "out";
  write_long_run(r.dir / "case", which);
  const std::string run = hosel_command() + " run " + (r.dir / "case").string() + " --quiet --out ";
  r.line = run + r.out.string();
  const Outcome o = shell(run + (r.dir / "whole").string());
  EXPECT_EQ(o.status, 0) << o.text;
  r.whole = results_below(r.dir / "whole");
  EXPECT_TRUE(r.whole.contains("summary.json"));
  return r;
}

bool gone_on_from(const fs::path& file) {
  return file.filename() == "checkpoint.cbor" || file.filename() == "points.jsonl";
}

bool at_work(const LongRun& r) {
  const fs::path points = r.out / "shards/1-of-1/points.jsonl";
  if (fs::exists(points)) {
    const std::string text = content(points);
    return std::ranges::count(text, '\n') >= 4;
  }
  return fs::exists(r.out / "checkpoint.cbor");
}

/// What has been written of the work: points, or frames.
std::size_t done(const LongRun& r) {
  const fs::path points = r.out / "shards/1-of-1/points.jsonl", frames = r.out / "vtk/ball";
  if (fs::exists(points)) {
    const std::string text = content(points);
    return std::size_t(std::ranges::count(text, '\n'));
  }
  return fs::exists(frames) ? std::size_t(std::distance(fs::directory_iterator(frames), {})) : 0;
}

struct Drained {
  bool at_work = false;  ///< had something to go on from, and had not ended
  int status = 0;
  std::size_t more = 0;  ///< done after SIGTERM
};

/// Leaves this process two of its cores: on all of a large machine a study would end before it is asked to.
void keep_two_cores() {
  cpu_set_t all, two;
  if (sched_getaffinity(0, sizeof all, &all) != 0) return;  // more cores than the set holds
  CPU_ZERO(&two);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&two) < 2; ++core)
    if (CPU_ISSET(core, &all)) CPU_SET(core, &two);
  sched_setaffinity(0, sizeof two, &two);
}

/// SIGTERM once the run is at work: it stands still while what it has done is counted.
Drained drained(const LongRun& r, const std::string& before = "") {
  Child run(before + r.line, keep_two_cores);
  Drained d;
  d.at_work = run.until([&] { return at_work(r); }) && run.hold();
  if (!d.at_work) {
    d.status = run.wait();
    return d;
  }
  const std::size_t until = done(r);
  kill(run.id(), SIGTERM);
  run.go_on();
  d.status = run.wait();
  d.more = done(r) - until;
  return d;
}

void expect_drained(const Drained& d, const std::string& which) {
  ASSERT_TRUE(d.at_work) << which << " ended before SIGTERM, with " << d.status;
  ASSERT_TRUE(WIFEXITED(d.status)) << which;
  ASSERT_EQ(WEXITSTATUS(d.status), 143) << which;
}

/// Slurm sends SIGTERM and, after 30 s, SIGKILL. The run ends the step of the blow, or the point that each core
/// computes, and begins no other; it leaves all that it can go on from.
TEST(ServiceFaults, ADrainedNodeLosesNothing) {
  for (const std::string& which : kLongRuns) {
    const LongRun r = long_run("drained", which);
    const Drained d = drained(r);
    ASSERT_NO_FATAL_FAILURE(expect_drained(d, which));
    EXPECT_LE(d.more, 2u) << which;  // of two cores
    ASSERT_FALSE(fs::exists(r.out / "summary.json")) << which;
    const fs::path points = r.out / "shards/1-of-1/points.jsonl";
    const std::string kept = fs::exists(points) ? content(points) : "";
    const Outcome again = shell(r.line);
    ASSERT_EQ(again.status, 0) << which << again.text;
    expect_same_results(r.out, r.whole, which);
    if (which == "study") {
      EXPECT_TRUE(content(points).starts_with(kept)) << "points were computed twice";
    } else {
      EXPECT_NE(content(r.out / "log.txt").find("goes on from t = "), std::string::npos);
    }
  }
}

TEST(ServiceFaults, AQuotaHitInTheMiddleIsSaidAndTheRunGoesOn) {
  for (const std::string& which : kLongRuns) {
    const LongRun r = long_run("quota", which);
    std::size_t bytes = 0;
    for (const auto& [name, text] : r.whole) bytes += text.size();
    int hit = 0;
    for (const double share : {0.05, 0.3, 0.6, 0.9}) {
      fs::remove_all(r.out);
      const fs::path log = r.dir / fmt::format("quota-{}", share);
      const Outcome full = shell(with_faults(fmt::format("FAULT_QUOTA={}", long(share * double(bytes))), log) + r.line);
      if (full.status == 0) continue;  // what it wrote by other means than the command's own
      ++hit;
      ASSERT_TRUE(fs::exists(log)) << which << full.text;
      EXPECT_EQ(full.status, 1) << which << full.text;
      EXPECT_EQ(std::ranges::count(full.text, '\n'), 1) << full.text;
      EXPECT_NE(full.text.find("Disk quota exceeded"), std::string::npos) << full.text;
      EXPECT_FALSE(fs::exists(r.out / "summary.json"));
      const Outcome again = shell(r.line);
      ASSERT_EQ(again.status, 0) << which << again.text;
      expect_same_results(r.out, r.whole, fmt::format("{}, {} of its bytes", which, share));
    }
    EXPECT_GE(hit, 2) << which;
  }
}

/// Nothing is ordered or believed by the time of day: an hour less at every reading, and an end before the beginning.
TEST(ServiceFaults, AClockThatIsSetBackChangesNothing) {
  for (const std::string& which : kLongRuns) {
    const LongRun r = long_run("clock", which);
    const std::string backwards = with_faults("FAULT_CLOCK=3600", r.dir / "clock");
    ASSERT_NO_FATAL_FAILURE(expect_drained(drained(r), which));
    const Outcome o = shell(backwards + r.line);
    ASSERT_EQ(o.status, 0) << which << o.text;
    ASSERT_NE(content(r.dir / "clock").find('C'), std::string::npos) << "the clock was read once at most";
    expect_same_results(r.out, r.whole, which);
    if (which == "blow") { EXPECT_NE(content(r.out / "log.txt").find("goes on from t = "), std::string::npos); }
  }
}

/// After a cut of power names may be without their bytes, where fsync wrote nothing. One file after the other of a run
/// that had not ended is empty, all zeros or the half of itself: the answer is the same, or there is a sentence.
TEST(SlowServiceFaults, AnFsyncThatWritesNothingMakesNoOtherAnswer) {
  for (const std::string& which : kLongRuns) {
    const LongRun r = long_run("fsync", which);
    ASSERT_NO_FATAL_FAILURE(expect_drained(drained(r, with_faults("FAULT_FSYNC=skip", r.dir / "fsync")), which));
    ASSERT_NE(content(r.dir / "fsync").find('F'), std::string::npos) << which;
    const fs::path stopped = r.dir / "stopped";
    fs::rename(r.out, stopped);
    std::vector<fs::path> written;
    for (const auto& entry : fs::recursive_directory_iterator(stopped))
      if (entry.is_regular_file() && entry.file_size() > 1) written.push_back(fs::relative(entry.path(), stopped));
    std::ranges::sort(written);
    // Of many frames the first and the last. What a run goes on from is left in each way, the others in one each.
    std::map<std::pair<std::string, std::string>, std::vector<fs::path>> alike;
    for (const fs::path& file : written)
      alike[{file.parent_path().string(), file.extension().string()}].push_back(file);
    const std::vector<std::string> ways = {"empty", "zeros", "half"};
    std::size_t next = 0;
    int same = 0, refused = 0;
    for (const auto& [kind, files] : alike)
      for (std::size_t k = 0; k < files.size(); k += std::max<std::size_t>(1, files.size() - 1))
        for (const std::string& left : gone_on_from(files[k]) ? ways : std::vector{ways[next++ % ways.size()]}) {
          fs::remove_all(r.out);
          fs::copy(stopped, r.out, fs::copy_options::recursive);
          const std::string bytes = content(stopped / files[k]);
          write(r.out / files[k], left == "empty"   ? ""
                                  : left == "zeros" ? std::string(bytes.size(), '\0')
                                                    : bytes.substr(0, bytes.size() / 2));
          const std::string told = fmt::format("{}: {} {}", which, files[k].string(), left);
          const Outcome o = shell(r.line);
          if (o.status == 0) {
            ++same;
            // The list of what the stopped process wrote is lost with its bytes. It is no result.
            if (files[k] == ".written") write(r.out / ".written", r.whole.at(".written"));
            expect_same_results(r.out, r.whole, told);
          } else {
            ++refused;
            EXPECT_EQ(o.status, 2) << told << o.text;
            EXPECT_EQ(std::ranges::count(o.text, '\n'), 1) << told << o.text;
            EXPECT_NE(o.text.find(files[k].filename().string()), std::string::npos) << told << o.text;
          }
        }
    EXPECT_GE(same, 4) << which;  // a study has its case, its lock and its points
    EXPECT_LE(refused, same / 2) << which;
  }
}

}  // namespace
}  // namespace hosel::test
