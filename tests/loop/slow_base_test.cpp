// The loop on a base that is asked through a surrogate: here a quick stand-in of a slow model, whose "cover" gives
// spin, so that the truth is known and thousands of answers cost nothing.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "golf/units.hpp"
#include "loop/shots/features.hpp"
#include "loop/shots/run.hpp"
#include "loop/shots/spread.hpp"
#include "models/rigid/rigid_eccentric.hpp"

namespace hosel::loop {
namespace {

/// A smooth law of its own where the closed form rolls: returns slip the more the stiffer the cover, less at speed.
Launch slow_model(const Shot& s) {
  static const models::RigidEccentric model;
  Blow b = s.blow;
  b.contact = {};
  b.contact.restitution += 0.02 - 0.05 * s.change.losses;
  b.contact.tangential_restitution = 0.25 + 0.15 * std::tanh(s.change.cover_stiffness) -
                                     0.003 * (b.delivery.club_speed - 40);
  return model.launch(b);
}

const char* const kHeaders[] = {"shot",          "club_speed_mps", "attack_angle_deg", "dynamic_loft_deg",
                                "impact_toe_mm", "impact_high_mm", "ball_speed_mps",   "launch_angle_deg",
                                "azimuth_deg",   "backspin_rpm",   "sidespin_rpm"};

/// Shots with the cover that much stiffer; of `bad` the loft is another quantity.
ShotCase made(double cover, int shots, int bad, unsigned seed) {
  ShotCase c;
  c.base = "a slow model";
  c.head_mass_declared = c.inertia_declared = c.deformable = true;
  c.blow.club.head = {
      .mass = 0.25, .cg = Vec3(-0.01, 0, 0), .inertia = Vec3(3e-4, 2e-4, 3e-4).asDiagonal(), .face = {}};
  c.blow.contact.friction = 0.4;
  post::Sheet sheet{"made", {}, {}, {}};
  for (const char* h : kHeaders) sheet.names.emplace_back(h);
  sheet.columns.resize(sheet.names.size());
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  for (int i = 0; i < shots; ++i) {
    Shot s;
    s.blow = c.blow;
    s.change.cover_stiffness = cover;
    s.blow.delivery = {.club_speed = 38 + 2 * gauss(random),
                       .attack_angle = radians(-2 + gauss(random)),
                       .dynamic_loft = radians(22 + 4 * gauss(random)),
                       .impact_toe = 0.006 * gauss(random),
                       .impact_high = 0.005 * gauss(random)};
    const Delivery& d = s.blow.delivery;
    const Launch l = slow_model(s);
    const double row[] = {i + 1.0,
                          d.club_speed,
                          degrees(d.attack_angle),
                          i < bad ? 82.0 : degrees(d.dynamic_loft),
                          1e3 * d.impact_toe,
                          1e3 * d.impact_high,
                          l.ball_speed() + 0.25 * gauss(random),
                          degrees(l.launch_angle()) + 0.2 * gauss(random),
                          degrees(l.azimuth()) + 0.25 * gauss(random),
                          rpm(l.backspin()) + 60 * gauss(random),
                          rpm(l.sidespin()) + 60 * gauss(random)};
    for (std::size_t k = 0; k < sheet.columns.size(); ++k)
      sheet.columns[k].push_back(k ? std::to_string(row[k]) : std::to_string(i + 1));
    sheet.lines.push_back(std::size_t(i) + 2);
  }
  c.shots = read_shots(sheet);
  c.noise = {{"ball_speed_mps", 0.25},
             {"launch_angle_deg", 0.2},
             {"azimuth_deg", 0.25},
             {"backspin_rpm", 60},
             {"sidespin_rpm", 60}};
  return c;
}

TEST(SlowBase, ASurrogateOverBlowsAndEffectsTellsItsError) {
  ShotCase c = made(0, 40, 0, 3);
  std::vector<Shot> recorded;
  for (std::size_t i = 0; i < 40; ++i) {
    Shot s;
    s.blow = c.blow;
    s.blow.delivery.club_speed = c.shots.find_stem("club_speed")->value[i];
    s.blow.delivery.dynamic_loft = c.shots.find_stem("dynamic_loft")->value[i];
    recorded.push_back(s);
  }
  std::vector<Parametrisation> effects;
  const Setting setting{.head_turns = true, .inertia_declared = true, .outputs = {}, .deformable = true};
  for (const EffectEntry& e : loop::effects())
    for (Parametrisation& p : e.forms(setting)) effects.push_back(std::move(p));
  EXPECT_GE(changed_quantities(recorded, effects), 12);
  const auto closed = [](const Shot& s) {
    Blow b = s.blow;
    b.contact = {};
    return models::RigidEccentric().launch(b);
  };
  Surrogate surrogate(slow_model, closed);
  surrogate.learn(spread(recorded, effects, 300, 1));
  EXPECT_EQ(surrogate.failed(), 0);
  double square = 0, told = 0;
  const std::vector<Shot> elsewhere = spread(recorded, effects, 200, 2);
  for (const Shot& s : elsewhere) {
    const Vec3 miss = surrogate.launch(s).spin - slow_model(s).spin;
    square += miss.squaredNorm() / 200;
    told += surrogate.error(s).diagonal().tail<3>().sum() * s.blow.delivery.club_speed * s.blow.delivery.club_speed /
            200;
  }
  EXPECT_NEAR(std::sqrt(told / square), 1, 0.4);  // told from 300 points, seen on 200
  EXPECT_LT(rpm(std::sqrt(square)), 150);         // of changes of some thousands
}

TEST(SlowBase, AnswersThatAreNoneForesawNothing) {
  const ShotCase c = made(0, 40, 0, 3);
  std::vector<Shot> shots(12);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    shots[i].blow = c.blow;
    shots[i].blow.delivery = {.club_speed = 30 + double(i), .dynamic_loft = radians(20)};
  }
  bool answers = true;
  const auto slow = [&](const Shot& s) {
    if (!answers) throw std::invalid_argument("no such blow");
    return slow_model(s);
  };
  Surrogate surrogate(slow, [](const Shot& s) { return models::RigidEccentric().launch(s.blow); });
  surrogate.learn(shots);
  EXPECT_TRUE(std::isnan(surrogate.surprise()));
  for (Shot& s : shots) s.blow.delivery.club_speed += 0.5;
  surrogate.learn(shots);
  EXPECT_TRUE(std::isfinite(surrogate.surprise()));
  answers = false;
  surrogate.learn(shots);
  EXPECT_EQ(surrogate.failed(), 12);
  EXPECT_TRUE(std::isnan(surrogate.surprise()));  // zero would read as foreseen to the last digit
}

TEST(SlowBase, EveryEffectInsideABaseMovesACoordinateAndNoneAtZero) {
  const ShotCase c = made(0, 1, 0, 1);
  int inside = 0;
  for (const bool full : {false, true}) {
    const Setting setting{.head_turns = true,
                          .inertia_declared = true,
                          .outputs = {Output::azimuth},
                          .deformable = true,
                          .shaft = true,
                          .full_club = full};
    for (const EffectEntry& e : loop::effects()) {
      for (const Parametrisation& f : e.forms(setting)) {
        if (!f.before) continue;
        Shot plain;
        plain.blow = c.blow;
        plain.order = 0.9;
        plain.blow.delivery = {.club_speed = 40, .dynamic_loft = radians(20)};
        Shot zero = plain, moved = plain;
        std::vector<double> p(f.parameters.size(), 0.0);
        f.before(p, zero);
        for (std::size_t k = 0; k < p.size(); ++k) p[k] = 0.3 * f.parameters[k].max;
        f.before(p, moved);
        EXPECT_EQ(zero.change, plain.change) << f.effect;
        bool moves = false;
        for (const Feature& q : features()) {
          EXPECT_EQ(q.get(zero), q.get(plain)) << f.effect << ": " << q.name;
          moves = moves || q.get(moved) != q.get(plain);
        }
        EXPECT_TRUE(moves) << f.effect << ", " << f.what;
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 30);
}

TEST(SlowBase, NamesWhatIsHiddenInsideTheModelAlthoughRowsAreBadAndEndsWithTheModelItself) {
  ShotCase c = made(0.7, 60, 4, 1);
  std::atomic<int> asked = 0;
  const SlowBase slow{.coarse =
                          [&](const Shot& s) {
                            ++asked;
                            return slow_model(s);
                          },
                      .fine = {}};
  c.slow = &slow;
  const LoopResult r = run(c);
  EXPECT_EQ(r.flagged.size(), 4U);
  EXPECT_EQ(r.adopted, std::vector<std::string>{"ball-cover-stiffness"});
  ASSERT_EQ(r.selection.chosen.p.size(), 1);
  EXPECT_NEAR(r.selection.chosen.p[0], 0.7, 0.12);  // tanh: 60 rpm on 40 shots are some 0.02
  ASSERT_TRUE(r.corrected);
  ASSERT_GT(r.corrected->rows.size(), 15U);
  const auto spin =
      std::size_t(std::ranges::find(r.channels, "backspin_rpm", &ChannelResult::name) - r.channels.begin());
  EXPECT_GT(errors(r.corrected->rows, &UsedRow::before, spin).holdout_rmse, 300);
  EXPECT_LT(errors(r.corrected->rows, &UsedRow::after, spin).holdout_rmse, 80);  // the noise is 60
  EXPECT_NEAR(r.corrected->shots.front().shot.change.cover_stiffness, r.selection.chosen.p[0], 1e-12);
  EXPECT_LT(asked, 600);
}

TEST(SlowBase, NothingHiddenNothingAdopted) {
  ShotCase c = made(0, 40, 0, 5);
  const SlowBase slow{.coarse = slow_model, .fine = {}};
  c.slow = &slow;
  const LoopResult r = run(c);
  EXPECT_TRUE(r.adopted.empty());
  EXPECT_TRUE(r.ties.empty());
  // The base is asked about what was held out all the same.
  ASSERT_TRUE(r.corrected && r.corrected->rows.size() > 10);
  EXPECT_EQ(errors(r.corrected->rows, &UsedRow::before, 0).holdout, int(r.corrected->rows.size()));
  for (const UsedRow& row : r.corrected->rows) EXPECT_EQ(row.before, row.after);
}

TEST(SlowBase, AnUnknownLoftIsFoundFromTheLaunchAngle) {
  ShotCase c = made(0.7, 60, 60, 2);  // no recorded loft is one
  c.loft_unknown = true;
  const SlowBase slow{.coarse = slow_model, .fine = {}};
  c.slow = &slow;
  const LoopResult r = run(c);
  EXPECT_TRUE(r.flagged.empty());
  EXPECT_TRUE(std::ranges::none_of(r.channels, [](const ChannelResult& k) { return k.name == "launch_angle_deg"; }));
  std::vector<std::string> named = r.adopted;
  for (const auto& tie : r.ties) named.insert(named.end(), tie.begin(), tie.end());
  EXPECT_TRUE(std::ranges::count(named, "ball-cover-stiffness"));
  ASSERT_TRUE(r.corrected);
  const auto spin =
      std::size_t(std::ranges::find(r.channels, "backspin_rpm", &ChannelResult::name) - r.channels.begin());
  EXPECT_LT(errors(r.corrected->rows, &UsedRow::after, spin).holdout_rmse,
            0.5 * errors(r.corrected->rows, &UsedRow::before, spin).holdout_rmse);
}

}  // namespace
}  // namespace hosel::loop
