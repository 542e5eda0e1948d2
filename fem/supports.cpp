#include "fem/supports.hpp"

#include <stdexcept>
#include <utility>

namespace hosel::fem {

Motion at_rest(const Vec3& position, const Eigen::Quaterniond& rotation) {
  return [pose = Pose{.position = position, .rotation = rotation}](double) { return pose; };
}

ImposedMotion::ImposedMotion(const Node& node, Motion motion)
    : node_(node), motion_(std::move(motion)), equations_(fem::equations(node)) {}

void ImposedMotion::impose(State& s) const {
  const Pose p = motion_(s.time);
  s.q.segment<3>(node_.translation.q) = p.position;
  set_rotation(s, node_.rotation, p.rotation);
  s.v.segment<3>(node_.translation.v) = p.velocity;
  s.v.segment<3>(node_.rotation.v) = p.angular_velocity;
  s.a.segment<3>(node_.translation.v) = p.acceleration;
  s.a.segment<3>(node_.rotation.v) = p.angular_acceleration;
}

NodeLoad::NodeLoad(std::string body, const Node& node, std::function<Wrench(double)> wrench, Moment moment)
    : body_(std::move(body)), node_(node), wrench_(std::move(wrench)), kind_(moment), equations_(fem::equations(node)) {}

void NodeLoad::pattern(std::vector<std::vector<Index>>& blocks) const { blocks.push_back(equations_); }

Vec3 NodeLoad::body_moment(const State& s, const Wrench& w) const {
  return kind_ == Moment::body ? w.moment : Vec3(rotation(s, node_.rotation).conjugate() * w.moment);
}

void NodeLoad::residual(const State& s, Vector&, Vector& force) const {
  const Wrench w = wrench_(s.time);
  force.segment<3>(node_.translation.v) -= w.force;
  force.segment<3>(node_.rotation.v) -= body_moment(s, w);
}

void NodeLoad::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero();
  if (kind_ == Moment::global) K.bottomRightCorner<3, 3>() = -weights.stiffness * skew(body_moment(s, wrench_(s.time)));
  sink.add(equations_, equations_, K);
}

Energies NodeLoad::energies(const State&) const { return {.external = work_}; }

void NodeLoad::accept(const State& s) {
  const Wrench w = wrench_(s.time);
  const Vec3 x = s.q.segment<3>(node_.translation.q), m = body_moment(s, w);
  const Eigen::Quaterniond r = rotation(s, node_.rotation);
  if (started_)
    work_ += 0.5 * (force_ + w.force).dot(x - position_) +
             0.5 * (moment_ + m).dot(rotation_log(rotation_.conjugate() * r));
  position_ = x;
  rotation_ = r;
  force_ = w.force;
  moment_ = m;
  started_ = true;
}

void NodeLoad::save(std::vector<double>& h) const {
  h.push_back(started_ ? 1 : 0);
  h.push_back(work_);
  for (const Vec3& v : {position_, force_, moment_}) h.insert(h.end(), v.begin(), v.end());
  h.insert(h.end(), rotation_.coeffs().begin(), rotation_.coeffs().end());
}

void NodeLoad::restore(std::span<const double>& h) {
  if (h.size() < 15) throw std::invalid_argument("the checkpoint is of another system");
  started_ = h[0] != 0;
  work_ = h[1];
  position_ = {h[2], h[3], h[4]};
  force_ = {h[5], h[6], h[7]};
  moment_ = {h[8], h[9], h[10]};
  rotation_.coeffs() = Eigen::Vector4d(h[11], h[12], h[13], h[14]);
  h = h.subspan(15);
}

}  // namespace hosel::fem
