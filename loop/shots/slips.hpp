/// Whether the rows that are flagged one by one are single slips of the record.
#pragma once

#include <optional>
#include <vector>

#include "loop/shots/screen.hpp"
#include "loop/shots/structure.hpp"

namespace hosel::loop {

/// The column along which flagged rows stand most closely together, and how many (Kuiper's test [@kuiper], p < `gate`
/// adjusted for the columns). Rows of `lines` without a number are left out, and along a column those that are flagged
/// in it: a slip is mostly at an end of its own column. nullptr: none.
const Line* stand_together(const std::vector<RowFlag>& flagged, const std::vector<Line>& lines, double gate,
                           std::size_t& together);

/// Single slips are spread by chance: over the columns, and along every column and the session. Returns the column in
/// which more rows are flagged than if any were as likely, p < `gate` adjusted for the columns, or else along which
/// they stand together.
std::optional<Location> no_single_slips(const std::vector<RowFlag>& flagged, const std::vector<ColumnUse>& uses,
                                        const std::vector<Line>& lines, double gate);

}  // namespace hosel::loop
