#include "app/cases.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/job.hpp"
#include "app/library.hpp"
#include "app/parse_toml.hpp"
#include "app/read_solid.hpp"
#include "app/reader.hpp"
#include "build_info.hpp"
#include "golf/shaft_library.hpp"
#include "loop/effect.hpp"
#include "models/flight/flight_laws.hpp"
#include "models/registry.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

/// The tree's cases first (a build in its checkout), then the installed ones.
std::vector<fs::path> case_homes() { return {fs::path(HOSEL_SOURCE_DIR) / "cases", fs::path(HOSEL_INSTALLED_CASES)}; }

}  // namespace

std::vector<std::pair<std::string, std::string>> shipped_cases() {
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

fs::path find_case(const std::string& named) {
  // A folder here that is no case (a run's, say, called after its case) hides no shipped one.
  const bool folder = fs::is_directory(named);
  if (folder ? fs::exists(fs::path(named) / "case.toml") : fs::exists(named)) return named;
  for (const fs::path& home : case_homes())
    if (fs::is_regular_file(home / named / "case.toml")) return home / named;
  if (folder) throw InputError(fmt::format("{}: holds no case.toml", named));
  std::vector<std::string> names;
  for (const auto& [name, title] : shipped_cases()) names.push_back(name);
  // `cases/iron7-trackman` is where a shipped case lies in a checkout; its name works everywhere.
  if (const std::string last = fs::path(named).lexically_normal().filename().string();
      std::ranges::find(names, last) != names.end())
    throw InputError(fmt::format("{}: no such directory here; the shipped case is called '{}'", named, last));
  throw InputError(
      fmt::format("{}: no such case{}", named, or_nearest(named, names, "; `hosel list` shows the shipped ones")));
}

namespace {

/// Every text of a case, wherever it stands.
void texts(const toml::node& node, std::vector<std::string>& out) {
  if (const auto* text = node.as_string()) out.push_back(text->get());
  if (const auto* table = node.as_table())
    for (auto&& [key, value] : *table) texts(value, out);
  if (const auto* list = node.as_array())
    for (const toml::node& value : *list) texts(value, out);
}

}  // namespace

void copy_case(const std::string& from, const fs::path& to) {
  const fs::path found = find_case(from), source = fs::is_directory(found) ? found : found.parent_path();
  if (fs::exists(to)) throw InputError(fmt::format("{}: is there already", to.string()));
  const fs::path inside = fs::weakly_canonical(to).lexically_relative(fs::canonical(source.empty() ? "." : source));
  if (!inside.empty() && *inside.begin() != "..")
    throw InputError(fmt::format("{}: lies in what is copied, {}", to.string(), from));
  std::string text = post::read_file(fs::is_directory(found) ? found / "case.toml" : found);
  std::vector<std::string> all;
  try {
    texts(parse_toml(text, found.string()), all);
  } catch (const InputError&) {}  // copied as it is: whoever runs it is told
  fs::create_directories(to);
  std::error_code error;
  fs::copy(source.empty() ? "." : source, to, fs::copy_options::recursive, error);
  if (error) {  // a link in it that leads back, a disk that is full
    fs::remove_all(to);
    throw InputError(fmt::format("{}: cannot be copied to {}: {}", from, to.string(), error.message()));
  }
  // Text and pictures of the old case say nothing of the new one.
  std::vector<fs::path> told;
  for (const auto& entry : fs::directory_iterator(to))
    if (fs::is_regular_file(entry.symlink_status()) &&
        (entry.path().filename() == "README.md" || entry.path().extension() == ".png"))
      told.push_back(entry.path());
  for (const fs::path& file : told) fs::remove(file);
  // A file that lies beside the old case comes along; another case is named from the new one.
  for (const std::string& name : all) {
    const fs::path path = name;
    if (path.is_absolute() || name.find('/') == std::string::npos || !fs::exists(source / path)) continue;
    if (fs::exists(to / path) && fs::equivalent(to / path, source / path)) continue;
    if (*path.lexically_normal().begin() != "..") continue;  // copied with the case
    std::string moved = fs::proximate(fs::canonical(source / path), fs::canonical(to)).string();
    if (const fs::path own = path.filename();
        fs::is_regular_file(source / path) && own.extension() != ".toml" && !fs::exists(to / own)) {
      fs::copy_file(source / path, to / own);
      moved = own.string();
    }
    for (const char quote : {'"', '\''})
      for (std::size_t at = 0; (at = text.find(quote + name + quote, at)) != std::string::npos; at += moved.size())
        text.replace(at + 1, name.size(), moved);
  }
  post::write_file(to / "case.toml", text);
}

std::vector<ListSection> everything() {
  const auto entries = [](const auto& named) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& n : named) out.emplace_back(n.name, n.what);
    return out;
  };
  const auto shelved = [](Shelf shelf) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const LibraryEntry& e : library(shelf))
      out.emplace_back(e.name, e.shipped ? e.what : fmt::format("{} ({})", e.what, e.file.string()));
    return out;
  };
  const auto acting = [](auto on) {
    std::vector<loop::EffectEntry> out;
    std::ranges::copy_if(loop::effects(), std::back_inserter(out), [&](const auto& e) { return e.*on != nullptr; });
    return out;
  };
  std::vector<ListSection> all = {
      {"kinds", entries(kinds())},
      {"models", entries(models::registry())},
      {"materials (law), each with branch_moduli_MPa and branch_times_ms", entries(solid_laws())},
      {"balls (ball.model)", shelved(Shelf::balls)},
      {"heads (head.name)", shelved(Shelf::heads)},
      {"flight laws (flight.law)", entries(models::flight_laws())},
      {"faces that deflect (face.name)", shelved(Shelf::faces)},
      {"contacts (contact.name)", shelved(Shelf::contacts)},
      {"shafts (shaft.name)", entries(shaft_library())},
      {"effects on shots", entries(acting(&loop::EffectEntry::on_shots))},
      {"effects on histories", entries(acting(&loop::EffectEntry::on_tests))},
      {"cases", shipped_cases()}};
  std::erase_if(all, [](const ListSection& s) { return s.entries.empty(); });
  return all;
}

}  // namespace hosel::app
