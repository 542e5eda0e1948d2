/// Sets of effects, each at its own optimum: single effects, all pairs (screened by linear algebra, refitted; far from
/// linear, those that begin with a good single effect), triples that begin with a good pair.
#pragma once

#include "loop/fit.hpp"
#include "loop/rules.hpp"
#include "loop/told.hpp"

namespace hosel::loop {

struct Candidate {
  std::vector<std::string> effects;  ///< in the order of the registry
  Fit fit;                           ///< effects of the base first
  double criterion = 0;  ///< deviance + cost of the parameters + complexity of the forms + improbability of their sizes
};

/// Place of an effect in the registry: the order in which sets of effects are told.
std::size_t order_of(const std::string& effect);

class Search {
 public:
  /// Fits the base and every single form. `forms`: what may be added to the forms of the base.
  Search(const Problem& problem, const std::vector<const Parametrisation*>& base,
         const std::vector<const Parametrisation*>& forms, const Rules& rules, Told told = {});
  void fit_pairs();
  void fit_triples();

  Fit base;
  std::vector<Candidate> singles, pairs, triples;  ///< by rising criterion, one per set of effects
  std::vector<std::string> silent;                 ///< effects without influence on these channels at these inputs

  /// Fall of the deviance by the best threshold effect. It acts on few shots, which a test's weights take for bad ones;
  /// that a plausible threshold explains them is seen here only.
  double threshold_gain() const;
  /// What each form changes at its optimum, whitened.
  Eigen::MatrixXd directions() const;
  /// The fit of least deviance, whatever it takes.
  const Fit& richest() const;

 private:
  /// A form made linear about a point: whitened columns per unit of scale.
  struct Linear {
    const Parametrisation* form;
    Eigen::Index first, count;
  };

  /// A pair, what linear algebra promises of it, and where to begin.
  struct Guess {
    double criterion;
    const Parametrisation *a, *b;
    Eigen::VectorXd p;
  };

  void weigh(const Fit& fit);
  Eigen::MatrixXd weighted(const Eigen::MatrixXd& a) const;
  bool acts(const Parametrisation* form) const;
  bool nothing_to_find(const std::vector<Eigen::MatrixXd>& columns) const;
  Eigen::MatrixXd about_zero(const Parametrisation& form) const;
  void linearise(std::vector<Eigen::MatrixXd> about_zero);
  double promise(const std::vector<std::size_t>& which, Eigen::VectorXd& p) const;
  std::vector<Guess> guesses() const;
  std::vector<Candidate> grown(const std::vector<Candidate>& sets, std::size_t few) const;
  Candidate candidate(Fit fit) const;
  std::vector<Candidate> refined(std::vector<Candidate> all) const;
  const Fit& of(const Parametrisation* form) const;  ///< of one that acts, beside the base
  Eigen::VectorXd optimum(const Parametrisation* form) const;
  std::vector<Eigen::VectorXd> other_optima(const Parametrisation* form) const;

  const Problem& problem_;
  const std::size_t base_forms_;
  const Rules& rules_;
  const Told told_;
  const Effort effort_;
  const solvers::Loss loss_;
  std::vector<Candidate> of_form_;  ///< every form that acts, at its optimum
  Eigen::VectorXd z0_, weight_;
  std::vector<Linear> linear_;
  Eigen::MatrixXd columns_, gram_;
  Eigen::VectorXd target_;
};

}  // namespace hosel::loop
