#include "hosel/app/sweep_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "hosel/app/reader.hpp"
#include "hosel/app/version.hpp"
#include "hosel/post/file.hpp"
#include "hosel/post/parse_json.hpp"

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

std::string digest_of_files(const std::vector<fs::path>& files) {
  std::string all;
  for (const fs::path& file : files)
    all += file.filename().string() + '\n' +
           (fs::is_regular_file(file) ? post::digest(post::read_file(file)) : "none") + '\n';
  return post::digest(all);
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

PointStore::PointStore(const fs::path& directory, const std::string& fingerprint)
    : file_((directory / "points.jsonl").string()),
      descriptor_(::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644)) {
  if (descriptor_ < 0) throw std::runtime_error(fmt::format("{}: cannot be written", file_));
  try {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
      throw InputError(fmt::format("{}: another process is computing this shard", file_));
    const std::string text = post::read_file(file_);
    const std::size_t last = text.rfind('\n');
    const std::size_t whole = last == std::string::npos ? 0 : last + 1;
    if (::ftruncate(descriptor_, off_t(whole)) != 0 || ::lseek(descriptor_, 0, SEEK_END) < 0)
      throw std::runtime_error(fmt::format("{}: cannot be written", file_));
    if (whole == 0) write_line(sealed({{"fingerprint", fingerprint}, {"version", program_version()}}).dump());
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

PointStore::~PointStore() { ::close(descriptor_); }

void PointStore::append(std::size_t point, double seconds, const nlohmann::json& result) {
  const std::string line = sealed({{"point", point}, {"seconds", seconds}, {"result", result}}).dump();
  const std::lock_guard lock(mutex_);
  write_line(line);
}

void PointStore::write_line(const std::string& line) {
  // One write a line: a kill leaves it whole or cuts the last one short, and that is seen by its end.
  const std::string text = line + "\n";
  const off_t before = ::lseek(descriptor_, 0, SEEK_END);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(descriptor_, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int reason = errno;
      if (::ftruncate(descriptor_, before) != 0) {}  // half a line would damage the one after it
      throw std::runtime_error(fmt::format("{}: cannot be written: {}", file_, std::strerror(reason)));
    }
    done += std::size_t(n);
  }
}

}  // namespace hosel::app
