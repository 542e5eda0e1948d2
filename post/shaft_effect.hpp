/// What one club changes against another over the face, as figures.
#pragma once

#include <string>
#include <vector>

#include "post/face_map.hpp"

namespace hosel::post {

/// A named figure in the unit of its name.
struct NamedFigure {
  std::string name;
  double value;
};

/// `club` against `free` over the whole grid. Differences are club minus free; positions are those of
/// a parabola through the best grid point and its neighbours; slopes are least-squares planes over the
/// grid, per mm towards toe and up. Throws std::invalid_argument where a point has no launch.
std::vector<NamedFigure> shaft_effect(const FaceGrid& grid, const FaceMap& club, const FaceMap& free);
/// The names of those figures for maps without flights: what statements may speak of.
std::vector<std::string> shaft_effect_names();

/// Extra head mass [kg] that gives the free head the club's ball speed, at every point. `heavier` is
/// the free head's map with `extra` more mass at its centre of gravity, `mass` the head's own. 1/v is
/// taken linear in 1/M, which is exact for one impulse with a fixed restitution.
std::vector<double> equivalent_mass(const FaceMap& club, const FaceMap& free, const FaceMap& heavier, double mass,
                                    double extra);
/// Such masses in figures: at the face's centre, mean, least and most.
std::vector<NamedFigure> mass_figures(const FaceGrid& grid, const std::vector<double>& mass);

/// How far a map is from its own mirror image heel to toe: the largest difference of a quantity that a
/// mirror keeps (ball speed, launch angle, backspin) or turns round (azimuth, sidespin), relative to
/// the largest value of its kind in the map. Zero for a symmetric head struck squarely.
double mirror_error(const FaceGrid& grid, const FaceMap& map);

}  // namespace hosel::post
