#include "models/fe/impact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fem/contact_method/methods.hpp"
#include "fem/friction/laws.hpp"
#include "models/reduced/face_strike.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

/// Ball, face and contact, behind a head or wall that carries the face. `free`: the carrier may leave the blow's plane
/// of symmetry.
void add_contact(ImpactBodies& out, const Blow& blow, const FeImpactOptions& o, const fem::SurfaceCarrier& carrier,
                 bool free) {
  const ContactFrame& e = out.frame;
  const Head& head = blow.club.head;
  if (o.face && head.compliance) throw std::invalid_argument("fe impact: a face is lumped or a plate, not both");
  const std::shared_ptr<const StruckFace> face = o.face ? o.face : own_face(head);
  const bool axial = o.harmonics == 0;
  const Mirror mirror = e.planar && e.principal && !free ? e.mirror() : Mirror::none;
  const bool planar = !axial && e.planar && !free && face->symmetric(mirror, head.face);
  const fem::FourierBasis basis = axial    ? fem::axisymmetric_basis()
                                  : planar ? fem::cartesian_basis(o.harmonics)
                                           : fem::cartesian_basis(o.harmonics, std::min(o.antisymmetric, o.harmonics));
  const int angles = o.angles > 0 ? o.angles : 2 * o.harmonics + 4;
  const int patch = o.contact_angles > 0 ? o.contact_angles : 3 * o.harmonics + 8;
  const auto rule = [&](int half) {
    return axial ? fem::single_angle() : planar ? fem::half_circle(half) : fem::full_circle(2 * half);
  };
  const double young = o.ball.instant_young(), tilt = o.tilt.value_or(axial ? 0 : expected_turn(e, blow, young) / 2);
  out.mesh_axes = Eigen::AngleAxisd(-tilt, e.ball_axes.col(2)).toRotationMatrix() * e.ball_axes;
  MeshedBall meshed_ball = meshed(o.ball, blow.ball, o.mesh);
  auto ball = std::make_unique<fem::HarmonicSolid>(
      out.system.dof_map, std::move(meshed_ball.mesh), basis, fem::SolidQuadrature{rule(angles), 2},
      std::move(meshed_ball.materials), fem::Placement{Vec3::Zero(), out.mesh_axes});
  const double radius = blow.ball.radius, stiffness = o.penalty * young / radius;
  fem::ContactLaws laws{fem::contact_method(o.method)->make(stiffness, o.penetration * radius), nullptr};
  if (!axial) laws.friction = fem::friction_law(blow.contact.patch, o.tangential_penalty * stiffness);
  FaceInSystem struck = face->add(out.system, {blow, carrier, axial, planar ? mirror : Mirror::none});
  const fem::Symmetry symmetry = axial ? fem::Symmetry::axis : planar ? fem::Symmetry::plane : fem::Symmetry::none;
  auto contact = std::make_unique<fem::Contact>(*ball, std::move(struck.surface), carrier, std::move(laws), rule(patch),
                                                symmetry, o.edge_points);
  out.ball = ball.get();
  out.contact = contact.get();
  out.face = struck.spring.get();
  out.compliance = struck.compliance;
  out.face_stresses = std::move(struck.stresses);
  out.system.terms.push_back(std::move(ball));
  out.system.terms.push_back(std::move(contact));
  if (struck.spring) out.system.terms.push_back(std::move(struck.spring));
  out.contact_time = hertz_time(out.ball->mass(), out.ball->mesh().radius, young, e.normal_speed) *
                     contact_on_face(out.compliance);
}

/// A body behind the face, its node at `from_face` in face axes.
fem::Node add_head(ImpactBodies& out, const Head& head, const Vec3& from_face, const Vec3& gravity) {
  const fem::Node node{out.system.dof_map.add_vector(3), out.system.dof_map.add_rotation()};
  auto body = std::make_unique<fem::RigidBody>("head", node.translation, node.rotation,
                                               fem::RigidBodyProperties{head.mass, head.inertia, head.cg - from_face},
                                               gravity);
  out.head = body.get();
  out.system.terms.push_back(std::move(body));
  return node;
}

