/// The input of a loop on shots: measured shots, base model, declared club, ball and noise.
#pragma once

#include <map>
#include <optional>

#include "loop/case.hpp"
#include "loop/shots/averages.hpp"
#include "loop/shots/shots.hpp"
#include "loop/shots/surrogate.hpp"
#include "models/flight/flight.hpp"
#include "models/impact_model.hpp"

namespace hosel::loop {

/// A base that takes seconds to answer. It is asked about shots with the effects in them, from many threads.
struct SlowBase {
  Surrogate::Answer coarse;  ///< at an accuracy at which hundreds of answers are affordable
  Surrogate::Answer fine;    ///< at the case's own; empty: the same
  int runs = 0;              ///< coarse ones before anything is found; 0: as many as the effects need
  int fine_runs = 24;
  int checked = 40;  ///< held-out shots that the corrected base itself is asked about, at most
  unsigned long seed = 1;
};

/// What the case tells of an effect's parameter beside the shots: it is zero within this.
struct Known {
  std::string effect, parameter;
  double sd;  ///< standard deviation, the parameter's printed unit
  std::string source;
};

struct ShotCase : Case {
  /// Of the base, one of: a model that answers quickly; one that does not (`run` makes a surrogate); a surrogate.
  const models::ImpactModel* model = nullptr;
  const SlowBase* slow = nullptr;
  const Surrogate* surrogate = nullptr;
  Surrogate::Answer closing = {};  ///< of a surrogate: the base itself, to be asked about held-out shots
  int checked = 0;                 ///< so many, at most
  bool direct = true;              ///< see ShotModel
  bool head_turns = true;          ///< the base lets the head rotate
  bool deformable = false, shaft_declared = false, full_club = false;  ///< see Setting
  Blow blow;  ///< ball, head, contact law; the delivery comes from the shots
  bool head_mass_declared = false;
  bool inertia_declared = false;
  bool hosel_declared = false;
  std::optional<models::FlightConditions> flight;  ///< absent: readings of the flight are not looked at
  Shots shots;
  std::optional<Averages> averages;           ///< the shots are means of these rows
  bool loft_unknown = false;                  ///< every shot's loft is found from its launch angle
  std::map<std::string, double> noise;        ///< by header, header's unit
  std::map<std::string, double> input_noise;  ///< the same for inputs
  std::vector<Known> known;                   ///< of what the base declares, for all rows alike: by another measurement
  /// Quantities that the base declares once although they differ between rows, each with its standard deviation.
  std::vector<Known> varying;
};

/// The rows that were read, of which the shots may be means.
inline const Shots& as_read(const ShotCase& c) { return c.averages ? c.averages->single : c.shots; }

}  // namespace hosel::loop
