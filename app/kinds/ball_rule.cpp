#include "app/kinds/ball_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "models/checked_launch.hpp"
#include "models/registry.hpp"
#include "post/csv.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

/// A machine's drive: the club's speed is the model's business, launch angle and spin are prescribed.
struct Test {
  double club_speed, launch_angle, spin_rate;
};

struct Player {
  std::string name;
  double club_speed, dynamic_loft;
  std::vector<double> published;  ///< lowest and highest loss [m]; may be empty
};

/// A ball as it may be changed: factors on drag, lift and the speed at which it leaves the face.
struct Change {
  double drag = 1, lift = 1, speed = 1;
};

/// One way to change a ball.
struct Remedy {
  const char* name;
  double Change::*factor;
  double low, high;
};
constexpr std::array kRemedies = {Remedy{"drag", &Change::drag, 0.5, 2}, Remedy{"lift", &Change::lift, 0.2, 1.3},
                                  Remedy{"speed", &Change::speed, 0.7, 1.2}};

class BallRuleJob final : public Job {
 public:
  explicit BallRuleJob(CaseFile& file) {
    Table root = file.root();
    std::vector<std::string> names;
    for (const auto& m : models::registry()) names.emplace_back(m.name);
    const std::string model = root.choice({"model", "that answers (`hosel list`)"}, names);
    blow_ = read_blow(root, {model});
    model_ = models::find(model)->make(read_options(root, {model}, blow_));
    setup_ = read_flight(root.table("flight"));
    if (!setup_.turf) root.fail("flight", "the rule limits the total distance: a [flight.turf] is needed");
    Table rule = root.table("rule");
    limit_ = rule.quantity({"limit", "longest allowed total distance"}, "yd", {50, 500});
    reach_ = rule.quantity({"reach", "of the ball in the old test: a ball in use need not be at the limit"}, "yd",
                           {50, 500}, limit_);
    new_limit_ = rule.quantity({"new_limit", "what the changed ball may reach in the new test: with a tolerance, say"},
                               "yd", {50, 500}, limit_);
    old_ = read_test(rule.table("old"));
    new_ = read_test(rule.table("new"));
    std::vector<std::string> taken;
    for (Table t : root.tables("player")) {
      players_.push_back({t.name({"name", "of the player"}, taken),
                          t.quantity({"club_speed", "of the player"}, "mph", {10, 100}),
                          t.quantity({"dynamic_loft", "of the player's club"}, "deg", {0, kPi / 2}),
                          {}});
      if (t.has_quantity("published_loss"))
        players_.back().published =
            t.quantities({"published_loss", "what was announced that such players lose, low and high"}, "yd", 2,
                         Range::non_negative());
    }
    if (players_.empty()) root.fail("player", "name at least one [[player]]");
  }

