#include "app/kinds/loaded_club.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "app/read_swing.hpp"
#include "models/checked_launch.hpp"
#include "models/club/hosel_load.hpp"
#include "models/club/swing_end.hpp"
#include "models/fe/impact.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/impact_recorder.hpp"
#include "post/launch_table.hpp"
#include "post/shaft_loads.hpp"

namespace hosel::app {
namespace {

using models::Grip;
using models::SwingEnd;

/// One answer at one point of the face.
struct LoadedPrediction {
  std::string name;
  Launch launch;
  models::HoselHistory hosel;  // of finite-element clubs
};

class LoadedClubJob final : public Job {
 public:
  explicit LoadedClubJob(CaseFile& file) {
    Table root = file.root();
    blow_.club.shaft = read_shaft(root.table("shaft"));
    blow_.club.head = read_head(root.table("head"));
    blow_.club.geometry = read_club_geometry(root, false);
    if (auto ball = root.optional_table("ball")) blow_.ball = read_ball(*ball);
    motion_ = read_motion(root.table("motion"));
    swing_ = read_swing_options(root);
    if (swing_.joint.kind == models::HeadJoint::Kind::none) root.fail("joint", "a blow needs a head on the shaft");
    // A condensed shaft knows no joint that gives: the reduced models are then not asked.
    std::vector<std::string> asked{"fe-free-body"};
    if (!swing_.joint.gives()) asked.emplace_back("volumetric");
    solve_ = read_options(root, asked, blow_);
    models::ShaftMount& mount = solve_.shaft_mount;
    mount.elements = swing_.elements;
    mount.growth = swing_.growth;
    mount.shear = swing_.shear;
    mount.grip_point = swing_.grip_point;
    mount.joint = swing_.joint;
    flight_ = read_optional_flight(root);
    record_ = read_recorder(root);
    record_.checkpoints = false;  // seven blows a point, of which one is recorded
    Table points = root.table("points");
    toe_ = points.quantities({"impact_toe", "where the ball meets the face, towards the toe"}, "mm", 0);
    high_ = points.quantities({"impact_high", "where the ball meets the face, up"}, "mm", toe_.size());
    if (toe_.empty()) points.fail("impact_toe", "at least one point of the face");
  }

