#include "hosel/solvers/sparse_polynomial.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace hosel::solvers {
namespace {

constexpr int kHighest = 3, kFolds = 10;
constexpr Eigen::Index kMost = 90;  // terms of an output

/// P_0 to P_3.
std::array<double, kHighest + 1> legendre(double x) { return {1, x, 0.5 * (3 * x * x - 1), 0.5 * x * (5 * x * x - 3)}; }

/// Columns chosen one after the other, each what takes most off the residual; beside it what the same sums of columns
/// say of points that were left out, after every choice.
struct Pursuit {
  std::vector<Eigen::Index> chosen;
  Eigen::MatrixXd told;  ///< left-out points x number of columns chosen, from none

  Pursuit(Eigen::MatrixXd columns, Eigen::VectorXd y, Eigen::MatrixXd apart, Eigen::Index most)
      : told(apart.rows(), most + 1) {
    const Eigen::VectorXd size = columns.colwise().squaredNorm();
    const double negligible = 1e-24 * y.squaredNorm();
    told.col(0).setZero();
    Eigen::Index step = 0;
    for (; step < most && y.squaredNorm() > negligible; ++step) {
      // The constant comes first. What is spanned already, or does not vary, is passed over.
      Eigen::Index next = 0;
      if (step > 0) {
        const Eigen::ArrayXd left = columns.colwise().squaredNorm().transpose().array();
        const Eigen::ArrayXd fall = (columns.transpose() * y).array().square() / left.max(1e-300);
        if (!((left > 1e-6 * size.array()).select(fall, 0.0).maxCoeff(&next) > 0)) break;
      }
      const double norm = columns.col(next).norm();
      const Eigen::VectorXd q = columns.col(next) / norm, r = apart.col(next) / norm;
      const Eigen::RowVectorXd along = q.transpose() * columns;
      const double amount = q.dot(y);
      columns.noalias() -= q * along;
      apart.noalias() -= r * along;
      y -= amount * q;
      told.col(step + 1) = told.col(step) + amount * r;
      chosen.push_back(next);
    }
    for (; step < most; ++step) told.col(step + 1) = told.col(step);
  }
};

}  // namespace

std::vector<SparsePolynomial::Term> SparsePolynomial::candidates(Eigen::Index inputs, int degree) {
  std::vector<Term> all{{}};
  for (int i = 0; i < inputs; ++i)
    for (int a = 1; a <= degree; ++a) {
      all.push_back({{{{i, a}, {}}}, 0});
      for (int j = i + 1; j < inputs; ++j)
        for (int b = 1; a + b <= degree; ++b) all.push_back({{{{i, a}, {j, b}}}, 0});
    }
  return all;
}

SparsePolynomial::SparsePolynomial(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, int degree)
    : left_out_(y.rows(), y.cols()) {
  const Eigen::Index n = x.rows();
  const std::vector<Term> candidate = candidates(x.cols(), std::min(degree, kHighest));
  Eigen::MatrixXd columns(n, Eigen::Index(candidate.size()));
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<std::array<double, kHighest + 1>> p;
    for (Eigen::Index k = 0; k < x.cols(); ++k) p.push_back(legendre(x(i, k)));
    for (std::size_t c = 0; c < candidate.size(); ++c) {
      double value = 1;
      for (const Factor& f : candidate[c].factors)
        if (f.degree) value *= p[std::size_t(f.input)][std::size_t(f.degree)];
      columns(i, Eigen::Index(c)) = value;
    }
  }
  std::array<std::vector<Eigen::Index>, kFolds> in, out;
  for (Eigen::Index i = 0; i < n; ++i)
    for (int f = 0; f < kFolds; ++f) (i % kFolds == f ? out : in)[std::size_t(f)].push_back(i);

  const Eigen::Index most = std::min({kMost, n / 3, columns.cols()});
  for (Eigen::Index o = 0; o < y.cols(); ++o) {
    Eigen::MatrixXd told(n, most + 1);
    for (std::size_t f = 0; f < kFolds; ++f)
      told(out[f], Eigen::all) =
          Pursuit(columns(in[f], Eigen::all), y(in[f], o), columns(out[f], Eigen::all), most).told;
    Eigen::Index size = 0;
    (told.colwise() - y.col(o)).colwise().squaredNorm().minCoeff(&size);
    left_out_.col(o) = told.col(size);
    const std::vector<Eigen::Index> chosen = Pursuit(columns, y.col(o), columns.topRows(0), size).chosen;
    std::vector<Term>& terms = terms_.emplace_back();
    if (chosen.empty()) continue;
    const Eigen::VectorXd c = columns(Eigen::all, chosen).colPivHouseholderQr().solve(y.col(o));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      terms.push_back(candidate[std::size_t(chosen[k])]);
      terms.back().coefficient = c[Eigen::Index(k)];
    }
  }
}

Eigen::VectorXd SparsePolynomial::operator()(const Eigen::VectorXd& x) const {
  Eigen::Matrix<double, kHighest + 1, Eigen::Dynamic> p(kHighest + 1, x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) p.col(k) = Eigen::Map<const Eigen::Vector4d>(legendre(x[k]).data());
  const auto value = [&](const Factor& f) { return f.degree ? p(f.degree, f.input) : 1.0; };
  Eigen::VectorXd y = Eigen::VectorXd::Zero(Eigen::Index(terms_.size()));
  for (std::size_t o = 0; o < terms_.size(); ++o)
    for (const Term& t : terms_[o]) y[Eigen::Index(o)] += t.coefficient * value(t.factors[0]) * value(t.factors[1]);
  return y;
}

int SparsePolynomial::terms() const {
  int n = 0;
  for (const auto& t : terms_) n += int(t.size());
  return n;
}

Eigen::VectorXd SparsePolynomial::importance(Eigen::Index inputs) const {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(inputs);
  for (const std::vector<Term>& terms : terms_) {
    Eigen::VectorXd share = Eigen::VectorXd::Zero(inputs);
    double all = 0;
    for (const Term& t : terms) {
      double variance = t.coefficient * t.coefficient;
      for (const Factor& f : t.factors) variance /= 2 * f.degree + 1;
      for (const Factor& f : t.factors)
        if (f.degree) share[f.input] += variance;
      if (t.factors[0].degree) all += variance;
    }
    if (all > 0) mean += (share / all).cwiseSqrt() / double(terms_.size());
  }
  return mean;
}

}  // namespace hosel::solvers
