#include "fem/reduced_face.hpp"

#include <stdexcept>

namespace hosel::fem {

ReducedFace ReducedFace::lumped(const FaceCompliance& f) {
  if (const auto faults = f.faults(); !faults.empty()) throw std::invalid_argument(faults.front());
  const auto one = [](double x) { return Eigen::MatrixXd::Constant(1, 1, x); };
  return {Eigen::VectorXd::Constant(1, f.mass),
          Eigen::Matrix3Xd::Zero(3, 1),
          one(f.mass),
          one(f.mass),
          one(f.stiffness),
          one(f.damping),
          Eigen::VectorXd::Ones(1)};
}

}  // namespace hosel::fem
