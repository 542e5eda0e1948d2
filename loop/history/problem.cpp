#include "hosel/loop/history/problem.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace hosel::loop {
namespace {

class Cost final : public ceres::CostFunction {
 public:
  Cost(const HistoryProblem& problem, const Model& model, double window)
      : problem_(problem), model_(model), window_(window) {
    set_num_residuals(problem.readings());
    mutable_parameter_block_sizes()->push_back(model.size());
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const auto parameters = model_.parameters();
    const auto n = std::ptrdiff_t(parameters.size());
    Eigen::VectorXd p(n), z, moved;
    for (std::ptrdiff_t k = 0; k < n; ++k) p[k] = x[0][k] * parameters[std::size_t(k)]->scale;
    if (!problem_.whitened(model_, p.data(), window_, z)) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, z.size()) = z;
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> J(jacobians[0], z.size(), n);
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      const Parameter& q = *parameters[std::size_t(k)];
      // Inside the plausible range, where the model has an answer.
      const double h = p[k] + kStep * q.scale > q.max ? -kStep * q.scale : kStep * q.scale, at = p[k];
      p[k] = at + h;
      if (!problem_.whitened(model_, p.data(), window_, moved)) return false;
      p[k] = at;
      J.col(k) = (moved - z) * (q.scale / h);
    }
    return true;
  }
  static constexpr double kStep = 1e-3;  // of a parameter's scale

 private:
  const HistoryProblem& problem_;
  const Model& model_;
  double window_;
};

}  // namespace

HistoryProblem::HistoryProblem(const HistoryModel& model, std::vector<HistoryRecord> records,
                               std::vector<HistoryChannel> channels,
                               const std::map<const Form*, const HistoryForm*>& forms)
    : model_(model), records_(std::move(records)), channels_(std::move(channels)), forms_(forms) {
  for (const HistoryRecord& r : records_) readings_ += int(r.measured.size());
}

void HistoryProblem::set_noise(int channel, double sigma, double colour) {
  channels_[std::size_t(channel)].noise = sigma;
  channels_[std::size_t(channel)].colour = colour;
}

void HistoryProblem::drop(int record, int sample, int channel) {
  records_[std::size_t(record)].measured(sample, channel) = std::numeric_limits<double>::quiet_NaN();
}

int HistoryProblem::training() const {
  int n = 0;
  for (const HistoryRecord& r : records_)
    for (std::ptrdiff_t i = 0; i < r.measured.rows(); ++i)
      if (r.train[std::size_t(i)])
        for (std::ptrdiff_t c = 0; c < r.measured.cols(); ++c) n += std::isfinite(r.measured(i, c));
  return n;
}

Rig HistoryProblem::rig(const Model& model, const double* p) const {
  Rig rig(channels_.size());
  for (const Form* f : model.forms) {
    forms_.at(f)->apply({p, f->parameters.size()}, rig);
    p += f->parameters.size();
  }
  return rig;
}

void HistoryProblem::whiten(const HistoryRecord& record, const Eigen::MatrixXd& column, bool train, double window,
                            double* out) const {
  const auto n = record.measured.rows();
  const double last = record.times.empty() ? 0 : record.times.front() + window;
  for (std::ptrdiff_t c = 0; c < record.measured.cols(); ++c) {
    const HistoryChannel& channel = channels_[std::size_t(c)];
    const double one = 1 / channel.noise, rho = channel.colour, next = one / std::sqrt(1 - rho * rho);
    bool before = false;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const bool here = std::isfinite(record.measured(i, c)) && (record.train[std::size_t(i)] != 0) == train &&
                        record.times[std::size_t(i)] <= last;
      out[c * n + i] = !here ? 0 : before ? next * (column(i, c) - rho * column(i - 1, c)) : one * column(i, c);
      before = here;
    }
  }
}

