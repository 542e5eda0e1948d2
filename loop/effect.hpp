/// Candidate effects: named, parameterised changes of what a model declares. Zero parameters give the base
/// model back bit for bit. A new effect is one file in loop/effects and one line in loop/effects.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hosel/golf/blow.hpp"
#include "hosel/golf/launch.hpp"
#include "hosel/loop/shots.hpp"

namespace hosel::loop {

/// One shot as an effect sees it.
struct Trial {
  Blow blow;
  double order = 0;  ///< place in the session: 0 the first shot, 1 the last
};

struct Parameter {
  std::string name;
  std::string unit;  ///< as reports print it
  double si = 1;     ///< one printed unit in SI
  double min, max;   ///< plausible range [SI]; zero lies inside or on its edge
  double scale;      ///< a size that matters [SI]: step of finite differences, unit of the optimiser
};

/// One functional form of an effect. The three hooks are applied in this order; all may be empty.
struct Form {
  std::string effect;  ///< name of the contract
  std::string what;    ///< what this form varies, in words
  std::vector<Parameter> parameters;
  /// How much better than the effect's usual forms an unusual one must fit [units of deviance].
  double rarity = 0;
  /// Further starting points [SI]; needed where the gradient at zero vanishes (thresholds).
  std::vector<std::vector<double>> starts;
  /// Changes the blow before the model answers.
  std::function<void(std::span<const double>, Trial&)> before;
  /// Changes the model's answer (the blow as the other hooks left it).
  std::function<void(std::span<const double>, const Trial&, Launch&)> after;
  /// Changes what the instrument shows of one output [SI].
  std::function<double(std::span<const double>, const Trial&, Output, double)> reading;
};

/// What the forms of an effect depend on.
struct Setting {
  bool head_turns = false;        ///< the base model lets the head rotate
  bool inertia_declared = false;  ///< the case declares a finite inertia tensor
  std::vector<Output> outputs;    ///< channels of the data
};

struct EffectEntry {
  std::string_view name;
  std::string_view what;                       ///< what a model without it lacks
  std::string_view sensor;                     ///< the quantity whose direct measurement would settle it
  std::vector<Form> (*forms)(const Setting&);  ///< empty where the effect cannot act on this base
};

/// Every effect on shots, in the order of the contract.
std::span<const EffectEntry> effects();
/// nullptr where no effect has this name.
const EffectEntry* find_effect(std::string_view name);

}  // namespace hosel::loop
