#include "models/reduced/volumetric.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "golf/first_contact.hpp"
#include "models/reduced/volume.hpp"
#include "solvers/cvode.hpp"
#include "solvers/peak.hpp"
#include "solvers/rosenbrock_w.hpp"

namespace hosel::models {
namespace {

// Layout of the state. Inertial axes: the face frame at first contact; origin: the ball's centre then.
enum : int {
  kBall = 0,  // displacement of the ball's centre
  kBallVelocity = 3,
  kCore = 6,  // angular velocities
  kCover = 9,
  kTwist = 12,         // rotation of the cover against the core
  kHead = 15,          // displacement of the head's cg
  kHeadRotation = 18,  // quaternion w, x, y, z
  kHeadVelocity = 22,
  kHeadSpin = 25,
  kLostNormal = 28,
  kLostFriction = 29,
  kLostJoint = 30,
  kCarrier = 31,
  kLostShaft = 32,
  kTime = 33,  // since first contact
  kFree = 34,  // size of head and ball; then a yielding face: travel, its rate, energy lost; then a shaft:
               // head's departure u from the carrier, q, q'
};

using ConstVec = Eigen::Map<const Vec3>;
using MutVec = Eigen::Map<Vec3>;

class Contact {
 public:
  Contact(const Blow& blow, const VolumetricLaw& law, const ShaftImpedance* shaft)
      : law_(law),
        ball_(blow.ball),
        head_(blow.club.head),
        shaft_(shaft),
        shaft_at_(kFree + (head_.compliance ? 3 : 0)) {
    const double r = ball_.radius;
    const Delivery& d = blow.delivery;
    const FirstContact first = first_contact(blow);
    to_global = first.face_axes;
    cg_start_ = to_global.transpose() * (first.point - first.head_arm);
    by_ = 1 / head_.face.bulge;
    bz_ = 1 / head_.face.roll;
    curvature_ = (by_ + bz_) / 2;
    const double core_share = std::pow(1 - law.cover_thickness / r, 5);
    core_inertia_ = ball_.inertia() * core_share;
    cover_inertia_ = ball_.inertia() - core_inertia_;
    wall_ = std::isinf(head_.mass);
    if (head_.compliance && !(head_.compliance->mass < head_.mass))
      throw std::invalid_argument("volumetric: the face's effective mass is part of the head's");
    inverse_mass_ = 1 / head_.mass;
    inverse_inertia_ = wall_ ? Mat3(Mat3::Zero()) : Mat3(head_.inertia.inverse());
    start_velocity_ = to_global.transpose() * d.velocity();
    start_spin_ = to_global.transpose() * d.head_angular_velocity;
    if (shaft_) {
      modes_ = static_cast<int>(shaft_->frequency2.size());
      added_ = shaft_->mass - shaft_->coupling * shaft_->coupling.transpose();
      if (shaft_->acceleration && !wall_) {
        carried_ = *shaft_->acceleration;
        held_ << head_.mass * carried_.head<3>(),
            head_.inertia * carried_.tail<3>() + start_spin_.cross(head_.inertia * start_spin_);
      }
    }
    speed_ = d.velocity().norm();
  }

  int size() const { return shaft_at_ + (shaft_ ? 6 + 2 * modes_ : 0); }

  std::vector<double> start() const {
    std::vector<double> y(size(), 0.0);
    y[kHeadRotation] = 1;
    MutVec{&y[kHeadVelocity]} = start_velocity_;
    MutVec{&y[kHeadSpin]} = start_spin_;
    return y;
  }

  /// Size of a component for error control: what a blow of this speed does to it.
  double scale(int i) const {
    if (i < kBallVelocity || (i >= kHead && i < kHeadRotation)) return 0.2 * ball_.radius;
    if (i < kCore || (i >= kHeadVelocity && i < kHeadSpin)) return speed_;
    if (i < kTwist) return speed_ / ball_.radius;
    if (i < kHead) return 0.2;
    if (i < kHeadVelocity) return 1;
    if (i < kLostNormal) return speed_ / ball_.radius;
    if (head_.compliance && i == kFree) return 0.2 * ball_.radius;
    if (head_.compliance && i == kFree + 1) return speed_;
    return 0;
  }

  double gap(const double* y) {
    evaluate(y);
    return depth_;
  }

