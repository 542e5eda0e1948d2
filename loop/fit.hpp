/// Least squares of effects' parameters on whitened residuals.
#pragma once

#include "loop/problem.hpp"

namespace hosel::loop {

struct Fit {
  Model model;
  Eigen::VectorXd p;                         ///< parameters [SI]
  double deviance = 0;                       ///< see deviance(); infinite where the model has no answer
  bool at_bound = false;                     ///< a parameter at the edge of its plausible range (zero excepted)
  std::vector<Eigen::VectorXd> others = {};  ///< further optima that other starts led to
  int size() const { return int(p.size()); }
};

/// Parameter::scale of every parameter.
Eigen::VectorXd scales(const Model& model);

/// Bounded least squares from each start [SI] through the problem's stages, the best of the last. Of more than `most`
/// starts those of least deviance are followed. `near`: the starts are good, early windows are left out.
Fit fit(const Problem& problem, Part part, const Model& model, std::vector<Eigen::VectorXd> starts, std::size_t most,
        bool near = false);
/// All combinations of the forms' own starting points, zero first, at most 128.
std::vector<Eigen::VectorXd> starts(const Model& model);

/// Whitened residual of a fit; empty where the model has no answer.
Eigen::VectorXd whitened(const Problem& problem, Part part, const Model& model, const Eigen::VectorXd& p);
/// What a fit minimises: the losses, on rows that are fitted with what is known of the parameters besides.
double deviance(const Problem& problem, Part part, const Fit& fit);
/// A fit with one more form, its parameters zero: where a look beside the fit begins.
Fit beside(const Fit& fit, const Parametrisation* more);

/// Those forms of a fit that `keep` wants, where they stand in it.
Fit part_of(const Fit& fit, const auto& keep) {
  Fit out;
  std::vector<double> p;
  fit.model.each(fit.p.data(), [&](const Parametrisation& form, Sizes own) {
    if (!keep(form)) return;
    out.model.forms.push_back(&form);
    p.insert(p.end(), own.begin(), own.end());
  });
  out.p = Eigen::Map<const Eigen::VectorXd>(p.data(), Eigen::Index(p.size()));
  return out;
}

/// What is known of a fit's parameters beside the data, as a part of its deviance.
double known(const Fit& fit);

/// What sizes beyond the usual cost a candidate [units of deviance]: twice the fall of the logarithm of Student's
/// density with four degrees of freedom, whose tails bear a size that is rare.
double improbability(const Fit& fit);

/// What candidates compare by: the deviance, and what the parameters, the complexity of the forms and the sizes cost.
double criterion(const Fit& fit, const Rules& rules);

/// Covariance of the parameters [SI] on a part of the data; infinite along null vectors. Where the noise of a channel
/// is not known, by the scatter of the scores.
Eigen::MatrixXd covariance(const Problem& problem, Part part, const Fit& fit);

inline Eigen::VectorXd as_vector(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), Eigen::Index(x.size()));
}

/// Orthonormal basis of the column space.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

}  // namespace hosel::loop
