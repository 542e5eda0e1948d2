/// An elastic sphere pressed between two plates and pulled along them, and how far its tractions are from theory.
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <memory>
#include <vector>

#include "fem/contact_method/penalty.hpp"
#include "fem/face_surface.hpp"
#include "fem/friction/coulomb.hpp"
#include "fem/materials/linear_elastic.hpp"
#include "fem/traction_field.hpp"
#include "golf/units.hpp"
#include "mesh/meridian.hpp"
#include "solvers/statics.hpp"
#include "tests/support/squeezed_sphere.hpp"

namespace hosel::test {

/// The exact pressure of the squeezed sphere under a force: its square is smooth in r^2, for Hertz a straight line.
class SqueezedPressure {
 public:
  /// `force` over Young's modulus and radius squared.
  SqueezedPressure(double nu, double force) {
    double approach = std::pow(force * (1 - nu * nu) * 0.75, 2.0 / 3);
    for (int i = 0; i < 6; ++i) approach *= std::pow(force / squeezed(nu, approach).force, 2.0 / 3);
    const Squeezed at = squeezed(nu, approach, 120);
    const auto n = static_cast<Eigen::Index>(at.cosine.size()) - 1;  // the last ring lies across the rim
    Eigen::MatrixXd powers(n, 3);
    Eigen::VectorXd square(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double c = at.cosine[static_cast<std::size_t>(i)], x = 1 - c * c,
                   weight = std::sqrt(std::sqrt(x));  // rings grow with r
      powers.row(i) = weight * Eigen::RowVector3d(1, x, x * x);
      const double p = at.pressure[static_cast<std::size_t>(i)] * force / at.force;
      square[i] = weight * p * p;
    }
    fit_ = powers.colPivHouseholderQr().solve(square);
    const double root = -fit_[1] / 2 / fit_[2], d = root * root - fit_[0] / fit_[2];
    const double first = root - std::sqrt(d), second = root + std::sqrt(d);
    radius_ = std::sqrt(first > 0 ? std::min(first, second > 0 ? second : first) : second);
  }
  double radius() const { return radius_; }  ///< of the patch over the sphere's
  /// At a distance from the axis over the sphere's radius, over Young's modulus.
  double operator()(double r) const {
    if (r >= radius_) return 0;
    return std::sqrt(std::max(0.0, fit_[0] + fit_[1] * r * r + fit_[2] * r * r * r * r));
  }

