/// A finite-element base with the effects that a loop adopted in it, as a case that anyone can run.
#pragma once

#include "app/output.hpp"
#include "loop/result.hpp"
#include "models/fe/changeable_fe.hpp"

namespace hosel::app {

/// Writes OUT/corrected/case.toml: `kind = "study"`, one variant for each of the result's corrected shots, with what
/// was measured beside it; everything else as the loop's own case has it. Writes nothing where there are no shots.
void write_corrected(Output& out, const loop::LoopResult& result, const models::ChangeableFe& base, bool loft_unknown);

}  // namespace hosel::app
