/// TOML that somebody else may have written.
#pragma once

#include <toml++/toml.h>
#include <string>
#include <string_view>

namespace hosel::app {

/// Throws InputError with `file` where a text has more dots than any case: each may open a table in another one, and a
/// stack is not deep enough for a hundred thousand.
void limit_dots(std::string_view text, const std::string& file);

/// Throws InputError with `file`, the line and what is wrong there.
toml::table parse_toml(std::string_view text, const std::string& file);

}  // namespace hosel::app
