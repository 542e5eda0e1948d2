/// Small vibrations of a shaft clamped on the bench, with or without its head; fast enough for fits.
///
/// Axes are the grip's: ZG along the shaft from tip to butt, XG the lead direction, YG the droop direction. A
/// cantilever is statically determinate, so its flexibility F is a sum of compliances (bending, torsion, the
/// clamp, the hosel), each with a factor of its own, and zero compliance is as regular as any other. With the mass
/// matrix M the modes are F M u = u / omega^2, projected on a basis V that holds the modes and static responses of
/// several such clubs (Rayleigh-Ritz on the inverse operator).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "golf/blow.hpp"

namespace hosel::models {

/// What may differ from the declared club and its supports; all zero: nothing does.
struct ClubChange {
  double bending = 0;           ///< log of the factor on bending and axial stiffness
  double torsion = 0;           ///< log of the factor on torsional and shear stiffness
  double damping_time = 0;      ///< added to the shaft's own, stiffness-proportional [s]
  double mass_damping = 0;      ///< force = -rate * mass * velocity [1/s]
  double damping_ratio = 0;     ///< added to that of every mode
  Vec3 clamp = Vec3::Zero();    ///< rotational compliance of the clamp about XG, YG, ZG [rad/(N m)]
  Vec3 hosel = Vec3::Zero();    ///< the same between shaft tip and head
  double tip_mass = 0;          ///< added at the hosel [kg]
  Vec3 cg = Vec3::Zero();       ///< shift of the head's centre of gravity, face frame [m]
  Vec3 inertia = Vec3::Zero();  ///< logs of the factors on the head's inertia about the face axes
  double stiffening = 0;        ///< share of the centrifugal stiffness that is felt

  bool operator==(const ClubChange&) const = default;
};

/// The head with its change: inertia about face axis k times exp(inertia[k]) (both sides by the root), and the
/// centre shifted; the mass at the hosel is not in it.
Head changed(const Head& head, const ClubChange& change);

struct BenchSensor {
  enum class Quantity { lead, droop, shortening, twist, strain_lead, strain_droop };
  Quantity quantity = Quantity::lead;
  double arc_length = 0;         ///< from the butt; the nearest node for motions [m]
  std::optional<double> radius;  ///< of a strain gauge from the shaft's axis; none: the outer radius [m]
};

struct BenchOptions {
  int elements = 12;
  bool shear = true;            ///< Timoshenko; false: Rayleigh
  double clamped_length = 0;    ///< from the butt [m]
  Vec3 gravity = Vec3::Zero();  ///< grip axes; its pull along the declared club counts, sag does not: readings are from
                                ///< rest [m/s^2]
  double rotation_rate = 0;     ///< of the clamp about `rotation_axis` [rad/s]
  Vec3 rotation_axis = Vec3::UnitY();  ///< XG or YG
  double hub = 0;                      ///< of the clamp from the axis of rotation [m]

  std::vector<std::string> faults() const;
};

/// Vibrations of a club on the bench; shapes have unit modal mass.
struct BenchModes {
  Eigen::VectorXd omega;    ///< ascending [rad/s]
  Eigen::VectorXd ratio;    ///< damping ratio
  Eigen::MatrixXd sensors;  ///< sensors x modes, SI per unit of the modal coordinate
  Eigen::MatrixXd tip;      ///< 6 x modes: motion of the hosel (head side), translation then rotation
  Eigen::MatrixXd base;     ///< 3 x modes: modal force per negative acceleration of the clamp
};

class Bench {
 public:
  /// Throws std::invalid_argument on a club without shaft, bad options, a sensor that is not on the free shaft.
  Bench(const Club& club, bool with_head, const BenchOptions& options, const std::vector<BenchSensor>& sensors);

  BenchModes modes(const ClubChange& change, int count = 24) const;

 private:
  Eigen::Matrix<double, 6, 6> head_mass(const ClubChange& change) const;

  Club club_;
  bool with_head_;
  BenchOptions options_;
  double length_ = 0, damping_time_ = 0;
  int basis_ = 0;                      // vectors of V
  std::vector<Eigen::MatrixXd> flex_;  // W' F_a W of each compliance a
  std::vector<Eigen::MatrixXd> read_;  // sensors' rows of F_a W
  Eigen::MatrixXd head_shape_;         // V at the head's six degrees of freedom
  Eigen::MatrixXd base_shape_;         // V' M0 r of the clamp's three translations
  Eigen::MatrixXd weight_, spin_;      // V' K V of gravity, and of one (rad/s)^2
  Eigen::Matrix<double, 6, 6> head0_;
};

}  // namespace hosel::models
