/// Measured shots: the columns of a file with their roles, in SI, missing values as NaN.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "golf/quantities.hpp"
#include "post/csv.hpp"

namespace hosel::loop {

enum class Role { bookkeeping, input, output, other };

struct Column {
  std::string name;  ///< the header, letter for letter
  std::string stem;  ///< without the unit
  double si = 1;     ///< one of the header's unit in SI
  Role role = Role::other;
  bool numeric = false;
  std::vector<double> value;        ///< SI; NaN where missing or not a finite number; empty for text columns
  std::vector<std::string> text;    ///< for text columns; "" where missing
  double resolution = 0;            ///< recording step found from the digits, SI; 0 where unknown
  std::vector<std::size_t> broken;  ///< rows whose cell is infinite or not a number ("nan", "inf")

  double native(std::size_t row) const { return value[row] / si; }
};

struct Shots {
  std::string file;
  std::vector<std::string> id;    ///< the `shot` value, or the row's number
  std::vector<std::size_t> line;  ///< in the file
  std::vector<Column> columns;
  bool has_shot_column = false;
  std::size_t repeated = 0;  ///< rows of the file that are copies of an earlier one: they count once

  std::size_t rows() const { return id.size(); }
  const Column* find(std::string_view name) const;  ///< by header
  Column* find(std::string_view name) { return const_cast<Column*>(std::as_const(*this).find(name)); }
  const Column* find_stem(std::string_view stem) const;  ///< by name without unit
};

/// All rows by their values, so that what is sampled or split from them does not hang on the file's order.
std::vector<std::size_t> rows_by_value(const Shots& shots);
/// At most so many of these, from all over.
template <class T>
std::vector<T> evenly(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<T> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(all[k * all.size() / most]);
  return some;
}

/// Roles, units, SI values and recording resolution of a sheet. Columns stand in the order of the quantities, rows in
/// that of their shot numbers where each has one. Values that were recorded in another unit and converted are taken
/// from there: their resolution is that unit's. A row that repeats an earlier one letter for letter, or all its inputs
/// and results under another number, is left out: a file pasted twice holds no more shots. Throws DataError: an output
/// or input column with a wrong unit, text in it, the same quantity twice. `flights`: carry and the like are outputs,
/// too; otherwise columns like any other. `elsewhere`: cells of results that stand in another file, by the shot's id;
/// they tell two rows apart as their own cells do.
Shots read_shots(const post::Sheet& sheet, bool flights = false,
                 const std::map<std::string, std::vector<std::string>>& elsewhere = {});
/// The `shot` value of every row, or the row's number.
std::vector<std::string> ids_of(const post::Sheet& sheet);

/// What a row records of this quantity [SI]; absent without a column or a number.
std::optional<double> recorded(const Shots& shots, std::size_t row, Output output);

/// Of unit length.
Vec3 direction(double up, double right);
/// The launch that a row records: ball speed, launch angle and spin (by components, or by rate and tilt).
/// Absent without ball speed, launch angle, or backspin or spin rate; a missing tilt, sidespin or azimuth counts as
/// zero.
std::optional<Launch> seen_launch(const Shots& shots, std::size_t row);

/// Fills inputs that the shots lack from a file with one row per value of `by`. Summaries (`mean_`,
/// `half_range_`) are left out. Throws DataError where a cluster is missing or stands twice.
void join(Shots& shots, const post::Sheet& sheet, const std::string& by);

/// The column's values as group numbers 0, 1, ... in order of first appearance; -1 where missing.
struct Groups {
  std::vector<int> of_row;
  std::vector<std::string> name;
};
Groups groups(const Column& column);
/// More groups than this are no few clubs or players.
inline constexpr std::size_t kMostGroups = 12;
/// The column by which rows stand sorted, so that they are not in the order in which they were struck: a reading that
/// only rises or only falls (noise would not let it), or without a shot number a text column with every value in one
/// block. nullptr where there is none.
const Column* sorted_by(const Shots& shots);
/// Whether every club of a column `club` was hit in one go, and there are several.
bool one_club_after_another(const Shots& shots);

}  // namespace hosel::loop
