#include "app/kinds/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/check_memory.hpp"
#include "app/offer.hpp"
#include "app/read_blow.hpp"
#include "app/read_face.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "app/read_solid.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "models/calibration/ball_calibration.hpp"
#include "post/digits.hpp"
#include "post/figure.hpp"
#include "post/table.hpp"

namespace hosel::app {
namespace {

class CalibrateBallJob final : public Job {
 public:
  explicit CalibrateBallJob(CaseFile& file) {
    Table root = file.root();
    Table ball = root.table("ball");
    problem_.ball = read_ball(ball);
    models::FeImpactOptions& options = problem_.options;
    options.ball = read_fe_ball(ball, models::range_ball());
    for (const models::BallLayer& layer : options.ball.layers)
      if (!layer.material.elastic.as<fem::Hyperelastic>())
        ball.fail("layers", "calibration fits neo-hooke, mooney-rivlin and yeoh layers");
    Table target = root.table("target");
    read_target(target);
    read_shots(root);
    if (problem_.bounce || !problem_.shots.empty())
      problem_.friction.coefficient =
          root.table("contact").number({"face_friction", "where the search begins, or what is held"}, {0, 5});
    options.harmonics = 0;
    Table mesh = root.default_table("mesh");
    read_mesh(mesh);
    check_memory(root, options);
    if (auto time = root.optional_table("time")) read_steps(*time, options);
    for (Table& t : root.tables("free")) problem_.free.push_back(read_free(t));
    if (problem_.free.empty()) root.fail("free", "name at least one parameter to fit: [[free]] with `what`");
    problem_.leave_one_out = root.flag(
        {"leave_one_out", "every seen shot is predicted by a fit without it, one Gauss-Newton step away"}, false);
    if (const auto faults = options.faults(); !faults.empty()) root.fail("ball", faults.front());
    if (const auto faults = problem_.faults(); !faults.empty()) root.fail("free", faults.front());
  }

