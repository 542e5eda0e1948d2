#include "app/kinds/clubs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "golf/units.hpp"
#include "loop/shots/shots.hpp"
#include "models/checked_launch.hpp"
#include "models/matched_launch.hpp"
#include "models/oblique.hpp"
#include "models/registry.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"

namespace hosel::app {
namespace {

/// Half of the last digit that a printed mean shows [deg, rpm, deg, mph], with a margin for round-off.
constexpr std::array<double, 4> resolution = {0.0251, 1.01, 0.0151, 0.0501};

/// The quantities of the tables, in the files' units.
constexpr std::array<const char*, 4> kColumns = {"dynamic_loft_deg", "spin_rate_rpm", "launch_angle_deg",
                                                 "ball_speed_mph"};

struct Line {
  double slope = 0, intercept = 0, r2 = 0;
};

Line straight_line(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  const double mx = std::accumulate(x.begin(), x.end(), 0.0) / n, my = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
    yy += (y[i] - my) * (y[i] - my);
  }
  return {xy / xx, my - xy / xx * mx, xy * xy / (xx * yy)};
}

struct ClubRow {
  std::string name;
  std::array<double, 4> mean{}, half_range{}, printed{}, printed_bar{};
  bool loft_replaced = false;
  Blow blow;
  std::vector<std::array<double, 4>> shots;
  double spin = 0, launch = 0, speed = 0;  // model: rpm, deg, mph
};

class ClubsJob final : public Job {
 public:
  explicit ClubsJob(CaseFile& file) {
    Table root = file.root();
    std::vector<std::string> names;
    for (const auto& m : models::registry()) names.emplace_back(m.name);
    model_ = root.choice({"model", "that answers (`hosel list`)"}, names, "rigid-planar");
    beside_ = root.texts({"beside", "further models asked about each club"}, std::vector<std::string>{});
    for (const std::string& name : beside_)
      if (!models::find(name)) root.fail("beside", fmt::format("no model '{}'; `hosel list` shows them", name));
    options_ = read_options(root, beside_);
    flight_ = read_optional_flight(root);
    blow_.ball = root.has("ball") ? read_ball(root.table("ball")) : Ball{};
    blow_.contact = read_contact(root);
    if (auto head = root.optional_table("head"))
      blow_.club.head = read_head(*head, model_ != "rigid-planar" || !beside_.empty());
    if (auto shaft = root.optional_table("shaft")) blow_.club.shaft = read_shaft(*shaft);
    blow_.club.geometry = read_club_geometry(root, false);
    calibrated_on_ = root.texts({"calibrated_on", "clubs on which the ball was calibrated, marked as such"},
                                std::vector<std::string>{});
    Table data = root.table("data");
    shots_file_ = data.data_file({"shots", "CSV of the shots"});
    clubs_file_ = data.data_file({"clubs", "CSV of each club's published means"});
    Table theory = root.table("theory");
    theory_mass_ = theory.quantity({"head_mass", "of the theoretical curves"}, "kg", limits::head_mass);
    theory_speed_ = theory.quantity({"club_speed", "of the theoretical curves"}, "mps", limits::club_speed);
    other_ball_.mass = theory.quantity({"other_ball_mass", "of a second ball in the theoretical curves"}, "kg",
                                       limits::ball_mass, blow_.ball.mass);
    other_ball_.radius = theory.quantity({"other_ball_radius", "of a second ball in the theoretical curves"}, "mm",
                                         limits::ball_radius, blow_.ball.radius);
  }

