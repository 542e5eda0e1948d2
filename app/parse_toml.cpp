#include "app/parse_toml.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/reader.hpp"

namespace hosel::app {

void limit_dots(std::string_view text, const std::string& file) {
  // Shipped cases have 200. A copied or destroyed tree calls itself at every level.
  constexpr auto most_dots = 10'000;
  if (std::ranges::count(text, '.') > most_dots)
    throw InputError(fmt::format("{}: more than {} dots: this is no case; a table of numbers belongs into a CSV file",
                                 file, most_dots));
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  limit_dots(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: not valid TOML: {}", file, error.source().begin.line, std::string(error.description())));
  }
}

}  // namespace hosel::app
