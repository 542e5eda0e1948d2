/// Two finished runs side by side.
#pragma once

#include <filesystem>
#include <string>

namespace hosel::app {

/// Inputs that differ, files in `inputs/` of other content, launches that differ (with what of it is within the models'
/// numerical error), and how many other numbers do, as text. Throws InputError where a directory holds no finished run
/// or a file cannot be read.
std::string difference(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace hosel::app
