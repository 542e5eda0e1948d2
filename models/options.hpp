/// How a model is solved, and what its ball and contact are made of where the blow's contact law does
/// not say it: one struct for all, each model reads its own.
#pragma once

#include "models/club/mounted_shaft.hpp"
#include "models/fe/impact.hpp"
#include "models/fe/plate_face.hpp"
#include "models/reduced/volumetric.hpp"
#include "models/rigid/hertz_maw.hpp"

namespace hosel::models {

struct Options {
  VolumetricLaw volumetric;
  VolumetricOptions volumetric_solution;
  ShaftImpedanceOptions shaft_beam;
  HertzMawLaw hertz_maw;
  HertzMawOptions hertz_maw_solution;
  FeImpactOptions fe;
  std::shared_ptr<const PlateOnDemand> plate = {};  ///< where `fe.face` is one
  ShaftMount shaft_mount;
};

}  // namespace hosel::models
