/// Files that come with the command.
#pragma once

#include <filesystem>

namespace hosel::app {

/// A file or folder of the checkout that the command was built in, by its path there; where the checkout is gone, as it
/// is installed below the data folder.
std::filesystem::path shipped(const std::filesystem::path& in_checkout, const std::filesystem::path& installed);

}  // namespace hosel::app
