// The club behind the head: during the contact the shaft's tip acts as a small mass at the hosel that also
// resists being turned across its axis (about its axis it twists easily). The augmented rigid head has the mass,
// the centre and the inertia of both.
#include "loop/effects/all.hpp"

namespace hosel::loop::forms {
namespace {

Mat3 steiner(double mass, const Vec3& arm) { return -mass * skew(arm) * skew(arm); }

/// The delivery's velocity stays that of the head's own centre of gravity. `beside`: from the declared hosel.
void attach(Blow& blow, double mass, double inertia, const Vec3& beside = Vec3::Zero()) {
  Head& head = blow.club.head;
  const Vec3 hosel = blow.club.geometry.hosel + beside, axis = blow.club.geometry.shaft_axis;
  const Vec3 cg = (head.mass * head.cg + mass * hosel) / (head.mass + mass);
  head.inertia += steiner(head.mass, head.cg - cg) + steiner(mass, hosel - cg) +
                  inertia * (Mat3::Identity() - axis * axis.transpose());
  head.cg = cg;
  head.mass += mass;
}

}  // namespace

std::vector<Parametrisation> shaft_coupling(const Setting& setting) {
  if (setting.full_club) return {};
  if (setting.shaft) {
    Parametrisation hung{
        .what = "share of the declared shaft", .parameters = {{"share", "1", 1, 0, 1.6, 0.1}}, .starts = {{1.0}}};
    hung.before = [](Sizes p, Shot& s) { s.change.shaft += p[0]; };
    return {hung};
  }
  const Parameter mass{"added_mass_at_hosel", "g", 1e-3, 0, 0.04, 3e-3};
  const Parameter stiffening{"added_inertia", "kg m^2", 1, 0, 4e-4, 3e-5};
  Parametrisation point{.what = "added mass at the hosel", .parameters = {mass}};
  point.before = [](Sizes p, Shot& t) {
    if (p[0] != 0) attach(t.blow, p[0], 0);
  };
  if (!setting.head_turns) return {};
  Parametrisation both{.what = "added mass and rotational inertia at the hosel", .parameters = {mass, stiffening}};
  both.before = [](Sizes p, Shot& t) {
    if (p[0] != 0 || p[1] != 0) attach(t.blow, p[0], p[1]);
  };
  Parametrisation stiff{.what = "added rotational inertia across the shaft", .parameters = {stiffening}};
  stiff.before = [](Sizes p, Shot& t) {
    if (p[0] != 0) attach(t.blow, 0, p[0]);
  };
  if (setting.hosel_declared) return {point, stiff, both};
  // Of a case that does not declare it: the library's heads have it 12 mm nearer to the toe to 5 mm nearer to the heel
  // than the default, and 10 mm higher.
  Parameter heel{"hosel_towards_heel", "mm", 1e-3, -0.03, 0.03, 3e-3}, up{"hosel_up", "mm", 1e-3, -0.03, 0.03, 3e-3};
  heel.known = up.known = 0.01;
  Parametrisation placed{.what = "added mass at the hosel, wherever it is", .parameters = {mass, heel, up}};
  placed.starts = {{0.01, 0, 0}};
  placed.before = [](Sizes p, Shot& t) {
    if (p[0] != 0) attach(t.blow, p[0], 0, Vec3(0, p[1], p[2]));
  };
  Parametrisation stiff_placed{.what = "added mass and rotational inertia at the hosel, wherever it is",
                               .parameters = {mass, stiffening, heel, up}};
  stiff_placed.starts = {{0.01, 3e-5, 0, 0}};
  stiff_placed.before = [](Sizes p, Shot& t) {
    if (p[0] != 0 || p[1] != 0) attach(t.blow, p[0], p[1], Vec3(0, p[2], p[3]));
  };
  return {point, stiff, both, placed, stiff_placed};
}

}  // namespace hosel::loop::forms
