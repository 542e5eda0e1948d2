#include "app/version.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "build_info.hpp"
#include "post/file.hpp"

namespace hosel::app {

std::string program_version() {
  // Inside Python the program is the module, not the interpreter.
  static const std::string file = [] {
    Dl_info here{};
    const bool found = dladdr(reinterpret_cast<const void*>(&program_version), &here) != 0 && here.dli_fname;
    return std::string(found && std::string_view(here.dli_fname).ends_with(".so") ? here.dli_fname : "/proc/self/exe");
  }();
  static const std::string version = fmt::format("{} build {}", HOSEL_VERSION, post::digest(post::read_file(file)));
  return version;
}

}  // namespace hosel::app
