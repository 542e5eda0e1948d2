/// Candidate effects: named changes of a model's input or output, with parameters. With zero parameters the result is
/// that of the base model, bit for bit. A new effect is one file in loop/effects, its declaration in
/// loop/effects/all.hpp and one line in loop/effects.cpp. An effect outside the library is part of the case
/// (examples/own_effect.cpp).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "golf/face_compliance.hpp"
#include "golf/quantities.hpp"
#include "loop/deviation.hpp"
#include "models/fe/fe_change.hpp"

namespace hosel::models {
struct FlightConditions;  // flight.hpp
}

namespace hosel::loop {

struct TestSetup;  // a club test: history/test_setup.hpp
struct HistorySetting;

/// One shot as an effect sees it.
struct Shot {
  Blow blow;
  models::FeChange change;          ///< of what a finite-element base declares beside the blow
  double order = 0;                 ///< place in the session: 0 the first shot, 1 the last
  std::optional<Launch> seen = {};  ///< what the monitor saw of the launch: there the flight starts
};

struct Parameter {
  std::string name;
  std::string unit;  ///< as reports print it
  double si = 1;     ///< one printed unit in SI
  double min, max;   ///< plausible range [SI]; zero lies inside or on its edge
  double scale;      ///< a size that matters [SI]: step of finite differences, unit of the optimiser
  /// Standard deviation about zero by another measurement of what is declared [SI]; infinite: none is known.
  double known = kInfinity;
  /// How far what is declared is usually off [SI]; its source stands where the effect declares it. Prices what a search
  /// finds (improbability), does not draw its fits; infinite: nothing is known of that.
  double usual = kInfinity;

  /// Whether it stands at an end of its range that is not zero.
  bool at_edge(double x) const {
    const double margin = kNothing * (max - min);
    return (max > 0 && max - x < margin) || (min < 0 && x - min < margin);
  }

  Parameter within(double usual_size) const {
    Parameter out = *this;
    out.usual = usual_size;
    return out;
  }
};

using Sizes = std::span<const double>;  ///< of a form's parameters [SI]

/// One functional form of an effect. The hooks on a shot are applied in this order; all may be empty.
struct Parametrisation {
  std::string effect;  ///< name of its entry, which gives it
  std::string what;    ///< what this form varies, in words
  std::vector<Parameter> parameters;
  /// How much better than the effect's usual forms an unusual one must fit [units of deviance].
  double complexity = 0;
  /// Further starting points [SI].
  std::vector<std::vector<double>> starts;
  /// It acts in proportion to the shot's place in the session.
  bool of_order = false;
  /// Nothing happens below some size: the gradient at zero vanishes, and the starts are probes that stand for it.
  bool threshold = false;
  /// Shot: changes the blow before the model answers.
  std::function<void(Sizes, Shot&)> before;
  /// Shot: changes the model's answer (the blow as the other hooks left it).
  std::function<void(Sizes, const Shot&, Launch&)> after;
  /// Shot: changes what the instrument shows of one output [SI].
  std::function<double(Sizes, const Shot&, Output, double)> reading;
  /// Shot: changes the launch that was seen, where the base is the flight alone.
  std::function<void(Sizes, Launch&)> seen;
  /// Shot: changes law, air or wind of the flight.
  std::function<void(Sizes, models::FlightConditions&)> flight;
  /// Club test: changes club, clamp or sensors.
  std::function<void(Sizes, TestSetup&)> setup;
};

/// A form `of_order` that takes shots for as far in the session as `place` says of where they are: the same on every
/// shot where that is constant, a jump where it is a step.
Parametrisation placed_otherwise(const Parametrisation& form, std::function<double(double)> place);

/// What the forms of an effect on shots depend on.
struct Setting {
  bool head_turns = false;        ///< the base model lets the head rotate
  bool inertia_declared = false;  ///< the case declares a finite inertia tensor
  bool hosel_declared = false;    ///< the case says where the shaft enters the head
  std::vector<Output> outputs;    ///< channels of the data, of the launch
  bool flies = false;             ///< and some of the flight
  bool no_blow = false;           ///< the base is the flight alone, from the launch that was seen
  bool deformable = false;        ///< the base computes the ball's deformation: it has no impact law to change
  bool shaft = false;             ///< the case declares a shaft that such a base can hang on its free head
  bool full_club = false;         ///< such a base has its shaft already
  FaceCompliance face = {};       ///< of a head like this one: models::usual_face
};

/// What an effect on shots is where it is one free function through one mechanism, whatever its form.
struct OneFunction {
  enum class Through { several, normal_restitution, tangential_restitution, recorded_loft } through = Through::several;
  enum class Of { blow, place } of = Of::blow;  ///< speed, loft, attack angle, incidence; or the place of impact

  bool operator==(const OneFunction&) const = default;
};

struct EffectEntry {
  std::string_view name;
  std::string_view what;    ///< what a model without it lacks
  std::string_view sensor;  ///< the quantity whose direct measurement would settle it
  /// Its forms on shots and on records of a club test; they return none where it cannot act on this base.
  std::vector<Parametrisation> (*on_shots)(const Setting&) = nullptr;
  std::vector<Parametrisation> (*on_tests)(const HistorySetting&) = nullptr;
  OneFunction function = {};

  /// The same with its name; none on data on which it has none.
  std::vector<Parametrisation> forms(const Setting& setting) const;
  std::vector<Parametrisation> forms(const HistorySetting& setting) const;
};

/// Every effect, in the order in which reports name them.
std::span<const EffectEntry> effects();
/// The library's effects, then those of one's own.
std::vector<EffectEntry> effects_with(std::span<const EffectEntry> own);
/// nullptr where no effect has this name.
const EffectEntry* find_effect(std::string_view name, std::span<const EffectEntry> own = {});
/// What would settle these ties, each quantity once.
std::vector<std::string> sensors_of(const std::vector<std::vector<std::string>>& ties,
                                    std::span<const EffectEntry> own);

}  // namespace hosel::loop
