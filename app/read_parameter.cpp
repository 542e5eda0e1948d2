#include "app/read_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "post/labels.hpp"

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

std::string label(const models::NamedParameter& p) {
  return fmt::format("{} [{}]", post::spoken(p.name), p.unit.empty() ? "-" : post::symbol(p.unit));
}

std::string column(const models::NamedParameter& p) {
  return p.unit.empty() ? std::string(p.name) : fmt::format("{}_{}", p.name, p.unit);
}

std::string Axis::said(std::size_t i) const {
  const std::string number = fmt::format("{} {:g}", post::spoken(parameter->name), values[i] / si);
  return parameter->unit.empty() ? number : fmt::format("{} {}", number, post::symbol(parameter->unit));
}

Axis read_axis(Table table) {
  Axis axis;
  axis.parameter = &read_parameter(table, {"name", "the parameter that varies"});
  const models::NamedParameter& p = *axis.parameter;
  axis.si = unit_of(p);
  axis.label = label(p);
  const Range range{p.low, p.high};
  const std::string unit(p.unit);
  const auto one = [&](Key key) { return unit.empty() ? table.number(key, range) : table.quantity(key, unit, range); };
  if (table.has("values") || table.has_quantity("values")) {
    axis.values =
        unit.empty()
            ? table.numbers({"values", "the values it takes; instead of from, to and count"}, 0, range)
            : table.quantities({"values", "the values it takes; instead of from, to and count"}, unit, 0, range);
    if (axis.values.empty()) table.fail("values", "name at least one value");
  } else {
    const double from = one({"from", "first value"}), to = one({"to", "last value"});
    const long count = table.integer({"count", "how many values, evenly spread"}, 2, 100000);
    for (long i = 0; i < count; ++i)
      axis.values.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return axis;
}

}  // namespace hosel::app
