/// Which effects explain the residual of the records: singles, pairs, triples, each at its own optimum.
#pragma once

#include "hosel/loop/history/problem.hpp"
#include "hosel/loop/select.hpp"

namespace hosel::loop {

struct HistorySearch {
  Fit base;
  std::vector<Candidate> singles, pairs, triples;  ///< by rising criterion, one per set of effects
  std::vector<std::string> silent;                 ///< effects that these channels do not show

  /// The model that was fitted best, whatever it takes.
  const Fit& richest() const;
};

/// `period` of the first mode [s]: an oscillation is fitted over a few periods first, then over ever more, since over
/// many a frequency that is off by one cycle is a minimum of its own.
HistorySearch search(const HistoryProblem& problem, const std::vector<const Form*>& base,
                     const std::vector<const Form*>& candidates, double period, const Rules& rules);

/// Adds triples that begin with the best pair.
void search_triples(const HistoryProblem& problem, const std::vector<const Form*>& candidates, const Rules& rules,
                    HistorySearch& s);

/// Place of an effect in the contract.
std::size_t history_order(const std::string& effect);

}  // namespace hosel::loop
