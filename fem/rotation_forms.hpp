/// Maps of rotation vectors that beams are made of, with their derivatives.
#pragma once

#include "hosel/golf/vector.hpp"

namespace hosel::fem {

/// V(w) q = q - f(z) w x q + g(z) (w (w.q) - z q), z = |w|^2: the shape shared by exp, its tangent and
/// the inverse of that, each with its own f and g.
struct RotationForm {
  double f = 0, f1 = 0, f2 = 0;  ///< f and its derivatives by z
  double g = 0, g1 = 0, g2 = 0;

  Mat3 matrix(const Vec3& w) const;                                 ///< V(w)
  Mat3 derivative(const Vec3& w, const Vec3& q) const;              ///< d(V q)/dw
  Mat3 dual_derivative(const Vec3& w, const Vec3& p) const;         ///< d(V^T p)/dw
  Mat3 hessian(const Vec3& w, const Vec3& p, const Vec3& q) const;  ///< d2(p . V q)/dw2
};

RotationForm exp_transposed(double z);       ///< V = exp(w)^T
RotationForm exp_tangent(double z);          ///< V = T(w), exp(w + dw) = exp(w) exp(T(w) dw)
RotationForm exp_tangent_inverse(double z);  ///< V = T(w)^-1; second derivatives are not given

}  // namespace hosel::fem
