// A surface of one's own: a ball falls on the top of a rigid sphere as large as itself. After Hertz the force depends
// on the radius of relative curvature to the power 1/5, the contact time to the power -1/5: both are compared with a
// flat wall, struck by the same ball on the same mesh.
#include <cmath>
#include <cstdio>

#include "fem/face_surface.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "models/fe/fe_impact.hpp"

namespace {

using namespace hosel;

/// A rigid sphere whose pole is the origin and whose axis is X.
class Sphere final : public fem::ContactSurface {
 public:
  explicit Sphere(double radius) : radius_(radius) {}
  double gap(const Vec3& place) const override { return from_centre(place).norm() - radius_; }
  fem::SurfacePoint at(const Vec3& place) const override {
    const Vec3 r = from_centre(place);
    const double distance = r.norm();
    fem::SurfacePoint out;
    out.gap = distance - radius_;
    out.normal = out.slope = r / distance;
    out.curvature = (Mat3::Identity() - out.normal * out.normal.transpose()) / distance;
    return out;
  }

 private:
  Vec3 from_centre(const Vec3& place) const { return place + Vec3(radius_, 0, 0); }
  double radius_;
};

models::FeImpactResult drop_on(std::unique_ptr<const fem::ContactSurface> surface, double speed) {
  const Ball ball;
  const fem::Solid rubber{.elastic = fem::Hyperelastic::neo_hooke(fem::Lame::of(100e6, 0.45)),
                          .branches = {},
                          .density = ball.mass / (4.0 / 3 * M_PI * std::pow(ball.radius, 3))};
  models::FeImpactOptions options;
  options.ball = models::elastic_ball("rubber", rubber);
  options.harmonics = 0;
  const mesh::MeridianOptions fine{.sector = 6, .rings = 4, .pole = 0.2, .skin = 0.3, .core = 0.4};

  fem::System system;
  // The pole that touches looks along -X, towards the surface.
  Mat3 axes;
  axes.col(0) = -Vec3::UnitX();
  axes.col(1) = Vec3::UnitZ();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  auto solid = std::make_unique<fem::HarmonicSolid>(
      system.dof_map, mesh::sphere_meridian({ball.radius}, fine), fem::axisymmetric_basis(),
      fem::SolidQuadrature{fem::single_angle(), 2}, std::vector{rubber}, fem::Placement{Vec3::Zero(), axes});
  fem::SurfaceCarrier still;
  still.position = Vec3(-ball.radius, 0, 0);
  fem::ContactLaws laws{.normal_stiffness = options.penalty * options.ball.instant_young() / ball.radius,
                        .friction = nullptr};
  auto contact = std::make_unique<fem::Contact>(*solid, std::move(surface), still, std::move(laws), fem::single_angle(),
                                                fem::Symmetry::axis);
  const models::BallOnFace parts{solid.get(), contact.get()};
  system.terms.push_back(std::move(solid));
  system.terms.push_back(std::move(contact));
  fem::State initial = system.dof_map.rest();
  parts.ball->set_velocity(initial, Vec3(-speed, 0, 0), Vec3::Zero());
  return models::run_impact(system, parts, initial, options, speed);
}

}  // namespace

int main() {
  const double speed = 2;
  const auto wall = drop_on(std::make_unique<fem::FaceSurface>(Face{}), speed);
  const auto post = drop_on(std::make_unique<Sphere>(Ball{}.radius), speed);
  const double force = post.peak_force / wall.peak_force, time = post.contact_time / wall.contact_time;
  const double hertz = std::pow(0.5, 0.2);
  std::printf("wall %.0f N, %.3f ms; sphere %.0f N, %.3f ms\n", wall.peak_force, 1e3 * wall.contact_time,
              post.peak_force, 1e3 * post.contact_time);
  std::printf("ratios %.4f, %.4f; Hertz %.4f, %.4f\n", force, time, hertz, 1 / hertz);
  // The patch is a twelfth of the radius: the finite sphere departs from Hertz by a per cent or so, on both alike.
  return wall.peak_force > 100 && std::abs(force / hertz - 1) < 0.02 && std::abs(time * hertz - 1) < 0.02 ? 0 : 1;
}
