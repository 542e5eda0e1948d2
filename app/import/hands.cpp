#include "app/import/hands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/reader.hpp"

namespace hosel::app {
namespace {

/// What a header asks of a hand that a yes or no answers.
enum class Asked { nothing, left, right };
Asked asked_by(const Reading& r, const std::string& header) {
  const std::string words = plain(header);
  if (r.dictionary.says("lefty", header) || words.find("left handed") != words.npos) return Asked::left;
  if (r.dictionary.says("righty", header) || words.find("right handed") != words.npos) return Asked::right;
  return Asked::nothing;
}

/// Whether a cell names the left hand (1), the right one (0), or says nothing of a hand.
std::optional<bool> left_hand(const Reading& r, const std::string& cell, Asked asked) {
  const auto answer = yes_or_no(cell);
  if (r.dictionary.says("left_hand", cell) || r.dictionary.says("lefty", cell)) return true;
  if (r.dictionary.says("right_hand", cell) || r.dictionary.says("righty", cell) || missing(cell)) return false;
  if (asked == Asked::nothing || !answer) return {};
  return *answer == (asked == Asked::left);
}

bool names_hand(const Reading& r, const std::string& words) {
  return names_a_hand(words) || r.dictionary.bookkeeping_of(words) == "hand";
}

/// Whether a line above the header says that the player is left-handed: `Player: Jo, Handedness: Left`, `Righty;no`.
bool says_left(const Reading& r, const Row& row) {
  std::string line = fmt::format("{}", fmt::join(row, " "));
  std::ranges::replace_if(
      line, [](char c) { return std::string_view("()[]").find(c) != std::string_view::npos; }, ' ');
  const std::vector<std::string> words = words_of(plain(line));
  bool left = false;
  for (std::size_t i = 0; i < words.size(); ++i) {  // the words beside the hand's name, not those further on
    if (!names_hand(r, words[i])) continue;
    const auto before = i > 0 ? left_hand(r, words[i - 1], Asked::nothing) : std::nullopt;
    const Asked asked = before ? (*before ? Asked::left : Asked::right) : asked_by(r, words[i]);
    const auto hand = i + 1 < words.size() ? left_hand(r, words[i + 1], asked) : std::nullopt;
    left = left || hand.value_or(before == true);
  }
  return left;
}

/// A label of the hand above the header whose value is a number or a letter that is no hand: `Handedness;1`.
void refuse_strange_hand(const Reading& r, const Row& row) {
  std::vector<std::string> parts;  // of a line in cells of another delimiter, too
  for (const std::string& cell : row)
    for (const std::string& part : words_of(cell.empty() ? " " : cell, ",;")) parts.push_back(part);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto colon = std::min(parts[k].find(':'), parts[k].size());
    const std::string label = trimmed(parts[k].substr(0, colon));
    const std::string behind = trimmed(parts[k].substr(std::min(colon + 1, parts[k].size())));
    const std::string value = trimmed(behind.empty() && k + 1 < parts.size() ? parts[k + 1] : behind);
    const bool may_mean_a_hand = value.size() == 1 || plain_number(value);  // not `Score` in a row of headers
    if (!may_mean_a_hand || !names_hand(r, plain(label)) || asked_by(r, label) != Asked::nothing ||
        left_hand(r, value, Asked::nothing))
      continue;
    throw InputError(
        fmt::format("{}: above the header '{}' is '{}', neither left nor right: --left-handed mirrors every shot; "
                    "for a right-handed player delete the line",
                    r.session.file.string(), label, value));
  }
}

}  // namespace

bool names_hands(const Reading& r, std::size_t c) {
  const bool sides = r.dictionary.says("may_name_hands", r.session.sheet.names[c]);
  return !r.is_empty(c) && std::ranges::all_of(r.session.sheet.rows, [&](const Row& row) {
    return missing(row[c]) || r.dictionary.says("lefty", row[c]) || r.dictionary.says("righty", row[c]) ||
           (sides && left_hand(r, row[c], Asked::nothing));
  });
}

void mirror_left_hand(Reading& r) {
  const Sheet& sheet = r.session.sheet;
  std::vector<bool> left(sheet.rows.size(), r.options.left_handed);
  for (const Row& row : sheet.before) {
    if (!r.options.left_handed) refuse_strange_hand(r, row);
    if (says_left(r, row)) left.assign(left.size(), true);
  }
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (r.roles[c] != "hand") continue;
    std::size_t right = 0;
    for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
      const auto hand = left_hand(r, sheet.rows[i][c], asked_by(r, sheet.names[c]));
      if (!hand)
        throw InputError(
            fmt::format("{}: column '{}', shot {}: '{}' is neither left nor right; --column '{}=' leaves "
                        "it out, --left-handed mirrors every shot",
                        r.session.file.string(), sheet.names[c], i + 1, sheet.rows[i][c], sheet.names[c]));
      left[i] = left[i] || *hand;
      right += !*hand && !missing(sheet.rows[i][c]);
    }
    if (r.options.left_handed && right > 0)
      r.session.told.push_back(
          fmt::format("column '{}' says right-handed in {} of {} shots, which --left-handed mirrors "
                      "all the same",
                      sheet.names[c], right, sheet.rows.size()));
  }
  for (const char* q : {"azimuth", "spin_axis", "sidespin", "club_path", "face_angle", "face_to_path"}) {
    Understood* u = r.session.find(q);
    if (!u) continue;
    for (std::size_t i = 0; i < u->cells.size(); ++i)
      if (left[i] && !u->own[i] && !u->cells[i].empty()) u->cells[i] = negated(u->cells[i]);
    count_again(*u);
  }
  r.session.left_handed = std::size_t(std::ranges::count(left, true));
}

}  // namespace hosel::app
