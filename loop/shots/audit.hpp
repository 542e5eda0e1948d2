/// Derived columns: columns that are functions of other columns to within their recording step.
#pragma once

#include <Eigen/Core>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "loop/deviation.hpp"
#include "loop/shots/shots.hpp"

namespace hosel::loop {

struct DerivedColumn {
  std::string column;
  std::vector<std::string> from;
  std::string formula;
  double residual_sd = 0;           ///< column's unit
  double recording_resolution = 0;  ///< column's unit
  int rows = 0;                     ///< on which it holds
  double share = 1;                 ///< of those that could show it
  bool input = false;               ///< the column is an input of the models
};
/// On all rows; `residual` [SI].
DerivedColumn derived_column(const Column& y, std::vector<std::string> from, std::string formula, double residual);

/// An evenly spread sample of so many rows shows a function.
inline constexpr std::size_t kRowsAsked = 400;
/// Some columns and one more.
std::set<int> set_with(const auto& columns, int more) {
  std::set<int> all(columns.begin(), columns.end());
  all.insert(more);
  return all;
}
/// A numeric column over some rows, as a formula sees it.
struct FormulaColumn {
  const Column* column;
  Eigen::VectorXd x;           ///< SI, so that no formula hangs on a unit; NaN where missing
  std::vector<double> rising;  ///< those that are there

  double step() const { return column->resolution; }  ///< of the recording, SI
  double spread() const { return at_share(rising, 0.9) - at_share(rising, 0.1); }
};
/// Those with a value on at least `fewest` of the rows.
std::vector<FormulaColumn> formula_columns(const Shots& shots, const std::vector<std::size_t>& rows,
                                           std::size_t fewest);
/// Whether the bulk of a column, between these values, keeps its sign and stays away from zero.
bool may_divide(double low, double high);
/// What an instrument is likely to compute: unknown columns, inputs (the loft before the others), spin, the rest.
int rank_if_computed(const Column& c);

/// Formulas that hold on all rows, then what is `partly_derived`, then what is `predictable`. `noise`: declared of
/// inputs and outputs, by header, in the header's unit.
std::vector<DerivedColumn> audit(const Shots& shots, const Ball& ball, const std::map<std::string, double>& noise = {});

/// Relations that hold on a part of the rows only, to the last digit: a column that was filled in by computation where
/// the instrument saw nothing. Columns that on 35 % of the rows and more are a formula of others: sums, products,
/// quotients and means of columns with at most one free number, and the directions of club, face and ball. Told once,
/// for the column that was computed. `whole`: what is known to hold on all rows.
std::vector<DerivedColumn> partly_derived(const Shots& shots, const std::vector<DerivedColumn>& whole);

/// Columns that are a smooth function of up to four others on all rows or on a part, whatever the formula.
///
/// A reading has an error of its own, and so have those that foretell it: its departure from any function f of them has
/// at least the variance s^2 + sum (df/dx_k)^2 s_k^2, where s are the declared noises with the rounding. A column that
/// departs less was computed from the others as they were recorded. f is quadratic, fitted together with the share of
/// the rows on which it holds; on the others the column scatters about a plane. Told is the column that is likelier by
/// its function than by no more than noise allows, beyond the number of functions that were tried; then the next
/// without it. `noise`: of inputs and outputs, by header, in the header's unit; a column without is never told.
/// `known`: computed columns that are left out.
std::vector<DerivedColumn> predictable(const Shots& shots, const std::map<std::string, double>& noise,
                                       const std::vector<DerivedColumn>& known);

}  // namespace hosel::loop