void set_motion(ImpactBodies& out, const fem::Node& node, const Vec3& position, const Vec3& velocity,
                const Vec3& spin) {
  const Mat3& axes = out.frame.face_axes;
  out.initial = out.system.dof_map.rest();
  out.initial.q.segment<3>(node.translation.q) = position;
  fem::set_rotation(out.initial, node.rotation, Eigen::Quaterniond(axes));
  out.initial.v.segment<3>(node.translation.v) = velocity;
  out.initial.v.segment<3>(node.rotation.v) = axes.transpose() * spin;
}

/// A free head, or in a wall's frame: it stands, the ball comes.
void assemble_free(ImpactBodies& out, const Blow& blow, const FeImpactOptions& o) {
  const ContactFrame& e = out.frame;
  const Head& head = blow.club.head;
  const bool wall = std::isinf(head.mass);
  if (o.harmonics == 0 && !e.axial && !wall)
    throw std::invalid_argument(
        "fe impact: harmonics = 0 is the axisymmetric ball: a blow with loft, offset or curved face needs harmonics of "
        "2 or more");
  if (o.harmonics == 0 && head.face.bulge != head.face.roll)
    throw std::invalid_argument(
        "fe impact: harmonics = 0 is the axisymmetric ball: a face of unlike bulge and roll needs harmonics of 2 or "
        "more");
  if (o.harmonics == 0 && (e.approach - e.normal_speed * e.normal).norm() > 1e-9 * e.normal_speed)
    throw std::invalid_argument("fe impact: harmonics = 0 is the axisymmetric ball: it cannot be struck obliquely");
  if (wall) {
    if (!blow.delivery.head_angular_velocity.isZero(0))
      throw std::invalid_argument(
          "fe impact: a head of infinite mass is a wall that does not turn: leave its angular "
          "velocity out");
    fem::SurfaceCarrier carrier;
    carrier.position = e.face_centre;
    carrier.attitude = e.face_axes;
    add_contact(out, blow, o, carrier, false);
    out.initial = out.system.dof_map.rest();
    out.ball->set_velocity(out.initial, -blow.delivery.velocity(), Vec3::Zero());
    return;
  }
  if (const auto faults = head.faults(); !faults.empty()) throw std::invalid_argument("fe impact: " + faults.front());
  const fem::Node node = add_head(out, head, head.cg, Vec3::Zero());
  add_contact(out, blow, o, {node.translation, node.rotation, -head.cg}, false);
  set_motion(out, node, e.face_centre + e.face_axes * head.cg, blow.delivery.velocity(),
             blow.delivery.head_angular_velocity);
}

/// The node that head and shaft share is at the hosel.
void assemble_club(ImpactBodies& out, const Blow& blow, const FeImpactOptions& o, ShaftMount mount) {
  const ContactFrame& e = out.frame;
  const Head& head = blow.club.head;
  if (std::isinf(head.mass))
    throw std::invalid_argument("fe full club: a head of infinite mass feels no shaft; use fe-free-body");
  if (const auto faults = head.faults(); !faults.empty())
    throw std::invalid_argument("fe full club: " + faults.front());
  if (o.harmonics == 0)
    throw std::invalid_argument(
        "fe full club: the shaft turns the head, which the axisymmetric ball cannot follow: use harmonics of 2 or "
        "more");
  if (mount.load && mount.joint.gives())
    throw std::invalid_argument(
        "fe full club: how far a joint that gives has turned follows from the swing, not from the hands' wrench: use a "
        "[motion] in its case, or a head that is rigid on the shaft");
  if (mount.load && !mount.loaded)
    mount.loaded = loaded_by_grip(blow, *mount.load, mount.grip_point, mount.elements, mount.growth, mount.shear);
  const Vec3& hosel = blow.club.geometry.hosel;
  const fem::Node node =
      add_head(out, head, hosel, mount.loaded ? Vec3(e.face_axes * mount.loaded->gravity) : Vec3(Vec3::Zero()));
  add_contact(out, blow, o, {node.translation, node.rotation, -hosel}, true);
  const Vec3& w = blow.delivery.head_angular_velocity;
  set_motion(out, node, e.face_centre + e.face_axes * hosel,
             blow.delivery.velocity() + w.cross(e.face_axes * (hosel - head.cg)), w);
  out.shaft = &mount_shaft(out.system, out.initial, node, blow.club, mount);
}

