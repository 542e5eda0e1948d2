#include "solvers/least_squares.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golf/units.hpp"
#include "solvers/errors.hpp"
#include "solvers/random.hpp"

namespace hosel::solvers {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Scales the blocks of the first `count` so that the plain sum of squares is the loss; the derivatives likewise.
void apply(const Loss& loss, Eigen::Index count, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
  if (std::isinf(loss.knee)) return;
  for (Eigen::Index i = 0; i < count; i += loss.block) {
    auto z = r.segment(i, loss.block);
    const double s = z.squaredNorm();
    if (!(s > loss.knee)) continue;
    const double value = loss(s), g = std::sqrt(value / s);
    if (J) {
      auto rows = J->middleRows(i, loss.block);
      const double slope = (loss.weight(s) * s - value) / (g * s * s);  // twice the derivative of g
      rows = (g * rows + slope * (z * (z.transpose() * rows))).eval();
    }
    z *= g;
  }
}

/// Central, shifted at a bound.
bool differences(const LeastSquares& problem, const Eigen::VectorXd& p, Eigen::MatrixXd& jacobian) {
  jacobian.resize(problem.residuals, p.size());
  Eigen::VectorXd moved = p, up(problem.residuals), down(problem.residuals);
  for (Eigen::Index k = 0; k < p.size(); ++k) {
    const Bounds& b = problem.bounds[std::size_t(k)];
    const double h = problem.step * b.scale, middle = std::clamp(p[k], b.low + h, b.high - h);
    moved[k] = middle + h;
    if (!problem.value(moved, up)) return false;
    moved[k] = middle - h;
    if (!problem.value(moved, down)) return false;
    moved[k] = p[k];
    jacobian.col(k) = (up - down) / (2 * h);
  }
  return true;
}

/// The whole problem as one cost function of parameters in units of their scale.
class Cost final : public ceres::CostFunction {
 public:
  explicit Cost(const LeastSquares& problem) : problem_(problem), scale_(std::ptrdiff_t(problem.bounds.size())) {
    for (Eigen::Index k = 0; k < scale_.size(); ++k) scale_[k] = problem.bounds[std::size_t(k)].scale;
    set_num_residuals(problem.residuals);
    mutable_parameter_block_sizes()->push_back(int(scale_.size()));
  }

  const Eigen::VectorXd& scale() const { return scale_; }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd p = Eigen::Map<const Eigen::VectorXd>(x[0], scale_.size()).cwiseProduct(scale_);
    const bool derive = jacobians && jacobians[0];
    Eigen::Map<Eigen::VectorXd> out(residuals, problem_.residuals);
    if (!derive && p == last_) {
      out = residuals_;
      return true;
    }
    Eigen::VectorXd r(problem_.residuals);
    Eigen::MatrixXd J;
    if (!(derive && problem_.linearised ? problem_.linearised(p, r, J) : problem_.value(p, r))) return false;
    if (derive && !problem_.linearised && !differences(problem_, p, J)) return false;
    apply(problem_.loss, r.size() - problem_.plain, r, derive ? &J : nullptr);
    out = r;
    if (derive) Eigen::Map<RowMajor>(jacobians[0], J.rows(), J.cols()) = J * scale_.asDiagonal();
    last_ = p;
    residuals_ = std::move(r);
    return true;
  }

 private:
  const LeastSquares& problem_;
  Eigen::VectorXd scale_;
  // A step is asked for where its line search ended.
  mutable Eigen::VectorXd last_ = Eigen::VectorXd::Constant(scale_.size(), kNaN), residuals_;
};

}  // namespace

double Loss::operator()(double s) const {
  if (s <= knee) return s;
  return tail == Tail::linear ? 2 * std::sqrt(knee * s) - knee : knee * (1 + std::log(std::min(s, cap) / knee));
}

double Loss::weight(double s) const {
  if (s <= knee) return 1;
  return tail == Tail::linear ? std::sqrt(knee / s) : s <= cap ? knee / s : 0;
}

double Loss::sum(const Eigen::VectorXd& r) const {
  double total = 0;
  for (Eigen::Index i = 0; i < r.size(); i += block) total += (*this)(r.segment(i, block).squaredNorm());
  return total;
}

std::optional<Minimum> minimise(const LeastSquares& problem, const Eigen::VectorXd& start, const Tolerances& until) {
  for (const Bounds& b : problem.bounds)
    if (!(b.low < b.high) || !std::isfinite(b.high - b.low))
      throw std::invalid_argument("least squares: bounds must be finite, low below high");
  Cost cost(problem);
  ceres::Problem::Options keep;
  keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem search(keep);
  Eigen::VectorXd x = start.cwiseQuotient(cost.scale());
  search.AddResidualBlock(&cost, nullptr, x.data());
  for (int k = 0; k < int(x.size()); ++k) {
    const Bounds& b = problem.bounds[std::size_t(k)];
    x[k] = std::clamp(start[k], b.low, b.high) / b.scale;
    search.SetParameterLowerBound(x.data(), k, b.low / b.scale);
    search.SetParameterUpperBound(x.data(), k, b.high / b.scale);
  }
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_QR;
  how.max_num_iterations = until.iterations;
  how.function_tolerance = until.cost;
  how.parameter_tolerance = until.parameters;
  how.logging_type = ceres::SILENT;
  // Between bounds every step is searched along. A cubic would ask for the derivatives there, which are dear.
  how.line_search_interpolation_type = ceres::QUADRATIC;
  // Its warnings come all the same; the summary says what failed.
  [[maybe_unused]] static const int quiet = FLAGS_minloglevel = google::GLOG_FATAL;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &search, &summary);
  if (!summary.IsSolutionUsable()) return {};
  return Minimum{x.cwiseProduct(cost.scale()), summary.final_cost, summary.termination_type == ceres::CONVERGENCE,
                 summary.BriefReport()};
}

