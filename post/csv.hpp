#pragma once

#include <string>
#include <string_view>

namespace hosel::post {

/// A text as a cell of RFC 4180: in quotes where it holds a comma, a quote or a line break.
inline std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  return out + '"';
}

}  // namespace hosel::post
