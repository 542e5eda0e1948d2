/// What a loop on shots offers the library: its base with the adopted effects in it.
#pragma once

#include "app/library.hpp"
#include "app/offer.hpp"
#include "loop/result.hpp"
#include "loop/shots/case.hpp"
#include "models/fe/changeable_fe.hpp"

namespace hosel::app {

/// What the shots ask of an entry: from 5 to 95 % of them, since some rows of a session are impossible. Nothing without
/// a usable row.
std::optional<Use> use_of_shots(const loop::ShotCase& c);

/// What the numbers of the declared head do not hold.
struct HeadWords {
  std::string face{kRigidFace};  ///< of the library; empty: it yields by values that have no name there
  std::optional<double> loft;    ///< of the library's head [rad]
};

/// Entries for what the effects change alike in every shot: the contact's law or friction, the head, the ball's layers,
/// the face. What they change from shot to shot, or in the instrument, is named in each entry as not in it. `base` is
/// the finite-element one, or nullptr.
void offer_corrected(Output& out, const loop::ShotCase& c, const loop::LoopResult& result,
                     const models::ChangeableFe* base, const HeadWords& words);

}  // namespace hosel::app
