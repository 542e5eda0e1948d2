/// The design of a study: factors whose levels set keys of a case, crossed with one another.
///
///     [[variant]]  name, set = ["key=value", ...]          named changes
///     [rows]       file = "blows.csv"                      a blow a row: heads with a dot are keys of the case
///     [grid]       columns, rows, width_mm, height_mm      places on the face
///     [sample]     points, seed, method                    of every [[axis]] with a range and no count
///     [[axis]]     key, values = [...] | range, count, spacing    one level a value
///                  key, range | mean and sd                drawn by the [sample]
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/overrides.hpp"
#include "app/reader.hpp"
#include "post/face_map.hpp"
#include "solvers/distribution.hpp"

namespace hosel::app {

/// Lowest and highest measured value of a quantity (one number: twice), as it was named.
struct MeasuredRange {
  std::string name;
  double low = 0, high = 0;
};

struct DesignLevel {
  std::vector<std::string> cells;  ///< one a column of its factor
  std::vector<std::string> set;    ///< overrides, key=value
  std::vector<MeasuredRange> measured;
  std::string from;  ///< file and line, and the key but for a row; empty: of a sample
};

/// How the values of one column of a sample were drawn, and the keys of the case that they set.
struct DrawnColumn {
  std::vector<std::string> keys;
  solvers::Distribution spread;
  std::string from;  ///< file, line and key
};

struct DesignFactor {
  enum class Kind { variants, rows, grid, sample, axis };
  Kind kind = Kind::axis;
  std::vector<std::string> columns;
  std::vector<DesignLevel> levels;
  std::vector<DrawnColumn> drawn = {};  ///< one a column, of a sample
};

/// The first factor changes slowest.
class Design {
 public:
  std::size_t size() const;
  const std::vector<DesignFactor>& factors() const { return factors_; }
  const DesignLevel& level(std::size_t factor, std::size_t point) const;
  bool has(DesignFactor::Kind kind) const;

  /// The key of the same quantity that the design sets; empty where none does. Of the variants those named, or all.
  std::string varied(const std::string& key, const std::vector<std::string>& variants = {}) const;
  /// Refuses a quantity that two factors set, or a factor and `stated`, overrides of every point.
  void check_varied_once(const Table& root, const std::vector<std::string>& stated) const;

  std::vector<std::string> columns() const;
  std::vector<std::string> cells(std::size_t point) const;
  /// A column's number at every point; empty where one is not a number.
  std::vector<double> numbers(std::size_t column) const;
  /// Whether two columns change together, those of [rows] or of a sample.
  bool tied(std::size_t column, std::size_t other) const {
    return place(column).first == place(other).first && factors_[place(column).first].kind != DesignFactor::Kind::grid;
  }
  /// A column's distinct cells, in the order of the design.
  std::vector<std::string> levels(std::size_t column) const;
  /// Whether every level of the column's factor has a cell of its own there; a grid's place has it in two columns.
  bool tells_apart(std::size_t column) const {
    const DesignFactor& f = factors_[place(column).first];
    return f.kind == DesignFactor::Kind::grid || levels(column).size() == f.levels.size();
  }
  /// What a point changes: variants and rows first, then `between`, then sample, grid and axes.
  std::vector<std::string> set(std::size_t point, const std::vector<std::string>& between) const;
  /// The same with one column's keys as another point has them; nothing where the column is not drawn by itself.
  std::vector<std::string> set_with(std::size_t point, std::size_t column, std::size_t other) const;
  std::vector<MeasuredRange> measured(std::size_t point) const;
  /// What a point's case refuses, with file and line of what the design set there, or of the point's row.
  std::string refused(std::size_t point, const std::string& why) const;
  /// "dynamic loft 30 deg, friction 0.2": where a point lies, in words; columns of one value are left out, and those of
  /// `but`.
  std::string said(std::size_t point, std::optional<DesignFactor::Kind> but = {}) const;
  const std::optional<post::FaceGrid>& grid() const { return grid_; }
  /// How each column was drawn, of a design that is one sample and nothing else; nothing of another.
  std::vector<DrawnColumn> only_drawn() const {
    return factors_.size() == 1 ? factors_.front().drawn : std::vector<DrawnColumn>();
  }

  void add(DesignFactor factor, const Table& at, std::string_view key);
  void add(const post::FaceGrid& grid, const Table& at);
  /// Leaves out the rows of `[rows]` of which `absent` says so, and names them; none where it says so of all.
  std::vector<std::string> leave_out_rows(const std::function<bool(const DesignLevel&)>& absent);

 private:
  std::pair<std::size_t, std::size_t> place(std::size_t column) const;  ///< factor, column in it
  std::vector<DesignFactor> factors_;
  std::optional<post::FaceGrid> grid_;
};

/// Columns of points.csv that are none of the design or the outputs.
inline constexpr std::array<std::string_view, 3> kOwnColumns = {"point", "model", "error"};

/// More points than this are a slip of the keys: each is read before anything is computed.
inline constexpr std::size_t kMostPoints = 100'000;

/// Reads the tables above from a study.
Design read_design(Table root);
/// `[measured]` of a study or a variant: names as they stand, a number or [lowest, highest] each.
std::vector<MeasuredRange> read_measured(Table table);

/// A cell in words: the value with its column's name and unit, "club speed 45 m/s".
std::string said_cell(const std::string& column, const std::string& cell, int digits = 6);

}  // namespace hosel::app
