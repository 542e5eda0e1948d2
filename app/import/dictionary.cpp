#include "app/import/dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <tuple>

#include "app/reader.hpp"
#include "build_info.hpp"

namespace hosel::app {

namespace fs = std::filesystem;

std::string plain(std::string_view text) {
  std::string out;
  int depth = 0;
  for (const char c : text) {
    if (c == '(' || c == '[') ++depth;
    if (depth == 0) {
      if (std::isalnum(static_cast<unsigned char>(c))) out += char(std::tolower(static_cast<unsigned char>(c)));
      else if (!out.empty() && out.back() != ' ' && static_cast<unsigned char>(c) < 0x80) out += ' ';
    }
    if ((c == ')' || c == ']') && depth > 0) --depth;
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

std::string letters(std::string_view header) {
  std::string out = plain(header);
  std::erase(out, ' ');
  return out;
}

bool names_a_hand(const std::string& words) {
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
    if (t.flag("side", false))
      q.sides = q.name == "impact_toe"                                                            ? Sides::toe
                : q.name == "impact_high" || q.name == "launch_angle" || q.name == "attack_angle" ? Sides::height
                                                                                                  : Sides::across;
    q.zero = t.choice("zero", {"reading", "no reading"}, "reading") == "reading";
    for (const std::string& h : t.texts("headers"))
      q.headers.push_back({letters(h), h.find('[') == h.npos ? "" : unit_in(h)});
    q.headers.push_back({letters(q.name), ""});
    quantities_.push_back(std::move(q));
  }
  for (const auto& [name, into, as] : {std::tuple{"bookkeeping", &bookkeeping_, &letters}, {"words", &words_, &plain}})
    if (auto t = root.optional_table(name))
      for (const std::string& key : t->keys()) {
        const auto words = each(t->texts(key), as);
        auto& known = (*into)[key];
        known.insert(known.end(), words.begin(), words.end());
      }
  for (Table& t : root.tables("club"))
    clubs_.push_back({each(t.texts("names"), plain), t.number("head_mass_kg", {0.1, 0.5}),
                      t.number("loft_deg", {0, 70}), t.text("head", "iron")});
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
}

fs::path shipped_dictionary() {
  const fs::path beside = fs::path(HOSEL_SOURCE_DIR) / "app" / "import" / "launch_monitors.toml";
  return fs::exists(beside) ? beside : fs::path(HOSEL_INSTALLED_CASES).parent_path() / "launch_monitors.toml";
}

const MonitorQuantity* Dictionary::quantity_of(const std::string& header) const {
  const auto called = [&](const std::string& word) -> const MonitorQuantity* {
    for (const MonitorQuantity& q : quantities_)
      for (const MonitorQuantity::Header& h : q.headers)
        if (h.words == word && (h.unit.empty() || h.unit == unit_in(header))) return &q;
    return nullptr;
  };
  if (const MonitorQuantity* q = called(letters(header))) return q;
  const auto blank = header.find_last_of(" _");  // `Ball Speed mph`
  const bool tail = blank != std::string::npos && header.back() != ')' && !unit_of(header.substr(blank + 1)).empty();
  return tail ? called(letters(std::string_view(header).substr(0, blank))) : nullptr;
}

std::string Dictionary::bookkeeping_of(const std::string& header) const {
  const std::string word = letters(header);
  for (const auto& [name, words] : bookkeeping_)
    if (std::ranges::count(words, word)) return name;
  return names_a_hand(plain(header)) ? "hand" : "";
}

void Dictionary::learn(const std::string& header, std::string_view quantity) {
  if (quantity.empty()) bookkeeping_["ignored"].push_back(letters(header));
  if (const auto role = bookkeeping_.find(std::string(quantity)); role != bookkeeping_.end())
    role->second.push_back(letters(header));
  for (MonitorQuantity& q : quantities_)
    if (q.name == quantity) q.headers.push_back({letters(header), ""});
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

std::vector<std::string> Dictionary::roles() const {
  std::vector<std::string> out;
  for (const auto& [name, words] : bookkeeping_) out.push_back(name);
  return out;
}

bool Dictionary::says(std::string_view list, const std::string& cell) const {
  const auto at = words_.find(list);
  const std::string word = plain(cell);
  return at != words_.end() && !word.empty() && std::ranges::count(at->second, word);
}

bool Dictionary::begins_or_ends(std::string_view list, const std::string& cell) const {
  const std::string word = plain(cell);
  const std::string last = word.substr(word.rfind(' ') + 1);
  return says(list, cell) || says(list, word.substr(0, word.find(' '))) || says(list, last) ||
         says(std::string(list) + "_end", last);
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

std::string Dictionary::club_key(const std::string& name) const {
  const auto key = [&](const std::string& said) {
    const auto [digits, letters] = number_and_kind(said);
    if (digits.empty() || digits.size() > 2) return plain(said);
    if (letters.empty()) return said.starts_with('#') && digits.size() == 1 ? digits + "i" : digits;
    for (const auto& [kind, letter] : {std::pair{"iron", "i"}, {"wood", "w"}, {"hybrid", "h"}, {"wedge", ""}})
      if (says(kind, letters)) return digits + letter;
    return plain(said);
  };
  std::string own = key(name);
  for (const NominalClub& c : clubs_)
    for (const std::string& n : c.names)
      if (key(n) == own) return key(c.names.front());
  return own;
}

const NominalClub* Dictionary::club(const std::string& name) const {
  const std::string key = club_key(name);
  for (const NominalClub& c : clubs_)
    if (club_key(c.names.front()) == key) return &c;
  return nullptr;
}

}  // namespace hosel::app
