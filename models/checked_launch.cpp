#include "models/checked_launch.hpp"

#include <cmath>
#include <optional>
#include <sstream>

#include "models/fe/impact.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/jointed_club.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/rigid_planar.hpp"
#include "models/rigid/stick_slip.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

/// What a model's blow may gain by its numerics, of the energy with which head and ball meet. A shaft that the swing
/// has loaded, or that turns with the head, gives energy which the launch does not tell.
double allowance(const ImpactModel& model, const Blow& blow) {
  if (const Impact* impact = model.impact()) return impact->whole_club() ? 0.05 : 0.005;
  if (const auto* coupled = dynamic_cast<const ShaftCoupled*>(&model))
    return coupled->loaded() || !blow.delivery.head_angular_velocity.isZero() ? 0.05 : 0.005;
  const bool closed = dynamic_cast<const RigidPlanar*>(&model) || dynamic_cast<const RigidEccentric*>(&model) ||
                      dynamic_cast<const StickSlip*>(&model) || dynamic_cast<const HertzMaw*>(&model) ||
                      dynamic_cast<const PendulumClub*>(&model) || dynamic_cast<const HingedHead*>(&model);
  return closed ? 1e-6 : 0.005;
}

/// Whether the club turns about its butt, and with a hinge at the hosel: energy is then kept in the butt's frame, and
/// the rod has a part of it.
std::optional<bool> hinged_about_butt(const ImpactModel& model) {
  if (dynamic_cast<const PendulumClub*>(&model)) return false;
  if (dynamic_cast<const HingedHead*>(&model)) return true;
  return {};
}

bool finite(const std::optional<double>& x) { return !x || std::isfinite(*x); }

/// Kinetic energy of a head [J]; of its motion alone where its inertia is not stated.
double kinetic(const Head& head, const Mat3& attitude, const Vec3& velocity, const Vec3& spin) {
  const double motion = 0.5 * head.mass * velocity.squaredNorm();
  if (!head.inertia.allFinite()) return motion;
  const Vec3 local = attitude.transpose() * spin;
  return motion + 0.5 * local.dot(head.inertia * local);
}

}  // namespace

Launch checked_launch(const ImpactModel& model, const Blow& blow) {
  const Launch launch = model.launch(blow);
  check_launch(model, blow, launch);
  return launch;
}

std::vector<Answer> checked_launches(const ImpactModel& model, std::span<const Blow> blows) {
  std::vector<Answer> answers = model.launches(blows);
  for (std::size_t k = 0; k < blows.size(); ++k) try {
      check_launch(model, blows[k], answers[k].value());
    } catch (...) { answers[k].failure = std::current_exception(); }
  return answers;
}

void check_launch(const ImpactModel& model, const Blow& blow, const Launch& l) {
  if (!l.velocity.allFinite() || !l.spin.allFinite() || !l.head_velocity.allFinite() || !l.head_spin.allFinite() ||
      !finite(l.contact_time) || !finite(l.peak_force) || !finite(l.peak_compression))
    throw solvers::NonConvergence("the answer is not finite: is the blow possible, and the club one?");
  Delivery d = blow.delivery;
  if (dynamic_cast<const RigidPlanar*>(&model)) d.club_path = d.face_angle = 0;  // it knows the plane of the loft alone
  const Head& head = blow.club.head;
  Ball ball = blow.ball;
  if (const Impact* impact = model.impact()) ball.inertia_factor = impact->options().ball.inertia_factor();
  const Mat3 attitude = d.face_to_global();
  const auto hinged = hinged_about_butt(model);
  const Vec3 frame = hinged ? butt_velocity(blow) : d.velocity();
  const bool wall = std::isinf(head.mass);  // its energy does not change in this frame
  const auto of_ball = [&](const Vec3& velocity, const Vec3& spin) {
    return 0.5 * ball.mass * (velocity - frame).squaredNorm() + 0.5 * ball.inertia() * spin.squaredNorm();
  };
  const auto of_club = [&](const Vec3& velocity, const Vec3& spin) {
    if (hinged) return jointed_energy(blow, *hinged, velocity - frame, spin);
    return wall ? 0 : kinetic(head, attitude, velocity - frame, spin);
  };
  const double meeting = 0.5 * ball.mass * d.velocity().squaredNorm(),
               before = of_ball(Vec3::Zero(), Vec3::Zero()) + of_club(d.velocity(), d.head_angular_velocity),
               after = of_ball(l.velocity, l.spin) + of_club(l.head_velocity, l.head_spin);
  if (!(after - before <= allowance(model, blow) * meeting)) {
    std::ostringstream text;
    text << "the answer has more energy than the blow: " << after << " J of " << (hinged ? "club" : "head")
         << " and ball after it, " << before << " J before, in the frame of the " << (hinged ? "butt" : "head");
    throw solvers::NonConvergence(text.str());
  }
}

}  // namespace hosel::models
