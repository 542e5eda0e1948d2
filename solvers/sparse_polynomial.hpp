/// Sparse polynomial regression in Legendre polynomials of many inputs: few terms of many candidates, taken one at a
/// time, as many as predict left-out points best.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hosel::solvers {

/// Orthogonal matching pursuit [@omp] over products of Legendre polynomials up to a total degree (at most three), at
/// most two inputs to a product. How many terms: the number of least error in ten-fold cross-validation, the terms
/// chosen anew without each fold (the error of leaving one out, with terms that saw it chosen, promises too much).
class SparsePolynomial {
 public:
  SparsePolynomial() = default;  ///< no outputs
  /// `x`: points x inputs, in [-1, 1]; `y`: points x outputs. Each output has terms of its own.
  SparsePolynomial(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, int degree);

  /// Values of the outputs at a point.
  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const;
  int terms() const;  ///< of all outputs together
  /// How much each of so many inputs moves the outputs: root of its share of every output's variance over the box (with
  /// all terms that hold it), mean over the outputs.
  Eigen::VectorXd importance(Eigen::Index inputs) const;
  /// What was predicted of every point without the fold that it is in: points x outputs.
  const Eigen::MatrixXd& left_out() const { return left_out_; }

 private:
  struct Factor {
    int input = 0, degree = 0;
  };
  struct Term {
    std::array<Factor, 2> factors;
    double coefficient = 0;
  };
  static std::vector<Term> candidates(Eigen::Index inputs, int degree);

  std::vector<std::vector<Term>> terms_;  ///< per output
  Eigen::MatrixXd left_out_;
};

}  // namespace hosel::solvers