 private:
  Eigen::Vector3d fit_;
  double radius_ = 0;
};

/// Relative L2 errors over the patch [-].
struct TractionError {
  double pressure = 0, friction = 0;
  double across = 0;  ///< of friction across the pull alone: theory has none
};

struct PressedSphere {
  double nu = 0.49, approach = 0.1;  ///< of each plate, over the radius
  mesh::MeridianOptions mesh;
  int harmonics = 0;  ///< 0: pressed alone
  double friction = 0;
  double pull = 0;        ///< of the sphere's core along the plates, over the radius
  double penalty = 1000;  ///< times Young's modulus over the radius
  int edge_points = 4;
};

struct Pressed {
  double radius = 0;          ///< of the exact patch over the sphere's
  double friction_ratio = 0;  ///< tangential over normal force over the coefficient
  double edges = 0;           ///< of the mesh within the radius of the patch
  TractionError stations, field;
  double force_off = 0;   ///< of the field's resultant force, over the stations'
  double moment_off = 0;  ///< of its moment about the sphere's centre, over force times radius of the patch
};

/// Against the exact pressure, and for friction against q(r) = mu (p(r) - c/a p(r a/c)), c/a = (1 - Q / mu P)^(1/3)
/// (Cattaneo and Mindlin; with the pressure of the finite sphere, Jaeger and Ciavarella). The patch rolls over the
/// sphere by a tenth of its radius at most where it is pulled; theory stands about the patch's own centre.
inline Pressed press(const PressedSphere& o) {
  constexpr double R = 0.02, E = 100e6;
  const mesh::Meridian meridian = mesh::sphere_meridian({R}, o.mesh);
  const fem::Solid material{.elastic = fem::LinearElastic{fem::Lame::of(E, o.nu)}, .branches = {}, .density = 1129};
  class Core final : public fem::Prescribed {  // the middle of the axis, along the plates
   public:
    std::vector<fem::Index> equations, offsets;
    double value = 0;
    const std::vector<fem::Index>& dofs() const override { return equations; }
    void impose(fem::State& s) const override {
      for (const fem::Index i : offsets) s.q[i] = value;
    }
  };
  struct Scene {
    fem::System system;
    fem::HarmonicSolid* ball = nullptr;
    std::vector<fem::Contact*> plates;
    Core* core = nullptr;
  };
  const int angles = 2 * o.harmonics + 4, patch = 3 * o.harmonics + 8;
  const bool axial = o.harmonics == 0;
  const fem::Symmetry symmetry = axial ? fem::Symmetry::axis : fem::Symmetry::plane;
  const auto build = [&](Scene& scene, double friction, const fem::Vector* q) {
    auto ball = std::make_unique<fem::HarmonicSolid>(
        scene.system.dof_map, meridian, axial ? fem::axisymmetric_basis() : fem::cartesian_basis(o.harmonics),
        fem::SolidQuadrature{axial ? fem::single_angle() : fem::half_circle(angles), 2},
        std::vector<fem::Solid>{material}, fem::Placement{});
    scene.ball = ball.get();
    scene.system.terms.push_back(std::move(ball));
    fem::State state = scene.system.dof_map.rest();
    if (q) state.q = *q;
    for (const double side : {1.0, -1.0}) {
      fem::SurfaceCarrier carrier;
      carrier.position = Vec3(side * R * (1 - o.approach), 0, 0);
      carrier.attitude = side < 0 ? Mat3(Mat3::Identity()) : Eigen::AngleAxisd(kPi, Vec3::UnitZ()).toRotationMatrix();
      const double stiffness = o.penalty * E / R;
      fem::ContactLaws laws{std::make_unique<fem::Penalty>(stiffness), nullptr};
      if (friction > 0) laws.friction = std::make_unique<fem::Coulomb>(friction, 0.5 * stiffness);
      auto contact = std::make_unique<fem::Contact>(
          *scene.ball, std::make_unique<fem::FaceSurface>(Face{}), carrier, std::move(laws),
          axial ? fem::single_angle() : fem::half_circle(patch), symmetry, o.edge_points);
      contact->start(state);
      scene.plates.push_back(contact.get());
      scene.system.terms.push_back(std::move(contact));
    }
    if (!axial) {
      auto core = std::make_unique<Core>();
      for (int n = 0; n < static_cast<int>(meridian.nodes.size()); ++n)
        if (meridian.on_axis(n) && std::abs(meridian.nodes[static_cast<std::size_t>(n)].x()) < 0.3 * R)
          for (fem::Index k = 0; k < scene.ball->unknowns(); ++k)
            if (const fem::AngularFunction& f = scene.ball->basis()[static_cast<std::size_t>(k)];
                f.order == 0 && f.cosine.y() != 0) {
              core->equations.push_back(scene.ball->dof(n, k));
              core->offsets.push_back(scene.ball->offset(n, k));
            }
      scene.core = core.get();
      scene.system.prescribed.push_back(std::move(core));
    }
    return state;
  };
  const solvers::StaticsOptions statics{.newton = {.residual_relative = 1e-7,
                                                   .increment_vector = 1e-6 * o.approach * R,
                                                   .increment_rotation = 1,
                                                   .max_iterations = 60}};
  auto scene = std::make_unique<Scene>();
  fem::State state = build(*scene, 0, nullptr);
  state = solvers::solve_static(scene->system, state, statics);
  if (o.friction > 0) {
    const fem::Vector pressed = state.q;
    scene = std::make_unique<Scene>();
    state = build(*scene, o.friction, &pressed);
    constexpr int kSteps = 8;
    for (int i = 1; i <= kSteps; ++i) {
      scene->core->value = o.pull * R * i / kSteps;
      state = solvers::solve_static(scene->system, state, statics);
      for (fem::Contact* plate : scene->plates) plate->commit(state);
    }
  }
  const std::vector<fem::ContactPoint> points = scene->plates.front()->points(state);
  const fem::TractionField field(*scene->ball, points);

  Pressed out;
  double normal = 0, along = 0, middle = 0;
  Vec3 turning = Vec3::Zero();  // about the centre, of what the plane of symmetry leaves
  for (const fem::ContactPoint& p : points) {
    normal += p.area * p.pressure;
    along += p.area * p.traction.y();
    middle += p.area * p.pressure * p.reference.y();
    turning += p.area * p.reference.cross(p.traction);
  }
  middle = axial ? 0 : middle / normal;
  const SqueezedPressure exact(o.nu, normal / (E * R * R));
  out.radius = exact.radius();
  for (const auto& edge : meridian.surface) {
    const Eigen::Vector2d &a = meridian.nodes[static_cast<std::size_t>(edge[0])],
                          &b = meridian.nodes[static_cast<std::size_t>(edge[1])];
    if (b.x() > 0) out.edges += std::clamp((out.radius * R - a.y()) / (b.y() - a.y()), 0.0, 1.0);
  }
  const double ratio = o.friction > 0 ? std::abs(along) / (o.friction * normal) : 0;
  out.friction_ratio = ratio;
  const double stick = std::cbrt(1 - std::min(ratio, 1.0));
  const Vec3 direction(0, along < 0 ? -1 : 1, 0);
  struct Expected {
    double pressure;
    Vec3 friction;
  };
  const auto expected = [&](const Vec3& x) -> Expected {
    const double r = std::hypot(x.y() - middle, x.z()) / R, p = E * exact(r);
    return {p, o.friction * (p - (stick > 0 ? stick * E * exact(r / stick) : 0)) * direction};
  };
  struct Sum {
    double pressure = 0, friction = 0, across = 0, of_pressure = 0, of_friction = 0;
    void add(double area, double p, const Vec3& q, const Expected& e) {
      pressure += area * (p - e.pressure) * (p - e.pressure);
      friction += area * (q - e.friction).squaredNorm();
      across += area * (q - e.friction).z() * (q - e.friction).z();
      of_pressure += area * e.pressure * e.pressure;
      of_friction += area * e.friction.squaredNorm();
    }
    TractionError error() const {
      return {std::sqrt(pressure / of_pressure), of_friction > 0 ? std::sqrt(friction / of_friction) : 0,
              of_friction > 0 ? std::sqrt(across / of_friction) : 0};
    }
  } stations, fields;
  for (const fem::ContactPoint& p : points)
    if (p.reference.x() > 0) stations.add(p.area, p.pressure, p.traction - p.push, expected(p.reference));
  constexpr int kRings = 200, kAround = 48;
  const double outer = 1.15 * out.radius;
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kAround; ++j) {
      const double r = outer * (i + 0.5) / kRings, phi = 2 * kPi * (j + 0.5) / kAround, c = std::sqrt(1 - r * r);
      const Vec3 x = R * Vec3(c, r * std::cos(phi), r * std::sin(phi));
      const double area = R * R * r * outer / kRings * 2 * kPi / kAround / c;
      const fem::TractionField::Value v = field.at(x);
      fields.add(area, v.pressure, v.tangential, expected(x));
      force += area * v.traction;
      moment += area * x.cross(v.traction);
    }
  out.stations = stations.error();
  out.field = fields.error();
  const double size = std::hypot(normal, along);
  out.force_off = (force - Vec3(-normal, along, 0)).norm() / size;
  if (!axial) out.moment_off = std::abs(moment.z() - turning.z()) / (size * out.radius * R);
  return out;
}

}  // namespace hosel::test
