#pragma once

#include "loop/shots/model.hpp"

namespace hosel::loop::forms {

/// For bases that do not compute the difference between two blows: the difference by the closed-form eccentric impact.
inline void add_difference(const Blow& with, const Blow& without, double amount, Launch& launch) {
  launch = plus(launch, plus(closed_form().launch(with), closed_form().launch(without), -1), amount);
}

}  // namespace hosel::loop::forms
