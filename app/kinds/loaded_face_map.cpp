#include "app/kinds/loaded_face_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/check_memory.hpp"
#include "app/read_blow.hpp"
#include "app/read_face_map.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "app/read_swing.hpp"
#include "app/stop.hpp"
#include "app/stored_launch.hpp"
#include "app/sweep.hpp"
#include "models/checked_launch.hpp"
#include "models/club/swing_end.hpp"
#include "models/fe/impact.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "post/csv.hpp"
#include "post/face_map.hpp"
#include "post/figure.hpp"
#include "post/shaft_effect.hpp"
#include "post/vtk_series.hpp"

namespace hosel::app {
namespace {

using models::Grip;
using nlohmann::json;

/// How the head meets the ball: all with the velocity and rotation that the swing gives it.
enum Body : std::size_t { free_head, at_rest, preloaded, loaded };
constexpr std::array<const char*, 4> kClubs = {"free head", "club at rest", "club preloaded", "club loaded"};

/// What one club is minus another.
struct Part {
  const char* name;
  Body with, without;
};
constexpr std::array kParts = {Part{"shaft present", at_rest, free_head}, Part{"preload", preloaded, at_rest},
                               Part{"grip wrench", loaded, preloaded}, Part{"all", loaded, free_head}};
/// A condensed shaft knows the loaded club's acceleration, not who pushes.
constexpr std::array kReducedParts = {Part{"shaft present", at_rest, free_head},
                                      Part{"preload and wrench", loaded, at_rest}, Part{"all", loaded, free_head}};

constexpr std::array<std::string_view, 6> kShown = {"ball_speed", "launch_angle", "azimuth",
                                                    "backspin",   "sidespin",     "head_rotation"};
constexpr std::array<const char*, 4> kPlaces = {"centre", "heel", "toe", "mean"};

/// A swing and everything that its blow is computed with.
struct Setup {
  Club club;
  Ball ball;
  ContactLaw contact;
  MotionInput motion;
  models::SwingOptions swing;
  models::Options solve;
  std::unique_ptr<std::once_flag> once = std::make_unique<std::once_flag>();
  mutable models::SwingEnd end;  // set once, when it is asked for: a case that is only read swings no club
};

/// The maps of one setup: of each swing on the whole grid; finer, and under each assumption, at nine places.
struct LoadedLayer {
  std::size_t setup;
  Body body;
  bool whole;
};

struct Assumption {
  std::string name;
  std::vector<std::size_t> setups;  // one a swing
};

struct Named {
  std::string name;
  std::vector<std::string> set;
};

class LoadedFaceMapJob final : public PointJob {
 public:
  explicit LoadedFaceMapJob(CaseFile& file) {
    const BlowsBeside beside;
    const Settings s = read(file.root());
    grid_ = s.grid;
    claims_ = s.claims;
    reduced_ = s.reduced;
    std::vector<Named> there;
    for (const Named& swing : s.swings) {
      Setup setup = set_up(file, swing.set);
      if (!setup.motion.present) {
        missing_.push_back(swing.name + " (" + setup.motion.file.filename().string() + ")");
        continue;
      }
      setups_.push_back(std::move(setup));
      there.push_back(swing);
    }
    if (there.empty()) file.root().fail("swings", "no swing's motion is there");
    for (const Named& swing : there) swings_.push_back(swing.name);
    const auto again = [&](std::size_t swing, const std::vector<std::string>& set) {
      std::vector<std::string> all = there[swing].set;
      all.insert(all.end(), set.begin(), set.end());
      setups_.push_back(set_up(file, all));
      return setups_.size() - 1;
    };
    if (!s.refinement.empty()) refined_.push_back(again(0, s.refinement));
    for (const Named& a : s.assumptions) {
      assumptions_.push_back({a.name, {}});
      for (std::size_t k = 0; k < there.size(); ++k) assumptions_.back().setups.push_back(again(k, a.set));
    }
    const std::vector<std::size_t> nine = post::coarse_points(grid_);
    for (std::size_t i = 0; i < setups_.size(); ++i)
      for (const Body body : {free_head, at_rest, preloaded, loaded}) {
        if (reduced_ && body == preloaded) continue;
        layers_.push_back({i, body, i < swings_.size() && (s.split_everywhere || body == free_head || body == loaded)});
        if (layers_.back().whole)
          for (std::size_t p = 0; p < grid_.size(); ++p) work_.push_back({layers_.size() - 1, p});
        else
          for (const std::size_t p : nine) work_.push_back({layers_.size() - 1, p});
      }
  }

