#include "models/fe/fe_impact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fem/face_surface.hpp"
#include "fem/friction/coulomb.hpp"
#include "fem/friction/regularised.hpp"
#include "fem/plate_surface.hpp"
#include "fem/yielding_face.hpp"
#include "models/fe/plate_strike.hpp"
#include "models/reduced/face_strike.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

/// Contact time of an elastic sphere of mass m on a rigid plane after Hertz [s].
double hertz_time(double mass, double radius, double young, double speed) {
  const double e = young / (1 - 0.25);  // plane-strain modulus of an incompressible ball
  return 2.868 * std::pow(mass * mass / (radius * e * e * speed), 0.2);
}

}  // namespace

void FeImpactOptions::resolve(Accuracy accuracy) {
  struct Level {
    int sector, harmonics, steps;
  };
  const auto [sector, order, steps] = accuracy == Accuracy::look       ? Level{2, 2, 30}
                                      : accuracy == Accuracy::standard ? Level{3, 4, 60}
                                                                       : Level{4, 6, 120};
  mesh.sector = mesh.rings = sector;
  harmonics = antisymmetric = order;
  steps_per_contact = steps;
}

std::optional<FeImpactOptions> FeImpactOptions::coarser() const {
  if (mesh.sector < 2 || mesh.rings < 2 || harmonics < 4 || antisymmetric < 3 || steps_per_contact < 40) return {};
  FeImpactOptions out = *this;
  --out.mesh.sector, --out.mesh.rings;
  out.harmonics -= 2, out.antisymmetric -= 2;
  if (angles > 0) out.angles -= 4;
  if (contact_angles > 0) out.contact_angles = std::max(contact_angles - 6, 1);
  out.steps_per_contact /= 2;
  return out;
}

std::vector<std::string> FeImpactOptions::faults() const {
  std::vector<std::string> out = ball.faults();
  for (const auto& fault : mesh.faults()) out.push_back(fault);
  if (face)
    for (const auto& fault : face->faults()) out.push_back(fault);
  if (face && plate) out.emplace_back("a face is lumped or a plate, not both");
  if (plate)
    for (const auto& fault : plate->design().faults()) out.push_back(fault);
  if (plate && harmonics == 0) out.emplace_back("harmonics = 0 is the axisymmetric ball: it meets no plate");
  if (harmonics < 0) out.emplace_back("harmonics must be at least 0");
  if (antisymmetric < 1) out.emplace_back("antisymmetric harmonics must be at least 1: less cannot turn");
  if (angles < 0 || (angles > 0 && angles < 2 * harmonics + 1))
    out.emplace_back("angles must be at least 2 N + 1 (0 chooses)");
  if (contact_angles < 0) out.emplace_back("contact_angles must not be negative");
  if (!(friction >= 0) || !std::isfinite(friction)) out.emplace_back("friction must be at least zero and finite");
  if (static_friction && !(static_friction->coefficient >= friction))
    out.emplace_back("static friction must be at least that of sliding");
  if (static_friction && transition_speed)
    out.emplace_back("friction regularised by velocity knows no sticking, and so no static friction");
  if (!(penalty > 0)) out.emplace_back("penalty must be positive");
  if (!(tangential_penalty > 0)) out.emplace_back("tangential_penalty must be positive");
  if (!(rho_inf >= 0 && rho_inf <= 1)) out.emplace_back("rho_inf must lie in [0, 1]");
  if (steps_per_contact < 10) out.emplace_back("steps_per_contact must be at least 10");
  if (!(newton_relative > 0)) out.emplace_back("newton_relative must be positive");
  if (!(after >= 0)) out.emplace_back("after must not be negative");
  return out;
}

