#include "models/club/loaded_shaft.hpp"

#include <stdexcept>

#include "fem/section.hpp"
#include "golf/dense.hpp"
#include "models/club/mounted_shaft.hpp"
#include "solvers/errors.hpp"
#include "solvers/statics.hpp"

namespace hosel::models {

LoadedShaft loaded_by_swing(const Swing& swing, const fem::State& s, const SwingSample& before,
                            const SwingSample& last) {
  if (!swing.head()) throw std::invalid_argument("a loaded start needs a head on the shaft");
  const fem::Node &on_head = swing.head_node(), &butt = swing.shaft().nodes().front();
  const Eigen::Quaterniond to_face(Mat3(swing.face_to_grip().transpose()));  // grip axes to face axes, straight club
  const Eigen::Quaterniond head = fem::rotation(s, on_head.rotation);        // grip axes to global
  const Vec3 x0 = s.q.segment<3>(on_head.translation.q), v0 = s.v.segment<3>(on_head.translation.v);
  const Vec3 w0 = head * Vec3(s.v.segment<3>(on_head.rotation.v));
  const auto local = [&](const Vec3& global) { return Vec3(to_face * (head.conjugate() * global)); };
  LoadedShaft out;
  for (const fem::Node& n : swing.shaft().nodes()) {
    const Vec3 arm = Vec3(s.q.segment<3>(n.translation.q)) - x0;
    const Eigen::Quaterniond R = fem::rotation(s, n.rotation);
    LoadedShaft::Node node;
    node.position = local(arm);
    node.rotation = to_face * head.conjugate() * R * to_face.conjugate();
    node.velocity = local(Vec3(s.v.segment<3>(n.translation.v)) - v0 - w0.cross(arm));
    node.angular_velocity = to_face * (Vec3(s.v.segment<3>(n.rotation.v)) - R.conjugate() * w0);
    out.nodes.push_back(node);
  }
  out.gravity = local(swing.gravity());
  out.grip = {local(last.force), to_face * last.moment};
  const double step = last.time - before.time;
  out.grip_rate = {local(last.force - before.force) / step, to_face * (last.moment - before.moment) / step};
  out.grip_acceleration = local(s.a.segment<3>(butt.translation.v));
  out.grip_angular_acceleration = to_face * Vec3(s.a.segment<3>(butt.rotation.v));
  const Vec3 w = s.v.segment<3>(on_head.rotation.v), alpha = s.a.segment<3>(on_head.rotation.v);
  const Vec3& c = swing.head()->properties().offset;
  out.head_acceleration =
      local(Vec3(s.a.segment<3>(on_head.translation.v)) + head * (alpha.cross(c) + w.cross(w.cross(c))));
  out.head_angular_acceleration = to_face * alpha;
  return out;
}

LoadedShaft loaded_by_grip(const Blow& blow, const GripLoad& load, double grip_point, int elements, double growth,
                           bool shear) {
  const Club& club = blow.club;
  const Mat3 face = blow.delivery.face_to_global(), to_face = face_to_grip(club.geometry).transpose();
  const Vec3 gravity = face.transpose() * load.gravity, w = face.transpose() * blow.delivery.head_angular_velocity;
  const Vec3 c = club.head.cg - club.geometry.hosel;
  const Vec3 v = face.transpose() * blow.delivery.velocity() - w.cross(c);
  fem::Wrench grip{to_face * load.force, to_face * load.moment};

  // A system of its own in face axes: the head's node at the origin, held; the butt under the wrench.
  fem::System system;
  const fem::Node head{system.dof_map.add_vector(3), system.dof_map.add_rotation()};
  system.terms.push_back(
      std::make_unique<fem::RigidBody>("head", head.translation, head.rotation,
                                       fem::RigidBodyProperties{club.head.mass, club.head.inertia, c}, gravity));
  const auto line = shaft_line(club, grip_point, elements, growth);
  auto owned = std::make_unique<fem::Beam>(system.dof_map, line, fem::shaft_sections(*club.shaft, shear, grip_point),
                                           fem::BeamOptions{.gravity = gravity, .last = head});
  const fem::Beam& beam = *owned;
  system.terms.push_back(std::move(owned));
  system.terms.push_back(std::make_unique<fem::NodeLoad>(
      "hands", beam.nodes().front(), [&grip](double) { return grip; }, fem::NodeLoad::Moment::body));
  Vec3 a = Vec3::Zero(), alpha = Vec3::Zero();
  system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(head, [&](double) {
    return fem::Pose{.velocity = v, .acceleration = a, .angular_velocity = w, .angular_acceleration = alpha};
  }));

