#include "models/club/changed_swing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golf/shaft_library.hpp"

namespace hosel::models {

std::vector<SwingSample> changed_swing(const Club& declared, const SwingOptions& as_declared, const GripMotion& motion,
                                       const ClubChange& c, double begin, double end) {
  if (c.hosel.norm() > 0 && as_declared.joint.kind != HeadJoint::Kind::rigid)
    throw std::invalid_argument("a yielding hosel is a joint of its own: state a rigid one between shaft and head");
  Club club = declared;
  club.shaft = scaled(*declared.shaft, std::exp(c.bending), std::exp(c.torsion));
  club.shaft->damping_time = declared.shaft->damping_time + c.damping_time;
  Head& head = club.head;
  head = changed(declared.head, c);
  if (c.tip_mass != 0) {
    const Vec3 hosel = club.geometry.hosel, cg = (head.mass * head.cg + c.tip_mass * hosel) / (head.mass + c.tip_mass);
    const auto steiner = [](double mass, const Vec3& arm) { return Mat3(-mass * skew(arm) * skew(arm)); };
    head.inertia += steiner(head.mass, head.cg - cg) + steiner(c.tip_mass, hosel - cg);
    head.mass += c.tip_mass;
    head.cg = cg;
  }
  SwingOptions options = as_declared;
  // A joint that yields about some axes and holds the others as a weld would.
  const double firm = 1e4 * declared.shaft->stations.back().bending_stiffness_y / declared.shaft->length();
  const auto spring = [&](const Vec3& compliance) {
    fem::JointStiffness k;
    k.translation = Vec3::Constant(1e2 * firm);
    for (int a = 0; a < 3; ++a) k.rotation[a] = compliance[a] > 0 ? std::min(firm, 1 / compliance[a]) : firm;
    return k;
  };
  if (c.hosel.norm() > 0) options.joint = {.kind = HeadJoint::Kind::spring, .stiffness = spring(c.hosel)};
  GripDrive drive{.motion = [&](double t) { return motion.at(t); }};
  if (c.clamp.norm() > 0) {
    drive.kind = GripDrive::Kind::hands;
    drive.hands = spring(c.clamp);
  }
  Swing swing(club, options, drive);
  std::vector<SwingSample> samples;
  swing.run(swing.start(begin, swing.equilibrium(begin)), end, [&](const SwingSample& s) { samples.push_back(s); });
  return samples;
}

Eigen::VectorXd sampled(const std::vector<SwingSample>& samples, const std::vector<double>& times,
                        double (*value)(const SwingSample&)) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(std::ptrdiff_t(times.size()));
  std::size_t at = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = std::clamp(times[i], samples.front().time, samples.back().time);
    while (at + 2 < samples.size() && samples[at + 1].time <= t) ++at;
    while (at > 0 && samples[at].time > t) --at;
    const std::size_t first = std::min(at > 0 ? at - 1 : 0, samples.size() >= 4 ? samples.size() - 4 : 0),
                      count = std::min<std::size_t>(4, samples.size());
    for (std::size_t a = first; a < first + count; ++a) {
      double weight = 1;
      for (std::size_t b = first; b < first + count; ++b)
        if (b != a) weight *= (t - samples[b].time) / (samples[a].time - samples[b].time);
      out[std::ptrdiff_t(i)] += weight * value(samples[a]);
    }
  }
  return out;
}

}  // namespace hosel::models
