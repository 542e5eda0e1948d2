#include "post/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace hosel::post {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kUnfinished = ".unfinished";

[[noreturn]] void refuse(const fs::path& file, const char* what) {
  throw std::runtime_error(fmt::format("{}: cannot be {}: {}", file.string(), what, std::strerror(errno)));
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) bytes.remove_prefix(std::size_t(n));
  }
  return true;
}

/// The names in a list of files; none where there is no such file.
std::set<std::string> listed_in(const fs::path& list) {
  std::set<std::string> names;
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(list, ignored))) return names;
  std::istringstream lines(read_file(list));
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) names.insert(line);
  return names;
}

std::string lines_of(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + '\n';
  return text;
}

/// Files written below a watched directory.
struct Watch {
  std::set<fs::path> files;
  std::unique_ptr<GrowingFile> list;
  std::set<std::string> listed;

  void append(const std::string& name) {
    if (list && name.find('\n') == name.npos && listed.insert(name).second) list->append(name + '\n');
  }
};

/// Every watched directory.
struct Watched {
  std::mutex mutex;
  std::map<std::string, Watch> files;

  static Watched& all() {
    static Watched watched;
    return watched;
  }
  static std::string name(const fs::path& path) { return fs::absolute(path).lexically_normal().string(); }
  /// The innermost watch around a file; null where there is none.
  Watch* around(const std::string& file) {
    Watch* found = nullptr;
    std::size_t longest = 0;
    for (auto& [directory, watch] : files)
      if (directory.size() >= longest && file.starts_with(directory)) longest = directory.size(), found = &watch;
    return found;
  }
  void note(const fs::path& file) {
    const std::lock_guard lock(mutex);
    if (files.empty()) return;
    const std::string full = name(file);
    Watch* const innermost = around(full);
    if (!innermost) return;
    innermost->files.insert(full);
    if (!innermost->list) return;
    for (auto& [directory, watch] : files)
      if (full.starts_with(directory)) watch.append(full.substr(directory.size()));
  }
};

/// A name of this process, which no other gives.
fs::path unfinished_in(const fs::path& directory) {
  static std::atomic<unsigned> count = 0;
  return directory / fmt::format("{}-{}{}", ::getpid(), count++, kUnfinished);
}

/// A new file in the directory of FILE.
struct Beside {
  fs::path path;
  int descriptor;
};

Beside open_beside(const fs::path& file) {
  for (;;) {
    Beside b{unfinished_in(file.parent_path()), -1};
    b.descriptor = ::open(b.path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (b.descriptor >= 0) return b;
    if (errno != EEXIST) refuse(file, "written");
  }
}

/// The bytes in a new file under the name of FILE; its descriptor, where it is to stay open.
int written_new(const fs::path& file, std::string_view bytes, bool durable, bool open) {
  const Beside beside = open_beside(file);
  bool good = write_all(beside.descriptor, bytes) && (!durable || ::fsync(beside.descriptor) == 0);
  int reason = errno;
  // What a network's disk refuses it says at the close.
  if ((!good || !open) && ::close(beside.descriptor) != 0 && good) good = false, reason = errno;
  if (good && ::rename(beside.path.c_str(), file.c_str()) != 0) {
    good = false, reason = errno;
    if (open) ::close(beside.descriptor);
  }
  if (good) {
    Watched::all().note(file);
    return beside.descriptor;
  }
  ::unlink(beside.path.c_str());
  errno = reason;
  refuse(file, "written");
}

}  // namespace

void write_file(const fs::path& file, std::string_view bytes, bool durable) {
  written_new(file, bytes, durable, false);
}

GrowingFile::GrowingFile(const fs::path& file, std::string_view beginning, bool durable)
    : file_(file), descriptor_(written_new(file, beginning, durable, true)) {}

GrowingFile::~GrowingFile() { ::close(descriptor_); }

void GrowingFile::append(std::string_view bytes) {
  const off_t before = ::lseek(descriptor_, 0, SEEK_END);
  if (before >= 0 && write_all(descriptor_, bytes)) return;
  const int reason = errno;
  if (::ftruncate(descriptor_, before) != 0) {}  // half a line would damage the one after it
  errno = reason;
  refuse(file_, "written");
}

std::string read_file(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) refuse(file, "read");
  struct stat is {};
  if (::fstat(descriptor, &is) != 0 || !S_ISREG(is.st_mode)) {
    ::close(descriptor);
    throw std::runtime_error(fmt::format("{}: cannot be read: not a regular file", file.string()));
  }
  std::string text;
  std::vector<char> buffer(std::size_t(std::clamp<off_t>(is.st_size + 1, 1 << 12, 1 << 26)));
  for (;;) {
    const ssize_t n = ::read(descriptor, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n > 0) text.append(buffer.data(), std::size_t(n));
    if (n > 0) continue;
    const int reason = errno;
    ::close(descriptor);
    errno = reason;
    if (n < 0) refuse(file, "read");
    return text;
  }
}