  void run(Output& out) override {
    if (!motion_.present) return out.skip(motion_.file);
    const SwingEnd end = swing_to_end(swing_.gravity);
    std::optional<SwingEnd> weightless;  // without its weight a head on a hinge hangs nowhere before the swing
    if (!swing_.joint.gives()) weightless = swing_to_end(Vec3::Zero(), end.lie);
    const double lie = end.lie;
    const Delivery& d = end.delivery;
    out.say(
        fmt::format("the swing ends with lead {:.1f} mm, droop {:.1f} mm; head {:.2f} m/s, attack {:.2f} deg, path "
                    "{:.2f} deg, loft {:.2f} deg, face {:.2f} deg, lie {:.2f} deg",
                    1e3 * end.lead, 1e3 * end.droop, d.club_speed, degrees(d.attack_angle), degrees(d.club_path),
                    degrees(d.dynamic_loft), degrees(d.face_angle), degrees(lie)));
    out.say(fmt::format("hands on the club: force {:.1f} N, moment {:.1f} N m; head without a blow: {:.0f} m/s^2",
                        end.shaft.grip.force.norm(), end.shaft.grip.moment.norm(), end.shaft.head_acceleration.norm()));
    nlohmann::json summary;
    summary["delivery"] = {{"club_speed_mps", d.club_speed},          {"attack_angle_deg", degrees(d.attack_angle)},
                           {"club_path_deg", degrees(d.club_path)},   {"dynamic_loft_deg", degrees(d.dynamic_loft)},
                           {"face_angle_deg", degrees(d.face_angle)}, {"dynamic_lie_deg", degrees(lie)}};
    summary["preload"] = {{"lead_mm", 1e3 * end.lead},
                          {"droop_mm", 1e3 * end.droop},
                          {"hands_force_N", end.shaft.grip.force.norm()},
                          {"hands_moment_N_m", end.shaft.grip.moment.norm()},
                          {"head_acceleration_m_per_s2", end.shaft.head_acceleration.norm()}};
    std::string table = "impact_toe_mm,impact_high_mm,club";
    for (const post::Channel& c : post::channels()) table += fmt::format(",{}_{}", c.name, c.unit);
    table +=
        ",head_speed_mps,head_rotation_rad_per_s,hosel_impulse_x_N_s,hosel_impulse_y_N_s,hosel_impulse_z_N_s,hosel_"
        "moment_impulse_x_N_m_s,"
        "hosel_moment_impulse_y_N_m_s,hosel_moment_impulse_z_N_m_s\n";
    post::Figure figure{.columns = 2, .panel_width = 840}, waves{.columns = 2, .panel_width = 840}, along{.columns = 3};
    std::vector<std::filesystem::path> series;
    const double back = axial_return();
    summary["axial_wave_back_from_the_grip_ms"] = 1e3 * back;
    for (std::size_t k = 0; k < toe_.size(); ++k) {
      Blow blow = blow_;
      blow.club = end.club;
      blow.delivery = d;
      blow.delivery.impact_toe = toe_[k];
      blow.delivery.impact_high = high_[k];
      models::turn_place(lie, blow.delivery);
      const std::string at = fmt::format("toe {:g} mm, high {:g} mm", 1e3 * toe_[k], 1e3 * high_[k]);
      const std::filesystem::path seen = out.directory() / fmt::format("point_{}", k + 1);
      post::ImpactRecorder recorder(seen, blow, record_, "");
      post::ShaftLoads carried;
      const std::vector<LoadedPrediction> answers =
          ask(out, blow, end, weightless, at, [&](const models::ImpactView& view) {
            recorder(view);
            carried.add(view.state.time, *view.shaft, view.state);
          });
      out.write(fmt::format("point_{}/shaft.csv", k + 1), carried.table());
      for (post::Panel& p : carried.panels(1e-3)) {
        p.title = fmt::format("{}: {}", at, p.title);
        along.panels.push_back(std::move(p));
      }
      std::ranges::copy(recorder.files(), std::back_inserter(series));
      std::vector<post::LaunchColumn> columns;
      nlohmann::json point = {{"impact_toe_mm", 1e3 * toe_[k]}, {"impact_high_mm", 1e3 * high_[k]}};
      for (const LoadedPrediction& a : answers) {
        columns.push_back({a.name, a.launch});
        if (flight_) columns.back().flight = flight_->follow(a.launch, blow_.ball);
        table += fmt::format("{:g},{:g},{}", 1e3 * toe_[k], 1e3 * high_[k], post::csv_cell(a.name));
        for (const post::Channel& c : post::channels()) table += fmt::format(",{:.9g}", (a.launch.*c.value)() / c.si);
        const fem::Wrench impulse = a.hosel.impulse();
        table += fmt::format(",{:.9g},{:.9g}", a.launch.head_velocity.norm(), a.launch.head_spin.norm());
        for (const Vec3& v : {impulse.force, impulse.moment})  // empty where no shaft was meshed
          table += a.hosel.times.empty() ? ",,," : fmt::format(",{:.6g},{:.6g},{:.6g}", v.x(), v.y(), v.z());
        table += "\n";
        point["clubs"][a.name] = post::to_json(a.launch);
        if (flight_) point["clubs"][a.name].update(post::to_json(*columns.back().flight));
        if (!a.hosel.times.empty())
          point["clubs"][a.name]["hosel_impulse"] = {
              {"force_N_s", {impulse.force.x(), impulse.force.y(), impulse.force.z()}},
              {"moment_N_m_s", {impulse.moment.x(), impulse.moment.y(), impulse.moment.z()}}};
      }
      out.tell(at);
      out.show(post::launch_table(columns), at);
      for (const auto& [what, with, without] : parts()) {
        if (!asked(answers, with) || !asked(answers, without)) continue;
        const Launch &a = find(answers, with).launch, &b = find(answers, without).launch;
        point["parts"][what] = difference(a, b);
        out.say(
            fmt::format("  {:<58} ball {:+.4f} m/s, launch {:+.3f} deg, azimuth {:+.3f} deg, backspin {:+.1f} rpm, "
                        "sidespin {:+.1f} rpm, head rotation {:+.2f} rad/s",
                        what, a.ball_speed() - b.ball_speed(), degrees(a.launch_angle() - b.launch_angle()),
                        degrees(a.azimuth() - b.azimuth()), rpm(a.backspin() - b.backspin()),
                        rpm(a.sidespin() - b.sidespin()), a.head_spin.norm() - b.head_spin.norm()));
      }
      summary["points"].push_back(point);
      out.write(fmt::format("hosel_{}.csv", k + 1), history(find(answers, "club loaded")));
      for (const bool force : {true, false})
        figure.panels.push_back(panel(find(answers, "club loaded"), find(answers, "club at rest"), at, force));
      waves.panels.push_back(grip_panel(answers, at, back));
    }
    out.write("points.csv", table);
    out.draw(figure, "hosel");
    out.draw(waves, "grip");
    out.draw(along, "shaft");
    for (const auto& file : series) out.say(fmt::format("ParaView: {}", file.string()));
    out.write_summary(summary);
  }

