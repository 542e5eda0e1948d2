/// Changes of a finite-element impact other than changes of the blow.
#pragma once

namespace hosel::models {

/// Changes of what a case declares of ball and shaft; zeros change nothing but the mesh of a ball of one piece. (What
/// the blow holds - head, delivery, hosel, Coulomb's coefficient in `contact.friction` - is changed there.)
struct FeChange {
  double cover_stiffness = 0;  ///< log of the factor on the outermost layer's shear moduli, elastic and branches [-]
  /// Added to the outermost layer [m]; a ball of one piece has one of `kSkin`.
  double cover_thickness = 0;
  double losses = 0;           ///< logarithm of the factor on the branch moduli of every layer [-]
  double relaxation = 0;       ///< logarithm of the factor on the branch times, see `changed` [-]
  double face_compliance = 0;  ///< added to that of the face at its centre [m/N]
  double shaft = 0;  ///< share of the club's shaft (its mass and its stiffness) added to what the model has [-]
  double shaft_stiffness = 0;  ///< logarithm of the factor on its bending and torsional stiffness [-]

  bool operator==(const FeChange&) const = default;
};

inline constexpr double kSkin = 1.9e-3;  ///< of a ball of one piece, of its own material until an effect changes it [m]

}  // namespace hosel::models
