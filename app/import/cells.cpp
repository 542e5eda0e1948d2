#include "app/import/cells.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "app/import/dictionary.hpp"

namespace hosel::app {

std::string trimmed(std::string_view s) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  return std::string(s);
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return out;
}

bool missing(const std::string& cell) {
  static const std::set<std::string> words = {
      "",     "-",    "--",      "---",     "\xE2\x80\x93", "\xE2\x80\x94", "n/a",    "na", "nan",   "null",
      "none", "#n/a", "#div/0!", "#value!", "#ref!",        "#num!",        "#name?", "?",  "error", "err"};
  return words.contains(lower(cell));
}

namespace {

/// Units that no header of ours has: numbers in them are converted.
constexpr std::array kOtherUnits = {
    Unit{"cm", Dimension::length, 0.01},         Unit{"ft/s", Dimension::speed, 0.3048},
    Unit{"kn", Dimension::speed, 1852.0 / 3600}, Unit{"mrad", Dimension::angle, 1e-3},
    Unit{"gon", Dimension::angle, kPi / 200},    Unit{"turn/s", Dimension::angular_velocity, 2 * kPi},
};

/// One of these, or of a header of ours.
std::optional<Unit> known_unit(std::string_view name) {
  for (const std::span<const Unit> all : {std::span<const Unit>(kOtherUnits), all_units()})
    if (const auto at = std::ranges::find(all, name, &Unit::suffix); at != all.end()) return *at;
  return {};
}

/// What stands in brackets, without them; empty where there are none.
std::vector<std::string> brackets(const std::string& header) {
  std::vector<std::string> out;
  for (std::size_t at = 0; (at = header.find_first_of("([", at)) != header.npos;) {
    const auto end = std::min(header.find_first_of(")]", at), header.size());
    out.push_back(header.substr(at + 1, end - at - 1));
    at = end;
  }
  return out;
}

}  // namespace

std::vector<std::string> words_of(std::string_view text, std::string_view between) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const auto end = std::min(text.find_first_of(between), text.size());
    if (end > 0) out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string unit_of(std::string text) {
  text = lower(text);
  std::erase_if(text, [](char c) { return c == '[' || c == ']' || c == '(' || c == ')' || c == ' ' || c == '.'; });
  static const std::vector<std::pair<std::string, std::vector<std::string>>> spellings = {
      {"mph", {"mph", "mi/h"}},
      {"kmh", {"kmh", "km/h", "kph", "km/u", "km/t", "км/ч"}},
      {"mps", {"mps", "m/s", "m/sec", "м/с"}},
      {"ft/s", {"ft/s", "ft/sec", "fps"}},
      {"kn", {"kn", "kt", "knots"}},
      {"deg",
       {"grad", "deg", "degrees", "degree", "grados", "graden", "grader", "gradi", "degrés", "\xC2\xB0", "\xC2\xBA",
        "度", "град"}},
      {"rad", {"rad"}},
      {"mrad", {"mrad"}},
      {"gon", {"gon"}},
      {"rpm", {"rpm", "rev/min", "1/min", "u/min", "tr/min", "varv/min", "omw/min", "об/мин"}},
      {"rad_per_s", {"rad/s", "rad/sec"}},
      {"deg_per_s", {"deg/s", "\xC2\xB0/s"}},
      {"turn/s", {"rps", "rev/s", "hz"}},
      {"um", {"\xC2\xB5m", "\xCE\xBCm", "um"}},
      {"mm", {"mm"}},
      {"cm", {"cm"}},
      {"in", {"in", "inch", "inches"}},
      {"m", {"m"}},
      {"yd", {"yd", "yds", "yard", "yards", "ヤード"}},
      {"ft", {"ft", "feet"}},
      {"s", {"s", "sec"}},
      {"kg", {"kg"}},
      {"g", {"g", "grams"}},
      {"pct", {"%"}}};
  static const std::map<std::string, std::string> units = [] {
    std::map<std::string, std::string> out;
    for (const auto& [unit, words] : spellings)
      for (const std::string& word : words) out.emplace(word, unit);
    return out;
  }();
  const auto at = units.find(text);
  return at == units.end() ? "" : at->second;
}

