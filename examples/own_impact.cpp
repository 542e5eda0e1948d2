// An impact of one's own: a rubber that is stated by its energy alone, and a face with a mesh of its own.
#include <cmath>
#include <cstdio>

#include "fem/materials/energy_law.hpp"
#include "golf/units.hpp"
#include "models/fe/impact.hpp"
#include "models/fe/plate_face.hpp"

struct Fung {  // W = mu / (2 b) (exp(b (I1' - 3)) - 1) + K/2 (J - 1)^2
  double mu, b, bulk;
  double shear() const { return mu; }
  double bulk_modulus() const { return bulk; }
  void stiffen(double factor) { mu *= factor; }
  std::vector<std::string> faults() const { return {}; }
  auto energy(const auto& I1, const auto&, const auto& J) const {
    using std::exp;
    return 0.5 * mu / b * (exp(b * (I1 - 3.0)) - 1.0) + 0.5 * bulk * (J - 1.0) * (J - 1.0);
  }
};

int main() {
  using namespace hosel;
  models::FeImpactOptions parts;
  parts.resolve(models::Accuracy::look);
  parts.ball = models::elastic_ball("own", {fem::EnergyLaw<Fung>(Fung{25e6, 0.2, 1e9}), {{45e6, 1e-5}}, 1129});
  models::PlateDesign titanium{.mesh = {.core = 4, .rings = 2}};
  titanium.thickness.map = mesh::PlateThickness::Constant{2.6e-3};
  parts.face = std::make_shared<models::PlateOnDemand>(titanium);

  Blow blow;
  blow.club.head = {.mass = 0.2, .cg = {-0.03, 0, 0}, .inertia = Vec3(2.8e-4, 4.1e-4, 5.7e-4).asDiagonal()};
  blow.delivery = {.club_speed = 45, .dynamic_loft = radians(11), .impact_toe = 0.01};
  const models::FeOutcome out = models::Impact(parts).run(blow);
  std::printf("%.1f m/s, %.0f rpm; the face gives %.2f mm, contact %.2f ms\n", out.launch.ball_speed(),
              rpm(out.launch.spin_rate()), 1e3 * out.result.face_travel, 1e3 * out.result.contact_time);
  return out.launch.ball_speed() > 1.3 * 45 && out.result.face_travel > 1e-4 ? 0 : 1;
}
