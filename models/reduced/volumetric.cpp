#include "models/reduced/volumetric.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "golf/first_contact.hpp"
#include "golf/lanes.hpp"
#include "golf/plate_shape.hpp"
#include "models/reduced/volume.hpp"
#include "solvers/cvode.hpp"
#include "solvers/peak.hpp"
#include "solvers/rosenbrock_w.hpp"
#include "solvers/small_positive.hpp"

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

template <class T>
using V3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using V6 = Eigen::Matrix<T, 6, 1>;
template <class T>
using M3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using M6 = Eigen::Matrix<T, 6, 6>;
using solvers::solve_positive;

/// The matrix of the cross product of a number's or of several lanes' vectors.
template <class T>
M3<T> cross_matrix(const V3<T>& a) {
  M3<T> s;
  s << T(0), -a.z(), a.y(), a.z(), T(0), -a.x(), -a.y(), a.x(), T(0);
  return s;
}

/// What the equations need of one blow, or of several side by side.
template <class T>
struct Setting {
  T ball_mass = 0, radius = 0, core_inertia = 0, cover_inertia = 0;
  T mass = 0, inverse_mass = 0, by = 0, bz = 0, curvature = 0, speed = 0;
  T face_mass = 0, face_stiffness = 0, face_damping = 0, shape_y = 0, shape_z = 0;  // of a yielding face
  T shape_yz = 0;
  M3<T> to_global, inertia, inverse_inertia;
  V3<T> cg, cg_start, start_velocity, start_spin;
  V6<T> carried, held;  // the carrier's acceleration, and what it takes from the shaft

  /// f(member of a, member of b) for every member.
  template <class A, class B, class F>
  static void each(A& a, B& b, F f) {
    f(a.ball_mass, b.ball_mass), f(a.radius, b.radius), f(a.core_inertia, b.core_inertia);
    f(a.cover_inertia, b.cover_inertia), f(a.mass, b.mass), f(a.inverse_mass, b.inverse_mass), f(a.by, b.by);
    f(a.bz, b.bz), f(a.curvature, b.curvature), f(a.speed, b.speed), f(a.face_mass, b.face_mass);
    f(a.face_stiffness, b.face_stiffness), f(a.face_damping, b.face_damping), f(a.shape_y, b.shape_y);
    f(a.shape_z, b.shape_z), f(a.shape_yz, b.shape_yz), f(a.to_global, b.to_global), f(a.inertia, b.inertia);
    f(a.inverse_inertia, b.inverse_inertia), f(a.cg, b.cg), f(a.cg_start, b.cg_start);
    f(a.start_velocity, b.start_velocity), f(a.start_spin, b.start_spin), f(a.carried, b.carried), f(a.held, b.held);
  }
};

/// What decides which equations a blow has.
struct Structure {
  bool yields = false;  ///< the face
  bool wall = false;    ///< a head of infinite mass
  explicit Structure(const Blow& blow)
      : yields(blow.club.head.compliance.has_value()), wall(std::isinf(blow.club.head.mass)) {}
  bool operator==(const Structure&) const = default;
};

/// Throws std::invalid_argument where the head moves away, or its face is heavier than it.
Setting<double> setting_of(const Blow& blow, const VolumetricLaw& law, const ShaftImpedance* shaft) {
  const Head& head = blow.club.head;
  const Structure structure(blow);
  const FirstContact first = first_contact(blow);
  first.closing_speed();  // a head that moves away strikes nothing
  if (shaft && structure.wall) throw std::invalid_argument("shaft-coupled: a head of infinite mass feels no shaft");
  Setting<double> s;
  s.to_global = first.face_axes;
  const auto local = [&](const Vec3& v) -> Vec3 { return s.to_global.transpose() * v; };
  s.ball_mass = blow.ball.mass;
  s.radius = blow.ball.radius;
  s.core_inertia = blow.ball.inertia() * std::pow(1 - law.cover_thickness / s.radius, 5);
  s.cover_inertia = blow.ball.inertia() - s.core_inertia;
  s.mass = head.mass;
  s.inverse_mass = 1 / head.mass;
  s.by = 1 / head.face.bulge;
  s.bz = 1 / head.face.roll;
  s.curvature = (s.by + s.bz) / 2;
  s.inertia = head.inertia;
  s.inverse_inertia = structure.wall ? Mat3(Mat3::Zero()) : Mat3(head.inertia.inverse());
  s.cg = head.cg;
  s.cg_start = local(first.point - first.head_arm);
  s.start_velocity = local(blow.delivery.velocity());
  s.start_spin = local(blow.delivery.head_angular_velocity);
  s.speed = blow.delivery.velocity().norm();
  if (const auto& face = head.compliance) {
    if (!(face->mass < head.mass))
      throw std::invalid_argument("volumetric: the face's effective mass is part of the head's");
    s.face_mass = face->mass;
    s.face_stiffness = face->stiffness;
    s.face_damping = face->damping;
    const Eigen::Matrix2d ellipse = face->ellipse();
    s.shape_y = ellipse(0, 0);
    s.shape_z = ellipse(1, 1);
    s.shape_yz = ellipse(0, 1);
  }
  s.carried.setZero();
  s.held.setZero();
  if (shaft && shaft->acceleration && !structure.wall) {
    s.carried = *shaft->acceleration;
    s.held << head.mass * s.carried.head<3>(),
        head.inertia * s.carried.tail<3>() + s.start_spin.cross(head.inertia * s.start_spin);
  }
  return s;
}

