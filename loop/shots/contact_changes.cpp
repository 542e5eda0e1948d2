#include "loop/shots/contact_changes.hpp"

#include "golf/first_contact.hpp"
#include "loop/shots/model.hpp"

namespace hosel::loop {
namespace {

ContactChange unchanged(double largest, double scale = 1e-3) {
  return {{.effect = "", .what = "", .parameters = {{"change", "1", 1, -1, 1, scale}}}, largest};
}

/// Of one number of the blow.
ContactChange changed(auto number, double largest, double scale = 1e-3) {
  ContactChange c = unchanged(largest, scale);
  c.form.before = [number](Sizes p, Shot& s) { number(s.blow) += p[0]; };
  return c;
}

/// A direction in the face, 1 across it and 2 up it, and the axis about which a force along it turns the ball.
struct Direction {
  Vec3 along, about;

  Direction(const Blow& blow, int axis) {
    const FirstContact g = first_contact(blow);
    const Vec3 axis_of_face = g.face_axes.col(axis);
    along = (axis_of_face - axis_of_face.dot(g.normal) * g.normal).normalized();
    about = g.normal.cross(along);
  }
  /// A share of a change of the launch, its part by impulse along this direction alone.
  void add(double share, const Vec3& velocity, const Vec3& spin, Launch& launch) const {
    launch.velocity += share * along.dot(velocity) * along;
    launch.spin += share * about.dot(spin) * about;
  }
};

ContactChange returned_along(int axis) {
  ContactChange c = unchanged(0.8);
  c.form.after = [axis](Sizes p, const Shot& s, Launch& launch) {
    Blow with = s.blow;
    with.contact.tangential_restitution += p[0];
    const Launch a = closed_form().launch(with), b = closed_form().launch(s.blow);
    Direction(s.blow, axis).add(1, a.velocity - b.velocity, a.spin - b.spin, launch);
  };
  return c;
}

ContactChange transmitted_along(int axis) {
  ContactChange c = unchanged(0.8);
  c.form.after = [axis](Sizes p, const Shot& s, Launch& launch) {
    Direction(s.blow, axis).add(p[0], launch.velocity, launch.spin, launch);
  };
  return c;
}

}  // namespace

std::array<ContactChange, 3> of_another_ball() {
  return {changed([](Blow& b) -> double& { return b.contact.restitution; }, 0.1),
          changed([](Blow& b) -> double& { return b.contact.tangential_restitution; }, 0.3),
          changed([](Blow& b) -> double& { return b.ball.inertia_factor; }, 0.06, 0.01)};
}

std::array<ContactChange, 3> of_another_head() {
  const auto moved = [](int axis) {
    return changed([axis](Blow& b) -> double& { return b.club.head.cg[axis]; }, 0.02);
  };
  return {moved(0), moved(1), moved(2)};
}

std::array<ContactChange, 4> of_one_direction() {
  return {returned_along(1), returned_along(2), transmitted_along(1), transmitted_along(2)};
}

}  // namespace hosel::loop
