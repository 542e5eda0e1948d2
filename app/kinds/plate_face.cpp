#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/check_memory.hpp"
#include "app/read_blow.hpp"
#include "app/read_face.hpp"
#include "app/read_options.hpp"
#include "app/solution_doubts.hpp"
#include "app/stop.hpp"
#include "app/stored_launch.hpp"
#include "app/sweep.hpp"
#include "golf/parallel.hpp"
#include "golf/units.hpp"
#include "models/checked_launch.hpp"
#include "models/fe/impact.hpp"
#include "models/fe/plate_strike.hpp"
#include "post/digits.hpp"
#include "post/face_map.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"
#include "post/table.hpp"
#include "post/vtk_series.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

using Eigen::Vector2d;
using nlohmann::json;

constexpr double kRulesTime = 239e-6, kRulesTolerance = 18e-6;  // of the rules' pendulum [s]
constexpr std::size_t kModes = 6;                               // in tables and pictures

/// Whether a head and its face are their own mirror image from heel to toe.
bool heel_toe_alike(const Head& head, const models::PlateDesign& face) {
  return face.heel_toe_alike() && head.cg.y() == 0 && head.inertia(0, 1) == 0 && head.inertia(1, 2) == 0;
}

bool heel_toe_alike(const Delivery& d) {
  return d.face_angle == 0 && d.club_path == 0 && d.head_angular_velocity.x() == 0 && d.head_angular_velocity.z() == 0;
}

/// By the plane of target and vertical: velocities change their side, spins about axes in the plane their sense.
Launch mirrored(Launch launch) {
  for (Vec3* velocity : {&launch.velocity, &launch.head_velocity}) velocity->y() *= -1;
  for (Vec3* spin : {&launch.spin, &launch.head_spin}) *spin = Vec3(-spin->x(), spin->y(), -spin->z());
  return launch;
}

class PlateFaceJob final : public PointJob {
 public:
  explicit PlateFaceJob(CaseFile& file) {
    const BlowsBeside beside;
    Table root = file.root();
    if (!has_plate(root)) root.table("face").fail("", "a face with a thickness is needed: [face.plate]");
    blow_ = read_blow(root, {"fe-free-body"});
    const models::Options options = read_options(root, {"fe-free-body"}, blow_);
    fe_ = options.fe;
    plate_ = options.plate;
    if (blow_.delivery.impact_toe != 0 || blow_.delivery.impact_high != 0)
      root.fail("delivery", "[places] says where the ball meets the face: impact_toe and impact_high stay out");
    Table places = root.default_table("places");
    toe_ = places.quantities({"toe", "columns of the places where a ball is struck, towards the toe"}, "mm", 0,
                             limits::impact_place, std::vector{-0.018, 0.0, 0.018});
    high_ = places.quantities({"high", "rows of the places where a ball is struck, up the face"}, "mm", 0,
                              limits::impact_place, std::vector{-0.009, 0.0, 0.009});
    if (toe_.empty() || high_.empty()) places.fail(toe_.empty() ? "toe" : "high", "name at least one place");
    grid_ = read_face_grid(root);
    if (!any_of_grid_on(plate_->design().outline)) {
      const Vector2d reach = plate_->design().outline.extent();
      root.fail("grid", fmt::format("none of the {} x {} places over {:g} x {:g} mm lies on the face (allowed: a grid "
                                    "with a place on it; it reaches {:g} mm aside and {:g} mm up, and odd numbers of "
                                    "columns and rows have its centre)",
                                    grid_.columns, grid_.rows, 1e3 * grid_.width, 1e3 * grid_.height, 1e3 * reach.x(),
                                    1e3 * reach.y()));
    }
    Table sphere = root.default_table("sphere");
    sphere_ = models::steel_sphere(sphere.quantity({"radius", "of the pendulum's sphere"}, "mm", {1e-3, 0.1}, 0.011));
    speeds_ = sphere.quantities({"speeds", "of the sphere"}, "mps", 0, {0.01, 20}, models::pendulum_speeds());
    if (speeds_.size() < 2) sphere.fail("speeds", "a line needs two speeds");
    restitution_speed_ =
        root.quantity({"restitution_speed", "at which the ball's restitution is computed"}, "mps", {1, 100}, 48.77);
    errors_ = root.flag({"numerical_error",
                         "solve one place twice more, the face's centre where it is among [places], else the first: "
                         "coarser, and with more modes"},
                        true);
    vtk_ = root.flag({"vtk", "write the modes for ParaView"}, true);
    draw_ = root.flag({"figures", "draw pictures; a study of many faces may do without"}, true);
    alike_ = heel_toe_alike(blow_.club.head, plate_->design());
    for (const double high : high_)
      for (const double toe : toe_) {
        const Vector2d place(-toe, high), image(toe, high);
        const auto twin = std::ranges::find(blows_, image, &Struck::place);
        const bool known = alike_ && heel_toe_alike(blow_.delivery) && toe != 0 && twin != blows_.end();
        places_.push_back({place, known ? std::size_t(twin - blows_.begin()) : blows_.size(), known});
        if (!known) blows_.push_back({place, fe_});
      }
    if (const auto at = std::ranges::find_if(places_, [](const Place& p) { return p.at.isZero(0); });
        at != places_.end())
      centre_ = std::size_t(at - places_.begin());
    companions_ = blows_.size();
    if (!errors_) return;
    const Vector2d at = places_[again()].at;
    if (const auto coarser = fe_.coarser()) blows_.push_back({at, *coarser, "coarser"});
    models::PlateDesign more = plate_->design();
    more.modes = std::min(27, 2 * more.modes);
    blows_.push_back({at, fe_, "more modes"});
    blows_.back().fe.face = std::make_shared<const models::PlateOnDemand>(more);
  }

