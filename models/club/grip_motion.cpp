#include "models/club/grip_motion.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hosel::models {
namespace {

solvers::Spline make_spline(const GripTrack& track, double smoothing) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(track.times.size()), 7);
  Eigen::Quaterniond last = track.attitudes.empty() ? Eigen::Quaterniond::Identity() : track.attitudes.front();
  for (std::size_t i = 0; i < track.times.size(); ++i) {
    Eigen::Quaterniond q = track.attitudes[i];
    if (q.dot(last) < 0) q.coeffs() = -q.coeffs();
    last = q;
    values.row(static_cast<Eigen::Index>(i)) << track.positions[i].transpose(), q.coeffs().transpose();
  }
  return smoothing > 0 ? solvers::Spline::near(track.times, values, smoothing)
                       : solvers::Spline::through(track.times, values);
}

}  // namespace

std::vector<std::string> GripTrack::faults(double longest_gap) const {
  std::vector<std::string> out;
  const auto say = [&](const char* what, double t) {
    std::ostringstream text;
    text << what << " at " << t << " s";
    out.push_back(text.str());
  };
  if (times.size() < 6) out.emplace_back("a swing needs at least six samples");
  for (std::size_t i = 0; i < times.size() && out.empty(); ++i) {
    if (!std::isfinite(times[i]) || !positions[i].allFinite() || !attitudes[i].coeffs().allFinite())
      say("a value is missing", times[i]);
    if (i == 0) continue;
    if (!(times[i] > times[i - 1])) say("time goes backwards or stands still", times[i]);
    else if (times[i] - times[i - 1] > longest_gap) say("the samples have a gap that ends", times[i]);
    else if (attitudes[i].angularDistance(attitudes[i - 1]) > M_PI / 4)
      say("the attitude jumps (Euler angles near gimbal lock, or samples too far apart)", times[i]);
  }
  return out;
}

void GripTrack::cut(double end) {
  const auto after = std::ranges::lower_bound(times, end - 1e-9);
  if (after == times.end()) return;
  const auto count = static_cast<std::size_t>(after - times.begin()) + 1;
  times.resize(count);
  positions.resize(count);
  attitudes.resize(count);
}

Eigen::Quaterniond from_yxz(double a, double b, double c) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(a, Vec3::UnitY()) * Eigen::AngleAxisd(b, Vec3::UnitX()) *
                            Eigen::AngleAxisd(c, Vec3::UnitZ()));
}

Eigen::Quaterniond from_axes(const Vec3& x, const Vec3& y, double tolerance) {
  if (!(std::abs(x.norm() - 1) <= tolerance && std::abs(y.norm() - 1) <= tolerance && std::abs(x.dot(y)) <= tolerance))
    throw std::invalid_argument("the axes of a rotation are not orthonormal");
  // Shared fairly between the two axes.
  const Vec3 z = x.cross(y).normalized(), sum = (x + y).normalized(), difference = (x - y).normalized();
  Mat3 R;
  R.col(0) = (sum + difference).normalized();
  R.col(1) = z.cross(R.col(0));
  R.col(2) = z;
  return Eigen::Quaterniond(R).normalized();
}

GripMotion::GripMotion(const GripTrack& track, double smoothing) : spline_(make_spline(track, smoothing)) {}

fem::Pose GripMotion::at(double time) const {
  const auto s = spline_.at(time);
  fem::Pose p;
  p.position = s.row(0).head<3>();
  p.velocity = s.row(1).head<3>();
  p.acceleration = s.row(2).head<3>();
  const Eigen::Quaterniond q(Eigen::Vector4d(s.row(0).tail<4>()));
  const Eigen::Quaterniond q1(Eigen::Vector4d(s.row(1).tail<4>())), q2(Eigen::Vector4d(s.row(2).tail<4>()));
  // With Q = q/n: Q* Q' = q* q'/n^2 - n'/n, so the body-frame rate is 2 vec(q* q')/n^2; its derivative
  // follows from (q* q')' = q'* q' + q* q'', whose first part is real.
  const double n2 = q.squaredNorm(), slope = 2 * q.dot(q1);
  const Vec3 rate = (q.conjugate() * q1).vec(), rate1 = (q.conjugate() * q2).vec();
  p.rotation = q.normalized();
  p.angular_velocity = 2 * rate / n2;
  p.angular_acceleration = 2 * rate1 / n2 - 2 * slope / (n2 * n2) * rate;
  return p;
}

}  // namespace hosel::models
