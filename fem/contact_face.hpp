/// Contact and friction between a harmonic solid and a curved rigid face.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hosel/fem/harmonic_solid.hpp"
#include "hosel/golf/face.hpp"

namespace hosel::fem {

/// The law at a point of the patch. With gap g < 0 the pressure is p = -normal_stiffness g; the
/// traction across it follows Coulomb: sticking is a spring of tangential_stiffness, |t| <= friction p.
/// Where `transition_speed` is set, friction is instead the regularised law
/// |t| = friction p tanh(4 v / transition_speed) of the slip speed v.
struct ContactLawAtPoint {
  double normal_stiffness = 0;             ///< penalty per reference area [N/m^3]
  double tangential_stiffness = 0;         ///< [N/m^3]
  double friction = 0;                     ///< Coulomb's coefficient [-]
  std::optional<double> transition_speed;  ///< [m/s]

  std::vector<std::string> faults() const;
};

/// The rigid body that carries the face. Its frame is that of the blocks' node, parallel to the face
/// frame; `face_centre` lies in it. Without blocks the face stands still at `position`, `attitude`.
struct FaceCarrier {
  std::optional<Layout::Block> translation, rotation;
  Vec3 face_centre = Vec3::Zero();   ///< from the node, body frame [m]
  Vec3 position = Vec3::Zero();      ///< of a fixed face's node, global [m]
  Mat3 attitude = Mat3::Identity();  ///< of a fixed face, body to global
};

/// Which half of the motion the angles leave to symmetry. The carrier feels the mirror images as well.
enum class Symmetry {
  none,   ///< angles over the full circle
  plane,  ///< half circle; mirror symmetry about the plane of the solid's axes 1 and 2
  axis,   ///< one angle; everything is symmetric about the solid's axis 1
};

/// One quadrature point of the patch at the last accepted state.
struct ContactPoint {
  Vec3 reference;       ///< material point, global, before the motion [m]
  Vec3 position;        ///< now, global [m]
  Vec3 traction;        ///< on the ball per reference area, global [Pa]
  double pressure = 0;  ///< [Pa]
  double gap = 0;       ///< positive when apart [m]
  double slip = 0;      ///< path slid so far [m]
  double area = 0;      ///< reference area that it stands for [m^2]
  bool sliding = false;
};

/// What the patch does at the last accepted state, and its largest errors so far.
struct ContactReport {
  Vec3 force = Vec3::Zero();    ///< on the ball, global [N]
  Vec3 point = Vec3::Zero();    ///< centre of pressure, global [m]
  double normal_force = 0;      ///< [N]
  double pressure = 0;          ///< largest [Pa]
  double area = 0;              ///< of the patch [m^2]
  double penetration = 0;       ///< largest so far [m]
  double stick_slip_error = 0;  ///< largest elastic creep of a sticking point so far [m]
  int points = 0;               ///< in contact
};

/// Points are Gauss points of the surface edges times equidistant angles; the gap is the distance (to
/// first order) to xc = -(yc^2/2Rb + zc^2/2Rr) along its normal, in the face frame. Forces act at
/// the ball's point on both bodies: equal, opposite, no net moment. Coulomb friction by return map on
/// an anchor that a point leaves in the face where it first touches: P. Wriggers, Computational Contact
/// Mechanics (2006), ch. 5.
class ContactFace final : public Term {
 public:
  /// `angles`: the rule over theta that suits `symmetry`; `edge_points`: Gauss points along an edge (1..5).
  ContactFace(const HarmonicSolid& solid, const Face& face, FaceCarrier carrier, ContactLawAtPoint law,
              const AngularRule& angles, Symmetry symmetry, int edge_points = 4);

  /// Takes the state that the motion starts from; to be called once, before anything else.
  void start(const State& initial);

  std::string body() const override { return "contact"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  Energies energies(const State& accepted) const override;
  void accept(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  const FaceCarrier& carrier() const { return carrier_; }
  ContactReport report(const State& accepted) const;
  std::vector<ContactPoint> points(const State& accepted) const;
  /// Distance of the solid's centre of mass from the face [m].
  double centre_gap(const State& s) const;

 private:
  struct Edge {
    std::array<int, 3> nodes;
    std::vector<Index> equations;  // free ones of the three nodes, then the carrier's six
    std::vector<int> places;       // i * K + k of the solid's part
  };
  struct Point {
    std::size_t edge = 0;
    Eigen::Vector3d shape;
    std::size_t angle = 0;
    Vec3 reference;   // in the placement's axes, from its origin
    double area = 0;  // reference area x angular weight
  };
  struct Past {  // as of the last accepted state, face frame
    Vec3 place = Vec3::Zero();
    Vec3 anchor = Vec3::Zero();  // of the tangential spring
    double gap = 0, traction = 0, slip_speed = 0, slip = 0;
    bool touching = false, sliding = false;
  };
  struct Kinematics {  // of one point
    Vec3 place;        // face frame, from the face centre
    Vec3 arm;          // body frame, from the node
    Vec3 relative;     // R^T (velocity of the point - of the node)
    Vec3 velocity;     // rate of `place`
  };
  struct Pose {
    Vec3 node, node_velocity, spin;  // spin in the body frame
    Mat3 R;
  };
  struct Local {  // law at one point, face frame, per area
    double gap = 0, pressure = 0, traction = 0, slip = 0, slip_speed = 0;
    Vec3 force = Vec3::Zero(), anchor = Vec3::Zero();
    bool sliding = false;
    Mat3 stiffness = Mat3::Zero();  // -d force / d place
    Mat3 damping = Mat3::Zero();    // -d force / d velocity
  };

  Pose pose(const State& s) const;
  /// What symmetry leaves of the carrier's translation (global) and rotation (body frame).
  Mat3 free_translation() const;
  Mat3 free_rotation(const Mat3& R) const;
  double gap_at(const Vec3& place) const;
  Local law(const Past& past, const Kinematics& k, bool derivatives) const;
  template <class Visit>
  void visit(const State& s, Visit&& visit) const;  // visit(point number, pose, kinematics)

  const HarmonicSolid& solid_;
  Face face_;
  FaceCarrier carrier_;
  ContactLawAtPoint law_;
  std::vector<Edge> edges_;
  std::vector<Point> points_;
  Symmetry symmetry_;
  std::vector<Eigen::MatrixXd> functions_;  // 3 x K at each angle, global
  std::vector<Past> past_;
  bool started_ = false;
  double friction_work_ = 0, penetration_ = 0, creep_ = 0;
};

}  // namespace hosel::fem