  void rate(const double* y, double* dy) {
    evaluate(y);
    const ConstVec vb(y + kBallVelocity), core(y + kCore), cover(y + kCover), twist(y + kTwist);
    const ConstVec vh(y + kHeadVelocity), wh(y + kHeadSpin);
    const Vec3 relative = cover - core;
    const Vec3 joint = law_.joint_stiffness * twist + law_.joint_damping * relative;
    MutVec(dy + kBall) = vb;
    MutVec(dy + kBallVelocity) = force_ / ball_.mass;
    MutVec(dy + kCore) = joint / core_inertia_;
    MutVec(dy + kCover) = (arm_.cross(force_) - joint) / cover_inertia_;
    // The spring turns with the mean of the two bodies, so that a common spin does not load it.
    MutVec(dy + kTwist) = relative + 0.5 * (core + cover).cross(twist);
    MutVec(dy + kHead) = vh;
    const double* q = y + kHeadRotation;
    double* dq = dy + kHeadRotation;
    dq[0] = -0.5 * (wh.x() * q[1] + wh.y() * q[2] + wh.z() * q[3]);
    dq[1] = 0.5 * (wh.x() * q[0] + wh.y() * q[3] - wh.z() * q[2]);
    dq[2] = 0.5 * (wh.y() * q[0] + wh.z() * q[1] - wh.x() * q[3]);
    dq[3] = 0.5 * (wh.z() * q[0] + wh.x() * q[2] - wh.y() * q[1]);
    const Vec3 spin_body = R_.transpose() * wh;
    const Vec3 gyro = R_ * spin_body.cross(head_.inertia * spin_body);
    const Vec3 torque = wall_ ? Vec3(Vec3::Zero()) : Vec3(-head_arm_.cross(force_) - gyro);
    if (head_.compliance) hang_face(y);
    if (shaft_) {
      shaft_rate(y, dy, torque);
    } else {
      if (head_.compliance && !wall_) {
        Vec6 wrench;
        wrench << -force_, torque;
        Eigen::Map<Vec6>(dy + kHeadVelocity) = (rigid_head() + face_.mass).llt().solve(wrench + face_.wrench);
      } else {
        MutVec(dy + kHeadVelocity) = -inverse_mass_ * force_;
        MutVec(dy + kHeadSpin) = R_ * (inverse_inertia_ * (R_.transpose() * torque));
      }
      dy[kCarrier] = dy[kLostShaft] = 0;
    }
    if (head_.compliance) {
      dy[kFree] = y[kFree + 1];
      dy[kFree + 1] = face_.own + face_.arm.dot(Eigen::Map<const Vec6>(dy + kHeadVelocity));
      dy[kFree + 2] = head_.compliance->damping * y[kFree + 1] * y[kFree + 1];
    }
    dy[kTime] = 1;
    dy[kLostNormal] = elastic_ * law_.damping * approach_ * approach_;
    dy[kLostFriction] = friction_.dot(slip_);
    dy[kLostJoint] = law_.joint_damping * relative.squaredNorm();
  }

  /// The stiff block: friction against slip. A = U (dF_t/dw) W with w the slip, W U = -mobility.
  void linearise(const double* y) {
    evaluate(y);
    const Vec3 n = normal_;
    const Mat3 tangent = Mat3::Identity() - n * n.transpose();
    const double s = slip_.norm();
    // Secant stiffness across and tangent along the slip.
    const double across = normal_force_ * friction_over_slip(s), along = normal_force_ * friction_slope(s);
    Mat3 G = across * tangent;
    if (s > 0) G += (along - across) / (s * s) * slip_ * slip_.transpose();
    ball_rate_ = 1 / ball_.mass;
    cover_rate_ = skew(arm_) / cover_inertia_;
    if (!shaft_) {
      head_rate_.topRows<3>() = -inverse_mass_ * Mat3::Identity();
      head_rate_.bottomRows<3>() = -R_ * inverse_inertia_ * R_.transpose() * skew(head_arm_);
    } else {
      Eigen::Matrix<double, 6, 3> wrench;
      wrench << -Mat3::Identity(), -skew(head_arm_);
      head_rate_ = head_mass().llt().solve(wrench);
    }
    // Slip = v_h + w_h x c - v_b - w_cover x a.
    slip_of_head_ << Mat3::Identity(), -skew(head_arm_);
    slip_of_cover_ = skew(arm_);
    const Mat3 mobility = ball_rate_ * Mat3::Identity() - slip_of_cover_ * cover_rate_ - slip_of_head_ * head_rate_;
    stiff_ = G;
    stiff_mobility_ = G * mobility;
    step_ = 0;
  }

