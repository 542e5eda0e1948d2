/// A face with a thickness: a plate on the head at its rim, its natural modes, and its condensation for a blow.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fem/plate.hpp"
#include "fem/reduced_face.hpp"
#include "fem/shape_spline.hpp"
#include "golf/face.hpp"
#include "models/fe/struck_face.hpp"

namespace hosel::models {

/// What an engineer states of a face. Axes of the outline and the thickness: y towards the heel, z up.
struct PlateDesign {
  mesh::PlateOutline outline;
  mesh::PlateThickness thickness;
  fem::PlateMaterial material{114e9, 0.34, 4430};  ///< titanium (Ti-6Al-4V)
  fem::RimSupport rim;
  double damping = 0.01;  ///< of each mode, over the critical [-]
  mesh::PlateMeshOptions mesh;
  std::optional<double> yield;  ///< stress at which the material yields [Pa]; used by no equation
  int modes = 8;                ///< of the rim at rest that a blow keeps; the pendulum keeps four times as many

  std::vector<std::string> faults() const;
  /// To a hundredth, without a mesh [kg].
  double mass() const;
  /// Whether toe and heel are alike by what is stated: the outline is no polygon, the thickness no grid.
  bool heel_toe_alike() const;
};

/// A plate as a blow about one place sees it: natural modes of the plate whose rim rests in the head, and what static
/// pressure about the place adds to them. Unknowns are the largest deflections of their shapes [m].
struct CondensedPlate {
  fem::ReducedFace face;
  std::shared_ptr<const fem::ShapeSpline> shapes;
  Eigen::VectorXd largest;  ///< of each shape over the face: 1
  Eigen::MatrixXd fields;   ///< of the plate's equations, a column for each unknown
};

class PlateFace {
 public:
  /// Throws std::invalid_argument on a design that cannot be, solvers::NonConvergence where the modes are not found.
  PlateFace(PlateDesign design, const Face& curvature);

  const PlateDesign& design() const { return design_; }
  const Face& curvature() const { return curvature_; }
  const fem::Plate& plate() const { return *plate_; }
  const fem::System& system() const { return system_; }
  double mass() const { return mass_; }                        ///< [kg]
  const std::vector<double>& omega() const { return omega_; }  ///< natural, ascending [rad/s]
  const Eigen::MatrixXd& modes() const { return modes_; }      ///< of the plate's equations, mass-normalised
  bool symmetric(Mirror mirror) const;
  bool covers(const Eigen::Vector2d& place) const { return design_.outline.share(place) < 1; }

  /// Unit force spread over a disc as 1 - r^2/a^2; what lies outside of the outline the head carries.
  fem::Vector patch_load(const Eigen::Vector2d& place, double radius) const;
  fem::Vector solve(const fem::Vector& load) const;  ///< static deflection
  /// Mean deflection of such a patch per force [m/N].
  double compliance(const Eigen::Vector2d& place, double radius) const;

  /// With `mirror`, of the shapes that are their own mirror image. Throws std::invalid_argument where the face is not.
  CondensedPlate condensed(const Eigen::Vector2d& place, Mirror mirror = Mirror::none) const;

  /// Largest von Mises stress of a deflection over both surfaces, at the corners and centres of the elements [Pa].
  class Stresses {
   public:
    Stresses(const fem::Plate& plate, const Eigen::MatrixXd& fields);
    FacePeak peak(const fem::Vector& unknowns) const;

   private:
    std::vector<Eigen::Vector2d> places_;
    Eigen::MatrixXd rows_;  // six a place: both sides' yy, zz, yz
  };

 private:
  fem::Vector mirrored(const fem::Vector& field, Mirror mirror) const;

  PlateDesign design_;
  Face curvature_;
  fem::System system_;
  const fem::Plate* plate_ = nullptr;
  double mass_ = 0;
  std::vector<double> omega_;
  Eigen::MatrixXd modes_;
  Eigen::SparseMatrix<double> inertia_, stiffness_;
  struct Factors;
  std::shared_ptr<const Factors> factors_;
  std::vector<int> mirror_[2];  // node of each node's image; empty where there is none
  Eigen::Vector2d grid_from_, grid_to_;
  int grid_columns_ = 0, grid_rows_ = 0;
  Eigen::SparseMatrix<double> on_grid_, on_samples_;  // deflection there, from the plate's equations
  Eigen::VectorXd sample_mass_;
  Eigen::Matrix3Xd sample_place_;
};

/// Radius of a golf ball's patch, in the mean over a blow at a driver's speed [m].
inline constexpr double kBallPatch = 9e-3;

/// A plate that is made when a blow first asks for it, once for each curvature of the face; a blow meets it condensed
/// about the place struck.
class PlateOnDemand final : public StruckFace {
 public:
  explicit PlateOnDemand(PlateDesign design) : design_(std::move(design)) {}
  const PlateDesign& design() const { return design_; }
  std::shared_ptr<const PlateFace> on(const Face& curvature) const;

  std::vector<std::string> faults(bool axial) const override;
  bool symmetric(Mirror mirror, const Face& curvature) const override { return on(curvature)->symmetric(mirror); }
  FaceInSystem add(fem::System& system, const FaceBlow& struck) const override;

 private:
  PlateDesign design_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const PlateFace> made_;
};

}  // namespace hosel::models
