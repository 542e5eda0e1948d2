/// Files that are whole or not there, whatever is killed and whatever disk is full.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hosel::post {

/// Replaces FILE: written beside it under a name of this process, renamed when complete. `durable` waits for the disk
/// before the rename, so that not even a loss of power leaves half a file. Throws std::runtime_error with the
/// system's reason; what stood in FILE is then untouched.
void write_file(const std::filesystem::path& file, std::string_view bytes, bool durable = true);

/// The whole of FILE. Throws std::runtime_error where it cannot be read.
std::string read_file(const std::filesystem::path& file);

/// What a killed process left of files it was writing in DIRECTORY. To be called by whoever holds it alone.
void remove_unfinished(const std::filesystem::path& directory);

/// Name-based UUID (SHA-1) of a text: tells damage and change, keeps no secret.
std::string digest(std::string_view text);

}  // namespace hosel::post
