#include "fem/rotation_forms.hpp"

#include <array>
#include <cmath>

namespace hosel::fem {
namespace {

constexpr int kHighest = 7, kTerms = 12;

/// Coefficients (-1)^k / (2k + m)!.
template <int m>
constexpr std::array<double, kTerms> coefficients() {
  std::array<double, kTerms> c{};
  double factorial = 1;
  for (int i = 2; i <= m; ++i) factorial *= i;
  for (int k = 0; k < kTerms; ++k) {
    c[static_cast<std::size_t>(k)] = (k % 2 ? -1 : 1) / factorial;
    factorial *= (2 * k + m + 1) * (2 * k + m + 2);
  }
  return c;
}

/// S_m(z) = sum_k (-z)^k / (2k + m)!: S_1 = sin x / x, S_2 = (1 - cos x)/x^2, S_3 = (x - sin x)/x^3 with x^2 = z. The
/// two highest by their series, the others from S_m = 1/m! - z S_{m+2}.
std::array<double, kHighest + 1> series(double z) {
  static constexpr auto six = coefficients<kHighest - 1>(), seven = coefficients<kHighest>();
  std::array<double, kHighest + 1> s{};
  for (std::size_t k = z < 1e-3 ? 4 : kTerms; k-- > 0;) {
    s[6] = s[6] * z + six[k];
    s[7] = s[7] * z + seven[k];
  }
  s[5] = 1.0 / 120 - z * s[7];
  s[4] = 1.0 / 24 - z * s[6];
  s[3] = 1.0 / 6 - z * s[5];
  s[2] = 0.5 - z * s[4];
  s[1] = 1 - z * s[3];
  return s;
}

}  // namespace

Mat3 RotationForm::matrix(const Vec3& w) const {
  Mat3 m = g * w * w.transpose() - f * skew(w);
  m.diagonal().array() += 1 - g * w.squaredNorm();
  return m;
}

Mat3 RotationForm::derivative(const Vec3& w, const Vec3& q) const {
  const double wq = w.dot(q);
  Mat3 m = f * skew(q) + g * (w * q.transpose() - 2 * q * w.transpose()) +
           2 * (g1 * (wq * w - w.squaredNorm() * q) - f1 * w.cross(q)) * w.transpose();
  m.diagonal().array() += g * wq;
  return m;
}

Mat3 RotationForm::dual_derivative(const Vec3& w, const Vec3& p) const {
  RotationForm transposed = *this;
  transposed.f = -f;
  transposed.f1 = -f1;
  return transposed.derivative(w, p);
}

Mat3 RotationForm::hessian(const Vec3& w, const Vec3& p, const Vec3& q) const {
  // p.Vq = p.q + f s + g r with s = w.(p x q), r = (p.w)(q.w) - z p.q.
  const Vec3 ds = p.cross(q);
  const double s = w.dot(ds), pw = p.dot(w), qw = q.dot(w), pq = p.dot(q), r = pw * qw - w.squaredNorm() * pq;
  const Vec3 dr = qw * p + pw * q - 2 * pq * w;
  const Vec3 u = 2 * (f1 * ds + g1 * dr) + 2 * (f2 * s + g2 * r) * w;
  Mat3 m = w * u.transpose() + u * w.transpose() + g * (p * q.transpose() + q * p.transpose());
  m.diagonal().array() += 2 * (f1 * s + g1 * r - g * pq);
  return m;
}

ExponentialForms exponential_forms(double z) {
  const auto s = series(z);
  std::array<double, 6> d{};  // derivatives by z: 2 S_m' = m S_{m+2} - S_{m+1}, without loss where z is small
  for (std::size_t m = 1; m < d.size(); ++m) d[m] = 0.5 * (static_cast<double>(m) * s[m + 2] - s[m + 1]);
  const double second1 = 0.5 * (d[3] - d[2]), second2 = d[4] - 0.5 * d[3], second3 = 0.5 * (3 * d[5] - d[4]);
  return {.transposed = {s[1], d[1], second1, s[2], d[2], second2},
          .tangent = {s[2], d[2], second2, s[3], d[3], second3}};
}

RotationForm exp_tangent_inverse(double z) {
  RotationForm v;
  v.f = -0.5;
  if (z < 0.05) {  // Bernoulli series of (1 - x/2 cot(x/2)) / z
    v.g = 1.0 / 12 +
          z * (1.0 / 720 + z * (1.0 / 30240 + z * (1.0 / 1209600 + z * (1.0 / 47900160 + z * 691.0 / 1307674368000))));
    v.g1 = 1.0 / 720 + z * (2.0 / 30240 + z * (3.0 / 1209600 + z * (4.0 / 47900160 + z * 5 * 691.0 / 1307674368000)));
    return v;
  }
  const double x = std::sqrt(z), half = x / 2, cot = 1 / std::tan(half), sine = std::sin(half);
  const double y = half * cot, y1 = (0.5 * cot - 0.25 * x / (sine * sine)) / (2 * x);
  v.g = (1 - y) / z;
  v.g1 = (-y1 - v.g) / z;
  return v;
}

}  // namespace hosel::fem
