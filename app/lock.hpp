/// One process at a time in a directory, and nothing in it that lies elsewhere.
#pragma once

#include <filesystem>

namespace hosel::app {

/// Throws InputError where anything below DIRECTORY, which need not be there, is a link: what a case brought along as
/// its OUT would be written, and emptied, wherever it points. DIRECTORY itself may be one: a person named it.
void refuse_links(const std::filesystem::path& directory);

/// Holds DIRECTORY as long as it lives; the system lets go of it when the process ends, however it ends.
class DirectoryLock {
 public:
  /// Throws InputError that names the owner where another process holds the directory, or where it has links in it.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;
  /// Throws std::runtime_error where the directory is no longer the one that is held: renamed, removed, or another's.
  void verify() const;

 private:
  std::filesystem::path directory_;
  int descriptor_;
};

}  // namespace hosel::app
