/// Contact and friction between a harmonic solid and a surface.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "fem/contact_method/method.hpp"
#include "fem/contact_surface.hpp"
#include "fem/friction/law.hpp"
#include "fem/harmonic_solid.hpp"

namespace hosel::fem {

/// What acts at a point.
struct ContactLaws {
  std::unique_ptr<const ContactMethod> method;  ///< along the normal
  std::unique_ptr<const FrictionLaw> friction;  ///< none: frictionless
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
  Vec3 traction;        ///< on the solid per reference area, global [Pa]
  Vec3 push;            ///< that of it which is pressure [Pa]
  double pressure = 0;  ///< [Pa]
  double gap = 0;       ///< positive when apart [m]
  double slip = 0;      ///< path slid so far [m]
  double area = 0;      ///< reference area that it stands for [m^2]
  bool sliding = false;
  double angle = 0;  ///< theta [rad]
};

/// What the patch does at the last accepted state, and its largest errors so far.
struct ContactReport {
  Vec3 force = Vec3::Zero();                                 ///< on the solid, global [N]
  Vec3 point = Vec3::Zero();                                 ///< centre of pressure, global [m]
  double normal_force = 0;                                   ///< [N]
  double pressure = 0;                                       ///< largest [Pa]
  double area = 0;                                           ///< of the patch [m^2]
  double penetration = 0;                                    ///< largest so far [m]
  double elastic_slip = 0;                                   ///< largest of a sticking point so far [m]
  int points = 0;                                            ///< in contact
  double nearest = std::numeric_limits<double>::infinity();  ///< smallest gap of any point, negative in contact [m]
};

/// Points are Gauss points of the solid's surface edges times equidistant angles. Forces act at the solid's point on
/// both bodies: equal, opposite, no net moment. Friction is told the path from an anchor that a point leaves on the
/// surface where it first touches.
class Contact final : public Term {
 public:
  /// `angles`: the rule over theta that suits `symmetry`; `edge_points`: Gauss points along an edge (1..5).
  Contact(const HarmonicSolid& solid, std::unique_ptr<const ContactSurface> surface, SurfaceCarrier carrier,
          ContactLaws laws, const AngularRule& angles, Symmetry symmetry, int edge_points = 4);

  /// Takes the state that the motion starts from; to be called once, before anything else.
  void start(const State& initial);

  std::string body() const override { return "contact"; }
  void pattern(std::vector<std::vector<Index>>& blocks) const override;
  void residual(const State& trial, Vector& inertia, Vector& force) const override;
  void tangent(const State& trial, const Weights& weights, TangentSink& sink) const override;
  bool abrupt() const override { return true; }
  void begin_step() override;
  bool augment(const State& trial) override;
  Energies energies(const State& accepted) const override;
  void commit(const State& accepted) override;
  void save(std::vector<double>& history) const override;
  void restore(std::span<const double>& history) override;

  SurfacePose surface_pose(const State& s) const { return pose(carrier_, s); }
  ContactReport report(const State& accepted) const;
  std::vector<ContactPoint> points(const State& accepted) const;
  /// How far the surface has moved inwards at a place of its own axes (see Travel) [m]; 0 where it is rigid.
  double surface_travel(const State& s, const Vec3& place) const;
  /// Distance of the solid's centre of mass from the surface [m].
  double centre_gap(const State& s) const;

 private:
  using Directions = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  struct Edge {
    std::array<int, 3> nodes;
    std::vector<Index> dofs;  // free ones of the three nodes, then the carrier's six, then the surface's own
    std::vector<int> places;  // i * K + k of the solid's part
    std::vector<int> places_and_carried;  // and 3 K + i of the others
  };
  struct Station {  // a Gauss point of an edge; `angles` points follow each other
    std::size_t edge = 0;
    Vec3 shape;
    Eigen::Vector2d reference;  // on the meridian
    double area = 0;            // reference area x angular weight
  };
  struct Past {  // as of the last accepted state, in the surface's axes
    Vec3 place = Vec3::Zero();
    Vec3 anchor = Vec3::Zero();  // of the tangential path
    double gap = 0, traction = 0, stored = 0, slip = 0;
    double slip_before = 0;  // with which the step that led here was solved
    bool touching = false, sliding = false;
    double multiplier = 0, offset = 0;  // see NormalState
    NormalState normal() const { return {gap, multiplier, offset}; }
  };
  struct Moved {                                                   // what holds for all points of a state
    Vec3 node, node_velocity = Vec3::Zero(), spin = Vec3::Zero();  // spin in the body frame
    Mat3 R, to_body;                                               // its inverse
    SurfaceUnknowns own, own_rate;
  };
  struct Kinematics {  // of one point
    std::size_t number = 0, angle = 0;
    const Station* station = nullptr;
    Vec3 arm;    // body frame, from the node
    Vec3 place;  // in the surface's axes, as if it had not moved
    double gap = 0;
    bool pressed = false;
    // Where it is, the velocities for a friction that depends on them:
    Vec3 relative = Vec3::Zero();  // R^T (velocity of the point - of the node)
    Vec3 rate = Vec3::Zero();      // of the arm
    Vec3 velocity = Vec3::Zero();  // of the place
    Travel travel;                 // of a surface with unknowns
  };
  struct Local {  // at one point, in the surface's axes, per area
    double pressure = 0;
    Vec3 force = Vec3::Zero();
    Friction friction;
    Mat3 stiffness = Mat3::Zero();  // -d force / d place
    Mat3 damping = Mat3::Zero();    // -d force / d velocity
  };

