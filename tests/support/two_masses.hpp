/// Ball on a linear spring against a lumped face and a free head, in closed form.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "golf/face_compliance.hpp"

namespace hosel::test {

struct TwoMasses {
  double restitution = 0, contact_time = 0, face_energy = 0;
};

/// z = (compression, travel) obeys z'' = -A z, z(0) = 0, z'(0) = (speed, 0), until the compression is zero again.
inline TwoMasses two_masses(double ball_mass, double spring, double head_mass, const FaceCompliance& face,
                            double speed) {
  const double m = face.mass, own = m * (1 - m / head_mass);
  Eigen::Matrix2d A;
  A << spring * ((1 - m / head_mass) / m + 1 / head_mass + 1 / ball_mass), -face.stiffness / m, -spring / m,
      face.stiffness / own;
  const Eigen::EigenSolver<Eigen::Matrix2d> modes(A);
  const Eigen::Array2d w = modes.eigenvalues().real().array().sqrt();
  const Eigen::Matrix2d shapes = modes.eigenvectors().real();
  const Eigen::Array2d c = shapes.inverse().col(0).array() * speed / w;  // of sin(w t)
  const Eigen::Array2d compression = shapes.row(0).transpose().array() * c,
                       travel = shapes.row(1).transpose().array() * c;
  const auto compressed = [&](double t) { return (compression * (w * t).sin()).sum() > 0; };
  double high = 1e-5;
  while (compressed(high)) high += 1e-6;
  double low = high - 1e-6;
  for (int i = 0; i < 60; ++i) (compressed(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  const double t = low, ball = spring / ball_mass * (compression * (1 - (w * t).cos()) / w).sum();
  const double at = (travel * (w * t).sin()).sum(), rate = (travel * w * (w * t).cos()).sum();
  return {(ball - (speed - ball_mass / head_mass * ball)) / speed, t,
          0.5 * own * rate * rate + 0.5 * face.stiffness * at * at};
}

}  // namespace hosel::test