  void run(Output& out) override {
    Progress progress = out.progress("calibrating");
    const models::BallCalibration fit = models::calibrate_ball(problem_, [&](int n, double cost) {
      progress.update(std::min(0.99, n / expected_blows()), fmt::format("{} blows, cost {:.3f}", n, cost));
    });
    progress.finish();
    nlohmann::json summary{
        {"converged", fit.converged}, {"cost", fit.cost}, {"blows", fit.evaluations}, {"solver", fit.report}};
    const std::size_t width = std::ranges::max(fit.names, {}, &std::string::size).size();
    for (std::size_t p = 0; p < fit.names.size(); ++p) {
      const double sd = sigma(fit, p);
      const std::string unit = additive(p) ? "" : " %";
      summary["parameters"].push_back({{"name", fit.names[p]},
                                       {"start", fit.start[p]},
                                       {"value", fit.values[p]},
                                       {additive(p) ? "sigma" : "relative_sigma", sd},
                                       {"at_bound", bool(fit.at_bound[p])}});
      out.say(fmt::format("{:<{}} {:12.5g}  +- {:.{}g}{}{}", fit.names[p], std::max<std::size_t>(32, width),
                          fit.values[p], additive(p) ? sd : 100 * sd, additive(p) ? 2 : 3, unit,
                          fit.at_bound[p] ? "  at its bound" : ""));
      // A name ends with its unit: moduli are read in MPa.
      const std::string name = fit.names[p].substr(0, fit.names[p].find(" ["));
      const bool modulus = fit.names[p].ends_with("[Pa]");
      const double shown = (modulus ? 1e-6 : 1) * fit.values[p];
      const post::Digits digits = post::digits(shown, fit.at_bound[p] ? 0 : additive(p) ? sd : sd * std::abs(shown));
      out.page().answer(name, digits.value + (modulus ? " MPa" : ""),
                        fit.at_bound[p] ? "at its bound"
                        : additive(p)   ? "± " + digits.deviation
                                        : fmt::format("± {:.1f} %", 100 * sd));
    }
    for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
      std::vector<double> row;
      for (Eigen::Index j = 0; j < fit.covariance.cols(); ++j) row.push_back(fit.covariance(i, j));
      summary["covariance"].push_back(row);
    }
    out.say("speed [m/s]   target e   ball e   contact [ms]   peak [kN]");
    post::Series wanted{.label = "target, one standard deviation"}, got{.label = "ball", .style = "points"};
    post::Series time_wanted{.label = "target, one standard deviation"},
        time_got{.label = "ball", .style = "linespoints"};
    post::Table bounce{{{"speed_mps", "{}", "speed [m/s]", "{:g}"},
                        {"target_restitution", "{:.6g}", "wanted e", "{:.4f}"},
                        {"restitution", "{:.6g}", "e", "{:.4f}"},
                        {"contact_time_s", "{:.6g}", "contact [ms]", "{:.4f}", 1e3},
                        {"peak_force_N", "{:.6g}", "peak force [kN]", "{:.2f}", 1e-3}}};
    for (const auto& p : fit.points) {
      bounce.add(p.speed, p.target, p.restitution, p.contact_time, p.peak_force);
      out.say(fmt::format("{:11.1f} {:10.4f} {:8.4f} {:14.4f} {:11.2f}", p.speed, p.target, p.restitution,
                          1e3 * p.contact_time, 1e-3 * p.peak_force));
      wanted.add(p.speed, p.target);
      wanted.error.push_back(problem_.wall.restitution_sigma);
      got.add(p.speed, p.restitution);
      time_got.add(p.speed, 1e3 * p.contact_time);
    }
    out.page().answer(bounce.shown());
    for (const auto& p : fit.points)
      if (p.speed == problem_.wall.contact_speed)
        out.say(fmt::format("contact at {:g} m/s: {:.4f} ms, wanted {:g} +- {:g}", p.speed, 1e3 * p.contact_time,
                            1e3 * problem_.wall.contact_time, 1e3 * problem_.wall.contact_time_sigma));
    summary["points"] = bounce.json();
    time_wanted.x = {problem_.wall.contact_speed};
    time_wanted.y = {1e3 * problem_.wall.contact_time};
    time_wanted.error = {1e3 * problem_.wall.contact_time_sigma};
    out.write("fit.csv", bounce.csv());
    if (fit.bounce) {
      out.say(fmt::format("thrown at a plate at {:g} m/s, {:g} deg from the normal: e_t {:.3f}, wanted {:g} +- {:g}",
                          problem_.bounce->speed, degrees(problem_.bounce->angle), *fit.bounce,
                          problem_.bounce->tangential_restitution, problem_.bounce->sigma));
      summary["bounce"] = {{"tangential_restitution", *fit.bounce}};
    }
    if (!fit.shots.empty()) report_shots(out, fit, summary);
    out.write("ball.toml", ball_file(fit));
    post::Figure figure;
    figure.title = "the calibrated ball on a rigid wall";
    figure.columns = 2;
    for (const auto& [label, series] :
         {std::pair{"restitution", std::vector{wanted, got}}, {"contact time [ms]", {time_wanted, time_got}}}) {
      post::Panel panel;
      panel.x_label = "impact speed [m/s]";
      panel.y_label = label;
      panel.series = series;
      figure.panels.push_back(panel);
    }
    out.draw(figure, "fit");
    if (!fit.shots.empty()) out.draw(shot_figure(fit), "shots");
    withdraw_offers(out);
    std::vector<std::string> doubts = doubts_of(fit);
    if (!fit.converged) doubts.insert(doubts.begin(), "the fit has not converged: " + fit.report);
    for (const std::string& doubt : doubts) out.warn(doubt);
    if (doubts.empty()) offer_found(out, fit);
    else out.say("nothing is offered to the library: see the warnings");
    out.write_summary(summary);
  }

 private:
  using What = models::FreeParameter::What;
  using Points = std::vector<models::ObliquePoint>;

