/// A solid of revolution whose displacement is a sum of angular functions times meridian fields.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "fem/harmonics.hpp"
#include "fem/materials/solid.hpp"
#include "fem/term.hpp"
#include "mesh/meridian.hpp"

namespace hosel::fem {

/// Where the solid lies in space before it moves.
struct Placement {
  Vec3 origin = Vec3::Zero();    ///< of the meridian's s axis, global [m]
  Mat3 axes = Mat3::Identity();  ///< columns: s axis, direction of theta = 0, of theta = 90 degrees
};

/// Numerical integration of the volume.
struct SolidQuadrature {
  AngularRule angles;
  int points = 2;  ///< Gauss points each way; 2 is the reduced rule, free of volumetric locking
};

/// Velocity of the whole in the sense of momentum.
struct MeanMotion {
  double mass = 0;                       ///< [kg]
  Vec3 centre = Vec3::Zero();            ///< of mass, global [m]
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass, global [m/s]
  Vec3 momentum = Vec3::Zero();          ///< [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< about the centre of mass [kg m^2/s]
  Mat3 inertia = Mat3::Zero();           ///< about the centre of mass, present shape [kg m^2]
};

/// Finite-strain (or corotated small-strain) solid on a meridian mesh of eight-node elements with
/// quadratic meridian fields U_k(s, rho): u = sum_k U_k f_k(theta), in the axes of its placement.
/// Total Lagrangian; consistent mass. Equations: axial node by node, unknown by unknown; on the axis
/// only functions of order 0 have one. Harmonics of nonlinear elasticity: cf. E.L. Wilson, AIAA J. 3
/// (1965) for the linear semi-analytical method; sums over angles evaluate products here.
class HarmonicSolid final : public Term {
 public:
  /// `materials[layer]` for the mesh's layers. Adds its unknowns to `layout`. Throws
  /// std::invalid_argument where a material or the number of them cannot be.
  HarmonicSolid(DofMap& dof_map, mesh::Meridian mesh, FourierBasis basis, SolidQuadrature quadrature,
                std::vector<Solid> materials, Placement placement, std::string body = "ball");

