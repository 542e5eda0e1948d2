/// Numerical options of the models, and parameters of ball and contact that the blow's contact law does not contain:
/// one struct for all models. Each model reads its own members.
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