  std::size_t size() const override { return work_.size(); }

  json compute(std::size_t point, const std::filesystem::path&) const override {
    const LoadedLayer& layer = layers_[work_[point].layer];
    const Setup& s = setups_[layer.setup];
    const models::SwingEnd& end = swung(s);
    Blow blow{.delivery = end.delivery, .club = end.club, .ball = s.ball, .contact = s.contact};
    blow.delivery.impact_toe = grid_.toe_at(work_[point].place);
    blow.delivery.impact_high = grid_.high_at(work_[point].place);
    models::turn_place(end.lie, blow.delivery);
    return stored(reduced_ ? by_overlap(s, layer.body, blow) : by_elements(s, layer.body, blow));
  }

  void report(Output& out, const std::vector<json>& points) const override {
    for (const std::string& name : missing_) out.say("left out, since its recording is not there: " + name);
    const std::vector<std::array<post::FaceMap, 4>> maps = gather(points);
    json summary;
    for (std::size_t k = 0; k < swings_.size(); ++k) tell_swing(out, k, summary);
    write_maps(out, maps);
    summary["left_out"] = missing_;
    out.say(fmt::format("\n{:<18} {:<21} {:<7} {:>10} {:>22} {:>10} {:>22}", "part", "", "", "mean", "over the swings",
                        "numerics", "assumptions add"));
    for (const Part& part : parts()) tell_part(out, maps, part, summary["parts"][part.name]);
    draw(out, maps);
    tell_statements(out, maps, summary);
    out.write_summary(summary);
  }

 private:
  struct Settings {
    post::FaceGrid grid;
    bool reduced = false, split_everywhere = true;
    std::vector<Named> swings, assumptions;
    std::vector<std::string> refinement;
    std::vector<post::Claim> claims;
    Setup setup;
  };

  /// Every key that a map of loaded clubs knows.
  static Settings read(Table root) {
    Settings s;
    s.grid = read_face_grid(root);
    s.reduced = root.choice({"model", "of ball and shaft: finite elements, or overlap volume and a condensed shaft"},
                            {"finite-element", "reduced"}, "finite-element") == "reduced";
    s.split_everywhere = root.choice({"split_at",
                                      "where the effect is taken apart: at every point of the grid, or at its "
                                      "corners, edge middles and centre alone"},
                                     {"grid", "nine-places"}, "grid") == "grid";
    std::vector<std::string> swings, assumptions;
    for (Table t : root.tables("swings"))
      s.swings.push_back({t.name({"name", "of the swing"}, swings),
                          t.texts({"set", "keys that make it this swing, table.key=value"})});
    if (s.swings.empty()) root.fail("swings", "name at least one swing in [[swings]]");
    for (Table t : root.tables("assumptions"))
      s.assumptions.push_back({t.name({"name", "of what else may be true"}, assumptions),
                               t.texts({"set", "keys that it changes, table.key=value"})});
    if (auto r = root.optional_table("refinement"))
      s.refinement = r->texts({"set", "keys that refine the numerics, table.key=value"});
    s.claims = read_statements(root, post::shaft_effect_names());
    Setup& setup = s.setup;
    setup.club.shaft = read_shaft(root.table("shaft"));
    setup.club.head = read_head(root.table("head"));
    setup.club.geometry =
        read_club_geometry(root, root.table("head").has("name") || !root.table("hosel").keys().empty());
    if (auto ball = root.optional_table("ball")) setup.ball = read_ball(*ball);
    setup.motion = read_motion(root.table("motion"));
    setup.swing = read_swing_options(root);
    if (setup.swing.joint.kind == models::HeadJoint::Kind::none) root.fail("joint", "a blow needs a head on the shaft");
    if (s.reduced && setup.swing.joint.gives())
      root.fail("joint", "a condensed shaft does not know how far the swing turns a joint: model = \"finite-element\"");
    Blow blow;
    setup.solve = read_options(root, {s.reduced ? "volumetric" : "fe-free-body"}, blow);
    setup.club.head.compliance = blow.club.head.compliance;
    setup.contact = blow.contact;
    models::ShaftMount& mount = setup.solve.shaft_mount;
    mount.elements = setup.swing.elements;
    mount.growth = setup.swing.growth;
    mount.shear = setup.swing.shear;
    mount.grip_point = setup.swing.grip_point;
    mount.joint = setup.swing.joint;
    return s;
  }

