/// A normal blow on a lumped face: striker, face and head in series along the normal. A solution takes microseconds.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "golf/ball.hpp"
#include "golf/face_compliance.hpp"
#include "golf/head.hpp"

namespace hosel::models {

/// What meets the face, by its own law: F = stiffness d^exponent (1 + damping d'), d the approach of striker and face.
struct Striker {
  double mass = 0;       ///< [kg]
  double stiffness = 0;  ///< [N/m^exponent]
  double exponent = 1;
  double damping = 0;  ///< [s/m]
};

/// An elastic steel sphere (E 200 GPa, nu 0.3, 7850 kg/m^3) on a thick titanium face (110 GPa, 0.33): Hertz.
Striker steel_sphere(double radius);
/// A ball that leaves a wall at 45 m/s with e = 0.86 - 0.0029 v after 0.45 ms, and pushes like depth^1.2 as the
/// finite-element ball does.
Striker golf_ball(const Ball& ball);

/// Mass with which a free head meets a blow along Xc at a point of the face [kg].
double mass_at(const Head& head, double yc, double zc);

/// Whether a rigid face leaves out what a driver has: a free head whose centre of gravity lies deeper than an iron's.
bool wants_yielding_face(const Head& head);
/// The shipped face of such a head: a driver's or an iron's.
const FaceCompliance& usual_face(const Head& head);

struct FaceStrike {
  double restitution = 0;   ///< relative speed of striker and head's point after over before [-]
  double contact_time = 0;  ///< [s]
  double peak_force = 0;    ///< [N]
  double energy = 0;        ///< left in the face [J]
};
/// `face`: none is rigid; `shape`: its at the point struck. Striker m, head M with the face's mass in it, travel w:
///   m x'' = F,   M X'' - m_f w'' = -F,   m_f (w'' - X'') + c w' + k w = shape F,   d = X - shape w - x,
/// from first touch to d = 0. solvers/rosenbrock_w.hpp; throws NonConvergence.
FaceStrike strike(const Striker& striker, double head_mass, const std::optional<FaceCompliance>& face, double shape,
                  double speed);

/// Share of a golf ball's loss 1 - e that is left on a face of so much compliance under it [m/N]: (1 + k_b C)^-2,
/// k_b = 1.68 MN/m. Ball and face share the compression like springs in series, and what a ball of this damping loses
/// goes with the square of its own rate. strike() in closed form up to the rules' limit; beyond it the face's own
/// period counts.
double loss_on_face(double compliance);
/// Factor by which the contact lasts longer there: (1 + k_b C)^1/2.
double contact_on_face(double compliance);

/// The rules' pendulum test: contact times of an elastic sphere at several speeds, and the straight line through them
/// against speed^-0.329, whose intercept is the characteristic time (USGA-TPX3004, as summarised in cases/
/// characteristic-time).
struct CharacteristicTime {
  double time = 0;            ///< intercept [s]
  double slope = 0;           ///< [s (m/s)^0.329]
  std::vector<double> times;  ///< at the speeds [s]
  double departure = 0;       ///< largest, of a time from the line [s]
};
/// The face follows at rest: Hertz and spring in series, by quadrature. A lumped mass would bounce under the hard
/// sphere, where a plate carries its energy away as bending waves.
CharacteristicTime characteristic_time(const Striker& sphere, double head_mass,
                                       const std::optional<FaceCompliance>& face, double shape,
                                       std::span<const double> speeds);
/// The line through contact times [s] of any such test.
CharacteristicTime characteristic_line(std::span<const double> speeds, std::vector<double> times);
/// Restitution that the rules' line ties to a characteristic time [s].
inline double rules_line(double characteristic_time) { return 0.718 + 436 * characteristic_time; }
/// Speeds of the shipped test [m/s].
std::vector<double> pendulum_speeds();

}  // namespace hosel::models
