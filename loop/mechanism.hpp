/// One function that acts through one mechanism, as a verdict sees it.
#pragma once

#include <string>
#include <vector>

namespace hosel::loop {

struct Mechanism {
  std::string acts;                ///< through what, in words
  std::string along;               ///< the column that it is a function of; "shot": of the place in the session
  bool step = false;               ///< it changes at one shot of the session
  int channel = 0;                 ///< that it moves most, in noise units
  double criterion = 0;            ///< deviance with it, and what the freedom of the function costs
  std::vector<std::string> names;  ///< effects that such a function is; none: it has no name
};

}  // namespace hosel::loop
