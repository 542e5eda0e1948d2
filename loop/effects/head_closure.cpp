// The head has an angular velocity at impact: the contact point moves differently from the centre of gravity.
#include "loop/effects/all.hpp"
#include "loop/effects/eccentric_difference.hpp"

namespace hosel::loop::forms {
namespace {

/// For a base without rotation of the head: the difference that the angular velocity makes on a head of
/// endless inertia, which is the extra velocity of the contact point.
void add_moving_point(const Vec3& spin, const Shot& t, Launch& launch) {
  Blow still = t.blow;
  still.club.head.inertia = 1e3 * Mat3::Identity();
  Blow turning = still;
  turning.delivery.head_angular_velocity += spin;
  add_difference(turning, still, 1, launch);
}

}  // namespace

std::vector<Parametrisation> head_closure(const Setting& setting) {
  // Usual: assumed, a club that closes at 2000 deg/s.
  const auto turning = [&](const char* what, const std::vector<const char*>& rates, auto vector) {
    Parametrisation f{.what = what};
    for (const char* name : rates) f.parameters.push_back(Parameter{name, "rad/s", 1, -90, 90, 10}.within(35));
    if (setting.head_turns)
      f.before = [vector](Sizes p, Shot& t) {
        if (const Vec3 w = vector(p, t.blow); !w.isZero(0)) t.blow.delivery.head_angular_velocity += w;
      };
    else
      f.after = [vector](Sizes p, const Shot& t, Launch& launch) {
        if (const Vec3 w = vector(p, t.blow); !w.isZero(0)) add_moving_point(w, t, launch);
      };
    return f;
  };
  const auto about = [&](const std::vector<int>& axes, const char* what) {
    static constexpr const char* names[] = {"rate_x", "rate_y", "rate_z"};
    std::vector<const char*> rates;
    for (const int a : axes) rates.push_back(names[a]);
    return turning(what, rates, [axes](Sizes p, const Blow&) {
      Vec3 w = Vec3::Zero();
      for (std::size_t k = 0; k < axes.size(); ++k) w[axes[k]] = p[k];
      return w;
    });
  };
  // A club closes about its shaft, which stands more upright than flat: rates about the horizontal are unusual, and
  // they do to the launch what a shifted centre of gravity does.
  std::vector<Parametrisation> all = {
      about({2}, "about the vertical"), about({1}, "about the horizontal across the target line"),
      about({1, 2}, "about the vertical and the horizontal"), about({0, 1, 2}, "about three axes")};
  for (std::size_t k = 1; k < all.size(); ++k) all[k].complexity = 10;
  all.push_back(turning("about the shaft", {"rate_shaft"}, [](Sizes p, const Blow& b) {
    return Vec3(p[0] * (b.delivery.face_to_global() * b.club.geometry.shaft_axis));
  }));
  return all;
}

}  // namespace hosel::loop::forms
