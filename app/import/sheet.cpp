#include "app/import/sheet.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utf8.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "app/import/statistics.hpp"
#include "app/reader.hpp"
#include "post/parse_json.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// Which byte order of UTF-16 a text without a mark is in: half of its Latin letters' bytes are zeros. Nothing where it
/// is no such text.
std::optional<bool> little_endian_by_zeros(const std::string& raw) {
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < raw.size(); ++i) zeros[i % 2] += raw[i] == '\0';
  if (zeros[0] > 8 * zeros[1]) return false;
  if (zeros[1] > 8 * zeros[0]) return true;
  return {};
}

/// Of files that are no text: what they are, and how to get one.
std::string not_a_text(const std::string& raw) {
  for (const auto& [begins, what] : {std::pair{"PK\x03\x04", "a workbook (.xlsx, .ods, .numbers) or another archive"},
                                     {"\xD0\xCF\x11\xE0", "an old Excel workbook (.xls)"}})
    if (raw.starts_with(begins))
      return fmt::format(
          "{}: open it in a spreadsheet program, choose the sheet with the shots, save that as CSV "
          "('CSV UTF-8' in Excel), and import the CSV",
          what);
  return raw.starts_with("%PDF") ? "a PDF: export the session as CSV" : "not a text file";
}

/// The file as UTF-8 without a byte-order mark: UTF-8, UTF-16, else Latin-1.
std::string read_utf8(const fs::path& file) {
  constexpr std::uintmax_t most = 64u << 20;
  std::error_code none;
  if (!fs::is_regular_file(file, none))
    throw InputError(fmt::format("{}: {}", file.string(),
                                 fs::is_directory(file, none) ? "a directory: the exported file itself is wanted"
                                 : fs::exists(file, none)     ? "no regular file"
                                                              : "no such file"));
  if (fs::file_size(file, none) > most)
    throw InputError(fmt::format("{}: more than 64 MiB: this is no launch monitor's session", file.string()));
  std::ifstream in(file, std::ios::binary);
  std::string raw((std::istreambuf_iterator<char>(in)), {});
  const auto byte = [&](std::size_t i) { return unsigned(static_cast<unsigned char>(raw[i])); };
  const auto utf16 = [&](bool little, std::size_t begin) {
    std::u16string units;
    for (std::size_t i = begin; i + 1 < raw.size(); i += 2)
      units += char16_t(little ? byte(i) | byte(i + 1) << 8 : byte(i) << 8 | byte(i + 1));
    return utf8::utf16to8(units);
  };
  if (raw.starts_with("\xFF\xFE") || raw.starts_with("\xFE\xFF")) try {
      return utf16(byte(0) == 0xFF, 2);
    } catch (const utf8::exception&) {
      throw InputError(fmt::format("{}: neither UTF-16, as its first bytes say, nor another text", file.string()));
    }
  if (raw.starts_with("\xEF\xBB\xBF")) raw.erase(0, 3);
  if (const bool document = raw.starts_with("PK\x03\x04") || raw.starts_with("%PDF");
      document || raw.find('\0') != std::string::npos) {
    if (const auto little = document ? std::nullopt : little_endian_by_zeros(raw)) try {
        if (std::string text = utf16(*little, 0); text.find('\0') == std::string::npos) return text;
      } catch (const utf8::exception&) {}  // no text in either order
    throw InputError(fmt::format("{}: {}", file.string(), not_a_text(raw)));
  }
  if (utf8::is_valid(raw)) return raw;
  std::string out;
  for (std::size_t i = 0; i < raw.size(); ++i) utf8::append(char32_t(byte(i)), out);
  return out;
}

/// The same, its unbreakable and narrow blanks as plain ones, and so what parts thousands in `6\u2019279`.
std::string read_text(const fs::path& file) {
  std::string text = read_utf8(file);
  const std::string_view mark = "\xE2\x80\x99";
  for (std::size_t at = 0; (at = text.find(mark, at)) != text.npos; ++at)
    if (at + mark.size() < text.size() && std::isdigit(static_cast<unsigned char>(text[at + mark.size()])))
      text.replace(at, mark.size(), "'");
  for (const std::string_view blank : {"\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89"})
    for (std::size_t at = 0; (at = text.find(blank, at)) != text.npos; ++at) text.replace(at, blank.size(), " ");
  return text;
}

