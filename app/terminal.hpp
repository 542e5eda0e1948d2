/// What reaches a terminal: no text of a case, a table or a path may move its cursor or end its line.
#pragma once

#include <string>
#include <string_view>

#include "post/text_table.hpp"

namespace hosel::app {

/// The text with a blank for every control character and every kind of line break but `\n`, and a question mark for
/// what is no UTF-8.
std::string printable(std::string_view text);
/// The same as one line, no longer than a person reads: of a longer one the beginning and the end.
std::string one_line(std::string_view text);

/// The table in parts that fit into `width` characters, each with the first column and the next ones: a terminal would
/// wrap its lines. 0: whole, as it is where no part would fit either, since the first column is a sentence.
std::string folded(const post::TextTable& table, std::size_t width);
/// Of the terminal that the standard output is; 0 where it is none.
std::size_t terminal_width();

/// Gives the standard streams that are closed a place to go: else the first files that are opened take theirs.
void open_standard_streams();
/// Throws std::runtime_error where what was printed could not be written: a full disk, a device that refuses.
void flush_output();

}  // namespace hosel::app
