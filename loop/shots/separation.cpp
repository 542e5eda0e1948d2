#include "loop/shots/separation.hpp"

#include <algorithm>
#include <utility>

#include "golf/dense.hpp"

namespace hosel::loop {

Separation::Separation(Eigen::Index parameters)
    : G_(1e-6 * Eigen::MatrixXd::Identity(parameters, parameters)), g_(Eigen::VectorXd::Zero(parameters)) {}

void Separation::add(const Site& s) {
  G_ += s.J.transpose() * s.J;
  g_ += s.J.transpose() * s.d;
  dd_ += s.d.squaredNorm();
}

Separation::Nearest Separation::nearest() const {
  const dense::Ldlt of(G_);
  Eigen::VectorXd p = of.solve(g_);
  const double squared = std::max(0.0, dd_ - g_.dot(p));
  return {of.inverse(), std::move(p), squared};
}

double squared_with(const Separation::Nearest& so_far, const Separation::Site& s) {
  const Eigen::VectorXd left = s.d - s.J * so_far.p;
  const Eigen::MatrixXd JC = s.J * so_far.covariance;
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Identity(left.size(), left.size()) + JC * s.J.transpose();
  return so_far.squared + left.dot(dense::Ldlt(spread).solve(left));
}

}  // namespace hosel::loop
