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
/// What a header says in brackets of the sign of its numbers (`mm toe-/heel+`).
struct HeaderSign {
  double sign = 0;   ///< -1: they grow towards the heel, the left, down or a draw; 1: the contrary; 0: it says nothing
  bool own = false;  ///< by the player's own words (in-out, open, fade)
};
HeaderSign sign_in(const std::string& header);
/// A cell without a side in front or behind and without marks: what decides where its decimals begin.
std::string figure_of(const std::string& cell);
/// One of the unit in SI; 1 where it is unknown.
double si_of(const std::string& unit);

struct Cell {
  std::string digits;  ///< as recorded, with a decimal point and our sign
  double value = 0;
  std::string unit = {};  ///< where the cell has one of its own
  bool sided = false;     ///< it says its side
  bool own = false;       ///< its sign is the player's own: in-to-out, open, a fade
  bool marked = false;    ///< `6401*`, `6806 (est.)`: the instrument's own estimate
};
/// `1.234,5`, `2 540`, `27.8 L`, `3.5R`, `R1.1`, `5 mm Toe`, `94.2 mph`, `6.1 Down`, `2.3 In-Out`. Right, toe, up,
/// in-to-out and open are positive; `side`: a cell may say so.
std::optional<Cell> number(std::string text, bool comma_is_decimal, bool side);

}  // namespace hosel::app
