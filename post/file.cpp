#include "hosel/post/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
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

}  // namespace

void write_file(const fs::path& file, std::string_view bytes, bool durable) {
  static std::atomic<unsigned> count = 0;
  const fs::path beside = fmt::format("{}.{}-{}{}", file.string(), ::getpid(), count++, kUnfinished);
  const int descriptor = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) refuse(file, "written");
  const bool good = write_all(descriptor, bytes) && (!durable || ::fsync(descriptor) == 0);
  const int reason = errno;
  if ((::close(descriptor) != 0 || !good) || ::rename(beside.c_str(), file.c_str()) != 0) {
    if (!good) errno = reason;
    const int kept = errno;
    ::unlink(beside.c_str());
    errno = kept;
    refuse(file, "written");
  }
}

std::string read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file)) refuse(file, "read");
  return {std::istreambuf_iterator<char>(in), {}};
}

void remove_unfinished(const fs::path& directory) {
  std::error_code ignored;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    if (entry.path().extension() == kUnfinished) found.push_back(entry.path());
  for (const fs::path& file : found) fs::remove(file, ignored);
}

std::string digest(std::string_view text) {
  boost::uuids::name_generator_sha1 name(boost::uuids::ns::oid());
  return to_string(name(text.data(), text.size()));
}

}  // namespace hosel::post
