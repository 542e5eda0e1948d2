#include "post/csv.hpp"

#include <fmt/format.h>
#include <utf8.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "post/file.hpp"

namespace hosel::post {
namespace {

constexpr std::uintmax_t kMostBytes = 1'000'000'000;
constexpr std::size_t kMostColumns = 10'000;

void trim(std::string& s) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!s.empty() && blank(s.back())) s.pop_back();
  s.erase(s.begin(), std::find_if_not(s.begin(), s.end(), blank));
}

}  // namespace

Sheet read_csv(const std::filesystem::path& path) {
  std::error_code error;
  // A pipe or a device may never end.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw DataError(fmt::format("{}: cannot be read: not a regular file", path.string()));
  if (const auto size = std::filesystem::file_size(path, error); !error && size > kMostBytes)
    throw DataError(fmt::format("{}: more than {} bytes: too large for a table", path.string(), kMostBytes));
  std::string text;
  try {
    text = read_file(path);
  } catch (const std::runtime_error& e) { throw DataError(e.what()); }
  return parse_csv(std::move(text), path.string());
}

Sheet parse_csv(std::string text, const std::string& name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // the byte-order mark of spreadsheet programs

  Sheet sheet;
  sheet.file = name;
  const auto fail = [&](std::size_t line, std::string_view what) {
    throw DataError(fmt::format("{}:{}: {}", sheet.file, line, what));
  };

  std::vector<std::string> row;
  std::string cell;
  bool quoted = false, was_quoted = false, header = true;
  std::size_t line = 1, row_line = 1;
  const auto end_cell = [&] {
    if (!was_quoted) trim(cell);
    row.push_back(std::move(cell));
    cell.clear();
    was_quoted = false;
  };
  const auto end_row = [&] {
    end_cell();
    if (row.size() == 1 && row[0].empty()) {
      row.clear();
      return;
    }
    if (header) {
      if (row.size() > kMostColumns) fail(row_line, fmt::format("{} columns, more than {}", row.size(), kMostColumns));
      for (std::size_t c = 0; c < row.size(); ++c) {
        if (row[c].empty()) fail(row_line, fmt::format("column {} has no name", c + 1));
        if (std::count(row.begin(), row.end(), row[c]) > 1)
          fail(row_line, fmt::format("column '{}' stands twice", row[c]));
      }
      for (const auto& [sign, called] : {std::pair{';', "semicolons"}, {'\t', "tabs"}, {'|', "bars"}})
        if (row.size() == 1 && row[0].find(sign) != std::string::npos)
          fail(row_line, fmt::format("cells are separated by {} here: a comma is what separates cells, and a point the "
                                     "decimals",
                                     called));
      sheet.names = row;
      sheet.columns.resize(row.size());
      header = false;
    } else {
      if (row.size() != sheet.names.size())
        fail(row_line, fmt::format("{} cells where the header has {}", row.size(), sheet.names.size()));
      for (std::size_t c = 0; c < row.size(); ++c) sheet.columns[c].push_back(std::move(row[c]));
      sheet.lines.push_back(row_line);
    }
    row.clear();
  };
  if (const auto wrong = utf8::find_invalid(text.begin(), text.end()); wrong != text.end())
    fail(std::size_t(std::count(text.begin(), wrong, '\n')) + 1,
         "not UTF-8 (a file of a Western Windows program? iconv -f WINDOWS-1252 -t UTF-8 makes it so)");
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\0') fail(line, "a zero byte: this is not a text file");
    if (quoted) {
      if (c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
        cell += '"';
        ++i;
      } else if (c == '"') {
        quoted = false;
      } else {
        if (c == '\n') ++line;
        cell += c;
      }
    } else if (c == '"' && cell.find_first_not_of(" \t") == std::string::npos && !was_quoted) {
      cell.clear();
      quoted = was_quoted = true;
    } else if (c == ',') {
      end_cell();
    } else if (c == '\n') {
      end_row();
      row_line = ++line;
    } else if (was_quoted && c != '\r' && c != ' ' && c != '\t') {
      fail(line, "text after a closing quote");
    } else if (!was_quoted) {
      cell += c;
    }
  }
  if (quoted) fail(row_line, "a quote is opened and never closed");
  if (!cell.empty() || !row.empty() || was_quoted) end_row();
  if (sheet.names.empty()) fail(1, "the file is empty");
  return sheet;
}

std::optional<double> number(const std::string& cell) {
  const char* begin = cell.data();
  if (*begin == '+') {
    ++begin;
    if (*begin == '-') return {};
  }
  double x = 0;
  const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), x);
  if (end != cell.data() + cell.size() || begin == end) return {};
  if (error == std::errc::result_out_of_range) return std::strtod(begin, nullptr);  // zero or infinite, with its sign
  return error == std::errc() ? std::optional(x) : std::nullopt;
}

int decimals(const std::string& cell) {
  const auto e = cell.find_first_of("eE");
  const int exponent = e == std::string::npos ? 0 : std::atoi(cell.c_str() + e + 1);
  const auto point = cell.find('.');
  const int after = point == std::string::npos ? 0 : int((e == std::string::npos ? cell.size() : e) - point - 1);
  return after - exponent;
}

std::string csv_cell(std::string_view text) {
  std::string cell(text);
  const std::size_t first = cell.find_first_not_of(' ');  // an import may trim blanks
  if (first != cell.npos && std::string_view("=@+-\t\r\n").find(cell[first]) != std::string_view::npos && !number(cell))
    cell.insert(0, 1, '\'');
  const bool blank = !cell.empty() && (cell.front() == ' ' || cell.back() == ' ' || cell.back() == '\t');
  if (!blank && cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string out = "\"";
  for (const char c : cell) out.append(c == '"' ? 2 : 1, c);
  return out + '"';
}

}  // namespace hosel::post