  std::size_t size() const override { return blows_.size(); }

  json compute(std::size_t point, const std::filesystem::path&) const override {
    const Struck& struck = blows_[point];
    Blow blow = blow_;
    blow.delivery.impact_toe = -struck.place.x();
    blow.delivery.impact_high = struck.place.y();
    models::FaceStress stress;
    const StopSignals stop;
    const models::FeOutcome outcome = models::Impact(struck.fe).run(blow, [&](const models::ImpactView& v) {
      stop.check();
      stress.see(v);
    });
    models::check_launch(models::Impact(struck.fe), blow, outcome.launch);
    json out = stored(outcome.launch);
    const models::FacePeak& peak = stress.peak().value();
    out["peak_stress_Pa"] = peak.stress;
    out["peak_stress_toe_m"] = -peak.place.x();
    out["peak_stress_high_m"] = peak.place.y();
    out["face_travel_m"] = outcome.result.face_travel;
    out["face_energy_J"] = outcome.result.face_energy;
    out["closure"] = outcome.result.ledger.closure / outcome.result.ledger.initial;
    for (const SolutionDoubt& d : solution_doubts(blow, outcome))
      out["doubts"].push_back({{"what", d.what}, {"value", d.value}, {"sentence", d.sentence()}});
    return out;
  }

  void report(Output& out, const std::vector<json>& points) const override {
    const std::shared_ptr<const models::PlateFace> plate = plate_->on(blow_.club.head.face);
    const models::PlateStrike strike(plate, blow_.club.head);
    json summary;
    doubt_places(out);
    doubt_solutions(out, points);
    show_maps(out, strike, summary);
    show_plate(out, *plate, summary);
    show_blows(out, points, summary);
    if (vtk_) write_modes(out, *plate);
    out.write_summary(summary);
  }

 private:
  /// Places beside the plate: one doubt, with the place farthest out.
  void doubt_places(Output& out) const {
    const mesh::PlateOutline& outline = plate_->design().outline;
    const Vector2d reach = outline.extent();
    std::size_t off = 0;
    Vector2d worst = Vector2d::Zero();
    for (const Place& place : places_) {
      if (outline.share(place.at) < 1) continue;
      ++off;
      if (place.at.norm() > worst.norm()) worst = place.at;
    }
    if (off > 0)
      out.warn(fmt::format(
          "the ball is struck off the face, which reaches {:g} mm aside and {:g} mm up, at {} of {}. "
          "The farthest: {:g} mm towards the {} and {:g} mm {}",
          1e3 * reach.x(), 1e3 * reach.y(), off, post::counted(places_.size(), "place"), 1e3 * std::abs(worst.x()),
          worst.x() > 0 ? "heel" : "toe", 1e3 * std::abs(worst.y()), worst.y() < 0 ? "down" : "up"));
  }

