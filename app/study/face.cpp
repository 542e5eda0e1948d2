#include "app/study/face.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/read_flight.hpp"
#include "app/stored_launch.hpp"
#include "golf/units.hpp"
#include "post/labels.hpp"
#include "post/vtk_series.hpp"

namespace hosel::app {
namespace {

using nlohmann::json;

bool whole(const post::FaceMap& map) {
  return std::ranges::all_of(map.launches, [](const auto& l) { return l.has_value(); });
}

/// Of an effect's figures, those that a page begins with.
constexpr std::array<std::string_view, 6> kAnswers = {"ball_speed_gain_centre_mps",  "ball_speed_gain_mean_mps",
                                                      "sidespin_difference_toe_rpm", "sidespin_difference_heel_rpm",
                                                      "carry_gain_centre_yd",        "equivalent_head_mass_centre_g"};

class FaceReport {
 public:
  FaceReport(Output& out, const StudyTable& table, const std::vector<json>& points, std::vector<FaceLayer>& layers,
             bool draw)
      : out_(out), table_(table), points_(points), layers_(layers), grid_(*table.design.grid()), draw_(draw) {}

  void tables() {
    std::vector<post::FaceMap> maps;
    post::References against;
    for (const FaceLayer& l : layers_) {
      maps.push_back(l.map);
      against.push_back(l.reference);
    }
    out_.write("face_map.csv", post::face_map_csv(grid_, maps));
    const bool compared = std::ranges::any_of(against, [](const auto& r) { return r.has_value(); });
    if (compared) out_.write("face_differences.csv", post::difference_csv(grid_, maps, against));
    post::VtkSeries(out_.directory() / "vtk", "face", post::VtkSeries::Form::surface)
        .write(0, post::face_map_mesh(layers_.front().head.face, grid_, maps, against));
  }

  /// What a layer is minus its reference, in figures.
  json effect(FaceLayer& layer, double extra, bool first) {
    const FaceLayer& reference = layers_[*layer.reference];
    const std::string title = fmt::format("{} minus {}", layer.map.title, reference.map.title);
    layer.figures = post::shaft_effect(grid_, layer.map, reference.map);
    if (extra > 0 && whole(reference.heavier)) {
      const auto mass = post::equivalent_mass(layer.map, reference.map, reference.heavier, reference.head.mass, extra);
      for (post::NamedFigure& f : post::mass_figures(grid_, mass)) layer.figures.push_back(std::move(f));
      std::vector<double> grams;
      for (const double x : mass) grams.push_back(1e3 * x);
      const std::string label = "equivalent extra head mass [g]";
      picture({.title = fmt::format("head mass to add to {} for it to play as {}; {}", reference.map.title,
                                    layer.map.title, post::kFaceView),
               .panels = {post::face_panel(grid_, grams, label, label, false)},
               .panel_width = 1100,
               .panel_height = 620},
              "figures/equivalent-mass-" + out_.file_name(layer.map.title), true);
    }
    if (first) {
      const auto gain = [&](std::string_view name) {
        return std::ranges::find(layer.figures, name, &post::NamedFigure::name)->value;
      };
      out_.page().sentence(fmt::format(
          "{}: the ball is {:+.3g} m/s faster at the centre of the face, {:+.3g} m/s in the mean over it, {:+.3g} to "
          "{:+.3g} m/s over all of it.",
          title, gain("ball_speed_gain_centre_mps"), gain("ball_speed_gain_mean_mps"), gain("ball_speed_gain_min_mps"),
          gain("ball_speed_gain_max_mps")));
    }
    json j;
    out_.say("\n" + title);
    for (const auto& [name, value] : layer.figures) {
      j["figures"][name] = value;
      out_.say(fmt::format("  {:<52} {:>12.5g}", post::label(name), value));
      if (!first || std::ranges::find(kAnswers, name) == kAnswers.end()) continue;
      const SplitName split = split_unit(name);
      out_.page().answer(post::spoken(split.stem), fmt::format("{:+.3g} {}", value, post::symbol(split.unit->suffix)),
                         title);
    }
    return j;
  }

