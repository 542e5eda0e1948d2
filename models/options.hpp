/// How a model is solved, and what its ball and contact are made of where the blow's contact law does
/// not say it: one struct for all, each model reads its own.
#pragma once

#include "models/volumetric.hpp"

namespace hosel::models {

struct Options {
  VolumetricLaw volumetric;
  VolumetricOptions volumetric_solution;
};

}  // namespace hosel::models