/// The equations of one blow (T: double) or of several of one structure side by side (T: Pack).
template <class T>
class Contact {
  using Vec3 = V3<T>;
  using Vec6 = V6<T>;
  using Mat3 = M3<T>;
  using Mat6 = M6<T>;
  using ConstVec = Eigen::Map<const Vec3>;
  using MutVec = Eigen::Map<Vec3>;

 public:
  using Scalar = T;

  /// Where ball and face are, and how they push.
  struct Instant {
    Mat3 R;
    Vec3 normal, arm, head_arm, slip, friction, force;
    T depth, approach, elastic, normal_force;
    T shape = 0;  // of a yielding face under the ball

    void take(const Instant& o, const typename LaneTraits<T>::Mask& lanes) {
      const auto one = [&](auto member) { replace(lanes, this->*member, o.*member); };
      one(&Instant::R), one(&Instant::normal), one(&Instant::arm), one(&Instant::head_arm), one(&Instant::slip);
      one(&Instant::friction), one(&Instant::force), one(&Instant::depth), one(&Instant::approach);
      one(&Instant::elastic), one(&Instant::normal_force), one(&Instant::shape);
    }
  };

  Contact(const VolumetricLaw& law, const ShaftImpedance* shaft, const Structure& structure)
      : law_(law), yields_(structure.yields), wall_(structure.wall), shaft_at_(kFree + (yields_ ? 3 : 0)) {
    // Lanes without a blow compute with zeros, and nobody asks for their answers.
    Setting<T>::each(s_, s_, [](auto& member, auto&) {
      if constexpr (!std::is_same_v<std::decay_t<decltype(member)>, T>) member.setZero();
    });
    if (!shaft) return;
    has_shaft_ = true;
    modes_ = static_cast<int>(shaft->frequency2.size());
    damping_time_ = shaft->damping_time;
    frequency2_.assign(shaft->frequency2.begin(), shaft->frequency2.end());
    shaft_mass_ = shaft->mass.template cast<T>();
    stiffness_ = shaft->stiffness.template cast<T>();
    added_ = (shaft->mass - shaft->coupling * shaft->coupling.transpose()).template cast<T>();
    for (int k = 0; k < modes_; ++k) coupling_.push_back(shaft->coupling.col(k).template cast<T>());
  }

  void seat(int l, const Setting<double>& blow) {
    Setting<T>::each(s_, blow, [l](auto& to, const auto& from) { set_lane(to, l, from); });
  }

  int size() const { return shaft_at_ + (has_shaft_ ? 6 + 2 * modes_ : 0); }

  /// Size of a component for error control: what a blow of this speed does to it.
  T scale(int i) const {
    if (i < kBallVelocity || (i >= kHead && i < kHeadRotation)) return 0.2 * s_.radius;
    if (i < kCore || (i >= kHeadVelocity && i < kHeadSpin)) return s_.speed;
    if (i < kTwist) return s_.speed / s_.radius;
    if (i < kHead) return 0.2;
    if (i < kHeadVelocity) return 1;
    if (i < kLostNormal) return s_.speed / s_.radius;
    if (yields_ && i == kFree) return 0.2 * s_.radius;
    if (yields_ && i == kFree + 1) return s_.speed;
    return 0;
  }

  T gap(const Instant& i) const { return i.depth; }

