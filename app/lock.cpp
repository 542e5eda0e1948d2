#include "hosel/app/lock.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "hosel/app/reader.hpp"
#include "hosel/post/file.hpp"

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

DirectoryLock::DirectoryLock(const fs::path& directory) {
  refuse_links(directory);
  const fs::path file = directory / ".lock";
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor_ < 0)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor_);
    const std::string name = post::read_file(file);
    throw InputError(fmt::format("{}: another run is at work here ({}); wait for it, or name another --out",
                                 directory.string(), name.empty() ? "of an unknown process" : name));
  }
  const std::string name = owner();
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, name.data(), name.size(), 0) != ssize_t(name.size())) {
    ::close(descriptor_);
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  }
}

DirectoryLock::~DirectoryLock() { ::close(descriptor_); }

}  // namespace hosel::app
