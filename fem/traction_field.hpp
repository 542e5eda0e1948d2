/// Pressure and traction over the contact patch as smooth fields with the moments of the contact forces.
#pragma once

#include <vector>

#include "fem/contact.hpp"

namespace hosel::fem {

/// A single station of the contact has no traction that converges: the displacement of a quadratic edge cannot follow
/// what its four stations ask for, and their pressures alternate. Forces and their low moments do converge: they are
/// the virtual work on smooth displacements, which the elements represent. The field is the one of a family suited to
/// contact that has the moments of the stations over the patch.
///
/// - Pressure: p0 sqrt(1 - r^2) on an ellipse, r = 1 at its rim (Hertz). The six moments of degree 0 to 2 give p0,
///   centre and axes.
/// - Friction: two such ellipses, the patch and one of the same shape within it where points stick, each with a vector
///   [@cattaneo-mindlin], and the pressure times a linear ratio. Friction over pressure is cut where it exceeds the
///   largest ratio of a station. The inner ellipse is the largest with which the rim does not exceed it. Moments of
///   degree 0 and 1 and the polar one of degree 2 give the rest.
///
/// Coordinates are those of the solid before the motion, in the plane across the direction to the centre of pressure;
/// values are per reference area, as the stations' are. The equations stand in docs/theory.md, Contact.
class TractionField {
 public:
  struct Value {
    double pressure = 0;             ///< [Pa]
    Vec3 tangential = Vec3::Zero();  ///< of friction, on the solid, global [Pa]
    Vec3 traction = Vec3::Zero();    ///< pressure and friction, on the solid, global [Pa]
  };

  /// `points` of Contact::points. Those of a half circle of angles stand for their mirror images too, those of one
  /// angle for all around the axis.
  TractionField(const HarmonicSolid& solid, const std::vector<ContactPoint>& points);

  /// At a point of the solid's surface before the motion, global [m]; zero off the patch.
  Value at(const Vec3& reference) const;

 private:
  using Vec2 = Eigen::Vector2d;
  using Mat2 = Eigen::Matrix2d;
  struct Ellipse {
    Vec2 centre = Vec2::Zero();
    Mat2 axes = Mat2::Zero();  // x = centre + axes xi, |xi| = 1 at the rim
    Mat2 inverse = Mat2::Zero();
    Vec2 unit(const Vec2& x) const { return inverse * (x - centre); }
  };
  struct Station;
  using Four = Eigen::Matrix<double, 4, 1>;

  Four shapes(const Vec2& xi) const;
  static Ellipse ellipse(const Vec2& centre, const Mat2& shape);
  /// Calls visit(x, weight) at points of a quadrature of sqrt(1 - r^2) f over the ellipse, per reference area. f is
  /// smooth, but for what bends at r = `inner`.
  template <class Visit>
  void over(const Ellipse& e, double inner, Visit&& visit) const;
  Ellipse with_moments(const Vec2& mean, const Mat2& variance) const;
  void fit_pressure(const std::vector<Station>& stations);
  void fit_friction(const std::vector<Station>& stations);
  Vec2 ratio(const Four& of_shapes) const;

  Vec3 origin_;
  double radius_ = 0;
  bool touching_ = false;
  Eigen::Matrix<double, 3, 2> plane_;  // across the direction to the centre of pressure
  Vec3 outwards_ = Vec3::UnitX();
  Ellipse patch_;
  double peak_ = 0;
  Eigen::Matrix3d push_ = Mat3::Zero();  // direction of the pressure: columns of 1, xi
  Eigen::Matrix<double, 3, 2> along_;    // tangential directions, global
  double inner_ = 0;                     // r at the rim of the inner ellipse
  Eigen::Matrix<double, 2, 4> ratio_ = Eigen::Matrix<double, 2, 4>::Zero();  // friction over pressure, of shapes
  double bound_ = 0;                                                         // largest ratio of a station
};

}  // namespace hosel::fem
