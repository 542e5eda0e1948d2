/// CSV files that a case names.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "golf/units.hpp"
#include "post/csv.hpp"

namespace hosel::app {

/// A CSV whose faults are faults of the input.
post::Sheet read_sheet(const std::filesystem::path& file);

/// A cell of a column as a number, NaN where it is empty. Throws InputError with file and line.
double number_in(const post::Sheet& sheet, std::size_t column, std::size_t row);

/// The numeric column `stem_unit`, with any unit of the dimension, in SI; where no unit is needed, `stem` alone. Throws
/// InputError with file and line where it is not there, has another unit or a cell that is no finite number.
std::vector<double> column(const post::Sheet& sheet, std::string_view stem, Dimension dimension,
                           bool unit_needed = true);

/// The cells of the column of that name as they stand. Throws InputError.
const std::vector<std::string>& cells_of(const post::Sheet& sheet, std::string_view name);
/// The numeric column of that name in its header's unit, NaN where a cell is empty. Throws InputError.
std::vector<double> column_with_gaps(const post::Sheet& sheet, std::string_view name);

}  // namespace hosel::app