  /// What the blows of the places doubt of their solutions: a sentence of a kind, with the worst of them.
  void doubt_solutions(Output& out, const std::vector<json>& points) const {
    std::vector<WorstDoubt> kinds;
    for (std::size_t i = 0; i < companions_; ++i)
      for (const json& d : points[i].value("doubts", json::array()))
        note_doubt(kinds, d["what"], i, d["value"], d["sentence"]);
    for (const WorstDoubt& w : kinds)
      out.warn(fmt::format("{} of {}; the worst, at toe {:g}, high {:g} mm: {}", w.count,
                           post::counted(companions_, "blow"), -1e3 * blows_[w.blow].place.x() + 0.0,
                           1e3 * blows_[w.blow].place.y() + 0.0, w.sentence));
  }

  struct Struck {
    Vector2d place;
    models::FeImpactOptions fe;
    std::string companion = {};  ///< empty: a place of the case
  };

  /// A place of the case, and the blow that answers there.
  struct Place {
    Vector2d at;
    std::size_t blow;
    bool image;  ///< the blow is at the mirrored place
  };

  /// The place that is solved again for its numerical errors.
  std::size_t again() const { return centre_.value_or(0); }

  bool any_of_grid_on(const mesh::PlateOutline& outline) const {
    for (std::size_t i = 0; i < grid_.size(); ++i)
      if (outline.share({-grid_.toe_at(i), grid_.high_at(i)}) < 1) return true;
    return false;
  }

  static std::optional<Launch> launch_at(const Place& place, const std::vector<json>& points) {
    const auto launch = launch_from(points[place.blow]);
    return launch && place.image ? mirrored(*launch) : launch;
  }

  void show_plate(Output& out, const models::PlateFace& plate, json& summary) const {
    const double f1 = plate.omega().front() / (2 * kPi);
    out.say(fmt::format("face {:.1f} g; first frequencies {:.0f}, {:.0f}, {:.0f} Hz with the rim in a head at rest",
                        1e3 * plate.mass(), f1, plate.omega()[1] / (2 * kPi), plate.omega()[2] / (2 * kPi)));
    post::Table table{{{"mode"}, {"frequency_Hz", "{:.4f}"}}};
    for (std::size_t i = 0; i < plate.omega().size(); ++i) {
      const double f = plate.omega()[i] / (2 * kPi);
      table.add(i + 1, f);
      if (i < kModes) summary["frequencies_Hz"].push_back(f);
    }
    out.write("modes.csv", table.csv());
    out.page().answer("first frequency", fmt::format("{:.0f} Hz", f1), "rim in a head at rest");
    // The lumped face that stands for it: as stiff at the centre, and as heavy in that static shape.
    const fem::Vector load = plate.patch_load(Vector2d::Zero(), models::kBallPatch), w = plate.solve(load);
    const double compliance = load.dot(w);
    double mass = 0;
    for (const auto& s : plate.plate().samples()) {
      double deflection = 0;
      for (int k = 0; k < 9; ++k)
        deflection += s.shape[k] *
                      plate.plate().value(w, plate.plate().mesh().elements[std::size_t(s.element)][std::size_t(k)],
                                          fem::Plate::kDeflection);
      mass += s.mass * std::pow(deflection / compliance, 2);
    }
    out.say(fmt::format("as a lumped face: {:.2f} MN/m and {:.1f} g at its centre", 1e-6 / compliance, 1e3 * mass));
    summary["face_mass_g"] = 1e3 * plate.mass();
    summary["lumped"] = {{"stiffness_N_per_m", 1 / compliance}, {"effective_mass_g", 1e3 * mass}};

    if (!draw_) return;
    post::Figure figure{.title = std::string("natural modes; ") + post::kFaceView,
                        .columns = 3,
                        .panel_width = 520,
                        .panel_height = 330};
    const post::FaceGrid fine = drawn(61, 41);
    for (std::size_t m = 0; m < std::min(kModes, plate.omega().size()); ++m) {
      std::vector<double> values;
      for (std::size_t i = 0; i < fine.size(); ++i) {
        const Vector2d at(-fine.toe_at(i), fine.high_at(i));
        values.push_back(plate.covers(at) ? plate.plate().deflection(plate.modes().col(Eigen::Index(m)), at)
                                          : std::nan(""));
      }
      double most = 0;
      for (const double v : values)
        if (std::isfinite(v)) most = std::max(most, std::abs(v));
      for (double& v : values) v /= most;
      figure.panels.push_back(post::face_panel(fine, values,
                                               fmt::format("mode {}, {:.0f} Hz{}", m + 1, plate.omega()[m] / (2 * kPi),
                                                           in_plane(plate, m) ? ", in its plane" : ""),
                                               "[-]", true));
      figure.panels.back().map_contours = false;
    }
    out.draw(figure, "modes");
  }