  void run(Output& out) override {
    nlohmann::json summary;
    // The ball at the limit: its drag such that the old test ends there.
    const Change today{.drag = solve(kRemedies[0], {}, old_, reach_)};
    const double reach = total(today, machine(new_, today));
    out.say(fmt::format(
        "old test: {:.1f} mph of ball speed; the ball that reaches {:.0f} yd has {:.3f} times the drag "
        "of {}\nnew test: {:.1f} mph of ball speed; the same ball reaches {:.1f} yd: {:.1f} too many",
        machine(old_, today).ball_speed() / kMpsPerMph, reach_ / yard(), today.drag, setup_.conditions.law.name,
        machine(new_, today).ball_speed() / kMpsPerMph, reach / yard(), (reach - new_limit_) / yard()));
    out.page().answer("a ball at the old limit, in the new test", fmt::format("{:.1f} yd", reach / yard()),
                      fmt::format("{:.1f} too many for {:.0f}", (reach - new_limit_) / yard(), new_limit_ / yard()));
    summary["drag_at_the_limit"] = today.drag;
    summary["new_test_total_yd"] = reach / yard();
    post::TextTable losses{
        .rows = {{"loss of total distance [yd]", "club [mph]", "ball [mph]", "carry [yd]", "total [yd]"}},
        .first_width = 28,
        .least_width = 12,
        .even = false};
    std::string csv = "player,club_speed_mph,ball_speed_mph,carry_yd,total_yd";
    std::vector<Change> changed;
    for (const Remedy& r : kRemedies) {
      Change c = today;
      c.*r.factor = solve(r, today, new_, new_limit_);
      changed.push_back(c);
      const double factor = c.*r.factor / (today.*r.factor);
      losses.rows[0].push_back(fmt::format("{} x {:.3f}", r.name, factor));
      csv += fmt::format(",loss_by_{}_yd", r.name);
      summary["factors"][r.name] = factor;
    }
    losses.rows[0].emplace_back("published");
    csv += ",published_low_yd,published_high_yd\n";
    post::Figure figure{
        .title = fmt::format("a ball at {:.0f} yd under the old test, changed to reach {:.0f} under the new",
                             reach_ / yard(), new_limit_ / yard()),
        .panel_width = 900,
        .panel_height = 520};
    post::Panel panel{.x_label = "club speed [mph]", .y_label = "loss of total distance [yd]"};
    for (std::size_t k = 0; k < changed.size(); ++k)
      panel.series.push_back({.label = fmt::format("by {}", kRemedies[k].name), .style = "linespoints"});
    post::Series published{.label = "published for such players"};
    for (const Player& p : players_) {
      const Launch launch = drive(p, today);
      const post::ShotFlight shot = follow(today, launch);
      losses.rows.push_back({p.name, fmt::format("{:.0f}", p.club_speed / kMpsPerMph),
                             fmt::format("{:.1f}", launch.ball_speed() / kMpsPerMph),
                             fmt::format("{:.1f}", shot.flight.carry / yard()),
                             fmt::format("{:.1f}", shot.run->total / yard())});
      std::vector<std::string>& line = losses.rows.back();
      csv += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g}", post::csv_cell(p.name), p.club_speed / kMpsPerMph,
                         launch.ball_speed() / kMpsPerMph, shot.flight.carry / yard(), shot.run->total / yard());
      for (std::size_t k = 0; k < changed.size(); ++k) {
        const double loss = (shot.run->total - total(changed[k], drive(p, changed[k]))) / yard();
        line.push_back(fmt::format("{:.1f}", loss));
        csv += fmt::format(",{:.4g}", loss);
        summary["players"][p.name][fmt::format("loss_by_{}_yd", kRemedies[k].name)] = loss;
        panel.series[k].x.push_back(p.club_speed / kMpsPerMph);
        panel.series[k].y.push_back(loss);
      }
      if (p.published.empty()) {
        csv += ",,\n";
        line.emplace_back();
      } else {
        const double low = p.published[0] / yard(), high = p.published[1] / yard();
        line.push_back(fmt::format("{:g} to {:g}", low, high));
        csv += fmt::format(",{:g},{:g}\n", low, high);
        published.x.push_back(p.club_speed / kMpsPerMph);
        published.y.push_back((low + high) / 2);
        published.error.push_back((high - low) / 2);
      }
    }
    out.tell("");
    out.show(losses);
    compare_laws(out, summary, panel);
    if (!published.x.empty()) panel.series.push_back(published);
    figure.panels = {panel};
    out.write("losses.csv", csv);
    out.draw(figure, "figures/losses");
    out.write_summary(summary);
  }

 private:
  /// The losses by more drag through every law of `beside`, each with its own ball at the limit: what the choice of the
  /// law makes of them. Draws the lowest and the highest.
  void compare_laws(Output& out, nlohmann::json& summary, post::Panel& panel) {
    if (setup_.others.empty()) return;
    post::TextTable table{.rows = {{"loss by more drag [yd]", "drag at the limit", "more drag"}},
                          .first_width = 28,
                          .least_width = 12,
                          .even = false};
    for (const Player& p : players_) table.rows[0].push_back(p.name);
    const models::FlightLaw own = setup_.conditions.law;
    constexpr int colour = 5;
    post::Series least{.label = "by drag, lowest and highest of all laws", .colour = colour}, most{.colour = colour};
    for (const Player& p : players_) {
      for (post::Series* s : {&least, &most}) s->x.push_back(p.club_speed / kMpsPerMph);
      least.y.push_back(std::numeric_limits<double>::infinity());
      most.y.push_back(-std::numeric_limits<double>::infinity());
    }
    std::vector<models::FlightLaw> laws = {own};
    laws.insert(laws.end(), setup_.others.begin(), setup_.others.end());
    for (const models::FlightLaw& law : laws) {
      setup_.conditions.law = law;
      std::vector<std::string> row = {law.name};
      try {
        const Change today{.drag = solve(kRemedies[0], {}, old_, reach_)},
            then{.drag = solve(kRemedies[0], today, new_, new_limit_)};
        row.insert(row.end(), {fmt::format("{:.3f}", today.drag), fmt::format("x {:.3f}", then.drag / today.drag)});
        for (std::size_t k = 0; k < players_.size(); ++k) {
          const Player& p = players_[k];
          const double loss = (total(today, drive(p, today)) - total(then, drive(p, then))) / yard();
          row.push_back(fmt::format("{:.1f}", loss));
          summary["laws"][law.name][p.name] = loss;
          least.y[k] = std::min(least.y[k], loss);
          most.y[k] = std::max(most.y[k], loss);
        }
      } catch (const solvers::NonConvergence& e) {
        out.say(fmt::format("{}: {}", law.name, e.what()));
        continue;
      }
      table.rows.push_back(std::move(row));
    }
    setup_.conditions.law = own;
    out.show(table, "By every law");
    if (table.rows.size() < 3) return;
    panel.series.push_back(std::move(least));
    panel.series.push_back(std::move(most));
  }

  static double yard() { return post::size(post::DistanceUnit::yards); }

  static Test read_test(Table t) {
    return {t.quantity({"club_speed", "of the test"}, "mph", {10, 100}),
            t.quantity({"launch_angle", "of the test"}, "deg", {0, kPi / 2}),
            t.quantity({"spin_rate", "of the test"}, "rpm", Range::positive())};
  }

  Launch drive(const Player& p, const Change& c) const {
    Blow blow = blow_;
    blow.delivery.club_speed = p.club_speed;
    blow.delivery.dynamic_loft = p.dynamic_loft;
    Launch l = models::checked_launch(*model_, blow);
    l.velocity *= c.speed;
    return l;
  }

  Launch machine(const Test& t, const Change& c) const {
    Blow blow = blow_;
    blow.delivery.club_speed = t.club_speed;
    const double speed = c.speed * models::checked_launch(*model_, blow).ball_speed();
    Launch l;
    l.velocity = speed * Vec3(std::cos(t.launch_angle), 0, std::sin(t.launch_angle));
    l.spin = {0, -t.spin_rate, 0};
    return l;
  }

  post::ShotFlight follow(const Change& c, const Launch& launch) const {
    FlightSetup s = setup_;
    s.conditions.law.drag_scale *= c.drag;
    s.conditions.law.lift_scale *= c.lift;
    return s.follow(launch, blow_.ball);
  }

  double total(const Change& c, const Launch& launch) const { return follow(c, launch).run->total; }

  /// The factor with which the test ends at the limit. A bounce more or less makes the total jump by centimetres: the
  /// factor is found as well as it can be.
  double solve(const Remedy& r, Change c, const Test& test, double wanted) const {
    const auto excess = [&](double factor) {
      c.*r.factor = factor;
      return total(c, machine(test, c)) - wanted;
    };
    const double low = excess(r.low), high = excess(r.high);
    if (low * high > 0)
      throw solvers::NonConvergence(
          fmt::format("no factor on {} from {:g} to {:g} brings the ball to the limit: {:.1f} "
                      "and {:.1f} yd",
                      r.name, r.low, r.high, (low + wanted) / yard(), (high + wanted) / yard()));
    std::uintmax_t most = 200;
    const auto [a, b] = boost::math::tools::toms748_solve(excess, r.low, r.high, low, high,
                                                          boost::math::tools::eps_tolerance<double>(30), most);
    return (a + b) / 2;
  }

  Blow blow_;
  std::unique_ptr<models::ImpactModel> model_;
  FlightSetup setup_;
  double limit_ = 0, reach_ = 0, new_limit_ = 0;
  Test old_{}, new_{};
  std::vector<Player> players_;
};

}  // namespace

std::unique_ptr<Job> read_ball_rule(CaseFile& file) { return std::make_unique<BallRuleJob>(file); }

}  // namespace hosel::app
