/// Normal blows on a face with a thickness by modal superposition: the rules' pendulum, and a ball by its force law.
#pragma once

#include <span>
#include <vector>

#include "golf/head.hpp"
#include "models/fe/plate_face.hpp"
#include "models/reduced/face_strike.hpp"

namespace hosel::models {

/// Free head and plate together, as a blow along Xc sees them: rigid motion and vibrations of both.
class PlateStrike {
 public:
  /// A head of infinite mass holds the rim still. Throws std::invalid_argument where the face outweighs the head.
  PlateStrike(std::shared_ptr<const PlateFace> plate, const Head& head);

  /// What a place offers a patch of this radius: participation of each mode, and what the modes leave out.
  struct Place {
    double mass = 0;                ///< of the head as it meets the blow [kg]
    Eigen::VectorXd participation;  ///< of each vibration [kg^-1/2]
    double compliance = 0;          ///< static, of the plate on a head at rest [m/N]
    double residual = 0;            ///< that the modes leave out [m/N]
  };
  Place at(const Eigen::Vector2d& place, double radius) const;

  /// The striker's force F = K d^n (1 + D d') on approach d, the residual compliance in series, from first touch until
  /// it is apart for good. Central differences for the modes.
  struct Strike {
    double restitution = 0;   ///< relative speed of striker and head's point after over before [-]
    double contact_time = 0;  ///< from first touch to last [s]
    double rise_time = 0;     ///< from 5 to 95 % of the change of the striker's speed by the first touch, over 0.713: a
                              ///< half sine of this rise lasts so long [s]
    double first_share = 0;   ///< of that change in all: a face that still vibrates may touch again [-]
    int touches = 0;          ///< 1: no bounce in between
  };
  Strike strike(const Striker& striker, const Place& place, double speed) const;

  /// The pendulum at a place: see models::CharacteristicTime; times are rise times. Throws solvers::NonConvergence
  /// where less than 0.8 of the sphere's change of speed comes from the first touch.
  CharacteristicTime characteristic_time(const Striker& sphere, const Eigen::Vector2d& place,
                                         std::span<const double> speeds) const;
  const PlateFace& plate() const { return *plate_; }
  const std::vector<double>& omega() const { return omega_; }  ///< of the vibrations on a free head [rad/s]

 private:
  std::shared_ptr<const PlateFace> plate_;
  Head head_;
  std::vector<double> omega_;
  Eigen::MatrixXd rigid_, elastic_;  // of (head's six motions, plate's modes): rigid motions, vibrations; columns
};

/// Radius over which the pendulum's small patch is spread in the plate's middle [m]: half of the thickness there.
double pendulum_patch(const PlateFace& plate, const Eigen::Vector2d& place);

}  // namespace hosel::models
