#include "models/rigid/restitution.hpp"

#include <sstream>
#include <stdexcept>

namespace hosel::models {

double normal_restitution(const ContactLaw& law, double approach_speed, double distance_from_centre) {
  const double e = law.normal_restitution(approach_speed, distance_from_centre);
  if (e >= 0 && e <= 1) return e;
  std::ostringstream text;
  text << "the coefficient of restitution comes to " << e << " at an approach of " << approach_speed << " m/s, "
       << 1e3 * distance_from_centre
       << " mm from the face centre (allowed: 0 to 1): look at restitution, its slope and its falloff";
  throw std::invalid_argument(text.str());
}

}  // namespace hosel::models
