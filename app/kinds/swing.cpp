#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_shaft.hpp"
#include "app/read_swing.hpp"
#include "post/digits.hpp"
#include "post/energy_table.hpp"
#include "post/figure.hpp"
#include "post/swing_recorder.hpp"
#include "post/table.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

class SwingJob final : public Job {
 public:
  explicit SwingJob(CaseFile& file) {
    Table root = file.root();
    club_.shaft = read_shaft(root.table("shaft"));
    club_.head = read_head(root.table("head"));
    club_.geometry = read_club_geometry(root, false);
    motion_ = read_motion(root.table("motion"));
    options_ = read_swing_options(root);
    grip_ = read_grip_drive(root);
    errors_ = root.flag({"numerical_error",
                         "swing once more with steps twice as long (by ida: by generalized-alpha): how far the end "
                         "moves"},
                        true);
    if (auto output = root.optional_table("output")) {
      record_.vtk = output->flag({"vtk", "write series for ParaView"}, record_.vtk);
      record_.steps_per_frame = int(output->integer({"steps_per_frame", "time steps from one frame to the next"}, 1,
                                                    100000, record_.steps_per_frame));
    }
  }

  void run(Output& out) override {
    if (!motion_.present) return out.skip(motion_.file);
    nlohmann::json summary;
    const models::GripMotion grip(motion_.track, motion_.smoothing);
    const fem::Motion motion = [&](double t) { return grip.at(t); };
    models::Swing swing(club_, options_, make_drive(grip_, motion_, motion));
    const fem::State from = begun(swing, options_, motion);
    std::vector<models::SwingSample> samples;
    post::SwingRecorder recorder(out.directory(), club_, swing, record_);
    {
      Progress progress = out.progress("swing");
      swing.watch(from, motion_.end, [&](const models::SwingSample& s, const fem::State& state) {
        samples.push_back(s);
        recorder(s, state);
        progress.update((s.time - motion_.begin) / (motion_.end - motion_.begin), fmt::format("t = {:.3f} s", s.time));
      });
    }
    post::Table table;
    table.in_files({"time_s", "lead_mm", "droop_mm", "twist_deg", "head_speed_mps", "force_x_N", "force_y_N",
                    "force_z_N", "moment_x_N_m", "moment_y_N_m", "moment_z_N_m"},
                   "{:.9g}");
    post::Series lead{.label = "lead"}, droop{.label = "droop"}, speed{.label = ""};
    double peak_lead = 0, peak_droop = 0;
    for (const auto& s : samples) {
      // The wrench in grip axes, as [@shaft-influence] shows it.
      const Vec3 force = s.grip.rotation.conjugate() * s.force;
      table.add(s.time, 1e3 * s.lead, 1e3 * s.droop, degrees(s.twist.z()), s.head.velocity.norm(), force, s.moment);
      lead.add(s.time, 1e3 * s.lead);
      droop.add(s.time, 1e3 * s.droop);
      speed.add(s.time, s.head.velocity.norm());
      if (std::abs(s.lead) > std::abs(peak_lead)) peak_lead = s.lead;
      if (std::abs(s.droop) > std::abs(peak_droop)) peak_droop = s.droop;
    }
    out.write("swing.csv", table.csv());
    post::Figure figure{.columns = 2};
    figure.panels.push_back({.title = "hosel in the grip frame",
                             .x_label = "time [s]",
                             .y_label = "deflection [mm]",
                             .series = {lead, droop}});
    figure.panels.push_back({.title = swing.head() ? "head speed" : "speed of the tip",
                             .x_label = "time [s]",
                             .y_label = "speed [m/s]",
                             .series = {speed}});
    out.draw(figure, "swing");

    recorder.finish();
    out.draw(recorder.figure(0.4), "shaft");

    const models::SwingSample& last = samples.back();
    const Delivery d = models::delivery_of(last.head);
    summary["at_end"] = {{"time_s", last.time},
                         {"lead_mm", 1e3 * last.lead},
                         {"droop_mm", 1e3 * last.droop},
                         {"twist_deg", degrees(last.twist.z())}};
    if (const fem::RigidBody* head = swing.head()) {
      // What the same grip would give the head of a club that does not bend.
      const Vec3 arm = swing.shaft().line().back().position + head->properties().offset;
      const fem::Pose& g = last.grip;
      summary["rigid_club_speed_mps"] = (g.velocity + g.rotation * g.angular_velocity.cross(arm)).norm();
    }
    summary["peak"] = {{"lead_mm", 1e3 * peak_lead}, {"droop_mm", 1e3 * peak_droop}};
    nlohmann::json way{{"club_speed_mps", d.club_speed},
                       {"attack_angle_deg", degrees(d.attack_angle)},
                       {"club_path_deg", degrees(d.club_path)}};
    if (swing.head()) {
      way["dynamic_loft_deg"] = degrees(d.dynamic_loft);
      way["face_angle_deg"] = degrees(d.face_angle);
      way["dynamic_lie_deg"] = degrees(models::dynamic_lie(last.head));
      way["head_angular_velocity_rad_per_s"] = {d.head_angular_velocity.x(), d.head_angular_velocity.y(),
                                                d.head_angular_velocity.z()};
      summary["delivery"] = way;
    } else {
      summary["tip"] = way;  // a shaft without a head has no face
    }
    // IDA keeps no ledger.
    if (const solvers::Ledger& l = swing.ledger(); options_.integrator == models::SwingIntegrator::generalized_alpha)
      summary["energy_J"] = {{"kinetic", l.kinetic},     {"strain", l.strain_total()}, {"viscous", l.viscous},
                             {"numerical", l.numerical}, {"external", l.external},     {"initial", l.initial},
                             {"closure", l.closure}};
    summary["steps"] = swing.counts().steps;
    const std::vector<Moved> moved = errors_ ? moved_by_steps(out, motion, last, swing.head() != nullptr)
                                             : std::vector<Moved>{};
    for (const Moved& m : moved) summary["numerical_error"][m.key] = m.by;
    RunPage& page = out.page();
    const bool mph = out.page_units() == post::Units::golf;
    page.answer(swing.head() ? "club speed" : "speed of the tip",
                mph ? fmt::format("{:.1f} mph", d.club_speed / kMpsPerMph) : fmt::format("{:.2f} m/s", d.club_speed),
                summary.contains("rigid_club_speed_mps") ? fmt::format("a club that does not bend: {:.2f} m/s",
                                                                       summary["rigid_club_speed_mps"].get<double>())
                                                         : "");
    const auto mm = [](double x) { return post::fixed(1e3 * x, 1); };
    const auto angle = [](double x) { return post::fixed(degrees(x), 2) + "°"; };
    page.answer("lead", mm(last.lead) + " mm", "largest " + mm(peak_lead));
    page.answer("droop", mm(last.droop) + " mm", "largest " + mm(peak_droop));
    page.answer("attack angle", angle(d.attack_angle));
    page.answer("club path", angle(d.club_path));
    if (swing.head()) {
      page.answer("dynamic loft", angle(d.dynamic_loft));
      page.answer("face angle", angle(d.face_angle));
    }
    show_solution(page, swing, samples.back().time - samples.front().time);
    show_moved(out, moved);
    out.say(fmt::format(
        "at {:.4f} s: lead {:.1f} mm, droop {:.1f} mm; {} {:.2f} m/s, attack {:.2f} deg, path {:.2f} deg{}", last.time,
        1e3 * last.lead, 1e3 * last.droop, swing.head() ? "head" : "tip", d.club_speed, degrees(d.attack_angle),
        degrees(d.club_path),
        swing.head() ? fmt::format(", loft {:.2f} deg, face {:.2f} deg", degrees(d.dynamic_loft), degrees(d.face_angle))
                     : ""));
    for (const auto& file : post::SwingRecorder::files(out.directory()))
      out.say(fmt::format("ParaView: {}", file.string()));
    out.write_summary(summary);
  }

