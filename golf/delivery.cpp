#include "golf/delivery.hpp"

#include <cmath>

namespace hosel {

Vec3 Delivery::velocity() const {
  return club_speed * Vec3(std::cos(attack_angle) * std::cos(club_path), -std::cos(attack_angle) * std::sin(club_path),
                           std::sin(attack_angle));
}

Mat3 Delivery::face_to_global() const {
  const double ca = std::cos(face_angle), sa = std::sin(face_angle);
  const double cl = std::cos(dynamic_loft), sl = std::sin(dynamic_loft);
  // About Y by minus the loft, then about Z by minus the face angle.
  return Mat3{{ca * cl, sa, -ca * sl}, {-sa * cl, ca, sa * sl}, {sl, 0, cl}};
}

}  // namespace hosel
