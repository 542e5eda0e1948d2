/// What `hosel run` does with a case: one job per `kind`, read first, run after.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "app/output.hpp"
#include "app/reader.hpp"

namespace hosel::app {

/// A case that has been read and found good. Reading writes nothing; only run() does.
class Job {
 public:
  virtual ~Job() = default;
  /// Throws solvers::NonConvergence (status 3) or InputError (status 2).
  virtual void run(Output& out) = 0;
};

struct Kind {
  std::string_view name;
  std::string_view what;      ///< one sentence for `hosel list`
  std::string_view question;  ///< that a run answers: what its page begins with
  /// Reads every key that the kind knows (`kind` and `title` are read already).
  std::unique_ptr<Job> (*read)(CaseFile& file);
};

/// Every kind by its name. Adding one: app/kinds/KIND.cpp and one line in job.cpp.
std::span<const Kind> kinds();

/// Reads `kind` and `title`, the whole case by its kind, and refuses what is left over.
std::unique_ptr<Job> read_job(CaseFile& file);

}  // namespace hosel::app
