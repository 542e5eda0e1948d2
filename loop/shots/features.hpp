/// Coordinates of the surrogate of a slow base: the blow in the face frame, and the quantities that effects change.
#pragma once

#include <span>
#include <string_view>

#include "loop/effect.hpp"

namespace hosel::loop {

/// One coordinate of a surrogate. An impact knows no direction but its own: the blow is seen in the face frame.
struct Feature {
  std::string_view name;
  double (*get)(const Shot&);
  /// Puts a value there, the others kept; nullptr: it follows from the delivery's inputs.
  void (*set)(Shot&, double) = nullptr;
};

/// A new quantity that an effect may change inside a slow base is one row here.
std::span<const Feature> features();

}  // namespace hosel::loop