/// Steps and tolerances.
solvers::GeneralizedAlphaOptions time_options(const ImpactBodies& bodies, const FeImpactOptions& o) {
  const double mass = bodies.ball->mass(), radius = bodies.ball->mesh().radius, speed = bodies.frame.normal_speed,
               expected = bodies.contact_time, step = expected / o.steps_per_contact;
  solvers::GeneralizedAlphaOptions options;
  options.rho_inf = o.rho_inf;
  options.newton.residual_relative = o.newton_relative;
  // The gradient F holds strains to machine precision and no better: what that is in forces counts in very slow blows.
  // On 21,000 unknowns residuals wandered from 5 to 113 eps of modulus times radius squared, half of them below 18.
  double stiffest = 0;
  for (const fem::Solid& m : bodies.ball->materials())
    stiffest = std::max(stiffest, m.bulk() + 4.0 / 3 * m.instant_shear());
  options.newton.residual_absolute = 1e-3 * o.newton_relative * mass * speed / expected +
                                     64 * std::numeric_limits<double>::epsilon() * stiffest * radius * radius;
  options.newton.increment_vector = 1e-4 * speed * step;
  options.newton.increment_rotation = 1e-4 * speed * step / radius;
  options.newton.max_iterations = 60;
  options.newton.renew_above = 0.12;
  options.step_max = step;
  options.step_first = step / 16;  // the first touch is the roughest part
  options.step_min = step / 1024;
  options.predict_acceleration = false;
  return options;
}

/// Throws solvers::NonConvergence where the energy does not add up, or where it takes far too long.
void check_balance(const solvers::Ledger& ledger, double now, double expected, bool touched) {
  if (!(std::abs(ledger.closure) <= 0.05 * ledger.initial)) {
    std::ostringstream text;
    text << "at t = " << now << " s the energy of the impact is out of balance by "
         << 100 * ledger.closure / ledger.initial
         << " % of what it began with: take more steps_per_contact or a lower rho_inf";
    throw solvers::NonConvergence(text.str());
  }
  if (now > 20 * expected) {
    std::ostringstream text;
    text << "ball and face " << (touched ? "have not parted" : "have not met") << " after " << now
         << " s, twenty times the time that Hertz's theory expects: is the ball far too soft or viscous?";
    throw solvers::NonConvergence(text.str());
  }
}

/// Whether ball and head part. A light face that yields flees from the ball, and the head follows.
bool parting(const ImpactBodies& bodies, const fem::State& state) {
  const fem::MeanMotion ball = bodies.ball->motion(state);
  const fem::SurfacePose face = bodies.contact->surface_pose(state);
  const Vec3 there = face.velocity + face.spin.cross(bodies.ball->centre(state) - face.centre);
  return face.axes.col(0).dot(ball.velocity - there) > 0;
}

/// What a step adds to what is known of the impact.
void add_step(ImpactCheckpoint& at, const ImpactBodies& bodies, const fem::State& state,
              const fem::ContactReport& report, double gap0, double after) {
  const double now = state.time;
  at.force.add(now, report.normal_force);
  if (report.points > 0) {
    at.touched = true;
    at.last_touch = now;
  } else if (at.last_nearest < 0) {
    // The last point let go within this step: its gap grows in proportion to time there.
    at.last_touch += (now - at.last_touch) * at.last_nearest / (at.last_nearest - report.nearest);
  }
  at.last_nearest = report.nearest;
  at.release.add(now, report.normal_force, report.points > 0);
  const double gap = bodies.contact->centre_gap(state);
  const bool leaving = gap > at.last_gap;  // a stiff skin may bounce while the ball still comes nearer
  at.last_gap = gap;
  at.compression.add(now, gap0 - gap);
  at.so_far.penetration = report.penetration;
  if (bodies.face) at.face_travel.add(now, bodies.face->travel(state));
  at.so_far.creep = report.elastic_slip;
  at.over = at.touched && leaving && report.points == 0 && now >= at.last_touch * (1 + after) && parting(bodies, state);
}