std::string unit_in(const std::string& header) {
  std::vector<std::string> all = brackets(header);
  std::ranges::reverse(all);
  for (const std::string& inside : all) {
    if (const std::string u = unit_of(inside); !u.empty()) return u;
    // `in mm`, `mm toe-/heel+`: an inch is meant where no other unit is.
    std::string inch;
    const std::vector<std::string> words = words_of(inside, " ,;");
    for (const std::string& word : words) {
      const std::string u = unit_of(word);
      if (!u.empty() && u != "in") return u;
      if (inch.empty()) inch = u;
    }
    if (std::ranges::any_of(words, [](const std::string& w) { return lower(w).starts_with("out"); })) continue;
    if (!inch.empty()) return inch;
  }
  return unit_of(header.substr(unit_tail(header)));
}

std::size_t unit_tail(const std::string& header) {
  const auto blank = header.find_last_of(" _");
  if (blank != std::string::npos) return blank + 1;
  for (std::size_t i = header.size(); i-- > 1;)  // `BallSpeedMph`
    if (std::isupper(static_cast<unsigned char>(header[i])) && std::islower(static_cast<unsigned char>(header[i - 1])))
      return i;
  return header.size();
}

std::string figure_of(const std::string& cell) {
  const auto begin = std::min(cell.find_first_of("0123456789.,+-'"), cell.size());
  const bool side = begin <= 6 && std::all_of(cell.begin(), cell.begin() + long(begin),
                                              [](unsigned char c) { return std::isalpha(c) || c == ' '; });
  const std::string rest = side ? cell.substr(begin) : cell;
  return rest.substr(0, rest.find_first_not_of("0123456789.,+-'"));
}

double si_of(const std::string& unit) {
  const auto known = known_unit(unit);
  return known ? known->si : 1;
}

std::optional<Dimension> dimension_of(const std::string& unit) {
  const auto known = known_unit(unit);
  return known ? std::optional(known->dimension) : std::nullopt;
}

std::string negated(const std::string& digits) { return digits.starts_with('-') ? digits.substr(1) : "-" + digits; }

namespace {

struct Side {
  double sign;
  bool own;  // the player's own: a left-hander's as well
};

std::optional<Side> side_of(const std::string& words, Sides sides) {
  struct Known {
    Sides of;
    Side side;
    std::set<std::string> words;
  };
  static const std::vector<Known> known = {
      {Sides::across, {1, false}, {"r", "right"}},
      {Sides::across, {-1, false}, {"l", "left"}},
      {Sides::across, {1, true}, {"open", "o", "fade", "in out", "in to out", "inside out", "i o"}},
      {Sides::across, {-1, true}, {"closed", "c", "draw", "out in", "out to in", "outside in", "o i"}},
      {Sides::height, {1, false}, {"u", "up", "h", "high"}},
      {Sides::height, {-1, false}, {"d", "down", "l", "low"}},
      {Sides::toe, {1, false}, {"t", "toe"}},
      {Sides::toe, {-1, false}, {"h", "heel"}}};
  const std::string last = words.substr(words.rfind(' ') + 1);
  for (const Sides of : {Sides::across, Sides::height, Sides::toe}) {
    if (sides != Sides::any && sides != of) continue;
    for (const std::string& text : {words, last})
      for (const Known& k : known)
        if (k.of == of && k.words.contains(text)) return k.side;
  }
  return {};
}

/// `6401*`, `6806 (est.)`, `6806 est`: the mark is taken off.
bool take_mark(std::string& text) {
  const std::string words = lower(text);
  for (const char* mark : {"*", "(e)", "(est)", "(est.)", "(estimated)", " est", " est.", " estimated"})
    if (words.ends_with(mark)) {
      text = trimmed(text.substr(0, text.size() - std::string_view(mark).size()));
      return true;
    }
  return false;
}

}  // namespace

