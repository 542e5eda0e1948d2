#include "fem/supports.hpp"

#include <utility>

#include "fem/rotation_forms.hpp"

namespace hosel::fem {
namespace {

constexpr char kOther[] = "the checkpoint is of another system";

}  // namespace

Motion at_rest(const Vec3& position, const Eigen::Quaterniond& rotation) {
  return [pose = Pose{.position = position, .rotation = rotation}](double) { return pose; };
}

ImposedMotion::ImposedMotion(const Node& node, Motion motion)
    : node_(node), motion_(std::move(motion)), dofs_(fem::dofs(node)) {}

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
    : body_(std::move(body)), node_(node), wrench_(std::move(wrench)), kind_(moment), dofs_(fem::dofs(node)) {}

void NodeLoad::pattern(std::vector<std::vector<Index>>& blocks) const { blocks.push_back(dofs_); }

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
  sink.add(dofs_, dofs_, K);
}

Energies NodeLoad::energies(const State&) const { return {.external = work_}; }

void NodeLoad::commit(const State& s) {
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
  put(h, started_, work_, position_, force_, moment_, rotation_.coeffs());
}

void NodeLoad::restore(std::span<const double>& h) {
  take(h, kOther, started_, work_, position_, force_, moment_, rotation_.coeffs());
}

/// d, r, their rates, and their derivative by the increments of both nodes (translations global,
/// rotations body frame).
struct SpringJoint::Strain {
  Vec3 d, r, d_rate, r_rate;
  Mat3 R1;
  RotationForm log;
  Mat3 Tinv, relative;
  Eigen::Matrix<double, 6, 12> B;
};

SpringJoint::SpringJoint(std::string body, const Node& first, const Node& second, const JointStiffness& k)
    : body_(std::move(body)), first_(first), second_(second) {
  dofs_ = fem::dofs(first);
  for (Index e : fem::dofs(second)) dofs_.push_back(e);
  const auto in_reference = [&](const Vec3& v) { return Mat3(k.frame * v.asDiagonal() * k.frame.transpose()); };
  Kt_ = in_reference(k.translation);
  Kr_ = in_reference(k.rotation);
  Ct_ = in_reference(k.translation_damping);
  Cr_ = in_reference(k.rotation_damping);
}

SpringJoint::SpringJoint(std::string body, Motion first, const Node& second, const JointStiffness& k)
    : SpringJoint(std::move(body), second, second, k) {
  first_.reset();
  motion_ = std::move(first);
  dofs_ = fem::dofs(second);
}

Pose SpringJoint::first(const State& s) const {
  if (!first_) return motion_(s.time);
  return {.position = s.q.segment<3>(first_->translation.q),
          .rotation = rotation(s, first_->rotation),
          .velocity = s.v.segment<3>(first_->translation.v),
          .angular_velocity = s.v.segment<3>(first_->rotation.v)};
}

SpringJoint::Strain SpringJoint::strain(const State& s) const {
  const Pose a = first(s);
  Strain e;
  e.R1 = a.rotation.toRotationMatrix();
  e.d = e.R1.transpose() * (s.q.segment<3>(second_.translation.q) - a.position);
  const Eigen::Quaterniond relative = a.rotation.conjugate() * rotation(s, second_.rotation);
  e.r = rotation_log(relative);
  e.relative = relative.toRotationMatrix();
  e.log = exp_tangent_inverse(e.r.squaredNorm());
  e.Tinv = e.log.matrix(e.r);
  e.B.setZero();
  e.B.block<3, 3>(0, 0) = -e.R1.transpose();
  e.B.block<3, 3>(0, 3) = skew(e.d);
  e.B.block<3, 3>(0, 6) = e.R1.transpose();
  e.B.block<3, 3>(3, 3) = -e.Tinv * e.relative.transpose();
  e.B.block<3, 3>(3, 9) = e.Tinv;
  Eigen::Matrix<double, 12, 1> v;
  v << a.velocity, a.angular_velocity, s.v.segment<3>(second_.translation.v), s.v.segment<3>(second_.rotation.v);
  e.d_rate = e.B.topRows<3>() * v;
  e.r_rate = e.B.bottomRows<3>() * v;
  return e;
}

