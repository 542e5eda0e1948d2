/// Finished points on disk: JSON lines, appended one by one, complete or absent after any kill.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "post/file.hpp"

namespace hosel::app {

/// The entry with a digest of itself, under "check".
nlohmann::json sealed(nlohmann::json entry);
/// What was sealed, without the digest; throws an exception where a bit of the text has changed since.
nlohmann::json unsealed(std::string_view text);

/// Every point found in DIRECTORY/*/points.jsonl, by its number. A last line cut short by a kill is
/// not a point. Throws InputError where a file belongs to another `fingerprint`, where two files
/// disagree about a point, or where one is none of `size`.
std::map<std::size_t, nlohmann::json> read_points(const std::filesystem::path& directory,
                                                  const std::string& fingerprint, std::size_t size);

/// The points file of one shard, held by one process at a time.
class PointStore {
 public:
  /// DIRECTORY/points.jsonl with the whole lines of what stood there, in a new file: another name of the old one keeps
  /// what it had. What a killed process left unfinished beside it is removed. Throws InputError where another process
  /// holds it.
  PointStore(const std::filesystem::path& directory, const std::string& fingerprint);
  PointStore(const PointStore&) = delete;
  PointStore& operator=(const PointStore&) = delete;
  /// On disk when it returns. Thread-safe.
  void append(std::size_t point, double seconds, const nlohmann::json& result);

 private:
  std::unique_ptr<post::GrowingFile> file_;
  std::mutex mutex_;
};

}  // namespace hosel::app
