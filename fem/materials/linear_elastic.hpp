/// Linear elasticity of small strain in a corotated frame.
#pragma once

#include "fem/materials/elastic_law.hpp"
#include "fem/materials/lame.hpp"

namespace hosel::fem {

/// Stress lambda tr(e) + 2 mu e of the small strain e = sym(R^T F) - 1, where R is the body's mean rotation. Only for
/// comparison with small-strain theory.
struct LinearElastic : Lame {
  void evaluate(const Mat3& F, const Mat3& Q, bool tangent, PointResponse& out) const {
    const Mat3 H = Q.transpose() * F;
    const Mat3 e = 0.5 * (H + H.transpose()) - Mat3::Identity();
    const double trace = e.trace();
    out.energy = 0.5 * lambda * trace * trace + mu * e.squaredNorm();
    out.stress = lambda * trace * Q + 2 * mu * Q * e;
    if (!tangent) return;
    const Eigen::Map<const Eigen::Matrix<double, 9, 1>> q(Q.data());
    out.tangent.noalias() = lambda * q * q.transpose();
    for (int I = 0; I < 3; ++I)
      for (int i = 0; i < 3; ++i)
        for (int K = 0; K < 3; ++K)
          for (int k = 0; k < 3; ++k)
            out.tangent(i + 3 * I, k + 3 * K) += mu * ((i == k && I == K ? 1.0 : 0.0) + Q(i, K) * Q(k, I));
  }
};

}  // namespace hosel::fem
