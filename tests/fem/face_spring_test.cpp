#include "fem/face_spring.hpp"

#include <gtest/gtest.h>

#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

const FaceCompliance kFace{.mass = 0.012, .stiffness = 9e6, .damping = 12, .half_width = 0.05, .half_height = 0.03};

/// Three unknowns with every integral that a face may have, as particles would give them.
ReducedFace three_shapes() {
  ReducedFace out{Vector::Zero(3), Eigen::Matrix3Xd::Zero(3, 3), Eigen::MatrixXd::Zero(3, 3), {}, {}, {},
                  Vector::Ones(3)};
  for (unsigned p = 1; p <= 5; ++p) {
    const double mass = 1e-3 * p;
    const Vec3 r = test::random_vector(3, p, 0.04);
    const Vector shapes = test::random_vector(3, 10 + p, 1);
    out.mass += mass * shapes;
    out.moment += mass * r * shapes.transpose();
    out.transverse += mass * shapes * shapes.transpose();
  }
  out.inertia = out.transverse + 1e-4 * Eigen::MatrixXd::Identity(3, 3);
  out.stiffness = 9e6 * Eigen::MatrixXd::Identity(3, 3) + 1e6 * Eigen::MatrixXd::Ones(3, 3);
  out.damping = 12 * Eigen::MatrixXd::Identity(3, 3);
  return out;
}

struct SpringScene {
  ReducedFace face;
  DofMap dof_map;
  SurfaceCarrier carrier{dof_map.add_vector(3), dof_map.add_rotation(), Vec3(0.035, -0.01, 0.02)};
  DofMap::Block travel = dof_map.add_vector(face.size());
  FaceSpring spring{face, carrier, travel};
  State s = dof_map.rest();

  explicit SpringScene(ReducedFace of) : face(std::move(of)) {
    set_rotation(s, *carrier.rotation, Eigen::Quaterniond(0.5, 0.1, 0.7, -0.3).normalized());
    s.q.segment(travel.q, travel.size) = 8e-4 * Vector::LinSpaced(travel.size, 1, 2);
    s.v = test::random_vector(dof_map.size(), 3, 20);
    s.a = test::random_vector(dof_map.size(), 4, 2e4);
  }
};

class FaceSprings : public testing::TestWithParam<int> {
 protected:
  SpringScene scene{GetParam() == 1 ? ReducedFace::lumped(kFace) : three_shapes()};
};
INSTANTIATE_TEST_SUITE_P(Unknowns, FaceSprings, testing::Values(1, 3));

TEST_P(FaceSprings, Tangent) {
  ASSERT_GT(test::total_residual(scene.spring, scene.s).norm(), 100);
  test::check_tangent(scene.spring, scene.dof_map, scene.s, 1e-6, 1e-7);
}

/// What inertia takes is the rate of the kinetic energy, along any motion; what spring and damper take is stored or
/// lost.
TEST_P(FaceSprings, PowerIsTheRateOfTheEnergies) {
  const State& s = scene.s;
  Vector inertia = Vector::Zero(scene.dof_map.size()), force = inertia;
  scene.spring.residual(s, inertia, force);
  const double h = 1e-7;
  const auto at = [&](double t) {
    State moved = s;
    moved.q = scene.dof_map.advanced(s.q, t * s.v);
    moved.v += t * s.a;
    return scene.spring.energies(moved);
  };
  const Energies before = at(-h), after = at(h);
  const double kinetic = (after.kinetic - before.kinetic) / (2 * h), strain = (after.strain - before.strain) / (2 * h);
  ASSERT_GT(std::abs(kinetic), 100);
  EXPECT_NEAR(inertia.dot(s.v), kinetic, 1e-6 * std::abs(kinetic));
  const Vector rate = s.v.segment(scene.travel.v, scene.travel.size);
  EXPECT_NEAR(force.dot(s.v), strain + rate.dot(scene.face.damping * rate), 1e-6 * std::abs(strain));
}

/// The integrals stand for particles: five of them, each as a lumped face would move it, feel the same.
TEST(FaceSpring, IntegralsAreThoseOfParticles) {
  SpringScene scene(three_shapes());
  const State& s = scene.s;
  const SurfaceCarrier& carrier = scene.carrier;
  const Mat3 R = rotation(s, *carrier.rotation).toRotationMatrix();
  const Vec3 x = R.transpose() * s.a.segment<3>(carrier.translation->v), spin = s.v.segment<3>(carrier.rotation->v),
             spin_rate = s.a.segment<3>(carrier.rotation->v), e = Vec3::UnitX();
  const auto acceleration = [&](const Vec3& arm, const Vec3& rate, const Vec3& second) -> Vec3 {
    return x + spin_rate.cross(arm) + spin.cross(spin.cross(arm)) + 2 * spin.cross(rate) + second;
  };
  Vec3 push = Vec3::Zero(), turn = push;
  for (unsigned p = 1; p <= 5; ++p) {
    const double mass = 1e-3 * p;
    const Vec3 r = carrier.centre + Vec3(test::random_vector(3, p, 0.04));
    const Vector shapes = test::random_vector(3, 10 + p, 1);
    const double f = shapes.dot(s.q.segment(scene.travel.q, 3)), f1 = shapes.dot(s.v.segment(scene.travel.v, 3)),
                 f2 = shapes.dot(s.a.segment(scene.travel.v, 3));
    const Vec3 moved = mass * acceleration(r - f * e, -f1 * e, -f2 * e), rigid = mass * acceleration(r, 0 * e, 0 * e);
    push += moved - rigid;
    turn += (r - f * e).cross(moved) - r.cross(rigid);
  }
  Vector inertia = Vector::Zero(scene.dof_map.size()), force = inertia;
  scene.spring.residual(s, inertia, force);
  ASSERT_GT(turn.norm(), 0.1);
  EXPECT_LT((inertia.segment<3>(carrier.translation->v) - R * push).norm(), 1e-10 * push.norm());
  EXPECT_LT((inertia.segment<3>(carrier.rotation->v) - turn).norm(), 1e-10 * turn.norm());
}

/// The shape is 1 at the centre, and smooth to its edge: derivatives against differences, zero outside.
TEST(FaceSpring, ShapeFallsToZeroAtTheEdge) {
  EXPECT_DOUBLE_EQ(kFace.shape(0, 0).value, 1);
  EXPECT_NEAR(kFace.shape(0.04, 0).value, 0.36 * 0.36, 1e-12);
  EXPECT_EQ(kFace.shape(0.051, 0).value, 0);
  const double h = 1e-6;
  for (const auto& [y, z] : {std::pair{0.01, -0.02}, {-0.04, 0.005}}) {
    const auto s = kFace.shape(y, z), yp = kFace.shape(y + h, z), ym = kFace.shape(y - h, z),
               zp = kFace.shape(y, z + h), zm = kFace.shape(y, z - h);
    EXPECT_NEAR(s.slope[0], (yp.value - ym.value) / (2 * h), 1e-7);
    EXPECT_NEAR(s.slope[1], (zp.value - zm.value) / (2 * h), 1e-7);
    EXPECT_NEAR((s.second.col(0) - (yp.slope - ym.slope) / (2 * h)).norm(), 0, 1e-4);
    EXPECT_NEAR((s.second.col(1) - (zp.slope - zm.slope) / (2 * h)).norm(), 0, 1e-4);
  }
}

}  // namespace
}  // namespace hosel::fem
