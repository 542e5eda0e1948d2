#include "app/kinds/variants.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/check_memory.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "golf/parallel.hpp"
#include "models/calibration/ball_calibration.hpp"
#include "models/checked_launch.hpp"
#include "models/matched_launch.hpp"
#include "models/oblique.hpp"
#include "models/registry.hpp"
#include "post/csv.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
namespace {

/// What an instrument saw of the blow; absent where it did not look.
struct Observed {
  std::optional<double> spin_rate, ball_speed, launch_angle;  ///< SI
  std::vector<double> launch_ratio;                           ///< of each instrument
};

struct Variant {
  std::string name, range;  ///< range: how far the lever goes, in words
  std::vector<std::string> set;
  std::string model;
  Blow blow;
  models::Options options;
  std::optional<FlightSetup> flight;
  Observed seen;
};

struct Prediction {
  std::string error;
  double elastic = 1, viscous = 1;  ///< factors on the moduli that keep the bounce
  double normal_restitution = NAN, contact_time = NAN;
  double loft = NAN;
  Launch launch;
  double e_t = NAN, ratio = NAN;
  std::optional<post::ShotFlight> flight;
};

class VariantsJob final : public Job {
 public:
  explicit VariantsJob(CaseFile& file) {
    const BlowsBeside beside;
    const std::vector<Variant> first = read(file.root());
    for (std::size_t i = 0; i < first.size(); ++i) {
      std::vector<std::string> overrides = first[i].set;  // the command line has the last word
      overrides.insert(overrides.end(), file.overrides().begin(), file.overrides().end());
      CaseFile own(file, overrides);
      std::vector<Variant> again = read(own.root());
      if (again.size() != first.size()) own.root().fail("variants", "a variant may not change the list of variants");
      variants_.push_back(std::move(again[i]));
      own.root().text({"kind", "what the case does (`hosel list`)"});
      own.root().text({"title", "of tables, pages and figures"}, "");
      own.finish();
    }
  }

  void run(Output& out) override {
    std::vector<Prediction> answers(variants_.size());
    answers.front() = answer(variants_.front(), nullptr);
    if (!answers.front().error.empty())
      throw InputError(fmt::format("{}: {}", variants_.front().name, answers.front().error));
    Progress progress = out.progress("variants");
    std::atomic<std::size_t> done = 1;
    for_all(std::size_t{1}, variants_.size(), [&](std::size_t i) {
      answers[i] = answer(variants_[i], &answers.front());
      progress.update(double(++done) / double(variants_.size()), variants_[i].name);
    });
    progress.finish();
    report(out, answers);
  }

 private:
  std::vector<Variant> read(Table root) {
    const std::vector<std::string> names = read_models(root);
    Variant base{.model = names.front()};
    if (names.size() > 1) root.fail("models", "variants of one model are compared");
    base.blow = read_blow(root, names);
    base.options = read_options(root, names);
    base.flight = read_optional_flight(root);
    if (auto t = root.optional_table("measured")) base.seen = read_seen(*t);
    matched_ = root.flag({"matched_launch", "turn the loft until the launch angle is the measured one"}, false);
    if (root.has_quantity("keep_bounce"))
      bounce_speed_ = root.quantity(
          {"keep_bounce",
           "turn the inner layers' loss until the ball bounces at this speed as the first variant's does"},
          "mps", {1, 100});
    std::vector<Variant> out;
    std::vector<std::string> taken;
    for (Table t : root.tables("variants")) {
      Variant v = base;
      v.name = t.name({"name", "of the variant"}, taken);
      v.range = t.text({"range", "where its figures come from"}, "");
      v.set = t.texts({"set", "keys that the variant changes, table.key=value"}, std::vector<std::string>{});
      if (auto own = t.optional_table("measured")) v.seen = read_seen(*own);
      if (matched_ && !v.seen.launch_angle) t.fail("", "matched_launch needs a measured launch angle");
      out.push_back(std::move(v));
    }
    constexpr std::size_t most = 1000;  // each is read once for every one
    if (out.size() > most) root.fail("variants", fmt::format("more than {}: sweep a key instead", most));
    if (out.empty())
      root.fail("variants", "name at least one [[variants]]; the first is what the others are compared with");
    return out;
  }
  static Observed read_seen(Table t) {
    Observed s;
    if (t.has_quantity("spin_rate")) s.spin_rate = t.quantity({"spin_rate", "measured"}, "rpm", Range::positive());
    if (t.has_quantity("ball_speed")) s.ball_speed = t.quantity({"ball_speed", "measured"}, "mps", Range::positive());
    if (t.has_quantity("launch_angle")) s.launch_angle = t.quantity({"launch_angle", "measured"}, "deg", {-1.5, 1.5});
    s.launch_ratio =
        t.numbers({"launch_ratio", "lowest and highest measured launch ratio"}, 0, {-1, 2}, std::vector<double>{});
    return s;
  }

