/// Named parameters of the models, from a case's tables.
#pragma once

#include <string>

#include "app/reader.hpp"
#include "models/parameters.hpp"

namespace hosel::app {

/// A parameter by its name at `key`; an unknown one is an error with the nearest spelling.
const models::NamedParameter& read_parameter(Table& table, Key key);

/// "dynamic_loft_deg" for files.
std::string column(const models::NamedParameter& p);
double unit_of(const models::NamedParameter& p);  ///< one of its unit in SI

}  // namespace hosel::app
