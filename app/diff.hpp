/// Two finished runs side by side.
#pragma once

#include <filesystem>
#include <string>

namespace hosel::app {

/// Inputs that differ, launches that differ (with what of it is within the models' numerical error), and how many other
/// numbers do, as text. Throws InputError where a directory holds no finished run.
std::string difference(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace hosel::app
