/// A body over time as ParaView reads it: NAME.pvd beside a folder of .vtu (volumes) or .vtp (surfaces,
/// lines) files. The .pvd is complete after every step, so that a killed run opens.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "golf/vector.hpp"

namespace hosel::post {

/// quadratic_wedge and quadratic_hexahedron are eight-node squares swept quadratically: VTK_BIQUADRATIC_QUADRATIC_WEDGE
/// (18 points) and VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON (24), in VTK's order.
enum class CellShape : std::uint8_t { vertex, line, triangle, quad, quadratic_wedge, quadratic_hexahedron };

/// One array at points or cells. Six components are a symmetric tensor in VTK's order XX YY ZZ XY YZ XZ.
struct VtkField {
  std::string name;
  std::string unit;  ///< shown by ParaView as UNITS_LABEL
  int components = 1;
  std::vector<double> values;  ///< components of the first point, then of the second, ...
};

struct VtkMesh {
  std::vector<Vec3> points;  ///< reference coordinates [m]
  struct Cell {
    static constexpr std::size_t most = 24;  ///< points
    CellShape shape;
    std::array<std::int64_t, most> points;
  };
  std::vector<Cell> cells;
  std::vector<VtkField> point_fields, cell_fields;
};

/// Vectors have three components always: a two-component array would warp silently wrong.
VtkField vector_field(std::string name, std::string unit, const std::vector<Vec3>& values);

/// The .pvd files of those of the bodies that a directory has, in their order, for a person to open.
std::vector<std::filesystem::path> series_in(const std::filesystem::path& directory,
                                             std::initializer_list<const char*> bodies);

class VtkSeries {
 public:
  enum class Form { surface, volume };
  /// How far a series has come, and what its files hold: enough to go on with it or to see that it was changed.
  struct Mark {
    std::vector<double> times = {};
    std::string digest = {};  ///< of the files, in their order
  };

  /// Writes DIRECTORY/NAME.pvd and DIRECTORY/NAME/NAME_0000.vt?. The files of `kept` stay; any other of an old series
  /// of this name is removed.
  VtkSeries(std::filesystem::path directory, std::string name, Form form, const Mark* kept = nullptr);
  /// Adds one instant. Throws std::runtime_error where the disk refuses, std::invalid_argument where
  /// an array's length does not fit the mesh.
  void write(double time, const VtkMesh& mesh);
  std::filesystem::path file() const;  ///< the .pvd
  const Mark& mark() const { return mark_; }
  /// Whether the files that the mark was taken of are there, byte for byte.
  static bool holds(const std::filesystem::path& directory, const std::string& name, Form form, const Mark& mark);

 private:
  std::filesystem::path directory_;
  std::string name_;
  Form form_;
  Mark mark_;
};

}  // namespace hosel::post
