/// Whose hand the club is in.
#pragma once

#include "app/import/reading.hpp"

namespace hosel::app {

/// A column of nothing but words for a left-handed and a right-handed player, whatever its header; or for left and
/// right under one that may be about hands.
bool names_hands(const Reading& r, std::size_t c);

/// A left-handed player's shots as a right-handed one's: what is signed towards the right turns round. The place on
/// the face is towards the toe for both, and in-to-out, open and a fade are the same words for both.
void mirror_left_hand(Reading& r);

}  // namespace hosel::app
