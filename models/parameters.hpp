/// Parameters of the models by name, for tuning, sweeps and comparisons. A new parameter is one line in parameters.cpp.
#pragma once

#include <span>
#include <string_view>

#include "golf/blow.hpp"
#include "models/options.hpp"

namespace hosel::models {

struct NamedParameter {
  std::string_view name;
  std::string_view unit;  ///< suffix in files; empty: dimensionless
  double low, high;       ///< what is plausible at all [SI]
  double (*get)(const Options&, const Blow&);
  void (*set)(Options&, Blow&, double);
};

std::span<const NamedParameter> parameters();
/// nullptr where no parameter has this name.
const NamedParameter* find_parameter(std::string_view name);

}  // namespace hosel::models
