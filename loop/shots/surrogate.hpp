/// A slow base made quick: a sparse polynomial of what it says beyond a quicker answer, over blows and effects
/// together, with its error.
#pragma once

#include <functional>
#include <vector>

#include "hosel/golf/launch.hpp"
#include "hosel/loop/effect.hpp"
#include "hosel/solvers/sparse_polynomial.hpp"

namespace hosel::loop {

/// Ball's velocity and spin over the club speed, in the face frame.
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

class Surrogate {
 public:
  using Answer = std::function<Launch(const Shot&)>;

  /// `slow` is asked from many threads; `quick` answers first, and its head's motion is kept.
  Surrogate(Answer slow, Answer quick, int degree);

  /// Asks the slow model about these shots too, and fits anew. Shots that it finds no answer to are left out. `told`
  /// hears how many of them are done.
  void learn(const std::vector<Shot>& shots, const std::function<void(int)>& told = {});

  /// Outside the box of the shots that it learnt from, what it adds is that of the box's nearest point.
  Launch launch(const Shot& shot) const;

  int points() const { return int(shots_.size()); }
  int inputs() const { return int(features_.size()); }  ///< quantities that vary over them
  int failed() const { return failed_; }
  int terms() const { return polynomial_.terms(); }
  /// Mean square of the error of ten-fold cross-validation [(m/s)^2, (rad/s)^2 over speed^2]: zero before it has
  /// learnt.
  const Mat6& error() const { return error_; }
  /// A launch with such an error added.
  static Launch shifted(Launch launch, const Shot& shot, const Vec6& error);

 private:
  Eigen::VectorXd coordinates(const Shot& shot) const;
  void fit();

  Answer slow_, quick_;
  int degree_, failed_ = 0;
  std::vector<Shot> shots_;
  std::vector<Vec6> beyond_;           ///< what the slow model says beyond the quick one
  std::vector<std::size_t> features_;  ///< that vary over the shots
  Eigen::VectorXd middle_, half_;
  solvers::SparsePolynomial polynomial_;
  Mat6 error_ = Mat6::Zero();
};

}  // namespace hosel::loop