  void at(const T* y, Instant& i) const {
    const Vec3 from_cg = closest_point(y, i);
    const ConstVec vb(y + kBallVelocity), cover(y + kCover), vh(y + kHeadVelocity), wh(y + kHeadSpin);
    const OverlapOf<T> overlapping = overlap(i.depth, s_.radius, s_.curvature);
    i.arm = -overlapping.centroid * i.normal;
    i.head_arm = from_cg + i.arm;
    Vec3 w = vh + wh.cross(i.head_arm) - vb - cover.cross(i.arm);
    if (yields_) w -= i.shape * y[kFree + 1] * i.R.col(0);
    i.approach = w.dot(i.normal);
    i.slip = w - i.approach * i.normal;
    i.elastic = law_.stiffness * powered(overlapping.volume, law_.volume_exponent);
    i.normal_force = i.elastic * (1 + law_.damping * i.approach);
    i.friction = i.normal_force * friction_over_slip(i.slip.norm()) * i.slip;
    i.force = i.normal_force * i.normal + i.friction;
  }

  void rate(const T* y, const Instant& i, T* dy) const {
    const ConstVec vb(y + kBallVelocity), core(y + kCore), cover(y + kCover), twist(y + kTwist);
    const ConstVec vh(y + kHeadVelocity), wh(y + kHeadSpin);
    const Vec3 relative = cover - core;
    const Vec3 joint = law_.joint_stiffness * twist + law_.joint_damping * relative;
    MutVec(dy + kBall) = vb;
    MutVec(dy + kBallVelocity) = i.force / s_.ball_mass;
    MutVec(dy + kCore) = joint / s_.core_inertia;
    MutVec(dy + kCover) = (i.arm.cross(i.force) - joint) / s_.cover_inertia;
    // The spring turns with the mean of the two bodies, so that a common spin does not load it.
    MutVec(dy + kTwist) = relative + 0.5 * (core + cover).cross(twist);
    MutVec(dy + kHead) = vh;
    const T* q = y + kHeadRotation;
    T* dq = dy + kHeadRotation;
    dq[0] = -0.5 * (wh.x() * q[1] + wh.y() * q[2] + wh.z() * q[3]);
    dq[1] = 0.5 * (wh.x() * q[0] + wh.y() * q[3] - wh.z() * q[2]);
    dq[2] = 0.5 * (wh.y() * q[0] + wh.z() * q[1] - wh.x() * q[3]);
    dq[3] = 0.5 * (wh.z() * q[0] + wh.x() * q[2] - wh.y() * q[1]);
    Vec3 torque = Vec3::Zero();
    if (!wall_) {
      const Vec3 spin_body = i.R.transpose() * wh;
      torque = -i.head_arm.cross(i.force) - i.R * spin_body.cross(s_.inertia * spin_body);
    }
    const HungFace face = yields_ ? hang_face(y, i) : HungFace();
    if (has_shaft_) {
      shaft_rate(y, i, face, torque, dy);
    } else {
      if (yields_ && !wall_) {
        Vec6 a;
        a << -i.force, torque;
        a += face.wrench;
        solve_positive(Mat6(rigid_head(i.R) + face.mass), a);
        Eigen::Map<Vec6>(dy + kHeadVelocity) = a;
      } else {
        MutVec(dy + kHeadVelocity) = -s_.inverse_mass * i.force;
        MutVec(dy + kHeadSpin) = i.R * (s_.inverse_inertia * (i.R.transpose() * torque));
      }
      dy[kCarrier] = dy[kLostShaft] = 0;
    }
    if (yields_) {
      dy[kFree] = y[kFree + 1];
      dy[kFree + 1] = face.own + face.arm.dot(Eigen::Map<const Vec6>(dy + kHeadVelocity));
      dy[kFree + 2] = s_.face_damping * y[kFree + 1] * y[kFree + 1];
    }
    dy[kTime] = 1;
    dy[kLostNormal] = i.elastic * law_.damping * i.approach * i.approach;
    dy[kLostFriction] = i.friction.dot(i.slip);
    dy[kLostJoint] = law_.joint_damping * relative.squaredNorm();
  }

