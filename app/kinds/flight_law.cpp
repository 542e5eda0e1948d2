#include "app/kinds/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_paths.hpp"
#include "post/digits.hpp"
#include "post/labels.hpp"
#include "post/table.hpp"
#include "solvers/errors.hpp"
#include "solvers/robust_regression.hpp"

namespace hosel::app {
namespace {

using models::FlightLaw;
using models::GroupWind;
using models::PathFit;

/// Computed minus seen by the radar, over some shots.
struct Misses {
  std::vector<double> carry, side, apex, time;

  static double mean(const std::vector<double>& x) {
    double sum = 0;
    for (const double v : x) sum += v;
    return sum / double(x.size());
  }
  static double rms(const std::vector<double>& x) {
    double sum = 0;
    for (const double v : x) sum += v * v;
    return std::sqrt(sum / double(x.size()));
  }
};

nlohmann::json to_json(const Misses& m) {
  return {{"shots", m.carry.size()},
          {"carry_bias_m", Misses::mean(m.carry)},
          {"carry_rms_m", Misses::rms(m.carry)},
          {"side_rms_m", Misses::rms(m.side)},
          {"apex_bias_m", Misses::mean(m.apex)},
          {"apex_rms_m", Misses::rms(m.apex)},
          {"time_bias_s", Misses::mean(m.time)},
          {"time_rms_s", Misses::rms(m.time)}};
}

class FlightLawJob final : public Job {
 public:
  explicit FlightLawJob(CaseFile& file) {
    Table root = file.root();
    const Ball ball = read_optional_ball(root);
    data_ = read_paths(root.table("paths"), ball);
    Table law = root.table("law");
    const std::string start =
        law.text({"start", "inferred law whose form, window and margins are used (`hosel list`)"}, "radar-2022");
    const auto* entry = models::find_flight_law(start);
    if (!entry || !std::holds_alternative<models::SurfaceLaw>(entry->make().form))
      law.fail("start", fmt::format("'{}' is no law that was inferred from flights", start));
    start_ = entry->make();
    auto& surface = std::get<models::SurfaceLaw>(start_.form);
    const auto terms = [&](const char* name, models::SurfaceLaw::Terms& into) {
      const std::vector<double> c =
          law.numbers({name, "its six terms about which nothing better is known"}, 6, Range::finite());
      std::ranges::copy(c, into.begin());
    };
    terms("drag", surface.drag);
    terms("lift", surface.lift);
    start_.decay = {.travel = law.number({"decay_travel", "share of the spin lost per radius of path"}, {0, 1e-3})};
    const double sd = law.number({"sd", "standard deviation of each term about these"}, Range::positive());
    law_sd_.assign(models::kInferredCoefficients, sd);
    law_sd_.back() = law.number({"decay_travel_sd", "of the decay about that"}, {0, 1e-3, true});
    for (const std::string& name :
         law.texts({"beside", "published laws that are judged on the same players"}, std::vector<std::string>{})) {
      const auto* other = models::find_flight_law(name);
      if (!other) law.fail("beside", fmt::format("no flight law '{}'; `hosel list` shows them", name));
      others_.push_back(other->make());
    }
  }

  void run(Output& out) override {
    if (!data_.missing.empty()) return out.skip(data_.missing);
    const auto training = data_.paths(false), held = data_.paths(true);
    if (training.empty() || held.empty())
      throw InputError("[paths]: no shot to learn from, or none of a player left out");
    out.say(fmt::format("{} shots to learn from, {} of players left out, {} groups", training.size(), held.size(),
                        data_.groups.size()));
    for (const std::string& rows : data_.not_used()) out.say("  " + rows);

    const int groups = int(data_.groups.size());
    PathFit found = models::fit_paths(training, groups, data_.model, start_, law_sd_);
    found.law.name = "inferred";
    nlohmann::json summary;
    tell_law(out, found, summary);
    tell_winds(out, found, training, summary);
    judge(out, found, training, held, summary);
    out.write_summary(summary);
  }

