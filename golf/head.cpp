#include "golf/head.hpp"

#include <Eigen/Eigenvalues>

namespace hosel {

std::vector<std::string> Head::faults() const {
  std::vector<std::string> said;
  if (!(mass > 0)) said.push_back("mass must be positive");
  if (!inertia.allFinite()) {
    said.push_back("inertia must be finite");
    return said;
  }
  if ((inertia - inertia.transpose()).cwiseAbs().maxCoeff() > 1e-9 * inertia.cwiseAbs().maxCoeff())
    said.push_back("inertia must be symmetric");
  const Vec3 principal = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvalues();
  if (!(principal[0] > 0)) said.push_back("principal moments of inertia must be positive");
  // A lamina reaches equality; the margin is round-off of the input's decimals.
  else if (principal[2] > (principal[0] + principal[1]) * (1 + 1e-9))
    said.push_back("the largest principal moment of inertia exceeds the sum of the others");
  if (!(face.bulge > 0) || !(face.roll > 0)) said.push_back("bulge and roll radii must be positive");
  if (compliance)
    for (const auto& fault : compliance->faults()) said.push_back(fault);
  return said;
}

}  // namespace hosel
