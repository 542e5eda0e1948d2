/// The finite-element impact: a deformable ball meets the face of a rigid head.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/beam.hpp"
#include "fem/contact.hpp"
#include "fem/face_spring.hpp"
#include "fem/friction/slip_weakening.hpp"
#include "fem/rigid_body.hpp"
#include "golf/first_contact.hpp"
#include "mesh/meridian.hpp"
#include "models/fe/fe_ball.hpp"
#include "models/fe/plate_face.hpp"
#include "models/impact_model.hpp"
#include "solvers/generalized_alpha.hpp"
#include "solvers/peak.hpp"

namespace hosel::models {

/// How fine space and time are resolved: within some 3 %, 0.5 %, 0.1 % of ball speed, launch angle and spin.
enum class Accuracy { look, standard, reference };

/// How the impact is solved.
struct FeImpactOptions {
  FeBall ball = range_ball();
  double friction = 0.4;                               ///< Coulomb's coefficient between ball and face [-]
  std::optional<double> transition_speed;              ///< where set, friction is regularised by velocity [m/s]
  std::optional<fem::StaticFriction> static_friction;  ///< where set, what holds a point until it has slid some way

  std::optional<FaceCompliance> face;               ///< of the club; without it and a plate the face is rigid
  std::shared_ptr<const PlateOnDemand> plate = {};  ///< of the club: a face with a thickness

  mesh::MeridianOptions mesh;
  int harmonics = 4;       ///< N; 0 is the axisymmetric ball
  int antisymmetric = 2;   ///< harmonics across the plane of the slip, where the blow has no plane of symmetry
  int angles = 0;          ///< of the volume over the half circle; 0: 2 N + 4
  int contact_angles = 0;  ///< of the patch over the half circle; 0: 3 N + 8
  int edge_points = 4;     ///< Gauss points of the patch along an edge
  /// Of the mesh's axis, against the turn of the ball [rad]; where not set, half of the turn that a gripping ball is
  /// expected to make in contact, so that the patch wanders to both sides of the pole.
  std::optional<double> tilt;

  double penalty = 1000;            ///< contact pressure stiffness times radius over Young's modulus [-]
  double tangential_penalty = 0.5;  ///< tangential stiffness over normal stiffness [-]

  /// Of generalized-alpha. Above about 0.7 the patch's penalty chatters at the step's own frequency and
  /// may gain energy; restitution does not depend on it from 0.2 to 0.6.
  double rho_inf = 0.5;
  int steps_per_contact = 120;    ///< of the contact time of Hertz's theory
  double newton_relative = 1e-6;  ///< residual over the size of the forces
  double after = 0.05;            ///< time computed after contact, as a fraction of the contact time

  /// Sets sectors and rings of the mesh, harmonics and steps; leaves the rest.
  void resolve(Accuracy accuracy);
  /// A sector and a ring less, two harmonics less, half the steps: what a run changes by against these bounds its
  /// error. Nothing where there is no less.
  std::optional<FeImpactOptions> coarser() const;

  /// Sentences naming what cannot be; empty if all is well.
  std::vector<std::string> faults() const;
};

/// The ball and its contact inside a system; owned by it.
struct BallOnFace {
  fem::HarmonicSolid* ball = nullptr;
  fem::Contact* contact = nullptr;
  const fem::FaceSpring* face = nullptr;         ///< of a face that yields
  double compliance = 0;                         ///< of it where it is struck [m/N]
  std::shared_ptr<const PlateFace> plate = {};   ///< that is the face
  std::optional<CondensedPlate> condensed = {};  ///< of it about the place struck
  const fem::Beam* shaft = nullptr;              ///< of a full club, for observers
};

/// First contact, and what of it is symmetric.
struct Encounter : FirstContact {
  double normal_speed = 0;       ///< approach along the normal [m/s]
  bool axial = false;            ///< nothing but a normal blow through the centres
  bool planar = false;           ///< a plane of symmetry exists
  bool principal = false;        ///< the plane of normal and slip is one of the face's own about its centre
  bool across_heel_toe = false;  ///< a principal plane is the one of out and up, not of out and heel-toe
  Mat3 ball_axes;                ///< contact pole, direction of slip, across both
  /// The face's mirror by a principal plane.
  Mirror mirror() const { return !principal ? Mirror::none : across_heel_toe ? Mirror::heel_toe : Mirror::up_down; }
};
/// Throws std::invalid_argument where the head moves away from the ball.
Encounter encounter(const Blow& blow);

/// The angle by which the ball will turn while it touches [rad], to a fifth or so: a spin 1.3 times that of rolling, or
/// what friction allows, that grows over a contact a good third longer than Hertz's with the instant modulus.
double expected_turn(const Blow& blow, const FeImpactOptions& options);

/// Axes of the ball's mesh: those of the encounter, turned about the third by the tilt.
Mat3 mesh_axes(const Blow& blow, const FeImpactOptions& options);

/// Adds ball and contact to a system whose face is carried by `carrier`: the way in for a head on a
/// shaft. `free` says that the carrier may move out of the blow's plane of symmetry.
BallOnFace add_ball(fem::System& system, const Blow& blow, const FeImpactOptions& options,
                    const fem::SurfaceCarrier& carrier, bool free);

/// What the impact was.
struct FeImpactResult {
  Vec3 ball_velocity = Vec3::Zero();  ///< of the centre of mass: momentum over mass, global [m/s]
  /// Angular momentum over the undeformed mesh's own inertia: the spin that the ball keeps once its
  /// vibration has died away, global [rad/s].
  Vec3 ball_spin = Vec3::Zero();
  double contact_time = 0;         ///< from first to last touch, see Release [s]
  double peak_force = 0;           ///< largest normal force, by solvers::Peak as the other largest values [N]
  double peak_time = 0;            ///< when [s]
  double compression = 0;          ///< largest approach of ball centre and face along the normal [m]
  double penetration = 0;          ///< largest of the patch [m]
  double creep = 0;                ///< largest elastic slip of a sticking point [m]
  double face_travel = 0;          ///< largest, at the face centre [m]
  double face_energy = 0;          ///< left in a face that yields when it is over [J]
  std::vector<double> dissipated;  ///< by layer [J]
  solvers::Ledger ledger;
  solvers::GeneralizedAlpha::Counts counts;
  fem::State last;  ///< when it was over
};

/// When contact ends, from the normal force in its last steps: Hertz's falls with (end - t)^(3/2), so its power 2/3
/// runs straight to zero. The step in which the last point lets go is known to a step only: after it the gap opens at
/// once.
struct Release {
  static constexpr std::size_t kSteps = 4;
  std::array<double, kSteps> time{}, force{};  ///< the last steps in contact, the latest last [s], [N]
  std::size_t known = 0;
  bool apart = false;  ///< since the last of them