  /// A parameter that the search held back, and a target that the ball misses.
  std::vector<std::string> doubts_of(const models::BallCalibration& fit) const {
    constexpr double most = 3;  // standard deviations
    std::vector<std::string> out;
    for (std::size_t p = 0; p < fit.names.size(); ++p)
      if (fit.at_bound[p])
        out.push_back(
            fmt::format("{} is at its bound, {:.4g}: the search goes no further", fit.names[p], fit.values[p]));
    const auto target = [&](const std::string& name, double wanted, double got, double sigma, std::string_view unit) {
      if (const double off = std::abs(got - wanted) / sigma; off > most)
        out.push_back(fmt::format("{}: wanted {:.4g}{}, got {:.4g}{}, {:.1f} standard deviations off", name, wanted,
                                  unit, got, unit, off));
    };
    const models::NormalImpactTarget& wall = problem_.wall;
    for (const models::NormalImpactPoint& p : fit.points) {
      target(fmt::format("restitution at {:g} m/s", p.speed), p.target, p.restitution, wall.restitution_sigma, "");
      if (p.speed == wall.contact_speed)
        target(fmt::format("contact time at {:g} m/s", p.speed), 1e3 * wall.contact_time, 1e3 * p.contact_time,
               1e3 * wall.contact_time_sigma, " ms");
    }
    if (fit.bounce)
      target("tangential restitution off the plate", problem_.bounce->tangential_restitution, *fit.bounce,
             problem_.bounce->sigma, "");
    // Of many shots a few are far off: they are judged together.
    double square = 0, worst = 0;
    std::size_t count = 0;
    std::string named;
    for (const models::ObliquePoint& p : fit.shots) {
      if (!p.seen) continue;
      const models::ObliqueTarget& t = target_of(p);
      const auto shot = [&](std::string_view what, double deviation) {
        square += deviation * deviation;
        ++count;
        if (std::abs(deviation) <= worst) return;
        worst = std::abs(deviation);
        named = fmt::format("{} of {}", what, p.name);
      };
      shot("spin", off(p.spin_rate, t.spin_rate) / (100 * t.spin_sigma));
      if (t.ball_speed) shot("ball speed", off(p.ball_speed, *t.ball_speed) / (100 * t.ball_speed_sigma));
    }
    if (const double rms = std::sqrt(square / double(std::max<std::size_t>(count, 1))); rms > most)
      out.push_back(fmt::format("the shots are missed by {:.1f} of their standard deviations (rms), the {} by {:.1f}",
                                rms, named, worst));
    return out;
  }

  /// The ball, and the friction that was fitted with it. Faces, strikes and heads are the clubs' own.
  void offer_found(Output& out, const models::BallCalibration& fit) const {
    const models::NormalImpactTarget& wall = problem_.wall;
    Offer o{
        .what = fmt::format("a ball of {} layer{} by its bounce{}", fit.ball.layers.size(),
                            fit.ball.layers.size() == 1 ? "" : "s", problem_.shots.empty() ? "" : " and oblique blows"),
        .source = fmt::format("restitution at {} speeds and a contact of {:g} ms at {:g} m/s on a wall",
                              wall.speeds.size(), 1e3 * wall.contact_time, wall.contact_speed),
        .parameters = fit.names,
        .values = fit.values,
        .covariance = fit.covariance};
    for (std::size_t p = 0; p < fit.names.size(); ++p) {
      o.of.emplace_back(additive(p) ? "value" : "logarithm");
      if (!additive(p)) continue;
      o.covariance.row(Eigen::Index(p)) *= 0.01;
      o.covariance.col(Eigen::Index(p)) *= 0.01;
    }
    Use use{{std::ranges::min(wall.speeds), std::ranges::max(wall.speeds)}, {0, 0}};
    bool oblique = problem_.bounce.has_value();
    if (oblique) use.spin_loft.high = problem_.bounce->angle;
    for (const models::ObliquePoint& found : fit.shots) {
      if (!found.seen) continue;
      oblique = true;
      Blow blow = target_of(found).blow;
      blow.delivery.dynamic_loft = found.loft;  // the target's is where the search began
      use = both(use, use_of(blow));
      o.seen.clubs.push_back(found.name);
    }
    o.seen.impact_speed = use.impact_speed;
    if (oblique) o.seen.spin_loft = use.spin_loft;
    else o.seen.not_for.emplace_back("a claim about spin: no oblique blow was seen");
    offer(out, Shelf::balls, o, ball_tables(problem_.ball, fit.ball));
    if (std::ranges::any_of(problem_.free, [](const auto& p) { return p.what == What::friction; })) {
      NamedContact contact;
      contact.face_friction = fit.friction;
      offer(out, Shelf::contacts, o, contact_tables(contact));
    }
  }

