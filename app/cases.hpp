/// Shipped cases, by name; and what `hosel list` shows.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace hosel::app {

/// The path of a case: itself where it exists, else the shipped case of this name. Throws InputError
/// with the nearest name.
std::filesystem::path find_case(const std::string& named);
/// A new case directory with the files of another; refuses to touch an existing one.
void copy_case(const std::string& from, const std::filesystem::path& to);

/// Names and titles of the shipped cases.
std::vector<std::pair<std::string, std::string>> shipped_cases();

struct ListSection {
  std::string title;
  std::vector<std::pair<std::string, std::string>> entries;
};
/// Kinds, models, materials, balls, shafts, effects, cases.
std::vector<ListSection> everything();

}  // namespace hosel::app
