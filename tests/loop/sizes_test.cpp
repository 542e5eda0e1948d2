// What a size of an effect is: that of the closed form for a blow so simple that there is one, and for what changes a
// declaration that declaration moved by as much.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "golf/units.hpp"
#include "loop/effect.hpp"
#include "loop/history/test_setup.hpp"
#include "models/registry.hpp"

namespace hosel::loop {
namespace {

constexpr double kToe = 0.02, kSpeed = 40;

/// A flat face at right angles to its way, whose centre of gravity lies `deep` behind it, struck `toe` aside.
Shot square_blow(double mass, double inertia, double deep, double toe) {
  Shot s;
  s.blow.club.head = {
      .mass = mass, .cg = Vec3(-deep, 0, 0), .inertia = Vec3::Constant(inertia).asDiagonal(), .face = {}};
  s.blow.delivery.club_speed = kSpeed;
  s.blow.delivery.impact_toe = toe;
  s.blow.contact = {.restitution = 0.8, .restitution_slope = 0};
  return s;
}
/// As a wall is: nothing of the blow turns or slows it.
Shot on_wall(double deep = 0.035, double toe = 0) { return square_blow(1e9, 1e6, deep, toe); }

Setting of_base(bool head_turns) {
  return {.head_turns = head_turns,
          .inertia_declared = true,
          .outputs = {Output::ball_speed, Output::launch_angle, Output::azimuth, Output::backspin, Output::sidespin}};
}

/// The form of an effect that varies this.
template <class Of>
Parametrisation form_of(const char* effect, const std::string& what, const Of& setting) {
  const EffectEntry* e = find_effect(effect);
  if (!e) throw std::runtime_error(std::string("no effect ") + effect);
  for (const Parametrisation& f : e->forms(setting))
    if (f.what == what) return f;
  throw std::runtime_error(std::string(effect) + " has no form " + what);
}

Launch launched(Shot s, const Parametrisation& f, const std::vector<double>& p, const char* base = "rigid-eccentric") {
  if (f.before) f.before(p, s);
  Launch l = models::find(base)->make({})->launch(s.blow);
  if (f.after) f.after(p, s, l);
  return l;
}
Launch launched(const Shot& s, const char* base = "rigid-eccentric") { return launched(s, {}, {}, base); }

/// Speed of the ball that a free head of this mass and inertia gives, struck `toe` beside its centre of gravity, which
/// lies in the face: the impulse by the effective mass there.
double free_head_speed(double mass, double inertia, double toe) {
  const double ball = Ball{}.mass;
  return 1.8 * kSpeed / (1 / ball + 1 / mass + toe * toe / inertia) / ball;
}

TEST(Sizes, OfTheBallsInertia) {
  // Rolling on a wall that slides past: its speed u, spin u / r / (1 + k).
  Shot s = on_wall();
  s.blow.delivery.dynamic_loft = radians(20);
  const auto f = form_of("ball-inertia", "inertia factor I / (m r^2)", of_base(true));
  const double k = s.blow.ball.inertia_factor, ratio = launched(s, f, {0.05}).backspin() / launched(s).backspin();
  EXPECT_GT(launched(s).backspin(), 100);
  EXPECT_NEAR(ratio, (1 + k) / (1 + k + 0.05), 1e-6);
}

TEST(Sizes, OfTheRestitutionsFall) {
  // On a wall the ball leaves with (1 + e) V.
  Shot s = on_wall(0, kToe);
  s.blow.delivery.impact_high = -0.01;
  const double calm = launched(s).velocity.x(), far = kToe * kToe + 1e-4;
  EXPECT_NEAR(calm, 1.8 * kSpeed, 1e-6);
  const auto fallen = [&](const char* what, const std::vector<double>& p) {
    return (calm - launched(s, form_of("restitution-falloff", what, of_base(true)), p).velocity.x()) / kSpeed;
  };
  EXPECT_NEAR(fallen("with the square of the distance", {100}), 100 * far, 1e-6);
  EXPECT_NEAR(fallen("with the squares of toe and high offset", {100, 0}), 100 * kToe * kToe, 1e-6);
  EXPECT_NEAR(fallen("with the squares of toe and high offset", {0, 100}), 100 * 1e-4, 1e-6);
  EXPECT_NEAR(fallen("with the distance", {2}), 2 * std::sqrt(far), 1e-6);
}

TEST(Sizes, OfTheNormalForcesOffset) {
  // The couple p r J turns a ball that J = m v sends off: p v / (k r). Where it rolls all the same, the tangent's
  // impulse is less by it: the spin more by p v / ((1 + k) r).
  Shot s = on_wall();
  s.blow.delivery.dynamic_loft = radians(20);
  const double v = 1.8 * kSpeed * std::cos(radians(20)), r = s.blow.ball.radius, k = s.blow.ball.inertia_factor;
  const auto more = [&](const char* what) {
    return launched(s, form_of("normal-force-offset", what, of_base(true)), {0.04}).backspin() - launched(s).backspin();
  };
  EXPECT_NEAR(more("offset over the ball's radius, its couple added to rolling"), 0.04 * v / (k * r), 1e-4);
  EXPECT_NEAR(more("offset over the ball's radius, rolling kept"), 0.04 * v / ((1 + k) * r), 1e-4);
}

TEST(Sizes, OfTheHeadsClosure) {
  // A face that turns about an axis `deep` behind it slides past the ball with w deep, and the ball rolls on it.
  constexpr double deep = 0.035, w = 30;
  Shot s = on_wall(deep);
  s.blow.club.geometry.shaft_axis = Vec3::UnitZ();
  const double spin = w * deep / (s.blow.ball.radius * (1 + s.blow.ball.inertia_factor));
  for (const bool turns : {true, false})
    for (const char* what : {"about the vertical", "about the shaft"}) {
      const char* base = turns ? "rigid-eccentric" : "rigid-planar";
      const Launch l = launched(s, form_of("head-closure", what, of_base(turns)), {w}, base), still = launched(s, base);
      EXPECT_NEAR(std::abs(l.sidespin() - still.sidespin()), spin, 1e-4) << base << " " << what;
      // The face carries the ball along with it, as a turn about the vertical carries what lies ahead of the axis.
      EXPECT_NEAR(l.velocity.y() - still.velocity.y(), w * deep * 0.4 / 1.4, 1e-4) << base << " " << what;
    }
}

TEST(Sizes, OfTheShaftsCoupling) {
  Shot s = square_blow(0.2, 3e-4, 0, 0);
  s.blow.club.geometry.hosel = Vec3::Zero();
  s.blow.club.geometry.shaft_axis = Vec3::UnitY();
  const auto f = [](const char* what) { return form_of("shaft-coupling", what, of_base(true)); };
  EXPECT_NEAR(launched(s).velocity.x(), free_head_speed(0.2, 3e-4, 0), 1e-9);
  EXPECT_NEAR(launched(s, f("added mass at the hosel"), {0.02}).velocity.x(), free_head_speed(0.22, 3e-4, 0), 1e-9);
  s.blow.delivery.impact_toe = kToe;
  EXPECT_NEAR(launched(s, f("added rotational inertia across the shaft"), {1e-4}).velocity.x(),
              free_head_speed(0.2, 4e-4, kToe), 1e-9);
  EXPECT_NEAR(launched(s, f("added mass and rotational inertia at the hosel"), {0.02, 1e-4}).velocity.x(),
              free_head_speed(0.22, 4e-4, kToe), 1e-9);
}

TEST(Sizes, OfTheHeadsInertia) {
  Shot toe = square_blow(0.2, 3e-4, 0, kToe), high = square_blow(0.2, 3e-4, 0, 0);
  high.blow.delivery.impact_high = kToe;
  const double other = free_head_speed(0.2, 3e-4 * std::exp(0.5), kToe), own = free_head_speed(0.2, 3e-4, kToe);
  ASSERT_GT(other - own, 1);
  const auto speed = [](const Shot& s, const char* what, const std::vector<double>& p) {
    return launched(s, form_of("head-inertia", what, of_base(true)), p).velocity.x();
  };
  for (const Shot& s : {toe, high}) EXPECT_NEAR(speed(s, "one factor on the tensor", {0.5}), other, 1e-9);
  EXPECT_NEAR(speed(toe, "about the vertical axis of the face", {0.5}), other, 1e-9);
  EXPECT_NEAR(speed(high, "about the vertical axis of the face", {0.5}), own, 1e-9);
  EXPECT_NEAR(speed(high, "about the horizontal axis of the face", {0.5}), other, 1e-9);
  EXPECT_NEAR(speed(toe, "about the horizontal axis of the face", {0.5}), own, 1e-9);
  EXPECT_NEAR(speed(high, "factors about the horizontal and the vertical axis", {0.5, 0}), other, 1e-9);
  EXPECT_NEAR(speed(toe, "factors about the horizontal and the vertical axis", {0, 0.5}), other, 1e-9);
}

TEST(Sizes, OfTheHeadsRotation) {
  // On a base whose head does not turn: as free as the declared inertia says, or half of it.
  const Shot s = square_blow(0.2, 3e-4, 0, kToe);
  const double held = launched(s, "rigid-planar").velocity.x();
  EXPECT_NEAR(held, free_head_speed(0.2, 1e9, kToe), 1e-6);
  const auto speed = [&](const char* what, double p) {
    return launched(s, form_of("head-rotation", what, of_base(false)), {p}, "rigid-planar").velocity.x();
  };
  const char *turns = "the declared inertia turns",
             *whole = "free head, with face, path and curvature in three dimensions";
  EXPECT_NEAR(speed(turns, 1), free_head_speed(0.2, 3e-4, kToe), 1e-6);
  EXPECT_NEAR(speed(turns, 0.5), free_head_speed(0.2, 6e-4, kToe), 1e-6);
  EXPECT_NEAR(speed(whole, 1), free_head_speed(0.2, 3e-4, kToe), 1e-6);
  EXPECT_NEAR(speed(whole, 0.5), (held + free_head_speed(0.2, 3e-4, kToe)) / 2, 1e-6);
}

TEST(Sizes, OfAMonitorsAxes) {
  Shot s = on_wall();
  s.blow.delivery.dynamic_loft = radians(20);
  const Launch own = launched(s);
  const auto seen = [&](const char* what) {
    return launched(s, form_of("monitor-misalignment", what, of_base(true)), {radians(2)});
  };
  EXPECT_NEAR(seen("yaw").azimuth() - own.azimuth(), radians(2), 1e-9);
  EXPECT_NEAR(seen("yaw").launch_angle(), own.launch_angle(), 1e-9);
  EXPECT_NEAR(seen("pitch").launch_angle() - own.launch_angle(), radians(2), 1e-9);
  EXPECT_NEAR(seen("roll").spin_axis() - own.spin_axis(), radians(2), 1e-9);
  EXPECT_NEAR(seen("roll").ball_speed(), own.ball_speed(), 1e-9);
}

TEST(Sizes, OfTheSpinsTilt) {
  const auto f = form_of("spin-axis-bias", "tilt of the spin beyond the recorded one, positive for a fade",
                         Setting{.outputs = {}, .flies = true, .no_blow = true});
  Launch l;
  l.velocity = Vec3(70, 0, 12);
  l.spin = Vec3(0, -280, -20);
  const Launch own = l;
  f.seen(std::vector{radians(3)}, l);
  EXPECT_NEAR(l.spin_axis() - own.spin_axis(), radians(3), 1e-9);
  EXPECT_NEAR(l.spin_rate(), own.spin_rate(), 1e-9);
  EXPECT_EQ(l.velocity, own.velocity);
}

TEST(Sizes, OfWhatAFiniteElementBaseDeclares) {
  const auto moved = [](const char* effect, const char* what, const Setting& setting) {
    Shot s;
    s.blow.club.geometry.hosel = Vec3(-0.01, 0.05, 0.02);
    form_of(effect, what, setting).before(std::vector{0.004}, s);
    return s;
  };
  const Setting club{.outputs = {}, .deformable = true, .shaft = true, .full_club = true};
  const std::vector<std::pair<const char*, Vec3>> ways = {
      {"out of the face", Vec3::UnitX()}, {"towards the heel", Vec3::UnitY()}, {"up", Vec3::UnitZ()}};
  for (const auto& [what, way] : ways)
    EXPECT_LT(
        (moved("hosel-place", what, club).blow.club.geometry.hosel - Vec3(-0.01, 0.05, 0.02) - 0.004 * way).norm(),
        1e-12)
        << what;
  EXPECT_DOUBLE_EQ(moved("ball-relaxation", "one factor on the branch times", club).change.relaxation, 0.004);
  const Setting head{.outputs = {}, .deformable = true, .shaft = true};
  EXPECT_DOUBLE_EQ(moved("shaft-coupling", "share of the declared shaft", head).change.shaft, 0.004);
}

/// What a club test declares: the change itself is told by the bench's own tests.
TEST(Sizes, OfAClubTest) {
  HistoryChannel channel;
  channel.name = "tip_lead_mm";
  channel.si = 1e-3;
  channel.noise = 0.1;
  const HistorySetting setting{.channels = {channel, channel},
                               .head = true,
                               .driven = true,
                               .turning = true,
                               .compliance = 0.01,
                               .frequency = 25,
                               .ratio = 0.01};
  const auto changed = [&](const char* effect, const char* what) {
    TestSetup r(2);
    form_of(effect, what, setting).setup(std::vector{0.003}, r);
    return r;
  };
  EXPECT_DOUBLE_EQ(changed("rotational-stiffening", "share of the centrifugal stiffness").club.stiffening, 0.003);
  EXPECT_DOUBLE_EQ(changed("sensor-offset", "of tip_lead_mm").offset[0], 0.003);
  const std::vector<std::pair<const char*, Vec3>> hosel = {{"alike about all axes", Vec3(1, 1, 1)},
                                                           {"across the shaft", Vec3(1, 1, 0)},
                                                           {"about the shaft", Vec3(0, 0, 1)}},
                                                  clamp = {{"alike in both planes", Vec3(1, 1, 0)},
                                                           {"in the lead plane", Vec3(0, 1, 0)},
                                                           {"in the droop plane", Vec3(1, 0, 0)},
                                                           {"about the shaft", Vec3(0, 0, 1)}},
                                                  head = {{"one factor on the tensor", Vec3(1, 1, 1)},
                                                          {"about the face normal", Vec3(1, 0, 0)},
                                                          {"about the horizontal", Vec3(0, 1, 0)},
                                                          {"about the vertical", Vec3(0, 0, 1)}};
  for (const auto& [what, axes] : hosel)
    EXPECT_LT((changed("hosel-compliance", what).club.hosel - 0.003 * axes).norm(), 1e-15) << what;
  for (const auto& [what, axes] : clamp)
    EXPECT_LT((changed("clamp-compliance", what).club.clamp - 0.003 * axes).norm(), 1e-15) << what;
  for (const auto& [what, axes] : head)
    EXPECT_LT((changed("head-inertia", what).club.inertia - 0.003 * axes).norm(), 1e-15) << what;
}

}  // namespace
}  // namespace hosel::loop