 private:
  /// How far a quantity at the end moves with other steps, and what is worth a doubt, in the unit of its key.
  struct Moved {
    std::string_view key, what;
    double by, much;
  };

  /// The start: bent by gravity, in the hands' springs or as a grip that is held would have it.
  fem::State begun(models::Swing& swing, const models::SwingOptions& options, const fem::Motion& motion) const {
    models::Swing held(club_, options,
                       {.kind = models::GripDrive::Kind::prescribed, .motion = motion, .wrench = {}, .hands = {}});
    models::Swing& hanging = grip_.kind == models::GripDrive::Kind::hands ? swing : held;
    return swing.start(motion_.begin, hanging.equilibrium(motion_.begin));
  }

  std::string_view companion() const {
    return options_.integrator == models::SwingIntegrator::ida ? "generalized-alpha" : "steps twice as long";
  }

  /// A second swing against the first one's end; nothing where it does not converge.
  std::vector<Moved> moved_by_steps(Output& out, const fem::Motion& motion, const models::SwingSample& last,
                                    bool head) const {
    models::SwingOptions other = options_;
    if (options_.integrator == models::SwingIntegrator::ida)
      other.integrator = models::SwingIntegrator::generalized_alpha;
    else other.step *= 2;
    models::SwingSample end;
    try {
      models::Swing swing(club_, other, make_drive(grip_, motion_, motion));
      swing.run(begun(swing, other, motion), motion_.end, [&](const models::SwingSample& s) { end = s; });
    } catch (const solvers::NonConvergence& e) {
      out.warn(fmt::format("nothing is known of the error of the time steps: by {} the swing has no answer ({})",
                           companion(), e.what()));
      return {};
    }
    const Delivery d = models::delivery_of(last.head), o = models::delivery_of(end.head);
    const auto angle = [](double a, double b) { return std::abs(degrees(std::remainder(a - b, 2 * kPi))); };
    constexpr double much_deg = 0.25, much_mm = 2;
    std::vector<Moved> moved = {
        {"club_speed_mps", head ? "club speed [m/s]" : "speed of the tip [m/s]", std::abs(d.club_speed - o.club_speed),
         0.005 * d.club_speed},
        {"attack_angle_deg", "attack angle [°]", angle(d.attack_angle, o.attack_angle), much_deg},
        {"club_path_deg", "club path [°]", angle(d.club_path, o.club_path), much_deg},
        {"lead_mm", "lead [mm]", 1e3 * std::abs(last.lead - end.lead), much_mm},
        {"droop_mm", "droop [mm]", 1e3 * std::abs(last.droop - end.droop), much_mm}};
    if (head) {
      moved.push_back({"dynamic_loft_deg", "dynamic loft [°]", angle(d.dynamic_loft, o.dynamic_loft), much_deg});
      moved.push_back({"face_angle_deg", "face angle [°]", angle(d.face_angle, o.face_angle), much_deg});
    }
    return moved;
  }

