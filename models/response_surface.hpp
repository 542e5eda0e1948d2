/// A slow model made quick: the closed-form eccentric impact plus a polynomial fitted to what the slow model answers
/// beyond it, with its error.
///
/// An impact knows no direction but its own: everything is seen in the face frame, where a delivery is the head's
/// speed, the direction of its velocity (two angles) and the point of impact. Differences are divided by the speed.
/// What an effect changes in ball, head or contact law acts through the closed form.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hosel/models/impact_model.hpp"

namespace hosel::models {

class ResponseSurface final : public ImpactModel {
 public:
  /// Asks `slow` about the club and ball of `blow` at every delivery (in parallel). The degree, 1 to 3, is the one
  /// with the least error when each answer is predicted from the others. Throws std::invalid_argument on fewer than
  /// eight deliveries, and what `slow` throws.
  ResponseSurface(const ImpactModel& slow, const Blow& blow, const std::vector<Delivery>& deliveries);

  Launch launch(const Blow& blow) const override;

  int degree() const { return degree_; }
  /// Root mean square of the error of each answer predicted from the others: ball's velocity and spin, then the
  /// head's, face axes, three each [m/s, rad/s].
  const Eigen::Matrix<double, 12, 1>& error() const { return error_; }
  /// The same predictions, one launch per delivery, for errors of any channel.
  const std::vector<Launch>& predicted() const { return predicted_; }
  const std::vector<Launch>& answers() const { return answers_; }

 private:
  using Vec5 = Eigen::Matrix<double, 5, 1>;
  Eigen::RowVectorXd terms(const Delivery& d, int degree) const;

  Vec5 middle_, half_;
  int degree_ = 1;
  Eigen::MatrixXd coefficients_;  // terms x 12
  Eigen::Matrix<double, 12, 1> error_;
  std::vector<Launch> predicted_, answers_;
};

}  // namespace hosel::models
