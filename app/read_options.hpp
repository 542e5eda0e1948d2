/// How the models of a case are solved: `[volumetric]`, `[hertz_maw]`, and for FE `[contact]`, `[mesh]`, `[time]`.
#pragma once

#include <string>
#include <vector>

#include "app/reader.hpp"
#include "models/options.hpp"

namespace hosel::app {

/// Reads the tables that the named models look at, and no others.
models::Options read_options(Table root, const std::vector<std::string>& models);

}  // namespace hosel::app
