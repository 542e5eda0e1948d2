#include "models/checked_launch.hpp"

#include <cmath>
#include <sstream>

#include "models/fe/fe_full_club.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "models/rigid/hinged_head.hpp"
#include "models/rigid/pendulum_club.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

/// Whether a shaft takes part in a model's blow, so that head and ball are not alone with their energy.
bool has_shaft(const ImpactModel& model) {
  return dynamic_cast<const ShaftCoupled*>(&model) || dynamic_cast<const PendulumClub*>(&model) ||
         dynamic_cast<const HingedHead*>(&model) || dynamic_cast<const FeFullClub*>(&model);
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

void check_launch(const ImpactModel& model, const Blow& blow, const Launch& l) {
  if (!l.velocity.allFinite() || !l.spin.allFinite() || !l.head_velocity.allFinite() || !l.head_spin.allFinite() ||
      !finite(l.contact_time) || !finite(l.peak_force) || !finite(l.peak_compression))
    throw solvers::NonConvergence("the answer is not finite: is the blow possible, and the club one?");
  const Delivery& d = blow.delivery;
  const Head& head = blow.club.head;
  const Ball& ball = blow.ball;
  const Mat3 attitude = d.face_to_global();
  const Vec3 frame = d.velocity();
  const bool wall = std::isinf(head.mass);  // its energy does not change in this frame
  const auto of_ball = [&](const Vec3& velocity, const Vec3& spin) {
    return 0.5 * ball.mass * (velocity - frame).squaredNorm() + 0.5 * ball.inertia() * spin.squaredNorm();
  };
  const auto of_head = [&](const Vec3& velocity, const Vec3& spin) {
    return wall ? 0 : kinetic(head, attitude, velocity - frame, spin);
  };
  const double meeting = of_ball(Vec3::Zero(), Vec3::Zero()),
               before = meeting + of_head(frame, d.head_angular_velocity),
               after = of_ball(l.velocity, l.spin) + of_head(l.head_velocity, l.head_spin);
  if (after - before > (has_shaft(model) ? 0.05 : 0.005) * meeting) {
    std::ostringstream text;
    text << "the answer has more energy than the blow: " << after << " J of head and ball after it, " << before
         << " J before, in the frame of the head";
    throw solvers::NonConvergence(text.str());
  }
}

}  // namespace hosel::models
