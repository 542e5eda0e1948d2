#include "models/club/mounted_shaft.hpp"

#include <stdexcept>

#include "fem/section.hpp"
#include "golf/shaft_library.hpp"

namespace hosel::models {

std::vector<mesh::LineNode> shaft_line(const Club& club, double grip_point, int elements, double growth) {
  if (!club.shaft) throw std::invalid_argument("the full club needs a shaft: add one to the club");
  if (const auto wrong = faults(*club.shaft); !wrong.empty()) throw std::invalid_argument(wrong.front());
  const double length = club.shaft->length() - grip_point;
  if (!(length > 0)) throw std::invalid_argument("the grip point lies beyond the shaft's tip");
  const Vec3 axis = club.geometry.shaft_axis.normalized();
  return mesh::straight(mesh::graded(length, elements, growth), length * axis, mesh::frame_along(-axis, Vec3::UnitX()));
}

const fem::Beam& mount_shaft(fem::System& system, fem::State& initial, const fem::Node& head, const Club& club,
                             const ShaftMount& mount) {
  if (mount.joint.kind == HeadJoint::Kind::none) throw std::invalid_argument("a blow needs a head on the shaft");
  const auto line = shaft_line(club, mount.grip_point, mount.elements, mount.growth);
  LoadedShaft shaft;  // straight and at rest on the head
  if (mount.loaded) shaft = *mount.loaded;
  else
    for (const mesh::LineNode& n : line) shaft.nodes.push_back({.position = n.position});
  if (shaft.nodes.size() != line.size())
    throw std::invalid_argument("the loaded shaft has another number of nodes than the club's mesh");

  const Vec3 x = initial.q.segment<3>(head.translation.q), v = initial.v.segment<3>(head.translation.v);
  const Vec3 w = initial.v.segment<3>(head.rotation.v);  // body frame
  const Eigen::Quaterniond R = fem::rotation(initial, head.rotation);
  fem::Node tip = head;
  if (mount.joint.gives()) {
    tip = {system.dof_map.add_vector(3), system.dof_map.add_rotation()};
    system.terms.push_back(std::make_unique<fem::SpringJoint>(
        "joint", tip, head, stiffness_of(mount.joint, *club.shaft, face_to_grip(club.geometry).transpose())));
  }
  auto owned = std::make_unique<fem::Beam>(
      system.dof_map, line, fem::shaft_sections(*club.shaft, mount.shear, mount.grip_point),
      fem::BeamOptions{.gravity = R * shaft.gravity, .damping_time = club.shaft->damping_time, .last = tip});
  const fem::Beam& beam = *owned;
  system.terms.push_back(std::move(owned));

  fem::State grown = system.dof_map.rest();
  grown.time = initial.time;
  grown.q.head(initial.q.size()) = initial.q;
  grown.v.head(initial.v.size()) = initial.v;
  grown.a.head(initial.a.size()) = initial.a;
  const std::size_t own = line.size() - (mount.joint.gives() ? 0 : 1);  // a rigid joint's tip is the head's node
  for (std::size_t i = 0; i < own; ++i) {
    const fem::Node& n = beam.nodes()[i];
    const LoadedShaft::Node& s = shaft.nodes[i];
    grown.q.segment<3>(n.translation.q) = x + R * s.position;
    fem::set_rotation(grown, n.rotation, R * s.rotation);
    grown.v.segment<3>(n.translation.v) = v + R * (w.cross(s.position) + s.velocity);
    grown.v.segment<3>(n.rotation.v) = s.rotation.conjugate() * w + s.angular_velocity;
  }
  initial = std::move(grown);

  // The grip goes on with the velocity and acceleration that it has before the blow.
  const fem::Node& butt = beam.nodes().front();
  const fem::Motion motion = [p = fem::Pose{.position = initial.q.segment<3>(butt.translation.q),
                                            .rotation = fem::rotation(initial, butt.rotation),
                                            .velocity = initial.v.segment<3>(butt.translation.v),
                                            .acceleration = R * shaft.grip_acceleration,
                                            .angular_velocity = initial.v.segment<3>(butt.rotation.v),
                                            .angular_acceleration = shaft.grip_angular_acceleration},
                              t0 = initial.time](double time) {
    const double t = time - t0;
    const Vec3 turn = t * p.angular_velocity + 0.5 * t * t * p.angular_acceleration;
    // To first order in t the rate of exp(turn) is turn's; what is left out is a turn of (t^2 w x a) / 12 of it.
    return fem::Pose{.position = p.position + t * p.velocity + 0.5 * t * t * p.acceleration,
                     .rotation = p.rotation * fem::rotation_exp(turn),
                     .velocity = p.velocity + t * p.acceleration,
                     .acceleration = p.acceleration,
                     .angular_velocity = p.angular_velocity + t * p.angular_acceleration,
                     .angular_acceleration = p.angular_acceleration};
  };
  const auto wrench = [R, grip = shaft.grip, rate = shaft.grip_rate, t0 = initial.time](double t) {
    return fem::Wrench{R * (grip.force + (t - t0) * rate.force), grip.moment + (t - t0) * rate.moment};
  };
  if (mount.grip == Grip::clamped) system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(butt, motion));
  if (mount.grip == Grip::forced || mount.grip == Grip::hands)
    system.terms.push_back(std::make_unique<fem::NodeLoad>("hands", butt, wrench, fem::NodeLoad::Moment::body));
  if (mount.grip == Grip::hands) {
    fem::JointStiffness hands = mount.hands;
    hands.frame = (face_to_grip(club.geometry).transpose() * hands.frame).eval();
    system.terms.push_back(std::make_unique<fem::SpringJoint>("hands", motion, butt, hands));
  }
  return beam;
}

}  // namespace hosel::models
