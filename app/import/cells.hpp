/// Cells as people and programs write them: missing ones, units, numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hosel::app {

std::string trimmed(std::string_view text);

bool missing(const std::string& cell);

/// What may stand for a unit, as it is spelt in our headers; empty where it is none.
std::string unit_of(std::string text);
/// `Ball Speed (mph)`, `Ball Speed [mph]`, `Ball Speed mph`, `Offset (mm toe-/heel+)` -> mph, mm.
std::string unit_in(const std::string& header);
/// -1 where a header says in brackets that its numbers grow towards the heel, the left, down or a draw (`mm
/// toe-/heel+`), 1 where it says the contrary, 0 where it says nothing.
double sign_in(const std::string& header);
/// One of the unit in SI; 1 where it is unknown.
double si_of(const std::string& unit);

struct Cell {
  std::string digits;  ///< as recorded, with a decimal point and our sign
  double value = 0;
  std::string unit = {};  ///< where the cell has one of its own
};
/// `1.234,5`, `2 540`, `27.8 L`, `3.5R`, `5 mm Toe`, `94.2 mph`, `6.1 Down`, `2.3 In-Out`. Right, toe, up, in-to-out
/// and open are positive; `side`: a cell may say so.
std::optional<Cell> number(std::string text, bool comma_is_decimal, bool side);

}  // namespace hosel::app