  void add(double now, double normal_force, bool touching);
  /// Nothing where fewer steps are known, or where the force did not fall: a skin that bounces.
  std::optional<double> end() const;
};

/// An impact under way: all that is needed to go on exactly where it was.
struct ImpactCheckpoint {
  solvers::Checkpoint solver;
  FeImpactResult so_far;  ///< what grows with the steps: penetration, creep, counts
  solvers::Peak force, compression, face_travel;
  bool touched = false, over = false;
  double last_touch = 0;    ///< between the steps, where the last point let go [s]
  double last_nearest = 0;  ///< smallest gap of the patch after the last step [m]
  double last_gap = 0;      ///< between ball centre and face [m]
  Release release;
};

/// What an observer sees after every accepted step, and once at the start.
struct ImpactView {
  const fem::System& system;
  const fem::State& state;
  const fem::HarmonicSolid& ball;
  const fem::Contact& contact;
  const fem::ContactReport& report;
  const solvers::Ledger& ledger;
  fem::SurfacePose face;
  double expected_end = 0;           ///< when Hertz's theory would have contact end [s]
  const fem::Beam* shaft = nullptr;  ///< of a full club
  const BallOnFace* parts = nullptr;
  std::function<ImpactCheckpoint()> checkpoint;
};
using ImpactObserver = std::function<void(const ImpactView&)>;

/// The largest von Mises stress of a face with a thickness over a blow, by an observer that sees every step.
class FaceStress {
 public:
  /// Of a blow on any other face nothing is seen.
  void see(const ImpactView& view);
  /// Nothing where no face with a thickness was seen.
  const std::optional<PlateFace::Peak>& peak() const { return peak_; }

 private:
  std::optional<PlateFace::Stresses> stresses_;
  std::optional<PlateFace::Peak> peak_;
};

struct FeOutcome {
  FeImpactResult result;
  Launch launch;
};

/// A model whose impact can be watched step by step, and gone on with from where it stopped.
class FeModel : public ImpactModel {
 public:
  /// `from`: a checkpoint that an observer of the same blow and options was given.
  virtual FeOutcome solve(const Blow& blow, const ImpactObserver& observer = {},
                          const ImpactCheckpoint* from = nullptr) const = 0;
  Launch launch(const Blow& blow) const final { return solve(blow).launch; }
};

/// Runs a system with a ball until contact has ended. `initial` holds the velocities at first contact.
/// Throws solvers::NonConvergence.
FeImpactResult run_impact(fem::System& system, const BallOnFace& parts, fem::State initial,
                          const FeImpactOptions& options, double approach_speed, const ImpactObserver& observer = {},
                          const ImpactCheckpoint* from = nullptr);

/// What the ball does, from the result; the head's motion is the caller's to add.
Launch launch_of(const FeImpactResult& result);

/// A free head (a wall where its mass is infinite) and the ball.
struct FreeBodyImpact {
  fem::System system;
  BallOnFace parts;
  const fem::RigidBody* head = nullptr;  ///< absent for a wall
  fem::State initial;
  Encounter encounter;
};
FreeBodyImpact assemble_free_body(const Blow& blow, const FeImpactOptions& options);

FeOutcome solve_free_body(const Blow& blow, const FeImpactOptions& options, const ImpactObserver& observer = {},
                          const ImpactCheckpoint* from = nullptr);

/// `fe-free-body` behind the common interface.
class FeFreeBody final : public FeModel {
 public:
  explicit FeFreeBody(FeImpactOptions options);
  FeOutcome solve(const Blow& blow, const ImpactObserver& observer, const ImpactCheckpoint* from) const override;

 private:
  FeImpactOptions options_;
};

}  // namespace hosel::models
