/// The mid-surface of a face: its outline, its thickness, and nine-node quadrilaterals over it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace hosel::mesh {

/// A closed curve about the origin of the face's plane (y towards the heel, z up); every ray from the origin meets it
/// once.
struct PlateOutline {
  enum class Form { superellipse, rectangle, polygon };
  Form form = Form::superellipse;
  double half_width = 0.045, half_height = 0.025;  ///< of superellipse and rectangle [m]
  double exponent = 2;                             ///< |y/w|^n + |z/h|^n = 1; 2 is the ellipse
  std::vector<Eigen::Vector2d> corners;            ///< of the polygon, in either direction [m]

  /// Sentences naming what is not allowed; empty if all is well.
  std::vector<std::string> faults() const;
  /// Number of the polygon's first corner, from 0, after which a ray from the origin would meet it twice.
  std::optional<std::size_t> turned_back() const;
  /// Half-extents towards the four sides: largest y, largest z [m].
  Eigen::Vector2d extent() const;
  /// Distance of the rim from the origin in a direction of any length, over that length.
  double reach(const Eigen::Vector2d& direction) const;
  /// 0 at the origin, 1 at the rim, linear along each ray.
  double share(const Eigen::Vector2d& at) const { return at.isZero() ? 0 : 1 / reach(at); }
};

/// Thickness over the face [m].
struct PlateThickness {
  struct Constant {
    double value = 2.8e-3;
  };
  /// Straight between stations of the outline's share; the last holds beyond.
  struct Rings {
    std::vector<double> share, value;
  };
  /// rim + (centre - rim) (1 - (y/w)^2 - (z/h)^2)^2 inside that ellipse, rim outside.
  struct Bulge {
    double centre = 3.4e-3, rim = 2.4e-3, half_width = 0.03, half_height = 0.018;
  };
  /// Bilinear between the points of a rectangular grid; `value` at (y[i], z[j]) is [j * y.size() + i].
  struct Grid {
    std::vector<double> y, z, value;
  };
  std::variant<Constant, Rings, Bulge, Grid> map = Constant{};

  std::vector<std::string> faults() const;
  /// `share`: of the outline at the place. Throws std::invalid_argument beyond a grid's edge.
  double at(const Eigen::Vector2d& place, double share) const;
  PlateThickness scaled(double factor) const;
};

/// How fine.
struct PlateMeshOptions {
  int core = 6;   ///< elements along a side of the core block; of a rectangle: across its height
  int rings = 3;  ///< rings of elements around it; a rectangle has none
  std::vector<std::string> faults() const;
};

/// Nodes at (y, z). Elements: nodes on the grid (-1, 0, 1)^2 of the reference square, xi fastest.
struct PlateMesh {
  std::vector<Eigen::Vector2d> nodes;
  std::vector<std::array<int, 9>> elements;
  std::vector<std::array<int, 3>> rim;  ///< edges: first, middle, last node
  std::vector<char> on_rim;             ///< of each node
  double area() const;                  ///< [m2]
};

/// Throws std::invalid_argument on faults, or where an element folds.
PlateMesh plate_mesh(const PlateOutline& outline, const PlateMeshOptions& options);
/// A rectangle of equal elements, `across` along y and `up` along z.
PlateMesh rectangle_mesh(double half_width, double half_height, int across, int up);

/// Shape functions of the nine-node square and their derivatives by (xi, eta).
struct Q9 {
  Eigen::Matrix<double, 9, 1> value;
  Eigen::Matrix<double, 9, 2> derivative;
  static Q9 at(double xi, double eta);
};

/// The element in which a place lies, and where in it.
struct PlatePlace {
  int element = -1;  ///< -1: outside of the mesh
  double xi = 0, eta = 0;
};
PlatePlace locate(const PlateMesh& mesh, const Eigen::Vector2d& place);

}  // namespace hosel::mesh
