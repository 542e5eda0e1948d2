#include "models/fe/plate_strike.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "golf/dense.hpp"
#include "golf/units.hpp"
#include "solvers/errors.hpp"

namespace hosel::models {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

constexpr double kFirstTouch = 0.8;  // of the change of speed: below, two touches are as one tap no more

}  // namespace

PlateStrike::PlateStrike(std::shared_ptr<const PlateFace> plate, const Head& head)
    : plate_(std::move(plate)), head_(head) {
  const Eigen::MatrixXd& modes = plate_->modes();
  const Index n = modes.cols(), rigid = std::isinf(head.mass) ? 0 : 6;
  if (!(plate_->mass() < head.mass)) throw std::invalid_argument("the face's mass is part of the head's");
  const Eigen::Map<const Eigen::VectorXd> omega(plate_->omega().data(), n);
  if (rigid == 0) {
    omega_ = plate_->omega();
    elastic_ = Eigen::MatrixXd::Identity(n, n);
    rigid_.resize(n, 0);
    return;
  }
  // Kinetic energy of the head's velocity and spin about its centre of gravity, and of the modes, with their coupling.
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(6 + n, 6 + n), K = M;
  M.topLeftCorner<3, 3>() = head.mass * Mat3::Identity();
  M.block<3, 3>(3, 3) = head.inertia;
  M.bottomRightCorner(n, n).setIdentity();
  K.bottomRightCorner(n, n) = omega.cwiseAbs2().asDiagonal();
  for (const auto& s : plate_->plate().samples()) {
    Eigen::VectorXd shape = Eigen::VectorXd::Zero(n);
    plate_->plate().deflections(s.element, [&](int k, Index dof) { shape += s.shape[k] * modes.row(dof).transpose(); });
    const Vec3 arm = plate_->curvature().point(s.place.x(), s.place.y()) - head.cg;
    M.block(0, 6, 1, n) -= s.mass * shape.transpose();
    M.block(3, 6, 3, n) -= s.mass * arm.cross(Vec3::UnitX()) * shape.transpose();
  }
  M.bottomLeftCorner(n, 6) = M.topRightCorner(6, n).transpose();
  if (!dense::Cholesky(M).positive()) throw std::invalid_argument("the face's inertia is part of the head's");
  const dense::Eigenpairs all = dense::eigenpairs(K, M);
  if (!all.converged) throw solvers::NonConvergence("the modes of the face and its head did not converge");
  rigid_ = all.vectors.leftCols(6);
  elastic_ = all.vectors.rightCols(n);
  for (Index i = 0; i < n; ++i) omega_.push_back(std::sqrt(all.values[6 + i]));
}

PlateStrike::Place PlateStrike::at(const Vector2d& where, double radius) const {
  Place out;
  const fem::Vector load = plate_->patch_load(where, radius);
  const Eigen::VectorXd shapes = plate_->modes().transpose() * load;
  const Index n = shapes.size(), rigid = elastic_.rows() - n;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(elastic_.rows());
  b.tail(n) = -shapes;
  out.mass = head_.mass;
  if (rigid > 0) {
    b.head<3>() = Vec3::UnitX();
    b.segment<3>(3) = (plate_->curvature().point(where.x(), where.y()) - head_.cg).cross(Vec3::UnitX());
    out.mass = 1 / (rigid_.transpose() * b).squaredNorm();
  }
  out.participation = elastic_.transpose() * b;
  out.compliance = load.dot(plate_->solve(load));
  const Eigen::Map<const Eigen::VectorXd> omega(plate_->omega().data(), n);
  out.residual = std::max(0.0, out.compliance - shapes.cwiseQuotient(omega).squaredNorm());
  return out;
}