Encounter encounter(const Blow& blow) {
  const Delivery& d = blow.delivery;
  const Head& head = blow.club.head;
  Encounter e{first_contact(blow)};
  e.normal_speed = e.closing_speed();
  const Vec3 slip = e.slip(), &arm = e.head_arm;
  const bool sliding = slip.norm() > 1e-12 * e.approach.norm();
  const bool wall = std::isinf(head.mass);
  Vec3 across = arm - arm.dot(e.normal) * e.normal;  // of the head's centre: the other direction that matters
  const bool central = wall || across.norm() <= 1e-9 * (arm.norm() + blow.ball.radius);
  const bool curved = std::isfinite(head.face.bulge) || std::isfinite(head.face.roll);
  const double tolerance = 1e-9;

  Vec3 direction = sliding ? Vec3(slip) : !central ? across : Vec3(e.face_axes.col(2));
  direction = (direction - direction.dot(e.normal) * e.normal).normalized();
  e.ball_axes.col(0) = -e.normal;
  e.ball_axes.col(1) = direction;
  e.ball_axes.col(2) = e.ball_axes.col(0).cross(direction);
  const Vec3 m = e.ball_axes.col(2);

  // Symmetric about the plane of normal and slip: velocities, arm, inertia and curved face all are.
  const Mat3 inertia = wall ? Mat3(Mat3::Identity()) : e.head_inertia;
  const Vec3 coupling = inertia * m - m.dot(inertia * m) * m;
  const Vec3& w = d.head_angular_velocity;
  e.planar = (wall || std::abs(arm.dot(m)) <= tolerance) && (w - w.dot(m) * m).norm() <= tolerance &&
             (wall || coupling.norm() <= 1e-6 * inertia.trace() || std::isinf(inertia.trace())) &&
             std::abs(d.velocity().dot(m)) <= tolerance * (1 + d.club_speed);
  const Vec3 local = e.face_axes.transpose() * m;
  const bool aligned = std::abs(local.y()) < tolerance || std::abs(local.z()) < tolerance;
  e.principal = aligned && std::abs((e.point - e.face_centre).dot(m)) <= tolerance;
  e.planar = e.planar && (!curved || e.principal);
  e.across_heel_toe = std::abs(local.y()) >= tolerance;
  e.axial = !sliding && central && !curved && w.norm() == 0 &&
            (wall || head.inertia.allFinite() || std::isinf(head.inertia.trace()));
  return e;
}

double expected_turn(const Blow& blow, const FeImpactOptions& o) {
  const Encounter e = encounter(blow);
  const Ball& ball = blow.ball;
  const double slip = (e.approach - e.normal_speed * e.normal).norm();
  const double gripping = 1.3 * slip / (1 + 1 / ball.inertia_factor + ball.mass / blow.club.head.mass),
               sliding = 1.8 * o.friction * e.normal_speed;
  const double spin = std::min(gripping, sliding) / (ball.inertia_factor * ball.radius);
  return 0.8 * spin * hertz_time(ball.mass, ball.radius, o.ball.instant_young(), e.normal_speed);
}

Mat3 mesh_axes(const Blow& blow, const FeImpactOptions& o) {
  const Mat3 axes = encounter(blow).ball_axes;
  const double tilt = o.tilt.value_or(o.harmonics == 0 ? 0 : expected_turn(blow, o) / 2);
  return Eigen::AngleAxisd(-tilt, axes.col(2)).toRotationMatrix() * axes;
}