  /// The stiff block: friction against slip. A = U (dF_t/dw) W with w the slip, W U = -mobility.
  void linearise(const Instant& i) {
    const Vec3 n = i.normal;
    const Mat3 tangent = Mat3::Identity() - n * n.transpose();
    const T s = i.slip.norm();
    // Secant stiffness across and tangent along the slip.
    const T across = i.normal_force * friction_over_slip(s), along = i.normal_force * friction_slope(s);
    stiff_ = across * tangent;
    const T curved = select(s > 0, (along - across) / (s * s), T(0));
    stiff_ += curved * i.slip * i.slip.transpose();
    ball_rate_ = 1 / s_.ball_mass;
    // Slip = v_h + w_h x c - v_b - w_cover x a.
    slip_of_cover_ = cross_matrix(i.arm);
    cover_rate_ = slip_of_cover_ / s_.cover_inertia;
    const Mat3 turn = cross_matrix(i.head_arm);
    slip_of_head_ << Mat3::Identity(), -turn;
    if (!has_shaft_) {
      head_rate_ << Mat3(-s_.inverse_mass * Mat3::Identity()),
          Mat3(-(i.R * s_.inverse_inertia * i.R.transpose()) * turn);
    } else {
      head_rate_ << -Mat3::Identity(), -turn;
      solve_positive(Mat6(added_ + rigid_head(i.R)), head_rate_);
    }
    const Mat3 mobility = ball_rate_ * Mat3::Identity() - slip_of_cover_ * cover_rate_ - slip_of_head_ * head_rate_;
    stiff_mobility_ = stiff_ * mobility;
  }

  void factor(const T& s) { inner_ = Mat3(Mat3::Identity() + s * stiff_mobility_).inverse() * (s * stiff_); }

  void solve(T* x) const {
    MutVec vb(x + kBallVelocity), cover(x + kCover);
    Eigen::Map<Vec6> head(x + kHeadVelocity);  // velocity and spin stand side by side
    const Vec3 force = inner_ * (slip_of_head_ * head - vb + slip_of_cover_ * cover);
    vb += ball_rate_ * force;
    cover += cover_rate_ * force;
    head += head_rate_ * force;
  }

  /// Of one blow.
  void launch(const double* y, Launch& l) const {
    const ConstVec core(y + kCore), cover(y + kCover);
    l.velocity = s_.to_global * ConstVec(y + kBallVelocity);
    l.spin = s_.to_global *
             ((s_.core_inertia * core + s_.cover_inertia * cover) / (s_.core_inertia + s_.cover_inertia));
    l.head_velocity = s_.to_global * ConstVec(y + kHeadVelocity);
    l.head_spin = s_.to_global * ConstVec(y + kHeadSpin);
  }

  void finish(const double* y, VolumetricResult& out) const {
    const ConstVec vb(y + kBallVelocity), core(y + kCore), cover(y + kCover), twist(y + kTwist);
    const ConstVec vh(y + kHeadVelocity), wh(y + kHeadSpin);
    Instant i;
    at(y, i);
    launch(y, out.launch);
    out.ball_displacement = s_.to_global * ConstVec(y + kBall);
    out.head_displacement = s_.to_global * ConstVec(y + kHead);
    out.head_rotation = s_.to_global * i.R * s_.to_global.transpose();
    EnergyLedger& e = out.energy;
    const auto head_energy = [&](const Vec3& v, const Vec3& w_body) {
      return wall_ ? 0.0 : (s_.mass * v.squaredNorm() + w_body.dot(s_.inertia * w_body)) / 2;
    };
    if (yields_) {
      const double travel = y[kFree], rate = y[kFree + 1];
      const Vec3 moved = face_velocity(y, i.R, travel, rate), carried = face_velocity(y, i.R, 0, 0),
                 gained = moved - carried, twice_mean = wall_ ? gained : Vec3(moved + carried);
      out.face_travel = travel;
      out.face_rate = rate;
      e.stored_face = (s_.face_stiffness * travel * travel + s_.face_mass * gained.dot(twice_mean)) / 2;
      e.lost_face = y[kFree + 2];
    }
    e.kinetic_before = wall_ ? s_.ball_mass * s_.start_velocity.squaredNorm() / 2
                             : head_energy(s_.start_velocity, s_.start_spin);
    // Of a wall in its own frame, as before.
    e.kinetic_after = (s_.ball_mass * Vec3(wall_ ? Vec3(vb - s_.start_velocity) : Vec3(vb)).squaredNorm() +
                       s_.core_inertia * core.squaredNorm() + s_.cover_inertia * cover.squaredNorm()) /
                          2 +
                      head_energy(vh, i.R.transpose() * wh);
    e.stored_contact = law_.stiffness * overlap_potential(i.depth, s_.radius, s_.curvature, law_.volume_exponent);
    e.stored_joint = law_.joint_stiffness * twist.squaredNorm() / 2;
    e.lost_normal = y[kLostNormal];
    e.lost_friction = y[kLostFriction];
    e.lost_joint = y[kLostJoint];
    e.lost_shaft = y[kLostShaft];
    e.work_of_carrier = y[kCarrier];
    if (has_shaft_) {
      const Eigen::Map<const Vec6> u(y + shaft_at_);
      const Vec6 v = velocity(y);
      const double *p = y + shaft_at_ + 6, *dp = p + modes_;
      e.stored_shaft = v.dot(shaft_mass_ * v) + u.dot(stiffness_ * u);
      for (int k = 0; k < modes_; ++k)
        e.stored_shaft += dp[k] * dp[k] + frequency2_[k] * p[k] * p[k] + 2 * v.dot(coupling_[k]) * dp[k];
      e.stored_shaft /= 2;
    }
  }

