/// First contact in the finite-element impact: axes, approach, and the symmetries of the blow.
#pragma once

#include "golf/first_contact.hpp"

namespace hosel::models {

/// A mirror of the face: y to -y, or z to -z.
enum class Mirror { none, heel_toe, up_down };

struct ContactFrame : FirstContact {
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
ContactFrame contact_frame(const Blow& blow);

/// Contact time of an elastic sphere on a rigid plane after Hertz [s].
double hertz_time(double mass, double radius, double young, double speed);

/// The angle by which the ball will turn while it touches [rad], to a fifth or so: a spin 1.3 times that of rolling, or
/// what friction allows, that grows over a contact a good third longer than Hertz's. `young`: of the ball, at an
/// instant [Pa].
double expected_turn(const ContactFrame& frame, const Blow& blow, double young);

}  // namespace hosel::models