  void read_target(Table& target) {
    models::NormalImpactTarget& wall = problem_.wall;
    wall.speeds = target.quantities({"speeds", "of the normal impacts on a wall"}, "mps", 0, {1, 100}, wall.speeds);
    if (wall.speeds.empty()) target.fail("speeds", "name at least one speed");
    if (target.has("restitutions")) {
      wall.restitutions =
          target.numbers({"restitutions", "one for each speed, in place of a law"}, wall.speeds.size(), {0, 1});
    } else {
      wall.restitution = target.number({"restitution", "of the target law at 0 m/s"}, {0, 1}, wall.restitution);
      wall.restitution_slope =
          target.quantity({"restitution_slope", "of the target law"}, "s_per_m", {-0.1, 0.1}, wall.restitution_slope);
    }
    wall.restitution_sigma = target.number({"restitution_sigma", "standard error of the restitution wanted"}, {1e-6, 1},
                                           wall.restitution_sigma);
    wall.contact_speed =
        target.quantity({"contact_speed", "at which the contact time is wanted"}, "mps", {1, 100}, wall.contact_speed);
    if (std::ranges::find(wall.speeds, wall.contact_speed) == wall.speeds.end())
      target.fail(target.has_quantity("contact_speed") ? "contact_speed" : "speeds",
                  fmt::format("the contact time is wanted at {:g} m/s, which is none of the speeds ({:g} m/s)",
                              wall.contact_speed, fmt::join(wall.speeds, ", ")));
    wall.contact_time = target.quantity({"contact_time", "wanted"}, "ms", Range::positive(), wall.contact_time);
    wall.contact_time_sigma = target.quantity({"contact_time_sigma", "standard error of the contact time wanted"}, "ms",
                                              Range::positive(), wall.contact_time_sigma);
    if (auto t = target.optional_table("bounce"))
      problem_.bounce = {
          .speed = t->quantity({"speed", "at which the ball is thrown at a rigid plate"}, "mps", {1, 100}),
          .angle = t->quantity({"angle", "from the plate's normal"}, "deg", {radians(0.5), radians(86)}),
          .tangential_restitution = t->number({"tangential_restitution", "wanted"}, {-1, 1}),
          .sigma = t->number({"sigma", "standard error of the tangential restitution wanted"}, {1e-4, 1})};
  }

  void read_mesh(Table& mesh) {
    models::FeImpactOptions& o = problem_.options;
    read_ball_mesh(mesh, o.mesh);
    if (problem_.shots.empty() && !problem_.bounce) return;
    o.harmonics = int(mesh.integer({"harmonics", "highest Fourier harmonic in the oblique shots"}, 2, 16, 3));
    o.antisymmetric = int(
        mesh.integer({"antisymmetric", "harmonics across the plane of the slip in shots without a plane of symmetry"},
                     1, 16, o.harmonics));
  }

  /// Measured shots beside the bounce; each with its own head and delivery, and with the case's face, shaft and hosel
  /// where it has none of its own.
  void read_shots(Table root) {
    const auto tables = root.tables("shots");
    if (tables.empty()) return;
    const std::optional<FaceCompliance> face = read_club_face(root);
    std::optional<Shaft> shaft;
    if (auto t = root.optional_table("shaft")) shaft = read_shaft(*t);
    const ClubGeometry geometry = read_club_geometry(root, false);
    std::vector<std::string> taken;
    for (Table t : tables) {
      models::ObliqueTarget shot{.name = t.name({"name", "of the shot or club"}, taken)};
      groups_.push_back(t.text({"group", "of shots whose errors are summed up together"}, ""));
      shot.seen = t.flag({"seen", "false: predicted, not fitted"}, true);
      shot.blow.ball = problem_.ball;
      shot.blow.delivery = read_delivery(t.table("delivery"));
      shot.blow.club.head = read_head(t.table("head"), true);
      const bool own_head = t.table("head").has("name");
      shot.blow.club.head.compliance = own_head || t.has("face") ? read_club_face(t) : face;
      auto own_shaft = t.optional_table("shaft");
      shot.blow.club.shaft = own_shaft ? std::optional(read_shaft(*own_shaft)) : shaft;
      shot.blow.club.geometry = own_head || t.has("hosel") ? read_club_geometry(t, false) : geometry;
      shot.launch_angle = t.quantity({"launch_angle", "measured: the loft is an unknown that meets it"}, "deg",
                                     {-radians(86), radians(86)});
      shot.spin_rate = t.quantity({"spin_rate", "measured"}, "rpm", Range::positive());
      shot.spin_sigma = t.number({"spin_sigma", "standard error of the spin, relative"}, {1e-4, 1});
      if (t.has_quantity("ball_speed")) {
        shot.ball_speed = t.quantity({"ball_speed", "measured; absent: no target"}, "mps", Range::positive());
        shot.ball_speed_sigma =
            t.number({"ball_speed_sigma", "standard error of ball speed over club speed, relative"}, {1e-4, 1});
      }
      problem_.shots.push_back(std::move(shot));
    }
  }

