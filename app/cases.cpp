#include "hosel/app/cases.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "build_info.hpp"
#include "hosel/app/job.hpp"
#include "hosel/app/read_solid.hpp"
#include "hosel/app/reader.hpp"
#include "hosel/golf/face_library.hpp"
#include "hosel/golf/shaft_library.hpp"
#include "hosel/loop/effect.hpp"
#include "hosel/loop/history/rig.hpp"
#include "hosel/models/registry.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

/// The tree's cases first (a build in its checkout), then the installed ones.
std::vector<fs::path> case_homes() { return {fs::path(HOSEL_SOURCE_DIR) / "cases", fs::path(HOSEL_INSTALLED_CASES)}; }

std::vector<std::pair<std::string, std::string>> shipped() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const fs::path& home : case_homes()) {
    if (!fs::is_directory(home)) continue;
    for (const auto& entry : fs::directory_iterator(home)) {
      if (!fs::is_regular_file(entry.path() / "case.toml")) continue;
      std::string title;
      try {
        title = CaseFile(entry.path()).root().text("title", "");
      } catch (const InputError& error) { title = fmt::format("(unreadable: {})", error.what()); }
      out.emplace_back(entry.path().filename().string(), title);
    }
    if (!out.empty()) break;
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace

fs::path find_case(const std::string& named) {
  if (fs::exists(named)) return named;
  for (const fs::path& home : case_homes())
    if (fs::is_regular_file(home / named / "case.toml")) return home / named;
  std::vector<std::string> names;
  for (const auto& [name, title] : shipped()) names.push_back(name);
  const std::string near = nearest(named, names);
  throw InputError(
      fmt::format("{}: no such case{}", named,
                  near.empty() ? "; `hosel list` shows the shipped ones" : "; did you mean '" + near + "'?"));
}

void copy_case(const std::string& from, const fs::path& to) {
  const fs::path source = find_case(from);
  if (fs::exists(to)) throw InputError(fmt::format("{}: is there already", to.string()));
  fs::create_directories(to);
  fs::copy(fs::is_directory(source) ? source : source.parent_path(), to, fs::copy_options::recursive);
}

std::vector<ListSection> everything() {
  const auto entries = [](const auto& named) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& n : named) out.emplace_back(n.name, n.what);
    return out;
  };
  return {{"kinds", entries(kinds())},
          {"models", entries(models::registry())},
          {"materials (law), each with branch_moduli_MPa and branch_times_ms", entries(solid_laws())},
          {"balls (ball.model)", entries(models::ball_library())},
          {"faces that yield (face.name)", entries(face_library())},
          {"shafts (shaft.name)", entries(shaft_library())},
          {"effects on shots", entries(loop::effects())},
          {"effects on histories", entries(loop::history_effects())},
          {"cases", shipped()}};
}

}  // namespace hosel::app