FeImpactResult integrated(ImpactBodies& bodies, const FeImpactOptions& o, const ImpactObserver& observer,
                          const ImpactCheckpoint* from) {
  bodies.contact->start(bodies.initial);
  const solvers::GeneralizedAlphaOptions options = time_options(bodies, o);
  const Mat3 inertia = bodies.ball->motion(bodies.system.dof_map.rest()).inertia;
  const double gap0 = bodies.contact->centre_gap(bodies.initial);
  solvers::GeneralizedAlpha solver(bodies.system, options, bodies.initial);
  ImpactCheckpoint at{.last_gap = gap0};
  if (from) {
    at = *from;
    solver.restore(from->solver);
  }
  FeImpactResult& out = at.so_far;
  const solvers::GeneralizedAlpha::Counts before = out.counts;
  const auto observe = [&](const fem::ContactReport& report) {
    if (observer)
      observer({bodies, solver.state(), *bodies.ball, *bodies.contact, report, solver.ledger(),
                bodies.contact->surface_pose(solver.state()), bodies.shaft, [&] {
                  // This run goes on from its checkpoint too: what is resumed takes the same steps, to the last bit.
                  at.solver = solver.checkpoint();
                  solver.restore(at.solver);
                  return at;
                }});
  };
  if (!from) observe(bodies.contact->report(solver.state()));
  while (!at.over) {
    solver.advance(solver.time() + options.step_max);
    const fem::ContactReport report = bodies.contact->report(solver.state());
    add_step(at, bodies, solver.state(), report, gap0, o.after);
    out.counts = before + solver.counts();
    observe(report);
    check_balance(solver.ledger(), solver.time(), bodies.contact_time, at.touched);
  }
  const fem::MeanMotion motion = bodies.ball->motion(solver.state());
  out.ball_velocity = motion.velocity;
  out.ball_spin = inertia.inverse() * motion.angular_momentum;
  out.contact_time = at.release.end().value_or(at.last_touch);
  out.peak_force = at.force.value;
  out.peak_time = at.force.time;
  out.compression = at.compression.value;
  out.face_travel = at.face_travel.value;
  out.dissipated = bodies.ball->dissipated();
  out.ledger = solver.ledger();
  out.last = solver.state();
  return out;
}

}  // namespace

void FeImpactOptions::resolve(Accuracy accuracy) {
  struct Level {
    int sector, harmonics, antisymmetric, steps;
  };
  // Of the ball's motion little is across the plane of the slip: one harmonic less there moves speed, angles and spin
  // by 0.02 %.
  const auto [sector, order, across, steps] = accuracy == Accuracy::look       ? Level{2, 2, 2, 30}
                                              : accuracy == Accuracy::standard ? Level{3, 4, 3, 60}
                                                                               : Level{4, 6, 5, 120};
  mesh.sector = mesh.rings = sector;
  harmonics = order;
  antisymmetric = across;
  steps_per_contact = steps;
}

std::optional<FeImpactOptions> FeImpactOptions::coarser() const {
  if (mesh.sector < 2 || mesh.rings < 2 || harmonics < 4 || antisymmetric < 3 || steps_per_contact < 40) return {};
  FeImpactOptions out = *this;
  --out.mesh.sector, --out.mesh.rings;
  out.harmonics -= 2, --out.antisymmetric;
  if (angles > 0) out.angles -= 4;
  if (contact_angles > 0) out.contact_angles = std::max(contact_angles - 6, 2 * out.harmonics + 1);
  out.steps_per_contact /= 2;
  return out;
}

