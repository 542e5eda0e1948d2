/// The surrogate of a slow base: its difference from a fast model as a Gaussian process over blows and effects
/// together, with the predicted error.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "golf/launch.hpp"
#include "loop/effect.hpp"
#include "solvers/kriging.hpp"

namespace hosel::loop {

/// Its vectors of six: the ball's velocity and spin over the club speed, in the face frame.
class Surrogate {
 public:
  using Answer = std::function<Launch(const Shot&)>;

  /// `slow` is asked from many threads; `quick` answers first, and its head's motion is kept.
  Surrogate(Answer slow, Answer quick);

  /// Asks the slow model about these shots too, and fits anew. Shots that it finds no answer to are left out. `told`
  /// hears how many of them are done.
  void learn(const std::vector<Shot>& shots, const std::function<void(int)>& told = {});

  /// Outside the box of the shots that it learnt from, what it adds is that of the box's nearest point.
  Launch launch(const Shot& shot) const;

  int points() const { return int(shots_.size()); }
  int inputs() const { return int(features_.size()); }  ///< quantities that vary over them
  int failed() const { return failed_; }
  /// Of the shots it learnt last: chi-squared per output of what it had said of them before. About 1 where it had told
  /// its error truly; not a number before it has learnt twice, and where none of them had an answer.
  double surprise() const { return surprise_; }
  /// Mean square of the error to be expected of an answer [(m/s)^2, (rad/s)^2 over speed^2]: zero before it has learnt.
  Mat6 error(const Shot& shot) const;
  /// How the errors of many answers go together: entry (i, j) times `error_scale` is the covariance of the errors of
  /// shots i and j. Neighbours err alike.
  Eigen::MatrixXd errors_together(const std::vector<Shot>& shots) const;
  Mat6 error_scale() const { return process_.process(); }
  /// A launch with such an error added.
  static Launch shifted(Launch launch, const Shot& shot, const Vec6& error);

 private:
  Eigen::VectorXd coordinates(const Shot& shot) const;
  double surprise(const std::vector<Shot>& shots, const std::vector<std::optional<Vec6>>& found) const;
  void fit();

  Answer slow_, quick_;
  int failed_ = 0;
  double surprise_ = kNaN;
  std::vector<Shot> shots_;
  std::vector<Vec6> beyond_;           ///< what the slow model says beyond the quick one
  std::vector<std::size_t> features_;  ///< that vary over the shots
  Eigen::VectorXd middle_, half_;
  solvers::Kriging process_;
};

}  // namespace hosel::loop
