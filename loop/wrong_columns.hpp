/// Whole columns that hold something else than their header says: unit, sign, swapped, moved by a row, offset, scale,
/// level shift. What is tried on shots and on flights, and how it is told. They are reported, never repaired.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "loop/problem.hpp"
#include "loop/shots/shots.hpp"

namespace hosel::loop {

struct WrongColumn {
  std::string column;
  std::string finding;  ///< unit, sign, swapped, rows, offset, scale, level-shift
  std::string text;     ///< "reads like mph: ..."
};

/// Values of `column` (and `second`) as they would have to be read: factor and offset, on the members only.
struct ColumnSlip {
  std::string finding;
  int column = 0, second = -1;
  double factor = 1, offset = 0;  ///< true value = factor * recorded + offset [SI]
  int rows = 0;                   ///< the true value stands so many rows below
  std::vector<char> member;       ///< rows that it holds on; empty: all
  std::string what, where;        ///< unit; in words, the rows that it holds on
  double cost = 0;                ///< what a slip of free size, or an unusual one, must earn
  double deviance = 0;
  double criterion() const { return deviance + cost; }
  /// Its size is fitted: beside a contact that is fitted too it would say little.
  bool free() const { return finding == "offset" || finding == "scale" || finding == "level-shift"; }
  bool disputed = false;  ///< physics does as well, which changes where it holds; or every group differs
};

using ColumnList = std::span<const Column* const>;

inline constexpr double kNoBlow = 1e3;  ///< noise units of a value that no blow and no flight can have

/// Slips without a free number: units, signs, rows, swaps, pairs in one other unit.
std::vector<ColumnSlip> constant_slips(ColumnList columns);

/// Whether a slip says so much more than what is recorded, and than the library, that the column contradicts its
/// header. `scale`: what of every deviance is the density's; `values`: number of readings.
bool contradicts(const ColumnSlip& slip, double recorded, double library, double scale, double values, double tie);

/// The likeliest slip where it holds and nothing disputes it, and the other column that would say as much. `slips`: the
/// likeliest first.
std::vector<WrongColumn> told(ColumnList columns, const std::vector<ColumnSlip>& slips, double tie,
                              const std::function<bool(const ColumnSlip&)>& holds);

/// Parameters [SI] of least loss from a start, and its sum; infinite where there are none, or at the edge of what is
/// plausible.
struct Refitted {
  Eigen::VectorXd p;
  double deviance = kInfinity;
};
Refitted refitted(const Model& model, const Eigen::VectorXd& start, int residuals, const solvers::Loss& loss,
                  const solvers::Residuals& whitened);

}  // namespace hosel::loop
