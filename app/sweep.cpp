#include "app/sweep.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>

#include "app/cases.hpp"
#include "app/lock.hpp"
#include "app/stop.hpp"
#include "app/sweep_store.hpp"
#include "app/terminal.hpp"
#include "app/version.hpp"
#include "golf/parallel.hpp"
#include "post/file.hpp"
#include "post/labels.hpp"
#include "solvers/blas.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

struct Plan {
  std::string fingerprint, version;
  std::size_t points = 0;
};

Plan plan_of(const PointJob& job, const std::string& fingerprint) {
  return {fingerprint, program_version(), job.size()};
}

/// The points of this shard that no shard has finished yet, on all cores.
void compute_missing(const PointJob& job, const Plan& plan, const fs::path& root, Shard shard, Output& out) {
  solvers::keep_blas_in_one_thread();  // one thread a point
  const fs::path shards = root / "shards", own = shards / fmt::format("{}-of-{}", shard.index, shard.count);
  const auto finished = read_points(shards, plan.fingerprint, plan.points);
  std::vector<std::size_t> todo;
  for (std::size_t p = shard.index - 1; p < plan.points; p += shard.count)
    if (!finished.contains(p)) todo.push_back(p);
  fs::create_directories(own);
  PointStore store(own, plan.fingerprint);
  if (!finished.empty()) out.tell(fmt::format("{} of {} points are on disk already", finished.size(), plan.points));
  if (todo.empty()) return;

  Progress progress = out.progress(post::counted(todo.size(), "point"));
  std::atomic<std::size_t> done = 0;
  std::atomic<double> busy = 0;
  const auto clock = [] { return std::chrono::steady_clock::now().time_since_epoch(); };
  const auto start = clock();
  const StopSignals stop;
  for_all(
      tbb::blocked_range<std::size_t>(0, todo.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          stop.check();
          const auto from = clock();
          json result;
          try {
            result = job.compute(todo[i], own / fmt::format("point-{:06}", todo[i]));
          } catch (const solvers::NonConvergence& error) {
            result = {{"error", fmt::format("no convergence: {}", error.what())}};
          } catch (const std::invalid_argument& error) { result = {{"error", error.what()}}; }
          const double seconds = std::chrono::duration<double>(clock() - from).count();
          store.append(todo[i], seconds, result);
          busy.fetch_add(seconds);
          const std::size_t n = done.fetch_add(1) + 1;
          progress.update(double(n) / double(todo.size()), fmt::format("{} of {}", n, todo.size()));
        }
      },
      tbb::simple_partitioner());
  progress.finish();
  const double wall = std::chrono::duration<double>(clock() - start).count();
  out.log(fmt::format("{} in {:.2f} s of wall time, {:.2f} s of work", post::counted(todo.size(), "point"), wall,
                      busy.load()));
}

/// Every point, in order; where some are missing, an InputError that says how many.
std::vector<json> all_points(const Plan& plan, const fs::path& root) {
  auto found = read_points(root / "shards", plan.fingerprint, plan.points);
  if (found.size() != plan.points)
    throw InputError(
        fmt::format("{}: {} of {} points are finished; nothing merged", root.string(), found.size(), plan.points));
  std::vector<json> points;
  for (auto& [number, result] : found) points.push_back(std::move(result));
  return points;
}

void report_all(const PointJob& job, const std::vector<json>& points, Output& out) {
  try {
    job.report(out, points);
  } catch (const json::exception& e) {
    throw InputError(fmt::format("{}: a finished point is none of this case ({}); discard all points with --force",
                                 out.directory().string(), e.what()));
  }
  std::size_t failed = 0, first = 0;
  for (std::size_t p = points.size(); p-- > 0;)
    if (points[p].contains("error")) {
      ++failed;
      first = p;
    }
  if (failed)
    throw solvers::NonConvergence(fmt::format("{} of {} points have no answer; the first is point {}: {}", failed,
                                              points.size(), first, points[first]["error"].get<std::string>()));
}

struct Planned {
  std::unique_ptr<CaseFile> file;
  std::unique_ptr<Job> job;
  const PointJob* points;
  Plan plan;
};

Planned read_planned(const fs::path& where, const std::vector<std::string>& overrides) {
  Planned p;
  p.file = std::make_unique<CaseFile>(where, overrides);
  p.job = read_job(*p.file);
  p.points = dynamic_cast<const PointJob*>(p.job.get());
  if (!p.points)
    throw InputError(fmt::format("{}: a case of this kind is one piece of work; studies and face maps have points",
                                 p.file->file().string()));
  p.plan = plan_of(*p.points, p.file->inputs()->fingerprint());
  return p;
}

