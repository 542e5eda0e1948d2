#include "hosel/app/kinds/calibrate_ball.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hosel/app/check_memory.hpp"
#include "hosel/app/read_blow.hpp"
#include "hosel/app/read_face.hpp"
#include "hosel/app/read_shaft.hpp"
#include "hosel/app/read_solid.hpp"
#include "hosel/fem/materials/hyperelastic.hpp"
#include "hosel/models/ball_calibration.hpp"
#include "hosel/post/figure.hpp"

namespace hosel::app {
namespace {

class CalibrateBallJob final : public Job {
 public:
  explicit CalibrateBallJob(CaseFile& file) {
    Table root = file.root();
    Table ball = root.table("ball");
    ball_ = read_ball(ball);
    options_.ball = read_fe_ball(ball, models::range_ball());
    for (const models::BallLayer& layer : options_.ball.layers)
      if (!layer.material.elastic.as<fem::Hyperelastic>())
        ball.fail("layers", "calibration fits neo-hooke, mooney-rivlin and yeoh layers");
    read_shots(root);
    options_.harmonics = 0;
    if (auto mesh = root.optional_table("mesh")) {
      options_.mesh.sector = int(mesh->integer({"sector", "elements per 45 degrees of the surface before grading"}, 1,
                                               64, options_.mesh.sector));
      options_.mesh.rings =
          int(mesh->integer({"rings", "rings of elements outside the core block"}, 1, 64, options_.mesh.rings));
      options_.mesh.pole = mesh->number({"pole", "size of surface elements at the contact pole over the ungraded ones"},
                                        {0.01, 1}, options_.mesh.pole);
      options_.mesh.skin =
          mesh->number({"skin", "thickness of the outermost ring over the innermost's"}, {0.01, 1}, options_.mesh.skin);
      if (!shots_.empty()) {
        options_.harmonics =
            int(mesh->integer({"harmonics", "highest Fourier harmonic in the oblique shots"}, 2, 16, 3));
        options_.antisymmetric = int(mesh->integer(
            {"antisymmetric", "harmonics across the plane of the slip in shots without a plane of symmetry"}, 1, 16,
            options_.harmonics));
      }
    }
    check_memory(root, options_);
    if (auto time = root.optional_table("time"))
      options_.steps_per_contact =
          int(time->integer({"steps_per_contact", "time steps in a contact of Hertz's duration"}, 10, 100000,
                            options_.steps_per_contact));
    Table target = root.table("target");
    target_.speeds =
        target.quantities({"speeds", "of the normal impacts on a wall"}, "mps", 0, {1, 100}, target_.speeds);
    target_.restitution = target.number({"restitution", "of the target law at 0 m/s"}, {0, 1}, target_.restitution);
    target_.restitution_slope =
        target.quantity({"restitution_slope", "of the target law"}, "s_per_m", {-0.1, 0.1}, target_.restitution_slope);
    target_.restitution_sigma = target.number({"restitution_sigma", "standard error of the restitution wanted"},
                                              {1e-6, 1}, target_.restitution_sigma);
    target_.contact_speed = target.quantity({"contact_speed", "at which the contact time is wanted"}, "mps", {1, 100},
                                            target_.contact_speed);
    target_.contact_time = target.quantity({"contact_time", "wanted"}, "ms", Range::positive(), target_.contact_time);
    target_.contact_time_sigma = target.quantity({"contact_time_sigma", "standard error of the contact time wanted"},
                                                 "ms", Range::positive(), target_.contact_time_sigma);
    if (auto fit = root.optional_table("fit")) {
      fitted_.branch_times = !fit->flag({"hold_branch_times", "leave the branch times as they are"}, false);
      if (!shots_.empty()) {
        fitted_.cover = fit->flag({"cover", "fit a factor on the moduli of the outermost layer"}, false);
        fitted_.friction = fit->flag({"friction", "fit the friction of the shots"}, false);
        if (options_.face)
          fitted_.face = fit->flag({"face", "fit the stiffness of the clubs' face, one for all shots"}, false);
      }
    }
    if (const auto faults = options_.faults(); !faults.empty()) root.fail("ball", faults.front());
  }

