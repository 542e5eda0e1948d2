/// What --column and --keep say of a file's columns.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "app/import/dictionary.hpp"
#include "app/import/import.hpp"
#include "app/import/sheet.hpp"

namespace hosel::app {

/// What --column says.
struct ByHand {
  std::map<std::string, std::string> quantity;  ///< header -> quantity with unit
  std::set<std::string> turned;                 ///< headers whose numbers grow the other way

  /// What is said of a column: by its whole header, else by its words where no other column's are said whole; null
  /// where nothing is.
  const std::string* of(const std::string& header, const Row& headers) const;
  /// Whether its numbers grow the other way.
  bool turns(const std::string& header) const;
};

/// Reads --column and teaches the dictionary what it says.
ByHand read_by_hand(const ImportOptions& options, Dictionary& dictionary);

/// Every header that --column and --keep name must be that of a column in a file at least.
void check_headers(const ImportOptions& options, const ByHand& by_hand, const std::vector<Sheet>& sheets);

}  // namespace hosel::app