  void solve(double s, double* x) {
    if (s != step_) {
      inner_ = (Mat3::Identity() + s * stiff_mobility_).inverse() * (s * stiff_);
      step_ = s;
    }
    MutVec vb(x + kBallVelocity), cover(x + kCover);
    Eigen::Map<Vec6> head(x + kHeadVelocity);  // velocity and spin stand side by side
    const Vec3 force = inner_ * (slip_of_head_ * head - vb + slip_of_cover_ * cover);
    vb += ball_rate_ * force;
    cover += cover_rate_ * force;
    head += head_rate_ * force;
  }

  ContactSample sample(double t, const double* y) {
    evaluate(y);
    return {t, depth_, normal_force_, to_global * friction_, to_global * slip_};
  }

  void finish(const double* y, const Blow& blow, VolumetricResult& out) {
    const ConstVec vb(y + kBallVelocity), core(y + kCore), cover(y + kCover), twist(y + kTwist);
    const ConstVec vh(y + kHeadVelocity), wh(y + kHeadSpin);
    evaluate(y);
    Launch& l = out.launch;
    l.velocity = to_global * vb;
    l.spin = to_global * ((core_inertia_ * core + cover_inertia_ * cover) / ball_.inertia());
    l.head_velocity = to_global * vh;
    l.head_spin = to_global * wh;
    out.core_spin = to_global * core;
    out.cover_spin = to_global * cover;
    out.ball_displacement = to_global * ConstVec(y + kBall);
    out.head_displacement = to_global * ConstVec(y + kHead);
    out.head_rotation = to_global * R_ * to_global.transpose();
    EnergyLedger& e = out.energy;
    const auto head_energy = [&](const Vec3& v, const Vec3& w_body) {
      return wall_ ? 0.0 : (head_.mass * v.squaredNorm() + w_body.dot(head_.inertia * w_body)) / 2;
    };
    if (head_.compliance) {
      const FaceCompliance& f = *head_.compliance;
      const Vec3 moved = face_velocity(y, y[kFree], y[kFree + 1]), carried = face_velocity(y, 0, 0),
                 gained = moved - carried, twice_mean = wall_ ? gained : Vec3(moved + carried);
      out.face_travel = y[kFree];
      out.face_rate = y[kFree + 1];
      e.stored_face = (f.stiffness * y[kFree] * y[kFree] + f.mass * gained.dot(twice_mean)) / 2;
      e.lost_face = y[kFree + 2];
    }
    e.kinetic_before = wall_ ? ball_.mass * blow.delivery.velocity().squaredNorm() / 2
                             : head_energy(start_velocity_, start_spin_);
    e.kinetic_after =
        (ball_.mass * vb.squaredNorm() + core_inertia_ * core.squaredNorm() + cover_inertia_ * cover.squaredNorm()) /
            2 +
        head_energy(vh, R_.transpose() * wh);
    e.stored_contact = law_.stiffness * overlap_potential(depth_, ball_.radius, curvature_, law_.volume_exponent);
    e.stored_joint = law_.joint_stiffness * twist.squaredNorm() / 2;
    e.lost_normal = y[kLostNormal];
    e.lost_friction = y[kLostFriction];
    e.lost_joint = y[kLostJoint];
    e.lost_shaft = y[kLostShaft];
    e.work_of_carrier = y[kCarrier];
    if (shaft_) {
      const Eigen::Map<const Vec6> u(y + shaft_at_);
      const Vec6 v = velocity(y);
      const Eigen::Map<const Eigen::VectorXd> p(y + shaft_at_ + 6, modes_), dp(y + shaft_at_ + 6 + modes_, modes_);
      e.stored_shaft = (v.dot(shaft_->mass * v) + u.dot(shaft_->stiffness * u) + dp.squaredNorm() +
                        p.dot(shaft_->frequency2.cwiseProduct(p))) /
                           2 +
                       v.dot(shaft_->coupling * dp);
    }
  }

  Mat3 to_global;

