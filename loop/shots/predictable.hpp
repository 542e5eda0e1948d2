/// Columns that others foretell more closely than noise allows, by whatever formula.
#pragma once

#include <map>

#include "loop/shots/audit.hpp"

namespace hosel::loop {

/// Columns that are a smooth function of up to four others on all rows or on a part.
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
