#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_markers.hpp"
#include "app/read_shaft.hpp"
#include "app/read_sheet.hpp"
#include "app/read_swing.hpp"
#include "golf/shaft_library.hpp"
#include "models/club/marker_swing.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

class IdentifyJob final : public Job {
 public:
  explicit IdentifyJob(CaseFile& file) {
    Table root = file.root();
    club_.shaft = read_shaft(root.table("shaft"));
    if (!(club_.shaft->damping_time > 0)) root.fail("shaft", "identification starts from a damping_ratio above zero");
    club_.head = read_head(root.table("head"));
    club_.geometry = read_club_geometry(root, false);
    options_ = read_swing_options(root);
    if (auto markers = root.optional_table("markers")) {
      markers_ = read_markers(*markers);
      train_ = markers->quantities({"train", "first and last instant that is fitted"}, "s", 2);
      test_ = markers->quantities({"test", "first and last instant that is predicted"}, "s", 2);
      for (const auto& [key, span] : {std::pair{"train", &train_}, {"test", &test_}})
        if (!((*span)[0] < (*span)[1])) markers->fail(key, "the first instant comes before the last");
      // Of what comes after `test` nothing is smoothed: an impact would reach back.
      if (train_[1] > test_[0]) markers->fail("test", "what is predicted comes after what is fitted");
      marker_kind_ = true;
      return;
    }
    for (Table t : root.tables("swing")) {
      Recorded r;
      r.motion = read_motion(t.table("motion"));
      r.deflection = t.data_file(
          {"deflection", "CSV of the measured lead and droop of the hosel; a row with an empty cell is left out"});
      r.train = t.flag({"train", "fit this swing; otherwise it is predicted"}, true);
      swings_.push_back(std::move(r));
    }
    if (swings_.empty()) root.fail("swing", "give [markers], or at least one [[swing]] with its motion and deflection");
  }

  void run(Output& out) override { marker_kind_ ? markers(out) : recorded(out); }

 private:
  struct Recorded {
    MotionInput motion;
    std::filesystem::path deflection;
    bool train = true;
  };

