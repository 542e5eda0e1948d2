/// Shots that no blow makes: a slip of the instrument or of a hand.
#pragma once

#include <string>
#include <vector>

#include "loop/shots/shots.hpp"

namespace hosel::app {

/// A sentence for each quantity that no blow gives, with the number of its rows and where they stand. Nobody leaves
/// them out.
std::vector<std::string> implausible_rows(const loop::Shots& shots);

}  // namespace hosel::app
