/// Contact methods: normal pressure as a pure function of one point's gap and multiplier.
#pragma once

#include <string>
#include <vector>

namespace hosel::fem {

/// Pressure p [Pa] at a point, as of a spring: p = stiffness * depth, and it acts where depth > 0.
struct NormalSpring {
  double stiffness = 0;  ///< -dp/dg [N/m^3]
  double depth = 0;      ///< p over the stiffness; not above zero: apart [m]
  double pressure() const { return stiffness * depth; }
};

/// What a method knows of a point at an accepted state.
struct NormalState {
  double gap = 0;         ///< negative inside [m]
  double multiplier = 0;  ///< with which the step was solved; 0 where the point is apart [Pa]
  double offset = 0;      ///< stored beyond that of the spring, 1/2 stiffness depth^2 [J/m^2]
};

/// A new method is a class beside penalty.hpp and a row in methods.cpp.
class ContactMethod {
 public:
  virtual ~ContactMethod() = default;
  virtual NormalSpring at(double gap, double multiplier) const = 0;

  /// Whether points have multipliers. What follows is asked only then.
  virtual bool multipliers() const { return false; }
  /// The next multiplier [Pa], where a step was solved with this one: that of the next step, or of the same once more.
  virtual double next([[maybe_unused]] double gap, [[maybe_unused]] double multiplier) const { return 0; }
  /// Whether the step that led there has to be solved again with the next multiplier.
  virtual bool repeats([[maybe_unused]] double gap, [[maybe_unused]] double multiplier) const { return false; }
  /// NormalState::offset of a point that is pressed `now` [J/m^2].
  virtual double offset(const NormalState&, [[maybe_unused]] const NormalState& now) const { return 0; }

  /// Sentences naming what cannot be; empty if all is well.
  virtual std::vector<std::string> faults() const = 0;
};

}  // namespace hosel::fem