  /// Value with the 95 % interval of its logarithm.
  static std::array<double, 2> interval(double value, double log_variance) {
    const double factor = std::exp(1.96 * std::sqrt(log_variance));
    return {value / factor, value * factor};
  }
  /// What a rigid club misses of the deflection [mm], over the swings that are fitted or the others.
  static std::optional<double> rigid_rms(const std::vector<models::MeasuredSwing>& swings, bool train) {
    double sum = 0, count = 0;
    for (const models::MeasuredSwing& m : swings) {
      if (m.train != train) continue;
      for (const auto* deflection : {&m.lead, &m.droop})
        for (const double x : *deflection) sum += x * x, ++count;
    }
    return count > 0 ? std::optional(1e3 * std::sqrt(sum / count)) : std::nullopt;
  }
  static nlohmann::json to_json(const models::ShaftIdentification& r) {
    return {{"bending_scale", r.bending_scale},
            {"bending_scale_95", interval(r.bending_scale, r.log_covariance(0, 0))},
            {"damping_time_s", r.damping_time},
            {"damping_time_95_s", interval(r.damping_time, r.log_covariance(1, 1))},
            {"correlation", r.log_covariance(0, 1) / std::sqrt(r.log_covariance(0, 0) * r.log_covariance(1, 1))},
            {"shortened_steps", r.shortened_steps},
            {"train_rms_mm", {{"before", 1e3 * r.train_before}, {"after", 1e3 * r.train_after}}},
            {"holdout_rms_mm",
             r.held_out ? nlohmann::json{{"before", 1e3 * r.held_out->before}, {"after", 1e3 * r.held_out->after}}
                        : nlohmann::json()}};
  }
  static void say(Output& out, const models::ShaftIdentification& r) {
    const auto scale = interval(r.bending_scale, r.log_covariance(0, 0)),
               damping = interval(r.damping_time, r.log_covariance(1, 1));
    out.say(fmt::format(
        "bending stiffness x {:.4f} (95 %: {:.4f} to {:.4f}), damping time {:.3g} s ({:.3g} to {:.3g}); "
        "deflection RMS train {:.2f} -> {:.2f} mm, {}",
        r.bending_scale, scale[0], scale[1], r.damping_time, damping[0], damping[1], 1e3 * r.train_before,
        1e3 * r.train_after,
        r.held_out ? fmt::format("holdout {:.2f} -> {:.2f} mm", 1e3 * r.held_out->before, 1e3 * r.held_out->after)
                   : "nothing held out"));
    RunPage& page = out.page();
    page.answer("bending stiffness", fmt::format("× {:.3f}", r.bending_scale),
                fmt::format("95 %: {:.3f} to {:.3f}", scale[0], scale[1]));
    page.answer("damping time", fmt::format("{:.3g} s", r.damping_time),
                fmt::format("95 %: {:.3g} to {:.3g}", damping[0], damping[1]));
    if (r.held_out)
      page.answer("deflection, held out", fmt::format("{:.2f} mm", 1e3 * r.held_out->after),
                  fmt::format("RMS; {:.2f} before", 1e3 * r.held_out->before));
    constexpr double far = 3;  // times; the interval is that of the fitted part
    if (r.held_out && r.held_out->after > far * r.train_after)
      out.warn(
          fmt::format("held out, the deflection is off by {:.2f} mm, fitted by {:.2f} mm: the interval holds for "
                      "the fitted part of the swing",
                      1e3 * r.held_out->after, 1e3 * r.train_after));
    page.answer("deflection, fitted", fmt::format("{:.2f} mm", 1e3 * r.train_after),
                fmt::format("RMS; {:.2f} before", 1e3 * r.train_before));
    if (r.shortened_steps > 0)
      out.say(fmt::format(
          "{} steps did not converge at their full length: shorten solution.step, or the interval says too little",
          r.shortened_steps));
  }
  static nlohmann::json tell_rigid(Output& out, const std::vector<models::MeasuredSwing>& swings) {
    const double train = rigid_rms(swings, true).value();
    const std::optional<double> holdout = rigid_rms(swings, false);
    if (holdout) out.page().answer("a rigid club, held out", fmt::format("{:.2f} mm", *holdout), "RMS");
    out.say(fmt::format("a rigid club: deflection RMS train {:.2f} mm{}", train,
                        holdout ? fmt::format(", holdout {:.2f} mm", *holdout) : ""));
    return {{"train", train}, {"holdout", holdout ? nlohmann::json(*holdout) : nlohmann::json()}};
  }
  void recorded(Output& out) {
    std::vector<models::GripMotion> motions;
    motions.reserve(swings_.size());
    std::vector<models::MeasuredSwing> measured;
    for (const Recorded& r : swings_) {
      if (!r.motion.present) return out.skip(r.motion.file);
      if (!std::filesystem::exists(r.deflection)) return out.skip(r.deflection);
      const post::Sheet sheet = read_sheet(r.deflection);
      motions.emplace_back(r.motion.track, r.motion.smoothing);
      models::MeasuredSwing m{.motion = [g = &motions.back()](double t) { return g->at(t); },
                              .begin = r.motion.begin,
                              .end = r.motion.end,
                              .train = r.train};
      const auto times = column_with_gaps(sheet, "time_s"), lead = column_with_gaps(sheet, "lead_mm"),
                 droop = column_with_gaps(sheet, "droop_mm");
      for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i])) throw InputError(fmt::format("{}:{}: no time", sheet.file, sheet.lines[i]));
        if (std::isinf(lead[i]) || std::isinf(droop[i]))
          throw InputError(fmt::format("{}:{}: a deflection is infinite", sheet.file, sheet.lines[i]));
        if (std::isnan(lead[i]) || std::isnan(droop[i])) continue;
        m.times.push_back(times[i]), m.lead.push_back(1e-3 * lead[i]), m.droop.push_back(1e-3 * droop[i]);
      }
      if (m.times.size() < times.size())
        out.lack(fmt::format("{}: {} of {} have no lead or no droop: left out", r.deflection.filename().string(),
                             times.size() - m.times.size(), post::counted(times.size(), "row")));
      if (const auto wrong = models::faults(m); !wrong.empty())
        throw InputError(fmt::format("{}: {}", r.deflection.string(), wrong.front()));
      measured.push_back(std::move(m));
    }
    const models::ShaftIdentification r = models::identify_shaft(club_, options_, measured);
    say(out, r);
    out.write_summary({{"identified", to_json(r)}, {"rigid_rms_mm", tell_rigid(out, measured)}});
  }

  std::vector<models::SwingSample> simulate(const models::GripMotion& motion, double end, double scale,
                                            double damping) const {
    Club club = club_;
    club.shaft = scaled(*club_.shaft, scale, 1);
    club.shaft->damping_time = damping;
    models::Swing swing(club, options_, {.motion = [&](double t) { return motion.at(t); }});
    std::vector<models::SwingSample> samples;
    swing.run(swing.start(motion.first(), swing.equilibrium(motion.first())), end,
              [&](const models::SwingSample& s) { samples.push_back(s); });
    return samples;
  }

  void markers(Output& out) {
    if (!std::filesystem::exists(markers_.file)) return out.skip(markers_.file);
    const double end = test_[1];
    const models::MarkerSwing swing = read_marker_swing(markers_, end);
    options_.grip_point = club_.shaft->length() - swing.length;
    const models::GripMotion motion(swing.clamp, markers_.smoothing);

    const auto part = [&](double from, double to, bool train) {
      models::MeasuredSwing m{
          .motion = [&](double t) { return motion.at(t); }, .begin = motion.first(), .end = to, .train = train};
      for (std::size_t i = 0; i < swing.times.size(); ++i)
        if (swing.times[i] >= from && swing.times[i] <= to) {
          m.times.push_back(swing.times[i]);
          m.lead.push_back(swing.lead[i]);
          m.droop.push_back(swing.droop[i]);
        }
      m.end = m.times.empty() ? to : m.times.back() + 1e-6;
      return m;
    };
    out.say(fmt::format("clamp to hosel {:.3f} m; identifying on {:g} to {:g} s", swing.length, train_[0], train_[1]));
    const std::vector<models::MeasuredSwing> parts = {part(train_[0], train_[1], true),
                                                      part(test_[0], test_[1], false)};
    const models::ShaftIdentification r = models::identify_shaft(club_, options_, parts);
    say(out, r);
    const nlohmann::json rigid = tell_rigid(out, parts);

    const auto nominal = simulate(motion, motion.last(), 1, club_.shaft->damping_time);
    const auto identified = simulate(motion, motion.last(), r.bending_scale, r.damping_time);
    nlohmann::json errors;
    const auto error = [&](const char* name, const std::vector<models::SwingSample>& samples) {
      const double all = models::marker_error(swing, motion, samples, end - 0.3, end),
                   held = models::marker_error(swing, motion, samples, test_[0], test_[1]);
      errors[name] = {{"last_300_ms_mm", 1e3 * all}, {"test_mm", 1e3 * held}};
      out.say(fmt::format("head markers, RMS over the last 300 ms: {:>6.1f} mm ({}); over the test interval {:.1f} mm",
                          1e3 * all, name, 1e3 * held));
    };
    error("rigid shaft", {});
    error("nominal", nominal);
    error("identified", identified);

    post::Figure figure{.title = fmt::format("fitted from {:g} to {:g} s, predicted from {:g} to {:g} s", train_[0],
                                             train_[1], test_[0], test_[1]),
                        .columns = 2};
    for (const bool is_lead : {true, false}) {
      post::Panel panel{.title = is_lead ? "lead" : "droop", .x_label = "time [s]", .y_label = "deflection [mm]"};
      post::Series measured{.label = "measured", .style = "points"};
      for (std::size_t i = 0; i < swing.times.size(); ++i)
        if (swing.times[i] > end - 0.6) measured.add(swing.times[i], 1e3 * (is_lead ? swing.lead : swing.droop)[i]);
      panel.series.push_back(measured);
      for (const auto& [label, samples] : {std::pair{"nominal", &nominal}, {"identified", &identified}}) {
        post::Series line{.label = label};
        for (const auto& s : *samples)
          if (s.time > end - 0.6) line.add(s.time, 1e3 * (is_lead ? s.lead : s.droop));
        panel.series.push_back(line);
      }
      figure.panels.push_back(panel);
    }
    out.draw(figure, "deflection");
    out.write_summary({{"identified", to_json(r)},
                       {"rigid_rms_mm", rigid},
                       {"head_markers_rms", errors},
                       {"clamp_to_hosel_m", swing.length}});
  }

  Club club_;
  models::SwingOptions options_;
  bool marker_kind_ = false;
  MarkerInput markers_;
  std::vector<double> train_, test_;
  std::vector<Recorded> swings_;
};

}  // namespace

std::unique_ptr<Job> read_identify_shaft(CaseFile& file) { return std::make_unique<IdentifyJob>(file); }

}  // namespace hosel::app