LeastSquaresFit least_squares(const Residuals& residuals, int count, const Eigen::VectorXd& start,
                              const std::vector<Bounds>& bounds, const LeastSquaresOptions& options) {
  LeastSquares problem{.residuals = count, .bounds = bounds, .value = residuals, .step = options.step};
  if (options.huber > 0) problem.loss.knee = options.huber * options.huber;
  std::mt19937_64 random(options.seed);
  std::vector<Minimum> found;
  for (int k = 0; k < options.starts; ++k) {
    Eigen::VectorXd p = start;
    for (Eigen::Index i = 0; k > 0 && i < p.size(); ++i) {
      const Bounds& b = bounds[std::size_t(i)];
      p[i] = b.low + (0.05 + 0.9 * uniform(random)) * (b.high - b.low);
    }
    if (auto minimum = minimise(problem, p, {.iterations = options.iterations})) found.push_back(*std::move(minimum));
  }
  if (found.empty()) throw NonConvergence("least squares: no start has an answer");
  std::ranges::stable_sort(found, {}, &Minimum::cost);
  if (!found.front().converged)
    throw NonConvergence("least squares: the best start has not converged; allow more iterations");
  LeastSquaresFit fit{.parameters = found.front().parameters, .cost = found.front().cost, .costs = {}, .jacobian = {}};
  for (const Minimum& m : found) fit.costs.push_back(m.cost);
  if (!differences(problem, fit.parameters, fit.jacobian))
    throw NonConvergence("least squares: no derivative at the solution");
  return fit;
}

std::vector<bool> at_bounds(const Eigen::VectorXd& parameters, const std::vector<Bounds>& bounds) {
  std::vector<bool> out;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const double x = parameters[Eigen::Index(k)], margin = 1e-3 * (bounds[k].high - bounds[k].low);
    out.push_back(x < bounds[k].low + margin || x > bounds[k].high - margin);
  }
  return out;
}

Eigen::MatrixXd covariance(const Eigen::MatrixXd& J, double least, const Eigen::MatrixXd* scores) {
  const Eigen::Index n = J.cols();
  if (n == 0) return {};  // nothing was fitted
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeFullV);
  Eigen::MatrixXd known = Eigen::MatrixXd::Zero(n, n), unknown = known;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double s = k < svd.singularValues().size() ? svd.singularValues()[k] : 0;
    const Eigen::MatrixXd part = svd.matrixV().col(k) * svd.matrixV().col(k).transpose();
    if (s > least) known += part / (s * s);
    else unknown += part.unaryExpr([](double x) { return std::abs(x) > 1e-12 ? x * INFINITY : 0.0; });
  }
  if (scores) known = (known * *scores * known).eval();
  return known + unknown;
}

Identifiability identifiability(const Eigen::MatrixXd& whitened, const std::vector<Bounds>& bounds) {
  const int n = static_cast<int>(whitened.cols());
  Eigen::VectorXd scale(n);
  for (int i = 0; i < n; ++i) scale[i] = bounds[i].scale;
  const Eigen::MatrixXd scaled = whitened * scale.asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeFullV);
  const Eigen::VectorXd& strength = svd.singularValues();  // of no more directions than there are data
  Identifiability out;
  for (int k = 0; k < n; ++k)
    if (!(k < strength.size() && strength[k] > 1))
      out.blind.push_back(svd.matrixV().col(k));  // sd above the bounds' distance
  const Eigen::MatrixXd spread = covariance(scaled, 1e-12 * strength[0]);
  out.sd = spread.diagonal().cwiseSqrt().cwiseProduct(scale);
  out.correlation = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (i != j) {
        const double c = spread(i, j) / std::sqrt(spread(i, i) * spread(j, j));
        // Two parameters of one blind direction: wholly tied, with the sign of their product.
        out.correlation(i, j) = std::isfinite(c) ? c
                                                 : (std::isinf(spread(i, j)) ? std::copysign(1.0, spread(i, j)) : 0.0);
      }
  Eigen::MatrixXd unit = scaled;
  for (int i = 0; i < n; ++i)
    if (const double length = unit.col(i).norm(); length > 0) unit.col(i) /= length;
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(unit).singularValues();
  out.condition = values.size() == n && values[n - 1] > 0 ? values[0] / values[n - 1] : INFINITY;
  return out;
}

}  // namespace hosel::solvers
