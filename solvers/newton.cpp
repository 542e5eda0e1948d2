#include "solvers/newton.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

/// Turns the vectors that begin at `rows`.
void turn(const std::vector<Index>& rows, const Mat3& rotation, Vector& x) {
  for (const Index row : rows) x.segment<3>(row) = (rotation * x.segment<3>(row)).eval();
}

}  // namespace

std::vector<std::string> NewtonOptions::faults() const {
  std::vector<std::string> out;
  if (!(residual_relative >= 0) || !(residual_absolute >= 0) || residual_relative + residual_absolute == 0)
    out.emplace_back("state a residual tolerance, relative or absolute, above zero");
  if (!(increment_vector > 0) || !(increment_rotation > 0))
    out.emplace_back("state both increment tolerances (infinity switches one off)");
  if (max_iterations < 1) out.emplace_back("allow at least one iteration");
  if (!(renew_above > 0) || !(renew_above <= 1)) out.emplace_back("renew_above lies in (0, 1]");
  return out;
}

IncrementTest::IncrementTest(const fem::System& system, const SparseTangent& tangent, const NewtonOptions& options)
    : vector_(options.increment_vector), rotation_(options.increment_rotation) {
  std::vector<bool> full(static_cast<std::size_t>(system.dof_map.size()), false);
  for (const auto& b : system.dof_map.blocks())
    if (b.rotation)
      for (Index i = 0; i < 3; ++i) full[static_cast<std::size_t>(b.v + i)] = true;
  for (Index e : tangent.free_dofs()) is_rotation_.push_back(full[static_cast<std::size_t>(e)]);
}

double IncrementTest::measure(const Vector& increment) const {
  double largest = 0;
  for (Index i = 0; i < increment.size(); ++i)
    largest =
        std::max(largest, std::abs(increment[i]) / (is_rotation_[static_cast<std::size_t>(i)] ? rotation_ : vector_));
  return largest;
}

Newton::Newton(const fem::System& system, SparseTangent& tangent, NewtonOptions options)
    : tangent_(tangent), options_(options), increments_(system, tangent, options) {
  if (const auto faults = options.faults(); !faults.empty()) throw std::invalid_argument("Newton: " + faults.front());
  for (const auto& b : system.dof_map.blocks()) {
    if (b.rotation || b.size != 3) continue;
    const int first = tangent.row(b.v);
    if (first >= 0 && tangent.row(b.v + 1) == first + 1 && tangent.row(b.v + 2) == first + 2) vectors_.push_back(first);
  }
}

NewtonReport Newton::solve(const NewtonProblem& problem) {
  NewtonReport report;
  double increment = INFINITY, before = INFINITY;
  Vector r;
  try {
    for (;; ++report.iterations) {
      r = problem.residual(report.scale);
      report.residual = r.norm();
      const double tolerance = options_.residual_relative * report.scale + options_.residual_absolute + round_off_;
      if (!std::isfinite(report.residual)) {
        report.reason = "the residual is not finite";
        break;
      }
      if (report.residual <= tolerance && increment <= 1) {
        report.converged = true;
        return report;
      }
      if (report.iterations == options_.max_iterations) {
        report.reason = "Newton's method did not converge in the iterations allowed";
        break;
      }
      // A small residual needs no better factor: only the increment is still to be confirmed.
      if (!factors_.ready() || (report.residual > options_.renew_above * before && report.residual > tolerance)) {
        round_off_ = problem.assemble();
        if (problem.attitude) attitude_ = problem.attitude();
        factors_.factorise(tangent_);
        ++report.factorisations;
      }
      before = report.residual;
      // A tangent in the axes of the bodies hardly changes while they turn: that of one attitude serves another.
      const Mat3 turned = problem.attitude ? Mat3(problem.attitude() * attitude_.transpose()) : Mat3::Identity();
      if (problem.attitude) turn(vectors_, turned.transpose(), r);
      Vector step = -factors_.solve(r);
      if (problem.attitude) turn(vectors_, turned, step);
      increment = increments_.measure(step);
      problem.advance(step);
    }
  } catch (const NonConvergence& e) { report.reason = e.what(); }
  factors_.forget();
  return report;
}

}  // namespace hosel::solvers
