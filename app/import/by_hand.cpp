#include "app/import/by_hand.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/reader.hpp"

namespace hosel::app {
namespace {

/// A header as a person copies it.
std::string copied(const std::string& header) { return lower(trimmed(header)); }

/// Of a header in --column: by its unit as well, where it has one: `SIDE (deg)` beside `SIDE (rpm)`.
std::string header_key(const std::string& header) {
  return unit_in(header).empty() && !plain(header).empty() ? plain(header) : copied(header);
}

}  // namespace

const std::string* ByHand::of(const std::string& header, const Row& headers) const {
  if (const auto at = quantity.find(copied(header)); at != quantity.end()) return &at->second;
  const auto at = quantity.find(plain(header));
  if (at == quantity.end()) return nullptr;
  for (const std::string& other : headers)
    if (other != header && plain(other) == plain(header) && copied(other) == at->first) return nullptr;
  return &at->second;
}

bool ByHand::turns(const std::string& header) const {
  return turned.contains(plain(header)) || turned.contains(copied(header));
}

ByHand read_by_hand(const ImportOptions& o, Dictionary& d) {
  ByHand out;
  auto& [by_hand, turned] = out;
  for (const std::string& c : o.columns) {
    const auto at = c.rfind('=');
    if (at == std::string::npos || at == 0)
      throw InputError(fmt::format("--column '{}': header=quantity_unit is wanted", c));
    const std::string header = c.substr(0, at);
    std::string name = c.substr(at + 1);
    if (name.starts_with('-')) turned.insert(header_key(header)), name.erase(0, 1);
    by_hand[header_key(header)] = name;
    if (name.empty()) {
      d.learn(header, "");
      continue;
    }
    const auto& roles = d.roles();
    if (roles.contains(name)) {
      d.learn(header, name);
      by_hand.erase(header_key(header));
      continue;
    }
    const SplitName part = split_unit(name);
    const std::vector<std::string> known = d.quantity_names();
    if (!part.unit || !std::ranges::count(known, part.stem))
      throw InputError(fmt::format("--column '{}': no such quantity with a unit, nor {}; quantities: {}", c,
                                   fmt::join(roles, ", "), fmt::join(known, ", ")));
    if (const auto wanted = dimension_of(d.quantity(part.stem)->metric); part.unit->dimension != wanted)
      throw InputError(fmt::format("--column '{}': '{}' is a unit of {}, {} wants one of {} ({}_{})", c,
                                   part.unit->suffix, hosel::name(part.unit->dimension), part.stem,
                                   hosel::name(*wanted), part.stem, d.quantity(part.stem)->metric));
    d.learn(header, part.stem);
  }
  return out;
}

void check_headers(const ImportOptions& o, const ByHand& by_hand, const std::vector<Sheet>& sheets) {
  std::vector<std::string> headers;
  for (const Sheet& sheet : sheets) headers.insert(headers.end(), sheet.names.begin(), sheet.names.end());
  const auto check = [&](const std::string& option, const std::string& said, const std::string& header,
                         const auto& is_it) {
    for (const Sheet& sheet : sheets)
      if (std::ranges::any_of(sheet.names, [&](const std::string& n) { return is_it(n, sheet.names); })) return;
    throw InputError(
        fmt::format("{} '{}': no column '{}'{}", option, said, header,
                    or_nearest(header, headers, fmt::format("; there are: {}", fmt::join(headers, ", ")))));
  };
  for (const std::string& c : o.columns) {
    const std::string header = c.substr(0, c.rfind('='));
    const auto at = by_hand.quantity.find(header_key(header));
    check("--column", c, header, [&](const std::string& name, const Row& names) {
      return at == by_hand.quantity.end() || at->second.empty() ? letters(name) == letters(header)
                                                                : by_hand.of(name, names) == &at->second;
    });
  }
  for (const std::string& k : o.keep)
    check("--keep", k, k, [&](const std::string& name, const Row&) { return letters(name) == letters(k); });
}

}  // namespace hosel::app
