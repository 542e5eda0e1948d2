/// The output directory of one run, its log, and what a person sees while it works.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "app/reader.hpp"
#include "app/run_page.hpp"
#include "post/figure.hpp"
#include "post/launch_table.hpp"
#include "post/text_table.hpp"

namespace hosel::app {

/// Verbosity and places, from the command line.
struct OutputOptions {
  std::filesystem::path directory;  ///< OUT
  bool force = false;               ///< overwrite a finished run
  bool merge = false;               ///< plan and points of a sweep stay all the same
  bool quiet = false;
  std::filesystem::path log = {};         ///< besides OUT/log.txt
  std::string command = {};               ///< what was typed, for the page
  std::optional<post::Units> units = {};  ///< of what is shown; absent: m/s, and the case's own on the page
  bool strict = false;                    ///< a doubt about the numbers is a failure
  bool inner = false;                     ///< of a point of a study, which tells its doubts itself
  bool durable = true;                    ///< files wait for the disk: not worth it where they are thrown away
};

/// Progress of one long piece of work: a bar with time to go on a terminal, plain lines elsewhere.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  /// `done` of 1; `note` is a short state ("t = 0.21 ms"). Thread-safe; cheap to call often.
  void update(double done, std::string_view note = {});
  void finish(std::string_view note = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The first doubt of a strict run.
struct Doubted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Output {
 public:
  /// Creates OUT (refused with InputError where a finished run lies there, unless forced, where another process is at
  /// work, or where something lies that the case reads), writes `case.resolved.toml` and opens `log.txt`. `--log FILE`
  /// replaces a log of an earlier run and nothing else.
  Output(OutputOptions options, const CaseFile& file);
  /// Of a case that reads no files.
  Output(OutputOptions options, std::string_view resolved_case);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  const std::filesystem::path& directory() const;
  std::filesystem::path path(std::string_view name) const;  ///< OUT/name, parent folders made
  const std::string& resolved_case() const;                 ///< as written to `case.resolved.toml`
  const std::string& fingerprint() const;                   ///< of everything that the run reads: Inputs::fingerprint
  bool quiet() const;
  std::optional<post::Units> asked_units() const;  ///< on the command line
  post::Units units() const;                       ///< of tables
  post::Units page_units() const;  ///< of the page's answer: those asked for, else those that the case speaks
  bool force() const;              ///< what an unfinished run left is to be discarded

  /// A line for the person and the log: how the run goes, not what it found.
  void tell(std::string_view line) const;
  /// A line of the answer: for the person, the log and the page.
  void say(std::string_view line);
  /// A table likewise: on the page under this heading, without one among the answers.
  void show(const post::TextTable& table, std::string_view heading = {});
  /// Draws OUT/name and puts it on the page (where there are many, as a link), or says why it cannot be drawn.
  void draw(const post::Figure& figure, std::string_view name, bool on_page = true);
  /// OUT/report.html as it grows.
  RunPage& page();
  /// A doubt about the numbers: for the person, even a quiet one's, the page, the log and `summary.json`. Throws
  /// Doubted where the run is strict.
  void warn(std::string_view doubt);
  /// What the run could not do and its numbers do not suffer from: for the person, even a quiet one's, the page, the
  /// log and `summary.json`.
  void lack(std::string_view sentence) const;
  /// A line for the log alone.
  void log(std::string_view line) const;
  Progress progress(std::string what) const;
  /// See post::write_file: a killed run or a full disk never leaves half a file. A table (NAME.csv) must be one: as
  /// many cells in every row as in its head, none of whose names stands twice; else std::logic_error.
  void write(std::string_view name, std::string_view content) const;
  /// A name from a case as part of a file's: letters, digits and hyphens, no longer than a disk stores, and another one
  /// for every other name.
  std::string file_name(std::string_view name);
  void write_json(std::string_view name, const nlohmann::json& content) const;
  /// Writes the page and the summary: `summary.json` marks the run as finished. Throws solvers::NonConvergence where a
  /// number in it is not finite, InputError where a file that the case names has changed since it was read, and
  /// std::runtime_error where something that the run has written is gone.
  void write_summary(const nlohmann::json& summary) const;
  /// Finishes a run whose measured data are not there.
  void skip(const std::filesystem::path& missing);

 private:
  void begin(std::string_view resolved);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hosel::app
