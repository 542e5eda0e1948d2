/// The one gate between a model's answer and whoever believes it.
#pragma once

#include <string_view>

#include "hosel/models/impact_model.hpp"

namespace hosel::models {

/// The launch that `model` gives, if it can be: every number finite, and head and
/// ball with no more kinetic energy together than before (1 % more is forgiven, 5 % where a shaft pushes too).
/// Throws solvers::NonConvergence with a sentence otherwise, and what the model throws.
Launch checked_launch(const ImpactModel& model, const Blow& blow);
/// The same of an answer that is there already.
void check_launch(const Blow& blow, const Launch& launch);

}  // namespace hosel::models
