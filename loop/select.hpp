/// Which effects explain the residual: single effects, all pairs, triples, each at its own optimum.
#pragma once

#include <string>
#include <vector>

#include "hosel/loop/fit.hpp"
#include "hosel/loop/structure.hpp"

namespace hosel::loop {

/// Thresholds of the selection; the README of this folder explains the figures.
struct Rules {
  double gate = 0.01;             ///< level of the test for structure at all
  double gain = 22;               ///< least fall of the deviance for a first effect
  double threshold_gain = 32;     ///< least fall by a threshold effect that opens the gate on its own
  double further_gain = 16;       ///< least fall of the criterion for one more effect
  double parameter_cost = 4;      ///< criterion = deviance + cost * parameters
  double tie = 7;                 ///< candidates within this of the best criterion tie with it
  double holdout_loss = 4;        ///< the held-out deviance must not rise by more
  double remaining = 0.005;       ///< level of the test for what is left
  double remaining_signal = 4.9;  ///< or any regressor with this signal, where the noise is declared
  int flips = 999;
  unsigned long seed = 1;
};

struct Candidate {
  std::vector<std::string> effects;  ///< in the order of the contract
  Fit fit;                           ///< effects of the base first
  double criterion = 0;
};

struct Selection {
  Fit base;                           ///< effects that the case declares, fitted
  std::vector<Candidate> candidates;  ///< by rising criterion
  std::vector<std::string> adopted;
  std::vector<std::vector<std::string>> ties;
  Fit chosen;               ///< the model behind `after`: the best of the chosen level, else the base
  int level = 0;            ///< number of effects that the data ask for
  bool structured = false;  ///< the gate
  bool clean = true;        ///< nothing remains after `chosen`
  bool nameless = false;    ///< many sets of effects tie and no name is common to them
  StructureMap before, after;
  std::vector<Regressor> regressors;
  std::vector<std::string> silent;  ///< effects without influence on these channels at these inputs
};

/// Candidate forms given; `base` are forms that are always part of the model. Rows: training rows of the
/// problem. `declared`: per channel, whether its noise is known, so that signals can be read in its units.
/// `deep`: go on to triples where pairs leave structure.
Selection select(const Problem& problem, const std::vector<int>& rows, const std::vector<const Form*>& base,
                 const std::vector<const Form*>& candidates, const std::vector<Regressor>& regressors, const Loss& loss,
                 const std::vector<char>& declared, const Rules& rules, bool deep = true);

}  // namespace hosel::loop
