#pragma once
// What a report's next experiment is worth: the shots that it asks for against ordinary ones.

#include "strata.hpp"

namespace examination {

struct Answer {
  bool separable = false;  ///< the designed shots, or as many as the session had at corners of the box, part truth and
                           ///< rival by a = 4.8
  bool sensor = false;     ///< the report names a quantity to measure
  double ordinary = 0;     ///< further shots like the session's until a = 4.8
  double designed = 0;     ///< further shots as the report asks for, repeated in turn; infinite where none help
};

/// Judges `next_experiment` of a report on a set with one hidden effect, tied with `rival`. The box is the session's
/// range of every input, wider by a quarter on both sides. Throws std::invalid_argument where the rival has no form.
Answer judge_answer(const Set& set, const std::string& rival, const Json& next_experiment);

}  // namespace examination
