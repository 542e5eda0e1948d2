/// What a model leaves that follows the inputs and has no name: a rival of every name, and what corrects a prediction
/// beside the named effects.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hosel::loop {

struct Remainder {
  /// Where it is in one channel.
  struct Place {
    int channel = 0;
    double size = 0;     ///< root mean square over the training rows, header's unit
    std::string along;   ///< the column that it follows most
    double share = 0;    ///< of its square that goes when this column stands still
    double largest = 0;  ///< header's unit
    double at = 0;       ///< value of that column there, its unit; of "shot": place in the session
  };
  /// Rows x channels, header's units: to be taken from model minus measured. Of a training row as the others foretell
  /// it.
  Eigen::MatrixXd value;
  double before = 0, after = 0;  ///< deviance of the training rows that it is judged on, without it and with it
  std::vector<Place> places;     ///< the largest in noise units first; none: it foretells nothing

  double fall() const { return before - after; }
};

}  // namespace hosel::loop
