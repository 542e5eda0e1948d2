#include "app/overrides.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "golf/units.hpp"

namespace hosel::app {
namespace {

void add_inner_keys(const std::string& name, const toml::node& node, std::vector<std::string>& out) {
  const auto add = [&](const std::string& key, const toml::node& value) {
    out.push_back(key);
    add_inner_keys(key, value, out);
  };
  if (const auto* table = node.as_table())
    for (auto&& [key, value] : *table) add(fmt::format("{}.{}", name, key.str()), value);
  if (const auto* list = node.as_array(); list && !list->empty() && list->get(0)->is_table())
    for (std::size_t i = 0; i < list->size(); ++i) add(fmt::format("{}[{}]", name, i + 1), *list->get(i));
}

}  // namespace

std::string key_of(const std::string& override) { return override.substr(0, override.find('=')); }

std::vector<std::string> keys_of(const std::string& override) {
  const std::string own = key_of(override);
  std::vector<std::string> out = {own};
  const std::size_t value = override.find_first_not_of(" \t", std::min(own.size() + 1, override.size()));
  if (value == std::string::npos || (override[value] != '{' && override[value] != '[')) return out;
  try {
    const toml::table parsed = toml::parse("value = " + override.substr(value));
    add_inner_keys(own, *parsed.get("value"), out);
  } catch (const toml::parse_error&) {}  // a text, as the reader of the case takes it
  return out;
}

bool same_quantity(const std::string& a, const std::string& b) {
  const SplitName x = split_unit(a), y = split_unit(b);
  return a == b || (x.unit && y.unit && x.stem == y.stem);
}

bool element_of(const std::string& key, const std::string& list) {
  return key.ends_with(']') && same_quantity(key.substr(0, key.rfind('[')), list);
}

bool replaces(const std::string& later, const std::string& earlier) {
  // The layers of a ball and its name in the library say the same.
  if (later == "ball.layers" && earlier == "ball.model") return true;
  if (later == "ball.model" && earlier.starts_with("ball.layers")) return true;
  return same_quantity(later, earlier) || element_of(earlier, later) || earlier.starts_with(later + ".") ||
         earlier.starts_with(later + "[");
}

std::string replaced(const std::string& later, const std::string& earlier) {
  const std::string key = key_of(later);
  for (const std::string& lost : keys_of(earlier))
    if (replaces(key, lost)) return lost;
  return "";
}

}  // namespace hosel::app
