#include "loop/problem.hpp"

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

}  // namespace hosel::loop