std::vector<Row> split(const std::string& text, char delimiter) {
  std::vector<Row> rows;
  Row row;
  std::string cell;
  bool quoted = false;
  const auto end_row = [&] {
    row.push_back(trimmed(cell));
    cell.clear();
    if (std::ranges::any_of(row, [](const std::string& c) { return !c.empty(); })) rows.push_back(row);
    row.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') cell += c;
      else if (i + 1 < text.size() && text[i + 1] == '"') cell += text[++i];
      else quoted = false;
    } else if (c == '"' && trimmed(cell).empty()) {
      cell.clear();
      quoted = true;
    } else if (c == delimiter) {
      row.push_back(trimmed(cell));
      cell.clear();
    } else if (c == '\n' || c == '\r') {
      end_row();
    } else {
      cell += c;
    }
  }
  end_row();
  return rows;
}

/// Of a text, a number or a truth.
std::string cell_of(const nlohmann::json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// The part of a path of names that the dictionary knows, from the left: `data Measurement BallSpeed` -> `BallSpeed`.
std::string known_name(const Dictionary& d, std::string path) {
  while (!path.empty()) {
    if (d.knows(path)) return path;
    const auto blank = path.find(' ');
    path = blank == std::string::npos ? "" : path.substr(blank + 1);
  }
  return "";
}

void flatten(const nlohmann::json& node, const std::string& path, std::map<std::string, std::string>& out) {
  if (node.is_object() && node.contains("value") && node.contains("unit") && node["unit"].is_string() &&
      (node["value"].is_number() || node["value"].is_string())) {  // {"value": 111.2, "unit": "mph"}
    out[path] = cell_of(node["value"]) + " " + cell_of(node["unit"]);
  } else if (node.is_object()) {
    for (const auto& [key, value] : node.items()) flatten(value, path.empty() ? key : path + " " + key, out);
  } else if (node.is_primitive() && !node.is_null()) {
    out[path] = cell_of(node);
  } else if (node.is_array() && !node.empty() && node.front().is_string()) {
    for (const auto& word : node)
      if (word.is_string()) out[path] += (out[path].empty() ? "" : " ") + word.get<std::string>();
  }
}

/// How a shot is known among other objects: by the quantities in it.
std::size_t known_names(const Dictionary& d, const nlohmann::json& object) {
  std::map<std::string, std::string> flat;
  flatten(object, "", flat);
  return std::size_t(std::ranges::count_if(flat, [&](const auto& e) { return known_name(d, e.first) != ""; }));
}

/// Every shot gets a cell for every name: a file of some megabytes could ask for a thousand times that.
void check_size(const fs::path& file, std::size_t names, std::size_t shots) {
  constexpr std::size_t most_names = 1000, most_shots = 100'000;
  if (names > most_names || shots > most_shots)
    throw InputError(fmt::format("{}: {} names and {} rows, more than {} and {}: this is no launch monitor's session",
                                 file.string(), names, shots, most_names, most_shots));
}

/// A list of objects in a document, and what its ancestors say of all of them: the club, the player, the hand.
struct ShotList {
  std::string path;  ///< names of the keys that lead to it
  const nlohmann::json* list = nullptr;
  std::map<std::string, std::string> said;
};

void find_lists(const Dictionary& d, const nlohmann::json& node, const std::string& path,
                std::map<std::string, std::string> said, std::vector<ShotList>& out) {
  if (node.is_array()) {
    if (!node.empty() && node.front().is_object()) out.push_back({path, &node, said});
    for (const auto& child : node)
      if (child.is_structured()) find_lists(d, child, path + "/", said, out);
  }
  if (!node.is_object()) return;
  for (const auto& [key, value] : node.items())
    if (value.is_primitive() && !value.is_null()) {
      const std::string role = d.bookkeeping_of(known_name(d, key));
      const std::string text = cell_of(value);
      // A hand that is a number is asked about, like that of a column.
      if (!role.empty() && role != "shot" && role != "carry" && (role == "hand" || !plain_number(text)))
        said[key] = text;
    }
  for (const auto& [key, value] : node.items())
    if (value.is_structured()) find_lists(d, value, path + "/" + key, said, out);
}

/// One document, or one on each line.
nlohmann::json documents(const std::string& text) {
  try {
    return post::parse_json(text);
  } catch (const std::exception&) {
    nlohmann::json all = nlohmann::json::array();
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (!trimmed(line).empty()) all.push_back(post::parse_json(line));
    if (all.size() < 2) throw;
    return all;
  }
}

Sheet read_json(const std::string& text, const fs::path& file, const Dictionary& d) {
  nlohmann::json document;
  try {
    document = documents(text);
  } catch (const std::exception& e) { throw InputError(fmt::format("{}: broken JSON ({})", file.string(), e.what())); }
  // The shots are the lists under one path whose objects know most names, the longest of several. A trajectory is a
  // list as well: where the document itself knows more than twice as many names, it is the one shot.
  std::vector<ShotList> lists;
  find_lists(d, document, "", {}, lists);
  const ShotList* best = nullptr;
  std::size_t known_best = 0;
  for (const ShotList& l : lists) {
    const std::size_t names = known_names(d, l.list->front());
    if (!best || names > known_best || (names == known_best && l.list->size() > best->list->size()))
      best = &l, known_best = names;
  }
  if (document.is_object() && known_names(d, document) > std::max<std::size_t>(1, 2 * known_best)) best = nullptr;
  nlohmann::json shots = nlohmann::json::array();
  std::vector<const std::map<std::string, std::string>*> said_above;
  for (const ShotList& l : lists) {
    if (!best || l.path != best->path) continue;
    for (const auto& shot : *l.list) shots.push_back(shot), said_above.push_back(&l.said);
  }
  if (!best) shots.push_back(document), said_above.push_back(nullptr);
  Sheet sheet;
  std::vector<std::map<std::string, std::string>> flat;
  std::set<std::string> known, every;
  std::map<std::string, std::string> standing;  // the player's hand and club, told apart from the shots that follow
  for (std::size_t k = 0; k < shots.size(); ++k) {
    std::map<std::string, std::string> said;
    flatten(shots[k], "", said);
    for (const auto& [key, value] : said) every.insert(key);
    const auto reading = [&](const auto& entry) {
      const auto x = number(entry.second, false, Sides::any);
      return x && x->value != 0 && d.quantity_of(known_name(d, entry.first));
    };
    if (std::ranges::none_of(said, reading)) {
      ++sheet.messages;
      for (const auto& [key, value] : said) {
        const std::string role = d.bookkeeping_of(known_name(d, key));
        if (!role.empty() && role != "shot" && !missing(value)) standing[key] = value;
      }
      continue;
    }
    said.insert(standing.begin(), standing.end());  // what the shot itself says stays
    if (said_above[k]) said.insert(said_above[k]->begin(), said_above[k]->end());
    for (const auto& [key, value] : said)
      if (known.insert(key).second) sheet.names.push_back(key);
    flat.push_back(std::move(said));
  }
  check_size(file, every.size(), shots.size());
  for (auto& shot : flat) {
    Row row;
    for (const std::string& name : sheet.names) row.push_back(shot.contains(name) ? shot[name] : "");
    sheet.rows.push_back(std::move(row));
  }
  // The known end of a path is the column's name, where no other column has it.
  for (std::string& name : sheet.names)
    if (const std::string end = known_name(d, name); !end.empty() && !std::ranges::count(sheet.names, end)) name = end;
  return sheet;
}

/// Different ones: a row of groups says `Ball` above each of the ball's columns.
std::size_t known_cells(const Dictionary& d, const Row& row) {
  return std::size_t(std::ranges::count_if(std::set<std::string>(row.begin(), row.end()),
                                           [&](const std::string& c) { return d.knows(c); }));
}

/// Groups in the row above a header, each over its own columns and those right of it without one: `Speed` below `Ball`
/// is `Ball Speed`. A name that is known and stands once needs no group. Over a blank or a unit the word itself is the
/// name.
void name_by_groups(Row& names, const Row& groups, const Dictionary& d) {
  const Row alone = names;
  std::string group;
  for (std::size_t c = 0; c < std::min(names.size(), groups.size()); ++c) {
    if (!groups[c].empty()) group = groups[c];
    const std::string both = group + " " + alone[c];
    if (plain(alone[c]).empty()) {
      if (!groups[c].empty() && d.knows(both)) names[c] = trimmed(both);
      continue;
    }
    const bool clear = d.knows(alone[c]) && std::ranges::count(alone, alone[c]) == 1;
    if (!clear && d.knows(both)) names[c] = both;
  }
}

/// What an unknown file's widest rows hold, as options to fill in.
void list_names(const std::string& text, const Dictionary& d) {
  std::vector<Row> widest;
  for (const char delimiter : {',', ';', '\t', '|'}) {
    std::vector<Row> rows = split(text, delimiter);
    std::erase_if(rows, [&](const Row& r) { return r.size() < 2; });
    if (!rows.empty() && (widest.empty() || rows.front().size() > widest.front().size())) widest = std::move(rows);
  }
  if (widest.size() < 2) return;
  list_columns(widest[0], widest[1], d);
}

/// Cells that are units or say nothing: most of those that say anything, and no number among them.
bool is_row_of_units(const Row& row) {
  std::size_t units = 0, other = 0;
  for (const std::string& c : row) {
    const bool bracketed = (c.starts_with('[') && c.ends_with(']')) || (c.starts_with('(') && c.ends_with(')'));
    if (!unit_of(c).empty()) ++units;
    else if (plain_number(c)) return false;
    else other += !bracketed && !missing(c);
  }
  return units > 0 && (other == 0 || (units >= 3 && units > 2 * other));
}

/// What a line above shots may name as their club: `7 Iron` alone, or `Club:` and its name.
std::string club_heading(const Row& row, const Dictionary& d) {
  Row said;
  for (const std::string& c : row)
    if (!c.empty()) said.push_back(c);
  const auto letter = [](unsigned char c) { return std::isalpha(c) || c >= 0x80; };
  if (said.size() == 1) {
    const auto colon = said[0].find(':');
    if (colon != std::string::npos && d.bookkeeping_of(said[0].substr(0, colon)) == "club")
      return trimmed(said[0].substr(colon + 1));
    if (std::ranges::any_of(said[0], letter)) return said[0];
  }
  if (said.size() == 2 && d.bookkeeping_of(said[0]) == "club") return said[1];
  return "";
}

/// Whether a column counts the shots, 1, 2, 3, ..., whatever its header: one above the row before, or 1 again.
/// `any_order`: other numbers are those of shots, too.
bool counts(const std::vector<Row>& rows, std::size_t column, bool any_order) {
  std::size_t steps = 0, numbers = 0;
  double last = 0;
  for (const Row& row : rows) {
    const auto x = plain_number(row[column]);
    if (!x) continue;
    ++numbers;
    steps += any_order || *x == last + 1 || *x == 1;
    last = *x;
  }
  return numbers > 2 && numbers == steps && 2 * numbers > rows.size();
}

bool has_digit(const std::string& cell) {
  return std::ranges::any_of(cell, [](unsigned char c) { return std::isdigit(c); });
}

/// "2024-05-12 10:22", "12.05.24", "5/12/2024 8:15 AM", "May 12, 2024", "20240512": two numbers, or one of four digits.
bool is_date(const std::string& cell) {
  std::size_t numbers = 0, longest = 0, digits = 0;
  for (const unsigned char c : cell) {
    digits = std::isdigit(c) ? digits + 1 : 0;
    numbers += digits == 1;
    longest = std::max(longest, digits);
  }
  return numbers >= 2 || longest >= 4;
}

/// Whether most cells of a column are dates. Summaries do not count: of a few shots a block they may be as many.
bool dated(const std::vector<Row>& rows, std::size_t column, const Dictionary& d) {
  std::size_t cells = 0, dates = 0;
  for (const Row& row : rows)
    if (column < row.size() && !row[column].empty() &&
        (has_digit(row[column]) || !d.begins_or_ends("summary", row[column])))
      ++cells, dates += is_date(row[column]);
  return 2 * dates > cells;
}

/// Whether a row names columns: two quantities, and no number.
bool is_header(const Row& row, const Dictionary& d) {
  std::set<std::string> quantities;
  for (const std::string& c : row) {
    if (plain_number(c)) return false;
    if (const MonitorQuantity* q = d.quantity_of(c)) quantities.insert(q->name);
  }
  return quantities.size() >= 2;
}

/// What a known header stands for: a quantity or a role.
std::string meaning(const Dictionary& d, const std::string& header) {
  const MonitorQuantity* q = d.quantity_of(header);
  return q ? q->name : d.bookkeeping_of(header);
}

/// Two headers whose cells mean the same.
bool same_header(const std::string& a, const std::string& b) {
  if (lower(a) == lower(b)) return true;
  const HeaderSign x = sign_in(a, Sides::any), y = sign_in(b, Sides::any);
  return letters(a) == letters(b) && unit_in(a) == unit_in(b) && x.sign == y.sign && x.strange == y.strange;
}

/// Where each column of a later part stands under the names of the first, which grow by those that only the part has.
/// A quantity whose name or unit changes is refused: its cells would be read by the first one's.
std::vector<std::size_t> places(const Row& part, Sheet& sheet, const Dictionary& d, const fs::path& file) {
  constexpr auto none = std::size_t(-1);
  std::vector<std::size_t> to(part.size(), none);
  std::vector<bool> taken(sheet.names.size());
  for (std::size_t c = 0; c < part.size(); ++c)
    for (std::size_t k = 0; k < taken.size() && to[c] == none; ++k)
      if (!taken[k] && same_header(part[c], sheet.names[k])) to[c] = k, taken[k] = true;
  for (std::size_t c = 0; c < part.size(); ++c) {
    if (to[c] != none) continue;
    const std::string means = meaning(d, part[c]);
    for (std::size_t k = 0; k < taken.size() && !means.empty(); ++k)
      if (!taken[k] && meaning(d, sheet.names[k]) == means)
        throw InputError(fmt::format("{}: a later header has '{}' where the first has '{}': import each part by itself",
                                     file.string(), part[c], sheet.names[k]));
    to[c] = sheet.names.size();
    sheet.names.push_back(part[c]);
  }
  return to;
}

/// Rows below a later header, laid under the names of the first one: a part of the file may have its columns in another
/// order. `header`: the first one as it stands. Returns the units of columns that only later parts have.
Row lay_parts(Sheet& sheet, const Row& header, const Dictionary& d, const fs::path& file) {
  const std::size_t width = sheet.names.size();
  const auto begins_with = [](const Row& row, const Row& as, std::size_t n) {
    return row.size() >= n && std::equal(row.begin(), row.begin() + long(n), as.begin());
  };
  Row units, units_of_new;
  std::vector<Row> rows;
  std::optional<std::vector<std::size_t>> to;  // none: as under the first header
  for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
    Row row = std::move(sheet.rows[i]);
    if (row.size() < width && !to) row.resize(width);
    if (begins_with(row, header, std::min(width, header.size()))) {
      to.reset();
      ++sheet.headers_again;
      continue;
    }
    if (is_header(row, d)) {
      Row names = row;
      if (i + 1 < sheet.rows.size() && !is_row_of_units(sheet.rows[i + 1])) {  // a row of groups
        Row below = sheet.rows[i + 1];
        name_by_groups(below, row, d);
        if (is_header(below, d) && known_cells(d, below) > known_cells(d, names)) names = std::move(below), ++i;
      }
      while (!names.empty() && names.back().empty()) names.pop_back();
      to = places(names, sheet, d, file);
      ++sheet.headers_again;
      continue;
    }
    const bool of_units = is_row_of_units(row);
    if (!to) {
      if (of_units && units.empty()) units = row;
      rows.push_back(std::move(row));
      continue;
    }
    for (std::size_t c = to->size(); c < row.size(); ++c)
      if (!row[c].empty())
        throw InputError(
            fmt::format("{}: below a later header, a row of {} cells stands under {} names: its values "
                        "stand under the wrong ones",
                        file.string(), row.size(), to->size()));
    Row laid = of_units ? units : Row{};  // the units of columns that this part has not are not said anew
    laid.resize(sheet.names.size());
    units_of_new.resize(sheet.names.size());
    for (std::size_t c = 0; c < std::min(to->size(), row.size()); ++c)
      if (const std::size_t k = (*to)[c]; of_units && k >= width) units_of_new[k] = row[c];
      else laid[k] = row[c];
    rows.push_back(std::move(laid));
  }
  sheet.rows = std::move(rows);
  return units_of_new;
}

