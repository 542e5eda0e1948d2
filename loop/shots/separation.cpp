#include "loop/shots/separation.hpp"

#include <Eigen/Cholesky>
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

Eigen::MatrixXd whitening_of_one(const ShotModel& model, const std::vector<int>& shots) {
  const Eigen::Index m = model.width();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(m, m), count = covariance;
  for (const int i : shots) {
    std::vector<int> read;
    for (int c = 0; c < model.width(); ++c)
      if (model.observed(i, c)) read.push_back(c);
    const Eigen::MatrixXd inverse = dense::inverse(Eigen::MatrixXd(model.whitening(i)(read, read)));
    covariance(read, read) += model.count(i) * inverse * inverse.transpose();  // of one of the rows in a mean
    count(read, read).array() += 1;
  }
  for (Eigen::Index a = 0; a < m; ++a)
    for (Eigen::Index b = 0; b < m; ++b) covariance(a, b) = count(a, b) > 0 ? covariance(a, b) / count(a, b) : 0;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() !=
      Eigen::Success) {  // read in other rows each: they stand for themselves, what none has tells nothing
    const auto variance = covariance.diagonal().array();
    return Eigen::VectorXd((variance > 0).select(variance.sqrt().inverse(), 0.0)).asDiagonal();
  }
  return factor.matrixL().solve(Eigen::MatrixXd::Identity(m, m));
}

}  // namespace hosel::loop
