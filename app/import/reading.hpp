/// One file being understood: what the steps of `understand` share.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/import/by_hand.hpp"
#include "app/import/session.hpp"

namespace hosel::app {

/// Each step reads what the steps before it found.
struct Reading {
  const ImportOptions& options;
  const Dictionary& dictionary;
  const ByHand& by_hand;
  Session session;
  std::string club;  ///< of every shot, where no column names it
  std::string family = !options.units.empty() ? options.units : session.sheet.family;
  std::vector<std::string> roles = {};                            ///< of every column; empty: none
  std::vector<std::pair<std::size_t, double>> placeholders = {};  ///< row and value that are no reading
  std::string speed_unit = {};                                    ///< of a file that names none; empty: not known
  bool by_carry = false;                                          ///< it is not the layout's

  bool is_empty(std::size_t column) const;
  /// The cells of a column, those that say nothing empty.
  Row cells(std::size_t column) const;
  std::optional<std::size_t> column_of(std::string_view role) const;
  /// The unit in a column's header or in the row of units; empty where neither has one.
  std::string headed_unit(std::size_t column) const;
  /// From the header, the row of units or the first cell, of a column of distances; empty where none of them says.
  std::string stated_length(std::size_t column) const;
  /// Throws InputError where cells of the column write their decimals otherwise than others.
  bool has_decimal_comma(std::size_t column) const;
};

/// Empties the cells of the rows where `which`; how many had something.
std::size_t blank(Understood& quantity, const std::vector<bool>& which);

/// Whether a text has one of these words in it.
bool says_any(const std::string& text, std::initializer_list<const char*> words);

/// Whether a cell answers a question with yes or with no, or with neither.
std::optional<bool> yes_or_no(const std::string& cell);

}  // namespace hosel::app