  void run(Output& out) override {
    Progress progress = out.progress("calibrating");
    const models::BallCalibration fit =
        models::calibrate_ball(options_, ball_, target_, shots_, fitted_, [&](int n, double cost) {
          progress.update(std::min(0.99, n / 40.0), fmt::format("{} evaluations, cost {:.3f}", n, cost));
        });
    progress.finish();
    nlohmann::json summary{
        {"converged", fit.converged}, {"cost", fit.cost}, {"evaluations", fit.evaluations}, {"solver", fit.report}};
    for (std::size_t p = 0; p < fit.names.size(); ++p) {
      const double relative = std::sqrt(fit.covariance(Eigen::Index(p), Eigen::Index(p)));
      summary["parameters"].push_back(
          {{"name", fit.names[p]}, {"start", fit.start[p]}, {"value", fit.values[p]}, {"relative_sigma", relative}});
      out.say(fmt::format("{:<32} {:12.5g}  +- {:.1f} %", fit.names[p], fit.values[p], 100 * relative));
      // A name ends with its unit: moduli are read in MPa.
      const std::string name = fit.names[p].substr(0, fit.names[p].find(" ["));
      const bool modulus = fit.names[p].ends_with("[Pa]");
      out.page().answer(name, fmt::format("{:.4g}{}", (modulus ? 1e-6 : 1) * fit.values[p], modulus ? " MPa" : ""),
                        fmt::format("± {:.1f} %", 100 * relative));
    }
    for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i) {
      std::vector<double> row;
      for (Eigen::Index j = 0; j < fit.covariance.cols(); ++j) row.push_back(fit.covariance(i, j));
      summary["covariance_of_logarithms"].push_back(row);
    }
    out.say("speed [m/s]   target e   ball e   contact [ms]   peak [kN]");
    std::string csv = "speed_mps,target_restitution,restitution,contact_time_s,peak_force_N\n";
    post::Series wanted{.label = "target, one standard deviation"}, got{.label = "ball", .style = "points"};
    post::Series law{.label = fmt::format("{:g} {} {:g} v", target_.restitution,
                                          target_.restitution_slope < 0 ? '-' : '+',
                                          std::abs(target_.restitution_slope))};
    post::Series time_wanted{.label = "target, one standard deviation"},
        time_got{.label = "ball", .style = "linespoints"};
    post::TextTable bounce{{{"speed [m/s]", "wanted e", "e", "contact [ms]", "peak force [kN]"}}};
    for (const auto& p : fit.points) {
      bounce.rows.push_back({fmt::format("{:g}", p.speed), fmt::format("{:.4f}", p.target),
                             fmt::format("{:.4f}", p.restitution), fmt::format("{:.4f}", 1e3 * p.contact_time),
                             fmt::format("{:.2f}", 1e-3 * p.peak_force)});
      out.say(fmt::format("{:11.1f} {:10.4f} {:8.4f} {:14.4f} {:11.2f}", p.speed, p.target, p.restitution,
                          1e3 * p.contact_time, 1e-3 * p.peak_force));
      csv += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g}\n", p.speed, p.target, p.restitution, p.contact_time,
                         p.peak_force);
      summary["points"].push_back({{"speed_mps", p.speed},
                                   {"target_restitution", p.target},
                                   {"restitution", p.restitution},
                                   {"contact_time_s", p.contact_time},
                                   {"peak_force_N", p.peak_force}});
      wanted.x.push_back(p.speed);
      wanted.y.push_back(p.target);
      wanted.error.push_back(target_.restitution_sigma);
      law.x.push_back(p.speed);
      law.y.push_back(p.target);
      got.x.push_back(p.speed);
      got.y.push_back(p.restitution);
      time_got.x.push_back(p.speed);
      time_got.y.push_back(1e3 * p.contact_time);
    }
    out.page().answer(bounce);
    time_wanted.x = {target_.contact_speed};
    time_wanted.y = {1e3 * target_.contact_time};
    time_wanted.error = {1e3 * target_.contact_time_sigma};
    out.write("fit.csv", csv);
    if (!fit.shots.empty())
      out.say("shot       loft found [deg]   spin: target, ball [rpm]   speed: measured, ball [m/s]     e_t");
    for (std::size_t k = 0; k < fit.shots.size(); ++k) {
      const models::ObliquePoint& s = fit.shots[k];
      const std::optional<double>& speed = shots_[k].ball_speed;
      out.say(fmt::format("{:<10} {:16.2f} {:17.0f} {:8.0f} {:>20} {:8.2f} {:7.3f}", s.name, degrees(s.loft),
                          rpm(s.target), rpm(s.spin_rate), speed ? fmt::format("{:.2f}", *speed) : "-", s.ball_speed,
                          s.tangential_restitution));
      summary["shots"].push_back({{"name", s.name},
                                  {"dynamic_loft_deg", degrees(s.loft)},
                                  {"target_spin_rate_rpm", rpm(s.target)},
                                  {"spin_rate_rpm", rpm(s.spin_rate)},
                                  {"ball_speed_mps", s.ball_speed},
                                  {"tangential_restitution", s.tangential_restitution}});
    }
    out.write("ball.toml", ball_file(fit));
    post::Figure figure;
    figure.title = "the calibrated ball on a rigid wall";
    figure.columns = 2;
    for (const auto& [label, series] :
         {std::pair{"restitution", std::vector{wanted, got, law}}, {"contact time [ms]", {time_wanted, time_got}}}) {
      post::Panel panel;
      panel.x_label = "impact speed [m/s]";
      panel.y_label = label;
      panel.series = series;
      figure.panels.push_back(panel);
    }
    out.draw(figure, "fit");
    if (!fit.converged) out.say("the fit has not converged: " + fit.report);
    out.write_summary(summary);
  }

 private:
  /// Measured shots beside the bounce; each with its own head and delivery, all with the case's shaft where it has one.
  void read_shots(Table root) {
    const auto tables = root.tables("shots");
    if (tables.empty()) return;
    options_.friction =
        root.table("contact").number({"face_friction", "where the search begins, or what is held"}, {0, 5});
    options_.face = read_club_face(root);
    std::optional<Shaft> shaft;
    if (auto t = root.optional_table("shaft")) shaft = read_shaft(*t);
    const ClubGeometry geometry = read_club_geometry(root, false);
    for (Table t : tables) {
      models::ObliqueTarget shot{.name = t.text({"name", "of the shot or club"})};
      shot.blow.ball = ball_;
      shot.blow.delivery = read_delivery(t.table("delivery"));
      shot.blow.club.head = read_head(t.table("head"), true);
      shot.blow.club.shaft = shaft;
      shot.blow.club.geometry = geometry;
      shot.launch_angle =
          t.quantity({"launch_angle", "measured: the loft is an unknown that meets it"}, "deg", {-1.5, 1.5});
      shot.spin_rate = t.quantity({"spin_rate", "measured"}, "rpm", Range::positive());
      shot.spin_sigma = t.number({"spin_sigma", "standard error of the spin, relative"}, {1e-4, 1});
      if (t.has_quantity("ball_speed")) {
        shot.ball_speed = t.quantity({"ball_speed", "measured; absent: no target"}, "mps", Range::positive());
        shot.ball_speed_sigma =
            t.number({"ball_speed_sigma", "standard error of ball speed over club speed, relative"}, {1e-4, 1});
      }
      shots_.push_back(std::move(shot));
    }
  }

  /// The fitted layers as a case has them under [ball], with where they come from.
  std::string ball_file(const models::BallCalibration& fit) const {
    std::vector<std::string> spins, speeds;
    for (const auto& shot : shots_) {
      spins.push_back(shot.name);
      if (shot.ball_speed) speeds.push_back(shot.name);
    }
    std::string saw, not_seen = "any oblique blow, so neither friction nor a cover apart from its core";
    if (!spins.empty()) {
      saw = fmt::format("; spin of {}", fmt::join(spins, ", "));
      if (!speeds.empty()) saw += fmt::format("; ball speed of {}", fmt::join(speeds, ", "));
      not_seen = "other clubs, recorded lofts, tangential restitution, launch ratios";
    }
    std::string text = fmt::format(
        "# Saw restitution {:g} {:+g} v at {} m/s and a contact of {:g} ms at {:g} m/s on a rigid wall{}.\n"
        "# Did not see {}.\n# {}\n",
        target_.restitution, target_.restitution_slope, fmt::join(target_.speeds, ", "), 1e3 * target_.contact_time,
        target_.contact_speed, saw, not_seen, fit.report);
    for (std::size_t p = 0; p < fit.names.size(); ++p)
      text += fmt::format("# {}: {:.6g} +- {:.1f} %\n", fit.names[p], fit.values[p],
                          100 * std::sqrt(fit.covariance(Eigen::Index(p), Eigen::Index(p))));
    text += "# covariance of their logarithms:";
    for (const double c : fit.covariance.reshaped()) text += fmt::format(" {:.4g}", c);
    text += fmt::format("\n{}\n[ball]\nmass_kg = {:g}\nradius_mm = {:g}\n",
                        fitted_.branch_times ? "# branch times were fitted" : "# branch times were held", ball_.mass,
                        1e3 * ball_.radius);
    for (const models::BallLayer& layer : fit.ball.layers) {
      const auto& law = *layer.material.elastic.as<fem::Hyperelastic>();
      std::vector<double> moduli, times;
      for (const auto& b : layer.material.branches) moduli.push_back(b.modulus / 1e6), times.push_back(b.time * 1e3);
      const char* name = law.c01 != 0 ? "mooney-rivlin" : law.c20 != 0 || law.c30 != 0 ? "yeoh" : "neo-hooke";
      text += fmt::format("\n[[ball.layers]]\nradius_fraction = {}\nlaw = \"{}\"\nc10_MPa = {:.6g}\n", layer.radius,
                          name, law.c10 / 1e6);
      if (law.c01 != 0) text += fmt::format("c01_MPa = {:.6g}\n", law.c01 / 1e6);
      if (law.c20 != 0 || law.c30 != 0)
        text += fmt::format("c20_MPa = {:.6g}\nc30_MPa = {:.6g}\n", law.c20 / 1e6, law.c30 / 1e6);
      text += fmt::format(
          "bulk_MPa = {:.6g}\ndensity_kg_per_m3 = {:.6g}\nbranch_moduli_MPa = [{:.6g}]\nbranch_times_ms = [{:.6g}]\n",
          law.bulk / 1e6, layer.material.density, fmt::join(moduli, ", "), fmt::join(times, ", "));
    }
    return text;
  }

  Ball ball_;
  models::FeImpactOptions options_;
  models::NormalImpactTarget target_;
  std::vector<models::ObliqueTarget> shots_;
  models::Fitted fitted_;
};

}  // namespace

std::unique_ptr<Job> read_calibrate_ball(CaseFile& file) { return std::make_unique<CalibrateBallJob>(file); }

}  // namespace hosel::app