  std::string body() const override { return body_; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  /// The functions that are odd: none of a solid that is struck in its plane of symmetry, little moved in any other
  /// blow.
  void weakly_coupled(std::vector<Index>& equations) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  const mesh::Meridian& mesh() const { return mesh_; }
  const FourierBasis& basis() const { return basis_; }
  const Placement& placement() const { return placement_; }
  const std::vector<Solid>& materials() const { return materials_; }
  Index unknowns() const { return static_cast<Index>(basis_.size()); }
  /// Equation of unknown k at a node; -1 where the axis leaves none.
  Index dof(int node, Index k) const { return dof_[static_cast<std::size_t>(node * unknowns() + k)]; }
  Index offset(int node, Index k) const;  ///< the same as an entry of State::q, or -1

  /// Meridian fields U (nodes x unknowns) of the state's displacement [m], velocity [m/s].
  Eigen::MatrixXd displacement_fields(const State& s) const { return fields(s.q, block_.q - block_.v); }
  Eigen::MatrixXd velocity_fields(const State& s) const { return fields(s.v, 0); }
  /// Reference position of a node at an angle, global.
  Vec3 reference(int node, double theta) const;
  /// The angular functions there, global: the vector of a row of fields is this times the row.
  Eigen::Matrix3Xd functions_at(double theta) const;

  /// Cauchy stress, extrapolated to the nodes and averaged over the elements that meet there: at each
  /// node and angle of `theta` a symmetric tensor in global axes [Pa], node by node (first all angles). Between the
  /// angles of the rule it is their trigonometric polynomial.
  std::vector<Sym> cauchy_at_nodes(const State& accepted, const std::vector<double>& theta) const;

  /// The velocity field of a rigid motion about the placement's origin [m/s; rad/s, global], where the
  /// solid has not moved yet. What the family cannot represent is left out.
  void set_velocity(State& s, const Vec3& linear, const Vec3& angular) const;

  MeanMotion motion(const State& s) const;
  Vec3 centre(const State& s) const;  ///< of mass alone, as motion() has it
  double mass() const;                ///< of the mesh [kg]
  /// The same before there is a solid. Throws std::invalid_argument on an element that is turned inside out.
  static double mass(const mesh::Meridian& mesh, const std::vector<Solid>& materials);
  const std::vector<double>& dissipated() const { return dissipated_; }  ///< by layer, cumulative [J]
  std::vector<double> strain_by_layer(const State& accepted) const;      ///< [J]

 private:
  struct Point {  // Gauss point of the meridian
    Eigen::Matrix<double, 8, 1> value, ds, drho;
    double rho = 0, weight = 0;  // of the meridian area times rho times the angular weight
  };
  static Point point(const mesh::Meridian& mesh, std::size_t element, double xi, double eta, double weight);
  static Eigen::Matrix<double, 8, 8> element_mass(const mesh::Meridian& mesh, std::size_t element, double density);
  struct Direction {  // the functions with a component along one Cartesian axis
    std::vector<Index> functions;
    Eigen::MatrixXd value, derivative;  // that component at each angle, zero beyond them: padded angles x functions
  };
  struct Coupling {  // of the functions of two directions: (k + l x count) x angles, products of value or derivative
    std::size_t left = 0, right = 0;
    Eigen::MatrixXd product[2][2];
  };
  struct Scratch;  // of an element's work
  /// Elements may be worked on at once, each on its own: what they find is put together in their order.
  template <class Work>
  void over_elements(const Work& work) const;
  void find_gradients(const State& s, std::size_t element, Scratch& scratch) const;
  template <class Visit>
  void visit_points(const State& s, const Mat3& mean, std::size_t element, Scratch& scratch, Visit&& visit) const;
  /// The same for several angles at a time, of a material that answers so; visit(point, point of the element, first
  /// angle, Mat3Lanes F, what the step from the history starts from).
  template <class Visit>
  void visit_lanes(const State& s, std::size_t element, Scratch& scratch, Visit&& visit) const;
  void add_stiffness(const State& s, double factor, const Mat3& mean, std::size_t element, Scratch& scratch,
                     Eigen::MatrixXd& ke) const;
  std::size_t points_per_element() const { return points_.size() / mesh_.elements.size(); }
  const Solid& material(std::size_t element) const {
    return materials_[static_cast<std::size_t>(mesh_.layer[element])];
  }
  std::span<const double> history_at(std::size_t point, Index angle) const;
  void element_fields(const Vector& numbers, Index offset, std::size_t element, Eigen::MatrixXd& fields) const;
  Eigen::MatrixXd fields(const Vector& numbers, Index shift) const;  // of all nodes
  Mat3 mean_rotation(const State& s) const;

  std::string body_;
  mesh::Meridian mesh_;
  FourierBasis basis_;
  SolidQuadrature quadrature_;
  std::vector<Solid> materials_;
  Placement placement_;
  DofMap::Block block_;
  std::vector<Index> dof_;
  std::vector<std::vector<Index>> element_equations_;      // free ones of each element
  std::vector<std::vector<int>> element_dofs_;             // their place i * K + k in the element's fields
  std::vector<Point> points_;                              // element by element
  std::vector<Eigen::Matrix<double, 8, 8>> element_mass_;  // density included, angular part not
  Eigen::MatrixXd gradients_;  // element by element 8 x 3 points: ds and drho point by point, then value / rho
  std::array<Direction, 3> directions_;
  std::vector<Coupling> couplings_;   // of each pair of directions, once
  std::vector<Mat3> frames_;          // columns e_s, e_rho, e_theta at each angle
  Index padded_ = 0;                  // angles, filled up to whole lanes
  Eigen::MatrixXd frame_components_;  // the same, component (c, J) in column c + 3 J: padded angles x 9
  Vector norms_;                      // integral of f_k . f_k over theta; of different functions it is zero
  bool corotated_ = false;
  Eigen::MatrixXd mean_gradient_;  // 9 x equations: volume mean of F - 1

  double time_ = 0;                         // of the last accepted state
  std::vector<std::size_t> history_start_;  // of each meridian point
  std::vector<double> history_;
  std::vector<double> dissipated_;
  /// What the step under way starts from, as start_step() makes it of the history: worked out by the first residual of
  /// a step for all that follow. Point by point, padded angles side by side; and the step of each element.
  mutable std::vector<double> starts_, starts_of_;
  /// What each element found last: storage that is not asked for anew in every iteration.
  struct Found {
    Eigen::MatrixXd force, inertia;
    Mat3 twist;         // integral of P F^T in Cartesian components
    double energy = 0;  // [J]
  };
  mutable std::vector<Found> found_;
  mutable Vector found_at_;  // the unknowns of which `found_` is, and their time
  mutable double found_time_ = NAN;
  bool is_found(const State& s) const;
  mutable std::vector<Eigen::MatrixXd> stiffness_;
  std::vector<std::size_t> start_of_point_;  // place in `starts_` of each meridian point
};

}  // namespace hosel::fem
