/// What was made of a file, kept while the file is the same: a study asks for the same files at every point.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>

namespace hosel::app {

/// From any thread. A file or folder counts as the same while its size and its time of writing are. One that was
/// written within the last second, or is not there, is not kept: a change in the same tick of the file system's clock
/// would not be seen.
template <class Made>
class OfFile {
 public:
  /// `make`: called without arguments where nothing is kept.
  template <class Make>
  Made get(const std::filesystem::path& file, Make&& make) {
    namespace fs = std::filesystem;
    std::error_code none;
    Stamp stamp{fs::last_write_time(file, none), 0};
    if (none) return make();
    stamp.size = fs::file_size(file, none);  // of a folder: an error, and any number
    if (none) stamp.size = 0;
    {
      const std::lock_guard lock(mutex_);
      if (const auto it = kept_.find(file); it != kept_.end() && it->second.first == stamp) return it->second.second;
    }
    Made made = make();
    if (fs::file_time_type::clock::now() - stamp.written > std::chrono::seconds(1)) {
      const std::lock_guard lock(mutex_);
      kept_.insert_or_assign(file, std::pair{stamp, made});
    }
    return made;
  }

 private:
  struct Stamp {
    std::filesystem::file_time_type written;
    std::uintmax_t size;
    bool operator==(const Stamp&) const = default;
  };
  std::mutex mutex_;
  std::map<std::filesystem::path, std::pair<Stamp, Made>> kept_;
};

}  // namespace hosel::app