 private:
  /// Closest point of the face to the ball's centre, and how deep the ball is in it. Returns the centre from the head's
  /// cg.
  Vec3 closest_point(const T* y, Instant& i) const {
    const T *q = y + kHeadRotation, qw = q[0], qx = q[1], qy = q[2], qz = q[3];
    const T f = 2 / (qw * qw + qx * qx + qy * qy + qz * qz);
    i.R << 1 - f * (qy * qy + qz * qz), f * (qx * qy - qz * qw), f * (qx * qz + qy * qw), f * (qx * qy + qz * qw),
        1 - f * (qx * qx + qz * qz), f * (qy * qz - qx * qw), f * (qx * qz - qy * qw), f * (qy * qz + qx * qw),
        1 - f * (qx * qx + qy * qy);
    const Vec3 from_cg = ConstVec(y + kBall) - s_.cg_start - ConstVec(y + kHead);
    const Vec3 s = i.R.transpose() * from_cg + s_.cg;
    // Stationary: (D by + 1) y = s_y, (D bz + 1) z = s_z with D the height of the centre over the face.
    // Chord iteration: each round gains the factor (y / bulge)^2, at least 50 on a club's face; four leave
    // less than a nanometre at its rim.
    const T by = s_.by, bz = s_.bz;
    const T ky = 1 / (1 + s.x() * by), kz = 1 / (1 + s.x() * bz);
    T py = ky * s.y(), pz = kz * s.z(), D = 0;
    for (int round = 0; round < 4; ++round) {
      D = s.x() + 0.5 * (by * py * py + bz * pz * pz);
      py -= ky * ((D * by + 1) * py - s.y());
      pz -= kz * ((D * bz + 1) * pz - s.z());
    }
    D = s.x() + 0.5 * (by * py * py + bz * pz * pz);
    T ty = by * py, tz = bz * pz;  // slopes of the face there
    if (yields_) {
      // Stationary on the face as it has moved: (y, z) = (s_y, s_z) - D (t_y, t_z). Chord again: the shape's curvature
      // times travel and radius is a tenth at most.
      const T w = y[kFree];
      for (int round = 0; round <= 8; ++round) {
        const PlateShape<T> moved(s_.shape_y, s_.shape_z, s_.shape_yz, py, pz);
        i.shape = moved.value;
        D = s.x() + 0.5 * (by * py * py + bz * pz * pz) + w * moved.value;
        ty = by * py + w * moved.slope_y;
        tz = bz * pz + w * moved.slope_z;
        if (round == 8) break;
        py -= ky * (py + D * ty - s.y());
        pz -= kz * (pz + D * tz - s.z());
      }
    }
    using std::sqrt;
    const T length = sqrt(1 + ty * ty + tz * tz);
    i.normal = i.R * Vec3(1 / length, ty / length, tz / length);
    i.depth = s_.radius - D * length;
    return from_cg;
  }