  /// The case with these keys changed.
  Setup set_up(const CaseFile& file, const std::vector<std::string>& set) {
    std::vector<std::string> overrides = file.overrides();
    overrides.insert(overrides.end(), set.begin(), set.end());
    CaseFile again(file, overrides);
    Table root = again.root();
    root.text({"kind", "what the case does (`hosel list`)"});
    root.text({"title", "of tables, pages and figures"}, "");
    Settings s = read(root);
    again.finish();
    return std::move(s.setup);
  }

  static const models::SwingEnd& swung(const Setup& s) {
    std::call_once(*s.once, [&] {
      const models::GripMotion grip(s.motion.track, s.motion.smoothing);
      s.end = models::swing_end(
          s.club, s.swing, [&](double t) { return grip.at(t); }, s.motion.begin, s.motion.end);
    });
    return s.end;
  }

  static Launch by_elements(const Setup& s, Body club, const Blow& blow) {
    const StopSignals stop;
    const auto watch = [&](const models::ImpactView&) { stop.check(); };
    if (club == free_head) return models::Impact(s.solve.fe).run(blow, watch).launch;
    models::ShaftMount mount = s.solve.shaft_mount;
    mount.grip = club == loaded ? Grip::forced : Grip::clamped;
    if (club != at_rest) mount.loaded = s.end.shaft;
    return models::Impact(s.solve.fe, mount).run(blow, watch).launch;
  }

  static Launch by_overlap(const Setup& s, Body club, const Blow& blow) {
    if (club == free_head)
      return models::checked_launch(models::Volumetric(s.solve.volumetric, s.solve.volumetric_solution), blow);
    models::ShaftMount mount = s.solve.shaft_mount;
    if (club == loaded) mount.loaded = s.end.shaft;
    return models::checked_launch(
        models::ShaftCoupled(s.solve.volumetric, s.solve.volumetric_solution, s.solve.shaft_beam, mount), blow);
  }

  std::vector<Part> parts() const {
    return reduced_ ? std::vector<Part>(kReducedParts.begin(), kReducedParts.end())
                    : std::vector<Part>(kParts.begin(), kParts.end());
  }

  /// The maps of every setup; of swings over the grid, of the others over nine places.
  std::vector<std::array<post::FaceMap, 4>> gather(const std::vector<json>& points) const {
    std::vector<std::array<post::FaceMap, 4>> out(setups_.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const LoadedLayer& layer = layers_[work_[i].layer];
      out[layer.setup][layer.body].launches.push_back(launch_from(points[i]));
    }
    for (std::size_t k = 0; k < out.size(); ++k)
      for (std::size_t c = 0; c < kClubs.size(); ++c)
        out[k][c].title = k < swings_.size() ? fmt::format("{}, {}", swings_[k], kClubs[c]) : "";
    return out;
  }

  void tell_swing(Output& out, std::size_t k, json& summary) const {
    const models::SwingEnd& end = swung(setups_[k]);
    const Delivery& d = end.delivery;
    out.say(fmt::format(
        "{}: {:.2f} m/s, attack {:.2f} deg, path {:.2f} deg, loft {:.2f} deg, face {:.2f} deg; lead {:.1f} mm, droop "
        "{:.1f} mm; hands {:.0f} N, {:.1f} N m",
        swings_[k], d.club_speed, degrees(d.attack_angle), degrees(d.club_path), degrees(d.dynamic_loft),
        degrees(d.face_angle), 1e3 * end.lead, 1e3 * end.droop, end.shaft.grip.force.norm(),
        end.shaft.grip.moment.norm()));
    const double turn = d.head_angular_velocity.norm();
    summary["swings"].push_back({{"name", swings_[k]},
                                 {"club_speed_mps", d.club_speed},
                                 {"attack_angle_deg", degrees(d.attack_angle)},
                                 {"club_path_deg", degrees(d.club_path)},
                                 {"dynamic_loft_deg", degrees(d.dynamic_loft)},
                                 {"face_angle_deg", degrees(d.face_angle)},
                                 {"dynamic_lie_deg", degrees(end.lie)},
                                 {"head_rotation_rad_per_s", turn},
                                 {"lead_mm", 1e3 * end.lead},
                                 {"droop_mm", 1e3 * end.droop},
                                 {"hands_force_N", end.shaft.grip.force.norm()},
                                 {"hands_moment_N_m", end.shaft.grip.moment.norm()}});
  }

