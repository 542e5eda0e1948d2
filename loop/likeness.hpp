/// Similarity of effects in the data: the share of an effect that the fitted ones absorb, and the combinations of
/// effects that no channel shows.
#pragma once

#include "loop/fit.hpp"

namespace hosel::loop {

struct Absorption {
  std::string effect, parameter;
  double absorbed = 0;  ///< share of the squared signal that the fitted parameters take up
  double signal = 0;    ///< what is left of one scale of the parameter, in noise units
  std::string nearest;  ///< the effect that what is left resembles most
  double likeness = 0;  ///< their correlation
};

/// A direction in the effects' parameters, each in units of its own signal, that the data hardly show.
struct NullVector {
  double singular = 0;  ///< of the whitened Jacobian, columns of unit length: 0 invisible, 1 alone in its direction
  std::vector<std::pair<std::string, double>> weights;  ///< effect, share
};

struct Likeness {
  std::vector<Absorption> absorption;
  std::vector<NullVector> null_vectors;  ///< at most four, the smallest singular values first; none above 0.1
};

struct EffectColumn {
  std::string effect, parameter;
  Eigen::VectorXd whitened;  ///< per scale of the parameter
};

/// `fitted`: whitened Jacobian of what the model already fits (no columns: nothing).
Likeness likeness(const std::vector<EffectColumn>& columns, const Eigen::MatrixXd& fitted);
/// Of the effects beside a fit, one column each: their first form with one parameter, a finite probe where it is a
/// threshold.
Likeness likeness(const Problem& problem, const Fit& at, const std::vector<const Parametrisation*>& forms);

}  // namespace hosel::loop
