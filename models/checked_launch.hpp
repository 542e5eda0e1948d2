/// Checks a model's launch before any other code uses it.
#pragma once

#include "models/impact_model.hpp"

namespace hosel::models {

/// The launch that `model` gives, if it can be: every number finite, and head and ball with no more kinetic energy
/// together than before. Counted in the frame in which the head's centre of gravity was at rest before the blow, where
/// nothing hides in the energy of a head that flies on; of a club that turns about its butt in the butt's frame, with
/// its rod. Of the energy with which the ball meets the head a closed form may err by round-off (1e-6 is forgiven), an
/// integration in time by 0.5 %. 5 % are forgiven where a shaft that was loaded or turns takes part: hands that push
/// with 300 N over the 3 mm of a blow do so much. Throws solvers::NonConvergence with a sentence otherwise, and what
/// the model throws.
Launch checked_launch(const ImpactModel& model, const Blow& blow);
/// The same of many blows: each launch, or what checked_launch() throws on it.
std::vector<Answer> checked_launches(const ImpactModel& model, std::span<const Blow> blows);
/// The same of an answer that `model` has given already.
void check_launch(const ImpactModel& model, const Blow& blow, const Launch& launch);

}  // namespace hosel::models