  /// Whether a mode moves the face in its plane more than across it.
  static bool in_plane(const models::PlateFace& face, std::size_t mode) {
    const Eigen::VectorXd shape = face.modes().col(Eigen::Index(mode));
    double across = 0, along = 0;
    for (std::size_t n = 0; n < face.plate().mesh().nodes.size(); ++n) {
      const auto value = [&](fem::Plate::Unknown u) { return face.plate().value(shape, int(n), u); };
      across = std::max(across, std::abs(value(fem::Plate::kDeflection)));
      along = std::max(along, std::hypot(value(fem::Plate::kStretchY), value(fem::Plate::kStretchZ)));
    }
    return along > across;
  }

  /// A grid over the whole outline.
  post::FaceGrid drawn(int columns, int rows) const {
    const Vector2d extent = plate_->design().outline.extent();
    return {2 * extent.x(), 2 * extent.y(), columns, rows};
  }

  void show_maps(Output& out, const models::PlateStrike& strike, json& summary) const {
    struct Point {
      double time = std::nan(""), departure = 0, restitution = std::nan(""), mass = 0, thickness = std::nan("");
    };
    std::vector<Point> points(grid_.size());
    const models::Striker ball = models::golf_ball(blow_.ball);
    const models::PlateFace& plate = strike.plate();
    const auto columns = std::size_t(grid_.columns);
    const auto image = [&](std::size_t i) { return i - i % columns + (columns - 1 - i % columns); };
    for_all_alone(std::size_t{0}, points.size(), [&](std::size_t i) {
      const Vector2d at(-grid_.toe_at(i), grid_.high_at(i));
      if (!plate.covers(at) || (alike_ && image(i) < i)) return;
      const auto ct = characteristic_time(strike, at);
      const auto place = strike.at(at, models::kBallPatch);
      points[i] = {ct ? ct->time : std::nan(""), ct ? ct->departure : std::nan(""),
                   strike.strike(ball, place, restitution_speed_).restitution, place.mass,
                   2 * models::pendulum_patch(plate, at)};
    });
    if (alike_)
      for (std::size_t i = 0; i < points.size(); ++i)
        if (image(i) < i) points[i] = points[image(i)];
    post::Table table;
    table.in_files({"toe_mm", "high_mm"}, "{:g}").in_files({"thickness_mm"}, "{:.4f}");
    table.in_files({"characteristic_time_us", "departure_us"}, "{:.3f}");
    table.in_files({"restitution", "head_mass_kg", "ball_speed_ratio"}, "{:.5f}");
    std::vector<double> time, restitution, ratio, thickness;
    double longest = 0, fastest = 0, departure = 0;
    Vector2d slowest = Vector2d::Zero();
    std::size_t beyond = 0, inside = 0, without = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point& p = points[i];
      time.push_back(1e6 * p.time);
      restitution.push_back(p.restitution);
      ratio.push_back((1 + p.restitution) * p.mass / (p.mass + blow_.ball.mass));
      thickness.push_back(1e3 * p.thickness);
      if (!std::isfinite(p.thickness)) continue;  // beyond the face
      (std::isfinite(p.time) ? inside : without) += 1;
      beyond += p.time > kRulesTime + kRulesTolerance;
      if (p.time > longest) longest = p.time, departure = p.departure, slowest = {-grid_.toe_at(i), grid_.high_at(i)};
      fastest = std::max(fastest, p.restitution);
      table.add(1e3 * grid_.toe_at(i), 1e3 * grid_.high_at(i), thickness.back(), post::if_finite(time.back()),
                post::if_finite(1e6 * p.departure), p.restitution, p.mass, ratio.back());
    }
    out.write("map.csv", table.csv());
    const auto centre = characteristic_time(strike, Vector2d::Zero());
    const double e =
        strike.strike(ball, strike.at(Vector2d::Zero(), models::kBallPatch), restitution_speed_).restitution;
    out.say(centre ? fmt::format("centre: characteristic time {:.1f} us, restitution {:.4f} (the rules' line {:.4f})",
                                 1e6 * centre->time, e, models::rules_line(centre->time))
                   : fmt::format("centre: no characteristic time, restitution {:.4f}", e));
    if (without > 0) {
      summary["places_without_characteristic_time"] = without;
      out.warn(fmt::format("{} places have no characteristic time: the pendulum bounces on the vibrating face there",
                           without));
    }
    std::string verdict = "this face has no verdict by the rules' test: not every place has a characteristic time",
                where, over = "no place of the grid has one";
    if (inside > 0) {
      const std::optional<double> halved = time_error(slowest, longest);
      const double error = departure + halved.value_or(0);
      if (!halved)
        verdict = "this face has no verdict by the rules' test: on a coarser mesh it has no characteristic time there";
      else if (without == 0 || longest >= kRulesTime + kRulesTolerance) verdict = rules_verdict(longest, error);
      const std::string toe = post::fixed(-1e3 * slowest.x(), 1), high = post::fixed(1e3 * slowest.y(), 1);
      out.say(fmt::format("over the face: at most {:.1f} us and {:.4f}; {} of {} places beyond {:.0f} us",
                          1e6 * longest, fastest, beyond, inside, 1e6 * (kRulesTime + kRulesTolerance)));
      out.say(fmt::format("{}: {:.1f}{} us at toe {}, high {} mm; at most {:.0f} us and a tolerance of {:.0f} us",
                          verdict, 1e6 * longest, halved ? fmt::format(" +- {:.1f}", 1e6 * error) : "", toe, high,
                          1e6 * kRulesTime, 1e6 * kRulesTolerance));
      where = fmt::format("{:.1f}{} µs at toe {}, high {} mm", 1e6 * longest,
                          halved ? fmt::format(" ± {:.1f}", 1e6 * error) : "", toe, high);
      over = fmt::format("at most {:.1f} µs over the face", 1e6 * longest);
      if (halved) summary["characteristic_time_error_us"] = 1e6 * error;
      summary["largest_characteristic_time_us"] = 1e6 * longest;
      summary["places_beyond_the_limit"] = beyond;
    } else {
      out.say(verdict);
    }
    summary["characteristic_time_verdict"] = verdict;
    out.page().answer("verdict", verdict.substr(std::string_view("this face ").size()), where);
    out.page().answer("characteristic time", centre ? fmt::format("{:.1f} µs", 1e6 * centre->time) : "none",
                      fmt::format("{}; limit {:.0f} + {:.0f}", over, 1e6 * kRulesTime, 1e6 * kRulesTolerance));
    out.page().answer("restitution", fmt::format("{:.4f}", e), fmt::format("{:g} m/s, centre", restitution_speed_));
    summary["restitution"] = e;
    summary["largest_restitution"] = fastest;
    if (centre) {
      summary["characteristic_time_us"] = 1e6 * centre->time;
      summary["restitution_less_rules_line"] = e - models::rules_line(centre->time);
    }
    post::Figure figure{.title = post::kFaceView, .columns = 2, .panel_width = 680, .panel_height = 330};
    figure.panels = {
        post::face_panel(grid_, time, "characteristic time [us]; line: 257 us, limit and tolerance", "[us]", false),
        post::face_panel(grid_, restitution, fmt::format("restitution at {:g} m/s", restitution_speed_), "[-]", false),
        post::face_panel(grid_, ratio, "ball speed over head speed, normal blow", "[-]", false),
        post::face_panel(grid_, thickness, "thickness [mm]", "[mm]", false)};
    figure.panels.front().map_contours = false;
    limit_line(figure.panels.front(), time, 1e6 * (kRulesTime + kRulesTolerance));
    if (draw_) out.draw(figure, "map");
  }

  /// Nothing where the sphere bounces on the vibrating face.
  std::optional<models::CharacteristicTime> characteristic_time(const models::PlateStrike& strike,
                                                                const Vector2d& at) const {
    try {
      return strike.characteristic_time(sphere_, at, speeds_);
    } catch (const solvers::NonConvergence&) { return {}; }
  }

  /// What a mesh with half the elements each way changes; 0 without `numerical_error`, or where the mesh is too coarse
  /// to be halved. Nothing where that one has no characteristic time.
  std::optional<double> time_error(const Vector2d& at, double time) const {
    models::PlateDesign coarser = plate_->design();
    if (!errors_ || coarser.mesh.core < 4 || coarser.mesh.rings < 2) return 0;
    coarser.mesh.core /= 2;
    coarser.mesh.rings /= 2;
    const models::PlateStrike other(std::make_shared<const models::PlateFace>(coarser, blow_.club.head.face),
                                    blow_.club.head);
    const auto ct = characteristic_time(other, at);
    return ct ? std::optional(std::abs(ct->time - time)) : std::nullopt;
  }

  static std::string rules_verdict(double time, double error) {
    constexpr double limit = kRulesTime + kRulesTolerance;
    if (std::abs(time - limit) <= error) return "this face is within the numerical error of the rules' limit";
    return time < limit ? "this face passes the rules' test" : "this face fails the rules' test";
  }

  /// The level line of a map, straight through each cell of its grid.
  void limit_line(post::Panel& panel, const std::vector<double>& values, double level) const {
    post::Series line{.style = "lines lw 2"};
    const auto columns = std::size_t(grid_.columns);
    for (std::size_t i = 0; i + columns < values.size(); ++i) {
      if (i % columns + 1 == columns) continue;
      const std::array corners{i, i + 1, i + 1 + columns, i + columns};
      std::vector<Vector2d> crossed;
      for (std::size_t side = 0; side < 4; ++side) {
        const std::size_t a = corners[side], b = corners[(side + 1) % 4];
        const double u = values[a] - level, v = values[b] - level, s = u / (u - v);
        if (!(u * v < 0)) continue;
        crossed.emplace_back((1 - s) * grid_.toe_at(a) + s * grid_.toe_at(b),
                             (1 - s) * grid_.high_at(a) + s * grid_.high_at(b));
      }
      for (std::size_t k = 0; k + 1 < crossed.size(); k += 2) {
        for (const Vector2d& at : {crossed[k], crossed[k + 1]}) line.add(1e3 * at.x(), 1e3 * at.y());
        line.add(std::nan(""), std::nan(""));  // the pen is lifted
      }
    }
    if (!line.x.empty()) panel.series.push_back(line);
  }

  void show_blows(Output& out, const std::vector<json>& points, json& summary) const {
    post::TextTable table{.rows = {{"toe [mm]", "high [mm]", "ball speed [m/s]", "launch [deg]", "backspin [rpm]",
                                    "sidespin [rpm]", "travel [mm]", "stress [MPa]"}}};
    std::string csv =
        "toe_mm,high_mm,ball_speed_mps,launch_angle_deg,azimuth_deg,backspin_rpm,sidespin_rpm,face_travel_mm,"
        "peak_stress_MPa,stress_toe_mm,stress_high_mm,face_energy_J,energy_closure\n";
    std::vector<double> speeds;
    double stress = 0, closure = 0;
    Vector2d stressed = Vector2d::Zero();  // toe, high [mm]
    for (const Place& place : places_) {
      const json& p = points[place.blow];
      const auto launch = launch_at(place, points);
      const double side = place.image ? -1 : 1, toe = -1e3 * place.at.x() + 0.0, high = 1e3 * place.at.y() + 0.0;
      if (!launch) {
        table.rows.push_back({fmt::format("{:g}", toe), fmt::format("{:g}", high), "no answer", "", "", "", "", ""});
        speeds.push_back(std::nan(""));
        continue;
      }
      const auto value = [&](const char* key) { return p.at(key).get<double>(); };
      speeds.push_back(launch->ball_speed());
      if (value("peak_stress_Pa") > stress)
        stress = value("peak_stress_Pa"),
        stressed = {side * 1e3 * value("peak_stress_toe_m"), 1e3 * value("peak_stress_high_m")};
      closure = std::max(closure, std::abs(value("closure")));
      table.rows.push_back({fmt::format("{:g}", toe), fmt::format("{:g}", high), post::fixed(launch->ball_speed(), 2),
                            post::fixed(degrees(launch->launch_angle()), 2), post::fixed(rpm(launch->backspin()), 0),
                            post::fixed(rpm(launch->sidespin()), 0), post::fixed(1e3 * value("face_travel_m"), 2),
                            post::fixed(1e-6 * value("peak_stress_Pa"), 0)});
      csv += fmt::format("{:g},{:g},{:.5f},{:.5f},{:.5f},{:.3f},{:.3f},{:.4f},{:.3f},{:.3f},{:.3f},{:.5f},{:.3e}\n",
                         toe, high, launch->ball_speed(), degrees(launch->launch_angle()), degrees(launch->azimuth()),
                         rpm(launch->backspin()), rpm(launch->sidespin()), 1e3 * value("face_travel_m"),
                         1e-6 * value("peak_stress_Pa"), side * 1e3 * value("peak_stress_toe_m"),
                         1e3 * value("peak_stress_high_m"), value("face_energy_J"), value("closure"));
    }
    out.write("blows.csv", csv);
    out.show(table, "Balls struck over the face");
    out.say(fmt::format("largest stress in the face {:.0f} MPa; energy closes to {:.1e} of the initial", 1e-6 * stress,
                        closure));
    out.page().answer("largest stress", fmt::format("{:.0f} MPa", 1e-6 * stress), "von Mises, over these blows");
    if (const auto yield = plate_->design().yield; yield && stress > *yield)
      out.warn(
          fmt::format("the largest stress, {:.0f} MPa at toe {}, high {} mm, exceeds the yield strength of "
                      "{:.0f} MPa: this face yields, and the plate of this model does not",
                      1e-6 * stress, post::fixed(stressed.x(), 1), post::fixed(stressed.y(), 1), 1e-6 * *yield));
    summary["peak_stress_MPa"] = 1e-6 * stress;
    summary["energy_closure"] = closure;
    for (const double v : speeds) summary["ball_speed_mps"].push_back(std::isfinite(v) ? json(v) : json());
    if (std::ranges::all_of(speeds, [](double v) { return std::isfinite(v); })) {
      const double least = std::ranges::min(speeds),
                   mean = std::accumulate(speeds.begin(), speeds.end(), 0.0) / double(speeds.size());
      out.say(fmt::format("ball speed over {}: {:.2f} m/s in the mean, at least {:.2f} m/s",
                          post::counted(speeds.size(), "place"), mean, least));
      summary["mean_ball_speed_mps"] = mean;
      summary["least_ball_speed_mps"] = least;
    }
    if (centre_)
      if (const auto centre = launch_at(places_[*centre_], points)) summary["centre"] = post::to_json(*centre);
    const json& finer = points[places_[again()].blow];
    post::TextTable solved{.rows = {{"other numerics", "ball speed [m/s]", "spin [rpm]", "largest stress [MPa]"}}};
    const auto launch = launch_at(places_[again()], points);
    for (std::size_t i = companions_; i < blows_.size(); ++i) {
      const auto other = launch_from(points[i]);
      if (!other || !launch) continue;
      const double speed = std::abs(other->ball_speed() - launch->ball_speed()),
                   spin = std::abs(other->spin.norm() - launch->spin.norm()),
                   peak = std::abs(points[i].at("peak_stress_Pa").get<double>() -
                                   finer.at("peak_stress_Pa").get<double>());
      out.say(fmt::format("{} at toe {:g}, high {:g} mm: {:.3f} m/s, {:.0f} rpm, {:.1f} MPa of difference",
                          blows_[i].companion, -1e3 * blows_[i].place.x() + 0.0, 1e3 * blows_[i].place.y() + 0.0, speed,
                          rpm(spin), 1e-6 * peak));
      solved.rows.push_back({blows_[i].companion == "coarser" ? "a coarser mesh and longer steps" : blows_[i].companion,
                             post::fixed(speed, 3), post::fixed(rpm(spin), 0), post::fixed(1e-6 * peak, 1)});
      summary["numerical_error"][blows_[i].companion] = {
          {"ball_speed_mps", speed}, {"spin_rpm", rpm(spin)}, {"peak_stress_MPa", 1e-6 * peak}};
    }
    const Vector2d at = places_[again()].at;
    if (solved.rows.size() > 1)
      out.page().section("How well it was solved",
                         fmt::format("<p class='soft'>By how much the blow at toe {:g}, high {:g} mm moves with other "
                                     "numerics.</p>{}",
                                     -1e3 * at.x() + 0.0, 1e3 * at.y() + 0.0, solved.html()));
    out.page().section(solved.rows.size() > 1 ? "" : "How well it was solved",
                       fmt::format("<p><small>Energy unaccounted for: at most {:.1e} of the initial energy of a "
                                   "blow.</small></p>",
                                   closure));
  }

  /// One surface with every mode as a vector field: displacement of the face, its largest deflection 1 mm.
  void write_modes(Output& out, const models::PlateFace& face) const {
    const fem::Plate& plate = face.plate();
    post::VtkMesh mesh;
    for (const Vector2d& n : plate.mesh().nodes) mesh.points.push_back(face.curvature().point(n.x(), n.y()));
    for (const auto& e : plate.mesh().elements)
      for (const int corner : {0, 1, 3, 4}) {
        const auto at = [&](int k) { return std::int64_t(e[std::size_t(corner + k)]); };
        mesh.cells.push_back({post::CellShape::quad, {at(0), at(1), at(4), at(3)}});
      }
    post::VtkField thickness{"thickness", "m", 1, plate.thickness()};
    mesh.point_fields.push_back(thickness);
    for (std::size_t m = 0; m < std::min(kModes, face.omega().size()); ++m) {
      std::vector<Vec3> moved;
      double most = 0;
      for (std::size_t n = 0; n < mesh.points.size(); ++n) {
        const auto value = [&](fem::Plate::Unknown u) {
          return plate.value(face.modes().col(Eigen::Index(m)), int(n), u);
        };
        moved.emplace_back(-value(fem::Plate::kDeflection), value(fem::Plate::kStretchY), value(fem::Plate::kStretchZ));
        most = std::max(most, moved.back().norm());
      }
      for (Vec3& v : moved) v *= 1e-3 / most;
      mesh.point_fields.push_back(
          post::vector_field(fmt::format("mode {} ({:.0f} Hz)", m + 1, face.omega()[m] / (2 * kPi)), "m", moved));
    }
    post::VtkSeries(out.directory() / "vtk", "modes", post::VtkSeries::Form::surface).write(0, mesh);
  }

  Blow blow_;
  models::FeImpactOptions fe_;
  std::shared_ptr<const models::PlateOnDemand> plate_;
  std::vector<double> toe_, high_, speeds_;
  post::FaceGrid grid_;
  models::Striker sphere_;
  double restitution_speed_ = 0;
  bool errors_ = true, vtk_ = true, draw_ = true;
  bool alike_ = false;  ///< head and face, from heel to toe
  std::vector<Struck> blows_;
  std::vector<Place> places_;
  std::optional<std::size_t> centre_;  ///< of the places, where the face's centre is among them
  std::size_t companions_ = 0;         ///< the first of the blows that tell numerical errors
};

}  // namespace

std::unique_ptr<Job> read_plate_face(CaseFile& file) { return std::make_unique<PlateFaceJob>(file); }

}  // namespace hosel::app