  void show_moved(Output& out, const std::vector<Moved>& moved) const {
    if (moved.empty()) return;
    post::TextTable t{.rows = {{fmt::format("moved by {}", companion()), ""}}};
    std::string doubtful;
    for (const Moved& m : moved) {
      t.rows.push_back({std::string(m.what), fmt::format("{:.2g}", m.by)});
      if (m.by > m.much) doubtful += fmt::format("{}{} {:.2g}", doubtful.empty() ? "" : ", ", m.what, m.by);
    }
    out.page().section("", t.html());
    out.say(fmt::format("{} move the end by {:.2g} m/s of speed, {:.2g} mm of lead and {:.2g} mm of droop", companion(),
                        moved[0].by, moved[3].by, moved[4].by));
    if (!doubtful.empty())
      out.warn(fmt::format("{} move the end of the swing by {}: shorten solution.step", companion(), doubtful));
  }

  /// Steps, what they left, and the energy balance.
  void show_solution(RunPage& page, const models::Swing& swing, double seconds) const {
    const auto& counts = swing.counts();
    const solvers::Ledger& ledger = swing.ledger();
    const bool own = options_.integrator == models::SwingIntegrator::generalized_alpha;
    post::TextTable t{.rows = {{"", own ? "generalized-alpha" : "ida"}}};
    t.rows.push_back({"time steps", fmt::format("{}", counts.steps)});
    t.rows.push_back({"mean step [ms]", fmt::format("{:.4g}", 1e3 * seconds / double(std::max(counts.steps, 1L)))});
    if (own) {
      t.rows.push_back({"longest step allowed [ms]", fmt::format("{:.4g}", 1e3 * options_.step)});
      t.rows.push_back({"rejected steps", fmt::format("{}", counts.rejected)});
      t.rows.push_back({"worst residual accepted, of the forces", fmt::format("{:.1e}", counts.worst_residual)});
      // The energy grows from near zero: what has gone through the club is the scale.
      const double scale = std::max({std::abs(ledger.initial), std::abs(ledger.kinetic), std::abs(ledger.external)});
      if (scale > 0)
        t.rows.push_back(
            {"energy unaccounted for, of the largest energy", fmt::format("{:.1e}", ledger.closure / scale)});
    }
    page.section("How well it was solved", t.html());
    if (own)
      page.section("Where the energy went", post::energy_table({{"swing", ledger}}, post::EnergyOf::swing).html());
    else page.section("", "<p><small>IDA keeps no energy balance.</small></p>");
  }

  Club club_;
  MotionInput motion_;
  models::SwingOptions options_;
  GripInput grip_;
  bool errors_ = true;
  post::SwingRecorderOptions record_;
};

}  // namespace

std::unique_ptr<Job> read_swing(CaseFile& file) { return std::make_unique<SwingJob>(file); }

}  // namespace hosel::app