  /// How much of what the first setting's layer is minus its reference is left in this one: least squares through the
  /// origin over the face, and one picture.
  json kept(const FaceLayer& layer) {
    const FaceLayer& first = layers_[layer.model];
    const post::FaceMap &map = layer.map, &against = layers_[*layer.reference].map,
                        &reference = layers_[*first.reference].map;
    post::Figure figure{.title = fmt::format("left: {} minus {}; right: {} minus {}", first.map.title, reference.title,
                                             map.title, against.title),
                        .columns = 2,
                        .panel_width = 640,
                        .panel_height = 330};
    static constexpr std::array<std::string_view, 4> kShown = {"ball_speed", "launch_angle", "backspin", "sidespin"};
    json j = json::object();
    out_.say(fmt::format("\n{} minus {}, as a share of {} minus {}", map.title, against.title, first.map.title,
                         reference.title));
    for (const post::MapQuantity& q : post::map_quantities(map)) {
      const auto before = post::differences(first.map, reference, q), now = post::differences(map, against, q);
      if (before.empty() || now.empty()) continue;
      double product = 0, square = 0;
      for (std::size_t k = 0; k < before.size(); ++k)
        if (std::isfinite(before[k]) && std::isfinite(now[k]))
          product += before[k] * now[k], square += before[k] * before[k];
      if (!(square > 0)) continue;
      const std::string unit = post::symbol(q.unit);
      j[q.name + "_share"] = product / square;
      out_.say(fmt::format("  {:<52} {:>12.3f}", post::spoken(q.name), product / square));
      if (std::ranges::find(kShown, q.name) == kShown.end()) continue;
      const std::string share = fmt::format("{}: {:.0f} % of it", post::spoken(q.name), 100 * product / square);
      double reach = 0;  // one range of colours for both, or the smaller one would look as large
      for (const auto* map_of : {&before, &now})
        for (const double x : *map_of)
          if (std::isfinite(x)) reach = std::max(reach, std::abs(x));
      for (const auto& [values, text] :
           {std::pair{&before, fmt::format("{} [{}]", post::spoken(q.name), unit)}, {&now, share}}) {
        figure.panels.push_back(post::face_panel(grid_, *values, text, fmt::format("[{}]", unit), true));
        figure.panels.back().map_reach = reach;
      }
    }
    picture(figure, "figures/kept-" + out_.file_name(map.title), true);
    return j;
  }

  /// What the shaft does to the head at every place: force and moment over time, and their impulses as maps.
  void hosel(const FaceLayer& layer) {
    static constexpr std::array kAxes = {"x", "y", "z"};
    post::Table table;
    table.in_files({"impact_toe_mm", "impact_high_mm", "time_ms"}, "{:.6g}");
    table.in_files({"force_x_N", "force_y_N", "force_z_N", "moment_x_N_m", "moment_y_N_m", "moment_z_N_m"}, "{:.8g}");
    std::array<std::vector<double>, 6> impulses;
    bool any = false;
    for (std::size_t p = 0; p < grid_.size(); ++p) {
      const json& point = points_[layer.points[p] * table_.models.size() + layer.model];
      const bool has = point.contains("hosel");
      for (std::size_t k = 0; k < 6; ++k)
        impulses[k].push_back(has ? point.at("hosel").at("impulse").at(k / 3).at(k % 3).get<double>() : std::nan(""));
      if (!has) continue;
      any = true;
      for (const json& row : point.at("hosel").at("history"))
        table.add(1e3 * grid_.toe_at(p), 1e3 * grid_.high_at(p), 1e3 * row.at(0).get<double>(), vector_from(row.at(1)),
                  vector_from(row.at(2)));
    }
    if (!any) return;
    const std::string name = out_.file_name(layer.map.title);
    out_.write(fmt::format("hosel-{}.csv", name), table.csv());
    post::Figure figure{.title = fmt::format("{}: impulse of the shaft on the head at the hosel, face axes; {}",
                                             layer.map.title, post::kFaceView),
                        .columns = 3,
                        .panel_width = 640,
                        .panel_height = 330};
    for (std::size_t k = 0; k < 6; ++k)
      figure.panels.push_back(post::face_panel(
          grid_, impulses[k], fmt::format("{} along {}", k < 3 ? "force's impulse" : "moment's impulse", kAxes[k % 3]),
          k < 3 ? "[N s]" : "[N m s]", true));
    picture(figure, "figures/hosel-" + name, false);
  }

 private:
  void picture(const post::Figure& figure, const std::string& stem, bool on_page) {
    if (draw_) out_.draw(figure, stem, on_page);
  }

