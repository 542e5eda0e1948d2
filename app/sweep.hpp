/// Work that falls into independent points: on all cores, in shards on several machines, killed and
/// resumed; the merged result has the same bytes whatever the order and the division.
///
///     OUT/shards/1-of-2/points.jsonl   append-only: a header line, then one line a finished point
///     OUT/plan.json                    how many points, of which case and version
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/job.hpp"

namespace hosel::app {

/// A job of independent points.
class PointJob : public Job {
 public:
  virtual std::size_t size() const = 0;
  /// One point as a JSON object. Pure and callable from any thread; whatever it writes goes below
  /// `scratch`, which is its own. Throws solvers::NonConvergence or std::invalid_argument where the
  /// point has no answer: that is recorded as the point's result, {"error": "..."}.
  virtual nlohmann::json compute(std::size_t point, const std::filesystem::path& scratch) const = 0;
  /// The tables and figures of all points, in order. Depends on nothing else.
  virtual void report(Output& out, const std::vector<nlohmann::json>& points) const = 0;

  /// Every point that is not on disk yet, then the report. Throws solvers::NonConvergence at the end
  /// where a point failed.
  void run(Output& out) final;
};

/// The share of one process: the points whose number leaves `index - 1` when divided by `count`.
struct Shard {
  std::size_t index = 1, count = 1;
};
Shard parse_shard(const std::string& text);  ///< "2/8"; throws InputError

// The subcommands of `hosel sweep`. Each throws InputError on a directory that is not a plan, or whose
// case or program is no longer the one it was planned with.
void sweep_plan(const std::filesystem::path& where, const std::vector<std::string>& overrides,
                const OutputOptions& out);
void sweep_run(const std::filesystem::path& out, Shard shard, bool quiet);
void sweep_merge(const std::filesystem::path& out, bool force, bool quiet);
void sweep_status(const std::filesystem::path& out);

}  // namespace hosel::app