  void run(Output& out) override {
    for (const auto& f : {shots_file_, clubs_file_})
      if (!std::filesystem::exists(f)) return out.skip(f);
    const auto model = models::find(model_)->make({});
    std::vector<ClubRow> clubs = read_rows(out);
    nlohmann::json summary;

    // The theoretical curves: loft alone varies.
    Blow blow = blow_;
    blow.club.head.mass = theory_mass_;
    blow.delivery.club_speed = theory_speed_;
    post::Series spin{.label = model_}, launch = spin, speed = spin;
    double peak = 0, peak_at = 0;
    std::string csv = "dynamic_loft_deg,spin_rate_rpm,launch_angle_deg,ball_speed_mps\n";
    for (int i = 1; i < 900; ++i) {
      const double loft = 0.1 * i;
      blow.delivery.dynamic_loft = radians(loft);
      const Launch l = models::checked_launch(*model, blow);
      if (degrees(l.launch_angle()) > peak) peak = degrees(l.launch_angle()), peak_at = loft;
      if (i % 10) continue;
      spin.x.push_back(loft), launch.x.push_back(loft), speed.x.push_back(loft);
      spin.y.push_back(rpm(l.spin_rate())), launch.y.push_back(degrees(l.launch_angle())),
          speed.y.push_back(l.ball_speed());
      csv += fmt::format("{:g},{:.8g},{:.8g},{:.8g}\n", loft, spin.y.back(), launch.y.back(), speed.y.back());
    }
    out.write("theory.csv", csv);
    const auto coefficient = [&](const Ball& ball) {
      Blow b = blow;
      b.ball = ball;
      b.delivery.dynamic_loft = radians(30);
      return rpm(models::checked_launch(*model, b).spin_rate()) / std::sin(radians(30));
    };
    const double own = coefficient(blow_.ball), other = coefficient(other_ball_);
    out.say(fmt::format(
        "spin = {:.4f} sin(loft) rpm for the stated ball (printed: 11120); {:.2f} with m = {:g} kg and r = {:g} mm",
        own, other, other_ball_.mass, other_ball_.radius * 1e3));
    out.say(fmt::format("launch angle peaks at {:.3f} deg for a loft of {:.1f} deg", peak, peak_at));
    summary["theory"] = {{"spin_coefficient_rpm", own},
                         {"spin_coefficient_other_ball_rpm", other},
                         {"launch_peak_deg", peak},
                         {"launch_peak_at_deg", peak_at}};

    // Club by club.
    post::TextTable table{
        .rows = {{"club", "loft", "spin", "measured", "", "launch", "measured", "", "speed", "measured", ""}},
        .first_width = 5,
        .least_width = 9,
        .even = false};
    csv =
        "club,dynamic_loft_deg,model_spin_rpm,measured_spin_rpm,model_launch_deg,measured_launch_deg,model_ball_speed_"
        "mph,measured_ball_speed_mph\n";
    std::array<int, 3> inside{};
    std::array<double, 3> bias{}, square{};
    double ratio = 0;
    std::array<post::Series, 3> measured, predicted;
    std::array<std::vector<double>, 4> means, prints, singles;
    std::vector<Launch> launches;
    for (ClubRow& c : clubs) {
      const Launch& l = launches.emplace_back(models::checked_launch(*model, c.blow));
      c.spin = rpm(l.spin_rate());
      c.launch = degrees(l.launch_angle());
      c.speed = l.ball_speed() / kMpsPerMph;
      const std::array<double, 3> m = {c.spin, c.launch, c.speed};
      table.rows.push_back({c.name, fmt::format("{:.3f}", c.mean[0]), fmt::format("{:.1f}", m[0]),
                            fmt::format("{:.1f}", c.mean[1]), fmt::format("{:+.1f}%", 100 * (m[0] / c.mean[1] - 1)),
                            fmt::format("{:.3f}", m[1]), fmt::format("{:.3f}", c.mean[2]),
                            fmt::format("{:+.2f}", m[1] - c.mean[2]), fmt::format("{:.2f}", m[2]),
                            fmt::format("{:.2f}", c.mean[3]), fmt::format("{:+.2f}%", 100 * (m[2] / c.mean[3] - 1))});
      csv += fmt::format("{},{:.6g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", post::csv_cell(c.name), c.mean[0],
                         m[0], c.mean[1], m[1], c.mean[2], m[2], c.mean[3]);
      ratio += m[0] / c.mean[1] / static_cast<double>(clubs.size());
      for (int k = 0; k < 3; ++k) {
        const double d = m[k] - c.mean[k + 1];
        bias[k] += d / static_cast<double>(clubs.size());
        square[k] += d * d / static_cast<double>(clubs.size());
        inside[k] += std::abs(d) <= c.printed_bar[k + 1];
        measured[k].x.push_back(c.mean[0]);
        measured[k].y.push_back(c.mean[k + 1]);
        measured[k].error.push_back(c.printed_bar[k + 1]);
        predicted[k].x.push_back(c.mean[0]);
        predicted[k].y.push_back(m[k]);
      }
      for (int k = 0; k < 4; ++k) {
        means[k].push_back(c.mean[k]);
        prints[k].push_back(c.printed[k]);
        if (!c.loft_replaced)
          for (const auto& s : c.shots) singles[k].push_back(s[k]);
      }
    }
    out.write("clubs.csv", csv);
    out.tell("");
    out.show(table, fmt::format("Club by club: {}, measured, and the difference", model_));
    out.page().answer("spin, model over measured", fmt::format("{:.3f}", ratio), model_);
    out.page().answer("spin, rms", fmt::format("{:.0f} rpm", std::sqrt(square[0])),
                      fmt::format("bias {:+.0f}", bias[0]));
    out.page().answer("launch angle, rms", fmt::format("{:.2f}°", std::sqrt(square[1])),
                      fmt::format("bias {:+.2f}", bias[1]));
    out.page().answer("ball speed, rms", fmt::format("{:.2f} mph", std::sqrt(square[2])),
                      fmt::format("bias {:+.2f}", bias[2]));
    out.say(fmt::format(
        "\nmodel / measured spin {:.4f}; bias {:+.0f} rpm, {:+.3f} deg, {:+.3f} mph; rms {:.0f} rpm, {:.3f} deg, "
        "{:.3f} mph",
        ratio, bias[0], bias[1], bias[2], std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2])));
    out.say(fmt::format("inside the printed error bars: spin {} of {}, launch {}, ball speed {}", inside[0],
                        clubs.size(), inside[1], inside[2]));
    summary["comparison"] = {{"spin_ratio", ratio},
                             {"bias", bias},
                             {"rms", {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2])}},
                             {"inside_error_bars", inside}};

    if (flight_) follow(clubs, launches, out, summary["flights"][model_]);
    std::vector<Curves> further;
    for (const std::string& name : beside_)
      for (Curves& curves : compare(name, clubs, out, summary)) further.push_back(std::move(curves));

    out.say(fmt::format("\n{:<34} {:>10} {:>10} {:>8} {:>10} {:>10} {:>8}", "straight-line fit", "spin slope",
                        "intercept", "R2", "launch", "intercept", "R2"));
    out.say(fmt::format("{:<34} {:>10.3f} {:>10.3f} {:>8.5f} {:>10.4f} {:>10.4f} {:>8.5f}", "printed", 269.24, 668.67,
                        .9979, .705, .5098, .9987));
    for (const auto& [name, set] :
         {std::pair{"table of means as printed", &prints}, std::pair{"means recomputed from the shots", &means},
          std::pair{"single shots with a recorded loft", &singles}}) {
      const Line s = straight_line((*set)[0], (*set)[1]), l = straight_line((*set)[0], (*set)[2]);
      out.say(fmt::format("{:<34} {:>10.3f} {:>10.3f} {:>8.5f} {:>10.4f} {:>10.4f} {:>8.5f}", name, s.slope,
                          s.intercept, s.r2, l.slope, l.intercept, l.r2));
      summary["fits"].push_back(
          {{"data", name}, {"spin", {s.slope, s.intercept, s.r2}}, {"launch", {l.slope, l.intercept, l.r2}}});
    }
    double top = 0, bottom = 0;
    for (std::size_t i = 0; i < means[0].size(); ++i) {
      top += means[1][i] * std::sin(radians(means[0][i]));
      bottom += std::pow(std::sin(radians(means[0][i])), 2);
    }
    out.say(fmt::format("measured spin = {:.1f} sin(loft) through the origin: the model's coefficient is {:.3f} of it",
                        top / bottom, own / (top / bottom)));
    summary["sine_through_origin_rpm"] = top / bottom;

    // The theory has a row of its own where it alone is asked; beside further models the clubs are the question.
    post::Figure figure{.title = further.empty()
                                     ? "loft against spin, launch angle and ball speed: theory (above), seven "
                                       "clubs (below)"
                                     : "seven clubs against their loft, predicted and measured",
                        .columns = 3,
                        .panel_width = 520};
    if (further.empty())
      figure.panels = {{.x_label = "dynamic loft [deg]", .y_label = "spin rate [rpm]", .series = {spin}},
                       {.x_label = "dynamic loft [deg]", .y_label = "launch angle [deg]", .series = {launch}},
                       {.x_label = "dynamic loft [deg]", .y_label = "ball speed [m/s]", .series = {speed}}};
    const Line spin_fit = straight_line(means[0], means[1]), launch_fit = straight_line(means[0], means[2]);
    const std::array<const char*, 3> labels = {"spin rate [rpm]", "launch angle [deg]", "ball speed [mph]"};
    for (std::size_t k = 0; k < 3; ++k) {
      measured[k].label = "measured (printed bars)";
      predicted[k].label = model_;
      predicted[k].style = "linespoints";
      post::Panel p{.x_label = "dynamic loft [deg]", .y_label = labels[k], .series = {measured[k], predicted[k]}};
      for (const Curves& curves : further) p.series.push_back(curves[k]);
      if (further.empty() && k < 2) {
        const Line& f = k == 0 ? spin_fit : launch_fit;
        p.series.push_back({.label = fmt::format("{:.4g} loft + {:.4g}", f.slope, f.intercept),
                            .x = {12, 33},
                            .y = {f.slope * 12 + f.intercept, f.slope * 33 + f.intercept}});
      }
      figure.panels.push_back(p);
    }
    out.draw(figure, "clubs");
    out.write_summary(summary);
  }

 private:
  /// Where the model's balls go, and where the measured means would by the same law.
  void follow(const std::vector<ClubRow>& clubs, const std::vector<Launch>& launches, Output& out,
              nlohmann::json& said) const {
    const auto channels = post::flight_channels(flight_->unit);
    std::string text = fmt::format("flights by {}: model, (minus that of the measured launch)\n{:<5}",
                                   flight_->conditions.law.name, "club");
    for (const post::FlightChannel& c : channels)
      if (c.name != "total" && c.name != "side") text += fmt::format("{:>22}", fmt::format("{} [{}]", c.name, c.unit));
    for (std::size_t i = 0; i < clubs.size(); ++i) {
      const ClubRow& club = clubs[i];
      const double up = radians(club.mean[2]);
      Launch seen;
      seen.velocity = club.mean[3] * kMpsPerMph * Vec3(std::cos(up), 0, std::sin(up));
      seen.spin = Vec3(0, -club.mean[1] * kRadPerSecPerRpm, 0);
      const post::ShotFlight own = flight_->follow(launches[i], blow_.ball),
                             measured = flight_->follow(seen, blow_.ball);
      text += fmt::format("\n{:<5}", club.name);
      for (const post::FlightChannel& c : channels)
        if (c.name != "total" && c.name != "side") {
          const double value = *c.value(own) / c.si;
          text += fmt::format("{:>22}", fmt::format("{:.{}f} ({:+.{}f})", value, c.decimals,
                                                    value - *c.value(measured) / c.si, c.decimals));
        }
      said[club.name] = {{"model", post::to_json(own)}, {"measured_launch", post::to_json(measured)}};
    }
    out.say(text);
  }

  /// Another model club by club, without the theory's curves: it may be expensive. At the recorded loft, which a launch
  /// monitor may have computed from the ball, and at the measured launch angle with the loft unknown.
  /// Of the seven clubs against their loft [deg]: spin [rpm], launch angle [deg], ball speed [mph].
  using Curves = std::array<post::Series, 3>;

  /// What a further model says at the recorded loft, and at the measured launch angle: for the figure.
  std::array<Curves, 2> compare(const std::string& name, const std::vector<ClubRow>& clubs, Output& out,
                                nlohmann::json& summary) const {
    std::array<Curves, 2> curves;
    const auto model = models::find(name)->make(options_);
    struct Prediction {
      Blow blow;
      Launch launch;
    };
    std::vector<Prediction> recorded, matched;
    Progress progress = out.progress(name);
    for (const ClubRow& c : clubs) {
      progress.update(double(recorded.size()) / double(clubs.size()), c.name);
      recorded.push_back({c.blow, models::checked_launch(*model, c.blow)});
      const auto found = models::match_launch_angle(*model, c.blow, radians(c.mean[2]), radians(0.05));
      models::check_launch(*model, found.blow, found.launch);
      matched.push_back({found.blow, found.launch});
    }
    progress.finish();
    for (const auto& [how, answers] :
         {std::pair{"at the recorded loft", &recorded}, {"at the launch angle measured", &matched}}) {
      post::TextTable table{.rows = {{"club", "loft", "spin", "measured", "", "launch", "measured", "", "speed",
                                      "measured", "", "e_t", "ratio", ""}},
                            .first_width = 5,
                            .least_width = 9,
                            .even = false};
      nlohmann::json& rows = summary["beside"][name][answers == &matched ? "matched_launch" : "recorded_loft"];
      std::array<double, 2> square{}, unseen{};  // of the relative errors of spin and speed
      int left = 0;
      Curves& shown = curves[answers == &matched ? 1 : 0];
      for (post::Series& s : shown) s.label = fmt::format("{} {}", name, how), s.style = "linespoints";
      for (std::size_t i = 0; i < clubs.size(); ++i) {
        const ClubRow& c = clubs[i];
        const auto& [blow, l] = (*answers)[i];
        const double spin = rpm(l.spin_rate()), launch = degrees(l.launch_angle()), speed = l.ball_speed() / kMpsPerMph;
        for (std::size_t k = 0; k < 3; ++k) {
          shown[k].x.push_back(degrees(blow.delivery.dynamic_loft));
          shown[k].y.push_back(std::array{spin, launch, speed}[k]);
        }
        const double e_t = models::tangential_restitution(blow, l).value_or(NAN);
        const double ratio = models::launch_ratio(blow, l).value_or(NAN);
        const std::array<double, 2> off = {spin / c.mean[1] - 1, speed / c.mean[3] - 1};
        const bool seen = std::ranges::find(calibrated_on_, c.name) != calibrated_on_.end();
        left += !seen;
        for (std::size_t k = 0; k < 2; ++k) square[k] += off[k] * off[k], unseen[k] += seen ? 0 : off[k] * off[k];
        table.rows.push_back(
            {c.name, fmt::format("{:.3f}", degrees(blow.delivery.dynamic_loft)), fmt::format("{:.1f}", spin),
             fmt::format("{:.1f}", c.mean[1]), fmt::format("{:+.1f}%", 100 * off[0]), fmt::format("{:.3f}", launch),
             fmt::format("{:.3f}", c.mean[2]), fmt::format("{:+.2f}", launch - c.mean[2]), fmt::format("{:.2f}", speed),
             fmt::format("{:.2f}", c.mean[3]), fmt::format("{:+.2f}%", 100 * off[1]), fmt::format("{:.3f}", e_t),
             fmt::format("{:.3f}", ratio), seen ? "(seen by the calibration)" : ""});
        rows[c.name] = {{"dynamic_loft_deg", degrees(blow.delivery.dynamic_loft)},
                        {"spin_rate_rpm", spin},
                        {"launch_angle_deg", launch},
                        {"ball_speed_mph", speed},
                        {"tangential_restitution", e_t},
                        {"launch_ratio", ratio},
                        {"seen_by_calibration", seen}};
      }
      out.tell(fmt::format("\n{} {}", name, how));
      out.show(table, fmt::format("{} {}", name, how));
      const auto percent = [](double sum, std::size_t n) { return 100 * std::sqrt(sum / double(n)); };
      out.say(fmt::format("rms error: spin {:.2f} %, ball speed {:.2f} %", percent(square[0], clubs.size()),
                          percent(square[1], clubs.size())));
      out.page().answer(fmt::format("{} {}", name, how), fmt::format("{:.1f} %", percent(square[0], clubs.size())),
                        fmt::format("rms of spin; ball speed {:.1f} %", percent(square[1], clubs.size())));
      std::vector<Launch> launches;
      for (const Prediction& p : *answers) launches.push_back(p.launch);
      if (flight_) follow(clubs, launches, out, rows["flights"]);
      rows["rms_pct"] = {{"spin", percent(square[0], clubs.size())}, {"speed", percent(square[1], clubs.size())}};
      if (calibrated_on_.empty() || left == 0) continue;
      out.say(fmt::format("on the {} clubs that the calibration did not see: spin {:.2f} %, ball speed {:.2f} %", left,
                          percent(unseen[0], std::size_t(left)), percent(unseen[1], std::size_t(left))));
      rows["rms_unseen_pct"] = {{"spin", percent(unseen[0], std::size_t(left))},
                                {"speed", percent(unseen[1], std::size_t(left))}};
    }
    return curves;
  }

  std::vector<ClubRow> read_rows(Output& out) const {
    try {
      const loop::Shots shots = loop::read_shots(post::read_csv(shots_file_));
      const post::Sheet sheet = post::read_csv(clubs_file_);
      const auto cell = [&](std::string_view name, std::size_t row) {
        const auto it = std::ranges::find(sheet.names, name);
        if (it == sheet.names.end()) throw InputError(fmt::format("{}: no column '{}'", clubs_file_.string(), name));
        return sheet.columns[static_cast<std::size_t>(it - sheet.names.begin())][row];
      };
      const auto value = [&](std::string_view name, std::size_t row, Range si) {
        const std::string text = cell(name, row);
        const SplitName split = split_unit(name);
        double x = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
        const auto fail = [&](const std::string& what) {
          throw InputError(fmt::format("{}:{}: {}: {}", clubs_file_.string(), sheet.lines[row], name, what));
        };
        if (text.empty()) fail("the cell is empty");
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(x))
          fail(fmt::format("'{}' is no number", text));
        if (!si.contains(x * split.unit->si)) fail(fmt::format("{} is {}", text, si.sentence(split.unit)));
        return x * split.unit->si;
      };
      const loop::Column* club = shots.find("club");
      if (!club || club->numeric) throw InputError(fmt::format("{}: no text column 'club'", shots_file_.string()));
      std::vector<ClubRow> rows;
      for (std::size_t k = 0; k < sheet.rows(); ++k) {
        ClubRow c;
        c.name = cell("club", k);
        c.blow = blow_;
        c.blow.club.head.mass = value("head_mass_kg", k, limits::head_mass);
        Delivery& d = c.blow.delivery;
        d.club_speed = value("club_speed_mph", k, limits::club_speed);
        d.attack_angle = value("attack_angle_deg", k, limits::angle);
        d.club_path = value("club_path_deg", k, limits::angle);
        d.face_angle = value("face_angle_deg", k, limits::angle);
        d.impact_toe = value("impact_toe_mm", k, limits::impact_place);
        d.impact_high = value("impact_high_mm", k, limits::impact_place);
        std::array<double, 4> low, high;
        low.fill(INFINITY), high.fill(-INFINITY);
        for (std::size_t row = 0; row < shots.rows(); ++row) {
          if (club->text[row] != c.name) continue;
          std::array<double, 4> s{};
          for (int i = 0; i < 4; ++i) {
            const loop::Column* column = shots.find(kColumns[static_cast<std::size_t>(i)]);
            if (!column)
              throw InputError(
                  fmt::format("{}: no column '{}'", shots_file_.string(), kColumns[static_cast<std::size_t>(i)]));
            s[i] = column->native(row);
            if (!std::isfinite(s[i]))
              throw InputError(fmt::format("{}: {}: an empty or broken cell of club '{}'", shots_file_.string(),
                                           column->name, c.name));
            low[i] = std::min(low[i], s[i]);
            high[i] = std::max(high[i], s[i]);
            c.mean[i] += s[i];
          }
          c.shots.push_back(s);
        }
        if (c.shots.empty()) throw InputError(fmt::format("{}: no shot of club '{}'", shots_file_.string(), c.name));
        for (int i = 0; i < 4; ++i) {
          c.mean[i] /= static_cast<double>(c.shots.size());
          c.half_range[i] = (high[i] - low[i]) / 2;
          const auto native = [&](const char* what, Range range) {
            const std::string name = fmt::format("{}_{}", what, kColumns[static_cast<std::size_t>(i)]);
            return value(name, k, range) / split_unit(name).unit->si;
          };
          c.printed[i] = native("mean", Range::finite());
          c.printed_bar[i] = native("half_range", Range::non_negative());
        }
        for (int i = 0; i < 4; ++i) {
          const double off = c.mean[i] - c.printed[i];
          if (i == 0 && std::abs(off) > 10) {
            out.say(
                fmt::format("{}: the shots' loft column has the mean {:.3f}, no loft (club speed {:g} mph); the "
                            "table's {:g} is taken",
                            c.name, c.mean[0], c.blow.delivery.club_speed / kMpsPerMph, c.printed[0]));
            c.mean[0] = c.printed[0];
            c.loft_replaced = true;
          } else if (std::abs(off) > resolution[static_cast<std::size_t>(i)]) {
            out.say(fmt::format("{}: printed mean of {} {:g}, recomputed {:.5g}", c.name,
                                kColumns[static_cast<std::size_t>(i)], c.printed[i], c.mean[i]));
          }
        }
        c.blow.delivery.dynamic_loft = radians(c.mean[0]);
        rows.push_back(c);
      }
      if (rows.size() < 2)
        throw InputError(fmt::format("{}: a line through the clubs needs two of them", clubs_file_.string()));
      return rows;
    } catch (const DataError& e) { throw InputError(e.what()); }
  }

  std::optional<FlightSetup> flight_;
  std::vector<std::string> beside_, calibrated_on_;
  models::Options options_;
  std::string model_;
  Blow blow_;
  std::filesystem::path shots_file_, clubs_file_;
  double theory_mass_ = 0, theory_speed_ = 0;
  Ball other_ball_;
};

}  // namespace

std::unique_ptr<Job> read_clubs(CaseFile& file) { return std::make_unique<ClubsJob>(file); }

}  // namespace hosel::app
