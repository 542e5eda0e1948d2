#include "models/mounted_shaft.hpp"

#include <stdexcept>

#include "fem/section.hpp"
#include "golf/shaft_library.hpp"

namespace hosel::models {

const fem::Beam& mount_shaft(fem::System& system, fem::State& initial, const fem::Node& head, const Club& club,
                             const ShaftMount& mount) {
  if (!club.shaft) throw std::invalid_argument("the full club needs a shaft: add one to the club");
  const Shaft& shaft = *club.shaft;
  if (const auto wrong = faults(shaft); !wrong.empty()) throw std::invalid_argument(wrong.front());

  const Vec3 axis = club.geometry.shaft_axis.normalized();
  const auto line = mesh::straight(mesh::graded(shaft.length(), mount.elements, mount.growth), shaft.length() * axis,
                                   mesh::frame_along(-axis, Vec3::UnitX()));
  auto owned = std::make_unique<fem::Beam>(system.layout, line, fem::shaft_sections(shaft, mount.shear),
                                           fem::BeamOptions{.damping_time = shaft.damping_time, .last = head});
  const fem::Beam& beam = *owned;
  system.terms.push_back(std::move(owned));

  const Vec3 x = initial.q.segment<3>(head.translation.q), v = initial.v.segment<3>(head.translation.v);
  const Vec3 w = initial.v.segment<3>(head.rotation.v);  // body frame
  const Eigen::Quaterniond R = fem::rotation(initial, head.rotation);
  fem::State grown = system.layout.rest();
  grown.time = initial.time;
  grown.q.head(initial.q.size()) = initial.q;
  grown.v.head(initial.v.size()) = initial.v;
  grown.a.head(initial.a.size()) = initial.a;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const fem::Node& n = beam.nodes()[i];
    grown.q.segment<3>(n.translation.q) = x + R * line[i].position;
    fem::set_rotation(grown, n.rotation, R);
    grown.v.segment<3>(n.translation.v) = v + R * w.cross(line[i].position);
    grown.v.segment<3>(n.rotation.v) = w;
  }
  initial = std::move(grown);

  // The grip goes on with the velocity and angular velocity that it has before the blow.
  const fem::Node& butt = beam.nodes().front();
  const fem::Motion motion = [x0 = Vec3(initial.q.segment<3>(butt.translation.q)),
                              v0 = Vec3(initial.v.segment<3>(butt.translation.v)), R, w,
                              t0 = initial.time](double t) {
    return fem::Pose{.position = x0 + (t - t0) * v0,
                     .rotation = R * fem::rotation_exp((t - t0) * w),
                     .velocity = v0,
                     .angular_velocity = w};
  };
  switch (mount.grip) {
    case Grip::clamped: system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(butt, motion)); break;
    case Grip::hands: system.terms.push_back(std::make_unique<fem::SpringJoint>("hands", motion, butt, mount.hands)); break;
    case Grip::free: break;
  }
  return beam;
}

}  // namespace hosel::models
