#include "fem/rigid_body.hpp"

#include <gtest/gtest.h>

#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

TEST(RigidBody, TangentAndMomentum) {
  DofMap dof_map;
  const auto x = dof_map.add_vector(3), r = dof_map.add_rotation();
  RigidBodyProperties p;
  p.mass = 0.2;
  p.inertia << 4.6e-4, 1e-5, 3e-5, 1e-5, 2.2e-4, -1.5e-5, 3e-5, -1.5e-5, 2.9e-4;
  p.offset = Vec3(0.02, 0.035, 0.015);
  const RigidBody body("head", x, r, p, Vec3(0, 0, -9.81));
  State s = dof_map.rest();
  s.q = dof_map.advanced(s.q, test::random_vector(6, 3));
  s.v = test::random_vector(6, 4, 10);
  s.a = test::random_vector(6, 5, 100);
  test::check_tangent(body, dof_map, s, 1e-5, 1e-8);

  // Kinetic energy and both momenta change at the rate of the equations: dT/dt = v . inertia.
  Vector inertia = Vector::Zero(6), force = inertia;
  body.residual(s, inertia, force);
  const double h = 1e-5;
  const auto later = [&](double t) {
    State n = s;
    n.q = dof_map.advanced(s.q, t * s.v + 0.5 * t * t * s.a);
    n.v += t * s.a;
    return n;
  };
  const double power = (body.energies(later(h)).kinetic - body.energies(later(-h)).kinetic) / (2 * h);
  EXPECT_NEAR(power, s.v.dot(inertia), 1e-7 * std::abs(power));
  const Vec3 rate = (body.linear_momentum(later(h)) - body.linear_momentum(later(-h))) / (2 * h);
  EXPECT_LE((rate - inertia.segment<3>(0)).norm(), 1e-7 * rate.norm());
  const Vec3 spin_rate = (body.angular_momentum(later(h)) - body.angular_momentum(later(-h))) / (2 * h);
  const Vec3 torque = Vec3(s.q.segment<3>(0)).cross(Vec3(inertia.segment<3>(0))) +
                      rotation(s, r) * Vec3(inertia.segment<3>(3));
  EXPECT_LE((spin_rate - torque).norm(), 1e-6 * torque.norm());
}

}  // namespace
}  // namespace hosel::fem
