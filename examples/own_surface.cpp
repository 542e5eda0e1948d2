// A surface of one's own: a ball falls on the top of a rigid sphere as large as itself. After Hertz the force depends
// on the radius of relative curvature to the power 1/5, the contact time to the power -1/5: both are compared with a
// flat wall, struck by the same ball on the same mesh.
#include <cmath>
#include <cstdio>

#include "fem/materials/hyperelastic.hpp"
#include "models/fe/impact.hpp"

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

/// The face that has it.
class Post final : public models::StruckFace {
 public:
  bool symmetric(models::Mirror, const Face&) const override { return true; }
  models::FaceInSystem add(fem::System&, const models::FaceBlow& struck) const override {
    return {.surface = std::make_unique<Sphere>(struck.blow.ball.radius)};
  }
};

/// Without a face of its own the wall is flat.
models::FeImpactResult drop_on(std::shared_ptr<const models::StruckFace> face, double speed) {
  const fem::Solid rubber{
      .elastic = fem::Hyperelastic::neo_hooke(fem::Lame::of(100e6, 0.45)), .branches = {}, .density = 1129};
  models::FeImpactOptions options;
  options.ball = models::elastic_ball("rubber", rubber);
  options.face = std::move(face);
  options.harmonics = 0;
  options.mesh = {.sector = 6, .rings = 4, .pole = 0.2, .skin = 0.3, .core = 0.4};
  Blow drop;
  drop.club.head.mass = INFINITY;
  drop.delivery.club_speed = speed;
  return models::Impact(options).run(drop).result;
}

}  // namespace

int main() {
  const double speed = 2;
  const auto wall = drop_on(nullptr, speed);
  const auto post = drop_on(std::make_shared<Post>(), speed);
  const double force = post.peak_force / wall.peak_force, time = post.contact_time / wall.contact_time;
  const double hertz = std::pow(0.5, 0.2);
  std::printf("wall %.0f N, %.3f ms; sphere %.0f N, %.3f ms\n", wall.peak_force, 1e3 * wall.contact_time,
              post.peak_force, 1e3 * post.contact_time);
  std::printf("ratios %.4f, %.4f; Hertz %.4f, %.4f\n", force, time, hertz, 1 / hertz);
  // The patch is a twelfth of the radius: the finite sphere departs from Hertz by a per cent or so, on both alike.
  return wall.peak_force > 100 && std::abs(force / hertz - 1) < 0.02 && std::abs(time * hertz - 1) < 0.02 ? 0 : 1;
}
