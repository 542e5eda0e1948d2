#include "fem/contact_method/methods.hpp"

#include <algorithm>

#include "fem/contact_method/augmented_lagrangian.hpp"
#include "fem/contact_method/penalty.hpp"

namespace hosel::fem {

const std::vector<NamedContactMethod>& contact_methods() {
  using Made = std::unique_ptr<const ContactMethod>;
  static const std::vector<NamedContactMethod> all = {
      {"penalty", false, [](double stiffness, double) -> Made { return std::make_unique<Penalty>(stiffness); }},
      {"augmented-lagrangian", true, [](double stiffness, double penetration) -> Made {
         return std::make_unique<AugmentedLagrangian>(stiffness, penetration);
       }}};
  return all;
}

const NamedContactMethod* contact_method(const std::string& name) {
  const auto it = std::ranges::find(contact_methods(), name, &NamedContactMethod::name);
  return it == contact_methods().end() ? nullptr : &*it;
}

}  // namespace hosel::fem
