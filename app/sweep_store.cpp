#include "app/sweep_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/reader.hpp"
#include "app/version.hpp"
#include "post/file.hpp"
#include "post/parse_json.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
nlohmann::json sealed(nlohmann::json entry) {
  entry["check"] = post::digest(entry.dump());
  return entry;
}

nlohmann::json unsealed(std::string_view text) {
  nlohmann::json entry = post::parse_json(text);
  const std::string check = entry.at("check");
  entry.erase("check");
  if (check != post::digest(entry.dump())) throw std::runtime_error("damaged");
  return entry;
}

std::map<std::size_t, nlohmann::json> read_points(const fs::path& directory, const std::string& fingerprint,
                                                  std::size_t size) {
  std::map<std::size_t, nlohmann::json> points;
  if (!fs::is_directory(directory)) return points;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(directory))
    if (fs::is_regular_file(entry.path() / "points.jsonl")) files.push_back(entry.path() / "points.jsonl");
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const std::string text = post::read_file(file);
    std::size_t at = 0;
    for (int line = 1;; ++line) {
      const std::size_t end = text.find('\n', at);
      if (end == std::string::npos) break;  // cut short by a kill, or the end
      nlohmann::json entry;
      try {
        entry = unsealed(std::string_view(text).substr(at, end - at));
        if (line == 1) {
          if (entry.at("fingerprint") != fingerprint)
            throw InputError(
                fmt::format("{}: holds points of another case or another version of the program; "
                            "start a new directory, or discard them with --force",
                            file.string()));
        } else {
          const std::size_t number = entry.at("point");
          const nlohmann::json& result = entry.at("result");
          if (!entry["point"].is_number_unsigned() || number >= size || !result.is_object() ||
              (result.contains("error") && !result["error"].is_string()))
            throw std::out_of_range("point");
          const auto [it, fresh] = points.emplace(number, result);
          if (!fresh && it->second != result)
            throw InputError(fmt::format("{}:{}: point {} has two different results", file.string(), line, number));
        }
      } catch (const InputError&) { throw; } catch (const std::exception&) {
        throw InputError(
            fmt::format("{}:{}: not a finished point, or damaged since it was written: remove this line, "
                        "or discard all points with --force",
                        file.string(), line));
      }
      at = end + 1;
    }
  }
  return points;
}

namespace {

[[noreturn]] void held(const fs::path& file) {
  throw InputError(fmt::format("{}: another process is computing this shard", file.string()));
}

}  // namespace

PointStore::PointStore(const fs::path& directory, const std::string& fingerprint) {
  const fs::path file = directory / "points.jsonl";
  std::string whole;
  const int old = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  try {
    if (old < 0 && errno != ENOENT)
      throw std::runtime_error(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    if (old >= 0) {
      if (::flock(old, LOCK_EX | LOCK_NB) != 0) held(file);
      const std::string text = post::read_file(file);
      const std::size_t last = text.rfind('\n');
      whole = text.substr(0, last == std::string::npos ? 0 : last + 1);
    }
    if (whole.empty()) whole = sealed({{"fingerprint", fingerprint}, {"version", program_version()}}).dump() + '\n';
    file_ = std::make_unique<post::GrowingFile>(file, whole, true);
    if (::flock(file_->descriptor(), LOCK_EX | LOCK_NB) != 0) held(file);
    post::remove_unfinished(directory);
  } catch (...) {
    if (old >= 0) ::close(old);
    throw;
  }
  if (old >= 0) ::close(old);
}

void PointStore::append(std::size_t point, double seconds, const nlohmann::json& result) {
  const std::string line = sealed({{"point", point}, {"seconds", seconds}, {"result", result}}).dump() + '\n';
  const std::lock_guard lock(mutex_);
  file_->append(line);
}

}  // namespace hosel::app
