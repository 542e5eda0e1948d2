#include "models/club/marker_swing.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hosel::models {
namespace {

Vec3 middle(const std::array<Vec3, 3>& p) { return (p[0] + p[1] + p[2]) / 3; }

}  // namespace

Placement place(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to) {
  const Vec3 a = middle(from), b = middle(to);
  Mat3 H = Mat3::Zero();
  for (std::size_t i = 0; i < 3; ++i) H += (from[i] - a) * (to[i] - b).transpose();
  const Eigen::JacobiSVD<Mat3> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 D = Mat3::Identity();
  D(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant();
  const Mat3 R = svd.matrixV() * D * svd.matrixU().transpose();
  return {Eigen::Quaterniond(R), b - R * a};
}

MarkerSwing marker_swing(const MarkerTrack& track, double still, double end) {
  std::array<Vec3, 3> shaft0, head0;
  const auto at_address = [&](const char* what, auto point) {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (std::size_t i = 0; i < track.times.size() && track.times[i] <= still; ++i)
      if (const Vec3 x = point(i); x.allFinite()) sum += x, ++count;
    if (count == 0) throw std::invalid_argument(std::string("no sample at address has ") + what);
    return Vec3(sum / count);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    shaft0[k] = at_address("every marker of the shaft", [&](std::size_t i) { return track.shaft[i][k]; });
    head0[k] = at_address("every marker of the head", [&](std::size_t i) { return track.head[i][k]; });
  }
  const Vec3 wrists0 = at_address("the wrists", [&](std::size_t i) { return track.wrists[i]; });

  const Vec3 hosel = middle(head0), up = (wrists0 - hosel).normalized();
  MarkerSwing out;
  out.length = (middle(shaft0) - hosel).dot(up);
  const Vec3 clamp = hosel + out.length * up;
  Mat3 R;
  R.col(2) = up;
  R.col(1) = up.cross(Vec3::UnitX()).normalized();
  R.col(0) = R.col(1).cross(up);
  for (std::size_t k = 0; k < 3; ++k) out.head_reference[k] = R.transpose() * (head0[k] - clamp);

  for (std::size_t i = 0; i < track.times.size() && track.times[i] <= end + 1e-9; ++i) {
    const auto seen = [](const Vec3& x) { return x.allFinite(); };
    if (!std::ranges::all_of(track.shaft[i], seen)) continue;
    const Placement body = place(shaft0, track.shaft[i]);
    const Eigen::Quaterniond attitude = body.rotation * Eigen::Quaterniond(R);
    const Vec3 at = body.rotation * clamp + body.translation;
    out.clamp.times.push_back(track.times[i]);
    out.clamp.positions.push_back(at);
    out.clamp.attitudes.push_back(attitude);
    if (!std::ranges::all_of(track.head[i], seen)) continue;
    const Placement head = place(head0, track.head[i]);
    const Vec3 d = attitude.conjugate() * (head.rotation * hosel + head.translation - at) + Vec3(0, 0, out.length);
    out.times.push_back(track.times[i]);
    out.lead.push_back(d.x());
    out.droop.push_back(d.y());
    out.head.push_back(track.head[i]);
  }
  return out;
}

double marker_error(const MarkerSwing& swing, const GripMotion& motion, const std::vector<SwingSample>& samples,
                    double from, double to) {
  double sum = 0;
  std::size_t n = 0, at = 0;
  for (std::size_t i = 0; i < swing.times.size(); ++i) {
    const double t = swing.times[i];
    if (t < from || t > to) continue;
    const fem::Pose clamp = motion.at(t);
    Vec3 hosel(0, 0, -swing.length), shift = Vec3::Zero(), twist = Vec3::Zero();
    if (!samples.empty()) {
      while (at + 2 < samples.size() && samples[at + 1].time < t) ++at;
      const SwingSample &a = samples[at], &b = samples[std::min(at + 1, samples.size() - 1)];
      const double w = b.time > a.time ? std::clamp((t - a.time) / (b.time - a.time), 0.0, 1.0) : 0;
      shift = (1 - w) * Vec3(a.lead, a.droop, a.shortening) + w * Vec3(b.lead, b.droop, b.shortening);
      twist = (1 - w) * a.twist + w * b.twist;
    }
    const Eigen::Quaterniond turn = fem::rotation_exp(twist);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 local = hosel + shift + turn * (swing.head_reference[k] - hosel);
      sum += (clamp.position + clamp.rotation * local - swing.head[i][k]).squaredNorm();
      ++n;
    }
  }
  if (n == 0) throw std::invalid_argument("no head markers in the interval");
  return std::sqrt(sum / static_cast<double>(n));
}

}  // namespace hosel::models
