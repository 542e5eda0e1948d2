/// Friction at one point of a contact patch: traction as a pure function of slip and pressure.
#pragma once

#include <string>
#include <vector>

#include "golf/vector.hpp"

namespace hosel::fem {

/// What a law is told. Vectors are in the axes of the surface that is touched.
struct Slip {
  double pressure = 0;           ///< [Pa]
  Vec3 stretch = Vec3::Zero();   ///< tangential path from the point's anchor [m]
  Vec3 step = Vec3::Zero();      ///< tangential path while touching, since the last accepted state [m]
  Vec3 velocity = Vec3::Zero();  ///< tangential [m/s]
  Mat3 tangent = Mat3::Zero();   ///< projector on the tangent plane
  double path = 0;               ///< slid before the step [m]
};

/// What it answers.
struct Friction {
  Vec3 traction = Vec3::Zero();  ///< along the slip; the solid feels its negative [Pa]
  Vec3 elastic = Vec3::Zero();   ///< what of the stretch is kept: the anchor trails the point by it [m]
  double slip = 0;               ///< path along which the traction has dissipated in this step [m]
  double stored = 0;             ///< lost where the point lets go [J/m^2]
  bool sliding = false;
  // Derivatives of the traction; only where asked for.
  Vec3 by_pressure = Vec3::Zero();  ///< [-]
  Mat3 by_stretch = Mat3::Zero();   ///< [N/m^3]
  Mat3 by_velocity = Mat3::Zero();  ///< [N s/m^3]
};

/// A new law is a class beside coulomb.hpp. What states it is a field of PatchFriction (golf/contact_law.hpp) with its
/// faults, and a key of app/read_options.cpp; a branch of laws.cpp chooses it. CONTRIBUTING.md has every step.
class FrictionLaw {
 public:
  virtual ~FrictionLaw() = default;
  virtual Friction at(const Slip& slip, bool derivatives) const = 0;
  /// Whether by_velocity is ever anything but zero.
  virtual bool rate_dependent() const = 0;
  /// Sentences naming what cannot be; empty if all is well.
  virtual std::vector<std::string> faults() const = 0;
};

}  // namespace hosel::fem