  Prediction answer(const Variant& v, const Prediction* reference) const {
    Prediction a;
    try {
      models::Options options = v.options;
      if (bounce_speed_) keep_bounce(options.fe, v.blow.ball, reference, a);
      const auto model = models::find(v.model)->make(options);
      Blow blow = v.blow;
      if (matched_) {
        auto found = models::match_launch_angle(*model, blow, *v.seen.launch_angle, radians(0.03));
        blow = std::move(found.blow);
        a.launch = found.launch;
      } else {
        a.launch = models::checked_launch(*model, blow);
      }
      a.loft = blow.delivery.dynamic_loft;
      a.e_t = models::tangential_restitution(blow, a.launch).value_or(NAN);
      a.ratio = models::launch_ratio(blow, a.launch).value_or(NAN);
      if (v.flight) a.flight = v.flight->follow(a.launch, blow.ball);
    } catch (const std::exception& e) { a.error = e.what(); }
    return a;
  }

  /// A lever that changes the ball's bounce would be judged by that: moduli and branches are scaled until restitution
  /// and contact time on a wall are the first variant's again.
  void keep_bounce(models::FeImpactOptions& fe, const Ball& ball, const Prediction* reference, Prediction& a) const {
    models::FeImpactOptions axial = fe;
    axial.harmonics = 0;
    axial.face.reset();  // of the club: the wall is rigid
    const models::NormalImpactPoint own = models::normal_impact(axial, ball, *bounce_speed_);
    a.normal_restitution = own.restitution;
    a.contact_time = own.contact_time;
    if (!reference) return;
    const bool same = std::abs(own.restitution - reference->normal_restitution) < 5e-4 &&
                      std::abs(own.contact_time / reference->contact_time - 1) < 2e-3;
    if (same) return;
    const models::NormalImpactTarget target{.speeds = {*bounce_speed_},
                                            .restitution = reference->normal_restitution,
                                            .restitution_slope = 0,
                                            .restitution_sigma = 5e-4,
                                            .contact_speed = *bounce_speed_,
                                            .contact_time = reference->contact_time,
                                            .contact_time_sigma = 2e-3 * reference->contact_time};
    using What = models::FreeParameter::What;
    const models::BallCalibration fit = models::calibrate_ball(
        {.options = axial, .ball = ball, .wall = target, .free = {{What::long_term}, {What::branches}}});
    fe.ball = fit.ball;
    a.elastic = fit.values[0] / fit.start[0];
    a.viscous = fit.values[1] / fit.start[1];
    a.normal_restitution = fit.points.front().restitution;
    a.contact_time = fit.points.front().contact_time;
  }

