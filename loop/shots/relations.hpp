/// Relations that hold on a part of the rows only, to the last digit: a column that was filled in by computation where
/// the instrument saw nothing.
#pragma once

#include "loop/shots/audit.hpp"

namespace hosel::loop {

/// Columns that on 35 % of the rows and more are a formula of others: sums, products, quotients and means of columns
/// with at most one free number, and the directions of club, face and ball. Told once, for the column that was
/// computed. `whole`: what is known to hold on all rows.
std::vector<DerivedColumn> partly_derived(const Shots& shots, const std::vector<DerivedColumn>& whole);

}  // namespace hosel::loop
