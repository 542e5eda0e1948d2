/// Is it a measurement at all? Columns that are, to within their recording, functions of other columns.
#pragma once

#include <map>
#include <string>
#include <vector>

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

/// Formulas that hold on all rows, then (relations) those that hold on many, then (predictable) what follows from
/// others more closely than noise allows, whatever the formula. `noise`: declared of inputs and outputs, by header, in
/// the header's unit.
std::vector<DerivedColumn> audit(const Shots& shots, const Ball& ball, const std::map<std::string, double>& noise = {});

}  // namespace hosel::loop
