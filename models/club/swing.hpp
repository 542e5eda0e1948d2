/// A flexible club driven at the grip: the swing, up to impact.
///
/// Everything is in the grip frame's axes before the motion: origin at the grip point on the shaft's
/// axis, ZG towards the butt, XG in the lead direction (the face's normal, across the shaft), YG = ZG x XG,
/// the droop direction.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fem/beam.hpp"
#include "fem/rigid_body.hpp"
#include "fem/supports.hpp"
#include "golf/blow.hpp"
#include "golf/units.hpp"
#include "models/club/head_joint.hpp"
#include "solvers/generalized_alpha.hpp"

namespace hosel::models {

/// What integrates the swing.
enum class SwingIntegrator {
  generalized_alpha,  ///< own Lie-group scheme (solvers/generalized_alpha.hpp), fixed step
  ida,                ///< SUNDIALS IDA (solvers/ida.hpp), variable order and step; no energy ledger
};

struct SwingOptions {
  SwingIntegrator integrator = SwingIntegrator::generalized_alpha;
  bool kinsol = false;  ///< equilibria by SUNDIALS KINSOL instead of Newton
  int elements = 20;
  double growth = 1;        ///< of the elements' lengths towards the tip
  double step = 1e-3;       ///< [s]
  double rho_inf = 0.8;     ///< of generalized-alpha
  double tolerance = 1e-6;  ///< of Newton: forces, of what acts; displacements, of 0.1 m or rad
  bool shear = true;        ///< Timoshenko; false: Rayleigh
  double grip_point = 0;    ///< arc length of the grip point from the butt; the shaft above it is the hands' [m]
  Vec3 gravity = Vec3(0, 0, -kGravity);
  HeadJoint joint;
  /// Damping ratios of the club's first modes, held at the grip, beside the shaft's own damping time.
  std::vector<double> modal_damping = {};

  std::vector<std::string> faults() const;
};

/// What drives the grip.
struct GripDrive {
  enum class Kind { prescribed, forced, hands, free } kind = Kind::prescribed;
  fem::Motion motion;                         ///< prescribed, hands; of all kinds the pose at the start
  std::function<fem::Wrench(double)> wrench;  ///< forced: force global, moment in grip axes
  fem::JointStiffness hands;                  ///< hands
};

/// The club at one time.
struct SwingSample {
  double time = 0;             ///< [s]
  double lead = 0;             ///< hosel from its place on the rigid club along XG [m]
  double droop = 0;            ///< along YG [m]
  double shortening = 0;       ///< along ZG [m]
  Vec3 twist = Vec3::Zero();   ///< rotation vector of the hosel in the grip frame [rad]
  fem::Pose grip, head;        ///< head: position of the cg, rotation face frame to global
  Vec3 force = Vec3::Zero();   ///< of the hands on the club, global [N]
  Vec3 moment = Vec3::Zero();  ///< about the grip point, grip axes [N m]
};

/// Rotation from face to grip axes of a club, before any bending.
Mat3 face_to_grip(const ClubGeometry& geometry);

/// The delivery of a head at a pose: speed, attack, path of the cg, loft and face angle.
Delivery delivery_of(const fem::Pose& head);
/// What a Delivery leaves out of the pose: the turn of the face about its normal, positive toe up [rad].
double dynamic_lie(const fem::Pose& head);
/// The same club described in a face frame turned about the normal by `angle`, so that a head with that
/// dynamic lie has none. Throws std::invalid_argument where bulge and roll differ.
Club turned_about_normal(Club club, double angle);

/// A club in a system of its own.
class Swing {
 public:
  /// Throws std::invalid_argument on a club without shaft, or bad options.
  Swing(const Club& club, const SwingOptions& options, GripDrive drive);

  /// Static equilibrium under gravity with the grip held as it is at `time`. Throws std::invalid_argument, as hold()
  /// does, where nothing holds the club.
  fem::State equilibrium(double time);
  /// The grip held for `seconds` up to `time`, from the straight shaft: what an experiment does.
  fem::State hold(double time, double seconds);
  /// What `equilibrium` or `hold` found, moving as a rigid body with the grip: where springs hold it, as they hold it.
  fem::State start(double time, const fem::State& deflected) const;

  using Observer = std::function<void(const SwingSample&)>;
  using StateObserver = std::function<void(const SwingSample&, const fem::State&)>;
  /// Integrates from `from` to `end`; the observer sees the start and every step. Returns the last state.
  fem::State run(const fem::State& from, double end, const Observer& observer);
  fem::State watch(const fem::State& from, double end, const StateObserver& observer);

  SwingSample sample(const fem::State& s, const fem::Vector& reactions) const;
  const fem::System& system() const { return system_; }
  const fem::Beam& shaft() const { return *shaft_; }
  const fem::RigidBody* head() const { return head_; }
  const fem::Node& head_node() const { return head_node_; }
  const Mat3& face_to_grip() const { return face_to_grip_; }
  const Vec3& gravity() const { return options_.gravity; }
  double mass() const;
  const solvers::Ledger& ledger() const { return ledger_; }  ///< of the last run by generalized-alpha
  const solvers::GeneralizedAlpha::Counts& counts() const { return counts_; }

 private:
  void check_held() const;
  fem::State straight(double time) const;
  fem::State carried(const fem::State& shape, const fem::Pose& from, const fem::Pose& grip, double time) const;
  solvers::NewtonOptions newton() const;
  solvers::GeneralizedAlpha scheme(const fem::State& from);
  fem::State by_ida(const fem::State& consistent, double end, const StateObserver& observer);
  std::unique_ptr<fem::Term> modal_damping();

  Club club_;
  SwingOptions options_;
  GripDrive drive_;
  fem::System system_;
  fem::Beam* shaft_ = nullptr;
  fem::RigidBody* head_ = nullptr;
  const fem::SpringJoint* hands_ = nullptr;  // of a drive by hands
  fem::Node head_node_;
  Mat3 face_to_grip_;
  double length_ = 0;
  std::optional<double> held_;  // the grip stands still as it is at this time
  solvers::Ledger ledger_;
  solvers::GeneralizedAlpha::Counts counts_;
};

}  // namespace hosel::models
