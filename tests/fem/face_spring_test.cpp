#include "fem/face_spring.hpp"

#include <gtest/gtest.h>

#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

const FaceCompliance kFace{.mass = 0.012, .stiffness = 9e6, .damping = 12, .half_width = 0.05, .half_height = 0.03};

struct SpringScene {
  DofMap dof_map;
  SurfaceCarrier carrier{dof_map.add_vector(3), dof_map.add_rotation(), Vec3(0.035, -0.01, 0.02)};
  DofMap::Block travel = dof_map.add_vector(1);
  FaceSpring spring{kFace, carrier, travel};
  State s = dof_map.rest();

  SpringScene() {
    set_rotation(s, *carrier.rotation, Eigen::Quaterniond(0.5, 0.1, 0.7, -0.3).normalized());
    s.q[travel.q] = 8e-4;
    s.v = test::random_vector(dof_map.size(), 3, 20);
    s.a = test::random_vector(dof_map.size(), 4, 2e4);
  }
};

TEST(FaceSpring, Tangent) {
  SpringScene scene;
  ASSERT_GT(test::total_residual(scene.spring, scene.s).norm(), 100);
  test::check_tangent(scene.spring, scene.dof_map, scene.s, 1e-6, 1e-7);
}

/// What inertia takes is the rate of the kinetic energy, along any motion; what spring and damper take is stored or
/// lost.
TEST(FaceSpring, PowerIsTheRateOfTheEnergies) {
  SpringScene scene;
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
  const double rate = s.v[scene.travel.v];
  EXPECT_NEAR(force.dot(s.v), strain + kFace.damping * rate * rate, 1e-6 * std::abs(strain));
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