std::vector<std::string> FeImpactOptions::faults() const {
  std::vector<std::string> out = ball.faults();
  for (const auto& fault : mesh.faults()) out.push_back(fault);
  if (face)
    for (const auto& fault : face->faults(harmonics == 0)) out.push_back(fault);
  if (harmonics < 0) out.emplace_back("harmonics must be at least 0");
  if (antisymmetric < 1) out.emplace_back("antisymmetric harmonics must be at least 1: less cannot turn");
  if (angles < 0 || (angles > 0 && angles < 2 * harmonics + 1))
    out.emplace_back("angles must be at least 2 N + 1 (0 chooses)");
  if (contact_angles < 0 || (contact_angles > 0 && contact_angles < 2 * harmonics + 1))
    out.emplace_back("contact_angles must be at least 2 N + 1 (0 chooses)");
  if (!fem::contact_method(method)) out.emplace_back("there is no contact method " + method);
  if (!(penetration > 0)) out.emplace_back("penetration must be positive");
  if (!(penalty > 0)) out.emplace_back("penalty must be positive");
  if (!(tangential_penalty > 0)) out.emplace_back("tangential_penalty must be positive");
  if (!(rho_inf >= 0 && rho_inf <= 1)) out.emplace_back("rho_inf must lie in [0, 1]");
  if (steps_per_contact < 10) out.emplace_back("steps_per_contact must be at least 10");
  if (!(newton_relative > 0)) out.emplace_back("newton_relative must be positive");
  if (!(after >= 0)) out.emplace_back("after must not be negative");
  return out;
}

void Release::add(double now, double normal_force, bool touching) {
  if (!touching) {
    apart = true;
    return;
  }
  if (apart) known = 0;  // it touches again
  apart = false;
  if (known == kSteps) {
    std::shift_left(time.begin(), time.end(), 1);
    std::shift_left(force.begin(), force.end(), 1);
    --known;
  }
  time[known] = now;
  force[known++] = normal_force;
}

std::optional<double> Release::end() const {
  if (known < kSteps) return {};
  std::array<double, kSteps> y{};
  double t_mean = 0, y_mean = 0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    y[k] = std::pow(std::max(force[k], 0.0), 2.0 / 3);
    t_mean += time[k] / kSteps;
    y_mean += y[k] / kSteps;
  }
  double up = 0, down = 0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    up += (time[k] - t_mean) * (y[k] - y_mean);
    down += (time[k] - t_mean) * (time[k] - t_mean);
  }
  if (!(up < 0)) return {};
  const double end = t_mean - y_mean * down / up, step = time[kSteps - 1] - time[kSteps - 2];
  // The last point lets go in the step after the last in contact; the line may miss it by a step.
  if (std::abs(end - time[kSteps - 1]) > 2 * step) return {};
  return end;
}

void FaceStress::see(const ImpactView& view) {
  if (!view.bodies.face_stresses) return;
  if (!stresses_) stresses_ = view.bodies.face_stresses();
  const FacePeak now = stresses_(view.bodies.face->unknowns(view.state));
  if (!peak_ || now.stress > peak_->stress) peak_ = now;
}

Impact::Impact(FeImpactOptions options) : options_(std::move(options)) {
  if (const auto faults = options_.faults(); !faults.empty())
    throw std::invalid_argument("fe impact: " + faults.front());
}

Impact::Impact(FeImpactOptions options, ShaftMount mount) : Impact(std::move(options)) { mount_ = std::move(mount); }

ImpactBodies Impact::assemble(const Blow& blow) const {
  if (const auto faults = blow.contact.patch.faults(); !faults.empty())
    throw std::invalid_argument("fe impact: " + faults.front());
  ImpactBodies out;
  out.frame = contact_frame(blow);
  if (mount_) assemble_club(out, blow, options_, *mount_);
  else assemble_free(out, blow, options_);
  return out;
}

FeOutcome Impact::run(const Blow& blow, const ImpactObserver& observer, const ImpactCheckpoint* from) const {
  ImpactBodies bodies = assemble(blow);
  FeOutcome out{.result = integrated(bodies, options_, observer, from)};
  FeImpactResult& r = out.result;
  if (bodies.face) r.face_energy = bodies.face->vibration(r.last, blow.club.head.mass);
  out.launch.velocity = r.ball_velocity;
  out.launch.spin = r.ball_spin;
  out.launch.contact_time = r.contact_time;
  out.launch.peak_force = r.peak_force;
  out.launch.peak_compression = r.compression;
  if (bodies.head) {
    out.launch.head_velocity = bodies.head->velocity(r.last);
    out.launch.head_spin = bodies.head->angular_velocity(r.last);
  } else {
    out.launch.velocity += blow.delivery.velocity();
    out.launch.head_velocity = blow.delivery.velocity();
  }
  out.frame = bodies.frame;
  out.mesh_axes = bodies.mesh_axes;
  return out;
}

}  // namespace hosel::models
