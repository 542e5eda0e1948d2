/// What the command says of itself besides `help`, from its own declarations.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <string_view>

namespace hosel::app {

/// A word that a shell takes as it is: in quotes where it holds anything but letters, digits and a few signs.
std::string shell_word(std::string_view word);
/// A name for another run, as a shell's word: OUT's own and a word behind it, so that it is never OUT itself.
std::string beside_out(const std::filesystem::path& out, std::string_view word);
/// The line that was typed, so that a shell takes it as the same words.
std::string typed(int argc, char** argv);
/// The man page hosel(1), as roff.
std::string man_page(const CLI::App& command);
/// A bash script that completes commands, options, shipped cases and files: `source <(hosel completion)`.
std::string bash_completion(const CLI::App& command);

}  // namespace hosel::app
