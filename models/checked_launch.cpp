#include "hosel/models/checked_launch.hpp"

#include <cmath>
#include <sstream>

#include "hosel/solvers/errors.hpp"

namespace hosel::models {
namespace {

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
  check_launch(blow, launch);
  return launch;
}

void check_launch(const Blow& blow, const Launch& l) {
  if (!l.velocity.allFinite() || !l.spin.allFinite() || !l.head_velocity.allFinite() || !l.head_spin.allFinite() ||
      !finite(l.contact_time) || !finite(l.peak_force) || !finite(l.peak_compression))
    throw solvers::NonConvergence("the answer is not finite: is the blow possible, and the club one?");
  const Delivery& d = blow.delivery;
  const Head& head = blow.club.head;
  const Ball& ball = blow.ball;
  const Mat3 attitude = d.face_to_global();
  // A wall's own energy is infinite: what the ball has is counted in the wall's frame.
  const bool wall = std::isinf(head.mass);
  const Vec3 frame = wall ? d.velocity() : Vec3::Zero();
  const auto of_ball = [&](const Vec3& velocity, const Vec3& spin) {
    return 0.5 * ball.mass * (velocity - frame).squaredNorm() + 0.5 * ball.inertia() * spin.squaredNorm();
  };
  const double before = of_ball(Vec3::Zero(), Vec3::Zero()) +
                        (wall ? 0 : kinetic(head, attitude, d.velocity(), d.head_angular_velocity));
  const double after = of_ball(l.velocity, l.spin) + (wall ? 0 : kinetic(head, attitude, l.head_velocity, l.head_spin));
  const double allowance = blow.club.shaft ? 0.05 : 0.01;
  if (after > before * (1 + allowance)) {
    std::ostringstream text;
    text << "the answer has more energy than the blow: " << after << " J of head and ball after it, " << before
         << " J before";
    throw solvers::NonConvergence(text.str());
  }
}

}  // namespace hosel::models
