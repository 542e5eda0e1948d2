/// One process at a time in a directory.
#pragma once

#include <filesystem>

namespace hosel::app {

/// Holds DIRECTORY as long as it lives; the system lets go of it when the process ends, however it ends.
class DirectoryLock {
 public:
  /// Throws InputError that names the owner where another process holds the directory.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace hosel::app
