/// Impact by the volume of interpenetration, with smooth friction and a ball of core and cover.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "models/impact_model.hpp"
#include "models/reduced/shaft_impedance.hpp"

namespace hosel::models {

/// What the ball and its contact are made of.
/// Normal force F_n = k_V V (1 + d_V v_n), V the overlap of the undeformed ball with the face (a sphere
/// of the face's mean curvature at its centre, (1/bulge + 1/roll) / 2), v_n the approach speed; it acts
/// at the overlap's centroid. Gonthier et al. (2004), Multibody Syst. Dyn. 11:209; Caldwell and McPhee
/// (2024), Sports Eng. 27:16.
/// Friction F_t = F_n (mu tanh(4 s) + (mu_s - mu) s / (s^2/4 + 3/4)^2), s = v_t / v_tr: Brown and McPhee
/// (2016), J. Comput. Nonlin. Dyn. 11:054502, without its viscous part.
/// A head's compliance is in series with all this, its effective mass at the face centre, as in fem/face_spring.hpp;
/// without one the face is rigid, bit for bit. The published driver's damping was identified on a driver: it holds a
/// yielding face already.
/// The ball is a core in a cover of the same density, which share their centre and are joined by a
/// rotary spring and damper about all three axes: the tangential compliance.
struct VolumetricLaw {
  double stiffness = 6.25e9;         ///< k_V [N/m^3]
  double damping = 6.42e-3;          ///< d_V [s/m]
  double friction = 0.372;           ///< mu [-]
  double static_friction = 0.372;    ///< mu_s [-]; equal to mu: no peak
  double transition_speed = 0.936;   ///< v_tr [m/s]
  double joint_stiffness = 13.5;     ///< [N m/rad]
  double joint_damping = 2.53e-3;    ///< [N m s/rad]
  double cover_thickness = 1.26e-3;  ///< [m]
  /// V in the normal force becomes V_0 (V / V_0)^exponent, V_0 = 1 cm^3. 1: the published law, force like depth
  /// squared. The finite-element ball pushes like depth^1.2 (exponent 0.6), a flatter and wider pulse.
  double volume_exponent = 1;

  /// Table 8 of Caldwell and McPhee (2024); their ball's radius is 21.3 mm.
  static VolumetricLaw published_driver() { return {}; }
  static VolumetricLaw published_iron7() { return {6.83e9, 9.26e-3, 0.489, 0.489, 0.812, 34.1, 13.2e-3, 2.55e-3}; }
};

/// Two ways through the same equations.
enum class Integrator {
  rosenbrock,  ///< own linearly implicit method of order 3 (solvers/rosenbrock_w.hpp): microseconds
  cvode,       ///< SUNDIALS CVODE, BDF with root finding: the reference
};

struct VolumetricOptions {
  Integrator integrator = Integrator::rosenbrock;
  /// Relative error a step may make. The cost is that of evaluating the rates (closest point on the doubly curved
  /// face, finite rotation, smooth friction: one long chain of dependent operations), four times in each step, and
  /// falls only with the cube root of the tolerance; `bench_reduced` prints cost and error.
  double tolerance = 1e-4;
};

/// One instant of the contact, for histories. Impulses and forces act on the ball.
struct ContactSample {
  double time = 0;                       ///< since first contact [s]
  double depth = 0;                      ///< approach of ball and face [m]
  double normal_force = 0;               ///< [N]
  Vec3 tangential_force = Vec3::Zero();  ///< global frame [N]
  Vec3 slip = Vec3::Zero();              ///< velocity of the face past the ball there, global frame [m/s]
};

/// Where the energy went; every column is computed for itself [J].
struct EnergyLedger {
  double kinetic_before = 0, kinetic_after = 0;
  double stored_contact = 0;  ///< k_V times the overlap's potential, at the end
  double stored_joint = 0;    ///< in the rotary spring, at the end
  double stored_shaft = 0;    ///< kinetic and elastic in the shaft beyond the head, at the end
  double stored_face = 0;     ///< in the face's spring and in its motion against the head, at the end
  double lost_normal = 0, lost_friction = 0, lost_joint = 0, lost_shaft = 0, lost_face = 0;
  double work_of_carrier = 0;  ///< done on the moving frame in which the shaft is at rest before the blow
  /// What is missing, relative to the kinetic energy before.
  double gap() const {
    return (kinetic_before + work_of_carrier - kinetic_after - stored_contact - stored_joint - stored_shaft -
            stored_face - lost_normal - lost_friction - lost_joint - lost_shaft - lost_face) /
           kinetic_before;
  }
};

struct VolumetricResult {
  Launch launch;
  EnergyLedger energy;
  Vec3 ball_displacement = Vec3::Zero();  ///< of the ball's centre during contact, global frame [m]
  Vec3 head_displacement = Vec3::Zero();  ///< of the head's cg during contact, global frame [m]
  Mat3 head_rotation = Mat3::Identity();  ///< of the head during contact, global frame
  double face_travel = 0, face_rate = 0;  ///< of a yielding face at its centre, inwards, at the end [m], [m/s]
  long steps = 0, rate_calls = 0;
};

/// Free head in three dimensions: closest point of the true face (bulge and roll), finite rotation and
/// gyroscopic moment of the head. With a shaft, where one is given, as a condensed linear beam at the
/// hosel (models/reduced/shaft_impedance.hpp).
/// Of blow.contact nothing is used: the law above replaces it.
VolumetricResult volumetric_impact(const Blow& blow, const VolumetricLaw& law, const VolumetricOptions& options = {},
                                   const ShaftImpedance* shaft = nullptr,
                                   const std::function<void(const ContactSample&)>& watch = {});

/// The launches of many blows, several side by side in vector registers: each to the last bit as by volumetric_impact.
/// With CVODE one after the other.
std::vector<Answer> volumetric_launches(std::span<const Blow> blows, const VolumetricLaw& law,
                                        const VolumetricOptions& options = {}, const ShaftImpedance* shaft = nullptr);

class Volumetric final : public ImpactModel {
 public:
  explicit Volumetric(VolumetricLaw law = {}, VolumetricOptions options = {}) : law_(law), options_(options) {}
  Launch launch(const Blow& blow) const override { return volumetric_impact(blow, law_, options_).launch; }
  std::vector<Answer> launches(std::span<const Blow> blows) const override {
    return volumetric_launches(blows, law_, options_);
  }

 private:
  VolumetricLaw law_;
  VolumetricOptions options_;
};

}  // namespace hosel::models
