// What no factors can be made of, and what is said about it.
#include "solvers/linear.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "solvers/errors.hpp"
#include "solvers/modes.hpp"

namespace hosel::solvers {
namespace {

/// A stiffness of its own and unit masses.
class Given final : public fem::Term {
 public:
  explicit Given(Eigen::MatrixXd stiffness) : K_(std::move(stiffness)) {
    for (Index i = 0; i < K_.rows(); ++i) all_.push_back(i);
  }
  std::string body() const override { return "given"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override { blocks.push_back(all_); }
  void residual(const fem::State& s, Vector& inertia, Vector& force) const override {
    inertia += s.a;
    force += K_ * s.q;
  }
  void tangent(const fem::State&, const fem::Weights& w, fem::TangentSink& sink) const override {
    sink.add(all_, all_, w.stiffness * K_ + w.mass * Eigen::MatrixXd::Identity(K_.rows(), K_.rows()));
  }
  fem::Energies energies(const fem::State&) const override { return {}; }

 private:
  Eigen::MatrixXd K_;
  std::vector<Index> all_;
};

fem::System given(const Eigen::MatrixXd& stiffness) {
  fem::System s;
  s.dof_map.add_vector(stiffness.rows());
  s.terms.push_back(std::make_unique<Given>(stiffness));
  return s;
}

std::string refused(const Eigen::MatrixXd& stiffness) {
  const fem::System s = given(stiffness);
  SparseTangent tangent(s);
  tangent.assemble(s, s.dof_map.rest(), {1, 0, 0});
  Factorisation factors;
  try {
    factors.factorise(tangent);
  } catch (const NonConvergence& e) {
    EXPECT_FALSE(factors.ready());
    return e.what();
  }
  return {};
}

/// Three equations go to KLU, two hundred that all meet to UMFPACK.
TEST(Linear, WhatIsNotFiniteIsNotCalledSingular) {
  for (const Index n : {3, 200}) {
    Eigen::MatrixXd K = Eigen::MatrixXd::Constant(n, n, 0.1);
    K.diagonal().setConstant(2.0 * double(n));
    EXPECT_EQ(refused(K), "");
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      Eigen::MatrixXd broken = K;
      broken(1, 1) = bad;
      EXPECT_NE(refused(broken).find("not finite"), std::string::npos) << refused(broken);
    }
    Eigen::MatrixXd singular = Eigen::MatrixXd::Zero(n, n);
    EXPECT_NE(refused(singular).find("singular"), std::string::npos) << refused(singular);
  }
}

TEST(Modes, ABuckledStateHasNone) {
  const fem::System good = given(Eigen::Vector3d(1, 2, 4).asDiagonal()),
                    buckled = given(Eigen::Vector3d(1, -1, 4).asDiagonal());
  const std::vector<double> omega = modes(good, good.dof_map.rest(), 3).omega;
  ASSERT_EQ(omega.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(omega[i], std::sqrt(double(1 << i)), 1e-9);
  EXPECT_THROW(modes(buckled, buckled.dof_map.rest(), 3), NonConvergence);
}

}  // namespace
}  // namespace hosel::solvers
