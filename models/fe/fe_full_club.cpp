#include "models/fe/fe_full_club.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace hosel::models {

FullClubImpact assemble_full_club(const Blow& blow, const FeFullClubOptions& options) {
  const Head& head = blow.club.head;
  if (std::isinf(head.mass))
    throw std::invalid_argument("fe full club: a head of infinite mass feels no shaft; use fe-free-body");
  if (const auto faults = head.faults(); !faults.empty())
    throw std::invalid_argument("fe full club: " + faults.front());
  if (options.impact.harmonics == 0)
    throw std::invalid_argument(
        "fe full club: the shaft turns the head, which the axisymmetric ball cannot follow: use harmonics of 2 or "
        "more");
  ShaftMount mount = options.mount;
  if (mount.load && mount.joint.gives())
    throw std::invalid_argument(
        "fe full club: how far a joint that gives has turned follows from the swing, not from the hands' wrench: use a "
        "loaded-club case, or a head that is rigid on the shaft");
  if (mount.load && !mount.loaded)
    mount.loaded = loaded_by_grip(blow, *mount.load, mount.grip_point, mount.elements, mount.growth, mount.shear);
  FullClubImpact out;
  out.encounter = encounter(blow);
  const Encounter& e = out.encounter;

  // The node that head and shaft share is at the hosel, its frame the face frame.
  const Vec3& hosel = blow.club.geometry.hosel;
  out.hosel = {out.system.dof_map.add_vector(3), out.system.dof_map.add_rotation()};
  auto body =
      std::make_unique<fem::RigidBody>("head", out.hosel.translation, out.hosel.rotation,
                                       fem::RigidBodyProperties{head.mass, head.inertia, head.cg - hosel},
                                       mount.loaded ? Vec3(e.face_axes * mount.loaded->gravity) : Vec3(Vec3::Zero()));
  out.head = body.get();
  out.system.terms.push_back(std::move(body));

  fem::SurfaceCarrier carrier;
  carrier.translation = out.hosel.translation;
  carrier.rotation = out.hosel.rotation;
  carrier.centre = -hosel;
  out.parts = add_ball(out.system, blow, options.impact, carrier, true);

  out.initial = out.system.dof_map.rest();
  const Vec3& w = blow.delivery.head_angular_velocity;
  out.initial.q.segment<3>(out.hosel.translation.q) = e.face_centre + e.face_axes * hosel;
  fem::set_rotation(out.initial, out.hosel.rotation, Eigen::Quaterniond(e.face_axes));
  out.initial.v.segment<3>(out.hosel.translation.v) = blow.delivery.velocity() +
                                                      w.cross(e.face_axes * (hosel - head.cg));
  out.initial.v.segment<3>(out.hosel.rotation.v) = e.face_axes.transpose() * w;
  out.shaft = &mount_shaft(out.system, out.initial, out.hosel, blow.club, mount);
  return out;
}

FeOutcome solve_full_club(const Blow& blow, const FeFullClubOptions& options, const ImpactObserver& observer,
                          const ImpactCheckpoint* from) {
  FullClubImpact impact = assemble_full_club(blow, options);
  impact.parts.shaft = impact.shaft;
  FeOutcome out;
  out.result = run_impact(impact.system, impact.parts, impact.initial, options.impact, impact.encounter.normal_speed,
                          observer, from);
  if (impact.parts.face) out.result.face_energy = impact.parts.face->vibration(out.result.last, blow.club.head.mass);
  out.launch = launch_of(out.result);
  out.launch.head_velocity = impact.head->velocity(out.result.last);
  out.launch.head_spin = impact.head->angular_velocity(out.result.last);
  return out;
}

FeFullClub::FeFullClub(FeFullClubOptions options) : options_(std::move(options)) {}

FeOutcome FeFullClub::solve(const Blow& blow, const ImpactObserver& observer, const ImpactCheckpoint* from) const {
  return solve_full_club(blow, options_, observer, from);
}

}  // namespace hosel::models