 private:
  /// Closest point of the face to the ball's centre, and how deep the ball is in it.
  void geometry(const double* y) {
    const double *q = y + kHeadRotation, qw = q[0], qx = q[1], qy = q[2], qz = q[3];
    const double f = 2 / (qw * qw + qx * qx + qy * qy + qz * qz);
    R_ << 1 - f * (qy * qy + qz * qz), f * (qx * qy - qz * qw), f * (qx * qz + qy * qw), f * (qx * qy + qz * qw),
        1 - f * (qx * qx + qz * qz), f * (qy * qz - qx * qw), f * (qx * qz - qy * qw), f * (qy * qz + qx * qw),
        1 - f * (qx * qx + qy * qy);
    const Vec3 from_cg = ConstVec(y + kBall) - cg_start_ - ConstVec(y + kHead);
    const Vec3 s = R_.transpose() * from_cg + head_.cg;
    // Stationary: (D by + 1) y = s_y, (D bz + 1) z = s_z with D the height of the centre over the face.
    // Chord iteration: each round gains the factor (y / bulge)^2, at least 50 on a club's face; four leave
    // less than a nanometre at its rim.
    const double ky = 1 / (1 + s.x() * by_), kz = 1 / (1 + s.x() * bz_);
    double py = ky * s.y(), pz = kz * s.z(), D = 0;
    for (int i = 0; i < 4; ++i) {
      D = s.x() + 0.5 * (by_ * py * py + bz_ * pz * pz);
      py -= ky * ((D * by_ + 1) * py - s.y());
      pz -= kz * ((D * bz_ + 1) * pz - s.z());
    }
    D = s.x() + 0.5 * (by_ * py * py + bz_ * pz * pz);
    double ty = by_ * py, tz = bz_ * pz;  // slopes of the face there
    if (head_.compliance) {
      // Stationary on the face as it has moved: (y, z) = (s_y, s_z) - D (t_y, t_z). Chord again: the shape's curvature
      // times travel and radius is a tenth at most.
      const double w = y[kFree];
      for (int i = 0; i <= 8; ++i) {
        const FaceCompliance::Shape moved = head_.compliance->shape(py, pz);
        shape_ = moved.value;
        D = s.x() + 0.5 * (by_ * py * py + bz_ * pz * pz) + w * moved.value;
        ty = by_ * py + w * moved.slope.x();
        tz = bz_ * pz + w * moved.slope.y();
        if (i == 8) break;
        py -= ky * (py + D * ty - s.y());
        pz -= kz * (pz + D * tz - s.z());
      }
    }
    const double length = std::sqrt(1 + ty * ty + tz * tz);
    normal_ = R_ * Vec3(1 / length, ty / length, tz / length);
    depth_ = ball_.radius - D * length;
    from_cg_ = from_cg;
  }

  void evaluate(const double* y) {
    const bool same_face = !head_.compliance || std::equal(y + kFree, y + kFree + 2, seen_face_.begin());
    if (same_face && std::equal(seen_.begin(), seen_.end(), y)) return;  // the same instant again
    std::copy(y, y + kLostNormal, seen_.begin());
    if (head_.compliance) std::copy(y + kFree, y + kFree + 2, seen_face_.begin());
    geometry(y);
    const ConstVec vb(y + kBallVelocity), cover(y + kCover), vh(y + kHeadVelocity), wh(y + kHeadSpin);
    overlap_ = overlap(depth_, ball_.radius, curvature_);
    arm_ = -overlap_.centroid * normal_;
    head_arm_ = from_cg_ + arm_;
    Vec3 w = vh + wh.cross(head_arm_) - vb - cover.cross(arm_);
    if (head_.compliance) w -= shape_ * y[kFree + 1] * R_.col(0);
    approach_ = w.dot(normal_);
    slip_ = w - approach_ * normal_;
    elastic_ = law_.stiffness * powered(overlap_.volume, law_.volume_exponent);
    normal_force_ = elastic_ * (1 + law_.damping * approach_);
    friction_ = normal_force_ * friction_over_slip(slip_.norm()) * slip_;
    force_ = normal_force_ * normal_ + friction_;
  }

