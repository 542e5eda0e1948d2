/// The input that every loop has, for all kinds of data.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "loop/effect.hpp"
#include "loop/rules.hpp"
#include "loop/told.hpp"

namespace hosel::loop {

struct Split {
  double holdout_fraction = 1.0 / 3.0;
  unsigned long seed = 1;
  std::string by;                             ///< column whose clusters are held out whole; empty: rows
  bool leave_one_out = false;                 ///< every cluster is the holdout once
  std::optional<std::array<double, 2>> span;  ///< of time histories: held out are the readings of these instants [s]
};

struct Case {
  std::string title;
  std::string base;                  ///< name of the model
  std::vector<std::string> effects;  ///< declared part of the base; their parameters are fitted
  std::vector<EffectEntry> own;      ///< candidates beside the library's
  Split split;
  Rules rules;
  std::vector<std::string> notes;  ///< about the case itself
  Told told = {};                  ///< progress
};

}  // namespace hosel::loop
