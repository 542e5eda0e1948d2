/// Degrees of freedom of the whole system on their manifold: vectors and rotations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "golf/vector.hpp"

namespace hosel::fem {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;

/// Configuration, velocity and acceleration at one time. A rotation is a unit quaternion (x, y, z, w)
/// in `q` and a material (body-frame) angular velocity in `v`; everything else is a plain number.
struct State {
  double time = 0;  ///< [s]
  Vector q;         ///< configuration, DofMap::q_size() entries
  Vector v;         ///< velocity, DofMap::size() entries
  Vector a;         ///< acceleration, DofMap::size() entries
};

/// Which entries of q, v and a belong to what. Equations, increments, v and a share one numbering.
class DofMap {
 public:
  struct Block {
    Index q = 0;     ///< first entry in State::q
    Index v = 0;     ///< first entry in State::v, State::a, residuals and increments
    Index size = 0;  ///< entries in v; a rotation has 3 (and 4 in q)
    bool rotation = false;
  };

  /// `size` plain numbers.
  Block add_vector(Index size);
  /// One rotation: 4 numbers in q, 3 elsewhere.
  Block add_rotation();

  Index size() const { return v_size_; }
  Index q_size() const { return q_size_; }
  const std::vector<Block>& blocks() const { return blocks_; }

  /// A state at rest: q = 0, rotations the identity.
  State rest() const;
  /// q o exp(dq): plain numbers add, rotations R <- R exp(dq^) with dq in the body frame.
  Vector advanced(const Vector& q, const Vector& dq) const;

 private:
  std::vector<Block> blocks_;
  Index q_size_ = 0, v_size_ = 0;
};

/// Rotation stored at `block`.
Eigen::Quaterniond rotation(const State& s, const DofMap::Block& block);
void set_rotation(State& s, const DofMap::Block& block, const Eigen::Quaterniond& r);

/// exp of so(3) as a quaternion; exact series near zero.
Eigen::Quaterniond rotation_exp(const Vec3& w);
/// log of SO(3), |w| <= pi.
Vec3 rotation_log(const Eigen::Quaterniond& r);
/// Right-trivialised tangent T(w): exp(w + dw) = exp(w) exp(T(w) dw) to first order.
Mat3 rotation_tangent(const Vec3& w);

}  // namespace hosel::fem