  /// F_t / (F_n v_t), finite at rest.
  double friction_over_slip(double slip) const {
    const double s = slip / law_.transition_speed;
    const double above = law_.static_friction - law_.friction, b = s * s / 4 + 0.75;
    const double peak = above == 0 ? 0 : above / (b * b);
    const double e = std::exp(-8 * s);
    const double saturating = s > 1e-7 ? (1 - e) / ((1 + e) * s) : 4.0;  // tanh(4 s) / s
    return (law_.friction * saturating + peak) / law_.transition_speed;
  }
  /// d(F_t / F_n) / dv_t.
  double friction_slope(double slip) const {
    const double s = slip / law_.transition_speed, t = std::tanh(4 * s), b = s * s / 4 + 0.75;
    const double peak = (law_.static_friction - law_.friction) * (b - s * s) / (b * b * b);
    return (law_.friction * 4 * (1 - t * t) + peak) / law_.transition_speed;
  }

  Mat6 rigid_head() const {
    Mat6 m = Mat6::Zero();
    m.topLeftCorner<3, 3>() = head_.mass * Mat3::Identity();
    m.bottomRightCorner<3, 3>() = R_ * head_.inertia * R_.transpose();
    return m;
  }
  Mat6 head_mass() const { return added_ + rigid_head(); }

  /// The face's particle at travel w: r = R (-cg) - w e from the head's cg, e = R Xc; held at r_0 it is part of the
  /// head. With G = (1, -[r]x), p'' = G a + b - w'' e and w'' = own + e . G a, the travel leaves the head's equations,
  /// which gain a mass and a wrench.
  void hang_face(const double* y) {
    const FaceCompliance& f = *head_.compliance;
    const ConstVec wh(y + kHeadSpin);
    const double w = y[kFree], rate = y[kFree + 1];
    const Vec3 e = R_.col(0), r0 = -(R_ * head_.cg), r = r0 - w * e;
    const Vec3 b0 = wh.cross(wh.cross(r0)), b = wh.cross(wh.cross(r)) - 2 * rate * wh.cross(e);
    Eigen::Matrix<double, 3, 6> G0, G;
    G0 << Mat3::Identity(), -skew(r0);
    G << Mat3::Identity(), -skew(r);
    face_.arm = G.transpose() * e;
    face_.own = (shape_ * force_.dot(e) - f.stiffness * w - f.damping * rate) / f.mass + e.dot(b);
    face_.mass = f.mass * (G.transpose() * G - G0.transpose() * G0 - face_.arm * face_.arm.transpose());
    face_.wrench = f.mass * (face_.own * face_.arm - G.transpose() * b + G0.transpose() * b0);
  }
  /// Velocity of that particle.
  Vec3 face_velocity(const double* y, double w, double rate) const {
    const ConstVec vh(y + kHeadVelocity), wh(y + kHeadSpin);
    const Vec3 e = R_.col(0);
    return vh + wh.cross(-(R_ * head_.cg) - w * e) - rate * e;
  }
  Vec6 velocity(const double* y) const {
    Vec6 v;
    v << ConstVec(y + kHeadVelocity) - start_velocity_, ConstVec(y + kHeadSpin) - start_spin_;
    return v - y[kTime] * carried_;
  }

  void shaft_rate(const double* y, double* dy, const Vec3& torque) {
    const Eigen::Map<const Vec6> u(y + shaft_at_);
    const Vec6 v = velocity(y);
    const Eigen::Map<const Eigen::VectorXd> p(y + shaft_at_ + 6, modes_), dp(y + shaft_at_ + 6 + modes_, modes_);
    Eigen::Map<Eigen::VectorXd> p_rate(dy + shaft_at_ + 6, modes_), dp_rate(dy + shaft_at_ + 6 + modes_, modes_);
    const double damping = shaft_->damping_time;
    Eigen::Map<Vec6>(dy + shaft_at_) = v;
    p_rate = dp;
    dp_rate = -shaft_->frequency2.cwiseProduct(p + damping * dp);
    const Vec6 pull = shaft_->stiffness * (u + damping * v);
    Vec6 wrench;
    wrench << -force_, torque;
    // From the carrier's motion, in which the loaded shaft holds the head with `held_`.
    Mat6 head = rigid_head();
    if (head_.compliance) {
      head += face_.mass;
      wrench += face_.wrench;
    }
    const Vec6 inner = shaft_->coupling * dp_rate;  // of the modes as if the tip were held
    const Vec6 a = (head + added_).llt().solve(wrench + held_ - head * carried_ - inner - pull);
    dp_rate -= shaft_->coupling.transpose() * a;
    Eigen::Map<Vec6>(dy + kHeadVelocity) = a + carried_;
    Vec6 carrier, moves;
    carrier << start_velocity_, start_spin_;
    moves << ConstVec(y + kHeadVelocity), ConstVec(y + kHeadSpin);
    dy[kCarrier] = moves.dot(held_) - (carrier + y[kTime] * carried_).dot(added_ * a + inner + pull);
    dy[kLostShaft] = damping * (v.dot(shaft_->stiffness * v) + dp.dot(shaft_->frequency2.cwiseProduct(dp)));
  }