bool HistoryProblem::solve(const Model& model, const double* p, double window, std::vector<Answer>& answers,
                           std::vector<Eigen::VectorXd>& unknowns, Eigen::VectorXd* z) const {
  const Rig setup = rig(model, p);
  if (!model_.answer(setup, answers)) return false;
  if (z) z->resize(readings_);
  unknowns.assign(records_.size(), {});
  std::ptrdiff_t at = 0;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    const HistoryRecord& record = records_[r];
    Answer& a = answers[r];
    const auto size = record.measured.size();
    for (std::ptrdiff_t c = 0; c < record.measured.cols(); ++c) {
      const double gain = 1 + setup.gain[std::size_t(c)], si = channels_[std::size_t(c)].si;
      a.value.col(c) = (gain * a.value.col(c).array() + setup.offset[std::size_t(c)]) / si;
      for (Eigen::MatrixXd& u : a.unknown) u.col(c) *= gain / si;
    }
    if (!a.unknown.empty())  // where the start is unknown, so is every zero
      for (std::ptrdiff_t c = 0; c < record.measured.cols(); ++c) {
        a.unknown.emplace_back(Eigen::MatrixXd::Zero(record.measured.rows(), record.measured.cols()));
        a.unknown.back().col(c).setOnes();
      }
    const Eigen::MatrixXd e = a.value - record.measured;
    Eigen::VectorXd w(size);
    whiten(record, e, true, window, w.data());
    if (!a.unknown.empty()) {
      Eigen::MatrixXd U(size, std::ptrdiff_t(a.unknown.size()));
      for (std::size_t k = 0; k < a.unknown.size(); ++k)
        whiten(record, a.unknown[k], true, window, U.col(std::ptrdiff_t(k)).data());
      Eigen::VectorXd norm = U.colwise().norm();
      // What the channels show of a mode of the other plane is round-off, and no unknown.
      const double faint = 1e-6 * norm.maxCoeff();
      for (std::ptrdiff_t k = 0; k < U.cols(); ++k) {
        if (norm[k] > faint) U.col(k) /= norm[k];
        else U.col(k).setZero(), norm[k] = 1;
      }
      // A whiff of a ridge: modes in two planes with one frequency look alike in one channel.
      Eigen::MatrixXd G = U.transpose() * U;
      G.diagonal().array() += 1e-8;
      const Eigen::VectorXd u = G.ldlt().solve(Eigen::VectorXd(-(U.transpose() * w)));
      w += U * u;
      unknowns[r] = u.cwiseQuotient(norm);
    }
    if (!w.allFinite()) return false;
    if (z) z->segment(at, size) = w;
    at += size;
  }
  return true;
}

bool HistoryProblem::whitened(const Model& model, const double* p, double window, Eigen::VectorXd& z) const {
  std::vector<Answer> answers;
  std::vector<Eigen::VectorXd> unknowns;
  return solve(model, p, window, answers, unknowns, &z);
}

int HistoryProblem::unknowns(const Model& model, const double* p) const {
  std::vector<Answer> answers;
  std::vector<Eigen::VectorXd> u;
  if (!solve(model, p, kWhole, answers, u, nullptr)) return 0;
  int n = 0;
  for (const auto& x : u) n += int(x.size());
  return n;
}

bool HistoryProblem::residuals(const Model& model, const double* p, std::vector<Eigen::MatrixXd>& out) const {
  std::vector<Answer> answers;
  std::vector<Eigen::VectorXd> unknowns;
  if (!solve(model, p, kWhole, answers, unknowns, nullptr)) return false;
  out.clear();
  for (std::size_t r = 0; r < records_.size(); ++r) {
    Eigen::MatrixXd e = answers[r].value - records_[r].measured;
    for (std::size_t k = 0; k < answers[r].unknown.size(); ++k)
      e += unknowns[r][std::ptrdiff_t(k)] * answers[r].unknown[k];
    out.push_back(std::move(e));
  }
  return true;
}

