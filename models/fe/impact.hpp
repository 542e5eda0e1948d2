/// The finite-element impact: a deformable ball, the head with its face, the contact between them, and the shaft of a
/// full club.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/beam.hpp"
#include "fem/contact.hpp"
#include "fem/rigid_body.hpp"
#include "mesh/meridian.hpp"
#include "models/club/mounted_shaft.hpp"
#include "models/fe/contact_frame.hpp"
#include "models/fe/fe_ball.hpp"
#include "models/fe/struck_face.hpp"
#include "models/impact_model.hpp"
#include "solvers/generalized_alpha.hpp"
#include "solvers/peak.hpp"

namespace hosel::models {

/// How fine space and time are resolved: within some 3 %, 0.5 %, 0.1 % of ball speed, launch angle and spin.
enum class Accuracy { look, standard, reference };

/// The ball, a face of its own where the head's is not meant, and how the impact is solved. Head, friction and place
/// are the blow's.
struct FeImpactOptions {
  FeBall ball = range_ball();
  std::shared_ptr<const StruckFace> face = {};  ///< none: the head's own, rigid or with its compliance

  mesh::MeridianOptions mesh;
  int harmonics = 4;       ///< N; 0 is the axisymmetric ball
  int antisymmetric = 2;   ///< harmonics across the plane of the slip, where the blow has no plane of symmetry
  int angles = 0;          ///< of the volume over the half circle; 0: 2 N + 4
  int contact_angles = 0;  ///< of the patch over the half circle; 0: 3 N + 8
  int edge_points = 4;     ///< Gauss points of the patch along an edge
  /// Of the mesh's axis, against the turn of the ball [rad]; where not set, half of the turn that a gripping ball is
  /// expected to make in contact, so that the patch wanders to both sides of the pole.
  std::optional<double> tilt;

  std::string method = "penalty";  ///< one of fem::contact_methods()
  /// That it leaves over the radius, where it reaches one [-]. The patch has more points than the solid has functions
  /// there: below 1e-4 their gaps cannot all close, and the patch stiffens.
  double penetration = 2e-4;
  double penalty = 1000;            ///< contact pressure stiffness times radius over Young's modulus [-]
  double tangential_penalty = 0.5;  ///< tangential stiffness over normal stiffness [-]

  /// Of generalized-alpha. Above about 0.7 the patch's penalty chatters at the step's own frequency and
  /// may gain energy; restitution does not depend on it from 0.2 to 0.6.
  double rho_inf = 0.5;
  int steps_per_contact = 120;    ///< of the contact time of Hertz's theory
  double newton_relative = 1e-5;  ///< residual over the size of the forces
  double after = 0.05;            ///< time computed after contact, as a fraction of the contact time

  /// Sets sectors and rings of the mesh, harmonics and steps; leaves the rest.
  void resolve(Accuracy accuracy);
  /// A sector and a ring less, two harmonics less (across the plane of the slip one), half the steps: what a run
  /// changes by against these bounds its error. Nothing where there is no less.
  std::optional<FeImpactOptions> coarser() const;

  /// Sentences naming what cannot be; empty if all is well.
  std::vector<std::string> faults() const;
};

/// The bodies of one blow in one system, as they stand at first contact. The system owns them.
struct ImpactBodies {
  fem::System system;
  fem::State initial;
  ContactFrame frame;
  Mat3 mesh_axes;  ///< of the ball's mesh: those of the frame, turned about the third by the tilt
  fem::HarmonicSolid* ball = nullptr;
  fem::Contact* contact = nullptr;
  const fem::RigidBody* head = nullptr;                                             ///< absent for a wall
  const fem::Beam* shaft = nullptr;                                                 ///< of a whole club
  const fem::FaceSpring* face = nullptr;                                            ///< of a face that yields
  double compliance = 0;                                                            ///< of it where it is struck [m/N]
  std::function<std::function<FacePeak(const fem::Vector&)>()> face_stresses = {};  ///< see FaceInSystem
  double contact_time = 0;                                                          ///< that Hertz's theory expects [s]
};

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
  const ImpactBodies& bodies;
  const fem::State& state;
  const fem::HarmonicSolid& ball;
  const fem::Contact& contact;
  const fem::ContactReport& report;
  const solvers::Ledger& ledger;
  fem::SurfacePose face;
  const fem::Beam* shaft = nullptr;  ///< of a whole club
  std::function<ImpactCheckpoint()> checkpoint;
};
using ImpactObserver = std::function<void(const ImpactView&)>;

/// The largest von Mises stress of a face with a thickness over a blow, by an observer that sees every step.
class FaceStress {
 public:
  /// Of a blow on a face that knows no stress nothing is seen.
  void see(const ImpactView& view);
  /// Nothing where no stress was seen.
  const std::optional<FacePeak>& peak() const { return peak_; }

 private:
  std::function<FacePeak(const fem::Vector&)> stresses_;
  std::optional<FacePeak> peak_;
};

struct FeOutcome {
  FeImpactResult result;
  Launch launch;
  ContactFrame frame;
  Mat3 mesh_axes;  ///< see ImpactBodies
};

/// `fe-free-body` and, with a shaft, `fe-full-club`: asks its bodies, and knows nothing of them beside.
class Impact final : public ImpactModel {
 public:
  /// A free head, or a wall where its mass is infinite. Throws std::invalid_argument with the first of the faults.
  explicit Impact(FeImpactOptions options);
  /// A head on the blow's shaft: at first contact unloaded, moving with the head as one rigid body, or as `mount` says.
  Impact(FeImpactOptions options, ShaftMount mount);

  /// Throws std::invalid_argument on a blow that these bodies cannot meet, solvers::NonConvergence.
  ImpactBodies assemble(const Blow& blow) const;
  /// Until contact has ended. `from`: a checkpoint that an observer of the same blow and options was given.
  FeOutcome run(const Blow& blow, const ImpactObserver& observer = {}, const ImpactCheckpoint* from = nullptr) const;
  Launch launch(const Blow& blow) const override { return run(blow).launch; }
  const Impact* impact() const override { return this; }

  const FeImpactOptions& options() const { return options_; }
  bool whole_club() const { return mount_.has_value(); }

 private:
  FeImpactOptions options_;
  std::optional<ShaftMount> mount_;
};

}  // namespace hosel::models
