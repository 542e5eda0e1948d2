#include "loop/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "golf/data_error.hpp"

namespace hosel::loop {

Study::Study(Problem& data, const std::vector<Parametrisation>& forms, const std::vector<std::string>& declared,
             const Rules& figures, Told progress)
    : problem(data), rules(figures), told_(std::move(progress)) {
  for (const std::string& name : declared) {
    const auto first = std::ranges::find(forms, name, &Parametrisation::effect);
    if (first == forms.end()) throw DataError(fmt::format("effect '{}' cannot act here", name));
    base.push_back(&*first);
  }
  for (const Parametrisation& f : forms)
    if (!std::ranges::count(declared, f.effect)) candidates.push_back(&f);
  settle();
}

void Study::select(bool deep) {
  selection = loop::select(problem, base, candidates, rules, deep, told_);
  if (!std::isfinite(selection.base.deviance)) throw DataError("the model has no answer for these data");
}

void Study::settle() {
  constexpr int most = 4;  // passes
  for (int pass = 0; pass < most && !problem.too_few(); ++pass) {
    select(pass > 0);
    const bool same_rows = problem.screen(selection);
    if (problem.too_few()) return;
    refute_noise();
    const bool same_noise = problem.update_noise(selection.chosen, selection.richest) < rules.noise_change;
    if (same_rows && same_noise) {
      if (pass == 0 && !selection.clean && selection.level == 2) select(true);
      return;
    }
    if (pass == most - 1) select(true);
  }
}

/// Declared noise that the scatter about a clean fit contradicts.
void Study::refute_noise() {
  if (!selection.clean) return;
  const Fit& at = selection.chosen;
  const Eigen::MatrixXd r = problem.residuals(at.model, at.p);
  for (int c = 0; c < problem.width(); ++c) {
    if (!problem.channel(c).trusted() || problem.channel(c).repeated)
      continue;  // no model is in the scatter of repeats
    const auto [ratio, error] = problem.scatter(c, r, at.size());
    if (std::abs(std::log(ratio)) > rules.scatter_error * error &&
        (ratio > rules.scatter_ratio || ratio < 1 / rules.scatter_ratio))
      problem.refute(c);
  }
}

}  // namespace hosel::loop
