/// The loop on records up to the selection: noise with its colour, spikes, effects.
#pragma once

#include "hosel/loop/history/histories.hpp"
#include "hosel/loop/history/noise.hpp"
#include "hosel/loop/history/search.hpp"

namespace hosel::loop {

struct HistoryStudy {
  explicit HistoryStudy(const HistoryCase& c);

  LoopResult result;  ///< forms, flags, selection; the verdict is still to come

  const HistoryCase& history_case;
  std::vector<double> declared_noise;
  std::vector<HistoryForm> history_forms;
  std::map<const Form*, const HistoryForm*> forms;
  std::vector<const Form*> base, candidates;
  std::unique_ptr<HistoryProblem> problem;
  std::vector<HistoryFinding> before, after;  ///< structure of the base's residual, and of the chosen model's
  std::vector<std::string> contradicted;      ///< channels whose declared noise is not that of the data
  bool too_few = false;                       ///< readings to test anything

  static constexpr double kRemaining = 1e-4;  ///< level of the test for what is left, adjusted for the number of tests

 private:
  HistorySearch found;

  double period() const;
  std::vector<HistoryFinding> test(const Fit& f) const;
  double estimate_noise(const Fit& at);
  bool drop_spikes(const Fit& at);
  void work();
  void contradict(const Fit& at);
  void select();
};

}  // namespace hosel::loop
