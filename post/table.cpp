#include "post/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "post/csv.hpp"

namespace hosel::post {
namespace {

std::string said(const TableCell& cell, const std::string& format, double scale) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* whole = std::get_if<long long>(&cell)) return std::to_string(*whole);
  const auto* number = std::get_if<double>(&cell);
  return number ? fmt::format(fmt::runtime(format), scale * *number) : std::string();
}

}  // namespace

Table& Table::in_files(const std::vector<std::string>& heads, const std::string& format) {
  for (const std::string& head : heads) columns.push_back({head, format});
  return *this;
}

void Table::check() const {
  for (const auto& row : rows)
    if (row.size() != columns.size())
      throw std::logic_error(fmt::format("a table of {} columns has a row of {} cells", columns.size(), row.size()));
}

std::string Table::csv() const {
  check();
  std::string out;
  const auto line = [&](const auto& cell_of) {
    const char* before = "";
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (!columns[c].in_files()) continue;
      out += before + cell_of(c);
      before = ",";
    }
    out += '\n';
  };
  line([&](std::size_t c) { return csv_cell(columns[c].head); });
  for (const auto& row : rows)
    line([&](std::size_t c) {
      const std::string text = said(row[c], columns[c].format, 1);
      return std::holds_alternative<std::string>(row[c]) ? csv_cell(text) : text;
    });
  return out;
}

TextTable Table::shown() const {
  check();
  TextTable out = layout;
  auto& heading = out.rows.emplace_back();
  for (const TableColumn& c : columns)
    if (c.for_people()) heading.push_back(c.heading);
  for (const auto& row : rows) {
    auto& cells = out.rows.emplace_back();
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (columns[c].for_people())
        cells.push_back(
            std::holds_alternative<std::monostate>(row[c]) ? "-" : said(row[c], columns[c].spoken, columns[c].scale));
  }
  return out;
}

nlohmann::json Table::json() const {
  check();
  nlohmann::json out = nlohmann::json::array();
  for (const auto& row : rows) {
    nlohmann::json& object = out.emplace_back(nlohmann::json::object());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (!columns[c].in_files()) continue;
      nlohmann::json& at = object[columns[c].head];
      if (const auto* text = std::get_if<std::string>(&row[c])) at = *text;
      if (const auto* whole = std::get_if<long long>(&row[c])) at = *whole;
      if (const auto* number = std::get_if<double>(&row[c])) at = *number;
    }
  }
  return out;
}

std::optional<double> if_finite(double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; }

}  // namespace hosel::post
