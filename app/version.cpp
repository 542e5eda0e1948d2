#include "hosel/app/version.hpp"

#include <fmt/format.h>

#include "build_info.hpp"
#include "hosel/post/file.hpp"

namespace hosel::app {

std::string program_version() {
  static const std::string version =
      fmt::format("{} build {}", HOSEL_VERSION, post::digest(post::read_file("/proc/self/exe")));
  return version;
}

}  // namespace hosel::app