  models::FreeParameter read_free(Table& t) {
    models::FreeParameter p{.what = t.one_of<What>({"what", "is fitted"}, {{"long-term-moduli", What::long_term},
                                                                           {"branch-moduli", What::branches},
                                                                           {"branch-times", What::branch_times},
                                                                           {"layer-moduli", What::layer},
                                                                           {"friction", What::friction},
                                                                           {"face-stiffness", What::face_stiffness},
                                                                           {"impact-high", What::impact_high},
                                                                           {"head-mass", What::head_mass}})};
    t.decided_by("ball.layers");
    if (p.what == What::layer)
      p.layer = std::size_t(t.integer({"layer", "counted from the inside, from 1"}, 1,
                                      long(problem_.options.ball.layers.size()))) -
                1;
    if (p.of_shots())
      for (const std::string& name : t.texts({"shots", "whose face, strike or head it is"})) {
        const auto it = std::ranges::find(problem_.shots, name, &models::ObliqueTarget::name);
        if (it == problem_.shots.end()) t.fail("shots", fmt::format("no shot '{}'", name));
        p.shots.push_back(std::size_t(it - problem_.shots.begin()));
      }
    // The prior, in the parameter's own unit: an offset, or the logarithm of a factor.
    const double inf = INFINITY, end = 0.01 * models::FreeParameter::kReach;
    const Range reach = Range{-end, end}.because("the search goes no further");
    if (p.what == What::impact_high) {
      p.prior = 100 * t.quantity({"offset", "expected, up the face"}, "mm", reach, 0);
      p.sd = 100 * t.quantity({"sd", "of that expectation; inf: nothing is expected"}, "mm", {1e-6, inf}, inf);
    } else if (p.what == What::head_mass) {
      p.prior = 100 * t.quantity({"offset", "expected"}, "kg", reach, 0);
      p.sd = 100 * t.quantity({"sd", "of that expectation; inf: nothing is expected"}, "kg", {1e-6, inf}, inf);
    } else {
      p.prior = std::log(t.number({"factor", "expected"}, {0.05, 20}, 1.0));
      p.sd = t.number({"sd", "of the factor's logarithm; inf: nothing is expected"}, {1e-6, inf}, inf);
    }
    return p;
  }

  bool additive(std::size_t p) const {
    return problem_.free[p].what == What::impact_high || problem_.free[p].what == What::head_mass;
  }
  /// Relative, or of an additive parameter in its unit.
  double sigma(const models::BallCalibration& fit, std::size_t p) const {
    return std::sqrt(fit.covariance(Eigen::Index(p), Eigen::Index(p))) * (additive(p) ? 0.01 : 1);
  }
  /// Blows of some six iterations: values (three blows a shot) and derivatives.
  double expected_blows() const {
    const auto n = double(problem_.free.size()), wall = double(problem_.wall.speeds.size()) + 1;
    return 6 * (wall * (n + 1) + double(problem_.shots.size()) * (n + 4)) + 1;
  }

  const models::ObliqueTarget& target_of(const models::ObliquePoint& p) const {
    return *std::ranges::find(problem_.shots, p.name, &models::ObliqueTarget::name);
  }