/// Takes out rows that `is` says of, and what their lines name as the club.
template <typename Is>
std::size_t take_out(std::vector<Row>& shots, Row& clubs, Is is) {
  std::vector<Row> left;
  Row left_clubs;
  for (std::size_t r = 0; r < shots.size(); ++r)
    if (!is(shots[r], clubs[r])) left.push_back(std::move(shots[r])), left_clubs.push_back(std::move(clubs[r]));
  const std::size_t n = shots.size() - left.size();
  shots = std::move(left), clubs = std::move(left_clubs);
  return n;
}

/// The rows below the header, which is given as it stands, as shots: units, repeated headers, summaries, lines of text
/// and lines that name a club are taken out.
void take_shots(Sheet& sheet, const Row& header, const Dictionary& d, const fs::path& file) {
  const Row units_of_new = lay_parts(sheet, header, d, file);
  const std::size_t width = sheet.names.size();
  std::string club;
  for (const Row& row : sheet.before)
    if (const std::string named = club_heading(row, d); d.club(named)) club = named;
  std::vector<std::string> roles;
  std::vector<bool> dates;
  std::vector<std::size_t> quantities, speeds;
  for (std::size_t c = 0; c < width; ++c) {
    roles.push_back(d.bookkeeping_of(sheet.names[c]));
    dates.push_back(roles[c] == "session" && dated(sheet.rows, c, d));
    const MonitorQuantity* q = d.quantity_of(sheet.names[c]);
    // `Club` may be its speed or its name.
    const bool names = !roles[c].empty() && std::ranges::any_of(sheet.rows, [&](const Row& row) {
      return c < row.size() && !missing(row[c]) && !plain_number(row[c]) && unit_of(row[c]).empty();
    });
    if (!q || names) continue;
    quantities.push_back(c);
    if (q->name == "ball_speed" || q->name == "club_speed") speeds.push_back(c);
  }
  std::vector<Row> shots;
  Row clubs;
  bool summaries_follow = false;  // below a line that says so
  for (Row& row : sheet.rows) {
    row.resize(std::max(width, row.size()));
    if (is_row_of_units(row)) {
      if (shots.empty() && sheet.units.empty()) sheet.units = row;
      else if (!std::ranges::equal(row.begin(), row.begin() + long(width), sheet.units.begin(),
                                   sheet.units.begin() + long(std::min(width, sheet.units.size()))))
        throw InputError(
            fmt::format("{}: the units change after shot {}: import each part by itself", file.string(), shots.size()));
      else ++sheet.units_again;
      continue;
    }
    const std::string named = club_heading(row, d);
    if (d.says("summary", named)) {
      summaries_follow = true;
      sheet.notes.push_back(named);
      continue;
    }
    // Where blocks have clubs, the next line of this form names one too, known or not.
    if (!named.empty() && (d.club(named) || !club.empty())) {
      club = named;
      summaries_follow = false;
      continue;
    }
    if (std::ranges::none_of(quantities, [&](std::size_t c) { return has_digit(row[c]); }) && !quantities.empty()) {
      const auto said = std::ranges::count_if(row, [](const std::string& c) { return !missing(c); });
      const bool numbers = said > 1 && std::ranges::any_of(row, has_digit);
      if (numbers) ++sheet.speedless;
      else if (said > 0) sheet.notes.push_back(trimmed(fmt::format("{}", fmt::join(row, " "))));
      continue;
    }
    // Summaries stand where the club's, the player's, the session's or the shot's name would.
    const auto names_club = [&](std::size_t c) { return roles[c] == "club" && d.club(row[c]); };
    bool known_club = false;
    for (std::size_t c = 0; c < width; ++c) known_club = known_club || names_club(c);
    bool summary = summaries_follow;
    for (std::size_t c = 0; c < width && !summary; ++c) {
      const std::string& role = roles[c];
      if (c != 0 && role != "club" && role != "shot" && role != "player" && role != "session") continue;
      const bool no_date = dates[c] && !has_digit(row[c]);
      const bool may_hold_it = role == "player" || (role == "session" && !no_date);
      const bool extreme = role == "shot" || no_date || (role == "club" && !known_club);
      summary = (no_date && !missing(row[c])) ||
                (may_hold_it ? d.says("summary", row[c]) : d.begins_or_ends("summary", row[c])) ||
                (extreme && d.says("extreme", row[c]));
    }
    if (summary) {
      ++sheet.summaries;
      continue;
    }
    if (std::any_of(row.begin() + long(width), row.end(), [](const std::string& c) { return !c.empty(); }))
      throw InputError(fmt::format("{}: shot {} has {} cells under {} names: its values stand under the wrong ones",
                                   file.string(), shots.size() + 1, row.size(), width));
    row.resize(width);
    shots.push_back(std::move(row));
    clubs.push_back(club);
  }
  // Where a column counts the shots, a word in it is a summary's in another language.
  for (std::size_t c = 0; c < width; ++c) {
    const bool unnamed = c == 0 && roles[c].empty() && !d.quantity_of(sheet.names[c]);
    if (!(roles[c] == "shot" || unnamed) || !counts(shots, c, !unnamed)) continue;
    sheet.summaries += take_out(
        shots, clubs, [&](const Row& row, const std::string&) { return !missing(row[c]) && !plain_number(row[c]); });
  }
  const auto fast = [](const std::string& cell) {
    const auto x = number(cell, false, Sides::none);
    return !missing(cell) && (!x || x->value != 0);
  };
  const auto has_speed = [&](const Row& row) {
    return std::ranges::any_of(speeds, [&](std::size_t c) { return fast(row[c]); });
  };
  if (std::ranges::any_of(shots, has_speed))
    sheet.speedless += take_out(shots, clubs, [&](const Row& row, const std::string&) { return !has_speed(row); });
  const bool comma =
      sheet.delimiter != "," && std::ranges::any_of(shots, [&](const Row& row) {
        return std::ranges::any_of(quantities, [&](std::size_t c) { return row[c].find(',') != std::string::npos; });
      });
  Statistics statistics(quantities, comma);
  std::string last_line, last_club;
  sheet.summaries += take_out(shots, clubs, [&](const Row& row, const std::string& line) {
    std::string named;
    for (std::size_t c = 0; c < width; ++c)
      if (roles[c] == "club") named += row[c];
    if (line != last_line || (named != last_club && !named.empty())) statistics.restart(), last_club = named;
    last_line = line;
    return statistics.take(row);
  });
  const auto says_club = [&](std::size_t c) {
    return roles[c] == "club" && std::ranges::any_of(shots, [&](const Row& row) { return d.club(row[c]) != nullptr; });
  };
  bool column = false;
  for (std::size_t c = 0; c < width; ++c) column = column || says_club(c);
  if (!sheet.units.empty()) {
    sheet.units.resize(width);
    for (std::size_t c = 0; c < std::min(width, units_of_new.size()); ++c)
      if (sheet.units[c].empty()) sheet.units[c] = units_of_new[c];
    // A name that is known only with a unit has it here: `LAUNCH` above `deg`.
    for (std::size_t c = 0; c < width; ++c)
      if (const std::string both = sheet.names[c] + " [" + sheet.units[c] + "]";
          !unit_of(sheet.units[c]).empty() && !d.knows(sheet.names[c]) && d.quantity_of(both))
        sheet.names[c] = both;
  }
  if (!column && std::ranges::any_of(clubs, [](const std::string& c) { return !c.empty(); })) {
    sheet.names.push_back("Club (its line)");
    if (!sheet.units.empty()) sheet.units.resize(sheet.names.size());
    for (std::size_t r = 0; r < shots.size(); ++r) shots[r].push_back(clubs[r]);
  }
  sheet.rows = std::move(shots);
}

