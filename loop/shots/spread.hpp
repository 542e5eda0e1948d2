/// Deliveries that fill the range of recorded ones.
#pragma once

#include <vector>

#include "hosel/loop/shots/shots.hpp"

namespace hosel::loop {

/// A Latin hypercube over the box of the recorded inputs (one per cent to spare on either side); inputs without a
/// column are zero. Throws DataError where the shots have no usable club_speed or dynamic_loft.
std::vector<Delivery> spread(const Shots& shots, int points, unsigned long seed);

}  // namespace hosel::loop