  void report_shots(Output& out, const models::BallCalibration& fit, nlohmann::json& summary) const {
    std::size_t width = 5;
    for (const auto& shot : problem_.shots) width = std::max(width, shot.name.size() + 1);
    post::Table shots{{{"fit", "{}", "fit"},
                       {"name", "{}", "shot"},
                       {"group"},
                       {"dynamic_loft_deg", "{:.6g}", "loft [deg]", "{:.2f}"},
                       {"spin_rate_rpm", "{:.6g}", "spin [rpm]", "{:.0f}"},
                       {"spin_off_percent", "{:.4g}", "off [%]", "{:+.1f}"},
                       {"ball_speed_mps", "{:.6g}", "ball speed [m/s]", "{:.2f}"},
                       {"ball_speed_off_percent", "{:.4g}", "off [%]", "{:+.2f}"},
                       {"tangential_restitution", "{:.4g}", "e_t", "{:.3f}"},
                       {"launch_ratio", "{:.4g}", "launch ratio", "{:.3f}"}}};
    const auto rows = [&](const std::string& title, const Points& points) {
      if (points.empty()) return;
      out.say(fmt::format("{:<{}} {:>7} {:>9} {:>7} {:>7} {:>8} {:>7} {:>7} {:>6}", title, width, "loft", "measured",
                          "spin", "off [%]", "speed", "off [%]", "e_t", "ratio"));
      for (const models::ObliquePoint& p : points) {
        const models::ObliqueTarget& t = target_of(p);
        const double spin = off(p.spin_rate, t.spin_rate);
        const auto fast = t.ball_speed ? std::optional(off(p.ball_speed, *t.ball_speed)) : std::nullopt;
        const std::string speed = fast ? fmt::format("{:+.2f}", *fast) : "-";
        out.say(fmt::format("{:<{}} {:7.2f} {:9.0f} {:7.0f} {:+7.1f} {:8.2f} {:>7} {:7.3f} {:6.3f}", p.name, width,
                            degrees(p.loft), rpm(t.spin_rate), rpm(p.spin_rate), spin, p.ball_speed, speed,
                            p.tangential_restitution, p.launch_ratio));
        shots.add(title, p.name, group_of(p), degrees(p.loft), rpm(p.spin_rate), spin, p.ball_speed, fast,
                  p.tangential_restitution, p.launch_ratio);
        summary["shots"].push_back({{"fit", title},
                                    {"name", p.name},
                                    {"dynamic_loft_deg", degrees(p.loft)},
                                    {"target_spin_rate_rpm", rpm(p.spin_rate / (1 + spin / 100))},
                                    {"spin_rate_rpm", rpm(p.spin_rate)},
                                    {"ball_speed_mps", p.ball_speed},
                                    {"tangential_restitution", p.tangential_restitution},
                                    {"launch_ratio", p.launch_ratio}});
      }
      sum_up(out, title, points, summary);
    };
    Points seen, unseen;
    for (const auto& p : fit.shots) (p.seen ? seen : unseen).push_back(p);
    rows("seen", seen);
    rows("left out", fit.left_out);
    rows("not seen", unseen);
    for (std::size_t k = 0, row = 0; k < problem_.shots.size() && !fit.left_out.empty(); ++k) {
      if (!problem_.shots[k].seen) continue;
      for (std::size_t c = 0; c < problem_.free.size(); ++c)
        if (const auto& p = problem_.free[c]; p.of_shots() && p.shots.front() == k && additive(c))
          out.say(fmt::format("{} without {}: {:.3g}", fit.names[c], problem_.shots[k].name,
                              0.01 * fit.left_out_values[row][c]));
      ++row;
    }
    out.page().answer(shots.shown());
    out.write("shots.csv", shots.csv());
  }

  /// Root of the mean square of the errors of every group that has a name.
  void sum_up(Output& out, const std::string& title, const Points& points, nlohmann::json& summary) const {
    std::vector<std::string> names;
    for (const auto& p : points)
      if (!group_of(p).empty() && std::ranges::find(names, group_of(p)) == names.end()) names.push_back(group_of(p));
    for (const std::string& name : names) {
      double spin = 0, speed = 0, worst = 0;
      int n = 0, speeds = 0;
      for (const auto& p : points) {
        if (group_of(p) != name) continue;
        const models::ObliqueTarget& t = target_of(p);
        ++n;
        spin += std::pow(off(p.spin_rate, t.spin_rate), 2);
        if (!t.ball_speed) continue;
        const double s = off(p.ball_speed, *t.ball_speed);
        ++speeds;
        speed += s * s;
        worst = std::max(worst, std::abs(s));
      }
      std::string line = fmt::format("{}, {}: spin {:.2f} % rms", title, name, std::sqrt(spin / n));
      summary["rms"][title][name]["spin_percent"] = std::sqrt(spin / n);
      if (speeds > 0) {
        line += fmt::format(", ball speed {:.2f} % rms, {:.2f} % at most", std::sqrt(speed / speeds), worst);
        summary["rms"][title][name]["ball_speed_percent"] = std::sqrt(speed / speeds);
        summary["rms"][title][name]["ball_speed_worst_percent"] = worst;
      }
      out.say(line);
    }
  }

