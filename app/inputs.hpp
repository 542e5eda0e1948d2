/// Everything that a run reads, in one place: its case with every default filled in, the cases made of it, and what
/// stands in the files that they name.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace hosel::app {

/// "FILE is not there; ...": what SKIPPED says of measured data.
std::string not_there(const std::filesystem::path& file);

/// Shared by a case file and every case file made of it: whoever reads a case may name files from any thread.
class Inputs {
 public:
  /// A file that a case names; a missing one counts as such. Throws InputError where it is no longer what it was when
  /// this run named it first. `name`: as the case has it, since two may end alike. `copy`: where below OUT a copy
  /// belongs, for the resolved case to run again; empty: nowhere.
  void file(const std::filesystem::path& file, const std::string& name, const std::filesystem::path& copy = {});
  /// A case file itself. What it says counts by what is resolved of it; it is listed since no run may overwrite it.
  void case_file(const std::filesystem::path& file, const std::filesystem::path& copy = {});
  /// A case, read to its end. Counts until the fingerprint is asked for.
  void resolved(std::string_view text);

  /// What a table that was read comes to, in words: for `hosel check`. The same text counts once.
  void tell(std::string_view text);
  std::vector<std::string> told() const;
  /// What of it can be meant and is likely not: a run begins with it. The same text counts once.
  void doubt(std::string_view text);
  std::vector<std::string> doubts() const;

  /// Digest of the program, of every case and of every file: what was computed under another one is of another run.
  std::string fingerprint() const;
  /// Throws InputError where a file is no longer what was read.
  void verify() const;
  std::vector<std::filesystem::path> files() const;
  /// Files that the case names and that are not there: measured data of another machine.
  std::vector<std::filesystem::path> missing() const;
  /// Where below OUT copies belong, and of what.
  std::map<std::filesystem::path, std::filesystem::path> copies() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::filesystem::path, std::string> digests_;  // in the order of their names, whichever thread came first
  std::set<std::string> read_;                            // names and digests
  std::vector<std::filesystem::path> cases_;
  std::map<std::filesystem::path, std::filesystem::path> copies_;
  std::vector<std::string> told_, doubts_;
  std::string all_;
  mutable std::string fingerprint_;  // once asked for
};

}  // namespace hosel::app
