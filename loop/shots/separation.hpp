/// How far one set of effects is from another over some shots, the second free to follow the first.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "loop/shots/model.hpp"

namespace hosel::loop {

class Separation {
 public:
  explicit Separation(Eigen::Index parameters);

  /// A shot [noise units].
  struct Site {
    Eigen::VectorXd d;  ///< what the first says beyond the second, of each channel
    Eigen::MatrixXd J;  ///< of the second by its parameters
  };
  void add(const Site& s);

  /// The second where it follows best.
  struct Nearest {
    Eigen::MatrixXd covariance;  ///< of its parameters
    Eigen::VectorXd p;           ///< by how much they move
    double squared;              ///< distance that is left [noise units, squared]
  };
  Nearest nearest() const;

 private:
  Eigen::MatrixXd G_;
  Eigen::VectorXd g_;
  double dd_ = 0;
};

/// `squared` with one site more: what is left of its difference, over what the second's freedom adds to the noise.
double squared_with(const Separation::Nearest& so_far, const Separation::Site& s);

/// Whitening (ShotModel::whitening) of a shot to come, which is read in all that these are and whose noise is the mean
/// of theirs. Channels err together, as much as they share uncertain inputs.
Eigen::MatrixXd whitening_of_one(const ShotModel& model, const std::vector<int>& shots);

}  // namespace hosel::loop
