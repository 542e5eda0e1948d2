/// One check for every term: residual against energy, tangent against residual, by central differences.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

#include "fem/term.hpp"

namespace hosel::test {

/// Gathers a tangent in a dense matrix.
class DenseSink final : public fem::TangentSink {
 public:
  explicit DenseSink(Eigen::Index size) : matrix(Eigen::MatrixXd::Zero(size, size)) {}
  void add(const std::vector<Eigen::Index>& rows, const std::vector<Eigen::Index>& columns,
           const Eigen::Ref<const Eigen::MatrixXd>& block) override {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < columns.size(); ++j)
        matrix(rows[i], columns[j]) += block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  Eigen::MatrixXd matrix;
};

inline Eigen::VectorXd random_vector(Eigen::Index size, unsigned seed, double scale = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-scale, scale);
  Eigen::VectorXd v(size);
  for (auto& x : v) x = uniform(generator);
  return v;
}

inline fem::Vector total_residual(const fem::Term& term, const fem::State& s) {
  fem::Vector inertia = fem::Vector::Zero(s.v.size()), force = inertia;
  term.residual(s, inertia, force);
  return inertia + force;
}

/// Directional derivatives of the residual along random directions of q, v and a against the tangent.
inline void check_tangent(const fem::Term& term, const fem::DofMap& dof_map, const fem::State& s, double step,
                          double tolerance, double rate_step = 1) {
  const Eigen::Index n = dof_map.size();
  for (int what = 0; what < 3; ++what) {
    const fem::Weights weights{what == 0 ? 1.0 : 0.0, what == 1 ? 1.0 : 0.0, what == 2 ? 1.0 : 0.0};
    DenseSink sink(n);
    term.tangent(s, weights, sink);
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const Eigen::VectorXd d = random_vector(n, seed);
      // Most residuals are at most quadratic in v and linear in a: a large step is exact there.
      const double h0 = what == 0 ? step : rate_step;
      const auto at = [&](double h) {
        fem::State t = s;
        if (what == 0) t.q = dof_map.advanced(s.q, h * d);
        if (what == 1) t.v += h * d;
        if (what == 2) t.a += h * d;
        return total_residual(term, t);
      };
      const Eigen::VectorXd difference = (at(h0) - at(-h0)) / (2 * h0);
      const Eigen::VectorXd product = sink.matrix * d;
      EXPECT_LE((difference - product).norm(), tolerance * (product.norm() + difference.norm()) + 1e-30)
          << "derivative by "
          << (what == 0   ? "q"
              : what == 1 ? "v"
                          : "a");
    }
  }
}

/// The force is the gradient of the stored energy (strain + contact) along random directions.
inline void check_gradient(const fem::Term& term, const fem::DofMap& dof_map, const fem::State& s, double step,
                           double tolerance) {
  const auto stored = [&](const fem::State& t) {
    const fem::Energies e = term.energies(t);
    return e.strain + e.contact;
  };
  fem::Vector inertia = fem::Vector::Zero(dof_map.size()), force = inertia;
  term.residual(s, inertia, force);
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Eigen::VectorXd d = random_vector(dof_map.size(), seed);
    fem::State plus = s, minus = s;
    plus.q = dof_map.advanced(s.q, step * d);
    minus.q = dof_map.advanced(s.q, -step * d);
    const double difference = (stored(plus) - stored(minus)) / (2 * step);
    EXPECT_NEAR(difference, force.dot(d), tolerance * (std::abs(difference) + std::abs(force.dot(d))));
  }
}

}  // namespace hosel::test