 private:
  void tell_law(Output& out, const PathFit& fit, nlohmann::json& summary) {
    FlightLaw law = fit.law, shipped = models::find_flight_law("radar-2022")->make();
    constexpr int n = models::kInferredCoefficients;
    post::Table table{{{"coefficient", "{}", "coefficient"},
                       {"value", "{:.9g}", "inferred", "{:.4g}"},
                       {.heading = "standard error", .spoken = "{:.2g}"},
                       {.heading = "radar-2022 as shipped", .spoken = "{:.4g}"}},
                      {.first_width = 20}};
    for (int k = 0; k < n; ++k)
      table.in_files({fmt::format("covariance_{}", models::inferred_coefficient_name(k))}, "{:.6g}");
    for (int k = 0; k < n; ++k) {
      const std::string name(models::inferred_coefficient_name(k));
      const double value = models::inferred_coefficient(law, k), sd = std::sqrt(law.covariance[std::size_t(k * n + k)]);
      table.add(name, value, sd, models::inferred_coefficient(shipped, k));
      table.more(std::span(law.covariance).subspan(std::size_t(k * n), n));
      summary["law"][name] = {{"value", value}, {"sd", sd}};
    }
    out.say(fmt::format("\nthe law, after {} steps; positions are met to {:.2f} m rms (weighted, each axis)",
                        fit.iterations, fit.rms));
    post::TextTable shown = table.shown();
    for (auto& row : shown.rows) row[0] = post::spoken(row[0]);  // `_s` is of the spin ratio here, no second
    out.show(shown, "The law");
    out.write("law.csv", table.csv());
    draw_law(out, law);
  }

  void draw_law(Output& out, const FlightLaw& law) const {
    post::Figure figure{.title =
                            "drag and lift over the spin ratio, each where its source has it: inferred (lines), "
                            "published at Re = 140000 (points)",
                        .columns = 2};
    post::Panel drag{.x_label = "spin ratio [-]", .y_label = "drag coefficient [-]"},
        lift{.x_label = "spin ratio [-]", .y_label = "lift coefficient [-]"};
    const auto add = [&](const FlightLaw& l, double re, const std::string& label, const char* style) {
      post::Series d{.label = label, .style = style}, c = d;
      for (double s = 0.03; s < 0.3005; s += 0.005) {
        if (!l.holds(re, s)) continue;  // beyond it the curve is another law's, or a straight line
        const auto k = l.at(re, s);
        d.add(s, k.drag);
        c.add(s, k.lift);
      }
      if (d.x.empty()) return;
      drag.series.push_back(d);
      lift.series.push_back(c);
    };
    for (const double re : {1e5, 1.4e5, 1.9e5}) add(law, re, fmt::format("inferred, Re {:.0f}", re), "lines");
    for (const FlightLaw& o : others_) add(o, 1.4e5, o.name, "points");
    figure.panels = {drag, lift};
    out.draw(figure, "figures/law");
  }

  void tell_winds(Output& out, const PathFit& fit, const std::vector<models::MeasuredPath>& shots,
                  nlohmann::json& summary) const {
    post::TextTable table{.rows = {{"group", "shots", "wind along [m/s]", "to the right [m/s]"}}, .first_width = 14};
    for (std::size_t g = 0; g < data_.groups.size(); ++g) {
      const auto n = std::ranges::count_if(shots, [&](const auto& s) { return s.group == int(g); });
      const auto of = [&](int k) {
        return post::fixed(fit.winds[g][k], 1, true) + fmt::format(" +- {:.1f}", fit.wind_sd[g][k]);
      };
      table.rows.push_back({data_.groups[g], fmt::format("{}", n), of(0), of(1)});
      summary["winds"][data_.groups[g]] = {{"along_mps", fit.winds[g][0]}, {"right_mps", fit.winds[g][1]}};
    }
    out.tell("");
    out.show(table, "The wind of each group, at 10 m");
  }

  /// Of the held-out shots that some ball and wind explain.
  Misses misses(const std::vector<models::ShotUnknowns>& own, const std::vector<GroupWind>& winds,
                const FlightLaw& law) const {
    Misses m;
    const auto held = data_.flights_of(true);
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (!sound_[i]) continue;
      const RadarFlight& f = *held[i];
      const models::Flight flight =
          models::fly(models::launched(f.path.launch, own[i]), data_.model.ball,
                      models::conditions_of(f.path, data_.model, law, own[i], winds[std::size_t(f.path.group)]));
      m.carry.push_back(flight.carry - f.carry);
      m.side.push_back(flight.side - f.side);
      m.apex.push_back(flight.apex - f.apex);
      m.time.push_back(flight.time - f.time);
    }
    return m;
  }

