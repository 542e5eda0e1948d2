/// Reissner-Mindlin plate, and shallow shell, on nine-node quadrilaterals with tied shear strains (MITC9).
///
/// Deflection w, rotations b and, where the surface is curved, in-plane displacements u share the biquadratic shape
/// functions. With h the height of the mid-surface (against w) over its plane:
///   membrane  e = sym grad u + sym (grad h x grad w)        (Marguerre)
///   bending   k = -sym grad b
///   shear     g = grad w - b, its covariant components from six points of each element
///   energy    1/2 int t e:C:e + t^3/12 k:C:k + 5/6 G t g.g
/// Shear strains evaluated at each Gauss point would lock a thin plate. Tied at the points of [@mitc9] they vanish with
/// the thickness. The element passes the patch tests, has no zero-energy modes, and needs no numerical factor.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "fem/term.hpp"
#include "golf/face.hpp"
#include "mesh/plate.hpp"

namespace hosel::fem {

struct PlateMaterial {
  double young = 0;    ///< [Pa]
  double poisson = 0;  ///< [-]
  double density = 0;  ///< [kg/m3]
  std::vector<std::string> faults() const;
};

/// What holds the rim, per length of it; infinite: held. With b the turn about the rim and u the displacement along its
/// outward normal: energy 1/2 rotation (b - lean u)^2 + 1/2 stretch u^2.
struct RimSupport {
  double deflection = std::numeric_limits<double>::infinity();  ///< across the plate [N/m2]
  double rotation = std::numeric_limits<double>::infinity();    ///< about the rim [N/rad]
  double stretch = std::numeric_limits<double>::infinity();     ///< in the plate's plane [N/m2]
  double lean = 0;  ///< turn of an edge free of moment, per displacement along the rim's outward normal [rad/m]
  std::vector<std::string> faults() const;
  /// What a thin shell that leaves the rim at a right angle does to it: across the plate it is stretched over its
  /// length, in the plate's plane and about the rim it bends as the edge of a long cylinder: stretch 2 D b^3, rotation
  /// 2 D b, lean b with b^4 = 3 (1 - nu^2) / (radius thickness)^2 [@plates-and-shells].
  static RimSupport of_shell(const PlateMaterial& material, double thickness, double radius, double length);
};

/// Stress at a point of a surface of the plate [Pa]; axes y, z.
struct PlateStress {
  Eigen::Vector3d inner = Eigen::Vector3d::Zero();  ///< yy, zz, yz on the side that w points to
  Eigen::Vector3d outer = Eigen::Vector3d::Zero();
  double von_mises() const;  ///< larger of the two sides
};

class Plate final : public Term {
 public:
  /// Adds its unknowns to `dof_map`; `thickness` at each node [m]. A face without curvature has no in-plane unknowns.
  /// Throws std::invalid_argument on what no plate can have.
  Plate(DofMap& dof_map, mesh::PlateMesh mesh, const PlateMaterial& material, std::vector<double> thickness,
        const RimSupport& rim, const Face& curvature);

  std::string body() const override { return "face"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;

  const mesh::PlateMesh& mesh() const { return mesh_; }
  const std::vector<double>& thickness() const { return thickness_; }
  double mass() const;  ///< [kg]

  enum Unknown { kDeflection, kRotationY, kRotationZ, kStretchY, kStretchZ };
  /// Equation of an unknown at a node; -1 where it is held or does not exist.
  Index dof(int node, Unknown unknown) const;
  /// Calls visit(k, equation) for the deflections of an element's nine nodes that are free.
  template <class Visit>
  void deflections(int element, const Visit& visit) const {
    for (int k = 0; k < 9; ++k)
      if (const Index d = dof(mesh_.elements[std::size_t(element)][std::size_t(k)], kDeflection); d >= 0) visit(k, d);
  }
  double value(const Vector& values, int node, Unknown unknown) const;  ///< 0 where held; `values`: one an equation
  double deflection(const Vector& values, const Eigen::Vector2d& place) const;  ///< 0 outside
  /// Consistent loads of a pressure in the direction of w.
  Vector load(const std::function<double(const Eigen::Vector2d&)>& pressure) const;
  /// A unit force at a place; zero outside.
  Vector point_load(const Eigen::Vector2d& place) const;
  /// At a point of an element, of the field `values`.
  PlateStress stress(const Vector& values, int element, double xi, double eta) const;
  /// The same of several fields: rows as in PlateStress, a column for each.
  Eigen::Matrix<double, 6, Eigen::Dynamic> stresses(const Eigen::MatrixXd& fields, int element, double xi,
                                                    double eta) const;

  /// Points of the integration: place, weight times area, and mass per area times that.
  struct Sample {
    int element;
    Eigen::Vector2d place;
    Eigen::Matrix<double, 9, 1> shape;
    double area, mass;
  };
  std::vector<Sample> samples() const;

 private:
  static constexpr int kMost = 45;
  struct Element {
    std::vector<Index> dofs, entries;  // free ones; their places in State::q
    std::vector<int> places;           // of them among the element's 45
    Eigen::MatrixXd stiffness, mass;
  };
  struct Strains;  // at a point
  Strains strains(const std::array<int, 9>& nodes, double xi, double eta) const;
  Eigen::Matrix2d jacobian(const std::array<int, 9>& nodes, const mesh::Q9& q) const;
  Element element(std::span<const int> nodes) const;  // its free unknowns alone
  void add_rim();
  void build(Element& element, const std::array<int, 9>& nodes) const;

  mesh::PlateMesh mesh_;
  PlateMaterial material_;
  std::vector<double> thickness_;
  RimSupport rim_;
  Face curvature_;
  bool curved_;
  Index to_q_ = 0;  // from an equation to its entry in State::q
  Index end_ = 0;   // after its last equation
  std::vector<std::array<Index, 5>> dofs_;
  std::vector<Element> elements_;  // of the mesh, then edges of the rim on springs
};

}  // namespace hosel::fem