std::string strange_unit(std::string_view text) {
  static const std::set<std::string, std::less<>> per = {"s", "sec", "second", "min", "minute", "h", "hr", "hour"};
  for (const std::string& word : words_of(text, " ,;[]()")) {
    const std::string unit = lower(word);
    const auto slash = unit.find('/');
    if (unit == "nm" || unit == "km" || unit == "mil" || unit == "thou") return word;
    if (slash == unit.npos || !unit_of(unit).empty() || !per.contains(unit.substr(slash + 1))) continue;
    const bool sides = side_of(unit.substr(0, slash), Sides::any) && side_of(unit.substr(slash + 1), Sides::any);
    if (slash > 0 && !sides) return word;  // `(T/H)` names two sides
  }
  // One word alone where a unit would stand: `(furlongs)`, unless it is a side or says how the number was found.
  static const std::set<std::string, std::less<>> harmless = {
      "abs",        "absolute", "actual", "angle",    "average",      "avg",        "ball",      "calc",
      "calculated", "camera",   "center", "centre",   "club",         "computed",   "corrected", "delivered",
      "distance",   "dynamic",  "est",    "estimate", "estimated",    "face",       "filtered",  "final",
      "flat",       "head",     "hor",    "horiz",    "horizontal",   "impact",     "initial",   "lateral",
      "launch",     "max",      "mean",   "meas",     "measured",     "median",     "min",       "model",
      "modeled",    "modelled", "net",    "norm",     "normalised",   "normalized", "optional",  "path",
      "peak",       "radar",    "raw",    "relative", "right-handed", "rotation",   "side",      "sign",
      "signed",     "spin",     "static", "target",   "test",         "total",      "tot",       "true",
      "value",      "ver",      "vert",   "vertical"};
  std::vector<std::string> alone = brackets(std::string(text));
  if (alone.empty()) alone.emplace_back(text);  // a cell of the row of units
  for (const std::string& inside : alone) {
    const std::string word = trimmed(inside), known = plain(word);
    const bool is_word = word.size() > 1 && std::ranges::all_of(word, [](unsigned char c) { return std::isalpha(c); });
    if (is_word && unit_of(word).empty() && !harmless.contains(known) && !side_of(known, Sides::any)) return word;
  }
  return "";
}

namespace {

bool is_sign(char c) { return c == '+' || c == '-'; }

/// `+toe-heel`, `L+R-`: a side with its sign each; else the word as it is.
std::vector<std::string> apart(const std::string& word, Sides sides) {
  if (word.size() < 3 || is_sign(word.front()) == is_sign(word.back())) return {word};
  std::vector<std::string> parts(1);
  for (const char c : word) {
    if (is_sign(word.front()) && is_sign(c) && !parts.back().empty()) parts.emplace_back();
    parts.back() += c;
    if (is_sign(word.back()) && is_sign(c)) parts.emplace_back();
  }
  if (parts.back().empty()) parts.pop_back();
  for (const std::string& part : parts) {
    std::string side = part;
    std::erase_if(side, is_sign);
    if (!side_of(side, sides)) return {word};
  }
  return parts;
}

}  // namespace

HeaderSign sign_in(const std::string& header, Sides sides) {
  HeaderSign out;
  bool both = false;
  const auto say = [&](const std::string& text, char sign) {
    const auto side = side_of(plain(text), sides);
    out.strange = out.strange || !side;
    if (!side) return;
    const double grows = (sign == '+') == (side->sign > 0) ? 1 : -1;
    both = both || (out.sign != 0 && out.sign != grows);
    out.sign = grows;
    out.own = out.own || side->own;
  };
  for (std::string inside : brackets(header)) {
    inside = lower(inside);
    const auto as = [&](std::string_view text, std::string_view other) {
      for (std::size_t at; (at = inside.find(text)) != inside.npos;) inside.replace(at, text.size(), other);
    };
    as("+/-", "");  // `(Right/Left +/-)` says that there are signs, not which
    as("+ve", "+"), as("-ve", "-");
    as(" positive", "+"), as("=positive", "+"), as(" negative", "-"), as("=negative", "-");
    for (const std::string_view equal : {" = ", "= ", " =", "="}) as(equal, "");
    for (const std::string& clause : words_of(inside, "/,;&")) {
      std::vector<std::string> words;
      for (const std::string& word : words_of(clause, " "))
        for (std::string& part : apart(word, sides)) words.push_back(std::move(part));
      std::string before;  // words without a sign; of a unit only what `in to out` needs
      for (std::size_t i = 0; i < words.size(); ++i) {
        std::string word = words[i];
        const bool behind = is_sign(word.back()), ahead = is_sign(word.front());
        if (word.size() == 1 && ahead) {  // it stands alone: behind its side, or before it
          std::string after;
          for (std::size_t j = i + 1; j < words.size(); ++j) after += (after.empty() ? "" : " ") + words[j];
          const bool last = side_of(plain(before), sides).has_value();
          say(last ? before : after, word.front());
          before.clear();
          if (!last) break;
        } else if (behind != ahead) {
          const char sign = behind ? word.back() : word.front();
          word.erase(behind ? word.size() - 1 : 0, 1);
          say(behind && !before.empty() ? before + " " + word : word, sign);
          before.clear();
        } else if (word == "in" || unit_of(word).empty()) {
          before += (before.empty() ? "" : " ") + word;
        }
      }
    }
  }
  if (both) return {.strange = true};
  if (out.sign != 0) out.strange = false;
  return out;
}

