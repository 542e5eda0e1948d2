#pragma once
// The examination's own forms of the effects: the natural form of each name, and other forms of the same
// mechanisms. The names are the contract's; the forms are the examination's.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "nature.hpp"

namespace examination {

constexpr int drift_channels = 5;

/// What a form changes: the blow, and slow additive drifts of the recorded channels.
struct Truth {
  Nature nature;
  /// Drift of channel c at the end of the session, in noise standard deviations; zero at the first shot.
  Eigen::Matrix<double, drift_channels, 1> drift = Eigen::Matrix<double, drift_channels, 1>::Zero();
  double drift_power = 1;  ///< shape t^power, t = 0 .. 1 over the session
  double loft_drift = 0;   ///< rad by the end of the session
  double level_drift = 0;  ///< restitution level by the end of the session
};

struct FormParameter {
  std::string name, unit;
  double scale;      ///< typical size: steps and draws are in this unit
  double low, high;  ///< plausible range
};

struct Form {
  std::string effect, form;
  std::vector<FormParameter> parameters;
  std::function<void(Truth&, std::span<const double>)> apply;  ///< zero gives the base
  bool planar, eccentric;                                      ///< the bases on which it makes sense
  std::vector<double> starts = {};                             ///< first parameter, for fits without a slope at zero
};

/// The natural form of every name.
const std::vector<Form>& natural_forms();
/// Other functional forms of some names.
const std::vector<Form>& other_forms();
/// The form with this effect and form name. Throws std::invalid_argument.
const Form& find_form(const std::string& effect, const std::string& form);
/// The restitution level, which a calibration may absorb.
const Form& calibration();

}  // namespace examination
