// One blow through a model that answers in a microsecond: what the ball does.
#include <cstdio>

#include "golf/units.hpp"
#include "models/rigid/rigid_eccentric.hpp"

int main() {
  using namespace hosel;
  Blow blow;  // a 7-iron, struck 5 mm towards the heel
  blow.club.head = {.mass = 0.286, .cg = {-0.012, 0.0, 0.0}, .inertia = Vec3(3.0e-4, 0.9e-4, 2.6e-4).asDiagonal()};
  blow.delivery = {
      .club_speed = 36.7, .attack_angle = radians(-1.9), .dynamic_loft = radians(22), .impact_toe = -0.005};

  const Launch launch = models::RigidEccentric().launch(blow);
  std::printf("ball speed %.2f m/s, launch %.2f deg, azimuth %.2f deg, backspin %.0f rpm, sidespin %.0f rpm\n",
              launch.ball_speed(), degrees(launch.launch_angle()), degrees(launch.azimuth()), rpm(launch.backspin()),
              rpm(launch.sidespin()));
  return launch.ball_speed() > blow.delivery.club_speed && launch.backspin() > 0 ? 0 : 1;
}