  /// F_t / (F_n v_t), finite at rest.
  T friction_over_slip(const T& slip) const {
    const T s = slip / law_.transition_speed;
    const T saturating = select(s > 1e-7, saturation(s) / s, T(4));
    return (law_.friction * saturating + peak(s, 1)) / law_.transition_speed;
  }
  /// d(F_t / F_n) / dv_t.
  T friction_slope(const T& slip) const {
    const T s = slip / law_.transition_speed, t = saturation(s);
    const T b = s * s / 4 + 0.75;
    return (law_.friction * 4 * (1 - t * t) + peak(s, (b - s * s) / b)) / law_.transition_speed;
  }
  /// tanh(4 s).
  static T saturation(const T& s) {
    using std::exp;
    const T e = exp(-8 * s);
    return (1 - e) / (1 + e);
  }
  /// The static peak over s, times `by`.
  T peak(const T& s, const T& by) const {
    const double above = law_.static_friction - law_.friction;
    if (above == 0) return 0;
    const T b = s * s / 4 + 0.75;
    return above * by / (b * b);
  }

  Mat6 rigid_head(const Mat3& R) const {
    Mat6 m = Mat6::Zero();
    m.template topLeftCorner<3, 3>() = s_.mass * Mat3::Identity();
    m.template bottomRightCorner<3, 3>() = R * s_.inertia * R.transpose();
    return m;
  }

  /// The face's particle at travel w: r = R (-cg) - w e from the head's cg, e = R Xc; held at r_0 it is part of the
  /// head. With G = (1, -[r]x), p'' = G a + b - w'' e and w'' = own + e . G a, the travel leaves the head's equations,
  /// which gain a mass and a wrench.
  struct HungFace {
    Mat6 mass;
    Vec6 wrench, arm;
    T own;
  };
  HungFace hang_face(const T* y, const Instant& i) const {
    const ConstVec wh(y + kHeadSpin);
    const T w = y[kFree], rate = y[kFree + 1];
    const Vec3 e = i.R.col(0), r0 = -(i.R * s_.cg), r = r0 - w * e;
    const Vec3 b0 = wh.cross(wh.cross(r0)), b = wh.cross(wh.cross(r)) - 2 * rate * wh.cross(e);
    Eigen::Matrix<T, 3, 6> G0, G;
    G0 << Mat3::Identity(), -cross_matrix(r0);
    G << Mat3::Identity(), -cross_matrix(r);
    HungFace face;
    face.arm = G.transpose() * e;
    face.own = (i.shape * i.force.dot(e) - s_.face_stiffness * w - s_.face_damping * rate) / s_.face_mass + e.dot(b);
    face.mass = s_.face_mass * (G.transpose() * G - G0.transpose() * G0 - face.arm * face.arm.transpose());
    face.wrench = s_.face_mass * (face.own * face.arm - G.transpose() * b + G0.transpose() * b0);
    return face;
  }
  /// Velocity of that particle.
  Vec3 face_velocity(const T* y, const Mat3& R, const T& w, const T& rate) const {
    const ConstVec vh(y + kHeadVelocity), wh(y + kHeadSpin);
    const Vec3 e = R.col(0);
    return vh + wh.cross(Vec3(-(R * s_.cg) - w * e)) - rate * e;
  }
  /// Of the head, from the carrier's.
  Vec6 velocity(const T* y) const {
    Vec6 v;
    v << ConstVec(y + kHeadVelocity) - s_.start_velocity, ConstVec(y + kHeadSpin) - s_.start_spin;
    return v - y[kTime] * s_.carried;
  }

  void shaft_rate(const T* y, const Instant& i, const HungFace& face, const Vec3& torque, T* dy) const {
    const Eigen::Map<const Vec6> u(y + shaft_at_);
    const Vec6 v = velocity(y);
    const T *p = y + shaft_at_ + 6, *dp = p + modes_;
    T *p_rate = dy + shaft_at_ + 6, *dp_rate = p_rate + modes_;
    Eigen::Map<Vec6>(dy + shaft_at_) = v;
    Vec6 inner = Vec6::Zero();  // of the modes as if the tip were held
    T lost = 0;
    for (int k = 0; k < modes_; ++k) {
      p_rate[k] = dp[k];
      dp_rate[k] = -frequency2_[k] * (p[k] + damping_time_ * dp[k]);
      inner += dp_rate[k] * coupling_[k];
      lost += frequency2_[k] * dp[k] * dp[k];
    }
    const Vec6 pull = stiffness_ * (u + damping_time_ * v);
    Vec6 wrench;
    wrench << -i.force, torque;
    // From the carrier's motion, in which the loaded shaft holds the head with `held`.
    Mat6 head = rigid_head(i.R);
    if (yields_) {
      head += face.mass;
      wrench += face.wrench;
    }
    Vec6 a = wrench + s_.held - head * s_.carried - inner - pull;
    solve_positive(Mat6(head + added_), a);
    for (int k = 0; k < modes_; ++k) dp_rate[k] -= coupling_[k].dot(a);
    Eigen::Map<Vec6>(dy + kHeadVelocity) = a + s_.carried;
    Vec6 carrier, moves;
    carrier << s_.start_velocity, s_.start_spin;
    moves << ConstVec(y + kHeadVelocity), ConstVec(y + kHeadSpin);
    dy[kCarrier] = moves.dot(s_.held) - (carrier + y[kTime] * s_.carried).dot(added_ * a + inner + pull);
    dy[kLostShaft] = damping_time_ * (v.dot(stiffness_ * v) + lost);
  }

