/// An elastic ball against a rigid wall, and what it does there: for comparison with theory.
#pragma once

#include <cmath>

#include "golf/units.hpp"
#include "models/fe/impact.hpp"

namespace hosel::test {

/// After contact, in the wall's frame; tangential figures along the incoming slip.
struct Bounce {
  double v_n = 0, v_t = 0;    ///< of the centre [m/s]
  double rim = 0;             ///< radius times spin, rolling along the slip positive [m/s]
  double contact_time = 0;    ///< [s]
  double peak_force = 0;      ///< normal [N]
  double approach = 0;        ///< largest, of the centre [m]
  double pull = 0, push = 0;  ///< extremes of the tangential force: against the slip, then along it [N]
  double friction_ratio = 0;  ///< largest resultant tangential over normal force
  double impulse_ratio = 0;   ///< of the tangential and the normal impulse
  double closure = 0;         ///< of the energy ledger, over the initial energy
};

/// `v_n` and `v_t` are the speeds of the ball's centre towards the wall and along it [m/s].
inline Bounce bounce(const models::FeImpactOptions& options, double v_n, double v_t, double friction = 0.4) {
  Blow blow;
  blow.contact.patch.coefficient = friction;
  blow.club.head.mass = INFINITY;
  blow.delivery.club_speed = std::hypot(v_n, v_t);
  blow.delivery.club_path = std::atan2(v_t, v_n);
  const models::ContactFrame e = models::contact_frame(blow);
  const Vec3 v0 = -blow.delivery.velocity();
  const Vec3 slip = v_t > 0 ? Vec3((v0 - v0.dot(e.normal) * e.normal).normalized()) : e.ball_axes.col(1);
  Bounce out;
  const models::FeOutcome answer = models::Impact(options).run(blow, [&](const models::ImpactView& view) {
    const double along = view.report.force.dot(slip), normal = view.report.normal_force;
    out.pull = std::max(out.pull, -along);
    out.push = std::max(out.push, along);
    if (normal > 0) out.friction_ratio = std::max(out.friction_ratio, std::abs(along) / normal);
  });
  const models::FeImpactResult& r = answer.result;
  out.v_n = r.ball_velocity.dot(e.normal);
  out.v_t = r.ball_velocity.dot(slip);
  out.rim = blow.ball.radius * r.ball_spin.dot(e.normal.cross(slip));
  out.contact_time = r.contact_time;
  out.peak_force = r.peak_force;
  out.approach = r.compression;
  out.impulse_ratio = (v_t - out.v_t) / (v_n + out.v_n);
  out.closure = r.ledger.closure / r.ledger.initial;
  return out;
}

}  // namespace hosel::test
