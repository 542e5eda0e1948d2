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
/// `Ball Speed (mph)`, `Ball Speed [mph]`, `Ball Speed mph` -> mph.
std::string unit_in(const std::string& header);
/// One of the unit in SI; 1 where it is unknown.
double si_of(const std::string& unit);

struct Cell {
  std::string digits;  ///< as recorded, with a decimal point and our sign
  double value = 0;
};
/// `1.234,5`, `2 540`, `27.8 L`, `3.5R`, `5 mm Toe`, `94.2 mph`. Right, toe and up are positive; `side`: a cell may
/// say so.
std::optional<Cell> number(std::string text, bool comma_is_decimal, bool side);

}  // namespace hosel::app
