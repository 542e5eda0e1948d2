#include "app/lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <stdexcept>

#include "app/reader.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

std::string owner() {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  return fmt::format("process {} on {} since {:%Y-%m-%d %H:%M:%S}", ::getpid(), host,
                     fmt::localtime(std::time(nullptr)));
}

}  // namespace

void refuse_links(const fs::path& directory) {
  std::error_code error;
  // Where another shard is at work, directories come and go: looked through again.
  for (int tries = 0; tries < 100 && fs::exists(directory); ++tries) {
    fs::recursive_directory_iterator it(directory, error), end;
    for (; !error && it != end; it.increment(error))
      if (it->is_symlink())
        throw InputError(fmt::format("{}: a link, to what may not be this run's; remove it, or name another --out",
                                     it->path().string()));
    if (!error) return;
    if (error != std::errc::no_such_file_or_directory) break;
  }
  if (error) throw InputError(fmt::format("{}: cannot be looked through: {}", directory.string(), error.message()));
}

namespace {

/// The status of what DESCRIPTOR holds, where FILE is its name.
std::optional<struct stat> held_as(const fs::path& file, int descriptor) {
  struct stat named {
  }, held{};
  const bool same = ::lstat(file.c_str(), &named) == 0 && ::fstat(descriptor, &held) == 0 &&
                    named.st_dev == held.st_dev && named.st_ino == held.st_ino && S_ISREG(held.st_mode);
  return same ? std::optional(held) : std::nullopt;
}

}  // namespace

DirectoryLock::DirectoryLock(const fs::path& directory) : directory_(fs::absolute(directory)) {
  refuse_links(directory);
  const fs::path file = directory / ".lock";
  const auto fail = [&] {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  };
  // A file with another name (a hard link) is not this run's to write: whoever holds it puts a new one in its place.
  for (int tries = 0; tries < 100; ++tries) {
    if (const auto status = fs::symlink_status(file); fs::exists(status) && !fs::is_regular_file(status))
      throw InputError(fmt::format("{}: no regular file; remove it, or name another --out", file.string()));
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
    if (descriptor_ < 0) fail();
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      ::close(descriptor_);
      const std::string name = post::read_file(file);
      throw InputError(fmt::format("{}: another run is at work here ({}); wait for it, or name another --out",
                                   directory.string(), name.empty() ? "of an unknown process" : name));
    }
    const auto held = held_as(file, descriptor_);
    if (held && held->st_nlink == 1) {
      const std::string name = owner();
      if (::ftruncate(descriptor_, 0) == 0 &&
          ::pwrite(descriptor_, name.data(), name.size(), 0) == ssize_t(name.size()))
        return;
      const int reason = errno;
      ::close(descriptor_);
      errno = reason;
      fail();
    }
    if (held) post::write_file(file, "", false);
    ::close(descriptor_);
  }
  throw std::runtime_error(fmt::format("{}: cannot be locked", file.string()));
}

DirectoryLock::~DirectoryLock() { ::close(descriptor_); }

void DirectoryLock::verify() const {
  if (!held_as(directory_ / ".lock", descriptor_))
    throw std::runtime_error(
        fmt::format("{}: was renamed or removed while this run was at work in it", directory_.string()));
}

}  // namespace hosel::app