  VolumetricLaw law_;
  bool yields_, wall_;
  int shaft_at_;  // where its unknowns begin
  Setting<T> s_;
  bool has_shaft_ = false;
  int modes_ = 0;
  double damping_time_ = 0;
  std::vector<double> frequency2_;
  Mat6 shaft_mass_, stiffness_, added_;
  std::vector<Vec6> coupling_;

  // The stiff block, as linearise() and factor() left it.
  T ball_rate_;
  Mat3 cover_rate_, slip_of_cover_, stiff_, stiff_mobility_, inner_;
  Eigen::Matrix<T, 6, 3> head_rate_;
  Eigen::Matrix<T, 3, 6> slip_of_head_;
};

std::vector<double> at_first_touch(const Setting<double>& blow, int size) {
  std::vector<double> y(static_cast<std::size_t>(size), 0.0);
  y[kHeadRotation] = 1;
  Eigen::Map<Vec3>{&y[kHeadVelocity]} = blow.start_velocity;
  Eigen::Map<Vec3>{&y[kHeadSpin]} = blow.start_spin;
  return y;
}

// A contact lasts half a millisecond; the first micrometre of depth takes some 20 ns.
constexpr double kLongestContact = 20e-3, kFirstContactStep = 1e-6;  // [s]

/// How a blow ended.
struct Ended {
  std::vector<double> y;
  double time = 0, peak_force = 0, peak_depth = 0;
  solvers::RosenbrockStatistics count;
  std::string failure;  ///< empty where the ball has left
};

/// Blows by the own method, side by side where T has lanes.
///   bool next(int lane, Setting<double>&)      the lane's next blow; false: none is left
///   void watch(int lane, double t, Instant)    at the start and after every step
///   void done(int lane, Ended)
template <class T, class Next, class Watch, class Done>
void integrate(Contact<T>& contact, double tolerance, Next&& next, Watch&& watch, Done&& done) {
  constexpr int kWidth = LaneTraits<T>::count;
  std::array<solvers::Peak, kWidth> force, depth;
  const int size = contact.size();
  solvers::RosenbrockW<Contact<T>> method(contact);
  method.run(
      {.first_step = kFirstContactStep, .latest = kLongestContact, .tolerance = tolerance, .event_tolerance = 1e-10},
      [&](int l, T* y) {
        Setting<double> blow;
        if (!next(l, blow)) return false;
        contact.seat(l, blow);
        const std::vector<double> start = at_first_touch(blow, size);
        for (int m = 0; m < size; ++m) set_lane(y[m], l, start[static_cast<std::size_t>(m)]);
        force[l] = depth[l] = {};
        return true;
      },
      [&](int l, double t, const typename Contact<T>::Instant& i) {
        force[l].add(t, lane(i.normal_force, l));
        depth[l].add(t, lane(i.depth, l));
        watch(l, t, i);
      },
      [&](int l, double t, const T* y, const solvers::RosenbrockStatistics& count, const char* failure) {
        Ended e{.y = std::vector<double>(static_cast<std::size_t>(size)),
                .time = t,
                .peak_force = force[l].value,
                .peak_depth = depth[l].value,
                .count = count,
                .failure = failure ? std::string("rosenbrock: ") + failure : std::string()};
        for (int m = 0; m < size; ++m) e.y[static_cast<std::size_t>(m)] = lane(y[m], l);
        done(l, std::move(e));
      });
}

}  // namespace

