/// Maps of rotation vectors that beam elements use, with their derivatives.
#pragma once

#include "golf/vector.hpp"

namespace hosel::fem {

/// V(w) q = q - f(z) w x q + g(z) (w (w.q) - z q), z = |w|^2: the shape shared by exp, its tangent and
/// the inverse of that, each with its own f and g.
struct RotationForm {
  double f = 0, f1 = 0, f2 = 0;  ///< f and its derivatives by z
  double g = 0, g1 = 0, g2 = 0;

  Vec3 times(const Vec3& w, const Vec3& q) const {  ///< V(w) q
    return q - f * w.cross(q) + g * (w.dot(q) * w - w.squaredNorm() * q);
  }
  Vec3 transposed_times(const Vec3& w, const Vec3& p) const {  ///< V(w)^T p
    return p + f * w.cross(p) + g * (w.dot(p) * w - w.squaredNorm() * p);
  }
  Vec3 change(const Vec3& w, const Vec3& q, const Vec3& dw) const {  ///< d(V q)/dw dw
    const double wq = w.dot(q), wd = w.dot(dw), z = w.squaredNorm();
    return f * q.cross(dw) + g * (q.dot(dw) * w + wq * dw - 2 * wd * q) +
           2 * wd * (g1 * (wq * w - z * q) - f1 * w.cross(q));
  }
  Vec3 gradient(const Vec3& w, const Vec3& q, const Vec3& p) const {  ///< d(p . V q)/dw
    const Vec3 across = p.cross(q);
    const double wq = w.dot(q), wp = w.dot(p), pq = p.dot(q), z = w.squaredNorm();
    return f * across + g * (wp * q + wq * p - 2 * pq * w) + 2 * (f1 * w.dot(across) + g1 * (wq * wp - z * pq)) * w;
  }
  Mat3 matrix(const Vec3& w) const;                                 ///< V(w)
  Mat3 derivative(const Vec3& w, const Vec3& q) const;              ///< d(V q)/dw
  Mat3 dual_derivative(const Vec3& w, const Vec3& p) const;         ///< d(V^T p)/dw
  Mat3 hessian(const Vec3& w, const Vec3& p, const Vec3& q) const;  ///< d2(p . V q)/dw2
};

struct ExponentialForms {
  RotationForm transposed;  ///< V = exp(w)^T
  RotationForm tangent;     ///< V = T(w), exp(w + dw) = exp(w) exp(T(w) dw)
};
/// Full precision up to |w| = pi.
ExponentialForms exponential_forms(double z);
RotationForm exp_tangent_inverse(double z);  ///< V = T(w)^-1; second derivatives are not given

}  // namespace hosel::fem
