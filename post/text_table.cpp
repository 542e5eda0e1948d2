#include "post/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "post/html.hpp"
#include "post/labels.hpp"

namespace hosel::post {
namespace {

/// A column with longer cells is not squeezed on a narrow page.
constexpr std::size_t kSentence = 30;

/// A key as people read it; a row's name without underscores; anything else as it stands.
std::string in_words(const std::string& cell, bool name) {
  const bool key = cell.size() > 3 && cell.find('_') != cell.npos &&
                   cell.find_first_not_of("abcdefghijklmnopqrstuvwxyzN0123456789_") == cell.npos;
  return key ? label(cell) : name ? spoken(cell) : cell;
}

}  // namespace

std::string TextTable::text() const {
  std::vector<std::size_t> width;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()), least_width);
    for (std::size_t c = 1; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size() + 2);
  }
  std::size_t first = first_width;
  for (const auto& row : rows)
    if (margin) first = std::max(first, row[0].size() + margin);
  if (even && !width.empty()) std::ranges::fill(width, std::ranges::max(width));
  std::string out;
  for (const auto& row : rows) {
    if (&row != rows.data()) out += '\n';
    out += fmt::format("{:<{}}", row[0], first);
    for (std::size_t c = 1; c < row.size(); ++c) out += fmt::format("{:>{}}", row[c], width[c]);
  }
  return out;
}

std::string TextTable::html() const {
  std::vector<std::vector<std::string>> shown = rows;
  for (auto& row : shown)
    for (std::string& cell : row) cell = in_words(cell, &cell == row.data());
  const std::size_t columns = rows.front().size();
  if (columns > 6 && columns > rows.size()) {
    shown.assign(columns, std::vector<std::string>(rows.size()));
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = 0; c < rows[r].size(); ++c) shown[c][r] = in_words(rows[r][c], c == 0);
  }
  // A column of words reads from the left, one of numbers stands by its last digit.
  std::vector<std::size_t> longest(shown.front().size());
  std::vector<bool> words(longest.size());
  for (auto row = shown.begin() + 1; row != shown.end(); ++row)
    for (std::size_t c = 0; c < row->size(); ++c) {
      const std::string& cell = (*row)[c];
      words[c] = words[c] || (!cell.empty() && std::isalpha(static_cast<unsigned char>(cell.front())));
      longest[c] = std::max(longest[c], cell.size());
    }
  std::string out = "<div class='scroll'><table>";
  for (std::size_t r = 0; r < shown.size(); ++r) {
    out += "<tr>";
    for (std::size_t c = 0; c < shown[r].size(); ++c) {
      std::string& cell = shown[r][c];
      if (const auto sign = cell.find("+-"); sign != cell.npos) cell.replace(sign, 2, "±");
      const char* kind = c == 0 || !words[c] ? "" : longest[c] > kSentence ? " class='l long'" : " class='l'";
      out += fmt::format("<{}{}>", r ? "td" : "th", kind) + escape_html(cell);
    }
    out += "</tr>";
  }
  return out + "</table></div>";
}

}  // namespace hosel::post
