/// A surface that a solid may touch: a shape in its own axes, which move with a rigid node or are fixed.
#pragma once

#include <limits>
#include <optional>

#include "fem/state.hpp"

namespace hosel::fem {

/// The surface as seen from a place beside it, in its own axes.
struct SurfacePoint {
  double gap = 0;                 ///< distance, negative inside [m]
  Vec3 normal = Vec3::UnitX();    ///< unit, outwards
  Vec3 slope = Vec3::UnitX();     ///< derivative of the gap by the place: the line along which pressure acts
  Mat3 curvature = Mat3::Zero();  ///< derivative of the slope by the place [1/m]
};

/// At most so many unknowns of its own move a surface.
inline constexpr int kSurfaceUnknowns = 32;
using SurfaceUnknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kSurfaceUnknowns, 1>;

/// How far a surface has moved inwards, against its first axis: a sum of its unknowns times shapes, which are functions
/// of the place's second and third coordinate.
struct Travel {
  double value = 0;                                  ///< [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();   ///< first derivatives by the place
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  ///< second derivatives by the place
  SurfaceUnknowns shape;                             ///< at the place
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kSurfaceUnknowns> shape_slope;
};

/// The shape is asked at places in the surface's axes. A surface with unknowns of its own is asked where the place
/// would be had it not moved, place + travel * (1, 0, 0): its shape never changes, and slip is measured on it.
class ContactSurface {
 public:
  virtual ~ContactSurface() = default;
  virtual double gap(const Vec3& place) const = 0;
  virtual SurfacePoint at(const Vec3& place) const = 0;
  /// No point of the surface lies further along its first axis than this [m]; infinity where that is not known.
  virtual double reach(const SurfaceUnknowns&) const { return std::numeric_limits<double>::infinity(); }

  /// A block of at most kSurfaceUnknowns plain numbers in the system's layout. What they weigh and what holds
  /// them is a term of its own.
  virtual std::optional<DofMap::Block> unknowns() const { return std::nullopt; }
  /// Where there are unknowns: how far they move the surface at a place [m], and that with its derivatives.
  virtual double travel(const Vec3& place, const SurfaceUnknowns& unknowns) const;
  virtual Travel travel_at(const Vec3& place, const SurfaceUnknowns& unknowns) const;
};

/// What carries the surface. Its axes are parallel to the body frame of the blocks' node; `centre` lies in it.
/// Without blocks the surface stands still at `position`, `attitude`.
struct SurfaceCarrier {
  std::optional<DofMap::Block> translation, rotation;
  Vec3 centre = Vec3::Zero();        ///< of the surface's axes, from the node, body frame [m]
  Vec3 position = Vec3::Zero();      ///< of a fixed surface's node, global [m]
  Mat3 attitude = Mat3::Identity();  ///< of a fixed surface, body to global
};

/// Where the carried axes stand and how they move.
struct SurfacePose {
  Vec3 centre = Vec3::Zero();    ///< global [m]
  Mat3 axes = Mat3::Identity();  ///< columns: the surface's axes in the global frame
  Vec3 velocity = Vec3::Zero();  ///< of the centre, global [m/s]
  Vec3 spin = Vec3::Zero();      ///< global [rad/s]
};
SurfacePose pose(const SurfaceCarrier& carrier, const State& s);

}  // namespace hosel::fem
