#include "hosel/loop/alike.hpp"

#include <set>

namespace hosel::loop {

Likeness alike(const Problem& problem, const std::vector<int>& rows, const Fit& at,
               const std::vector<const Form*>& forms) {
  std::vector<EffectColumn> columns;
  std::set<std::string> seen;
  for (const Form* f : at.model.forms) seen.insert(f->effect);
  const Eigen::VectorXd z = whitened(problem, rows, at.model, at.p);
  for (const Form* f : forms) {
    if (f->parameters.size() != 1 || !seen.insert(f->effect).second) continue;
    Model more = at.model;
    more.forms.push_back(f);
    Eigen::VectorXd p(more.size());
    p << at.p, 0.0;
    EffectColumn c{f->effect, f->parameters.front().name, {}};
    if (f->starts.empty()) {
      c.whitened = whitened_jacobian(problem, rows, more, p).rightCols(1);
    } else {
      p[p.size() - 1] = f->starts.front().front();
      c.whitened = (whitened(problem, rows, more, p) - z) / (p[p.size() - 1] / f->parameters.front().scale);
    }
    columns.push_back(std::move(c));
  }
  return likeness(columns,
                  at.size() > 0 ? whitened_jacobian(problem, rows, at.model, at.p) : Eigen::MatrixXd(z.size(), 0));
}

}  // namespace hosel::loop
