// Bodies of a blow as ParaView gets them.
#include "post/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fem/beam.hpp"
#include "fem/section.hpp"
#include "golf/shaft_library.hpp"
#include "mesh/line.hpp"

namespace hosel::post {
namespace {

/// A line that begins below the hands has the radii that the shaft has there.
TEST(ShaftMesh, HasTheShaftsRadiiBelowAGripPoint) {
  const Shaft shaft = shaft_library().front().make();
  constexpr double grip = 0.23;
  fem::System system;
  const auto line = mesh::straight(mesh::graded(shaft.length() - grip, 4, 1), Vec3::Zero(),
                                   mesh::frame_along(-Vec3::UnitZ(), Vec3::UnitX()));
  const fem::Beam beam(system.dof_map, line, fem::shaft_sections(shaft, true, grip), {});
  fem::State state = system.dof_map.rest();
  beam.place(state);
  const VtkMesh drawn = shaft_mesh(beam, shaft, state);
  const auto radius = std::ranges::find(drawn.point_fields, "radius", &VtkField::name);
  ASSERT_NE(radius, drawn.point_fields.end());
  EXPECT_NEAR(radius->values.front(), shaft.at(grip).outer_radius, 1e-12);
  EXPECT_NEAR(radius->values.back(), shaft.stations.back().outer_radius, 1e-12);
}

}  // namespace
}  // namespace hosel::post