  static double off(double value, double measured) { return 100 * (value / measured - 1); }
  const std::string& group_of(const models::ObliquePoint& p) const {
    return groups_[std::size_t(&target_of(p) - problem_.shots.data())];
  }

  post::Figure shot_figure(const models::BallCalibration& fit) const {
    post::Figure f{.title = "measured shots at their launch angle",
                   .columns = 2,
                   .panel_width = 560,
                   .panel_height = 130 + 22 * int(problem_.shots.size())};
    post::Panel spin{.x_label = "spin, off by [%]"}, speed{.x_label = "ball speed, off by [%]"};
    for (const auto& shot : problem_.shots) spin.y_names.push_back(shot.name);
    speed.y_names = spin.y_names;
    const auto add = [&](const std::string& label, const Points& points, bool seen) {
      post::Series a{.label = label, .style = "points"}, b{.label = label, .style = "points"};
      for (const auto& p : points) {
        if (p.seen != seen) continue;
        const models::ObliqueTarget& t = target_of(p);
        const double y = -double(&t - problem_.shots.data());
        a.add(off(p.spin_rate, t.spin_rate), y);
        if (t.ball_speed) b.add(off(p.ball_speed, *t.ball_speed), y);
      }
      if (a.x.empty()) return;
      spin.series.push_back(a);
      if (!b.x.empty()) speed.series.push_back(b);
    };
    add("seen by the fit", fit.shots, true);
    add("left out of the fit", fit.left_out, true);
    add("never seen", fit.shots, false);
    f.panels = {spin, speed};
    return f;
  }

  /// The fitted layers as a case has them under [ball], with where they come from.
  std::string ball_file(const models::BallCalibration& fit) const {
    std::vector<std::string> spins, speeds;
    for (const auto& shot : problem_.shots) {
      if (!shot.seen) continue;
      spins.push_back(shot.name);
      if (shot.ball_speed) speeds.push_back(shot.name);
    }
    std::string saw, not_seen = "any oblique blow, so neither friction nor a cover apart from its core";
    if (!spins.empty()) {
      saw = fmt::format("; spin of {}", fmt::join(spins, ", "));
      if (!speeds.empty()) saw += fmt::format("; ball speed of {}", fmt::join(speeds, ", "));
      not_seen = problem_.bounce ? "other clubs, recorded lofts, launch ratios"
                                 : "other clubs, recorded lofts, tangential restitution, launch ratios";
    }
    if (problem_.bounce)
      saw += fmt::format("; e_t of {:g} +- {:g} off a plate at {:g} deg", problem_.bounce->tangential_restitution,
                         problem_.bounce->sigma, degrees(problem_.bounce->angle));
    std::vector<double> wanted;
    for (std::size_t k = 0; k < problem_.wall.speeds.size(); ++k) wanted.push_back(problem_.wall.wanted(k));
    std::string text = fmt::format(
        "# Saw restitutions {:.4g} at {} m/s and a contact of {:g} ms at {:g} m/s on a rigid wall{}.\n"
        "# Did not see {}.\n# {}\n",
        fmt::join(wanted, ", "), fmt::join(problem_.wall.speeds, ", "), 1e3 * problem_.wall.contact_time,
        problem_.wall.contact_speed, saw, not_seen, fit.report);
    for (std::size_t p = 0; p < fit.names.size(); ++p)
      text += additive(p) ? fmt::format("# {}: {:.6g} +- {:.2g}\n", fit.names[p], fit.values[p], sigma(fit, p))
                          : fmt::format("# {}: {:.6g} +- {:.1f} %\n", fit.names[p], fit.values[p], 100 * sigma(fit, p));
    text += "# covariance (logarithms of factors; strikes in cm, masses in 10 g):";
    for (const double c : fit.covariance.reshaped()) text += fmt::format(" {:.4g}", c);
    return text + "\n" + ball_tables(problem_.ball, fit.ball);
  }

  models::BallCalibrationProblem problem_;
  std::vector<std::string> groups_;  // of the shots
};

}  // namespace

std::unique_ptr<Job> read_calibrate_ball(CaseFile& file) { return std::make_unique<CalibrateBallJob>(file); }

}  // namespace hosel::app
