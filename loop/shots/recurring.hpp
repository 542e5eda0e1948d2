/// Readings that are none: the one before once more, an end of the scale, a number that is written where nothing was
/// read.
#pragma once

#include <string>
#include <vector>

#include "loop/shots/shots.hpp"

namespace hosel::loop {

/// Rows of a column of results in which the same number stands more often than readings bring it.
struct Recurring {
  std::string column;
  std::vector<int> rows;
  std::string reason;
};

/// Two tests of each column of results, each at a level of 1e-4:
/// - a row has the number of the row before, more often than rows further apart have the same. Rows in which every
///   other result repeats too do not count: such a row is a copy.
/// - one number stands in more rows than coincidence brings, and in twice as many as any other. The column needs twenty
///   different numbers.
std::vector<Recurring> recurring(const Shots& shots);

}  // namespace hosel::loop
