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
  const double angle2 = w.squaredNorm(), angle = std::sqrt(angle2);
  const double half_sinc = angle < 1e-4 ? 0.5 - angle2 / 48 : std::sin(angle / 2) / angle;
  const double c = angle < 1e-4 ? 1 - angle2 / 8 + angle2 * angle2 / 384 : std::cos(angle / 2);
  return {c, half_sinc * w.x(), half_sinc * w.y(), half_sinc * w.z()};
}

Vec3 rotation_log(const Eigen::Quaterniond& r) {
  const double sign = r.w() < 0 ? -1 : 1;
  const Vec3 u = sign * r.vec();
  const double s = u.norm(), c = sign * r.w();
  return (s < 1e-8 ? 2 / c : 2 * std::atan2(s, c) / s) * u;
}

Mat3 rotation_tangent(const Vec3& w) {
  const double x2 = w.squaredNorm(), x = std::sqrt(x2);
  const double a = x < 1e-3 ? 0.5 - x2 / 24 : (1 - std::cos(x)) / x2;
  const double b = x < 1e-3 ? 1.0 / 6 - x2 / 120 : (x - std::sin(x)) / (x2 * x);
  const Mat3 W = skew(w);
  return Mat3::Identity() - a * W + b * W * W;
}

}  // namespace hosel::fem
