#include "app/import/dictionary.hpp"

#include <fmt/format.h>
#include <utf8.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "app/reader.hpp"
#include "build_info.hpp"

namespace hosel::app {

namespace fs = std::filesystem;

namespace {

/// What a character of ASCII is compared as: lower case, a blank for punctuation.
char folded(char c) {
  if (c >= 'A' && c <= 'Z') return char(c - 'A' + 'a');
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : ' ';
}

/// The same of any character: without accent, nothing for a mark or a symbol. Other scripts keep their letters.
std::u32string folded(char32_t c) {
  if (c >= 0xFF01 && c <= 0xFF5E) c -= 0xFEE0;  // full width
  if (c < 0x80) return {char32_t(folded(char(c)))};
  if (c < 0xC0) return {};  // degrees, ordinals
  // From U+00C0 on; a dot: no letter, or one that becomes two.
  constexpr std::string_view base =
      "aaaaaa.ceeeeiiiidnooooo.ouuuuy..aaaaaa.ceeeeiiiidnooooo.ouuuuy.yaaaaaaccccccccddddeeeeeeeeeegggggggghhhh"
      "iiiiiiiiii..jjkkkllllllllllnnnnnnnnnoooooo..rrrrrrssssssssttttttuuuuuuuuuuuuwwyyyzzzzzzs";
  static_assert(base.size() == 0x180 - 0xC0);
  if (c < 0x180) {
    if (c == 0xC6 || c == 0xE6) return U"ae";
    if (c == 0xDE || c == 0xFE) return U"th";
    if (c == 0xDF) return U"ss";
    if (c == 0x132 || c == 0x133) return U"ij";
    if (c == 0x152 || c == 0x153) return U"oe";
    const char letter = base[c - 0xC0];
    return letter == '.' ? std::u32string{} : std::u32string{char32_t(letter)};
  }
  if ((c >= 0x300 && c < 0x370) || (c >= 0x200B && c < 0x2010) || c == 0xFEFF) return {};  // accents by themselves
  if ((c >= 0x2000 && c < 0x2070) || (c >= 0x3000 && c < 0x3040) || c == 0x30FB) return U" ";
  if (c >= 0x2100 && c < 0x2C00) return {};
  if ((c >= 0x391 && c <= 0x3A9) || (c >= 0x410 && c < 0x430)) c += 0x20;
  if (c >= 0x400 && c < 0x410) c += 0x50;
  return {c};
}

}  // namespace

std::string plain(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  int depth = 0;
  const auto take = [&](char32_t c) {
    const bool opens = c == '(' || c == '[' || c == 0xFF08, closes = c == ')' || c == ']' || c == 0xFF09;
    if (opens) ++depth;
    if (depth == 0 && c < 0x80) {
      if (const char letter = folded(char(c)); letter != ' ' || (!out.empty() && out.back() != ' ')) out += letter;
    } else if (depth == 0) {
      for (const char32_t letter : folded(c))
        if (letter != ' ' || (!out.empty() && out.back() != ' ')) utf8::append(letter, out);
    }
    if (closes && depth > 0) --depth;
  };
  if (std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; })) {
    for (const char c : text) take(char32_t(c));
  } else {
    std::string valid;
    utf8::replace_invalid(text.begin(), text.end(), std::back_inserter(valid), U'?');
    for (auto at = valid.begin(); at != valid.end();) take(utf8::next(at, valid.end()));
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

namespace {

/// As `letters` has it, of a header that is `words` as `plain` has it.
std::string letters_of(std::string words, std::string_view header) {
  if (words.empty()) words = lower(header);  // signs alone: `#` is not `%`
  std::erase(words, ' ');
  return words;
}

}  // namespace

std::string letters(std::string_view header) { return letters_of(plain(header), header); }

bool names_a_hand(const std::string& words) {
  if (words.find("hand") == words.npos && words.find("dexterity") == words.npos) return false;
  const std::string apart = ' ' + words + ' ';
  const auto says = [&](const char* word) { return apart.find(word) != apart.npos; };
  return apart.ends_with(" hand ") || says(" handed ") || says(" handedness ") || says(" dexterity ");
}

void Dictionary::read(const fs::path& file) {
  CaseFile text(file);
  Table root = text.root();
  const auto each = [](std::vector<std::string> words, std::string (*as)(std::string_view)) {
    for (std::string& w : words) w = as(w);
    return words;
  };
  for (Table& t : root.tables("quantity")) {
    MonitorQuantity q;
    q.name = t.text("name");
    Table unit = t.table("unit");
    q.imperial = unit.text("imperial");
    q.metric = unit.text("metric");
    const auto range = t.numbers("plausible", 2);
    q.low = range[0], q.high = range[1];
    const double most = 2 * std::max(std::abs(q.low), std::abs(q.high));
    const auto possible = t.numbers("possible", 2, Range::finite(), std::vector{-most, most});
    q.least = possible[0], q.greatest = possible[1];
    if (t.flag("side", false))
      q.sides = q.name == "impact_toe"                                                            ? Sides::toe
                : q.name == "impact_high" || q.name == "launch_angle" || q.name == "attack_angle" ? Sides::height
                                                                                                  : Sides::across;
    q.zero = t.choice("zero", {"reading", "no reading"}, "reading") == "reading";
    for (const std::string& h : t.texts("headers"))
      quantity_by_letters_[letters(h)].push_back({quantities_.size(), h.find('[') == h.npos ? "" : unit_in(h)});
    quantity_by_letters_[letters(q.name)].push_back({quantities_.size(), ""});
    quantities_.push_back(std::move(q));
  }
  if (auto t = root.optional_table("bookkeeping"))
    for (const std::string& role : t->keys())
      for (const std::string& word : each(t->texts(role), letters)) add(role, word);
  if (auto t = root.optional_table("words"))
    for (const std::string& key : t->keys())
      for (std::string& word : each(t->texts(key), plain)) words_[key].push_back(std::move(word));
  for (Table& t : root.tables("club"))
    clubs_.push_back({.names = each(t.texts("names"), plain),
                      .head_mass = t.number("head_mass_kg", {0.1, 0.5}),
                      .loft = t.number("loft_deg", {0, 70}),
                      .head = t.text("head", "iron")});
  if (auto t = root.optional_table("head"))
    for (const std::string& key : t->keys()) {
      Table head = t->table(key);
      const auto list = [](const Vec3& v) { return fmt::format("[{:g}, {:g}, {:g}]", v.x(), v.y(), v.z()); };
      const Vec3 cg = head.vector("cg", "mm") * 1e3;
      const Mat3 I = head.matrix("inertia", "kg_m2");
      heads_[key] = {list(cg), fmt::format("[{}, {}, {}]", list(I.row(0)), list(I.row(1)), list(I.row(2)))};
    }
  for (Table& t : root.tables("layout"))
    layouts_.push_back({t.text("name"), plain(t.text("has", "")), t.text("preamble", ""),
                        t.choice("units", {"imperial", "metric", "si"})});
  text.finish();
  for (NominalClub& c : clubs_) {
    c.keys.clear();
    for (const std::string& name : c.names) c.keys.push_back(own_key(name));
  }
}

fs::path shipped_dictionary() {
  const fs::path beside = fs::path(HOSEL_SOURCE_DIR) / "app" / "import" / "launch_monitors.toml";
  return fs::exists(beside) ? beside : fs::path(HOSEL_INSTALLED_CASES).parent_path() / "launch_monitors.toml";
}

const MonitorQuantity* Dictionary::quantity_of(const std::string& letters, const std::string& header) const {
  const auto at = quantity_by_letters_.find(letters);
  if (at == quantity_by_letters_.end()) return nullptr;
  const MonitorQuantity* first = nullptr;  // of several, the one that was read first
  for (const Meaning& m : at->second)
    if (const MonitorQuantity* q = &quantities_[m.quantity]; !first || q < first)
      if (m.unit.empty() || m.unit == unit_in(header)) first = q;
  return first;
}

const MonitorQuantity* Dictionary::quantity_of(const std::string& header) const {
  const MonitorQuantity* q = quantity_of(letters(header), header);
  return q ? q : quantity_before_unit(header);
}

const MonitorQuantity* Dictionary::quantity_before_unit(const std::string& header) const {
  const auto tail = unit_tail(header);
  if (tail == header.size() || header.back() == ')' || unit_of(header.substr(tail)).empty()) return nullptr;
  std::string before = plain(std::string_view(header).substr(0, tail));
  if (before.ends_with(" in")) before.resize(before.size() - 3);
  return quantity_of(letters_of(before, before), header);
}

std::string Dictionary::bookkeeping_of(const std::string& header) const {
  const std::string words = plain(header);
  return role_of(words, letters_of(words, header));
}

bool Dictionary::knows(const std::string& header) const {
  const std::string words = plain(header), letters = letters_of(words, header);
  return quantity_of(letters, header) || !role_of(words, letters).empty() || quantity_before_unit(header);
}

std::string Dictionary::role_of(const std::string& words, const std::string& letters) const {
  if (const auto at = role_by_letters_.find(letters); at != role_by_letters_.end()) return at->second;
  return names_a_hand(words) || lists("lefty", words) || lists("righty", words) ? "hand" : "";
}

void Dictionary::add(const std::string& role, const std::string& letters) {
  roles_.insert(role);
  std::string& known = role_by_letters_[letters];
  if (known.empty() || role < known) known = role;
}

void Dictionary::learn(const std::string& header, std::string_view quantity) {
  if (quantity.empty()) add("ignored", letters(header));
  if (const auto role = roles_.find(quantity); role != roles_.end()) add(*role, letters(header));
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    if (quantities_[i].name == quantity) quantity_by_letters_[letters(header)].push_back({i, ""});
}

const MonitorQuantity* Dictionary::quantity(std::string_view name) const {
  const auto at = std::ranges::find(quantities_, name, &MonitorQuantity::name);
  return at == quantities_.end() ? nullptr : &*at;
}

std::vector<std::string> Dictionary::quantity_names() const {
  std::vector<std::string> out;
  for (const MonitorQuantity& q : quantities_) out.push_back(q.name);
  return out;
}

bool Dictionary::says(std::string_view list, const std::string& cell) const { return lists(list, plain(cell)); }

bool Dictionary::lists(std::string_view list, const std::string& word) const {
  const auto at = words_.find(list);
  return at != words_.end() && !word.empty() && std::ranges::find(at->second, word) != at->second.end();
}

bool Dictionary::begins_or_ends(std::string_view list, const std::string& cell) const {
  const std::string word = plain(cell);
  const std::string last = word.substr(word.rfind(' ') + 1);
  return lists(list, word) || lists(list, word.substr(0, word.find(' '))) || lists(list, last) ||
         lists(std::string(list) + "_end", last);
}

namespace {

/// Number and letters of a club's name: `Eisen 7` -> 7, "eisen".
std::pair<std::string, std::string> number_and_kind(const std::string& name) {
  std::string digits, letters;
  for (const char c : plain(name)) {
    if (std::isdigit(static_cast<unsigned char>(c))) digits += c;
    else if (c != ' ' || (!letters.empty() && letters.back() != ' ')) letters += c;
  }
  while (!letters.empty() && letters.back() == ' ') letters.pop_back();
  return {digits, letters};
}

}  // namespace

std::string Dictionary::own_key(const std::string& name) const {
  const auto [digits, letters] = number_and_kind(name);
  if (digits.empty() || digits.size() > 2) return plain(name);
  if (letters.empty()) return name.starts_with('#') && digits.size() == 1 ? digits + "i" : digits;
  for (const auto& [kind, letter] : {std::pair{"iron", "i"}, {"wood", "w"}, {"hybrid", "h"}, {"wedge", ""}})
    if (says(kind, letters)) return digits + letter;
  return plain(name);
}

std::string Dictionary::club_key(const std::string& name) const {
  const std::string own = own_key(name);
  for (const NominalClub& c : clubs_)
    if (std::ranges::count(c.keys, own)) return c.keys.front();
  return own;
}

const NominalClub* Dictionary::club(const std::string& name) const {
  const auto called = [&](const std::string& said) -> const NominalClub* {
    const std::string key = own_key(said);
    for (const NominalClub& c : clubs_)
      if (std::ranges::count(c.keys, key)) return &c;
    return nullptr;
  };
  if (const NominalClub* whole = called(name)) return whole;
  // Beside a brand, a model, a loft: `7I - Srixon ZX5`, `G430 Driver 10.5°`. One club only may be named.
  const std::vector<std::string> words = words_of(plain(name));
  const auto of_digits = [](const std::string& w) { return w.find_first_not_of("0123456789") == w.npos; };
  std::set<const NominalClub*> found;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool pair = i + 1 < words.size() && of_digits(words[i]) != of_digits(words[i + 1]);
    const NominalClub* c = pair ? called(words[i] + " " + words[i + 1]) : nullptr;
    if (c) ++i;
    else if (words[i].size() > 1 && !of_digits(words[i])) c = called(words[i]);
    if (c) found.insert(c);
  }
  return found.size() == 1 ? *found.begin() : nullptr;
}

}  // namespace hosel::app
