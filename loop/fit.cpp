#include "hosel/loop/fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

namespace hosel::loop {
namespace {

constexpr double kImpossible = 100;  // noise units

void whitened_row(const Problem& problem, int shot, const Model& model, const double* p, double* scratch, double* z) {
  const int m = problem.width();
  Eigen::Map<Eigen::VectorXd> out(z, m);
  if (!problem.predict(shot, model, p, scratch)) {
    out.setConstant(kImpossible);
    return;
  }
  for (int c = 0; c < m; ++c) scratch[c] = problem.observed(shot, c) ? scratch[c] - problem.measured()(shot, c) : 0.0;
  out.noalias() = problem.whitening(shot) * Eigen::Map<const Eigen::VectorXd>(scratch, m);
}

/// Whitened residual of a row and its derivatives; zero derivatives where the blow or a neighbour cannot happen.
void linear_row(const Problem& problem, int shot, const Model& model, const double* p, double step, bool central,
                Eigen::Ref<Eigen::VectorXd> z, Eigen::MatrixXd& J) {
  const int m = problem.width();
  std::array<double, 16> scratch{};
  if (!problem.linearise(shot, model, p, step, central, scratch.data(), J.data())) {
    J.setZero();
    whitened_row(problem, shot, model, p, scratch.data(), z.data());
    return;
  }
  for (int c = 0; c < m; ++c) {
    const bool seen = problem.observed(shot, c);
    scratch[std::size_t(c)] = seen ? scratch[std::size_t(c)] - problem.measured()(shot, c) : 0.0;
    if (!seen) J.row(c).setZero();
  }
  const auto W = problem.whitening(shot).triangularView<Eigen::Lower>();
  z = W * Eigen::Map<const Eigen::VectorXd>(scratch.data(), m);
  J = (W * J).eval();
}

/// Scales a shot so that the plain sum of squares is the loss; the derivatives likewise.
void apply(const Loss& loss, Eigen::Ref<Eigen::VectorXd> z, Eigen::MatrixXd* J) {
  const double s = z.squaredNorm();
  if (!(s > loss.knee)) return;
  const double value = loss(s), g = std::sqrt(value / s);
  if (J) {
    const double slope = (loss.weight(s) * s - value) / (g * s * s);  // twice the derivative of g
    *J = g * *J + slope * (z * (z.transpose() * *J)).eval();
  }
  z *= g;
}

class Cost final : public ceres::CostFunction {
 public:
  Cost(const Problem& problem, const std::vector<int>& rows, const Model& model, const Loss& loss)
      : problem_(problem), rows_(rows), model_(model), loss_(loss) {
    set_num_residuals(int(rows.size()) * problem.width());
    mutable_parameter_block_sizes()->push_back(model.size());
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const int n = model_.size(), m = problem_.width();
    const auto parameters = model_.parameters();
    Eigen::VectorXd p(n);
    for (int k = 0; k < n; ++k) p[k] = x[0][k] * parameters[std::size_t(k)]->scale;
    Eigen::Map<Eigen::VectorXd> z(residuals, std::ptrdiff_t(rows_.size()) * m);
    if (!jacobians || !jacobians[0]) {
      z = whitened(problem_, rows_, model_, p);
      for (Eigen::Index i = 0; i < z.size(); i += m) apply(loss_, z.segment(i, m), nullptr);
      return true;
    }
    Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> J(jacobians[0], z.size(), n);
    Eigen::MatrixXd part(m, n);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto at = std::ptrdiff_t(i) * m;
      linear_row(problem_, rows_[i], model_, p.data(), kForward, false, z.segment(at, m), part);
      apply(loss_, z.segment(at, m), &part);
      J.middleRows(at, m) = part;
    }
    return true;
  }

  static constexpr double kCentral = 1e-3, kForward = 1e-5;  // of a parameter's scale

 private:
  const Problem& problem_;
  const std::vector<int>& rows_;
  const Model& model_;
  Loss loss_;
};

}  // namespace

Eigen::VectorXd whitened(const Problem& problem, const std::vector<int>& rows, const Model& model,
                         const Eigen::VectorXd& p) {
  const int m = problem.width();
  Eigen::VectorXd z(std::ptrdiff_t(rows.size()) * m), scratch(m);
  for (std::size_t i = 0; i < rows.size(); ++i)
    whitened_row(problem, rows[i], model, p.data(), scratch.data(), z.data() + std::ptrdiff_t(i) * m);
  return z;
}

Eigen::MatrixXd whitened_jacobian(const Problem& problem, const std::vector<int>& rows, const Model& model,
                                  const Eigen::VectorXd& at) {
  const int m = problem.width();
  Eigen::MatrixXd J(std::ptrdiff_t(rows.size()) * m, model.size()), part(m, model.size());
  if (model.size() == 0) return J;
  Eigen::VectorXd z(m);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    linear_row(problem, rows[i], model, at.data(), Cost::kCentral, true, z, part);
    J.middleRows(std::ptrdiff_t(i) * m, m) = part;
  }
  return J;
}

double deviance(const Eigen::VectorXd& z, int width, const Loss& loss) {
  double sum = 0;
  for (Eigen::Index i = 0; i < z.size(); i += width) sum += loss(z.segment(i, width).squaredNorm());
  return sum;
}