std::pair<double, int> HistoryProblem::holdout_score(const Model& model, const double* p) const {
  std::vector<Eigen::MatrixXd> e;
  if (!residuals(model, p, e)) return {-std::numeric_limits<double>::infinity(), 0};
  double sum = 0;
  int count = 0;
  for (std::size_t r = 0; r < records_.size(); ++r) {
    Eigen::VectorXd z(records_[r].measured.size());
    whiten(records_[r], e[r], false, kWhole, z.data());
    for (std::ptrdiff_t c = 0; c < width(); ++c) {
      const HistoryChannel& ch = channels_[std::size_t(c)];
      for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i)
        if (!records_[r].train[std::size_t(i)] && std::isfinite(e[r](i, c))) {
          const double w = z[c * e[r].rows() + i];
          sum -= 0.5 * w * w + std::log(ch.noise * std::sqrt(1 - ch.colour * ch.colour) * std::sqrt(2 * kPi));
          ++count;
        }
    }
  }
  return {sum, count};
}

Eigen::MatrixXd HistoryProblem::jacobian(const Model& model, const Eigen::VectorXd& at) const {
  const auto parameters = model.parameters();
  Eigen::VectorXd p = at, one, two, z;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(readings_, model.size());
  for (std::ptrdiff_t k = 0; k < J.cols(); ++k) {
    const Parameter& q = *parameters[std::size_t(k)];
    const double step = Cost::kStep * q.scale;
    const auto look = [&](double steps, Eigen::VectorXd& out) {
      p[k] = at[k] + steps * step;
      const bool good = whitened(model, p.data(), kWhole, out);
      p[k] = at[k];
      return good;
    };
    // Of second order: central inside the plausible range, one-sided at its edge, where the model has no answer beyond.
    const bool low = at[k] - step<q.min, high = at[k] + step> q.max;
    const double side = high ? -1 : 1;
    if (low || high) {
      if (look(0, z) && look(side, one) && look(2 * side, two))
        J.col(k) = side * (4 * one - 3 * z - two) / (2 * Cost::kStep);
    } else if (look(1, one) && look(-1, two)) {
      J.col(k) = (one - two) / (2 * Cost::kStep);
    }
  }
  return J;
}

Fit HistoryProblem::fit(const Model& model, const Eigen::VectorXd& start, double window, int iterations) const {
  Fit out;
  out.model = model;
  out.p = start;
  out.deviance = std::numeric_limits<double>::infinity();
  const auto parameters = model.parameters();
  Eigen::VectorXd x(model.size());
  for (std::ptrdiff_t k = 0; k < x.size(); ++k) {
    const Parameter& q = *parameters[std::size_t(k)];
    x[k] = std::clamp(start[k], q.min, q.max) / q.scale;
  }
  if (x.size() > 0) {
    ceres::Problem lsq;
    lsq.AddResidualBlock(new Cost(*this, model, window), nullptr, x.data());
    for (std::ptrdiff_t k = 0; k < x.size(); ++k) {
      const Parameter& q = *parameters[std::size_t(k)];
      lsq.SetParameterLowerBound(x.data(), int(k), q.min / q.scale);
      lsq.SetParameterUpperBound(x.data(), int(k), q.max / q.scale);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-7;
    options.parameter_tolerance = 1e-7;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &lsq, &summary);
    if (!summary.IsSolutionUsable()) return out;
    out.converged = summary.termination_type == ceres::CONVERGENCE;
    for (std::ptrdiff_t k = 0; k < x.size(); ++k) {
      const Parameter& q = *parameters[std::size_t(k)];
      out.p[k] = x[k] * q.scale;
      const double margin = 1e-3 * (q.max - q.min);
      out.at_bound = out.at_bound || (q.max - out.p[k] < margin && q.max > 0) ||
                     (out.p[k] - q.min < margin && q.min < 0);
    }
  } else {
    out.converged = true;
  }
  Eigen::VectorXd z;
  if (whitened(model, out.p.data(), window, z)) out.deviance = z.squaredNorm();
  return out;
}

}  // namespace hosel::loop
