/// Named parameters of the models, and axes of them, from a case's tables.
#pragma once

#include <string>
#include <vector>

#include "app/reader.hpp"
#include "models/parameters.hpp"

namespace hosel::app {

/// A parameter by its name at `key`; an unknown one is an error with the nearest spelling.
const models::NamedParameter& read_parameter(Table& table, Key key);

/// A parameter and the values it takes: `name`, then `values_<unit> = [...]`, or `from_<unit>`, `to_<unit>`
/// and `count`.
struct Axis {
  const models::NamedParameter* parameter = nullptr;
  double si = 1;               ///< one of the unit in SI
  std::string label;           ///< "dynamic loft [deg]"
  std::vector<double> values;  ///< SI
  /// "dynamic loft 30 deg": where its i-th value stands in a sentence.
  std::string said(std::size_t i) const;
};
Axis read_axis(Table table);

/// "dynamic loft [deg]" for figures, "dynamic_loft_deg" for files.
std::string label(const models::NamedParameter& p);
std::string column(const models::NamedParameter& p);
double unit_of(const models::NamedParameter& p);  ///< one of its unit in SI

}  // namespace hosel::app
