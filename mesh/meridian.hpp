/// The meridian half-disc of a ball: eight-node quadrilaterals in concentric layers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hosel::mesh {

/// How fine. The half-disc is an O-grid: a core block inside concentric rings.
struct MeridianOptions {
  int sector = 4;     ///< elements per 45 degrees of the surface before grading (4 * sector in all)
  int rings = 4;      ///< rings of elements outside the core block
  double pole = 0.5;  ///< surface element size at the contact pole relative to the ungraded one, in (0, 1]
  /// The same at the other pole, at least 2 - pole. Where set, sizes grow as a power of the angle between the two;
  /// else half-tangents grade them, with 1/pole there: too coarse for a pole below 0.15.
  std::optional<double> far = {};
  bool both_poles = false;  ///< for a ball between two plates: graded alike to both; `far` is then at the equator
  double skin = 0.5;        ///< thickness of the outermost ring relative to the innermost, in (0, 1]
  double core = 0.4;        ///< half-width of the core block relative to the first layer's radius

  /// Sentences naming what is not allowed; empty if all is well.
  std::vector<std::string> faults() const;
};

/// Nodes at (s, rho): s along the axis towards the contact pole, rho >= 0 from the axis [m].
struct Meridian {
  std::vector<Eigen::Vector2d> nodes;
  /// Corners anticlockwise, then the nodes amid the sides 0-1, 1-2, 2-3, 3-0.
  std::vector<std::array<int, 8>> elements;
  std::vector<int> layer;  ///< of each element, 0 the innermost
  /// Outer edges from the contact pole (s = R) to the other: first, last, middle node.
  std::vector<std::array<int, 3>> surface;
  double radius = 0;  ///< outer [m]
  int layers = 1;

  bool on_axis(int node) const { return nodes[static_cast<std::size_t>(node)].y() == 0; }
};

/// A full sphere; `interfaces` are the outer radii of the layers from the inside, the last the ball's.
/// Throws std::invalid_argument on options or radii that make no mesh.
Meridian sphere_meridian(const std::vector<double>& interfaces, const MeridianOptions& options);

/// A hollow sphere of `polar` x `radial` elements, for tests with known solutions.
Meridian shell_meridian(double inner, double outer, int polar, int radial);

/// Shape functions of the eight-node serendipity square and their derivatives by (xi, eta).
struct Q8 {
  Eigen::Matrix<double, 8, 1> value;
  Eigen::Matrix<double, 8, 2> derivative;
  static Q8 at(double xi, double eta);
};

}  // namespace hosel::mesh
