#include "solvers/spline.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hosel::solvers {
namespace {

void check(const std::vector<double>& times, const Eigen::MatrixXd& values, std::size_t least) {
  if (times.size() < least || static_cast<Eigen::Index>(times.size()) != values.rows())
    throw std::invalid_argument("a spline needs at least " + std::to_string(least) + " samples");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1])) {
      std::ostringstream text;
      text << "time goes backwards or stands still at " << times[i] << " s";
      throw std::invalid_argument(text.str());
    }
}

/// Values at the times of the functions that basis(time) tells.
template <class Basis>
Eigen::SparseMatrix<double> sampled(const std::vector<double>& times, Eigen::Index functions, const Basis& basis) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto b = basis(times[i]);
    for (int j = 0; j < 6; ++j) entries.emplace_back(static_cast<int>(i), b.first + j, b.n(0, j));
  }
  Eigen::SparseMatrix<double> A(static_cast<Eigen::Index>(times.size()), functions);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

}  // namespace

/// De Boor's recursion with derivatives: L. Piegl, W. Tiller, The NURBS Book (1997), algorithm A2.3.
Spline::Basis Spline::basis(double t) const {
  constexpr int p = kDegree;
  const int n = static_cast<int>(knots_.size()) - p - 1;
  int span = static_cast<int>(std::upper_bound(knots_.begin(), knots_.end(), t) - knots_.begin()) - 1;
  span = std::clamp(span, p, n - 1);
  const auto knot = [&](int i) { return knots_[static_cast<std::size_t>(i)]; };
  std::array<std::array<double, 7>, 7> ndu{};
  std::array<double, 7> left{}, right{};
  ndu[0][0] = 1;
  for (int j = 1; j <= p; ++j) {
    left[j] = t - knot(span + 1 - j);
    right[j] = knot(span + j) - t;
    double saved = 0;
    for (int r = 0; r < j; ++r) {
      ndu[j][r] = right[r + 1] + left[j - r];
      const double temp = ndu[r][j - 1] / ndu[j][r];
      ndu[r][j] = saved + right[r + 1] * temp;
      saved = left[j - r] * temp;
    }
    ndu[j][j] = saved;
  }
  Basis out{span - p, Eigen::Matrix<double, 3, 6>::Zero()};
  for (int j = 0; j <= p; ++j) out.n(0, j) = ndu[j][p];
  for (int r = 0; r <= p; ++r) {
    std::array<std::array<double, 7>, 2> a{};
    int s1 = 0, s2 = 1;
    a[0][0] = 1;
    for (int k = 1; k <= 2; ++k) {
      double d = 0;
      const int rk = r - k, pk = p - k;
      if (r >= k) {
        a[s2][0] = a[s1][0] / ndu[pk + 1][rk];
        d = a[s2][0] * ndu[rk][pk];
      }
      const int j1 = rk >= -1 ? 1 : -rk, j2 = r - 1 <= pk ? k - 1 : p - r;
      for (int j = j1; j <= j2; ++j) {
        a[s2][j] = (a[s1][j] - a[s1][j - 1]) / ndu[pk + 1][rk + j];
        d += a[s2][j] * ndu[rk + j][pk];
      }
      if (r <= pk) {
        a[s2][k] = -a[s1][k - 1] / ndu[pk + 1][r];
        d += a[s2][k] * ndu[r][pk];
      }
      out.n(k, r) = d * (k == 1 ? p : p * (p - 1));
      std::swap(s1, s2);
    }
  }
  return out;
}

Eigen::Matrix<double, 3, Eigen::Dynamic> Spline::at(double t) const {
  const Basis b = basis(t);
  return b.n.leftCols(kDegree + 1) * coefficients_.middleRows(b.first, kDegree + 1);
}

Spline Spline::through(const std::vector<double>& times, const Eigen::MatrixXd& values) {
  check(times, values, 6);
  Spline s;
  s.knots_.assign(6, times.front());
  s.knots_.insert(s.knots_.end(), times.begin() + 3, times.end() - 3);
  s.knots_.insert(s.knots_.end(), 6, times.back());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(
      sampled(times, values.rows(), [&](double t) { return s.basis(t); }));
  s.coefficients_ = lu.solve(values);
  return s;
}

Spline Spline::near(const std::vector<double>& times, const Eigen::MatrixXd& values, double spacing) {
  check(times, values, 6);
  if (!(spacing > 0)) throw std::invalid_argument("the knots of a smoothing spline need a spacing above zero");
  const double span = times.back() - times.front();
  const auto too_close = [&] {
    std::ostringstream text;
    text << "the smoothing spline has too few samples between its knots, " << spacing
         << " s apart: lengthen the smoothing";
    throw std::invalid_argument(text.str());
  };
  if (span / spacing > static_cast<double>(times.size())) too_close();
  const int pieces = std::max(1, static_cast<int>(std::lround(span / spacing)));
  Spline s;
  s.knots_.assign(6, times.front());
  for (int i = 1; i < pieces; ++i) s.knots_.push_back(times.front() + span * i / pieces);
  s.knots_.insert(s.knots_.end(), 6, times.back());
  const Eigen::SparseMatrix<double> A = sampled(times, pieces + 5, [&](double t) { return s.basis(t); });
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(Eigen::SparseMatrix<double>(A.transpose() * A));
  if (ldlt.info() != Eigen::Success || ldlt.vectorD().minCoeff() < 1e-12) too_close();
  s.coefficients_ = ldlt.solve(Eigen::MatrixXd(A.transpose() * values));
  return s;
}

}  // namespace hosel::solvers
