#include "app/paraview.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "app/command_help.hpp"
#include "app/reader.hpp"
#include "app/shipped.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace fs = std::filesystem;

void open_in_paraview(const fs::path& out) {
  if (!fs::is_directory(out)) throw InputError(fmt::format("{}: no such directory", out.string()));
  std::vector<std::string> folders;
  for (const auto& entry : fs::recursive_directory_iterator(out))
    if (entry.path().extension() == ".pvd" &&
        std::ranges::find(folders, entry.path().parent_path().string()) == folders.end())
      folders.push_back(entry.path().parent_path().string());
  std::ranges::sort(folders);
  if (folders.empty())
    throw InputError(fmt::format("{}: no series for ParaView (vtk/*.pvd) in this run", out.string()));
  const fs::path program = post::find_program("paraview", out);
  if (program.empty()) throw InputError("ParaView is not installed (Debian: apt-get install paraview)");
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) {
    // Each kind of run has a script that draws without a screen, by the series that it is about.
    for (const auto& [series, maker] : {std::pair{"ball", "impact"}, {"face", "face"}, {"shaft", "swing"}}) {
      const auto found = std::ranges::find_if(
          folders, [&](const auto& f) { return fs::exists(fs::path(f) / (std::string(series) + ".pvd")); });
      if (found != folders.end())
        throw InputError(
            fmt::format("there is no screen here; without one: scripts/pvbatch post/paraview/{0}.py {1} {0}.png", maker,
                        shell_word(*found)));
    }
    throw InputError("there is no screen here; the figures beside report.html need none");
  }
  fmt::print("{}\n", fmt::join(folders, "\n"));
  std::fflush(stdout);
  setenv("HOSEL_VTK", fmt::format("{}", fmt::join(folders, "\n")).c_str(), 1);
  const std::string argument = "--script=" + shipped("post/paraview/open.py", "paraview/open.py").string();
  execl(program.c_str(), program.c_str(), argument.c_str(), static_cast<char*>(nullptr));
  throw std::runtime_error("ParaView could not be started");
}

}  // namespace hosel::app
