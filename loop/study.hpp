/// One pass of the loop up to the selection: rows to trials, split, noise, screening of rows, effects.
#pragma once

#include <memory>
#include <optional>
#include <set>

#include "hosel/loop/inputs.hpp"
#include "hosel/loop/run.hpp"
#include "hosel/loop/split.hpp"

namespace hosel::loop {

struct Study {
  /// `held_rows`: the holdout, where it is not split here. `doubted`: an input whose record counts for nothing.
  Study(const LoopCase& c, const std::vector<DerivedColumn>& derived, std::optional<std::set<int>> held_rows = {},
        std::optional<Input> doubted = {});

  LoopResult result;  ///< title, rows, forms, selection; the verdict is still to come

  const LoopCase& loop_case;
  std::optional<std::set<int>> held_rows;
  Inputs inputs;
  std::unique_ptr<Problem> problem;  ///< absent where no shot can be used
  std::vector<const Form*> base_forms, candidate_forms;
  std::vector<ColumnUse> uses;
  std::vector<int> usable;  ///< shots whose base answer exists
  Rows rows;
  std::vector<RowFlag> early;  ///< flagged before they could become shots
  std::vector<RowFlag> flags;
  std::string widespread;  ///< see Screening
  Loss loss;
  std::vector<Regressor> regressors;
  std::vector<std::string> contradicted;  ///< channels whose declared noise is not that of the data
  std::vector<double> declared_noise;     ///< per channel; zero where there is none

  /// Per channel: the noise is declared and not contradicted.
  std::vector<char> declared() const;

 private:
  void flag_early(int row, std::string column, std::string reason, int shot = -1);
  void prepare(std::optional<Input> doubted);
  void distrust(Input input);
  void split(const std::set<int>& without);
  void estimate_noise(const Fit* at);
  void set_covariance(const Fit* at);
  void select(bool deep);
  void work();
  void contradict(const Fit& at);
};

}  // namespace hosel::loop