  fem::State s = system.dof_map.rest();
  beam.place(s);
  const auto move = [&](const Vec3& linear, const Vec3& angular, const Vec3& spin) {
    for (const fem::Node& n : beam.nodes()) {
      const Vec3 x = s.q.segment<3>(n.translation.q);
      const Eigen::Quaterniond back = fem::rotation(s, n.rotation).conjugate();
      s.v.segment<3>(n.translation.v) = v + spin.cross(x);
      s.v.segment<3>(n.rotation.v) = back * spin;
      s.a.segment<3>(n.translation.v) = linear + angular.cross(x) + spin.cross(spin.cross(x));
      s.a.segment<3>(n.rotation.v) = back * angular;
    }
  };
  /// What is out of balance: force and moment about the hosel.
  const auto resultant = [&] {
    const fem::Vector r = fem::unbalanced(system, s);
    Eigen::Matrix<double, 6, 1> out = Eigen::Matrix<double, 6, 1>::Zero();
    for (const fem::Node& n : beam.nodes()) {
      const Vec3 f = r.segment<3>(n.translation.v), x = s.q.segment<3>(n.translation.q);
      out.head<3>() += f;
      out.tail<3>() += x.cross(f) + fem::rotation(s, n.rotation) * Vec3(r.segment<3>(n.rotation.v));
    }
    return out;
  };
  const solvers::NewtonOptions newton{
      .residual_relative = 1e-9, .residual_absolute = 1e-7, .increment_vector = 1e-9, .increment_rotation = 1e-9};
  double change = 1;
  for (int round = 0; change > 1e-8; ++round) {  // of a swing's wrench each round leaves some 0.8 of the change
    if (round == 500)
      throw solvers::NonConvergence("loaded shaft: deflection and acceleration do not settle under this grip wrench");
    grip.force = fem::rotation(s, beam.nodes().front().rotation) * (to_face * load.force);
    move(Vec3::Zero(), Vec3::Zero(), w);
    const Eigen::Matrix<double, 6, 1> at_rest = resultant();
    Eigen::Matrix<double, 6, 6> mass;
    for (int k = 0; k < 6; ++k) {
      const Vec3 unit = Vec3::Unit(k % 3);
      move(k < 3 ? unit : Vec3::Zero(), k < 3 ? Vec3::Zero() : unit, w);
      mass.col(k) = resultant() - at_rest;
    }
    const Eigen::Matrix<double, 6, 1> acceleration = dense::solve_lu(mass, Eigen::VectorXd(-at_rest));
    a = acceleration.head<3>();
    alpha = acceleration.tail<3>();
    move(a, alpha, w);
    const fem::Vector q = s.q;
    s = solvers::solve_static(system, s, {.newton = newton, .load_steps = round == 0 ? 4 : 1});
    change = (s.q - q).cwiseAbs().maxCoeff();
  }
  move(a, alpha, w);

  LoadedShaft out;
  for (const fem::Node& n : beam.nodes())
    out.nodes.push_back({.position = s.q.segment<3>(n.translation.q), .rotation = fem::rotation(s, n.rotation)});
  out.gravity = gravity;
  out.grip = grip;
  out.grip_rate.force = w.cross(grip.force);  // steady in the grip's axes, which turn with the club
  const fem::Node& butt = beam.nodes().front();
  out.grip_acceleration = s.a.segment<3>(butt.translation.v);
  out.grip_angular_acceleration = s.a.segment<3>(butt.rotation.v);
  out.head_acceleration = a + alpha.cross(c) + w.cross(w.cross(c));
  out.head_angular_acceleration = alpha;
  return out;
}

}  // namespace hosel::models
