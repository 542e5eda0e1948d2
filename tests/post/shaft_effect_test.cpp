#include "post/shaft_effect.hpp"

#include <gtest/gtest.h>

namespace hosel::post {
namespace {

/// Grids without a point there too: between the middle ones.
TEST(MassFigures, AreThoseOfTheFacesCentre) {
  for (const int columns : {4, 5}) {
    const FaceGrid grid{.width = 0.06, .height = 0.03, .columns = columns, .rows = 4};
    std::vector<double> mass;
    for (std::size_t p = 0; p < grid.size(); ++p) mass.push_back(0.002 + 0.1 * grid.toe_at(p) - 0.05 * grid.high_at(p));
    const auto figures = mass_figures(grid, mass);
    ASSERT_EQ(figures.front().name, "equivalent_head_mass_centre_g");
    EXPECT_NEAR(figures.front().value, 2, 1e-9) << columns;
  }
}

}  // namespace
}  // namespace hosel::post
