#include "loop/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  std::vector<const Parametrisation*> forms = candidates;
  if (even_) std::erase_if(forms, [](const Parametrisation* f) { return f->of_order; });
  selection = loop::select(problem, base, forms, rules, deep, told_);
  if (!std::isfinite(selection.base.deviance)) throw DataError("the model has no answer for these data");
  if (even_) return beside_drift();
  if (const Parametrisation* drift = likelier_at_every_shot()) {
    even_ = drift;
    select(deep);
  }
}

double Study::likeliest(const Model& model) const {
  return criterion(fit(problem, Part::select, model, starts(model), problem.effort().starts), rules);
}

/// What is told as a drift must drift: the one among the chosen that is no likelier than the same on every shot. One
/// that is not much likelier is none either, and is told so.
const Parametrisation* Study::likelier_at_every_shot() {
  const auto& chosen = selection.chosen.model.forms;
  std::vector<Parametrisation> same(chosen.size());
  Model model;
  const Parametrisation* drift = nullptr;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const bool drifts = k >= base.size() && chosen[k]->of_order;
    if (drifts) same[k] = at_every_shot(*(drift = chosen[k]));
    model = model.with(drifts ? &same[k] : chosen[k]);
  }
  if (!drift) return nullptr;
  const double beyond = likeliest(model) - criterion(selection.chosen, rules);
  if (beyond < 0) return drift;
  if (beyond < rules.tie)
    selection.at_every_shot =
        fmt::format("{} ({}) says no more than the same on every shot", drift->effect, drift->what);
  return nullptr;
}

/// What settles early is nearer to the same on every shot than to a drift: where the drift is as likely as what was
/// chosen without it, it ties with one name, and leaves several in doubt.
void Study::beside_drift() {
  if (selection.level == 0 || !selection.clean) return;
  if (likeliest(selection.base.model.with(even_)) > criterion(selection.chosen, rules) + rules.tie) return;
  if (selection.level > 1) {
    selection.at_every_shot = fmt::format("{} say no more than {} ({}), and that no more than the same on every shot",
                                          fmt::join(selection.chosen.model.effects(base.size()), " and "),
                                          even_->effect, even_->what);
    return;
  }
  std::vector<std::string> tie = selection.adopted;
  for (const auto& names : selection.ties) tie.insert(tie.end(), names.begin(), names.end());
  tie.push_back(even_->effect);
  selection.adopted.clear();
  selection.ties = {std::move(tie)};
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
    const Channel& ch = problem.channel(c);
    if (!ch.declared || ch.repeated) continue;  // no model is in the scatter of repeats
    auto [ratio, error] = problem.scatter(c, r, at.size());
    if (ch.refuted) ratio *= ch.noise / *ch.declared;
    problem.refute(c, std::abs(std::log(ratio)) > rules.scatter_error * error &&
                          (ratio > rules.scatter_ratio || ratio < 1 / rules.scatter_ratio));
  }
}

}  // namespace hosel::loop