  Moved moved(const State& s) const;
  Vec3 place(const Moved& m, const Vec3& arm) const;
  /// The force on the solid in the body frame: `force` works on the place as if the surface had not moved.
  static Vec3 in_body(const Kinematics& k, const Vec3& force);
  /// What symmetry leaves of the carrier's translation (global) and rotation (body frame).
  Mat3 free_translation() const;
  Mat3 free_rotation(const Mat3& R) const;
  Eigen::Ref<const Directions, 0, Eigen::OuterStride<>> functions(std::size_t angle) const;
  Local evaluate(const Kinematics& k, bool derivatives) const { return evaluate(k, derivatives, past_[k.number].slip); }
  /// At the state that was accepted last: with the path that its step began with, as it was solved.
  Local accepted(const Kinematics& k) const { return evaluate(k, false, past_[k.number].slip_before); }
  Local evaluate(const Kinematics& k, bool derivatives, double path) const;
  /// What the method makes of a point at a gap with the multiplier of the step at hand.
  NormalSpring normal(std::size_t number, double gap) const { return laws_.method->at(gap, multipliers_[number]); }
  /// Derivatives of -force at a station: changes^T forces, and what the turn of the carrier adds. Three rows a point,
  /// of the place, and where the surface has unknowns two more, of how these tilt it there; columns are the solid's
  /// functions, carrier and own unknowns.
  struct Linearised {
    Linearised(Index most, Index size, Index others)
        : changes(most, size),
          forces(most, size),
          arm(3, others),
          turned(decltype(turned)::Zero(size, 3)),
          moment(Directions::Zero(3, size)) {}
    Index rows = 0;
    Eigen::MatrixXd changes, forces;
    Directions arm;                                   // of the point at hand: its changes
    Eigen::Matrix<double, Eigen::Dynamic, 3> turned;  // columns of the carrier's rotation
    Directions moment;                                // and its rows
  };
  void linearise(const Moved& m, const Kinematics& k, const Weights& weights, Linearised& out) const;
  /// How far from the surface a multiplier may still press a point [m].
  double beyond() const;
  struct Scratch;  // of a station's work
  /// Numbers of the stations with a point that the surface, or a pressure beyond it, reaches.
  std::vector<std::size_t> within_reach(const Moved& m, const State& s) const;
  /// So many stations may be worked on at once, each on its own: what they find is put together in their order.
  template <class Work>
  void over_stations(std::size_t count, const Work& work) const;
  template <class Visit>
  void visit_station(const Moved& m, const State& s, std::size_t number, Scratch& scratch,
                     Visit&& visit) const;  // visit(kinematics)
  template <class Visit>
  void visit(const State& s, Visit&& visit) const;  // visit(moved, kinematics) at every point

  const HarmonicSolid& solid_;
  std::unique_ptr<const ContactSurface> surface_;
  SurfaceCarrier carrier_;
  ContactLaws laws_;
  Symmetry symmetry_;
  std::optional<DofMap::Block> own_;
  Index carried_ = 0;  // equations of carrier and surface
  Index to_q_ = 0;     // from an equation of the solid to its entry in State::q
  std::vector<Edge> edges_;
  std::vector<Station> stations_;
  std::vector<double> angles_;
  Eigen::MatrixXd functions_;  // 3 x K at each angle, one below the other, global
  Directions reference_;       // of each point, global
  std::vector<Past> past_;
  std::vector<double> multipliers_;  // of the step at hand [Pa]
  bool started_ = false;
  double friction_work_ = 0, penetration_ = 0, elastic_slip_ = 0;
};

}  // namespace hosel::fem
