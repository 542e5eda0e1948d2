#include "app/import/cells.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <vector>

#include "app/import/dictionary.hpp"
#include "golf/units.hpp"

namespace hosel::app {

std::string trimmed(std::string_view s) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  return std::string(s);
}

bool missing(const std::string& cell) {
  static const std::set<std::string> words = {"",    "-",  "--",  "---",  "\xE2\x80\x93", "\xE2\x80\x94",
                                              "n/a", "na", "nan", "null", "none",         "#n/a"};
  std::string lower = cell;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return words.contains(lower);
}

std::string unit_of(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  std::erase_if(text, [](char c) { return c == '[' || c == ']' || c == '(' || c == ')' || c == ' ' || c == '.'; });
  static const std::map<std::string, std::string> spellings = {
      {"mph", "mph"},      {"mi/h", "mph"},     {"kmh", "kmh"},  {"km/h", "kmh"},    {"kph", "kmh"},
      {"mps", "mps"},      {"m/s", "mps"},      {"deg", "deg"},  {"degrees", "deg"}, {"degree", "deg"},
      {"\xC2\xB0", "deg"}, {"\xC2\xBA", "deg"}, {"rad", "rad"},  {"rpm", "rpm"},     {"mm", "mm"},
      {"cm", "cm"},        {"in", "in"},        {"inch", "in"},  {"inches", "in"},   {"m", "m"},
      {"yd", "yd"},        {"yds", "yd"},       {"yards", "yd"}, {"ft", "ft"},       {"feet", "ft"},
      {"s", "s"},          {"sec", "s"},        {"%", "pct"}};
  const auto at = spellings.find(text);
  return at == spellings.end() ? "" : at->second;
}

std::string unit_in(const std::string& header) {
  if (const auto open = header.find_last_of("(["); open != std::string::npos) {
    const std::string inside = header.substr(open);
    if (const std::string u = unit_of(inside); !u.empty()) return u;
    if (const std::string u = unit_of(inside.substr(0, inside.find(' '))); !u.empty()) return u;
  }
  const auto blank = header.find_last_of(" _");
  return blank == std::string::npos ? "" : unit_of(header.substr(blank + 1));
}

HeaderSign sign_in(const std::string& header) {
  const auto open = header.find_last_of("([");
  if (open == std::string::npos) return {};
  std::string text = header.substr(open);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  std::erase_if(text, [](char c) { return c == ' ' || c == '='; });
  // `(Right/Left +/-)` says that there are signs, not which.
  for (std::size_t at; (at = text.find("+/-")) != text.npos;) text.erase(at, 3);
  using Words = std::vector<std::string>;
  const auto says = [&](const Words& words, char sign) {
    return std::ranges::any_of(words, [&](const std::string& w) {
      return text.find(w + sign) != std::string::npos || text.find(sign + w) != std::string::npos;
    });
  };
  HeaderSign out;
  for (const bool own : {false, true}) {
    const Words positive = own ? Words{"fade", "open", "in-out"} : Words{"toe", "right", "up", "high"},
                negative = own ? Words{"draw", "closed", "out-in"} : Words{"heel", "left", "down", "low"};
    const bool minus = says(negative, '+') || says(positive, '-'), plus = says(positive, '+') || says(negative, '-');
    if (minus == plus) continue;
    if (out.sign != 0 && (out.sign < 0) != minus) return {};  // it says both
    out = {minus ? -1.0 : 1.0, own};
  }
  return out;
}

std::string figure_of(const std::string& cell) {
  const auto begin = std::min(cell.find_first_of("0123456789.,+-'"), cell.size());
  const bool side = begin <= 6 && std::all_of(cell.begin(), cell.begin() + long(begin),
                                              [](unsigned char c) { return std::isalpha(c) || c == ' '; });
  const std::string rest = side ? cell.substr(begin) : cell;
  return rest.substr(0, rest.find_first_not_of("0123456789.,+-'"));
}

double si_of(const std::string& unit) {
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  if (unit == "ft") return 0.3048;
  for (const Unit& u : units())
    if (u.suffix == unit) return u.si;
  return 1;
}