  VolumetricLaw law_;
  Ball ball_;
  Head head_;
  const ShaftImpedance* shaft_;
  int shaft_at_;  // where its unknowns begin
  Vec3 cg_start_, start_velocity_, start_spin_;
  double by_, bz_, curvature_, core_inertia_, cover_inertia_, inverse_mass_, speed_;
  Mat3 inverse_inertia_;
  bool wall_ = false;
  int modes_ = 0;
  Mat6 added_ = Mat6::Zero();
  Vec6 carried_ = Vec6::Zero(), held_ = Vec6::Zero();  // the carrier's acceleration, and what it takes from the shaft

  // The instant, as evaluate() left it.
  std::array<double, kLostNormal> seen_ = {};
  std::array<double, 2> seen_face_ = {};
  Mat3 R_;
  Vec3 normal_, arm_, head_arm_, from_cg_, slip_, friction_, force_;
  Overlap overlap_;
  double depth_ = 0, approach_ = 0, elastic_ = 0, normal_force_ = 0;
  double shape_ = 0;  // of a yielding face under the ball
  struct {
    Mat6 mass;
    Vec6 wrench, arm;
    double own;
  } face_;

  // The stiff block, as linearise() left it.
  double ball_rate_ = 0, step_ = 0;
  Mat3 cover_rate_, slip_of_cover_, stiff_, stiff_mobility_, inner_;
  Eigen::Matrix<double, 6, 3> head_rate_;
  Eigen::Matrix<double, 3, 6> slip_of_head_;
};

}  // namespace

VolumetricResult volumetric_impact(const Blow& blow, const VolumetricLaw& law, const VolumetricOptions& options,
                                   const ShaftImpedance* shaft,
                                   const std::function<void(const ContactSample&)>& watch) {
  Contact contact(blow, law, shaft);
  std::vector<double> y = contact.start();
  first_contact(blow).closing_speed();  // a head that moves away strikes nothing
  VolumetricResult out;
  solvers::Peak force, depth;
  const auto record = [&](double t, const double* state) {
    const ContactSample now = contact.sample(t, state);
    force.add(t, now.normal_force);
    depth.add(t, now.depth);
    if (watch) watch(now);
  };
  record(0, y.data());
  // A contact lasts half a millisecond; the first micrometre of depth takes some 20 ns.
  const double latest = 20e-3, first_step = 1e-6;
  double end = 0;
  if (options.integrator == Integrator::rosenbrock) {
    solvers::RosenbrockW<Contact> method(contact);
    end = method.run(y.data(), first_step, latest, options.tolerance, 1e-10, record);
    out.steps = method.statistics.steps;
    out.rate_calls = method.statistics.rate_calls;
  } else {
    solvers::CvodeOptions how;
    how.relative_tolerance = options.tolerance;
    for (int i = 0; i < contact.size(); ++i) {
      const double size = contact.scale(i);
      how.absolute.push_back(options.tolerance * 1e-2 * (size > 0 ? size : 1));
    }
    how.first_step = 1e-9;
    how.largest_step = 2e-5;
    solvers::CvodeStatistics count;
    end = solvers::integrate_to_event([&](double, const double* s, double* ds) { contact.rate(s, ds); },
                                      [&](double, const double* s) { return contact.gap(s); }, 0, latest, y, how,
                                      &count, record);
    out.steps = count.steps;
    out.rate_calls = count.rate_calls;
  }
  contact.finish(y.data(), blow, out);
  out.launch.contact_time = end;
  out.launch.peak_force = force.value;
  out.launch.peak_compression = depth.value;
  return out;
}

}  // namespace hosel::models
