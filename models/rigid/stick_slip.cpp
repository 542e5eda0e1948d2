#include "models/rigid/stick_slip.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/rigid/restitution.hpp"

namespace hosel::models {
namespace {

/// Work done against the approach w = w0 - K J by an impulse that grows from J0 to J1 on a straight line.
double work(const ImpulseProblem& p, const Vec3& from, const Vec3& to, const Vec3& part) {
  return (p.contact.approach - p.mobility * (from + to) / 2).dot(part);
}

}  // namespace

StickSlipPath stick_slip_path(const Blow& blow, const ImpulseProblem& p) {
  const Vec3 n = p.contact.normal, slip = p.contact.slip();
  const Vec3 t1 = n.unitOrthogonal(), t2 = n.cross(t1);
  Eigen::Matrix<double, 3, 2> T;
  T << t1, t2;
  using Vec2 = Eigen::Vector2d;
  const Eigen::Matrix2d K_tt = T.transpose() * p.mobility * T, to_stop = K_tt.inverse();
  const Vec2 K_tn = T.transpose() * p.mobility * n, w = T.transpose() * slip;
  const double mu = blow.contact.friction;

  const Vec2 stop = to_stop * w;      // tangential impulse that stops the slip at once
  const Vec2 hold = -to_stop * K_tn;  // per normal impulse, while sticking
  const double K_nn = n.dot(p.mobility * n);
  const double approach = p.contact.closing_speed();

  // Sliding ends at p_s where stop / p_s + hold = mu d with |d| = 1: a quadratic in q = 1 / p_s.
  double p_slide = 0;
  Vec2 slide = Vec2::Zero();  // mu d
  if (std::isinf(mu)) {
    slide = stop;  // an impulse, at once
  } else if (mu == 0) {
    p_slide = INFINITY;  // nothing stops it
  } else if (stop.norm() > 0) {
    const double a = stop.squaredNorm(), b = stop.dot(hold), c = hold.squaredNorm() - mu * mu;
    const double inner = b * b - a * c, q = inner >= 0 ? (-b + std::sqrt(inner)) / a : 0;
    p_slide = q > 0 ? 1 / q : INFINITY;
    slide = q > 0 ? Vec2(stop * q + hold) : Vec2(mu * w.normalized());
  }
  // Normal approach falls by these per normal impulse, sliding and sticking.
  const double sliding = K_nn + K_tn.dot(slide), sticking = K_nn + K_tn.dot(hold);
  const double distance = std::hypot(blow.delivery.impact_toe, blow.delivery.impact_high);
  const double e = normal_restitution(blow.contact, approach, distance);

  StickSlipPath out;
  Vec2 tangential;
  double closing;  // p_c
  Vec3 at_slide_end = Vec3::Zero();
  if (std::isinf(mu)) {
    closing = (approach - K_tn.dot(stop)) / sticking;
    out.normal_impulse = (1 + e) * closing;
    at_slide_end = T * stop;
    tangential = stop + out.normal_impulse * hold;
  } else {
    closing = p_slide * sliding >= approach ? approach / sliding : p_slide + (approach - p_slide * sliding) / sticking;
    if (!(closing > 0 && std::isfinite(closing)))
      throw std::invalid_argument("stick-slip: friction jams the contact (sliding does not close it)");
    out.normal_impulse = (1 + e) * closing;
    const double slid = std::min(p_slide, out.normal_impulse);
    if (slid < out.normal_impulse && hold.norm() > mu)
      throw std::invalid_argument("stick-slip: friction is too small to hold the ball once it rolls");
    at_slide_end = slid * n + T * (slid * slide);
    tangential = slid * slide + (out.normal_impulse - slid) * hold;
    out.rolling_from = slid / out.normal_impulse;
  }
  const Vec3 rolled = out.normal_impulse * n + T * tangential;

  // What comes back, up to Coulomb's limit on the whole tangential impulse.
  double share = blow.contact.tangential_restitution;
  if (std::isfinite(mu) && share > 0) {
    const double limit = mu * out.normal_impulse;
    const double a = stop.squaredNorm(), b = stop.dot(tangential), c = tangential.squaredNorm() - limit * limit;
    if (out.rolling_from >= 1) share = 0;
    else if (a > 0) share = std::min(share, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a);
  }
  if (out.rolling_from >= 1) share = 0;
  out.tangential_restitution = share;
  out.impulse = rolled + T * (share * stop);

  const auto normal_part = [&](const Vec3& v) { return Vec3(n.dot(v) * n); };
  const Vec3 second = rolled - at_slide_end, third = out.impulse - rolled;
  out.lost_normal = work(p, Vec3::Zero(), at_slide_end, normal_part(at_slide_end)) +
                    work(p, at_slide_end, rolled, normal_part(second));
  out.lost_friction = work(p, Vec3::Zero(), at_slide_end, at_slide_end - normal_part(at_slide_end));
  out.lost_tangential = work(p, at_slide_end, rolled, second - normal_part(second)) +
                        work(p, rolled, out.impulse, third);
  return out;
}

Launch StickSlip::launch(const Blow& blow) const {
  const ImpulseProblem p = impulse_problem(blow);
  return launch_after(blow, p, stick_slip_path(blow, p).impulse);
}

}  // namespace hosel::models
