#include "app/read_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/of_file.hpp"
#include "app/reader.hpp"

namespace hosel::app {

post::Sheet read_sheet(const std::filesystem::path& file) {
  static OfFile<std::shared_ptr<const post::Sheet>> sheets;
  try {
    return *sheets.get(file, [&] { return std::make_shared<const post::Sheet>(post::read_csv(file)); });
  } catch (const DataError& e) { throw InputError(e.what()); }
}

namespace {

InputError no_number(const post::Sheet& sheet, std::size_t c, std::size_t r) {
  return InputError(
      fmt::format("{}:{}: {} '{}' is no number", sheet.file, sheet.lines[r], sheet.names[c], sheet.columns[c][r]));
}

}  // namespace

double number_in(const post::Sheet& sheet, std::size_t c, std::size_t r) {
  const std::string& cell = sheet.columns[c][r];
  if (cell.empty()) return kNaN;
  const auto x = post::number(cell);
  if (!x || (std::isinf(*x) && cell.find_first_of("0123456789") != cell.npos)) throw no_number(sheet, c, r);
  return *x;
}

std::vector<double> column(const post::Sheet& sheet, std::string_view stem, Dimension dimension, bool unit_needed) {
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    SplitName split = split_unit(sheet.names[c]);
    if (!unit_needed && sheet.names[c] == stem) split = {std::string(stem), {}};
    if (split.stem != stem) continue;
    if (unit_needed && (!split.unit || split.unit->dimension != dimension))
      throw InputError(
          fmt::format("{}:1: column '{}' needs a unit of {}", sheet.file, sheet.names[c], name(dimension)));
    std::vector<double> out;
    for (std::size_t r = 0; r < sheet.rows(); ++r) {
      const double x = number_in(sheet, c, r);
      if (!std::isfinite(x)) throw no_number(sheet, c, r);
      out.push_back(unit_needed ? x * split.unit->si : x);
    }
    return out;
  }
  std::string there, wanted;
  for (const Unit& u : all_units())
    if (unit_needed && u.dimension == dimension)
      wanted += fmt::format("{}{}_{}", wanted.empty() ? " with a unit (" : ", ", stem, u.suffix);
  if (!wanted.empty()) wanted += ")";
  for (const std::string& n : sheet.names) there += (there.empty() ? "" : ", ") + n;
  constexpr std::size_t most = 200;
  if (there.size() > most) there.replace(most, there.npos, " ...");
  throw InputError(fmt::format("{}:1: no column '{}'{}; there are: {}{}", sheet.file, stem, wanted, there,
                               sheet.names.size() == 1 ? "; cells are separated by commas" : ""));
}

const std::vector<std::string>& cells_of(const post::Sheet& sheet, std::string_view name) {
  const auto at = std::ranges::find(sheet.names, name);
  if (at == sheet.names.end()) throw InputError(fmt::format("{}:1: no column '{}'", sheet.file, name));
  return sheet.columns[std::size_t(at - sheet.names.begin())];
}

std::vector<double> column_with_gaps(const post::Sheet& sheet, std::string_view name) {
  const auto c = std::size_t(&cells_of(sheet, name) - sheet.columns.data());
  std::vector<double> out;
  for (std::size_t r = 0; r < sheet.rows(); ++r) out.push_back(number_in(sheet, c, r));
  return out;
}

}  // namespace hosel::app
