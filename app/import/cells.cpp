#include "app/import/cells.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <set>

#include "app/import/dictionary.hpp"
#include "golf/units.hpp"

namespace hosel::app {

std::string trimmed(std::string_view s) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  if (s.starts_with("\xC2\xA0")) s.remove_prefix(2);  // the blank that spreadsheets do not break at
  if (s.ends_with("\xC2\xA0")) s.remove_suffix(2);
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

double sign_in(const std::string& header) {
  const auto open = header.find_last_of("([");
  if (open == std::string::npos) return 0;
  std::string text = header.substr(open);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  std::erase_if(text, [](char c) { return c == ' ' || c == '='; });
  const auto says = [&](std::initializer_list<const char*> words, char sign) {
    return std::ranges::any_of(words, [&](const char* w) {
      return text.find(std::string(w) + sign) != std::string::npos ||
             text.find(sign + std::string(w)) != std::string::npos;
    });
  };
  const auto positive = {"toe", "right", "up", "high", "fade", "open", "in-out"};
  const auto negative = {"heel", "left", "down", "low", "draw", "closed", "out-in"};
  const bool minus = says(negative, '+') || says(positive, '-'), plus = says(positive, '+') || says(negative, '-');
  return minus == plus ? 0 : minus ? -1 : 1;
}

double si_of(const std::string& unit) {
  if (unit == "cm") return 0.01;
  if (unit == "in") return 0.0254;
  for (const Unit& u : units())
    if (u.suffix == unit) return u.si;
  return 1;
}

std::optional<Cell> number(std::string text, bool comma_is_decimal, bool side) {
  double sign = 1;
  std::string tail, own_unit;
  for (const char* minus : {"\xE2\x88\x92", "\xE2\x80\x93"})  // typographic ones
    if (text.starts_with(minus)) text.replace(0, 3, "-");
  std::size_t end = 0;
  while (end < text.size() &&
         (std::isdigit(static_cast<unsigned char>(text[end])) || text[end] == '.' || text[end] == ',' ||
          text[end] == '-' || text[end] == '+' || text[end] == 'e' || text[end] == 'E' || text[end] == '\'' ||
          (text[end] == ' ' && end + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[end + 1])))))
    ++end;
  tail = trimmed(std::string_view(text).substr(end));
  std::string digits = text.substr(0, end);
  std::erase_if(digits, [&](char c) { return c == ' ' || c == '\'' || c == (comma_is_decimal ? '.' : ','); });
  std::ranges::replace(digits, ',', '.');
  if (!tail.empty()) {
    const std::string word = plain(tail);
    static const std::map<std::string, double> phrases = {{"in out", 1},     {"in to out", 1},  {"inside out", 1},
                                                          {"i o", 1},        {"o i", -1},       {"out in", -1},
                                                          {"out to in", -1}, {"outside in", -1}};
    const std::string last = word.substr(word.find_last_of(' ') == std::string::npos ? 0 : word.find_last_of(' ') + 1);
    static const std::map<std::string, double> sides = {
        {"r", 1},     {"right", 1}, {"l", -1},      {"left", -1}, {"t", 1},    {"toe", 1},   {"h", -1},
        {"heel", -1}, {"u", 1},     {"up", 1},      {"high", 1},  {"d", -1},   {"down", -1}, {"low", -1},
        {"open", 1},  {"o", 1},     {"closed", -1}, {"c", -1},    {"fade", 1}, {"draw", -1}};
    const auto at = sides.find(last);
    const auto phrase = phrases.find(word);
    // `5 mm Toe`: a unit may stand before the side.
    const auto gap = tail.find_first_of(" \t");
    const std::string before = unit_of(tail.substr(0, gap));
    if (side && phrase != phrases.end()) sign = phrase->second;
    else if (side && at != sides.end()) {
      sign = at->second;
      if (gap != std::string::npos) own_unit = before;
    } else if (own_unit = unit_of(tail); own_unit.empty()) return {};
  }
  if (!digits.empty() && digits.front() == '+') digits.erase(0, 1);
  Cell out;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out.value);
  if (error != std::errc() || stop != digits.data() + digits.size() || digits.empty()) return {};
  if (sign < 0) {
    out.value = -out.value;
    digits = digits.front() == '-' ? digits.substr(1) : "-" + digits;
  }
  out.digits = digits;
  out.unit = own_unit;
  return out;
}

}  // namespace hosel::app
