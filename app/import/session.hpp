/// What one export says: its columns as quantities in our units and signs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/import/by_hand.hpp"
#include "app/import/dictionary.hpp"
#include "app/import/import.hpp"
#include "app/import/sheet.hpp"

namespace hosel::app {

struct Understood {
  std::string header, name, note;  ///< name: of shots.csv; empty: goes to kept.csv
  std::vector<std::string> cells;
  std::size_t filled = 0;
  double median = 0;           ///< [SI]
  std::vector<bool> own = {};  ///< cells whose sign is the player's own (in-to-out, open); empty: none

  /// Adds to the note.
  void remark(const std::string& text) { note += (note.empty() ? "" : ", ") + text; }
};

/// What one file says, or several together.
struct Session {
  std::filesystem::path file;
  Sheet sheet;
  std::string club;  ///< of every shot, where no column names it; empty: unknown
  std::vector<Understood> columns;
  std::size_t shots = 0, other_clubs = 0, modelled = 0, left_handed = 0;
  std::vector<std::string> no_nominal;  ///< clubs that the dictionary does not know
  std::vector<std::string> told;        ///< what was decided of the whole file, a sentence each
  bool nominal_loft = false;
  Understood carry;  ///< of the monitor's own flight model; its name is its unit; empty: none

  Understood* find(std::string_view stem);
};

/// What `sheet`, read from a file, says. `club`: of the shots, where the file names none. Throws InputError in one
/// sentence.
Session understand(const std::filesystem::path& from, Sheet sheet, const std::string& club,
                   const ImportOptions& options, const Dictionary& dictionary, const ByHand& by_hand);

/// Counts what stands in the cells of a quantity anew.
void count_again(Understood& quantity);

}  // namespace hosel::app
