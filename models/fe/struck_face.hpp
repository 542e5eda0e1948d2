/// The face in a finite-element impact: a contact surface, and its degrees of freedom relative to the head.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/face_spring.hpp"
#include "fem/term.hpp"
#include "models/fe/contact_frame.hpp"

namespace hosel::models {

/// A stress, and where on the face it is.
struct FacePeak {
  double stress = 0;                                ///< von Mises [Pa]
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< towards the heel, up [m]
};

/// A face that has been put into the system of a blow.
struct FaceInSystem {
  std::unique_ptr<const fem::ContactSurface> surface;
  std::unique_ptr<fem::FaceSpring> spring = {};  ///< what it weighs and what holds it; none: it does not yield
  double compliance = 0;                         ///< where it is struck [m/N]
  /// Makes what tells the largest stress of a state of the face's unknowns; none: the face knows no stress.
  std::function<std::function<FacePeak(const fem::Vector&)>()> stresses = {};
};

/// Where and how a face is struck.
struct FaceBlow {
  const Blow& blow;
  fem::SurfaceCarrier carrier;   ///< of the face's axes: the head, or a wall
  bool axial = false;            ///< by an axisymmetric ball
  Mirror mirror = Mirror::none;  ///< by which the blow is its own image, none where it is not
  Eigen::Vector2d place() const { return {-blow.delivery.impact_toe, blow.delivery.impact_high}; }
};

/// A face of one's own is a class derived from this (`examples/own_surface.cpp`).
class StruckFace {
 public:
  virtual ~StruckFace() = default;
  /// Sentences naming what cannot be, also against an axisymmetric ball; empty if all is well.
  virtual std::vector<std::string> faults(bool axial) const { return (void)axial, std::vector<std::string>{}; }
  /// Whether the face of this curvature is its own image by a mirror of its axes.
  virtual bool symmetric(Mirror mirror, const Face& curvature) const = 0;
  /// Adds the face's unknowns to the system's layout; what it returns is put in by the caller, contact before spring.
  /// Throws std::invalid_argument on a blow that the face cannot answer.
  virtual FaceInSystem add(fem::System& system, const FaceBlow& struck) const = 0;
};

/// The head's own face: with its lumped compliance where it has one, else rigid.
std::shared_ptr<const StruckFace> own_face(const Head& head);

}  // namespace hosel::models
