/// Launch over the face: one impact at every point of a grid, for one or several models.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "golf/face.hpp"
#include "golf/launch.hpp"
#include "post/figure.hpp"
#include "post/flight_table.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

/// Points over width x height around the face centre, in rows from low to high, each from heel to toe.
struct FaceGrid {
  double width = 0.075, height = 0.0375;  ///< [m]
  int columns = 15, rows = 9;             ///< at least 2 each

  std::size_t size() const { return std::size_t(columns) * std::size_t(rows); }
  double toe(int column) const { return width * (double(column) / (columns - 1) - 0.5); }  ///< [m], toe positive
  double high(int row) const { return height * (double(row) / (rows - 1) - 0.5); }         ///< [m], up positive
  double toe_at(std::size_t point) const { return toe(int(point) % columns); }
  double high_at(std::size_t point) const { return high(int(point) / columns); }
};

/// One model's launches, one a grid point; absent where the model found no answer.
struct FaceMap {
  std::string title;
  std::vector<std::optional<Launch>> launches;
  std::vector<std::optional<ShotFlight>> flights = {};  ///< one a grid point, or none at all
  DistanceUnit distances = DistanceUnit::yards;
};

/// What a map shows: the launch channels, head and contact after the blow; the flight, and how much carry is lost
/// against the map's longest.
struct MapQuantity {
  std::string name, unit;  ///< unit as a suffix
  double si;               ///< one of the unit in SI
  bool of_flight;
  std::function<std::optional<double>(const FaceMap&, std::size_t point)> value;  ///< SI; absent where there is none
};
/// Those of the launch alone, or with those of the flight in its unit.
std::span<const MapQuantity> map_quantities(const FaceMap& map);

/// The quantity over the grid in its unit, NaN where there is none; empty if it is nowhere.
std::vector<double> values(const FaceMap& map, const MapQuantity& quantity);
/// The same as `map` minus `reference`.
std::vector<double> differences(const FaceMap& map, const FaceMap& reference, const MapQuantity& quantity);

/// One row a point and model: model, impact_toe_mm, impact_high_mm, then a column a quantity.
std::string face_map_csv(const FaceGrid& grid, const std::vector<FaceMap>& maps);
/// Number of the map that each of several is compared with; nothing: with none.
using References = std::vector<std::optional<std::size_t>>;
/// The same for each map minus its reference.
std::string difference_csv(const FaceGrid& grid, const std::vector<FaceMap>& maps, const References& references);

/// Labels of a panel over the face in millimetres, as long up as across, with the 12 mm circle.
void frame_face(Panel& panel);
/// A contour map as a panel: millimetres from the face centre, toe on the right, the 12 mm circle.
/// `symmetric` centres the colours on zero.
Panel face_panel(const FaceGrid& grid, const std::vector<double>& values, std::string title, std::string label,
                 bool symmetric);
/// Under every figure of maps.
inline constexpr const char* kFaceView =
    "seen from behind (right-handed): heel left, toe right; dashed: 12 mm from the face centre";

/// The face's surface through the grid points (face frame) with every quantity of every map, and its
/// differences to its reference, as point arrays `MODEL.QUANTITY` and `MODEL-minus-REFERENCE.QUANTITY`.
VtkMesh face_map_mesh(const Face& face, const FaceGrid& grid, const std::vector<FaceMap>& maps,
                      const References& references);

}  // namespace hosel::post
