/// Whether the commas of a file's numbers part decimals or thousands.
#pragma once

#include <filesystem>
#include <string>

#include "app/import/sheet.hpp"

namespace hosel::app {

/// Of a whole file: 1 where a column of it surely has decimal commas and none has points, -1 the contrary, else 0.
int decimal_of(const Sheet& sheet);

/// Of a column's cells: by themselves, else by the rest of the file. Throws InputError where they differ.
bool decimal_comma(const Row& cells, const Sheet& sheet, const std::string& header, const std::filesystem::path& file);

}  // namespace hosel::app