std::vector<Eigen::VectorXd> starts(const Model& model) {
  std::vector<Eigen::VectorXd> all = {Eigen::VectorXd::Zero(model.size())};
  int at = 0;
  for (const Form* f : model.forms) {
    const int n = int(f->parameters.size());
    const std::size_t known = all.size();
    for (const auto& s : f->starts)
      for (std::size_t i = 0; i < known && all.size() < 128; ++i) {
        Eigen::VectorXd p = all[i];
        p.segment(at, n) = Eigen::Map<const Eigen::VectorXd>(s.data(), n);
        all.push_back(p);
      }
    at += n;
  }
  return all;
}

Fit fit(const Problem& problem, const std::vector<int>& rows, const Model& model,
        const std::vector<Eigen::VectorXd>& from, const Loss& loss, std::size_t most) {
  Fit best;
  best.model = model;
  best.p = Eigen::VectorXd::Zero(model.size());
  best.deviance = std::numeric_limits<double>::infinity();
  const auto parameters = model.parameters();
  if (parameters.empty()) {
    best.deviance = deviance(whitened(problem, rows, model, best.p), problem.width(), loss);
    best.converged = true;
    return best;
  }
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < from.size(); ++k)
    order.emplace_back(
        from.size() > most ? deviance(whitened(problem, rows, model, from[k]), problem.width(), loss) : 0.0, k);
  std::ranges::stable_sort(order, {}, [](const auto& o) { return o.first; });
  order.resize(std::min(order.size(), most));
  for (const auto& [unused, which] : order) {
    const Eigen::VectorXd& start = from[which];
    Eigen::VectorXd x(model.size());
    for (int k = 0; k < x.size(); ++k) {
      const Parameter& q = *parameters[std::size_t(k)];
      x[k] = std::clamp(start[k], q.min, q.max) / q.scale;
    }
    ceres::Solver::Summary summary;
    const auto solve = [&](const Loss& l) {
      ceres::Problem lsq;
      lsq.AddResidualBlock(new Cost(problem, rows, model, l), nullptr, x.data());
      for (int k = 0; k < x.size(); ++k) {
        const Parameter& q = *parameters[std::size_t(k)];
        lsq.SetParameterLowerBound(x.data(), k, q.min / q.scale);
        lsq.SetParameterUpperBound(x.data(), k, q.max / q.scale);
      }
      ceres::Solver::Options options;
      options.linear_solver_type = ceres::DENSE_QR;
      options.max_num_iterations = 40;
      options.function_tolerance = 1e-7;  // hundredths of a unit of deviance on long sets
      options.parameter_tolerance = 1e-7;
      options.gradient_tolerance = 1e-9;
      options.num_threads = 1;
      options.logging_type = ceres::SILENT;
      ceres::Solve(options, &lsq, &summary);
    };
    if (std::isfinite(loss.cap)) solve(loss.uncapped());
    const Eigen::VectorXd z = whitened(problem, rows, model, [&] {
      Eigen::VectorXd p = x;
      for (int k = 0; k < x.size(); ++k) p[k] *= parameters[std::size_t(k)]->scale;
      return p;
    }());
    bool beyond = !std::isfinite(loss.cap);
    for (Eigen::Index i = 0; i < z.size() && !beyond; i += problem.width())
      beyond = z.segment(i, problem.width()).squaredNorm() > loss.cap;
    if (beyond) solve(loss);
    if (!summary.IsSolutionUsable() || 2 * summary.final_cost >= best.deviance) continue;
    best.deviance = 2 * summary.final_cost;
    best.converged = summary.termination_type == ceres::CONVERGENCE;
    best.at_bound = false;
    for (int k = 0; k < x.size(); ++k) {
      const Parameter& q = *parameters[std::size_t(k)];
      best.p[k] = x[k] * q.scale;
      const double margin = 1e-3 * (q.max - q.min);
      best.at_bound = best.at_bound || (q.max - best.p[k] < margin && q.max > 0) ||
                      (best.p[k] - q.min < margin && q.min < 0);
    }
  }
  return best;
}

Eigen::MatrixXd covariance(const Problem& problem, const std::vector<int>& rows, const Fit& fit, const Loss& loss,
                           bool sandwich) {
  const int n = fit.size(), m = problem.width();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  Eigen::MatrixXd J = whitened_jacobian(problem, rows, fit.model, fit.p);
  const Eigen::VectorXd z = whitened(problem, rows, fit.model, fit.p);
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto Ji = J.middleRows(std::ptrdiff_t(i) * m, m);
    const auto zi = z.segment(std::ptrdiff_t(i) * m, m);
    const double w = loss.weight(zi.squaredNorm());
    const Eigen::VectorXd score = w * (Ji.transpose() * zi);
    meat += score * score.transpose();
    J.middleRows(std::ptrdiff_t(i) * m, m) *= std::sqrt(w);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinV);
  const Eigen::VectorXd s = svd.singularValues();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) {
    // Below a thousandth of a noise unit per unit of scale nothing is known along this direction.
    const double variance = s[k] > 1e-3 ? 1 / (s[k] * s[k]) : 1e12;
    inverse += variance * svd.matrixV().col(k) * svd.matrixV().col(k).transpose();
  }
  Eigen::MatrixXd cov = sandwich ? Eigen::MatrixXd(inverse * meat * inverse *
                                                   (double(rows.size()) / std::max(1.0, double(rows.size()) - n)))
                                 : inverse;
  const auto parameters = fit.model.parameters();
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) cov(a, b) *= parameters[std::size_t(a)]->scale * parameters[std::size_t(b)]->scale;
  return cov;
}

}  // namespace hosel::loop