  void write_maps(Output& out, const std::vector<std::array<post::FaceMap, 4>>& maps) const {
    std::vector<post::FaceMap> all;
    for (std::size_t k = 0; k < swings_.size(); ++k) {
      std::vector<post::FaceMap> own;
      post::References against;
      for (const post::FaceMap& m : maps[k])
        if (m.launches.size() == grid_.size()) {
          against.push_back(own.empty() ? std::nullopt : std::optional(std::size_t(0)));
          own.push_back(m);
        }
      post::VtkSeries(out.directory() / "vtk", fmt::format("face-{}", k + 1), post::VtkSeries::Form::surface)
          .write(0, post::face_map_mesh(setups_[k].club.head.face, grid_, own, against));
      all.insert(all.end(), own.begin(), own.end());
    }
    out.write("face_maps.csv", post::face_map_csv(grid_, all));
    std::string csv = "part,impact_toe_mm,impact_high_mm";
    for (const post::MapQuantity* q : shown(maps))
      csv += fmt::format(",{0}_{1}_mean,{0}_{1}_low,{0}_{1}_high", q->name, q->unit);
    csv += '\n';
    for (const Part& part : parts()) {
      const post::FaceGrid grid = grid_of(maps, part);
      for (std::size_t p = 0; p < grid.size(); ++p) {
        csv += fmt::format("{},{:.6g},{:.6g}", part.name, 1e3 * grid.toe_at(p), 1e3 * grid.high_at(p));
        for (const post::MapQuantity* q : shown(maps)) {
          const Band b = over_swings(maps, part, *q, [&](const std::vector<double>& v) { return v[p]; });
          csv += fmt::format(",{:.9g},{:.9g},{:.9g}", b.mean, b.low, b.high);
        }
        csv += '\n';
      }
    }
    out.write("parts.csv", csv);
  }

  static std::vector<const post::MapQuantity*> shown(const std::vector<std::array<post::FaceMap, 4>>& maps) {
    std::vector<const post::MapQuantity*> out;
    for (const post::MapQuantity& q : post::map_quantities(maps.front().front()))
      if (std::ranges::find(kShown, q.name) != kShown.end()) out.push_back(&q);
    return out;
  }
  static std::string words(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
  }
  static std::string unit_text(const post::MapQuantity& q) {
    return q.unit == "mps" ? "m/s" : q.unit == "rad_per_s" ? "rad/s" : q.unit;
  }

  /// A part's difference map, over the grid or at the nine places.
  std::vector<double> field(const std::vector<std::array<post::FaceMap, 4>>& maps, std::size_t setup, const Part& part,
                            const post::MapQuantity& q, bool nine) const {
    const auto on = [&](Body body) {
      const post::FaceMap& m = maps[setup][body];
      return nine && m.launches.size() == grid_.size() ? post::coarse(grid_, m) : m;
    };
    return post::differences(on(part.with), on(part.without), q);
  }
  post::FaceGrid grid_of(const std::vector<std::array<post::FaceMap, 4>>& maps, const Part& part) const {
    const bool whole = maps[0][part.with].launches.size() == grid_.size() &&
                       maps[0][part.without].launches.size() == grid_.size();
    return whole ? grid_ : post::coarse(grid_);
  }

  struct Band {
    double mean = 0, low = INFINITY, high = -INFINITY;
  };
  /// Of a number of each swing's difference map.
  template <class Number>
  Band over_swings(const std::vector<std::array<post::FaceMap, 4>>& maps, const Part& part, const post::MapQuantity& q,
                   const Number& number) const {
    const bool nine = grid_of(maps, part).size() < grid_.size();
    Band b;
    for (std::size_t k = 0; k < swings_.size(); ++k) {
      const double x = number(field(maps, k, part, q, nine));
      b.mean += x / double(swings_.size());
      b.low = std::min(b.low, x);
      b.high = std::max(b.high, x);
    }
    return b;
  }

  /// A place's number of a field over the nine: rows from low to high, each from heel to toe.
  static double of_nine(const std::vector<double>& v, std::size_t place) {
    if (place < 3) return v[std::array{4, 3, 5}[place]];
    double sum = 0;
    for (const double x : v) sum += x / double(v.size());
    return sum;
  }
  double of_grid(const std::vector<double>& v, std::size_t place) const {
    if (v.size() < grid_.size() || place == 3) return of_nine(v, place);
    return v[post::coarse_points(grid_)[std::array{4UL, 3UL, 5UL}[place]]];
  }

