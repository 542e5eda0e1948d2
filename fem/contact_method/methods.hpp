/// The contact methods by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/contact_method/method.hpp"

namespace hosel::fem {

struct NamedContactMethod {
  std::string name;
  bool reaches_penetration = false;  ///< whether it is told which penetration to reach
  /// `stiffness` per reference area [N/m^3], `penetration` [m].
  std::unique_ptr<const ContactMethod> (*make)(double stiffness, double penetration) = nullptr;
};
const std::vector<NamedContactMethod>& contact_methods();
/// Null where there is none of this name.
const NamedContactMethod* contact_method(const std::string& name);

}  // namespace hosel::fem