void SpringJoint::pattern(std::vector<std::vector<Index>>& blocks) const { blocks.push_back(dofs_); }

void SpringJoint::residual(const State& s, Vector&, Vector& force) const {
  const Strain e = strain(s);
  Eigen::Matrix<double, 6, 1> stress;
  stress << Kt_ * e.d + Ct_ * e.d_rate, Kr_ * e.r + Cr_ * e.r_rate;
  const Eigen::Matrix<double, 12, 1> f = e.B.transpose() * stress;
  const Index skip = 12 - static_cast<Index>(dofs_.size());
  for (std::size_t i = 0; i < dofs_.size(); ++i) force[dofs_[i]] += f[skip + static_cast<Index>(i)];
}

void SpringJoint::tangent(const State& s, const Weights& w, TangentSink& sink) const {
  const Strain e = strain(s);
  const Vec3 n = Kt_ * e.d + Ct_ * e.d_rate, m = Kr_ * e.r + Cr_ * e.r_rate;
  // The change of strain rates with the configuration is left out: it vanishes with the strains.
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>() = w.stiffness * Kt_ + w.damping * Ct_;
  C.bottomRightCorner<3, 3>() = w.stiffness * Kr_ + w.damping * Cr_;
  Eigen::Matrix<double, 12, 12> K = e.B.transpose() * C * e.B;
  if (w.stiffness != 0) {
    const Mat3 f = w.stiffness * e.R1 * skew(n);
    K.block<3, 3>(6, 3) -= f;
    K.block<3, 3>(0, 3) += f;
    K.middleRows<3>(3) += w.stiffness * skew(n) * e.B.topRows<3>();
    const Vec3 moment = e.Tinv.transpose() * m;
    const Eigen::Matrix<double, 3, 12> change = w.stiffness * e.log.dual_derivative(e.r, m) * e.B.bottomRows<3>();
    K.middleRows<3>(9) += change;
    K.middleRows<3>(3) -= e.relative * change;
    const Mat3 turned = w.stiffness * e.relative * skew(moment);
    K.block<3, 3>(3, 9) += turned;
    K.block<3, 3>(3, 3) -= turned * e.relative.transpose();
  }
  const auto n_eq = static_cast<Index>(dofs_.size());
  sink.add(dofs_, dofs_, K.bottomRightCorner(n_eq, n_eq));
}

Energies SpringJoint::energies(const State& s) const {
  const Strain e = strain(s);
  return {.strain = 0.5 * (e.d.dot(Kt_ * e.d) + e.r.dot(Kr_ * e.r)), .viscous = viscous_, .external = work_};
}

void SpringJoint::commit(const State& s) {
  const Strain e = strain(s);
  const double power = e.d_rate.dot(Ct_ * e.d_rate) + e.r_rate.dot(Cr_ * e.r_rate);
  double drive = 0;
  if (!first_) {  // the hands' power on the system: what the first side of the joint is given
    const Pose a = motion_(s.time);
    Eigen::Matrix<double, 6, 1> stress, twist;
    stress << Kt_ * e.d + Ct_ * e.d_rate, Kr_ * e.r + Cr_ * e.r_rate;
    twist << a.velocity, a.angular_velocity;
    drive = (e.B.leftCols<6>().transpose() * stress).dot(twist);
  }
  if (started_) {
    viscous_ += 0.5 * (power_ + power) * (s.time - time_);
    work_ += 0.5 * (drive_ + drive) * (s.time - time_);
  }
  power_ = power;
  drive_ = drive;
  time_ = s.time;
  started_ = true;
}

void SpringJoint::save(std::vector<double>& h) const { put(h, viscous_, work_, power_, drive_, time_, started_); }

void SpringJoint::restore(std::span<const double>& h) {
  take(h, kOther, viscous_, work_, power_, drive_, time_, started_);
}

}  // namespace hosel::fem