  /// What other setups of the first swings make of a place's number, against those swings' own.
  Band change(const std::vector<std::array<post::FaceMap, 4>>& maps, const std::vector<std::size_t>& others,
              const Part& part, const post::MapQuantity& q, std::size_t place) const {
    Band b;
    for (std::size_t k = 0; k < others.size(); ++k) {
      const auto number = [&](std::size_t setup) { return of_nine(field(maps, setup, part, q, true), place); };
      const double x = number(others[k]) - number(k);
      b.mean += x / double(others.size());
      b.low = std::min(b.low, x);
      b.high = std::max(b.high, x);
    }
    return b;
  }

  /// What all assumptions together make of it at most, down and up.
  Band assumed(const std::vector<std::array<post::FaceMap, 4>>& maps, const Part& part, const post::MapQuantity& q,
               std::size_t place) const {
    Band all{.low = 0, .high = 0};
    for (const Assumption& a : assumptions_) {
      const Band e = change(maps, a.setups, part, q, place);
      all.low = std::min(all.low, e.low);
      all.high = std::max(all.high, e.high);
    }
    return all;
  }

  void tell_part(Output& out, const std::vector<std::array<post::FaceMap, 4>>& maps, const Part& part,
                 json& said) const {
    post::TextTable table{{{"", "place", "mean", "over the swings", "numerics", "over the assumptions"}}};
    for (const post::MapQuantity* q : shown(maps))
      for (std::size_t place = 0; place < kPlaces.size(); ++place) {
        const Band b = over_swings(maps, part, *q, [&](const std::vector<double>& v) { return of_grid(v, place); });
        json& j = said[fmt::format("{}_{}", q->name, q->unit)][kPlaces[place]];
        j = {{"mean", b.mean}, {"swings", {b.low, b.high}}};
        std::string numerics = "-", assumption = "-";
        if (!refined_.empty()) {
          const double error = std::abs(change(maps, refined_, part, *q, place).mean);
          j["numerical_error"] = error;
          numerics = fmt::format("{:.2g}", error);
        }
        for (const Assumption& a : assumptions_) {
          const Band e = change(maps, a.setups, part, *q, place);
          j["assumptions"][a.name] = {e.low, e.high};
        }
        if (!assumptions_.empty()) {
          const Band all = assumed(maps, part, *q, place);
          assumption = fmt::format("{:+.3g} to {:+.3g}", all.low, all.high);
        }
        const std::string range = fmt::format("{:+.4g} to {:+.4g}", b.low, b.high);
        table.rows.push_back({fmt::format("{} [{}]", words(q->name), unit_text(*q)), kPlaces[place],
                              fmt::format("{:+.4g}", b.mean), range, numerics, assumption});
        if (place == 0 && std::string_view(part.name) == parts().back().name)
          out.page().answer(fmt::format("{}, {}", words(q->name), kPlaces[place]),
                            fmt::format("{:+.3g} {}", b.mean, unit_text(*q)), range + " over the swings");
        out.say(fmt::format("{:<18} {:<21} {:<7} {:>+10.4g} {:>22} {:>10} {:>22}",
                            q == shown(maps).front() && place == 0 ? part.name : "",
                            place == 0 ? fmt::format("{} [{}]", words(q->name), unit_text(*q)) : "", kPlaces[place],
                            b.mean, range, numerics, assumption));
      }
    out.page().section(fmt::format("What the loaded club changes: {}", part.name), table.html());
  }