BallOnFace add_ball(fem::System& system, const Blow& blow, const FeImpactOptions& o, const fem::SurfaceCarrier& carrier,
                    bool free) {
  if (const auto faults = o.faults(); !faults.empty()) throw std::invalid_argument("fe impact: " + faults.front());
  const Encounter e = encounter(blow);
  const double R = blow.ball.radius;
  std::vector<double> radii;
  std::vector<fem::Solid> materials;
  for (const BallLayer& layer : o.ball.layers) {
    radii.push_back(layer.radius * R);
    materials.push_back(layer.material);
  }
  const mesh::Meridian meridian = mesh::sphere_meridian(radii, o.mesh);

  const bool axial = o.harmonics == 0;
  const std::shared_ptr<const PlateFace> plate = o.plate ? o.plate->on(blow.club.head.face) : nullptr;
  const Mirror mirror = e.planar && e.principal && !free ? e.mirror() : Mirror::none;
  const bool planar = !axial && e.planar && !free && (!o.face || e.principal) && (!plate || plate->symmetric(mirror));
  if (plate && !(plate->mass() < blow.club.head.mass))
    throw std::invalid_argument("fe impact: the face's mass is part of the head's and must be smaller");
  if (o.face && !(o.face->mass < blow.club.head.mass))
    throw std::invalid_argument("fe impact: the face's effective mass is part of the head's and must be smaller");
  if (axial && o.face) {
    const bool everywhere = std::isinf(o.face->half_width) && std::isinf(o.face->half_height),
               centre = blow.delivery.impact_toe == 0 && blow.delivery.impact_high == 0;
    if (!everywhere && !(centre && o.face->half_width == o.face->half_height))
      throw std::invalid_argument(
          "fe impact: harmonics = 0 is the axisymmetric ball: a yielding face must be as wide as high and struck at "
          "its "
          "centre");
  }
  const fem::FourierBasis basis = axial    ? fem::axisymmetric_basis()
                                  : planar ? fem::cartesian_basis(o.harmonics)
                                           : fem::cartesian_basis(o.harmonics, std::min(o.antisymmetric, o.harmonics));
  const int angles = o.angles > 0 ? o.angles : 2 * o.harmonics + 4;
  const int patch = o.contact_angles > 0 ? o.contact_angles : 3 * o.harmonics + 8;
  const auto rule = [&](int half) {
    return axial ? fem::single_angle() : planar ? fem::half_circle(half) : fem::full_circle(2 * half);
  };
  fem::Placement placement{Vec3::Zero(), e.ball_axes};
  placement.axes = mesh_axes(blow, o);

  // The mesh weighs what the ball weighs, layer by layer in proportion to the densities given.
  const auto mass_of = [&](const std::vector<fem::Solid>& m) {
    fem::DofMap dof_map;
    return fem::HarmonicSolid(dof_map, meridian, fem::axisymmetric_basis(), {fem::single_angle(), 2}, m, placement)
        .mass();
  };
  const double scale = blow.ball.mass / mass_of(materials);
  for (fem::Solid& m : materials) m.density *= scale;

  auto ball = std::make_unique<fem::HarmonicSolid>(system.dof_map, meridian, basis,
                                                   fem::SolidQuadrature{rule(angles), 2}, materials, placement);
  fem::ContactLaws laws{o.penalty * o.ball.instant_young() / R, nullptr};
  if (!axial && o.friction > 0) {
    const double sticking = o.tangential_penalty * laws.normal_stiffness;
    if (o.transition_speed) laws.friction = std::make_unique<fem::RegularisedFriction>(o.friction, *o.transition_speed);
    else if (o.static_friction)
      laws.friction = std::make_unique<fem::SlipWeakening>(o.friction, *o.static_friction, sticking);
    else laws.friction = std::make_unique<fem::Coulomb>(o.friction, sticking);
  }
  const fem::Symmetry symmetry = axial ? fem::Symmetry::axis : planar ? fem::Symmetry::plane : fem::Symmetry::none;
  BallOnFace parts{.ball = ball.get()};
  const Face& face = blow.club.head.face;
  std::unique_ptr<const fem::ContactSurface> surface;
  std::unique_ptr<fem::FaceSpring> spring;
  if (o.face) {
    const fem::DofMap::Block travel = system.dof_map.add_vector(1);
    surface = std::make_unique<fem::YieldingFace>(face, *o.face, travel);
    spring = std::make_unique<fem::FaceSpring>(fem::ReducedFace::lumped(*o.face), carrier, travel);
    parts.face = spring.get();
    const double shape = o.face->shape(-blow.delivery.impact_toe, blow.delivery.impact_high).value;
    parts.compliance = shape * shape / o.face->stiffness;
  } else if (plate) {
    const Eigen::Vector2d place(-blow.delivery.impact_toe, blow.delivery.impact_high);
    parts.plate = plate;
    const CondensedPlate& condensed = parts.condensed.emplace(plate->condensed(place, planar ? mirror : Mirror::none));
    const fem::DofMap::Block unknowns = system.dof_map.add_vector(condensed.face.size());
    surface = std::make_unique<fem::PlateSurface>(face, condensed.shapes, condensed.largest, unknowns);
    spring = std::make_unique<fem::FaceSpring>(condensed.face, carrier, unknowns);
    parts.face = spring.get();
    parts.compliance = plate->compliance(place, kBallPatch);
  } else {
    surface = std::make_unique<fem::FaceSurface>(face);
  }
  auto contact = std::make_unique<fem::Contact>(*ball, std::move(surface), carrier, std::move(laws), rule(patch),
                                                symmetry, o.edge_points);
  parts.contact = contact.get();
  system.terms.push_back(std::move(ball));
  system.terms.push_back(std::move(contact));
  if (spring) system.terms.push_back(std::move(spring));
  return parts;
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

FeImpactResult run_impact(fem::System& system, const BallOnFace& parts, fem::State initial, const FeImpactOptions& o,
                          double approach_speed, const ImpactObserver& observer, const ImpactCheckpoint* from) {
  parts.contact->start(initial);
  const double mass = parts.ball->mass(), radius = parts.ball->mesh().radius;
  const double expected = hertz_time(mass, radius, o.ball.instant_young(), approach_speed) *
                          contact_on_face(parts.compliance);
  const double step = expected / o.steps_per_contact;

  solvers::GeneralizedAlphaOptions options;
  options.rho_inf = o.rho_inf;
  options.newton.residual_relative = o.newton_relative;
  // The gradient F holds strains to machine precision and no better: what that is in forces counts in very slow blows.
  // On 21,000 unknowns residuals wandered from 5 to 113 eps of modulus times radius squared, half of them below 18.
  double stiffest = 0;
  for (const fem::Solid& m : parts.ball->materials())
    stiffest = std::max(stiffest, m.bulk() + 4.0 / 3 * m.instant_shear());
  options.newton.residual_absolute = 1e-3 * o.newton_relative * mass * approach_speed / expected +
                                     64 * std::numeric_limits<double>::epsilon() * stiffest * radius * radius;
  options.newton.increment_vector = 1e-4 * approach_speed * step;
  options.newton.increment_rotation = 1e-4 * approach_speed * step / radius;
  options.newton.max_iterations = 60;
  options.newton.renew_above = 0.12;
  options.step_max = step;
  options.step_first = step / 16;  // the first touch is the roughest part
  options.step_min = step / 1024;
  options.predict_acceleration = false;
  options.error_vector = options.error_rotation = INFINITY;

  const Mat3 inertia = parts.ball->motion(system.dof_map.rest()).inertia;
  const double gap0 = parts.contact->centre_gap(initial);
  solvers::GeneralizedAlpha solver(system, options, std::move(initial));
  ImpactCheckpoint at{.last_gap = gap0};
  if (from) {
    at = *from;
    solver.restore(from->solver);
  }
  FeImpactResult& out = at.so_far;
  const solvers::GeneralizedAlpha::Counts before = out.counts;
  const auto observe = [&](const fem::ContactReport& report) {
    if (observer)
      observer({system, solver.state(), *parts.ball, *parts.contact, report, solver.ledger(),
                parts.contact->surface_pose(solver.state()), expected, parts.shaft, &parts, [&] {
                  // This run goes on from its checkpoint too: what is resumed takes the same steps, to the last bit.
                  at.solver = solver.checkpoint();
                  solver.restore(at.solver);
                  return at;
                }});
  };
  if (!from) observe(parts.contact->report(solver.state()));

  while (!at.over) {
    solver.advance(solver.time() + step);
    const fem::ContactReport report = parts.contact->report(solver.state());
    const double now = solver.time();
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
    const double gap = parts.contact->centre_gap(solver.state());
    const bool leaving = gap > at.last_gap;  // a stiff skin may bounce while the ball still comes nearer
    at.last_gap = gap;
    at.compression.add(now, gap0 - gap);
    out.penetration = report.penetration;
    if (parts.face) at.face_travel.add(now, parts.face->travel(solver.state()));
    out.creep = report.elastic_slip;
    out.counts = before + solver.counts();
    at.over = at.touched && leaving && report.points == 0 && now >= at.last_touch * (1 + o.after);
    observe(report);
    if (!(std::abs(solver.ledger().closure) <= 0.05 * solver.ledger().initial)) {
      std::ostringstream text;
      text << "at t = " << now << " s the energy of the impact is out of balance by "
           << 100 * solver.ledger().closure / solver.ledger().initial
           << " % of what it began with: take more steps_per_contact or a lower rho_inf";
      throw solvers::NonConvergence(text.str());
    }
    if (now > 20 * expected) {
      std::ostringstream text;
      text << "ball and face " << (at.touched ? "are still in contact" : "have not met") << " after " << now
           << " s, twenty times the time that Hertz's theory expects: is the ball far too soft or viscous?";
      throw solvers::NonConvergence(text.str());
    }
  }
  const fem::MeanMotion motion = parts.ball->motion(solver.state());
  out.ball_velocity = motion.velocity;
  out.ball_spin = inertia.inverse() * motion.angular_momentum;
  out.contact_time = at.release.end().value_or(at.last_touch);
  out.peak_force = at.force.value;
  out.peak_time = at.force.time;
  out.compression = at.compression.value;
  out.face_travel = at.face_travel.value;
  out.dissipated = parts.ball->dissipated();
  out.ledger = solver.ledger();
  out.last = solver.state();
  return out;
}

void FaceStress::see(const ImpactView& view) {
  if (!view.parts->plate) return;
  if (!stresses_) stresses_.emplace(view.parts->plate->plate(), view.parts->condensed->fields);
  const PlateFace::Peak now = stresses_->peak(view.parts->face->unknowns(view.state));
  if (!peak_ || now.stress > peak_->stress) peak_ = now;
}

Launch launch_of(const FeImpactResult& result) {
  Launch l;
  l.velocity = result.ball_velocity;
  l.spin = result.ball_spin;
  l.contact_time = result.contact_time;
  l.peak_force = result.peak_force;
  l.peak_compression = result.compression;
  return l;
}

FreeBodyImpact assemble_free_body(const Blow& blow, const FeImpactOptions& options) {
  FreeBodyImpact out;
  out.encounter = encounter(blow);
  const Encounter& e = out.encounter;
  const Head& head = blow.club.head;
  const bool wall = std::isinf(head.mass);
  if (options.harmonics == 0 && !e.axial && !wall)
    throw std::invalid_argument(
        "fe impact: harmonics = 0 is the axisymmetric ball: a blow with loft, offset or curved face needs harmonics of "
        "2 or more");
  if (options.harmonics == 0 && (e.approach - e.normal_speed * e.normal).norm() > 1e-9 * e.normal_speed)
    throw std::invalid_argument("fe impact: harmonics = 0 is the axisymmetric ball: it cannot be struck obliquely");
  fem::SurfaceCarrier carrier;
  fem::DofMap::Block x, r;
  if (wall) {
    // In the wall's frame: it stands, the ball comes.
    carrier.position = e.face_centre;
    carrier.attitude = e.face_axes;
  } else {
    if (const auto faults = head.faults(); !faults.empty()) throw std::invalid_argument("fe impact: " + faults.front());
    x = out.system.dof_map.add_vector(3);
    r = out.system.dof_map.add_rotation();
    carrier.translation = x;
    carrier.rotation = r;
    carrier.centre = -head.cg;
    auto body =
        std::make_unique<fem::RigidBody>("head", x, r, fem::RigidBodyProperties{head.mass, head.inertia, Vec3::Zero()});
    out.head = body.get();
    out.system.terms.push_back(std::move(body));
  }
  out.parts = add_ball(out.system, blow, options, carrier, false);
  out.initial = out.system.dof_map.rest();
  if (wall) {
    out.parts.ball->set_velocity(out.initial, -blow.delivery.velocity(), Vec3::Zero());
  } else {
    out.initial.q.segment<3>(x.q) = e.face_centre + e.face_axes * head.cg;
    fem::set_rotation(out.initial, r, Eigen::Quaterniond(e.face_axes));
    out.initial.v.segment<3>(x.v) = blow.delivery.velocity();
    out.initial.v.segment<3>(r.v) = e.face_axes.transpose() * blow.delivery.head_angular_velocity;
  }
  return out;
}

FeOutcome solve_free_body(const Blow& blow, const FeImpactOptions& options, const ImpactObserver& observer,
                          const ImpactCheckpoint* from) {
  FreeBodyImpact impact = assemble_free_body(blow, options);
  FeOutcome out;
  out.result =
      run_impact(impact.system, impact.parts, impact.initial, options, impact.encounter.normal_speed, observer, from);
  if (impact.parts.face) out.result.face_energy = impact.parts.face->vibration(out.result.last, blow.club.head.mass);
  out.launch = launch_of(out.result);
  if (impact.head) {
    out.launch.head_velocity = impact.head->velocity(out.result.last);
    out.launch.head_spin = impact.head->angular_velocity(out.result.last);
  } else {
    out.launch.velocity += blow.delivery.velocity();
    out.launch.head_velocity = blow.delivery.velocity();
  }
  return out;
}

FeFreeBody::FeFreeBody(FeImpactOptions options) : options_(std::move(options)) {
  if (const auto faults = options_.faults(); !faults.empty())
    throw std::invalid_argument("fe impact: " + faults.front());
}

FeOutcome FeFreeBody::solve(const Blow& blow, const ImpactObserver& observer, const ImpactCheckpoint* from) const {
  return solve_free_body(blow, options_, observer, from);
}

}  // namespace hosel::models