VolumetricResult volumetric_impact(const Blow& blow, const VolumetricLaw& law, const VolumetricOptions& options,
                                   const ShaftImpedance* shaft,
                                   const std::function<void(const ContactSample&)>& watch) {
  const Setting<double> setting = setting_of(blow, law, shaft);
  const Structure structure(blow);
  Contact<double> contact(law, shaft, structure);
  contact.seat(0, setting);
  VolumetricResult out;
  const auto tell = [&](double t, const auto& i, int l) {
    if (watch)
      watch({t, lane(i.depth, l), lane(i.normal_force, l), setting.to_global * lane(i.friction, l),
             setting.to_global * lane(i.slip, l)});
  };
  Ended end;
  if (options.integrator == Integrator::rosenbrock) {
    // A lane of many, so that a blow among others has the same answer.
    Contact<Pack> one(law, shaft, structure);
    bool taken = false;
    integrate(
        one, options.tolerance,
        [&](int, Setting<double>& to) {
          to = setting;
          return !std::exchange(taken, true);
        },
        [&](int l, double t, const auto& i) { tell(t, i, l); }, [&](int, Ended e) { end = std::move(e); });
    if (!end.failure.empty()) throw solvers::NonConvergence(end.failure);
    out.steps = end.count.steps;
    out.rate_calls = end.count.rate_calls;
  } else {
    solvers::CvodeOptions how;
    how.relative_tolerance = options.tolerance;
    for (int i = 0; i < contact.size(); ++i) {
      const double size = contact.scale(i);
      how.absolute.push_back(options.tolerance * 1e-2 * (size > 0 ? size : 1));
    }
    how.first_step = 1e-9;
    how.largest_step = 2e-5;
    solvers::Peak force, depth;
    Contact<double>::Instant now;
    const auto record = [&](double t, const double* y) {
      contact.at(y, now);
      force.add(t, now.normal_force);
      depth.add(t, now.depth);
      tell(t, now, 0);
    };
    end.y = at_first_touch(setting, contact.size());
    record(0, end.y.data());
    solvers::CvodeStatistics count;
    end.time = solvers::integrate_to_event(
        [&](double, const double* y, double* dy) {
          contact.at(y, now);
          contact.rate(y, now, dy);
        },
        [&](double, const double* y) {
          contact.at(y, now);
          return contact.gap(now);
        },
        0, kLongestContact, end.y, how, &count, record);
    end.peak_force = force.value;
    end.peak_depth = depth.value;
    out.steps = count.steps;
    out.rate_calls = count.rate_calls;
  }
  contact.finish(end.y.data(), out);
  out.launch.contact_time = end.time;
  out.launch.peak_force = end.peak_force;
  out.launch.peak_compression = end.peak_depth;
  return out;
}

std::vector<Answer> volumetric_launches(std::span<const Blow> blows, const VolumetricLaw& law,
                                        const VolumetricOptions& options, const ShaftImpedance* shaft) {
  std::vector<Answer> answers(blows.size());
  if (options.integrator == Integrator::cvode) {
    for (std::size_t k = 0; k < blows.size(); ++k) try {
        answers[k].launch = volumetric_impact(blows[k], law, options, shaft).launch;
      } catch (...) { answers[k].failure = std::current_exception(); }
    return answers;
  }
  // Blows of one structure go together.
  std::vector<bool> taken(blows.size(), false);
  for (std::size_t first = 0; first < blows.size(); ++first) {
    if (taken[first]) continue;
    const Structure structure(blows[first]);
    Contact<Pack> contact(law, shaft, structure);
    Contact<double> alone(law, shaft, structure);
    std::array<std::size_t, kLanes> number{};
    std::array<Setting<double>, kLanes> setting;
    std::size_t k = first;
    integrate(
        contact, options.tolerance,
        [&](int l, Setting<double>& to) {
          for (; k < blows.size(); ++k) {
            if (taken[k] || Structure(blows[k]) != structure) continue;
            taken[k] = true;
            try {
              to = setting[l] = setting_of(blows[k], law, shaft);
            } catch (...) {
              answers[k].failure = std::current_exception();
              continue;
            }
            number[l] = k++;
            return true;
          }
          return false;
        },
        [](int, double, const auto&) {},
        [&](int l, const Ended& end) {
          Answer& answer = answers[number[l]];
          if (!end.failure.empty()) {
            answer.failure = std::make_exception_ptr(solvers::NonConvergence(end.failure));
            return;
          }
          alone.seat(0, setting[l]);
          alone.launch(end.y.data(), answer.launch);
          answer.launch.contact_time = end.time;
          answer.launch.peak_force = end.peak_force;
          answer.launch.peak_compression = end.peak_depth;
        });
  }
  return answers;
}

}  // namespace hosel::models
