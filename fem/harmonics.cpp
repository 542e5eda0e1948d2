#include "fem/harmonics.hpp"

#include <cmath>

#include "golf/units.hpp"

namespace hosel::fem {

Vec3 AngularFunction::at(double theta) const {
  return std::cos(order * theta) * cosine + std::sin(order * theta) * sine;
}

Vec3 AngularFunction::derivative(double theta) const {
  return order * (-std::sin(order * theta) * cosine + std::cos(order * theta) * sine);
}

FourierBasis axisymmetric_basis() { return {{0, Vec3::UnitX(), Vec3::Zero()}, {1, Vec3::UnitY(), Vec3::UnitZ()}}; }

FourierBasis cartesian_basis(int symmetric, int antisymmetric) {
  FourierBasis f;
  const Vec3 none = Vec3::Zero();
  for (int m = 0; m <= symmetric; ++m) {
    f.push_back({m, Vec3::UnitX(), none});
    f.push_back({m, Vec3::UnitY(), none});
    if (m > 0) f.push_back({m, none, Vec3::UnitZ()});
  }
  for (int m = 0; m <= antisymmetric; ++m) {
    f.push_back({m, Vec3::UnitZ(), none});
    if (m > 0) f.push_back({m, none, Vec3::UnitX()});
    if (m > 0) f.push_back({m, none, Vec3::UnitY()});
  }
  return f;
}

FourierBasis cylindrical_basis(int m) {
  // u_r e_r + u_theta e_theta = (U - V)/2 [harmonic m - 1] + (U + V)/2 [harmonic m + 1].
  FourierBasis f{{m, Vec3::UnitX(), Vec3::Zero()}};
  if (m > 0) f.push_back({m - 1, Vec3::UnitY(), -Vec3::UnitZ()});
  f.push_back({m + 1, Vec3::UnitY(), Vec3::UnitZ()});
  return f;
}

FourierBasis torsion_basis() { return {{1, Vec3::UnitZ(), -Vec3::UnitY()}}; }

AngularRule single_angle() { return {{0.0}, 2 * kPi}; }

AngularRule full_circle(int count) {
  AngularRule rule{{}, 2 * kPi / count};
  for (int i = 0; i < count; ++i) rule.theta.push_back(2 * kPi * i / count);
  return rule;
}

AngularRule half_circle(int count) {
  AngularRule rule{{}, 2 * kPi / count};
  for (int i = 0; i < count; ++i) rule.theta.push_back(kPi * (i + 0.5) / count);
  return rule;
}

double cardinal(double theta, int count) {
  const double x = 0.5 * std::remainder(theta, 2 * kPi), m = double(count);
  if (std::abs(x) < 1e-9) return 1;
  return std::sin(m * x) / (m * (count % 2 ? std::sin(x) : std::tan(x)));
}

}  // namespace hosel::fem
