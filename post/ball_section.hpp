/// The ball cut open in the plane of slip, with the face that it meets: what a page shows of the largest force.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "golf/face.hpp"
#include "models/fe/impact.hpp"

namespace hosel::post {

/// Lengths in the plane of the cut, from the ball's middle: to the right towards the target, upwards [m].
struct BallSection {
  using Point = Eigen::Vector2d;
  double time = 0;                        ///< [s]
  double force = 0;                       ///< normal, of the face on the ball [N]
  std::vector<Point> points;              ///< deformed
  std::vector<double> von_mises;          ///< at the points [Pa]
  std::vector<std::array<int, 4>> cells;  ///< quadrilaterals
  std::vector<std::array<int, 3>> seams;  ///< edges between layers, and the surface: end, middle, end
  std::vector<Point> face;                ///< the club's as it stands, yielding included, from low to high
};

BallSection ball_section(const models::ImpactView& view, const Face& face);

/// Coloured by stress, with a scale.
std::string svg(const BallSection& section);

}  // namespace hosel::post
