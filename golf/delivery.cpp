#include "golf/delivery.hpp"

#include <cmath>

namespace hosel {

Vec3 Delivery::velocity() const {
  return club_speed * Vec3(std::cos(attack_angle) * std::cos(club_path), -std::cos(attack_angle) * std::sin(club_path),
                           std::sin(attack_angle));
}

Mat3 Delivery::face_to_global() const {
  return (Eigen::AngleAxisd(-face_angle, Vec3::UnitZ()) * Eigen::AngleAxisd(-dynamic_loft, Vec3::UnitY()))
      .toRotationMatrix();
}

}  // namespace hosel