  void report(Output& out, const std::vector<Prediction>& answers) const {
    std::size_t width = 8;
    for (const Variant& v : variants_) width = std::max(width, v.name.size() + 1);
    post::TextTable table{.rows = {{"variant", "loft", "launch", "speed", "off [%]", "spin", "off [%]", "e_t", "ratio",
                                    "measured ratios"}},
                          .first_width = width,
                          .least_width = 9,
                          .even = false};
    std::string csv =
        "variant,dynamic_loft_deg,launch_angle_deg,ball_speed_mps,spin_rate_rpm,tangential_restitution,"
        "launch_ratio,contact_ms,normal_restitution,contact_time_ms,elastic_factor,viscous_factor,range,error\n";
    nlohmann::json summary;
    std::vector<post::LaunchColumn> flights;
    for (std::size_t i = 0; i < variants_.size(); ++i) {
      const Variant& v = variants_[i];
      const Prediction& a = answers[i];
      if (!a.error.empty()) {
        out.say(fmt::format("{:<{}} {}", v.name, width, a.error));
        csv += fmt::format("{},,,,,,,,,,,,,{}\n", post::csv_cell(v.name), post::csv_cell(a.error));
        summary["variants"][v.name] = {{"error", a.error}};
        continue;
      }
      const auto off = [](double value, const std::optional<double>& seen) {
        return seen ? fmt::format("{:+.2f}", 100 * (value / *seen - 1)) : std::string("-");
      };
      const double speed = a.launch.ball_speed(), spin = a.launch.spin_rate();
      std::string ratios;
      for (const double r : v.seen.launch_ratio) ratios += fmt::format("{:g} ", r);
      table.rows.push_back(
          {v.name, fmt::format("{:.2f}", degrees(a.loft)), fmt::format("{:.2f}", degrees(a.launch.launch_angle())),
           fmt::format("{:.2f}", speed), off(speed, v.seen.ball_speed), fmt::format("{:.0f}", rpm(spin)),
           off(spin, v.seen.spin_rate), fmt::format("{:.3f}", a.e_t), fmt::format("{:.3f}", a.ratio), ratios});
      csv += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},\n",
                         post::csv_cell(v.name), degrees(a.loft), degrees(a.launch.launch_angle()), speed, rpm(spin),
                         a.e_t, a.ratio, 1e3 * a.launch.contact_time.value_or(NAN), a.normal_restitution,
                         1e3 * a.contact_time, a.elastic, a.viscous, post::csv_cell(v.range));
      summary["variants"][v.name] = {{"dynamic_loft_deg", degrees(a.loft)},
                                     {"launch_angle_deg", degrees(a.launch.launch_angle())},
                                     {"ball_speed_mps", speed},
                                     {"spin_rate_rpm", rpm(spin)},
                                     {"tangential_restitution", a.e_t},
                                     {"launch_ratio", a.ratio}};
      if (a.launch.contact_time) summary["variants"][v.name]["contact_ms"] = 1e3 * *a.launch.contact_time;
      if (a.flight) {
        flights.push_back({.title = v.name, .launch = a.launch, .flight = a.flight});
        summary["variants"][v.name]["flight"] = post::to_json(*a.flight);
      }
    }
    out.tell("");
    out.show(table);
    if (!flights.empty()) {
      out.tell("");
      out.show(post::launch_table(flights, {}, {}, out.units()));
    }
    out.draw(figure(answers), "variants");
    out.write("variants.csv", csv);
    out.write_summary(summary);
  }

  /// Spin and speed of every variant, and launch ratio, beside what was measured.
  post::Figure figure(const std::vector<Prediction>& answers) const {
    std::size_t widest = 0;
    for (const Variant& v : variants_) widest = std::max(widest, v.name.size());
    post::Figure f{
        .columns = 3, .panel_width = 400 + 8 * int(widest), .panel_height = 130 + 22 * int(variants_.size())};
    const auto panel = [&](std::string label, auto value, auto seen) {
      post::Panel p{.x_label = std::move(label)};
      post::Series model{.label = "model", .style = "points"}, measured{.label = "measured", .style = "points"};
      for (std::size_t i = 0; i < variants_.size(); ++i) {
        p.y_names.push_back(variants_[i].name);
        if (answers[i].error.empty()) model.x.push_back(value(answers[i])), model.y.push_back(-double(i));
        for (const double x : seen(variants_[i].seen)) measured.x.push_back(x), measured.y.push_back(-double(i));
      }
      p.series = {std::move(model), std::move(measured)};
      f.panels.push_back(std::move(p));
    };
    const auto list = [](const std::optional<double>& x, double unit) {
      return x ? std::vector<double>{*x / unit} : std::vector<double>{};
    };
    panel(
        "spin [1000 rpm]", [](const Prediction& a) { return 1e-3 * rpm(a.launch.spin_rate()); },
        [&](const Observed& s) { return list(s.spin_rate, 1e3 / rpm(1)); });
    panel(
        "ball speed [m/s]", [](const Prediction& a) { return a.launch.ball_speed(); },
        [&](const Observed& s) { return list(s.ball_speed, 1); });
    panel(
        "launch ratio", [](const Prediction& a) { return a.ratio; }, [](const Observed& s) { return s.launch_ratio; });
    return f;
  }

  std::vector<Variant> variants_;
  bool matched_ = false;
  std::optional<double> bounce_speed_;
};

}  // namespace

std::unique_ptr<Job> read_variants(CaseFile& file) { return std::make_unique<VariantsJob>(file); }

}  // namespace hosel::app
