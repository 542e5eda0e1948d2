/// A table of named columns: filled once, written as a file, for people and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "post/text_table.hpp"

namespace hosel::post {

/// Formats are those of fmt, of numbers alone. A column without a head is for people only, one with a head and without
/// a heading in files only.
struct TableColumn {
  std::string head = {};      ///< in files, with its unit: "contact_time_s"
  std::string format = "{}";  ///< in files; "{}": the fewest digits that give the number back
  std::string heading = {};   ///< for people: "contact [ms]"
  std::string spoken = "{}";  ///< format for people
  double scale = 1;           ///< for people, of the number in files

  bool in_files() const { return !head.empty(); }
  bool for_people() const { return head.empty() || !heading.empty(); }
};

/// Nothing, a text, a number, a whole number (which no format changes).
using TableCell = std::variant<std::monostate, std::string, double, long long>;

struct Table {
  std::vector<TableColumn> columns = {};
  TextTable layout = {};  ///< for people: its widths; it has no rows
  std::vector<std::vector<TableCell>> rows = {};

  /// Further columns, in files only.
  Table& in_files(const std::vector<std::string>& heads, const std::string& format = "{}");

  /// A row from left to right: texts, numbers, std::nullopt for nothing; a range gives a cell for each of its elements.
  template <class... Cells>
  void add(const Cells&... cells) {
    rows.emplace_back();
    more(cells...);
  }
  /// Further cells of the last row.
  template <class... Cells>
  void more(const Cells&... cells) {
    (put(cells), ...);
  }

  /// By RFC 4180 (csv_cell), a line break at the end. This and the next two throw std::logic_error where a row has not
  /// a cell for every column.
  std::string csv() const;
  /// For a terminal and a page; nothing is "-".
  TextTable shown() const;
  /// A list of objects, cells by their columns' heads; nothing is null.
  nlohmann::json json() const;

 private:
  template <class Cell>
  void put(const Cell& cell) {
    auto& row = rows.back();
    if constexpr (std::is_constructible_v<std::string_view, const Cell&>) row.emplace_back(std::string(cell));
    else if constexpr (std::is_integral_v<Cell>) row.emplace_back(static_cast<long long>(cell));
    else if constexpr (std::is_floating_point_v<Cell>) row.emplace_back(double(cell));
    else if constexpr (std::ranges::range<const Cell>)
      for (const auto& each : cell) put(each);
    else if (cell) put(*cell);
    else row.emplace_back();
  }
  void put(std::nullopt_t) { rows.back().emplace_back(); }
  void check() const;
};

/// A number as a cell that is nothing where it is not finite.
std::optional<double> if_finite(double x);

}  // namespace hosel::post
