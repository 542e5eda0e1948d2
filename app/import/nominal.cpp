#include "app/import/nominal.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/reader.hpp"

namespace hosel::app {
namespace {

/// The header of a column that has no role and whose cells are clubs, by more than their numbers.
std::string looks_like_clubs(const Reading& r) {
  for (std::size_t c = 0; c < r.roles.size(); ++c)
    if (r.roles[c].empty() && !r.session.sheet.names[c].empty() &&
        std::ranges::all_of(r.session.sheet.rows,
                            [&](const Row& row) { return r.dictionary.club(row[c]) && !plain_number(row[c]); }))
      return r.session.sheet.names[c];
  return "header";
}

}  // namespace

void add_nominal(Reading& r) {
  const Understood* clubs = r.session.find("club");
  if (!clubs) {
    r.session.club = r.club;
    if (!r.club.empty() && r.club != r.options.club)
      r.session.told.push_back(fmt::format("club, from the name of the file: {}", r.club));
  }
  std::vector<std::string>& unknown = r.session.no_nominal;
  // Cells of a quantity, those that are empty from the shot's club.
  const auto nominal = [&](double NominalClub::*what, std::string_view option, Understood u) {
    u.cells.resize(r.session.shots);
    for (std::size_t i = 0; i < r.session.shots; ++i) {
      if (!u.cells[i].empty()) continue;
      const std::string name = clubs ? clubs->cells[i] : r.session.club;
      const NominalClub* entry = r.dictionary.club(name);
      if (!entry && !std::ranges::count(unknown, name)) unknown.push_back(name);
      u.cells[i] = entry ? fmt::format("{:g}", entry->*what) : "";
      u.filled += entry != nullptr;
    }
    if (u.filled == 0) {
      const std::string name = clubs ? clubs->cells.front() : r.session.club;
      throw InputError(
          !name.empty()
              ? fmt::format("{}: {} is not a known club, and the file has no {}: a [[club]] in --dictionary FILE makes "
                            "it known, --club NAME says which it is where every shot is of it; a column "
                            "head_mass_kg serves, too",
                            r.session.file.string(),
                            clubs ? fmt::format("'{}' ({})", name, clubs->header) : "'" + name + "'", option)
              : fmt::format("{}: {} is not in the file, and no club is known to take it from (no column of clubs; "
                            "--column '{}=club' names one); --club NAME names the club of every shot",
                            r.session.file.string(), option, looks_like_clubs(r)));
    }
    return u;
  };
  if (!r.session.find("dynamic_loft")) {
    r.session.columns.push_back(nominal(&NominalClub::loft, "dynamic loft",
                                        {.header = "(nominal)",
                                         .name = "dynamic_loft_deg",
                                         .note = "not recorded: nominal of the club, +- 4 deg",
                                         .cells = {}}));
    r.session.nominal_loft = true;
  }
  if (Understood* mass = r.session.find("head_mass")) {
    const std::size_t recorded = mass->filled;
    if (recorded < r.session.shots) {
      *mass = nominal(&NominalClub::head_mass, "head mass", *mass);
      mass->remark(fmt::format("nominal of the club in {} of {} shots", mass->filled - recorded, r.session.shots));
    }
  } else
    r.session.columns.push_back(nominal(
        &NominalClub::head_mass, "head mass",
        {.header = "(nominal)", .name = "head_mass_kg", .note = "not recorded: nominal of the club", .cells = {}}));
}

}  // namespace hosel::app
