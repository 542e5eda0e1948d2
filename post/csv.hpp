/// Comma-separated files: a strict reader (a header, then rows of as many cells), and cells as they are written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "golf/data_error.hpp"

namespace hosel::post {

/// Cells as text, quotes removed. Row numbers count data rows from 0; `lines` gives their place in the file.
struct Sheet {
  std::string file;
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> columns;  ///< columns[c][row]
  std::vector<std::size_t> lines;

  std::size_t rows() const { return lines.size(); }
};

/// Reads RFC-4180 text: quoted cells may hold commas, quotes (doubled) and line breaks; blank lines are
/// passed over. Throws DataError on a missing file or one that is none (a pipe), text that is not UTF-8, an
/// empty or doubled header, a row of the wrong length, an open quote.
Sheet read_csv(const std::filesystem::path& file);
/// The same of a text; `name` stands for the file in errors.
Sheet parse_csv(std::string text, const std::string& name);

/// A whole cell as a number; nothing where it is text. "nan" and "inf" are numbers here.
std::optional<double> number(const std::string& cell);
/// Digits after the decimal point ("-1.3e2" counts as -1: the exponent moves the point).
int decimals(const std::string& cell);

/// A text as a cell of RFC 4180: in quotes where it holds a comma, a quote, a line break or a blank at an end. A text
/// that a spreadsheet would compute (it begins with =, @, +, - or a control and is no number) gets an apostrophe in
/// front, by which such programs know a text.
std::string csv_cell(std::string_view text);

}  // namespace hosel::post
