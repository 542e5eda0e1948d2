#include "loop/shots/contact_changes.hpp"

#include "golf/first_contact.hpp"
#include "loop/shots/model.hpp"

namespace hosel::loop {
namespace {

ContactChange unchanged(double largest) {
  return {{.effect = "", .what = "", .parameters = {{"change", "1", 1, -1, 1, 1e-3}}}, largest};
}

ContactChange changed(double ContactLaw::*of, double largest) {
  ContactChange c = unchanged(largest);
  c.form.before = [of](std::span<const double> p, Shot& s) { s.blow.contact.*of += p[0]; };
  return c;
}

/// 1: across the face; 2: up it.
ContactChange returned_along(int axis) {
  ContactChange c = unchanged(0.8);
  c.form.after = [axis](std::span<const double> p, const Shot& s, Launch& launch) {
    Blow with = s.blow;
    with.contact.tangential_restitution += p[0];
    const Launch a = closed_form().launch(with), b = closed_form().launch(s.blow);
    const FirstContact g = first_contact(s.blow);
    const Vec3 axis_of_face = g.face_axes.col(axis),
               along = (axis_of_face - axis_of_face.dot(g.normal) * g.normal).normalized(),
               about = g.normal.cross(along);
    launch.velocity += along.dot(a.velocity - b.velocity) * along;
    launch.spin += about.dot(a.spin - b.spin) * about;
  };
  return c;
}

}  // namespace

std::array<ContactChange, 2> of_another_ball() {
  return {changed(&ContactLaw::restitution, 0.1), changed(&ContactLaw::tangential_restitution, 0.3)};
}

std::array<ContactChange, 2> of_one_direction() { return {returned_along(1), returned_along(2)}; }

}  // namespace hosel::loop
