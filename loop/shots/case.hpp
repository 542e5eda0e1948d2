/// A loop on shots: the measured ones, the base model, what is known of club, ball and noise.
#pragma once

#include <map>

#include "hosel/loop/case.hpp"
#include "hosel/loop/shots/shots.hpp"
#include "hosel/models/impact_model.hpp"

namespace hosel::loop {

struct ShotCase : Case {
  const models::ImpactModel* model = nullptr;
  bool direct = true;      ///< see ShotModel
  bool head_turns = true;  ///< the base lets the head rotate
  Blow blow;               ///< ball, head, contact law; the delivery comes from the shots
  bool head_mass_declared = false;
  bool inertia_declared = false;
  Shots shots;
  std::map<std::string, double> noise;        ///< by header, header's unit
  std::map<std::string, double> input_noise;  ///< the same for inputs
};

}  // namespace hosel::loop
