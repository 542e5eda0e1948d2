#include "golf/face_compliance.hpp"

#include <cmath>

#include "golf/plate_shape.hpp"

namespace hosel {

FaceCompliance::Shape FaceCompliance::shape(double yc, double zc) const {
  const Eigen::Matrix2d C = ellipse();
  const PlateShape<double> plate(C(0, 0), C(1, 1), C(0, 1), yc, zc);
  if (!(plate.height > 0)) return {};
  const Eigen::Vector2d slope = -2 * C * Eigen::Vector2d(yc, zc);
  Shape s;
  s.value = plate.value;
  s.slope = {plate.slope_y, plate.slope_z};
  s.second = 2 * slope * slope.transpose() - 4 * plate.height * C;
  return s;
}

Eigen::Matrix2d FaceCompliance::ellipse() const {
  const double y = 1 / (half_width * half_width), z = 1 / (half_height * half_height), c = std::cos(turn),
               s = std::sin(turn);
  Eigen::Matrix2d C;
  C << c * c * y + s * s * z, c * s * (y - z), c * s * (y - z), s * s * y + c * c * z;
  return C;
}

std::vector<std::string> FaceCompliance::faults() const {
  std::vector<std::string> said;
  if (!(mass > 0) || !std::isfinite(mass)) said.emplace_back("the face's effective mass must be positive and finite");
  if (!(stiffness > 0) || !std::isfinite(stiffness))
    said.emplace_back("the face's stiffness must be positive and finite; leave the face out for a rigid one");
  if (!(damping >= 0) || !std::isfinite(damping))
    said.emplace_back("the face's damping must be at least zero and finite");
  if (!(half_width > 0) || !(half_height > 0)) said.emplace_back("the face's half width and height must be positive");
  return said;
}

}  // namespace hosel
