#include "loop/detectable.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "golf/parallel.hpp"

namespace hosel::loop {

std::vector<Detectable> minimum_detectable(const Problem& problem, const Fit& base,
                                           const std::vector<const Parametrisation*>& forms, const Rules& rules) {
  // Found nine times in ten: the threshold and 1.3 standard deviations more.
  const double wanted = std::sqrt(rules.gain) + 1.3;
  const Eigen::VectorXd z0 = whitened(problem, Part::select, base.model, base.p);
  const auto beside_base = [&](const Fit& f) { return orthonormal(problem.jacobian(Part::select, f.model, f.p)); };
  const Eigen::MatrixXd fitted = beside_base(base);
  // Nothing where the data do not show the form.
  const auto size_of = [&](const Parametrisation* f) -> std::optional<Detectable> {
    const Parameter& par = f->parameters.front();
    Fit probe = beside(base, f);
    Eigen::MatrixXd Q = fitted;
    if (f->of_order) {  // a drift is told by what is not the same on every shot
      const Parametrisation even = placed_otherwise(*f, [](double) { return 1.0; });
      Q = beside_base(beside(base, &even));
    }
    const auto signal = [&](double x) {
      probe.p[base.size()] = x;
      Eigen::VectorXd d = whitened(problem, Part::select, probe.model, probe.p);
      if (!d.size()) return kNaN;
      d -= z0;
      if (Q.cols()) d -= Q * (Q.transpose() * d);
      return d.norm();
    };
    double end = par.max >= -par.min ? par.max : par.min, most = signal(end);
    for (int k = 0; k < 20 && std::isnan(most); ++k) most = signal(end *= 0.5);  // not all that is plausible can happen
    if (!(most > kNothing)) return {};
    Detectable out{f->effect, par.name, par.unit, kNaN};
    if (most < wanted) return out;
    std::uintmax_t evaluations = 60;
    const auto [low, high] =
        boost::math::tools::toms748_solve([&](double share) { return signal(share * end) - wanted; }, 0.0, 1.0, -wanted,
                                          most - wanted, boost::math::tools::eps_tolerance<double>(20), evaluations);
    out.value = std::abs(0.5 * (low + high) * end) / par.si;
    return out;
  };
  std::vector<std::vector<const Parametrisation*>> of_effect;
  for (const Parametrisation* f : forms) {
    const auto same = std::ranges::find(of_effect, f->effect, [](const auto& list) { return list.front()->effect; });
    if (same == of_effect.end()) of_effect.push_back({f});
    else same->push_back(f);
  }
  std::vector<std::optional<Detectable>> found(of_effect.size());
  for_all(std::size_t(0), of_effect.size(), [&](std::size_t k) {
    for (const Parametrisation* f : of_effect[k])
      if (!found[k]) found[k] = size_of(f);
  });
  std::vector<Detectable> all;
  for (auto& d : found)
    if (d) all.push_back(*std::move(d));
  return all;
}

}  // namespace hosel::loop