/// Rows that may be the header: the first, and, where none of these is one, as many as a long preamble may have.
constexpr std::size_t kFirstRows = 30, kMostBefore = 1000;

Sheet read_table(std::string text, const Dictionary& d, const fs::path& file) {
  Sheet best;
  Row header;
  std::size_t most = 1;
  if (text.starts_with("sep=") || text.starts_with("SEP=")) text.erase(0, text.find('\n') + 1);
  for (const char delimiter : {',', ';', '\t', '|'}) {
    const std::vector<Row> rows = split(text, delimiter);
    for (std::size_t h = 0; h < std::min(rows.size(), kMostBefore); ++h) {
      Row names = rows[h];
      const bool numbers = std::ranges::any_of(names, [](const std::string& c) { return plain_number(c).has_value(); });
      if (h >= kFirstRows && is_header(best.names, d)) break;
      if (h >= kFirstRows && (numbers || names.size() < 3)) continue;  // cells of a shot, or a line of text
      if (h > 0 && !numbers && !is_row_of_units(names)) name_by_groups(names, rows[h - 1], d);
      const std::size_t known = known_cells(d, names);
      if (known <= most) continue;
      most = known;
      best = {};
      best.names = std::move(names);
      header = rows[h];
      best.before.assign(rows.begin(), rows.begin() + long(h));
      best.delimiter = delimiter == '\t' ? "tab" : std::string(1, delimiter);
      for (const Row& row : best.before)
        for (const MonitorLayout& l : d.layouts())
          if (!l.preamble.empty() && row.front().starts_with(l.preamble)) best.layout = l.name, best.family = l.units;
      best.rows.assign(rows.begin() + long(h) + 1, rows.end());
    }
  }
  if (most < 2) {
    list_names(text, d);
    throw InputError(
        fmt::format("{}: no row of the first {} looks like the header of shots (two known names at least); "
                    "--dictionary FILE or --column 'header=quantity_unit' help",
                    file.string(), kMostBefore));
  }
  while (!best.names.empty() && best.names.back().empty()) best.names.pop_back();
  check_size(file, best.names.size(), best.rows.size());
  take_shots(best, header, d, file);
  return best;
}

}  // namespace

void list_columns(const Row& names, const Row& cells, const Dictionary& d) {
  fmt::print("columns and their first cells; fill in what each is, or leave the line out:\n");
  for (std::size_t c = 0; c < names.size(); ++c)
    fmt::print("  --column '{}=?'    {}, ...\n", names[c], c < cells.size() ? cells[c] : "");
  fmt::print("with one of: {}; and its unit, as ball_speed_mph\n", fmt::join(d.quantity_names(), ", "));
}

Sheet read_sheet(const fs::path& file, const Dictionary& d) {
  const std::string text = read_text(file);
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) throw InputError(fmt::format("{}: the file is empty", file.string()));
  const bool json = text[first] == '{' || (text[first] == '[' && text.find('{') != std::string::npos);
  Sheet sheet = json ? read_json(text, file, d) : read_table(text, d, file);
  if (sheet.rows.empty()) throw InputError(fmt::format("{}: a header, but no shots", file.string()));
  for (const MonitorLayout& l : d.layouts())
    if (!l.has.empty())
      for (const std::string& name : sheet.names)
        if (plain(name) == l.has) sheet.layout = l.name, sheet.family = l.units;
  return sheet;
}

}  // namespace hosel::app