fs::path find_program(std::string_view name, const fs::path& outside) {
  const char* path = std::getenv("PATH");
  std::stringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  std::error_code ignored;
  const fs::path around = outside.empty() ? fs::path() : fs::weakly_canonical(outside, ignored);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.starts_with('/')) continue;
    const fs::path program = fs::weakly_canonical(fs::path(folder) / name, ignored);
    if (ignored || !fs::is_regular_file(program, ignored) || ::access(program.c_str(), X_OK) != 0) continue;
    if (!around.empty() && !program.lexically_relative(around).empty() &&
        *program.lexically_relative(around).begin() != "..")
      continue;
    return fs::path(folder) / name;
  }
  return {};
}

WrittenFiles::WrittenFiles(const fs::path& directory, const std::string& list)
    : directory_(Watched::name(directory / "")) {
  Watch watch;
  if (!list.empty()) {
    list_ = directory / list;
    watch.listed = listed_in(list_);
    watch.list = std::make_unique<GrowingFile>(list_, lines_of(watch.listed));
  }
  const std::lock_guard lock(Watched::all().mutex);
  Watched::all().files[directory_] = std::move(watch);
}

WrittenFiles::~WrittenFiles() {
  const std::lock_guard lock(Watched::all().mutex);
  Watched::all().files.erase(directory_);
}

fs::path WrittenFiles::missing() const {
  const std::lock_guard lock(Watched::all().mutex);
  for (const fs::path& file : Watched::all().files.at(directory_).files)
    if (!fs::is_regular_file(fs::symlink_status(file))) return file;
  return {};
}

void WrittenFiles::close_list() {
  std::set<std::string> names;
  {
    const std::lock_guard lock(Watched::all().mutex);
    Watch& watch = Watched::all().files.at(directory_);
    names = watch.listed;
    watch.list.reset();
  }
  std::erase_if(names, [&](const std::string& name) {
    return !fs::is_regular_file(fs::symlink_status(list_.parent_path() / name));
  });
  write_file(list_, lines_of(names));
}

void remove_listed(const fs::path& directory, const std::string& list, const std::set<fs::path>& stay) {
  std::error_code error;
  const fs::path home = fs::weakly_canonical(directory, error);
  std::set<std::string> stayed;
  for (const std::string& line : listed_in(directory / list)) {
    const fs::path name(line);
    // Whoever sends a folder may have written its list: names elsewhere, and links to there, are not followed.
    if (name.is_absolute() || std::ranges::find(name, "..") != name.end()) continue;
    if (stay.contains(*name.begin())) {
      stayed.insert(line);
      continue;
    }
    const fs::path folder = (home / name).parent_path();
    if (fs::weakly_canonical(folder, error) != folder || error) continue;
    if (!fs::is_regular_file(fs::symlink_status(home / name, error)) || !fs::remove(home / name, error)) continue;
    for (fs::path empty = folder; empty != home && fs::is_empty(empty, error) && fs::remove(empty, error);)
      empty = empty.parent_path();
  }
  if (stayed.empty()) fs::remove(directory / list, error);
  else write_file(directory / list, lines_of(stayed));
}

void move_file(const fs::path& from, const fs::path& to) {
  if (!fs::is_regular_file(fs::symlink_status(from)))
    throw std::runtime_error(fmt::format("{}: was not made", to.string()));
  if (::rename(from.c_str(), to.c_str()) != 0) refuse(to, "written");
  Watched::all().note(to);
}

void remove_file(const fs::path& file) {
  fs::remove(file);
  const std::lock_guard lock(Watched::all().mutex);
  const std::string full = Watched::name(file);
  if (Watch* const watch = Watched::all().around(full)) watch->files.erase(full);
}

void remove_unfinished(const fs::path& directory) {
  std::error_code ignored;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    if (entry.path().extension() == kUnfinished) found.push_back(entry.path());
  for (const fs::path& file : found) fs::remove_all(file, ignored);
}

WorkFolder::WorkFolder(const fs::path& directory) {
  do path_ = unfinished_in(directory);
  while (!fs::create_directory(path_));
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string digest(std::string_view text) {
  boost::uuids::name_generator_sha1 name(boost::uuids::ns::oid());
  return to_string(name(text.data(), text.size()));
}

}  // namespace hosel::post
