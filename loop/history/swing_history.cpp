#include "hosel/loop/history/swing_history.hpp"

#include <algorithm>
#include <cmath>

#include "hosel/golf/shaft_library.hpp"
#include "hosel/solvers/errors.hpp"

namespace hosel::loop {

SwingHistory::SwingHistory(Club club, const models::SwingOptions& options, models::GripMotion motion, double begin,
                           std::vector<std::vector<double>> times, const std::vector<HistoryChannel>& channels)
    : club_(std::move(club)),
      options_(options),
      motion_(std::move(motion)),
      begin_(begin),
      times_(std::move(times)),
      channels_(channels) {
  end_ = begin_;
  for (const auto& t : times_) end_ = std::max(end_, t.back());
}

std::pair<double, double> SwingHistory::first_mode() const {
  const models::Bench bench(club_, true, {.shear = options_.shear, .clamped_length = options_.grip_point}, {});
  const models::BenchModes m = bench.modes({}, 1);
  return {m.omega[0], m.ratio[0]};
}

std::vector<models::SwingSample> SwingHistory::simulate(const models::ClubChange& c) const {
  Club club = club_;
  club.shaft = scaled(*club_.shaft, std::exp(c.bending), std::exp(c.torsion));
  club.shaft->damping_time = club_.shaft->damping_time + c.damping_time;
  Head& head = club.head;
  head = models::changed(club_.head, c);
  if (c.tip_mass != 0) {
    const Vec3 hosel = club.geometry.hosel, cg = (head.mass * head.cg + c.tip_mass * hosel) / (head.mass + c.tip_mass);
    const auto steiner = [](double mass, const Vec3& arm) { return Mat3(-mass * skew(arm) * skew(arm)); };
    head.inertia += steiner(head.mass, head.cg - cg) + steiner(c.tip_mass, hosel - cg);
    head.mass += c.tip_mass;
    head.cg = cg;
  }
  models::SwingOptions options = options_;
  // A joint that yields about some axes and holds the others as a weld would.
  const double firm = 1e4 * club_.shaft->stations.back().bending_stiffness_y / club_.shaft->length();
  const auto spring = [&](const Vec3& compliance) {
    fem::JointStiffness k;
    k.translation = Vec3::Constant(1e2 * firm);
    for (int a = 0; a < 3; ++a) k.rotation[a] = compliance[a] > 0 ? std::min(firm, 1 / compliance[a]) : firm;
    return k;
  };
  if (c.hosel.norm() > 0) {
    options.joint = models::HeadJoint::spring;
    options.joint_stiffness = spring(c.hosel);
    options.joint_stiffness.frame = models::face_to_grip(club.geometry).transpose();
  }
  models::GripDrive drive{.motion = [this](double t) { return motion_.at(t); }};
  if (c.clamp.norm() > 0) {
    drive.kind = models::GripDrive::Kind::hands;
    drive.hands = spring(c.clamp);
  }
  models::Swing swing(club, options, drive);
  std::vector<models::SwingSample> samples;
  swing.run(swing.start(begin_, swing.equilibrium(begin_)), end_,
            [&](const models::SwingSample& s) { samples.push_back(s); });
  return samples;
}

bool SwingHistory::answer(const Rig& rig, std::vector<Answer>& out) const {
  const models::ClubChange& c = rig.club;
  const std::vector<double> key = {c.bending,  c.torsion,    c.damping_time, c.clamp[0],  c.clamp[1], c.clamp[2],
                                   c.hosel[0], c.hosel[1],   c.hosel[2],     c.tip_mass,  c.cg[0],    c.cg[1],
                                   c.cg[2],    c.inertia[0], c.inertia[1],   c.inertia[2]};
  std::vector<models::SwingSample> samples;
  {
    const std::lock_guard lock(mutex_);
    if (const auto it = known_.find(key); it != known_.end()) samples = it->second;
  }
  if (samples.empty()) {
    try {
      samples = simulate(c);
    } catch (const solvers::NonConvergence&) { return false; } catch (const std::invalid_argument&) {
      return false;
    }
    const std::lock_guard lock(mutex_);
    if (known_.size() > 64) known_.clear();
    known_.emplace(key, samples);
  }
  const auto value = [&](const models::SwingSample& s, Reading r) {
    return r == Reading::lead         ? s.lead
           : r == Reading::droop      ? s.droop
           : r == Reading::shortening ? s.shortening
                                      : s.twist.z();
  };
  out.assign(times_.size(), {});
  for (std::size_t r = 0; r < times_.size(); ++r) {
    Eigen::MatrixXd& y = out[r].value;
    y.resize(std::ptrdiff_t(times_[r].size()), std::ptrdiff_t(channels_.size()));
    for (std::size_t k = 0; k < channels_.size(); ++k) {
      std::size_t at = 0;
      for (std::size_t i = 0; i < times_[r].size(); ++i) {
        // Cubic through four samples of the simulation; what was before the swing is its start.
        const double t = std::clamp(times_[r][i] - rig.delay[k], samples.front().time, samples.back().time);
        while (at + 2 < samples.size() && samples[at + 1].time <= t) ++at;
        while (at > 0 && samples[at].time > t) --at;
        const std::size_t first = std::min(at > 0 ? at - 1 : 0, samples.size() >= 4 ? samples.size() - 4 : 0),
                          count = std::min<std::size_t>(4, samples.size());
        double sum = 0;
        for (std::size_t a = first; a < first + count; ++a) {
          double weight = 1;
          for (std::size_t b = first; b < first + count; ++b)
            if (b != a) weight *= (t - samples[b].time) / (samples[a].time - samples[b].time);
          sum += weight * value(samples[a], channels_[k].reading);
        }
        y(std::ptrdiff_t(i), std::ptrdiff_t(k)) = sum;
      }
    }
  }
  return true;
}

}  // namespace hosel::loop
