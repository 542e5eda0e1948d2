/// The one concept that ties the house together: (delivery, club, ball) -> launch.
#pragma once

#include <string_view>

#include "golf/blow.hpp"
#include "golf/launch.hpp"

namespace hosel::models {

class Impact;

class ImpactModel {
 public:
  virtual ~ImpactModel() = default;
  /// The launch after the blow. Pure: the same blow gives the same launch, from any thread.
  /// Throws std::invalid_argument on a blow that cannot happen (the head moves away from the ball),
  /// solvers::NonConvergence where a numerical model finds no answer.
  virtual Launch launch(const Blow& blow) const = 0;
  /// Where the model is the finite-element impact: what can be watched step by step, and gone on with from where it
  /// stopped. Else nullptr.
  virtual const Impact* impact() const { return nullptr; }
};

}  // namespace hosel::models
