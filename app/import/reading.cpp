#include "app/import/reading.hpp"

#include <algorithm>
#include <set>

#include "app/import/decimals.hpp"

namespace hosel::app {

bool Reading::is_empty(std::size_t c) const {
  return std::ranges::all_of(session.sheet.rows, [&](const Row& row) { return missing(row[c]); });
}

Row Reading::cells(std::size_t c) const {
  Row out;
  for (const Row& row : session.sheet.rows) out.push_back(missing(row[c]) ? "" : row[c]);
  return out;
}

std::optional<std::size_t> Reading::column_of(std::string_view role) const {
  const auto at = std::ranges::find(roles, role);
  return at == roles.end() ? std::nullopt : std::optional(std::size_t(at - roles.begin()));
}

std::string Reading::headed_unit(std::size_t c) const {
  const std::string unit = unit_in(session.sheet.names[c]);
  return unit.empty() && c < session.sheet.units.size() ? unit_of(session.sheet.units[c]) : unit;
}

std::string Reading::stated_length(std::size_t c) const {
  std::string unit = headed_unit(c);
  for (const Row& row : session.sheet.rows) {
    if (!unit.empty() || missing(row[c])) continue;
    if (const auto cell = number(row[c], false, Sides::none)) unit = cell->unit;
    break;
  }
  return dimension_of(unit) == Dimension::length ? unit : "";
}

bool Reading::has_decimal_comma(std::size_t c) const {
  return decimal_comma(cells(c), session.sheet, session.sheet.names[c], session.file);
}

std::size_t blank(Understood& u, const std::vector<bool>& which) {
  const std::size_t before = u.filled;
  for (std::size_t i = 0; i < u.cells.size(); ++i)
    if (which[i]) u.cells[i].clear();
  count_again(u);
  return before - u.filled;
}

bool says_any(const std::string& cell, std::initializer_list<const char*> words) {
  const std::string text = plain(cell);
  return std::ranges::any_of(words, [&](const char* w) { return text.find(w) != std::string::npos; });
}

std::optional<bool> yes_or_no(const std::string& cell) {
  static const std::set<std::string> yes = {"yes", "y", "true", "1"}, no = {"no", "n", "false", "0"};
  const std::string word = plain(cell);
  return yes.contains(word) ? std::optional(true) : no.contains(word) ? std::optional(false) : std::nullopt;
}

}  // namespace hosel::app