 private:
  struct Part {
    const char *what, *with, *without;
  };
  static std::array<Part, 10> parts() {
    return {{{"the shaft, unloaded", "club at rest", "free body"},
             {"the swing's preload, without gravity", "club loaded, no gravity", "club at rest"},
             {"gravity", "club loaded", "club loaded, no gravity"},
             {"the whole club", "club loaded", "free body"},
             {"start from delivery and hands alone", "club from delivery and hands", "club loaded"},
             {"grip clamped instead of forced", "club loaded, clamped", "club loaded"},
             {"grip free instead of forced", "club loaded, free", "club loaded"},
             {"reduced: added mass", "shaft-coupled, translation", "volumetric"},
             {"reduced: added rotational inertia", "shaft-coupled", "shaft-coupled, translation"},
             {"reduced: preload and gravity", "shaft-coupled, loaded", "shaft-coupled"}}};
  }
  static double rpm(double w) { return w * 60 / (2 * kPi); }
  static nlohmann::json difference(const Launch& a, const Launch& b) {
    nlohmann::json j;
    for (const post::Channel& c : post::channels())
      j[fmt::format("{}_{}", c.name, c.unit)] = ((a.*c.value)() - (b.*c.value)()) / c.si;
    j["head_speed_mps"] = a.head_velocity.norm() - b.head_velocity.norm();
    j["head_rotation_rad_per_s"] = a.head_spin.norm() - b.head_spin.norm();
    return j;
  }
  static bool asked(const std::vector<LoadedPrediction>& answers, std::string_view name) {
    return std::ranges::find(answers, name, &LoadedPrediction::name) != answers.end();
  }
  static const LoadedPrediction& find(const std::vector<LoadedPrediction>& answers, std::string_view name) {
    for (const LoadedPrediction& a : answers)
      if (a.name == name) return a;
    throw std::logic_error("no such club");
  }

  SwingEnd swing_to_end(const Vec3& gravity, std::optional<double> lie = {}) const {
    const models::GripMotion grip(motion_.track, motion_.smoothing);
    models::SwingOptions options = swing_;
    options.gravity = gravity;
    return models::swing_end(
        blow_.club, options, [&](double t) { return grip.at(t); }, motion_.begin, motion_.end, lie);
  }

  std::vector<LoadedPrediction> ask(Output& out, const Blow& blow, const SwingEnd& end,
                                    const std::optional<SwingEnd>& weightless, const std::string& at,
                                    const models::ImpactObserver& record) const {
    std::vector<LoadedPrediction> answers;
    Progress progress = out.progress(at);
    const auto fe = [&](const std::string& name, const models::ShaftMount* mount) {
      progress.update(static_cast<double>(answers.size()) / 11, name);
      LoadedPrediction a{.name = name};
      const auto watch = [&](const models::ImpactView& view) {
        if (view.shaft) a.hosel.add(*view.shaft, view.state);
        if (name == "club loaded") record(view);
      };
      a.launch = mount ? models::Impact(solve_.fe, *mount).run(blow, watch).launch
                       : models::Impact(solve_.fe).run(blow).launch;
      answers.push_back(std::move(a));
    };
    fe("free body", nullptr);
    models::ShaftMount mount = solve_.shaft_mount;
    mount.grip = Grip::clamped;  // a club at rest has no hands' wrench to go on with
    fe("club at rest", &mount);
    mount.grip = Grip::forced;
    if (weightless) {
      mount.loaded = weightless->shaft;
      fe("club loaded, no gravity", &mount);
    }
    mount.loaded = end.shaft;
    fe("club loaded", &mount);
    for (const auto& [name, grip] :
         {std::pair{"club loaded, clamped", Grip::clamped}, {"club loaded, free", Grip::free}}) {
      mount.grip = grip;
      fe(name, &mount);
    }
    // A joint's turn is the swing's: neither the hands' wrench alone nor a condensed shaft knows it.
    if (swing_.joint.gives()) return answers;
    mount.grip = Grip::forced;
    mount.loaded.reset();
    mount.load = end.hands;
    fe("club from delivery and hands", &mount);

    const auto reduced = [&](const std::string& name, const models::ImpactModel& model) {
      answers.push_back({.name = name, .launch = models::checked_launch(model, blow)});
    };
    reduced("volumetric", models::Volumetric(solve_.volumetric, solve_.volumetric_solution));
    models::ShaftImpedanceOptions translation = solve_.shaft_beam;
    translation.feels_rotation = false;
    reduced("shaft-coupled, translation",
            models::ShaftCoupled(solve_.volumetric, solve_.volumetric_solution, translation));
    reduced("shaft-coupled", models::ShaftCoupled(solve_.volumetric, solve_.volumetric_solution, solve_.shaft_beam));
    mount.load.reset();
    mount.loaded = end.shaft;
    reduced("shaft-coupled, loaded",
            models::ShaftCoupled(solve_.volumetric, solve_.volumetric_solution, solve_.shaft_beam, mount));
    return answers;
  }

