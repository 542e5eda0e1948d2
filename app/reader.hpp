/// The strict case reader: every key is declared where it is read, with its dimension and range; what
/// nobody asked for is an error with the nearest spelling. Keys carry their unit as a suffix.
#pragma once

#include <algorithm>
#include <concepts>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/inputs.hpp"
#include "golf/units.hpp"
#include "golf/vector.hpp"

namespace hosel::app {

/// One line a person can act on: `file:line: key: what is wrong (what is allowed)`. Exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Allowed values, in SI. NaN is never allowed.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false;       ///< min itself is not allowed
  std::string_view why = {};   ///< said to the person whose value is refused
  bool also_infinite = false;  ///< inf is allowed besides, where it has a meaning (a wall, a flat face)

  constexpr Range because(std::string_view reason) const { return {min, max, open_min, reason, also_infinite}; }
  constexpr Range or_infinite() const { return {min, max, open_min, why, true}; }
  bool contains(double x) const;
  /// "0.01 to 5 kg"; without a unit for a plain number.
  std::string allowed(std::optional<Unit> unit = {}) const;
  /// "out of range (allowed: 0.01 to 5 kg; why)".
  std::string sentence(std::optional<Unit> unit = {}) const;
  static Range positive() { return {0, std::numeric_limits<double>::max(), true}; }
  static Range non_negative() { return {0, std::numeric_limits<double>::max()}; }
  static Range finite() { return {std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()}; }
  static Range fraction() { return {0, 1}; }
};

/// The name of a key, without its unit where it carries one, and its meaning: one line for the reference.
struct Key {
  std::string_view name;
  std::string_view meaning = {};
  std::string_view shown = {};  ///< what the reference says instead of a name that is data

  template <class Text>
  requires std::convertible_to<const Text&, std::string_view> Key(const Text& text) : name(text) {}
  Key(std::string_view text, std::string_view means, std::string_view shows = {})
      : name(text), meaning(means), shown(shows) {}
};

/// A key that a reader asked for: what the reference lists and the tests of the ranges try.
struct Declared {
  std::string key = {};    ///< dotted, with the unit that the case uses, as `--set` takes it
  std::string shown = {};  ///< dotted, with the unit in which the default is echoed
  std::string meaning = {};
  std::string type = {};                     ///< "number", "list of 3", "text", "one of a, b"
  std::optional<std::string> standard = {};  ///< the default as TOML text; without one the key is required
  std::string unit = {};                     ///< suffix of `shown`
  Range range = {};                          ///< of a number, SI
  double si = 1;                             ///< one of the case's unit in SI
  std::string decided_by = {};               ///< the key that decides default or range (Table::decided_by)
  bool optional = false;                     ///< without a default, but asked for only where it is there
  std::size_t size = 0;                      ///< of a list; 0: a single number
  bool whole = false;                        ///< an integer
};

namespace detail {
struct Document;
}  // namespace detail

/// A table of the case file. Reading a key marks it as known and echoes it, defaults included, into
/// the resolved case.
class Table {
 public:
  bool has(std::string_view key) const;
  /// `stem` with any unit of the dimension (`club_speed_mps`, `club_speed_mph`).
  bool has_quantity(std::string_view stem) const;

  /// A quantity `key_unit`; returns SI. Without a default the key is required. `unit` is the suffix
  /// in which the default is echoed and which is offered where the key is missing.
  double quantity(Key key, std::string_view unit, Range si = Range::finite(), std::optional<double> default_si = {});
  /// As above for a list of `size` values (any size where 0).
  std::vector<double> quantities(Key key, std::string_view unit, std::size_t size, Range si = Range::finite(),
                                 std::optional<std::vector<double>> default_si = {});
  Vec3 vector(Key key, std::string_view unit, const std::optional<Vec3>& default_si = {});
  Vec3 vector(Key key, std::string_view unit, Range si, std::optional<Vec3> default_si = {});
  /// A 3x3 matrix as a list of rows.
  Mat3 matrix(Key key, std::string_view unit, std::optional<Mat3> default_si = {});

  double number(Key key, Range range = Range::finite(), std::optional<double> standard = {});
  std::vector<double> numbers(Key key, std::size_t size, Range range = Range::finite(),
                              std::optional<std::vector<double>> standard = {});
  /// A number, or a list of two: lowest and highest. Any finite number.
  std::pair<double, double> number_or_range(Key key);
  long integer(Key key, long min, long max, std::optional<long> standard = {});
  bool flag(Key key, std::optional<bool> standard = {});
  /// One line: control characters and line breaks in it are blanks.
  std::string text(Key key, const std::optional<std::string>& standard = {});
  /// What an entry of a list is called: an error where it is empty or one of `taken`, to which it is added. Two of one
  /// name would be one entry of a summary.
  std::string name(Key key, std::vector<std::string>& taken);
  /// One of the words, else an error that names the nearest.
  std::string choice(Key key, const std::vector<std::string>& allowed, const std::optional<std::string>& standard = {});
  /// What stands beside the word in `named`.
  template <class T>
  T one_of(Key key, const std::vector<std::pair<std::string, T>>& named,
           const std::optional<std::string>& standard = {}) {
    std::vector<std::string> words;
    for (const auto& [word, value] : named) words.push_back(word);
    const std::string wanted = choice(key, words, standard);
    return named[std::size_t(std::ranges::find(words, wanted) - words.begin())].second;
  }
  std::vector<std::string> texts(Key key, std::optional<std::vector<std::string>> standard = {});
  /// A list of numbers, texts or flags as TOML text, to be handed on to another case.
  std::vector<std::string> scalars(Key key);
  /// A file named relative to the case directory; must exist.
  std::filesystem::path file(Key key);
  /// A measured file: in the case directory, else in the folder that HOSEL_DATA names (default ../shared/data beside
  /// the project or the working directory). Only where a name with a folder is asked for and that folder is not
  /// there, because there are no measured data on this machine, is the missing file returned as it would be
  /// expected, for the caller to say SKIPPED; any other missing file is an error.
  std::filesystem::path data_file(Key key);
  /// One such file, or a list of them.
  std::vector<std::filesystem::path> data_files(Key key);

