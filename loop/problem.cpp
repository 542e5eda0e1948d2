#include "loop/problem.hpp"

#include "loop/result.hpp"

namespace hosel::loop {

int Model::size() const {
  int n = 0;
  for (const Parametrisation* f : forms) n += int(f->parameters.size());
  return n;
}

std::vector<const Parameter*> Model::parameters() const {
  std::vector<const Parameter*> all;
  for (const Parametrisation* f : forms)
    for (const Parameter& p : f->parameters) all.push_back(&p);
  return all;
}

Model Model::with(const Parametrisation* more) const {
  Model m = *this;
  m.forms.push_back(more);
  return m;
}

std::vector<std::string> Model::effects(std::size_t first) const {
  std::vector<std::string> names;
  for (std::size_t k = first; k < forms.size(); ++k) names.push_back(forms[k]->effect);
  return names;
}

std::vector<Location> Problem::shapes(const Selection&) const { return {}; }
std::vector<Location> Problem::doubts(const Selection&) const { return {}; }

}  // namespace hosel::loop
