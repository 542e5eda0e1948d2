/// Ways in which the channels of a shot move together.
#pragma once

#include <string>
#include <vector>

#include "loop/shots/model.hpp"
#include "loop/shots/shots.hpp"

namespace hosel::loop {

inline constexpr double kNoMotion = kRoundOff;  ///< norm of whitened derivatives: nothing moves

/// One way in which a shot's channels move together.
struct Way {
  std::string acts, column;  ///< column: the input or reading that is wrong; empty: physics
  Parametrisation form;
  enum class Kind { normal, tangential, input, reading } kind;
};

/// The restitutions, an error of each input of the data, an error of each reading.
std::vector<Way> ways(const ShotModel& model, const Shots& shots);

}  // namespace hosel::loop