  static std::string history(const LoadedPrediction& a) {
    std::string csv = "time_ms,force_x_N,force_y_N,force_z_N,moment_x_N_m,moment_y_N_m,moment_z_N_m\n";
    for (std::size_t i = 0; i < a.hosel.times.size(); ++i) {
      const fem::Wrench& w = a.hosel.loads[i];
      csv += fmt::format("{:.6f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", 1e3 * a.hosel.times[i], w.force.x(),
                         w.force.y(), w.force.z(), w.moment.x(), w.moment.y(), w.moment.z());
    }
    return csv;
  }
  /// Loaded: lines; at rest: points.
  static post::Panel panel(const LoadedPrediction& loaded, const LoadedPrediction& at_rest, const std::string& at,
                           bool force) {
    post::Panel p{.title = at + (force ? ": force of the shaft on the head" : ": its moment about the hosel"),
                  .x_label = "time [ms]",
                  .y_label = force ? "force, face axes [N]" : "moment, face axes [N m]"};
    for (const LoadedPrediction* a : {&loaded, &at_rest})
      for (int c = 0; c < 3; ++c) {
        post::Series s{.label = fmt::format("{}{}", "xyz"[c], a == &loaded ? ", loaded" : ", at rest"),
                       .style = a == &loaded ? "lines" : "points"};
        for (std::size_t i = 0; i < a->hosel.times.size(); ++i) {
          s.x.push_back(1e3 * a->hosel.times[i]);
          s.y.push_back((force ? a->hosel.loads[i].force : a->hosel.loads[i].moment)[c]);
        }
        p.series.push_back(std::move(s));
      }
    return p;
  }

  /// When a push along the shaft is back at the hosel from the grip [s].
  double axial_return() const {
    const Shaft& shaft = *blow_.club.shaft;
    double time = 0;
    for (std::size_t i = 1; i < shaft.stations.size(); ++i) {
      const double a = std::max(shaft.stations[i - 1].arc_length, swing_.grip_point), b = shaft.stations[i].arc_length;
      if (b <= a) continue;
      const ShaftStation s = shaft.at((a + b) / 2);
      time += 2 * (b - a) * std::sqrt(s.mass_per_length / s.axial_stiffness);
    }
    return time;
  }
  /// What a clamped or a free grip changes in the hosel's force against the forced one, along the shaft and across.
  post::Panel grip_panel(const std::vector<LoadedPrediction>& answers, const std::string& at, double back) const {
    post::Panel p{.title = fmt::format("{}: grip, push along the shaft back at {:.3f} ms", at, 1e3 * back),
                  .x_label = "time [ms]",
                  .y_label = "force at the hosel, change [N]"};
    const models::HoselHistory& forced = find(answers, "club loaded").hosel;
    const Vec3 axis = blow_.club.geometry.shaft_axis.normalized();
    for (const auto& [name, label] : {std::pair{"club loaded, clamped", "clamped"}, {"club loaded, free", "free"}}) {
      const models::HoselHistory& other = find(answers, name).hosel;
      post::Series along{.label = fmt::format("{}, along", label)}, across{.label = fmt::format("{}, across", label)};
      // The same steps as long as Newton made none shorter: compared by index only where the times agree.
      for (std::size_t i = 0; i < std::min(forced.times.size(), other.times.size()); ++i) {
        if (std::abs(forced.times[i] - other.times[i]) > 1e-12) break;
        const Vec3 f = other.loads[i].force - forced.loads[i].force;
        along.x.push_back(1e3 * forced.times[i]);
        along.y.push_back(f.dot(axis));
        across.x.push_back(1e3 * forced.times[i]);
        across.y.push_back((f - f.dot(axis) * axis).norm());
      }
      p.series.push_back(std::move(along));
      p.series.push_back(std::move(across));
    }
    return p;
  }

  Blow blow_;
  MotionInput motion_;
  models::SwingOptions swing_;
  models::Options solve_;
  std::vector<double> toe_, high_;
  std::optional<FlightSetup> flight_;
  post::RecorderOptions record_;
};

}  // namespace

std::unique_ptr<Job> read_loaded_club(CaseFile& file) { return std::make_unique<LoadedClubJob>(file); }

}  // namespace hosel::app
