#include "fem/modal_damping.hpp"

#include <stdexcept>
#include <utility>

namespace hosel::fem {

ModalDamping::ModalDamping(std::string body, const Node& first, std::vector<Node> nodes, Eigen::MatrixXd weights,
                           Vector rates)
    : body_(std::move(body)),
      first_(first),
      nodes_(std::move(nodes)),
      weights_(std::move(weights)),
      rates_(std::move(rates)) {
  if (weights_.rows() != 6 * static_cast<Index>(nodes_.size()) || weights_.cols() != rates_.size())
    throw std::invalid_argument("modal damping: six rows per node and a column per mode");
  if (!(rates_.array() >= 0).all()) throw std::invalid_argument("modal damping: a damping ratio is not negative");
}

Vector ModalDamping::speeds(const State& s) const {
  const Mat3 back = rotation(s, first_.rotation).toRotationMatrix().transpose();
  const Vec3 x0 = s.q.segment<3>(first_.translation.q), v0 = back * s.v.segment<3>(first_.translation.v),
             w0 = s.v.segment<3>(first_.rotation.v);
  Vector rate(weights_.rows());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const Vec3 arm = back * (s.q.segment<3>(n.translation.q) - x0);
    const auto at = static_cast<Index>(6 * i);
    rate.segment<3>(at) = back * s.v.segment<3>(n.translation.v) - v0 - w0.cross(arm);
    rate.segment<3>(at + 3) = back * (rotation(s, n.rotation) * Vec3(s.v.segment<3>(n.rotation.v))) - w0;
  }
  return weights_.transpose() * rate;
}

void ModalDamping::residual(const State& s, Vector&, Vector& force) const {
  const Vector pull = weights_ * rates_.cwiseProduct(speeds(s));
  const Mat3 R0 = rotation(s, first_.rotation).toRotationMatrix();
  const Vec3 x0 = s.q.segment<3>(first_.translation.q);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const auto at = static_cast<Index>(6 * i);
    const Vec3 f = R0 * pull.segment<3>(at), m = R0 * pull.segment<3>(at + 3),
               arm = s.q.segment<3>(n.translation.q) - x0;
    force.segment<3>(n.translation.v) += f;
    force.segment<3>(n.rotation.v) += rotation(s, n.rotation).conjugate() * m;
    force.segment<3>(first_.translation.v) -= f;
    force.segment<3>(first_.rotation.v) -= R0.transpose() * (arm.cross(f) + m);
  }
}

void ModalDamping::commit(const State& s) {
  const Vector eta = speeds(s);
  const double power = eta.dot(rates_.cwiseProduct(eta));
  if (started_) viscous_ += 0.5 * (power_ + power) * (s.time - time_);
  power_ = power;
  time_ = s.time;
  started_ = true;
}

void ModalDamping::save(std::vector<double>& h) const { put(h, viscous_, power_, time_, started_); }

void ModalDamping::restore(std::span<const double>& h) {
  take(h, "the checkpoint is of another system", viscous_, power_, time_, started_);
}

}  // namespace hosel::fem