  /// What drives with such launches did, without physics: a quadratic in speed, angle and logarithm of the spin, and
  /// the site's density where sites differ, fitted robustly to the drives to learn from. No law predicts much better
  /// from the launch alone. Throws NonConvergence where they are too few or too alike.
  Misses regressed() const {
    const auto training = data_.flights_of(false), held = data_.flights_of(true);
    const auto [least, most] =
        std::ranges::minmax(training, {}, [](const RadarFlight* f) { return f->path.air.density; });
    const Eigen::Index columns = most->path.air.density - least->path.air.density > 1e-3 ? 11 : 10;
    const auto features = [columns](const RadarFlight& f) -> Eigen::RowVectorXd {
      const Launch& l = f.path.launch;
      const double v = (l.ball_speed() - 75) / 5, a = (l.launch_angle() - 0.2) / 0.05,
                   s = std::log(l.spin_rate() / 280);
      return Eigen::RowVectorXd{{1, v, a, s, v * v, a * a, s * s, v * a, v * s, a * s, f.path.air.density - 1.17}}.head(
          columns);
    };
    Eigen::MatrixXd X(training.size(), columns);
    for (std::size_t i = 0; i < training.size(); ++i) X.row(Eigen::Index(i)) = features(*training[i]);
    const auto of = [&](double RadarFlight::*seen) {
      Eigen::VectorXd y(training.size());
      for (std::size_t i = 0; i < training.size(); ++i) y[Eigen::Index(i)] = training[i]->*seen;
      const Eigen::VectorXd c = solvers::robust_regression(X, y).coefficients;
      std::vector<double> misses;
      for (std::size_t i = 0; i < held.size(); ++i)
        if (sound_[i]) misses.push_back(features(*held[i]).dot(c) - held[i]->*seen);
      return misses;
    };
    return {of(&RadarFlight::carry), of(&RadarFlight::side), of(&RadarFlight::apex), of(&RadarFlight::time)};
  }

  void judge(Output& out, const PathFit& found, const std::vector<models::MeasuredPath>& training,
             const std::vector<models::MeasuredPath>& held, nlohmann::json& summary) {
    const int groups = int(data_.groups.size());
    const std::vector<GroupWind> calm(std::size_t(groups), GroupWind::Zero());
    const std::vector<models::ShotUnknowns> none(held.size(), models::ShotUnknowns::Zero());
    // What can be reached at all: every shot with a drag, a lift and a wind of its own, whatever they are.
    std::vector<models::MeasuredPath> free = held;
    for (models::MeasuredPath& p : free) {
      p.sd[models::kOwnDrag] = p.sd[models::kOwnLift] = 0.3;
      p.sd[models::kGustAlong] = p.sd[models::kGustRight] = 10;
    }
    const PathFit best = models::fit_paths(free, groups, data_.model, found.law, {}, found.winds, true);
    sound_.clear();
    for (const double w : best.weight) sound_.push_back(w > 0.5);
    const auto lost = std::ranges::count(sound_, false);
    if (std::size_t(lost) == held.size())
      throw InputError("[paths]: no ball and wind of its own explain the path of any shot that is left out");
    out.say(
        fmt::format("\nplayers left out, computed minus radar at the height of the launch; {} of {} shots, whose "
                    "path no ball and wind of their own explain, are not counted",
                    lost, held.size()));
    post::TextTable table{.rows = {{"", "carry bias [m]", "carry rms [m]", "apex rms [m]", "time bias [s]",
                                    "time rms [s]", "side rms [m]"}},
                          .first_width = 44,
                          .least_width = 14};
    const auto row = [&](const std::string& name, const char* key, const std::string& law, const Misses& m) {
      table.rows.push_back({name, fmt::format("{:+.2f}", Misses::mean(m.carry)),
                            fmt::format("{:.2f}", Misses::rms(m.carry)), fmt::format("{:.2f}", Misses::rms(m.apex)),
                            fmt::format("{:+.3f}", Misses::mean(m.time)), fmt::format("{:.3f}", Misses::rms(m.time)),
                            fmt::format("{:.1f}", Misses::rms(m.side))});
      summary["left_out"][key][law] = to_json(m);
    };
    std::vector<FlightLaw> laws = others_;
    laws.push_back(found.law);
    for (const FlightLaw& law : laws) row("calm air, " + law.name, "calm", law.name, misses(none, calm, law));
    try {
      row("regression on the others' drives", "regression", "none", regressed());
    } catch (const solvers::NonConvergence& e) {
      out.say(fmt::format("no regression on the others' drives beside the laws: {}", e.what()));
    }
    for (const FlightLaw& law : laws) {
      const bool own = law.name == found.law.name;
      const auto winds = own ? found.winds : models::fit_paths(training, groups, data_.model, law).winds;
      row("wind of the group from others, " + law.name, "wind_of_others", law.name, misses(none, winds, law));
    }
    const PathFit shots = models::fit_paths(held, groups, data_.model, found.law, {}, found.winds);
    const Misses fitted = misses(shots.shots, shots.winds, found.law);
    row("axis, ball, wind by the path, inferred", "by_path", found.law.name, fitted);
    row("drag, lift, wind of each shot at will", "at_will", found.law.name, misses(best.shots, found.winds, found.law));
    out.show(table, "Players left out");
    out.page().answer("carry of players left out, axis, ball and wind by the path",
                      fmt::format("{:+.2f} m, rms {:.2f}", Misses::mean(fitted.carry), Misses::rms(fitted.carry)),
                      "computed minus radar");
    draw(out, found, shots, held);
  }

