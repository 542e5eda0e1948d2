// Springs between two nodes: derivatives, and the power of the hands.
#include <gtest/gtest.h>

#include "fem/supports.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

JointStiffness stiffness(double damping) {
  JointStiffness k;
  k.translation = {3, 5, 7};
  k.rotation = {2, 4, 6};
  k.translation_damping = damping * Vec3(1, 2, 3);
  k.rotation_damping = damping * Vec3(3, 2, 1);
  k.frame = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  return k;
}

TEST(SpringJoint, ForceIsTheGradientAndTheTangentItsDerivative) {
  DofMap dof_map;
  const Node a{dof_map.add_vector(3), dof_map.add_rotation()}, b{dof_map.add_vector(3), dof_map.add_rotation()};
  State s = dof_map.rest();
  s.q = dof_map.advanced(s.q, test::random_vector(dof_map.size(), 1, 0.7));
  s.v = test::random_vector(dof_map.size(), 2);
  const SpringJoint between("joint", a, b, stiffness(0));
  test::check_gradient(between, dof_map, s, 1e-5, 1e-8);
  test::check_tangent(between, dof_map, s, 1e-5, 1e-8);
  const SpringJoint hands("hands",
                          at_rest(Vec3(0.1, 0.2, 0.3), Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3::UnitY()))), b,
                          stiffness(0));
  test::check_gradient(hands, dof_map, s, 1e-5, 1e-8);
  test::check_tangent(hands, dof_map, s, 1e-5, 1e-8);
}

}  // namespace
}  // namespace hosel::fem
