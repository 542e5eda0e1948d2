/// Cells as people and programs write them: missing ones, units, numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "golf/units.hpp"

namespace hosel::app {

/// The words for a side that numbers of a quantity may have.
enum class Sides {
  none,
  across,  ///< right, open, in-to-out, a fade: positive; left, closed, out-to-in, a draw: negative
  height,  ///< up, high; down, low
  toe,     ///< toe; heel
  any
};

std::string trimmed(std::string_view text);
std::string lower(std::string_view text);

/// The words of a text, parted by any of the characters `between`.
std::vector<std::string> words_of(std::string_view text, std::string_view between = " ");

bool missing(const std::string& cell);

/// What may stand for a unit, as it is spelt in our headers, or as `si_of` knows it; empty where it is none.
std::string unit_of(std::string text);
/// `Ball Speed (mph)`, `Ball Speed [mph]`, `Ball Speed mph`, `Offset (mm toe-/heel+)`, `Offset (in mm)` -> mph, mm.
std::string unit_in(const std::string& header);
/// Where the last word of a header begins, which may be its unit: `Ball Speed mph`, `ball_speed_mph`, `BallSpeedMph`.
std::size_t unit_tail(const std::string& header);
/// What stands where units do, is built as they are and is none that is known: `Spin (turns/min)`; empty where nothing
/// is.
std::string strange_unit(std::string_view text);
/// What a header says in brackets of the sign of its numbers (`mm toe-/heel+`, `L+/R-`, `left positive`).
struct HeaderSign {
  double sign = 0;   ///< -1: they grow towards the heel, the left, down or a draw; 1: the contrary; 0: it says nothing
  bool own = false;  ///< by the player's own words (in-out, open, fade)
  bool strange = false;  ///< it has signs that are not understood
};
HeaderSign sign_in(const std::string& header, Sides sides);
/// A cell without a side in front or behind and without marks: what decides where its decimals begin.
std::string figure_of(const std::string& cell);
/// One of the unit in SI; 1 where it is unknown.
double si_of(const std::string& unit);
/// Of a unit that headers of ours may have, or of one that only files of others have.
std::optional<Dimension> dimension_of(const std::string& unit);

/// A number as text with the other sign.
std::string negated(const std::string& digits);

struct Cell {
  std::string digits;  ///< as recorded, with a decimal point and our sign
  double value = 0;
  std::string unit = {};  ///< where the cell has one of its own
  bool sided = false;     ///< it says its side
  bool own = false;       ///< its sign is the player's own: in-to-out, open, a fade
  bool marked = false;    ///< `6401*`, `6806 (est.)`: the instrument's own estimate
};
/// `1.234,5`, `2 540`, `0.4-`, `(0.6)`, `27.8 L`, `3.5R`, `R1.1`, `5 mm Toe`, `94.2 mph`, `6.1 Down`, `2.3 In-Out`.
/// Right, toe, up, in-to-out and open are positive; `sides`: which of these words a cell may have.
std::optional<Cell> number(std::string text, bool comma_is_decimal, Sides sides);
/// The value of a cell with a decimal point and no side.
std::optional<double> plain_number(const std::string& cell);

}  // namespace hosel::app
