#include "golf/contact_law.hpp"

namespace hosel {

std::vector<std::string> PatchFriction::faults() const {
  std::vector<std::string> out;
  if (!(coefficient >= 0) || !std::isfinite(coefficient)) out.emplace_back("friction must be at least zero and finite");
  if (at_rest && !(at_rest->coefficient >= coefficient))
    out.emplace_back("static friction must be at least that of sliding");
  if (at_rest && transition_speed)
    out.emplace_back("friction regularised by velocity knows no sticking, and so no static friction");
  return out;
}

}  // namespace hosel