  void draw(Output& out, const PathFit& found, const PathFit& shots,
            const std::vector<models::MeasuredPath>& held) const {
    const auto flights = data_.flights_of(true);
    const models::ShotUnknowns none = models::ShotUnknowns::Zero();
    // Paths of a few shots, by the radar (points) and computed.
    post::Panel side{.x_label = "distance [m]", .y_label = "height [m]"},
        above{.x_label = "distance [m]", .y_label = "right of the target [m]"};
    int drawn = 0;
    for (std::size_t i = 0; i < held.size() && drawn < 5; i += std::max<std::size_t>(1, held.size() / 6)) {
      if (!sound_[i]) continue;
      ++drawn;
      post::Series radar{.label = drawn == 1 ? "radar" : "", .style = "points"},
          radar_above = radar, line{.label = drawn == 1 ? "computed" : ""}, line_above = line;
      for (const Vec3& x : held[i].positions) {
        radar.add(x.x(), x.z());
        radar_above.add(x.x(), -x.y());
      }
      const models::Flight f = models::fly(models::launched(held[i].launch, shots.shots[i]), data_.model.ball,
                                           models::conditions_of(held[i], data_.model, found.law, shots.shots[i],
                                                                 shots.winds[std::size_t(held[i].group)]),
                                           {.sample = 0.1});
      for (const models::FlightPoint& p : f.path) {
        line.add(p.position.x(), p.position.z());
        line_above.add(p.position.x(), -p.position.y());
      }
      side.series.insert(side.series.end(), {radar, line});
      above.series.insert(above.series.end(), {radar_above, line_above});
    }
    post::Figure paths{.title = "paths of players left out, by the radar (points) and computed (lines)",
                       .columns = 1,
                       .panel_width = 900,
                       .panel_height = 340};
    paths.panels = {side, above};
    out.draw(paths, "figures/paths");

    // Residual by spin ratio, and where the shots end.
    post::Panel by_spin{.title = "carry, computed minus radar, without any unknown of the shot",
                        .x_label = "spin ratio at launch [-]",
                        .y_label = "carry [m]"},
        fairway{.title = "where the drives of players left out end, at the height of their launch",
                .x_label = "right of the target [m]",
                .y_label = "distance [m]"};
    post::Series tracked{.label = "spin tracked", .style = "points"},
        estimated{.label = "spin estimated", .style = "points"}, radar{.label = "radar", .style = "points"},
        computed{.label = "computed: axis, ball, wind by the path", .style = "points"};
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (!sound_[i]) continue;
      const auto fly = [&](const models::ShotUnknowns& own, const GroupWind& wind) {
        return models::fly(models::launched(held[i].launch, own), data_.model.ball,
                           models::conditions_of(held[i], data_.model, found.law, own, wind));
      };
      const auto group = std::size_t(held[i].group);
      post::Series& of = flights[i]->spin_tracked ? tracked : estimated;
      of.add(held[i].launch.spin_rate() * data_.model.ball.radius / held[i].launch.ball_speed(),
             fly(none, found.winds[group]).carry - flights[i]->carry);
      const models::Flight f = fly(shots.shots[i], shots.winds[group]);
      const auto forward = [](double carry, double across) {
        return std::sqrt(std::max(0.0, carry * carry - across * across));
      };
      radar.add(flights[i]->side, forward(flights[i]->carry, flights[i]->side));
      computed.add(f.side, forward(f.carry, f.side));
    }
    by_spin.series = {tracked, estimated};
    fairway.series = {radar, computed};
    post::Figure residuals{.title = "players left out", .columns = 2};
    residuals.panels = {by_spin, fairway};
    out.draw(residuals, "figures/residuals");
  }

  RadarPaths data_;
  FlightLaw start_;
  std::vector<double> law_sd_;
  std::vector<FlightLaw> others_;
  std::vector<bool> sound_;  ///< of the held-out shots: some ball and wind explain the path
};

}  // namespace

std::unique_ptr<Job> read_flight_law(CaseFile& file) { return std::make_unique<FlightLawJob>(file); }

}  // namespace hosel::app
