#include "fem/state.hpp"

#include <cmath>

namespace hosel::fem {

DofMap::Block DofMap::add_vector(Index size) {
  blocks_.push_back({q_size_, v_size_, size, false});
  q_size_ += size;
  v_size_ += size;
  return blocks_.back();
}

DofMap::Block DofMap::add_rotation() {
  blocks_.push_back({q_size_, v_size_, 3, true});
  q_size_ += 4;
  v_size_ += 3;
  return blocks_.back();
}

State DofMap::rest() const {
  State s{0, Vector::Zero(q_size_), Vector::Zero(v_size_), Vector::Zero(v_size_)};
  for (const Block& b : blocks_)
    if (b.rotation) s.q[b.q + 3] = 1;
  return s;
}

Vector DofMap::advanced(const Vector& q, const Vector& dq) const {
  Vector out(q_size_);
  for (const Block& b : blocks_) {
    if (!b.rotation) {
      out.segment(b.q, b.size) = q.segment(b.q, b.size) + dq.segment(b.v, b.size);
      continue;
    }
    const Eigen::Quaterniond r(Eigen::Vector4d(q.segment<4>(b.q)));
    out.segment<4>(b.q) = (r * rotation_exp(dq.segment<3>(b.v))).normalized().coeffs();
  }
  return out;
}

Eigen::Quaterniond rotation(const State& s, const DofMap::Block& block) {
  return Eigen::Quaterniond(Eigen::Vector4d(s.q.segment<4>(block.q)));
}

void set_rotation(State& s, const DofMap::Block& block, const Eigen::Quaterniond& r) {
  s.q.segment<4>(block.q) = r.normalized().coeffs();
}

Eigen::Quaterniond rotation_exp(const Vec3& w) {
  const double z = w.squaredNorm() / 4;
  double half_sinc, c;
  if (z < 2.5e-3) {  // a time step's turn: series of sine and cosine
    half_sinc = 0.5 - z * (1.0 / 12 - z * (1.0 / 240 - z * (1.0 / 10080 - z / 725760)));
    c = 1 - z * (1.0 / 2 - z * (1.0 / 24 - z * (1.0 / 720 - z * (1.0 / 40320 - z / 3628800))));
  } else {
    const double half = std::sqrt(z);
    half_sinc = 0.5 * std::sin(half) / half;
    c = std::cos(half);
  }
  return {c, half_sinc * w.x(), half_sinc * w.y(), half_sinc * w.z()};
}

Vec3 rotation_log(const Eigen::Quaterniond& r) {
  const double sign = r.w() < 0 ? -1 : 1;
  const Vec3 u = sign * r.vec();
  const double z = u.squaredNorm(), c = sign * r.w();
  if (z < 1e-3)  // neighbours in a mesh: 2 arcsin(s) / s by its series
    return (2 + z * (1.0 / 3 + z * (3.0 / 20 + z * (5.0 / 56 + z * (35.0 / 576 + z * 63.0 / 1408))))) * u;
  const double s = std::sqrt(z);
  return 2 * std::atan2(s, c) / s * u;
}

Mat3 rotation_tangent(const Vec3& w) {
  const double x2 = w.squaredNorm(), x = std::sqrt(x2);
  const double a = x < 1e-3 ? 0.5 - x2 / 24 : (1 - std::cos(x)) / x2;
  const double b = x < 1e-3 ? 1.0 / 6 - x2 / 120 : (x - std::sin(x)) / (x2 * x);
  const Mat3 W = skew(w);
  return Mat3::Identity() - a * W + b * W * W;
}

}  // namespace hosel::fem
