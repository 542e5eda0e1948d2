/// Shots that no blow makes, and shots that stand twice: a slip of the instrument or of a hand.
#pragma once

#include <string>
#include <vector>

#include "loop/shots/shots.hpp"

namespace hosel::app {

/// A sentence for each quantity that no blow gives, with the number of its rows and where they stand. Nobody leaves
/// them out.
std::vector<std::string> implausible_rows(const loop::Shots& shots);

/// A sentence where shots stood in the file more than once; empty elsewhere.
std::string repeated_rows(const loop::Shots& shots);

}  // namespace hosel::app
