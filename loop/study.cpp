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
  if (even_ || jumps_) std::erase_if(forms, [](const Parametrisation* f) { return f->of_order; });
  selection = loop::select(problem, base, forms, rules, deep, told_);
  if (!std::isfinite(selection.base.deviance)) throw DataError("the model has no answer for these data");
  if (even_) return beside_drift();
  if (const Parametrisation* drift = likelier_at_every_shot()) {
    even_ = drift;
    select(deep);
  } else if (!jumps_ && jumps_rather()) {
    jumps_ = true;
    select(deep);
  }
}

double Study::likeliest(const Model& model) const {
  return criterion(fit(problem, Part::select, model, starts(model), problem.effort().starts), rules);
}

/// The chosen model, what drifts in it at other places in the session.
double Study::likeliest_placed(const std::function<double(double)>& place) const {
  const auto& chosen = selection.chosen.model.forms;
  std::vector<Parametrisation> placed;
  placed.reserve(chosen.size());
  Model model;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    model = model.with(k >= base.size() && chosen[k]->of_order
                           ? &placed.emplace_back(placed_otherwise(*chosen[k], place))
                           : chosen[k]);
  return likeliest(model);
}

const Parametrisation* Study::drift() const {
  const auto& chosen = selection.chosen.model.forms;
  const auto it = std::find_if(chosen.begin() + std::ptrdiff_t(base.size()), chosen.end(),
                               [](const Parametrisation* f) { return f->of_order; });
  return it == chosen.end() ? nullptr : *it;
}

/// A jump somewhere that is likelier by more than a tie, and than the choice of its place is worth, than the drift and
/// than one that settles early.
bool Study::jumps_rather() const {
  if (!drift()) return false;
  const double enough = rules.tie + 2 * std::log(kPartsOfSession - 1.0),
               drifting = std::min(criterion(selection.chosen, rules),
                                   likeliest_placed([](double order) { return 1 - std::exp(-5 * order); }));
  for (int k = 1; k < kPartsOfSession; ++k) {
    const double at = double(k) / kPartsOfSession;
    if (likeliest_placed([at](double order) { return order > at ? 1.0 : 0.0; }) + enough < drifting) return true;
  }
  return false;
}

/// What is told as a drift must drift: the one among the chosen that is no likelier than the same on every shot. One
/// that is not much likelier is none either, and is told so.
const Parametrisation* Study::likelier_at_every_shot() {
  const Parametrisation* drift = this->drift();
  if (!drift) return nullptr;
  const double beyond = likeliest_placed([](double) { return 1.0; }) - criterion(selection.chosen, rules);
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