/// The plan of a directory, with the case read again and found the same.
Planned open_plan(const fs::path& out) {
  if (!fs::is_regular_file(out / "plan.json"))
    throw InputError(fmt::format("{0}: no plan here; `hosel sweep plan CASE --out {0}` makes one", out.string()));
  json plan;
  std::string named, version;
  std::vector<std::string> set;
  try {
    plan = unsealed(post::read_file(out / "plan.json"));
    named = plan.at("case");
    version = plan.at("version");
    set = plan.at("set").get<std::vector<std::string>>();
  } catch (const std::exception&) {
    throw InputError(fmt::format("{}: the plan is damaged; plan again", (out / "plan.json").string()));
  }
  Planned p = read_planned(named, set);
  if (version != p.plan.version)
    throw InputError(fmt::format("{}: planned with version {}, this program is {}; plan again", out.string(), version,
                                 p.plan.version));
  if (plan.at("fingerprint") != p.plan.fingerprint)
    throw InputError(fmt::format("{}: the case {} has changed since it was planned; plan again", out.string(), named));
  return p;
}

}  // namespace

void PointJob::run(Output& out) {
  if (out.force()) fs::remove_all(out.directory() / "shards");
  const Plan plan = plan_of(*this, out.fingerprint());
  compute_missing(*this, plan, out.directory(), {}, out);
  report_all(*this, all_points(plan, out.directory()), out);
}

Shard parse_shard(const std::string& text) {
  std::size_t index = 0, count = 0;
  const std::size_t slash = text.find('/');
  const auto whole = [](std::string_view digits, std::size_t& number) {
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() && stop == digits.data() + digits.size();
  };
  const bool good = slash != std::string::npos && whole(std::string_view(text).substr(0, slash), index) &&
                    whole(std::string_view(text).substr(slash + 1), count);
  if (!good || index < 1 || index > count)
    throw InputError(fmt::format("--shard {}: expected k/n with k from 1 to n, e.g. 2/8", text));
  return {index, count};
}

void sweep_plan(const fs::path& where, const std::vector<std::string>& overrides, const OutputOptions& options) {
  const fs::path found = find_case(where.string());
  if (const std::string path = fs::canonical(found).string(); printable(path) != path)
    throw InputError(fmt::format("{}: a plan names its case, and this path is no text", path));
  const Planned p = read_planned(found, overrides);
  const fs::path root = options.directory;
  if (fs::exists(root / "shards") && options.force) fs::remove_all(root / "shards");
  read_points(root / "shards", p.plan.fingerprint, p.plan.points);  // refuses a directory with other points
  Output out(options, *p.file);
  out.write_json("plan.json", sealed({{"case", fs::canonical(found).string()},
                                      {"set", overrides},
                                      {"points", p.plan.points},
                                      {"version", p.plan.version},
                                      {"fingerprint", p.plan.fingerprint}}));
  out.say(fmt::format("{} planned in {}", post::counted(p.plan.points, "point"), root.string()));
}

void sweep_run(const fs::path& root, Shard shard, bool quiet) {
  const Planned p = open_plan(root);
  refuse_links(root);
  // A directory of its own: shards run side by side and share no file.
  Output out({.directory = root / "shards" / fmt::format("{}-of-{}", shard.index, shard.count), .quiet = quiet},
             *p.file);
  compute_missing(*p.points, p.plan, root, shard, out);
}

void sweep_merge(const fs::path& root, bool force, bool quiet) {
  const Planned p = open_plan(root);
  const auto points = all_points(p.plan, root);
  Output out({.directory = root, .force = force, .merge = true, .quiet = quiet}, *p.file);
  report_all(*p.points, points, out);
}

void sweep_status(const fs::path& root) {
  const Planned p = open_plan(root);
  const auto points = read_points(root / "shards", p.plan.fingerprint, p.plan.points);
  std::size_t failed = 0;
  for (const auto& [number, result] : points) failed += result.contains("error");
  fmt::print("{} of {} points finished, {} without an answer{}\n", points.size(), p.plan.points, failed,
             fs::exists(root / "summary.json") ? "; merged" : "");
}

}  // namespace hosel::app