  Output& out_;
  const StudyTable& table_;
  const std::vector<json>& points_;
  std::vector<FaceLayer>& layers_;
  post::FaceGrid grid_;
  bool draw_;
};

}  // namespace

std::vector<FaceLayer> face_layers(const StudyTable& table, const std::vector<json>& points,
                                   const std::optional<StudyReference>& reference,
                                   const std::function<StudyBlow(std::size_t, std::size_t)>& blow) {
  std::vector<FaceLayer> out;
  const Design& design = table.design;
  const std::size_t places = design.grid()->size(), models = table.models.size();
  std::size_t block = 1;  // of points from one place of the grid to the next
  for (std::size_t f = design.factors().size(); design.factors()[--f].kind != DesignFactor::Kind::grid;)
    block *= design.factors()[f].levels.size();
  const auto setting_of = [&](std::size_t d) { return d / (block * places) * block + d % block; };
  for (std::size_t k = 0; k < design.size() / places; ++k) {
    const std::size_t first = k / block * block * places + k % block;
    const std::string said = design.said(first, DesignFactor::Kind::grid);
    for (std::size_t m = 0; m < models; ++m) {
      const std::string& model = table.models[m];
      const StudyBlow asked = blow(first, m);
      FaceLayer l{.map = {.title = said.empty()  ? model
                                   : models == 1 ? said
                                                 : fmt::format("{}, {}", said, model),
                          .launches = {}},
                  .heavier = {},
                  .head = asked.blow.club.head,
                  .model = m,
                  .setting = k,
                  .points = {},
                  .reference = {}};
      for (std::size_t p = 0; p < places; ++p) {
        l.points.push_back(first + p * block);
        const json& point = points[l.points.back() * models + m];
        const auto launch = [&](const char* key) {
          return point.contains(key) ? launch_from(point[key]) : std::optional<Launch>();
        };
        l.map.launches.push_back(launch("launch"));
        l.heavier.launches.push_back(launch("heavier"));
        if (!asked.flight) continue;
        l.map.distances = asked.flight->unit;
        l.map.flights.emplace_back();
        if (l.map.launches.back()) try {
            const StudyBlow here = blow(l.points.back(), m);
            l.map.flights.back() = here.flight->follow(*l.map.launches.back(), here.blow.ball);
          } catch (const std::invalid_argument&) {}  // a ball that cannot reach the landing has no flight
      }
      if (reference && (reference->model || reference->variant)) {
        const std::size_t other = setting_of(counterpart(table, *reference, first)) * models +
                                  reference->model.value_or(m);
        if (other != out.size()) l.reference = other;
      }
      out.push_back(std::move(l));
    }
  }
  return out;
}

std::vector<std::string> face_figure_names(bool with_mass) {
  std::vector<std::string> names = post::shaft_effect_names();
  if (with_mass)
    for (const post::NamedFigure& f : post::mass_figures({.columns = 2, .rows = 2}, {0, 0, 0, 0}))
      names.push_back(f.name);
  return names;
}

void report_face(Output& out, const StudyTable& table, const std::vector<json>& points, std::vector<FaceLayer>& layers,
                 double extra, bool draw, json& summary) {
  // Distances of all in one table: as they are asked for, or as the first that flies has them.
  const auto flies = std::ranges::find_if(layers, [](const FaceLayer& l) { return !l.map.flights.empty(); });
  if (flies != layers.end()) {
    FlightSetup shown{.unit = flies->map.distances};
    shown.show_in(out);
    for (FaceLayer& l : layers) l.map.distances = shown.unit;
  }
  FaceReport report(out, table, points, layers, draw);
  report.tables();
  bool first = true;
  for (FaceLayer& l : layers) {
    if (whole(l.map)) summary["mirror_error"][l.map.title] = post::mirror_error(*table.design.grid(), l.map);
    report.hosel(l);
    if (!l.reference || !whole(l.map) || !whole(layers[*l.reference].map)) continue;
    summary["effect"][l.map.title] = report.effect(l, extra, first);
    first = false;
    // Only where each setting has a reference of its own.
    if (l.setting > 0 && layers[*l.reference].setting == l.setting) summary["kept"][l.map.title] = report.kept(l);
  }
}

}  // namespace hosel::app
