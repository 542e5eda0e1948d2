#include "app/import/roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/import/hands.hpp"
#include "app/reader.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

/// "Club" and "Ball" are names where their cells are not numbers, speeds where they are; "Ball" without a unit, and
/// beside a column of ball speed, is a number of the ball.
bool is_speed(const Reading& r, std::size_t c, const std::string& role) {
  const Sheet& sheet = r.session.sheet;
  const auto same = std::ranges::count_if(sheet.names, [&](const std::string& n) {
    return r.dictionary.quantity_of(n) == r.dictionary.quantity_of(sheet.names[c]);
  });
  const bool unit = !r.headed_unit(c).empty();
  return std::ranges::all_of(sheet.rows, [&](const Row& row) {
    return missing(row[c]) || (plain_number(row[c]) && (unit || (role == "ball" && same == 1)));
  });
}

/// A column about spin that holds nothing but words for measured and estimated.
bool tells_how_spin_was_found(const Reading& r, std::size_t c) {
  if (!says_any(r.session.sheet.names[c], {"spin"})) return false;
  std::size_t said = 0;
  for (const Row& row : r.session.sheet.rows) {
    if (missing(row[c])) continue;
    if (!r.dictionary.says("estimated", row[c]) && !r.dictionary.says("measured", row[c])) return false;
    ++said;
  }
  return said > 0;
}

}  // namespace

void find_roles(Reading& r) {
  const Sheet& sheet = r.session.sheet;
  r.roles.assign(sheet.names.size(), "");
  std::map<std::string, std::pair<std::size_t, std::size_t>> best;  // role -> known cells, column
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    if (r.by_hand.of(sheet.names[c], sheet.names)) continue;
    std::string role = r.dictionary.bookkeeping_of(sheet.names[c]);
    if ((role == "club" || role == "ball") && r.dictionary.quantity_of(sheet.names[c]) && is_speed(r, c, role))
      role.clear();
    if (role.empty() && tells_how_spin_was_found(r, c)) role = "accuracy";
    if (role.empty() && !r.dictionary.quantity_of(sheet.names[c]) && names_hands(r, c)) role = "hand";
    if ((role == "club" || role == "ball") && r.dictionary.quantity_of(sheet.names[c]))
      r.roles[c] = "aside";  // names in any case
    if (role.empty() || r.is_empty(c)) continue;
    if (role == "accuracy") {  // one for the rate and one for the axis
      r.roles[c] = role;
      continue;
    }
    const auto known = role != "club" ? 1 : std::size_t(std::ranges::count_if(sheet.rows, [&](const Row& row) {
      return r.dictionary.club(row[c]) != nullptr;
    }));
    const auto [at, first] = best.try_emplace(role, known, c);
    if (!first && known > at->second.first) at->second = {known, c};
  }
  for (const auto& [role, at] : best) r.roles[at.second] = role;
}

void leave_out_unused(Reading& r) {
  std::vector<Row>& rows = r.session.sheet.rows;
  for (const auto& [role, unwanted] : {std::pair{"used", false}, {"deleted", true}}) {
    const auto c = r.column_of(role);
    if (!c) continue;
    const auto marked = [&](const Row& row) { return yes_or_no(row[*c]) == unwanted; };
    const auto n = std::size_t(std::ranges::count_if(rows, marked));
    const std::string& header = r.session.sheet.names[*c];
    if (n == rows.size())
      r.session.told.push_back(fmt::format("'{}' leaves out every shot: all of them stay in", header));
    else if (n > 0) {
      std::erase_if(rows, marked);
      r.session.told.push_back(
          fmt::format("left out by '{}': {}; --column '{}=' takes them", header, post::counted(n, "shot"), header));
    }
  }
}

void keep_one_club(Reading& r) {
  const auto c = r.column_of("club");
  if (r.options.club.empty() || !c) return;
  Sheet& sheet = r.session.sheet;
  std::vector<std::string> names;
  for (const Row& row : sheet.rows)
    if (!std::ranges::count(names, row[*c])) names.push_back(row[*c]);
  const NominalClub* wanted = r.dictionary.club(r.options.club);
  const auto is_it = [&](const std::string& name) {
    return r.dictionary.club_key(name) == r.dictionary.club_key(r.options.club) ||
           (wanted && r.dictionary.club(name) == wanted);
  };
  // `Irn` for every shot says no more than that they are of one club.
  if (names.size() == 1 && wanted && !r.dictionary.club(names[0]) && !is_it(names[0])) {
    r.roles[*c] = "aside";
    r.session.told.push_back(fmt::format("'{}' in column '{}' is not a known club: taken as {}, by --club", names[0],
                                         sheet.names[*c], r.options.club));
    return;
  }
  r.session.other_clubs = sheet.rows.size();
  std::erase_if(sheet.rows, [&](const Row& row) { return !is_it(row[*c]); });
  r.session.other_clubs -= sheet.rows.size();
  if (sheet.rows.empty())
    throw InputError(fmt::format("{}: no shot with club '{}'; there are: {}", r.session.file.string(), r.options.club,
                                 fmt::join(names, ", ")));
}

void one_name_a_club(Reading& r) {
  Understood* clubs = r.session.find("club");
  if (!clubs) return;
  std::map<std::string, std::string> names;
  std::set<std::string> said;
  for (std::string& cell : clubs->cells) {
    if (cell.empty()) continue;
    const std::string& first = names.try_emplace(r.dictionary.club_key(cell), cell).first->second;
    if (cell != first && said.insert(cell).second) clubs->remark(fmt::format("'{}' is '{}'", cell, first));
    cell = first;
  }
}

}  // namespace hosel::app
