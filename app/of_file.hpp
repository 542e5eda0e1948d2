/// What was made of a file, kept while the file is the same: a study asks for the same files at every point.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <system_error>

namespace hosel::app {

/// While one lives, no file of an `OfFile` that is `once_a_study` is looked at a second time: all points see the same,
/// and a point does not ask the file system. From any thread.
class StudyFiles {
 public:
  StudyFiles() {
    if (alive_++ == 0) ++number_;
  }
  ~StudyFiles() { --alive_; }
  StudyFiles(const StudyFiles&) = delete;
  StudyFiles& operator=(const StudyFiles&) = delete;

  /// The number of the studies that are at work together, from 1; 0: there is none.
  static unsigned long now() { return alive_ > 0 ? number_.load() : 0; }

 private:
  inline static std::atomic<int> alive_ = 0;
  inline static std::atomic<unsigned long> number_ = 0;
};

/// From any thread. A file or folder counts as the same while its size and its time of writing are. One that was
/// written within the last second, or is not there, is not kept: a change in the same tick of the file system's clock
/// would not be seen.
template <class Made>
class OfFile {
 public:
  explicit OfFile(bool once_a_study = false) : once_a_study_(once_a_study) {}

  /// `make`: called without arguments where nothing is kept.
  template <class Make>
  Made get(const std::filesystem::path& file, Make&& make) {
    namespace fs = std::filesystem;
    const unsigned long once = once_a_study_ ? StudyFiles::now() : 0;
    if (once) {
      const std::lock_guard lock(mutex_);
      if (const auto it = kept_.find(file.native()); it != kept_.end() && it->second.once == once)
        return it->second.made;
    }
    std::error_code none;
    Stamp stamp{fs::last_write_time(file, none), 0};
    bool stands = !none;
    if (stands) {
      stamp.size = fs::file_size(file, none);  // of a folder: an error, and any number
      if (none) stamp.size = 0;
      const std::lock_guard lock(mutex_);
      if (const auto it = kept_.find(file.native());
          it != kept_.end() && it->second.stands && it->second.stamp == stamp) {
        it->second.once = once;
        return it->second.made;
      }
    }
    Made made = make();
    stands = stands && fs::file_time_type::clock::now() - stamp.written > std::chrono::seconds(1);
    if (stands || once) {
      const std::lock_guard lock(mutex_);
      kept_.insert_or_assign(file.native(), Kept{stamp, stands, once, made});
    }
    return made;
  }

 private:
  struct Stamp {
    std::filesystem::file_time_type written;
    std::uintmax_t size;
    bool operator==(const Stamp&) const = default;
  };
  struct Kept {
    Stamp stamp;
    bool stands;         // the stamp tells a change
    unsigned long once;  // the studies for which it was looked at
    Made made;
  };
  bool once_a_study_;
  std::mutex mutex_;
  std::map<std::string, Kept> kept_;  // by name: paths are compared part by part
};

}  // namespace hosel::app
