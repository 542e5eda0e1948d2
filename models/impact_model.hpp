/// The interface of every impact model: (delivery, club, ball) -> launch.
#pragma once

#include <exception>
#include <span>
#include <string_view>
#include <vector>

#include "golf/blow.hpp"
#include "golf/launch.hpp"

namespace hosel::models {

class Impact;

/// One of many blows: the launch, or what ImpactModel::launch() throws on it.
struct Answer {
  Launch launch;
  std::exception_ptr failure;
  const Launch& value() const {
    if (failure) std::rethrow_exception(failure);
    return launch;
  }
};

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
  /// launch() of every blow, in their order. An answer does not depend on the other blows. One after the other, unless
  /// the model goes through several side by side.
  virtual std::vector<Answer> launches(std::span<const Blow> blows) const {
    std::vector<Answer> answers(blows.size());
    for (std::size_t k = 0; k < blows.size(); ++k) try {
        answers[k].launch = launch(blows[k]);
      } catch (...) { answers[k].failure = std::current_exception(); }
    return answers;
  }
};

}  // namespace hosel::models
