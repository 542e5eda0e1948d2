// A model of one's own behind the common interface, asked the same question as one of the library's.
#include <cmath>
#include <cstdio>

#include "golf/units.hpp"
#include "models/rigid/rigid_planar.hpp"

namespace {

/// No friction at all: the ball leaves along the face's normal and does not spin.
class Frictionless final : public hosel::models::ImpactModel {
 public:
  hosel::Launch launch(const hosel::Blow& blow) const override {
    const hosel::Vec3 n = blow.delivery.face_to_global().col(0);
    const double approach = blow.delivery.velocity().dot(n);
    const double e = blow.contact.normal_restitution(approach, 0);
    hosel::Launch out;
    out.velocity = approach * (1 + e) / (1 + blow.ball.mass / blow.club.head.mass) * n;
    return out;
  }
};

}  // namespace

int main() {
  hosel::Blow blow;
  blow.club.head.mass = 0.286;
  blow.delivery = {.club_speed = 36.7, .dynamic_loft = hosel::radians(22)};
  const Frictionless own;
  const hosel::models::RigidPlanar rolling;
  for (const hosel::models::ImpactModel* model : {static_cast<const hosel::models::ImpactModel*>(&own),
                                                  static_cast<const hosel::models::ImpactModel*>(&rolling)}) {
    const hosel::Launch l = model->launch(blow);
    std::printf("%.2f m/s at %.2f deg with %.0f rpm\n", l.ball_speed(), hosel::degrees(l.launch_angle()),
                hosel::rpm(l.backspin()) + 0.0);
  }
  // Without friction it starts at the loft; a ball that rolls starts lower.
  const double start = own.launch(blow).launch_angle();
  return std::abs(start - hosel::radians(22)) < 1e-12 && rolling.launch(blow).launch_angle() < start ? 0 : 1;
}
