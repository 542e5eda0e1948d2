#include "fem/friction/coulomb.hpp"

#include <cmath>

namespace hosel::fem {

Friction Coulomb::at(const Slip& in, bool derivatives) const {
  Friction out;
  const double limit = coefficient_ * in.pressure, size = in.stretch.norm();
  if (stiffness_ * size <= limit) {
    out.traction = stiffness_ * in.stretch;
    out.elastic = in.stretch;
    if (derivatives) out.by_stretch = stiffness_ * Mat3::Identity();
  } else {
    const Vec3 d = in.stretch / size;
    out.sliding = true;
    out.traction = limit * d;
    out.elastic = limit / stiffness_ * d;
    out.slip = size - limit / stiffness_;
    if (derivatives) {
      out.by_pressure = coefficient_ * d;
      out.by_stretch = limit / size * (Mat3::Identity() - d * d.transpose());
    }
  }
  out.stored = 0.5 * stiffness_ * out.elastic.squaredNorm();
  return out;
}

std::vector<std::string> Coulomb::faults() const {
  std::vector<std::string> out;
  if (!(coefficient_ >= 0) || !std::isfinite(coefficient_))
    out.emplace_back("contact: friction must be at least zero and finite");
  if (!(stiffness_ > 0)) out.emplace_back("contact: Coulomb friction needs a positive tangential stiffness");
  return out;
}

}  // namespace hosel::fem