  /// A sub-table; required unless `optional_table` is used instead.
  Table table(Key key);
  std::optional<Table> optional_table(std::string_view key);
  /// A sub-table that is as good as empty where it is absent: its defaults are echoed all the same.
  Table default_table(std::string_view key);
  /// What is echoed for this key is no default, though no case states it: it stands whatever else is set.
  void keep(std::string_view key);
  /// A file that the case depends on without naming its path.
  void note_file(const std::filesystem::path& file);
  /// A list of tables `[[key]]`; empty where absent.
  std::vector<Table> tables(std::string_view key);
  /// Keys and tables of this case that another reader declares: nothing is said of what they hold.
  void leave(std::initializer_list<std::string_view> keys);
  /// All keys as they stand, for tables whose keys are data (noise per channel); each must then be read.
  std::vector<std::string> keys() const;

  /// Which key decides the defaults and ranges that differ from case to case, of what is read from here on: a literal.
  void decided_by(std::string_view key) { decided_by_ = key; }

  /// What `hosel check` says of this table beside its keys, a line or several.
  void tell(std::string_view text);
  /// What can be meant and is likely a slip: a warning of every run, a comment of `hosel check`.
  void doubt(std::string_view text);

  /// Whether the command line says this key, by `--set`.
  bool set_by_command(std::string_view key) const;
  /// Where this key stands, as an error at it says: "case.toml:12: axis[1].values".
  std::string place_of(std::string_view key) const;
  /// An error at this key, of a quantity at its stem with any unit (or at the table where the key is empty or absent).
  [[noreturn]] void fail(std::string_view key, std::string_view what) const;

 private:
  friend class CaseFile;
  Table(std::shared_ptr<detail::Document> document, void* node, std::string path, std::string shown);
  /// Whether what is asked for is noted: most readers want no list of keys.
  bool listed() const;
  /// Notes what has been asked for; `unit` is the suffix that the key carries in the reference.
  void declare(Key key, Declared what);
  std::string read_text(std::string_view key, const std::optional<std::string>& standard);
  std::filesystem::path data_path(std::string_view key, const std::string& name);
  std::shared_ptr<detail::Document> document_;
  void* node_;         // toml::table*, kept out of this header for compile time
  std::string path_;   // dotted, for messages
  std::string shown_;  // dotted, for the reference: lists as `layers[]`
  std::string_view decided_by_;
};

/// One `case.toml`, or a case directory that contains it.
class CaseFile {
 public:
  /// `overrides` are `dotted.key=value` in TOML syntax (bare words are taken as strings); `layers[2].law=yeoh` is a
  /// key of the second table of a list.
  explicit CaseFile(const std::filesystem::path& where, const std::vector<std::string>& overrides = {});
  /// The case as `read` found it, whatever has become of the file since, with other overrides. What it reads counts
  /// among the inputs of the first.
  CaseFile(const CaseFile& read, const std::vector<std::string>& overrides);
  /// Another case that `by` is made with: what it reads counts among the inputs of `by`. `named`: how `by` names it
  /// where it lies beside it, and not among the shipped ones.
  CaseFile(const std::filesystem::path& where, const CaseFile& by, const std::string& named);

  Table root();
  const std::filesystem::path& directory() const;
  const std::filesystem::path& file() const;
  /// Another case that this one names: beside it, or among the inputs beside a resolved case; empty: neither.
  std::filesystem::path case_beside(const std::string& named) const;
  const std::vector<std::string>& overrides() const;
  /// Everything read by this case and the cases made of it.
  const std::shared_ptr<Inputs>& inputs() const;
  /// For who lists keys: of a study its own tables are read, and not every point.
  void for_keys_alone();
  bool read_for_keys_alone() const;
  /// Every key that was read or left to its default, in the order of asking; nothing unless read for keys alone.
  const std::vector<Declared>& declared() const;
  /// Every key that was not read is an error. Call it when reading is complete: what the case says then counts among
  /// the inputs.
  void finish();
  /// The case with every default filled in, as TOML text, and a list of these. Where it is read with overrides, those
  /// in the list are decided again, as they are when the case is read that it was made of.
  std::string resolved() const;

 private:
  void open(const std::filesystem::path& where);
  void begin();
  std::shared_ptr<detail::Document> document_;
};

/// The word of `candidates` nearest in spelling, or empty where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The names of what may be chosen, entry by entry.
std::vector<std::string> names_in(const auto& entries) {
  std::vector<std::string> out;
  for (const auto& entry : entries) out.emplace_back(entry.name);
  return out;
}

/// A default of a key: that member of what may not be there.
template <class Entry, class Value>
std::optional<Value> standard_of(const std::optional<Entry>& entry, Value Entry::*member) {
  return entry ? std::optional<Value>((*entry).*member) : std::nullopt;
}

/// "; did you mean 'NAME'?" with the nearest of them, else `otherwise`.
std::string or_nearest(std::string_view word, const std::vector<std::string>& candidates,
                       std::string_view otherwise = "");

/// Where large measured files are: HOSEL_DATA, else ../shared/data beside the project.
std::filesystem::path data_directory();

}  // namespace hosel::app
