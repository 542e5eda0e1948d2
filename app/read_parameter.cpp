#include "app/read_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hosel::app {

const models::NamedParameter& read_parameter(Table& table, Key key) {
  std::vector<std::string> names;
  for (const auto& p : models::parameters()) names.emplace_back(p.name);
  return *models::find_parameter(table.choice(key, names));
}

double unit_of(const models::NamedParameter& p) {
  if (p.unit.empty()) return 1;
  const auto all = units();
  return std::ranges::find(all, p.unit, &Unit::suffix)->si;
}

std::string column(const models::NamedParameter& p) {
  return p.unit.empty() ? std::string(p.name) : fmt::format("{}_{}", p.name, p.unit);
}

}  // namespace hosel::app