namespace {

struct Side {
  double sign;
  bool own;  // the player's own: a left-hander's as well
};

std::optional<Side> side_of(const std::string& words) {
  static const std::map<std::string, Side> sides = {
      {"r", {1, false}},      {"right", {1, false}},    {"l", {-1, false}},        {"left", {-1, false}},
      {"t", {1, false}},      {"toe", {1, false}},      {"h", {-1, false}},        {"heel", {-1, false}},
      {"u", {1, false}},      {"up", {1, false}},       {"high", {1, false}},      {"d", {-1, false}},
      {"down", {-1, false}},  {"low", {-1, false}},     {"open", {1, true}},       {"o", {1, true}},
      {"closed", {-1, true}}, {"c", {-1, true}},        {"fade", {1, true}},       {"draw", {-1, true}},
      {"in out", {1, true}},  {"in to out", {1, true}}, {"inside out", {1, true}}, {"i o", {1, true}},
      {"o i", {-1, true}},    {"out in", {-1, true}},   {"out to in", {-1, true}}, {"outside in", {-1, true}}};
  if (const auto at = sides.find(words); at != sides.end()) return at->second;
  const auto last = sides.find(words.substr(std::min(words.size(), words.rfind(' ') + 1)));
  return last == sides.end() ? std::nullopt : std::optional(last->second);
}

/// `6401*`, `6806 (est.)`, `6806 est`: the mark is taken off.
bool take_mark(std::string& text) {
  std::string lower = text;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* mark : {"*", "(e)", "(est)", "(est.)", "(estimated)", " est", " est.", " estimated"})
    if (lower.ends_with(mark)) {
      text = trimmed(text.substr(0, text.size() - std::string_view(mark).size()));
      return true;
    }
  return false;
}

}  // namespace

std::optional<Cell> number(std::string text, bool comma_is_decimal, bool side) {
  Cell out;
  double sign = 1;
  out.marked = take_mark(text);
  // `R1.1`, `L 0,6`: the side stands in front.
  if (side && !text.empty() && std::isalpha(static_cast<unsigned char>(text.front()))) {
    const auto gap = text.find_first_of("0123456789.,+-\xE2");
    const auto before = gap == std::string::npos ? std::nullopt : side_of(plain(text.substr(0, gap)));
    if (!before) return {};
    sign = before->sign;
    out.own = before->own;
    out.sided = true;
    text.erase(0, gap);
  }
  for (const char* minus : {"\xE2\x88\x92", "\xE2\x80\x93"})  // typographic ones
    if (text.starts_with(minus)) text.replace(0, 3, "-");
  std::size_t end = 0;
  while (end < text.size() &&
         (std::isdigit(static_cast<unsigned char>(text[end])) || text[end] == '.' || text[end] == ',' ||
          text[end] == '-' || text[end] == '+' || text[end] == 'e' || text[end] == 'E' || text[end] == '\'' ||
          (text[end] == ' ' && end + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[end + 1])))))
    ++end;
  const std::string tail = trimmed(std::string_view(text).substr(end));
  std::string digits = text.substr(0, end);
  std::erase_if(digits, [&](char c) { return c == ' ' || c == '\'' || c == (comma_is_decimal ? '.' : ','); });
  std::ranges::replace(digits, ',', '.');
  if (!tail.empty()) {
    if (const auto behind = side ? side_of(plain(tail)) : std::nullopt) {
      if (out.sided) return {};
      sign = behind->sign;
      out.own = behind->own;
      out.sided = true;
      // `5 mm Toe`: a unit may stand before the side.
      if (const auto gap = tail.find_first_of(" \t"); gap != std::string::npos) out.unit = unit_of(tail.substr(0, gap));
    } else if (out.unit = unit_of(tail); out.unit.empty()) {
      return {};
    }
  }
  if (!digits.empty() && digits.front() == '+') digits.erase(0, 1);
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out.value);
  if (error != std::errc() || stop != digits.data() + digits.size() || digits.empty()) return {};
  if (out.sided && out.value < 0) return {};  // `-2.5 L`: to which side?
  if (sign < 0) {
    out.value = -out.value;
    digits = digits.front() == '-' ? digits.substr(1) : "-" + digits;
  }
  out.digits = digits;
  return out;
}

}  // namespace hosel::app
