/// A column of inputs that is off by a constant beside an effect. Without one, loop/shots/columns finds it.
#pragma once

#include <optional>

#include "loop/shots/problem.hpp"
#include "loop/study.hpp"

namespace hosel::loop {

struct InputOffset {
  Input input;
  double size;                      ///< what is recorded lacks this [SI]
  std::vector<std::string> beside;  ///< effects that explain the rest
};

/// The offset of one input that, in place of an effect of the chosen model or beside one effect of the library, is
/// likelier than that model by more than a tie.
std::optional<InputOffset> likelier_offset(const Problem& problem, const Study& study,
                                           const std::vector<Input>& recorded);

}  // namespace hosel::loop
