/// A slender body with large displacements and rotations: geometrically exact three-node elements.
///
/// Strains of E. Reissner and J. C. Simo, Comput. Methods Appl. Mech. Eng. 49 (1985) 55-70. With R the
/// rotation from the reference placement, in reference axes:
///   gamma = R^T x' - X',   kappa = axial vector of R^T R'
/// (the initial curvature cancels). Between nodes the rotation vector relative to the middle node is interpolated:
/// R = R_2 exp(sum N_i log(R_2^T R_i)), which is objective and path-independent. Source: M. A. Crisfield, G. Jelenic,
/// Proc. R. Soc. A 455 (1999) 1125-1147. Strain energy is integrated at two Gauss points, where the section's
/// properties are evaluated. The residual is its exact derivative.
/// Where centres are off the line of nodes, axial strain is taken at the elastic centre and shear at the shear centre,
/// gamma + kappa x r. Mass is consistent for translations. Rotary inertia and the mass centre's offset are lumped at
/// the nodes (Lobatto weights): each node is a small rigid body, and momenta are those of a system of such bodies.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fem/section.hpp"
#include "fem/term.hpp"
#include "mesh/line.hpp"

namespace hosel::fem {

/// A point with a triad: global position and rotation from the reference placement.
struct Node {
  DofMap::Block translation, rotation;
};
/// The six equations of a node: forces (global), then moments (body frame).
std::vector<Index> dofs(const Node& node);

struct BeamOptions {
  std::string body = "shaft";
  Vec3 gravity = Vec3::Zero();  ///< [m/s^2]
  /// Stress = stiffness (strain + damping_time * strain rate): damping ratio omega damping_time / 2
  /// of a mode with circular frequency omega [s].
  double damping_time = 0;
  /// Existing nodes that the line begins and ends at, for bodies that share them.
  std::optional<Node> first = {}, last = {};
};

class Beam final : public Term {
 public:
  /// Adds nodes along the line to the layout. Sections are functions of the line's arc length. Throws
  /// std::invalid_argument where a stiffness or mass is not positive.
  Beam(DofMap& dof_map, const std::vector<mesh::LineNode>& line, const SectionLaw& sections, BeamOptions options);

  /// Writes the reference placement (positions, no rotation) into a state.
  void place(State& s) const;
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<mesh::LineNode>& line() const { return line_; }

  std::string body() const override { return options_.body; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  /// Strains at a Gauss point (two per element) in the section's axes.
  struct Strain {
    double arc_length;
    Vec3 gamma, kappa;
  };
  std::vector<Strain> strains(const State& s) const;
  /// What the section carries there, damping included, in its axes: the part towards the line's end pulls and turns the
  /// part towards its beginning by this much.
  struct Resultant {
    double arc_length;
    Vec3 force;   ///< axial, shear along y and z [N]
    Vec3 moment;  ///< torque, bending about y and z; about the line [N m]
  };
  std::vector<Resultant> resultants(const State& s) const;
  double mass() const;

 private:
  struct Point {  // Gauss point of the stiffness
    double weight, arc_length;
    Vec3 N, dN;      // shape functions and their derivatives by arc length
    Vec3 tangent;    // X'
    Mat6 stiffness;  // of (gamma, kappa), reference axes
    Mat3 frame;
  };
  struct Element {
    std::vector<Index> dofs;  // 18
    std::array<Point, 2> points;
    Mat3 mass;  // consistent, per direction
  };
  struct Kinematics;
  struct Rates;
  Kinematics kinematics(const State& s, const Element& e) const;
  Rates rates(const State& s, const Element& e, const Kinematics& k) const;
  Mat3 attitude(const State& s, std::size_t node) const;

  BeamOptions options_;
  std::vector<mesh::LineNode> line_;
  std::vector<Node> nodes_;
  std::vector<Element> elements_;
  std::vector<Mat3> rotary_;    // of each node and about it, reference axes
  std::vector<Vec3> moment_;    // mass times offset of its centre from the node, reference axes
  std::vector<double> weight_;  // integral of mass times shape function, for gravity
  // History: dissipated and external work so far, and what the next step adds to.
  double viscous_ = 0, power_ = 0, time_ = 0, height_ = 0, fall_ = 0;
  bool started_ = false;
};

}  // namespace hosel::fem
