/// What launch monitors call things: quantities, bookkeeping, clubs, layouts, from launch_monitors.toml.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/import/cells.hpp"

namespace hosel::app {

struct MonitorQuantity {
  std::string name, imperial, metric;
  double low = 0, high = 0;        ///< of a column's median [SI]
  double least = 0, greatest = 0;  ///< of a cell: beyond them no instrument has measured it [SI]
  Sides sides = Sides::none;       ///< words that cells and headers may have
  bool zero = true;                ///< 0 may be measured, else it stands for no reading
};
struct NominalClub {
  std::vector<std::string> names, keys;  ///< keys: `club_key` of each name
  double head_mass = 0;                  ///< [kg]
  double loft = 0;                       ///< at impact [deg]
  std::string head;                      ///< one of Dictionary::heads
};
/// The head that a case begins with, as its TOML has it.
struct NominalHead {
  std::string cg_mm, inertia_kg_m2;
};
/// A vendor's file that names no units.
struct MonitorLayout {
  std::string name;
  std::string has;       ///< a header that only it has
  std::string preamble;  ///< how its first line begins
  std::string units;     ///< imperial, metric, si (lengths in m)
};

class Dictionary {
 public:
  /// Entries of `file` count before those read later.
  void read(const std::filesystem::path& file);

  /// A header that a person names: of this quantity or role, or, with none, of no interest.
  void learn(const std::string& header, std::string_view quantity);

  const MonitorQuantity* quantity_of(const std::string& header) const;
  const MonitorQuantity* quantity(std::string_view name) const;
  std::vector<std::string> quantity_names() const;
  std::string bookkeeping_of(const std::string& header) const;  ///< the role of a header, "" where it has none
  bool knows(const std::string& header) const;                  ///< whether it has a quantity or a role
  const std::set<std::string, std::less<>>& roles() const { return roles_; }  ///< club, shot, hand, ...
  /// `7Iron`, `7-iron`, `Iron 7`, `7i`, `i7`, `Eisen 7` are one club, `DR` and `Driver` another. Words beside it are
  /// its brand's: `7I - Srixon ZX5`.
  const NominalClub* club(const std::string& name) const;
  /// One spelling of a club's name: that of the nominal clubs where it is one, else number and kind (`7i`), else as
  /// `plain` has it.
  std::string club_key(const std::string& name) const;
  /// Whether a cell is one of the words of a list in [words], as `plain` has it.
  bool says(std::string_view list, const std::string& cell) const;
  /// Whether its first or its last word is, or its last one of the list with _end behind its name.
  bool begins_or_ends(std::string_view list, const std::string& cell) const;
  const std::vector<MonitorLayout>& layouts() const { return layouts_; }
  const std::map<std::string, NominalHead>& heads() const { return heads_; }

 private:
  struct Meaning {
    std::size_t quantity;
    std::string unit;  ///< that a header must have to be meant; empty: any
  };
  const MonitorQuantity* quantity_of(const std::string& letters, const std::string& header) const;
  const MonitorQuantity* quantity_before_unit(const std::string& header) const;  ///< `Ball Speed mph`
  std::string role_of(const std::string& words, const std::string& letters) const;
  bool lists(std::string_view list, const std::string& word) const;  ///< `says` of a word as `plain` has it
  void add(const std::string& role, const std::string& letters);
  std::string own_key(const std::string& name) const;  ///< without what nominal clubs are called
  std::vector<MonitorQuantity> quantities_;
  std::map<std::string, std::vector<Meaning>> quantity_by_letters_;  ///< as `letters` has a header
  std::map<std::string, std::string> role_by_letters_;
  std::set<std::string, std::less<>> roles_;
  std::map<std::string, std::vector<std::string>, std::less<>> words_;
  std::vector<NominalClub> clubs_;
  std::vector<MonitorLayout> layouts_;
  std::map<std::string, NominalHead> heads_;
};

/// Where the shipped dictionary is: in the tree, else installed.
std::filesystem::path shipped_dictionary();

/// Whether a header, as `plain` has it, is about the player's hand: `player hand`, `left handed`; not `hand speed`.
bool names_a_hand(const std::string& words);

/// Lower case, without accents and what stands in brackets, single blanks for punctuation; letters of other scripts
/// stay.
std::string plain(std::string_view text);

/// As headers are compared: `FaceToTarget` is `face to target`.
std::string letters(std::string_view header);

}  // namespace hosel::app
