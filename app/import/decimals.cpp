#include "app/import/decimals.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/import/cells.hpp"
#include "app/reader.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// Whether a cell's comma (1) or its point (-1) is the decimal one; 0 where it may as well part thousands, or has none.
int decimal_of(const std::string& cell) {
  const std::string text = figure_of(cell);
  if (text.find_first_of("0123456789") == text.npos) return 0;  // `Std.-Abw.`
  const auto point = text.rfind('.'), comma = text.rfind(',');
  constexpr auto none = std::string::npos;
  if (point == none && comma == none) return 0;
  if (point != none && comma != none) return comma > point ? 1 : -1;
  const char sign = comma != none ? ',' : '.';
  const int decimal = comma != none ? 1 : -1;
  const auto first = text.find(sign), last = text.rfind(sign);
  if (first != last) return -decimal;  // thousands stand several times
  const std::size_t before = first - std::min(first, text.find_first_of("0123456789")), after = text.size() - last - 1;
  return after == 3 && before >= 1 && before <= 3 && text[text.find_first_of("0123456789")] != '0' ? 0 : decimal;
}

}  // namespace

int decimal_of(const Sheet& sheet) {
  bool comma = false, point = false;
  for (const Row& row : sheet.rows)
    for (const std::string& cell : row)
      if (!cell.empty() && figure_of(cell).size() > 1 && cell.size() < figure_of(cell).size() + 12) {
        const int d = decimal_of(cell);
        comma |= d > 0;
        point |= d < 0;
      }
  return comma == point ? 0 : comma ? 1 : -1;
}

bool decimal_comma(const Row& cells, const Sheet& sheet, const std::string& header, const fs::path& file) {
  std::vector<std::size_t> commas, points;
  bool any = false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int d = decimal_of(cells[i]);
    if (d > 0) commas.push_back(i);
    if (d < 0) points.push_back(i);
    any |= figure_of(cells[i]).find(',') != std::string::npos;
  }
  if (!commas.empty() && !points.empty()) {
    const std::size_t odd = commas.size() < points.size() ? commas.front() : points.front();
    throw InputError(
        fmt::format("{}: column '{}', shot {}: '{}' among {} that write the decimals otherwise: correct it",
                    file.string(), header, odd + 1, cells[odd], std::max(commas.size(), points.size())));
  }
  if (!commas.empty() || !points.empty()) return !commas.empty();
  if (const int d = decimal_of(sheet); d != 0) return d > 0;
  // 94,213 alone: thousands in a file of commas, decimals where small numbers stand in a file of semicolons.
  return any && sheet.delimiter != "," && sheet.delimiter != "JSON" &&
         std::ranges::all_of(cells, [](const std::string& c) { return c.size() < 6; });
}

}  // namespace hosel::app
