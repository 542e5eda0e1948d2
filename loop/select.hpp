/// The rule for adopting: how many effects the data require, which, and their ties.
#pragma once

#include "loop/search.hpp"
#include "loop/structure.hpp"

namespace hosel::loop {

struct Selection {
  Fit base;                           ///< effects that the case declares, fitted
  std::vector<Candidate> candidates;  ///< the likeliest first, every effect beyond the first at its price
  std::vector<std::string> adopted;
  std::vector<std::vector<std::string>> ties;
  Fit chosen;               ///< the model behind `after`: the best of the chosen level, else the base
  Fit richest;              ///< of least deviance, whatever it takes
  int level = 0;            ///< number of effects that the data ask for
  bool structured = false;  ///< the gate
  bool clean = true;        ///< nothing remains after `chosen`
  bool nameless =
      false;  ///< many sets of effects tie, without a name in common, and not as one choice from each of few ties
  /// Two effects, of which the chosen is one: likelier by more than a tie and not by as much as a second must be.
  std::vector<std::string> likelier;
  /// In words, what acts in proportion to the place in the session and does as well without it, chosen or as likely as
  /// what was chosen; empty: none.
  std::string at_every_shot;
  StructureMap before, after;
  std::vector<std::string> silent;  ///< effects without influence on these channels at these inputs
};

/// `base`: forms that are always part of the model; `forms`: what may be added. `deep`: go on to triples where pairs
/// leave structure.
Selection select(const Problem& problem, const std::vector<const Parametrisation*>& base,
                 const std::vector<const Parametrisation*>& forms, const Rules& rules, bool deep,
                 const Told& told = {});

}  // namespace hosel::loop