PlateStrike::Strike PlateStrike::strike(const Striker& striker, const Place& place, double speed) const {
  // Displacements along Xc of the striker's own point and the head's, and of the vibrations; the head comes.
  const Index n = place.participation.size();
  const Eigen::Map<const Eigen::ArrayXd> omega(omega_.data(), n);
  const double fastest = omega.size() ? omega.maxCoeff() : 0;
  const double step = std::min(0.25e-6, fastest > 0 ? 0.2 / fastest : 0.25e-6);
  const Eigen::ArrayXd b = place.participation.array(), damped = plate_->design().damping * omega * step,
                       spring = omega.square() * step;
  const double per_striker = 1 / striker.mass, per_head = std::isinf(place.mass) ? 0 : 1 / place.mass;
  Eigen::ArrayXd q = Eigen::ArrayXd::Zero(n), rate = q;
  double gap = 0, gap_rate = speed;  // head's rigid approach to the striker
  double force = 0, last_touch = 0, impulse = 0, indentation = 0;
  Strike out;
  std::vector<double> impulses{0};  // of the first touch
  bool touching = false;
  const double quiet = 0.15e-3;
  constexpr double longest = 5e-3;
  double time = 0;
  for (; time < longest; time += step) {
    const double approach = gap + (b * q).sum();
    double F = 0;
    if (approach > 0) {
      // d + residual F(d, d') = approach with d' of this step: what F leaves in d would feed back on a rate of the last
      // step and grow. F rises with d: Newton, between bounds.
      const double before = indentation;
      const auto rate_factor = [&](double d) { return std::max(0.0, 1 + striker.damping * (d - before) / step); };
      double low = 0, high = approach, d = before > 0 ? std::min(before, approach) : approach;
      for (int i = 0; i < 60; ++i) {
        const double elastic = striker.stiffness * std::pow(d, striker.exponent);
        F = elastic * rate_factor(d);
        const double error = d + place.residual * F - approach;
        (error > 0 ? high : low) = d;
        const double slope =
            1 + (F > 0 ? place.residual * (striker.exponent * F / d + elastic * striker.damping / step) : 0.0);
        double next = d - error / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - d) < 1e-13 * approach) break;
        d = next;
      }
      indentation = d;
      F = striker.stiffness * std::pow(d, striker.exponent) * rate_factor(d);
      if (!touching) ++out.touches;
      touching = true;
      last_touch = time;
    } else {
      touching = false;
      indentation = 0;
      const bool opening = gap_rate + (b * rate).sum() < 0;
      if (opening && gap_rate < 0 && time - last_touch > quiet) break;
    }
    force = F;
    // Striker and head by the force; each vibration too, half of its damping on either side of the step.
    gap_rate -= force * (per_striker + per_head) * step;
    rate = ((1 - damped) * rate - spring * q - b * (force * step)) / (1 + damped);
    gap += gap_rate * step;
    q += rate * step;
    impulse += force * step;
    if (out.touches <= 1) impulses.push_back(impulse);
  }
  if (time >= longest) throw solvers::NonConvergence("striker and face are still in contact after 5 ms");
  out.contact_time = last_touch + step;
  out.restitution = (impulse * (per_striker + per_head) - speed) / speed;
  const double first = impulses.back();
  out.first_share = first / impulse;
  const auto reached = [&](double share) {
    const auto found = std::ranges::lower_bound(impulses, share * first);
    const auto i = double(found - impulses.begin());
    const double high = *found, low = *(found - 1);
    return step * (i - (high - share * first) / (high - low));
  };
  out.rise_time = (reached(0.95) - reached(0.05)) * kPi / (std::acos(-0.9) - std::acos(0.9));
  return out;
}

CharacteristicTime PlateStrike::characteristic_time(const Striker& sphere, const Vector2d& where,
                                                    std::span<const double> speeds) const {
  const Place place = at(where, pendulum_patch(*plate_, where));
  std::vector<double> times;
  for (const double speed : speeds) {
    const Strike tap = strike(sphere, place, speed);
    if (!(tap.first_share > kFirstTouch))
      throw solvers::NonConvergence("the pendulum bounces on the vibrating face: its first touch makes " +
                                    std::to_string(std::lround(100 * tap.first_share)) +
                                    " % of the change of speed; such a face has no characteristic time");
    times.push_back(tap.rise_time);
  }
  return characteristic_line(speeds, std::move(times));
}

double pendulum_patch(const PlateFace& plate, const Vector2d& place) {
  const PlateDesign& d = plate.design();
  const double share = d.outline.share(place);
  return 0.5 * d.thickness.at(share > 1 ? Vector2d(place / share) : place, std::min(1.0, share));
}

}  // namespace hosel::models