std::optional<Cell> number(std::string text, bool comma_is_decimal, Sides sides) {
  Cell out;
  double sign = 1;
  const auto take = [&](const Side& side) {
    sign = side.sign;
    out.own = side.own;
    out.sided = true;
  };
  out.marked = take_mark(text);
  // `R1.1`, `L 0,6`: the side stands in front.
  if (sides != Sides::none && !text.empty() && std::isalpha(static_cast<unsigned char>(text.front()))) {
    const auto gap = text.find_first_of("0123456789.,+-\xE2");
    const auto before = gap == std::string::npos ? std::nullopt : side_of(plain(text.substr(0, gap)), sides);
    if (!before) return {};
    take(*before);
    text.erase(0, gap);
  }
  for (const char* minus : {"\xE2\x88\x92", "\xE2\x80\x93"})  // typographic ones
    if (text.starts_with(minus)) text.replace(0, 3, "-");
  if (text.size() > 2 && text.front() == '(' && text.back() == ')') {  // `(0.6)`, as in accounts
    if (!std::isdigit(static_cast<unsigned char>(text[1]))) return {};
    text = "-" + text.substr(1, text.size() - 2);
  }
  const auto of_number = [](char c) { return std::string_view("0123456789.,-+eE'").find(c) != std::string_view::npos; };
  std::size_t end = 0;
  while (end < text.size() && (of_number(text[end]) || (text[end] == ' ' && end + 1 < text.size() &&
                                                        std::isdigit(static_cast<unsigned char>(text[end + 1])))))
    ++end;
  const std::string tail = trimmed(std::string_view(text).substr(end));
  std::string digits = text.substr(0, end);
  std::erase_if(digits, [&](char c) { return c == ' ' || c == '\'' || c == (comma_is_decimal ? '.' : ','); });
  std::ranges::replace(digits, ',', '.');
  if (!tail.empty()) {
    if (const auto behind = side_of(plain(tail), sides)) {
      if (out.sided) return {};
      take(*behind);
      // `5 mm Toe`: a unit may stand before the side; none does in `in to out`.
      if (const auto gap = tail.find_first_of(" \t");
          gap != std::string::npos && side_of(plain(tail.substr(gap)), sides))
        out.unit = unit_of(tail.substr(0, gap));
    } else if (out.unit = unit_of(tail); out.unit.empty()) {
      return {};
    }
  }
  if (digits.size() > 1 && is_sign(digits.back()) && !is_sign(digits.front()))  // `0.4-`
    std::ranges::rotate(digits, digits.end() - 1);
  if (!digits.empty() && digits.front() == '+') digits.erase(0, 1);
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out.value);
  if (error != std::errc() || stop != digits.data() + digits.size() || digits.empty()) return {};
  if (out.sided && out.value < 0) return {};  // `-2.5 L`: to which side?
  if (sign < 0) {
    out.value = -out.value;
    digits = negated(digits);
  }
  out.digits = digits;
  return out;
}

std::optional<double> plain_number(const std::string& cell) {
  const auto x = number(cell, false, Sides::none);
  return x ? std::optional(x->value) : std::nullopt;
}

}  // namespace hosel::app