  void draw(Output& out, const std::vector<std::array<post::FaceMap, 4>>& maps) const {
    static constexpr std::array<std::string_view, 4> kDrawn = {"ball_speed", "backspin", "sidespin", "head_rotation"};
    const std::string swings = swings_.size() == 1 ? swings_.front() : fmt::format("mean of {} swings", swings_.size());
    post::Figure figure{
        .title = fmt::format("what the club of a swing changes, part by part ({}); {}", swings, post::kFaceView),
        .columns = int(kDrawn.size()),
        .panel_width = 400,
        .panel_height = 215};
    post::Figure along{.title = "along the middle of the face; bars: from swing to swing",
                       .columns = 2,
                       .panel_width = 560,
                       .panel_height = 330};
    for (const Part& part : parts())
      for (const post::MapQuantity* q : shown(maps)) {
        if (std::ranges::find(kDrawn, q->name) == kDrawn.end()) continue;
        std::vector<double> mean;
        const post::FaceGrid grid = grid_of(maps, part);
        for (std::size_t p = 0; p < grid.size(); ++p)
          mean.push_back(over_swings(maps, part, *q, [&](const std::vector<double>& v) { return v[p]; }).mean);
        figure.panels.push_back(post::face_panel(grid, mean, fmt::format("{}: {}", part.name, words(q->name)),
                                                 fmt::format("[{}]", unit_text(*q)), true));
        figure.panels.back().on_page = part.with == loaded && part.without == free_head;  // the sum of the others
      }
    for (const post::MapQuantity* q : shown(maps)) {
      if (std::ranges::find(kDrawn, q->name) == kDrawn.end()) continue;
      post::Panel panel{.x_label = "heel  <-  impact toe [mm]  ->  toe",
                        .y_label = fmt::format("change of {} [{}]", words(q->name), unit_text(*q))};
      for (const Part& part : parts()) {
        post::Series s{.label = part.name, .style = "linespoints"};
        const post::FaceGrid grid = grid_of(maps, part);
        for (int i = 0; i < grid.columns; ++i) {
          const std::size_t p = std::size_t(grid.rows / 2 * grid.columns + i);
          const Band b = over_swings(maps, part, *q, [&](const std::vector<double>& v) { return v[p]; });
          s.x.push_back(1e3 * grid.toe(i));
          s.y.push_back((b.low + b.high) / 2);
          s.error.push_back((b.high - b.low) / 2);
        }
        panel.series.push_back(std::move(s));
      }
      if (!assumptions_.empty()) panel.series.push_back(assumption_bars(maps, *q));
      along.panels.push_back(std::move(panel));
    }
    out.draw(figure, "figures/parts");
    out.draw(along, "figures/along");
  }

  /// How far the whole effect goes under the assumptions, at heel, centre and toe; a little beside them, to be seen.
  post::Series assumption_bars(const std::vector<std::array<post::FaceMap, 4>>& maps,
                               const post::MapQuantity& q) const {
    post::Series s{.label = "all, by assumption", .style = "points"};
    const Part all = parts().back();
    const double half = 500 * grid_.width;
    for (const auto& [place, x] : {std::pair{1UL, -half}, {0UL, 0.0}, {2UL, half}}) {
      const Band b = over_swings(maps, all, q, [&](const std::vector<double>& v) { return of_grid(v, place); });
      const Band more = assumed(maps, all, q, place);
      s.x.push_back(x + 1.5);
      s.y.push_back(b.mean + (more.low + more.high) / 2);
      s.error.push_back((more.high - more.low) / 2);
    }
    return s;
  }

  /// Each statement, swing by swing.
  void tell_statements(Output& out, const std::vector<std::array<post::FaceMap, 4>>& maps, json& summary) const {
    if (claims_.empty()) return;
    std::vector<std::vector<post::NamedFigure>> figures;
    for (std::size_t k = 0; k < swings_.size(); ++k) {
      const auto whole = [&](const post::FaceMap& m) {
        return m.launches.size() == grid_.size() &&
               std::ranges::all_of(m.launches, [](const auto& l) { return l.has_value(); });
      };
      if (!whole(maps[k][free_head]) || !whole(maps[k][loaded])) return;
      figures.push_back({post::shaft_effect(grid_, maps[k][loaded], maps[k][free_head])});
      for (const post::NamedFigure& f : figures.back()) summary["swings"][k]["all"][f.name] = f.value;
    }
    out.say("\nstatements about the loaded club against the free head, and in how many of the swings they hold");
    post::TextTable borne{{{"published statement", "swings in which it holds"}}};
    for (const post::Claim& claim : claims_) {
      const auto holds = std::ranges::count_if(figures, [&](const auto& f) { return claim.holds(f); });
      out.say(fmt::format("  {} of {}  {}", holds, swings_.size(), claim.text));
      borne.rows.push_back({claim.text, fmt::format("{} of {}", holds, swings_.size())});
      summary["statements"].push_back({{"text", claim.text}, {"swings", holds}});
    }
    out.page().section("Published statements borne out here", borne.html());
  }

  struct Work {
    std::size_t layer, place;
  };
  post::FaceGrid grid_;
  bool reduced_ = false;
  std::vector<std::string> swings_, missing_;
  std::vector<post::Claim> claims_;
  std::vector<Setup> setups_;            // the swings, then
  std::vector<std::size_t> refined_;     // the first one on finer numerics, and
  std::vector<Assumption> assumptions_;  // each under each assumption
  std::vector<LoadedLayer> layers_;
  std::vector<Work> work_;
};

}  // namespace

std::unique_ptr<Job> read_loaded_face_map(CaseFile& file) { return std::make_unique<LoadedFaceMapJob>(file); }

}  // namespace hosel::app
