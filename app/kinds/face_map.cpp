#include "app/kinds/face_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/check_memory.hpp"
#include "app/read_blow.hpp"
#include "app/read_face_map.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/stop.hpp"
#include "app/stored_launch.hpp"
#include "app/sweep.hpp"
#include "models/checked_launch.hpp"
#include "models/club/hosel_load.hpp"
#include "models/fe/fe_impact.hpp"
#include "models/registry.hpp"
#include "post/face_map.hpp"
#include "post/html.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"
#include "post/shaft_effect.hpp"
#include "post/vtk_series.hpp"

namespace hosel::app {
namespace {

using nlohmann::json;

/// One map: a model asked about one club, at every point of the grid or at the nine coarse ones.
struct Layer {
  std::string title;
  std::unique_ptr<models::ImpactModel> model;
  Blow blow;
  std::optional<FlightSetup> flight;
  bool refined = false;
};

struct MapVariant {
  std::string title, model;
  std::vector<std::string> set;
  std::string against = {};  ///< the map that it is the counterpart of, where that is not the reference
};

/// What one map is minus another, and the same pair under other circumstances.
struct Pair {
  std::size_t map, against, first;  ///< first: a map of the same model, whose counterpart is the reference
};

class FaceMapJob final : public PointJob {
 public:
  explicit FaceMapJob(CaseFile& file) {
    const BlowsBeside beside;
    Settings s = read(file.root());
    grid_ = s.grid;
    reference_ = s.reference;
    extra_ = s.extra_mass;
    claims_ = s.claims;
    figures_ = s.figures;
    // The maps themselves, then the reference with a heavier head, then each again with finer numerics.
    for (const MapVariant& v : s.variants) add(file, v, false);
    maps_ = layers_.size();
    pairs_ = s.pairs;
    if (extra_ > 0) {
      add(file, s.variants[reference_], false);
      layers_.back().title += fmt::format(", head {:+.6g} g", 1e3 * extra_);
      layers_.back().blow.club.head.mass += extra_;
    }
    bases_ = layers_.size();
    if (!s.refinement.empty())
      for (std::size_t m = 0; m < bases_; ++m) {
        MapVariant v = s.variants[m < maps_ ? m : reference_];
        v.set.insert(v.set.end(), s.refinement.begin(), s.refinement.end());
        add(file, v, true);
        if (m >= maps_) layers_.back().blow.club.head.mass += extra_;
      }
    for (std::size_t layer = 0; layer < layers_.size(); ++layer)
      if (layers_[layer].refined)
        for (const std::size_t p : post::coarse_points(grid_)) work_.push_back({layer, p});
      else
        for (std::size_t p = 0; p < grid_.size(); ++p) work_.push_back({layer, p});
  }

  std::size_t size() const override { return work_.size(); }

  json compute(std::size_t point, const std::filesystem::path&) const override {
    const auto& [layer, place] = work_[point];
    Blow blow = layers_[layer].blow;
    blow.delivery.impact_toe = grid_.toe_at(place);
    blow.delivery.impact_high = grid_.high_at(place);
    const models::ImpactModel& model = *layers_[layer].model;
    const auto* fe = dynamic_cast<const models::FeModel*>(&model);
    if (!fe) return stored(models::checked_launch(model, blow));
    models::HoselHistory hosel;
    const StopSignals stop;
    json out = stored(fe->solve(blow, [&](const models::ImpactView& v) {
                          stop.check();
                          if (v.shaft) hosel.add(*v.shaft, v.state);
                        }).launch);
    if (!hosel.times.empty()) out["hosel"] = stored(hosel);
    return out;
  }

  void report(Output& out, const std::vector<json>& points) const override {
    std::vector<post::FaceMap> all;
    for (const Layer& layer : layers_) all.push_back({layer.title, {}});
    for (std::size_t i = 0; i < points.size(); ++i) all[work_[i].layer].launches.push_back(launch_from(points[i]));
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) add_flights(layers_[layer], all[layer]);
    const std::vector<post::FaceMap> maps(all.begin(), all.begin() + long(maps_));
    const post::FaceMap& reference = maps[reference_];

    out.write("face_map.csv", post::face_map_csv(grid_, maps));
    if (maps_ > 1) out.write("differences.csv", post::difference_csv(grid_, maps, reference));
    post::VtkSeries(out.directory() / "vtk", "face", post::VtkSeries::Form::surface)
        .write(0, post::face_map_mesh(layers_[reference_].blow.club.head.face, grid_, maps, reference));

    json summary;
    summary["grid"] = {{"width_mm", 1e3 * grid_.width},
                       {"height_mm", 1e3 * grid_.height},
                       {"columns", grid_.columns},
                       {"rows", grid_.rows}};
    summary["reference"] = reference.title;
    for (const post::FaceMap& map : maps) {
      json& m = summary["models"][map.title];
      const bool whole = std::ranges::all_of(map.launches, [](const auto& l) { return l.has_value(); });
      m["points_without_a_launch"] = std::ranges::count_if(map.launches, [](const auto& l) { return !l; });
      if (whole) m["mirror_error"] = post::mirror_error(grid_, map);
      const auto& centre = map.launches[post::coarse_points(grid_)[4]];
      if (centre) m["centre"] = post::to_json(*centre);
      if (!map.flights.empty()) {
        const auto& flight = map.flights[post::coarse_points(grid_)[4]];
        if (flight) m["centre"].update(post::to_json(*flight));
      }
      // The page shows what the first of the others makes different, and beneath it the reference.
      if (&map != &maps[reference_]) draw(out, map, nullptr, false);
      hosel(out, points, std::size_t(&map - maps.data()));
      if (&map == &maps[reference_]) continue;
      draw(out, map, &reference, &map == &maps[reference_ == 0 ? 1 : 0]);
      if (whole && std::ranges::all_of(reference.launches, [](const auto& l) { return l.has_value(); }))
        summary["effect"][map.title] = effect(out, all, std::size_t(&map - maps.data()));
    }
    draw(out, reference, nullptr, true);
    for (const Pair& pair : pairs_) summary["kept"][maps[pair.map].title] = kept(out, maps, pair);
    out.write_summary(summary);
  }

 private:
  struct Settings {
    Blow blow;
    models::Options options;
    post::FaceGrid grid;
    std::vector<MapVariant> variants;
    std::size_t reference = 0;
    std::vector<Pair> pairs;
    double extra_mass = 0;
    std::vector<std::string> refinement;
    std::optional<FlightSetup> flight;
    std::vector<post::Claim> claims;
    bool figures = true;
  };

  /// Every key that a face map knows.
  static Settings read(Table root) {
    Settings s;
    std::vector<std::string> names = read_models(root);
    for (const std::string& m : names) s.variants.push_back({m, m, {}});
    for (Table v : root.tables("variants")) {
      const std::string name = v.name({"name", "of the map"}, names),
                        model = v.text({"model", "that answers for this map"});
      if (!models::find(model)) v.fail("model", fmt::format("no model '{}'; `hosel list` shows them", model));
      s.variants.push_back(
          {name, model, v.texts({"set", "keys that this map changes, table.key=value"}),
           v.text({"against", "the map that this one is the counterpart of, if not the reference"}, "")});
    }
    constexpr std::size_t most = 1000;  // each is read once for every one
    if (s.variants.size() > most) root.fail("variants", fmt::format("more than {}: sweep a key instead", most));
    const std::string reference =
        root.choice({"reference", "the map that the others are compared with"}, names, names.front());
    s.reference = std::size_t(std::ranges::find(names, reference) - names.begin());
    for (std::size_t m = 0; m < s.variants.size(); ++m) {
      const MapVariant& v = s.variants[m];
      if (v.against.empty()) continue;
      const auto against = std::ranges::find(names, v.against);
      if (against == names.end()) root.fail("variants", fmt::format("no map is called '{}'", v.against));
      const auto first = std::ranges::find(s.variants, v.model, &MapVariant::model);
      s.pairs.push_back({m, std::size_t(against - names.begin()), std::size_t(first - s.variants.begin())});
    }
    s.grid = read_face_grid(root);
    if (auto e = root.optional_table("equivalent_mass"))
      s.extra_mass =
          e->quantity({"extra", "head mass added to the reference: what the shaft's effect is compared with"}, "g",
                      {1e-5, 0.1}, 5e-3);
    if (auto r = root.optional_table("refinement"))
      s.refinement = r->texts({"set", "keys that refine the numerics, table.key=value"});
    s.claims = read_statements(root, figure_names(s.extra_mass > 0));
    s.figures = root.flag({"figures", "draw the maps; a sweep of many may do without"}, true);
    std::vector<std::string> asked;
    for (const MapVariant& v : s.variants) asked.push_back(v.model);
    s.blow = read_blow(root, asked);
    s.options = read_options(root, asked);
    s.flight = read_optional_flight(root);
    if (s.blow.delivery.impact_toe != 0 || s.blow.delivery.impact_high != 0)
      root.fail("delivery", "the grid says where the ball meets the face: impact_toe and impact_high stay out");
    return s;
  }

  /// What statements may speak of.
  static std::vector<std::string> figure_names(bool with_mass) {
    std::vector<std::string> names = post::shaft_effect_names();
    if (with_mass)
      for (const post::NamedFigure& f : mass_figures({0}, 0)) names.push_back(f.name);
    return names;
  }

  /// Of the equivalent head mass [kg] over a grid.
  static std::vector<post::NamedFigure> mass_figures(const std::vector<double>& mass, std::size_t centre) {
    double sum = 0;
    for (const double x : mass) sum += x;
    return {{"equivalent_head_mass_centre_g", 1e3 * mass[centre]},
            {"equivalent_head_mass_mean_g", 1e3 * sum / double(mass.size())},
            {"equivalent_head_mass_min_g", 1e3 * std::ranges::min(mass)},
            {"equivalent_head_mass_max_g", 1e3 * std::ranges::max(mass)}};
  }

  void add(const CaseFile& file, const MapVariant& variant, bool refined) {
    std::vector<std::string> overrides = file.overrides();
    overrides.insert(overrides.end(), variant.set.begin(), variant.set.end());
    CaseFile again(file, overrides);
    Table root = again.root();
    root.text({"kind", "what the case does (`hosel list`)"}, "face-map");
    root.text({"title", "of tables, pages and figures"}, "");
    const Settings own = read(root);
    Layer layer{variant.title, models::find(variant.model)->make(own.options), own.blow, own.flight, refined};
    again.finish();
    layers_.push_back(std::move(layer));
  }

  /// Where each ball of a map goes, if the case asks. A ball that cannot reach the landing has no flight.
  static void add_flights(const Layer& layer, post::FaceMap& map) {
    if (!layer.flight) return;
    map.distances = layer.flight->unit;
    for (const auto& launch : map.launches) {
      map.flights.emplace_back();
      if (!launch) continue;
      try {
        map.flights.back() = layer.flight->follow(*launch, layer.blow.ball);
      } catch (const std::invalid_argument&) {}
    }
  }

  void draw(Output& out, const post::FaceMap& map, const post::FaceMap* reference, bool on_page) const {
    draw(out, map, reference, false, on_page);
    if (!map.flights.empty()) draw(out, map, reference, true, on_page);
  }

  /// Every quantity of a map, or of its difference to another: those of the launch, or those of the flight.
  void draw(Output& out, const post::FaceMap& map, const post::FaceMap* reference, bool of_flight, bool on_page) const {
    const std::string what = reference ? fmt::format("{} minus {}", map.title, reference->title) : map.title;
    post::Figure figure{.title = what + "; " + post::kFaceView, .columns = 3, .panel_width = 640, .panel_height = 330};
    // What a map is asked for; the other quantities are in the picture of them all.
    static constexpr std::array<std::string_view, 8> kAnswers = {"ball_speed", "launch_angle", "azimuth", "backspin",
                                                                 "sidespin",   "carry",        "side",    "lost_carry"};
    for (const post::MapQuantity& q : post::map_quantities(map)) {
      if (q.of_flight != of_flight) continue;
      const auto v = reference ? post::differences(map, *reference, q) : post::values(map, q);
      if (v.empty()) continue;
      const std::string unit = post::symbol(q.unit);
      figure.panels.push_back(post::face_panel(
          grid_, v, fmt::format("{}{} [{}]", reference ? "difference of " : "", post::spoken(q.name), unit),
          fmt::format("[{}]", unit), reference != nullptr));
      figure.panels.back().on_page = std::ranges::find(kAnswers, q.name) != kAnswers.end();
    }
    picture(out, figure,
            fmt::format("figures/{}{}{}", of_flight ? "flight-" : "", reference ? "difference-" : "map-",
                        out.file_name(map.title)),
            on_page);
  }

  /// What the shaft does to the head at every point: force and moment over time, and their impulses as maps.
  void hosel(Output& out, const std::vector<json>& points, std::size_t layer) const {
    static constexpr std::array kAxes = {"x", "y", "z"};
    std::string csv =
        "impact_toe_mm,impact_high_mm,time_ms,force_x_N,force_y_N,force_z_N,moment_x_N_m,moment_y_N_m,moment_z_N_m\n";
    std::array<std::vector<double>, 6> impulses;
    bool any = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (work_[i].layer != layer) continue;
      const bool has = points[i].contains("hosel");
      for (std::size_t k = 0; k < 6; ++k)
        impulses[k].push_back(has ? points[i].at("hosel").at("impulse").at(k / 3).at(k % 3).get<double>()
                                  : std::nan(""));
      if (!has) continue;
      any = true;
      for (const json& row : points[i].at("hosel").at("history")) {
        const Vec3 force = vector_from(row.at(1)), moment = vector_from(row.at(2));
        csv += fmt::format("{:.6g},{:.6g},{:.6g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n",
                           1e3 * grid_.toe_at(work_[i].place), 1e3 * grid_.high_at(work_[i].place),
                           1e3 * row.at(0).get<double>(), force.x(), force.y(), force.z(), moment.x(), moment.y(),
                           moment.z());
      }
    }
    if (!any) return;
    const std::string name = out.file_name(layers_[layer].title);
    out.write(fmt::format("hosel-{}.csv", name), csv);
    post::Figure figure{.title = fmt::format("{}: impulse of the shaft on the head at the hosel, face axes; {}",
                                             layers_[layer].title, post::kFaceView),
                        .columns = 3,
                        .panel_width = 640,
                        .panel_height = 330};
    for (std::size_t k = 0; k < 6; ++k)
      figure.panels.push_back(post::face_panel(
          grid_, impulses[k], fmt::format("{} along {}", k < 3 ? "force's impulse" : "moment's impulse", kAxes[k % 3]),
          k < 3 ? "[N s]" : "[N m s]", true));
    picture(out, figure, "figures/hosel-" + name, false);
  }

  void picture(Output& out, const post::Figure& figure, const std::string& stem, bool on_page = true) const {
    if (figures_) out.draw(figure, stem, on_page);
  }

  json effect(Output& out, const std::vector<post::FaceMap>& all, std::size_t m) const {
    const post::FaceMap &map = all[m], &reference = all[reference_];
    auto figures = post::shaft_effect(grid_, map, reference);
    std::vector<double> mass;
    const auto with_mass = [&](std::vector<post::NamedFigure>& f, const std::vector<double>& kg, std::size_t centre) {
      for (post::NamedFigure& figure : mass_figures(kg, centre)) f.push_back(std::move(figure));
    };
    const double head = layers_[reference_].blow.club.head.mass;
    if (extra_ > 0) {
      mass = post::equivalent_mass(map, reference, all[maps_], head, extra_);
      with_mass(figures, mass, post::coarse_points(grid_)[4]);
      std::vector<double> grams;
      for (const double x : mass) grams.push_back(1e3 * x);
      const std::string label = "equivalent extra head mass [g]";
      picture(
          out,
          {.title = fmt::format("head mass by which {} plays as {}; {}", reference.title, map.title, post::kFaceView),
           .panels = {post::face_panel(grid_, grams, label, label, false)},
           .panel_width = 1100,
           .panel_height = 620},
          "figures/equivalent-mass-" + out.file_name(map.title));
    }
    // The same figures from the nine coarse points, as computed and with finer numerics: their
    // difference is the numerical uncertainty.
    std::optional<std::vector<post::NamedFigure>> as_computed, finer;
    if (layers_.size() > bases_) {
      const auto complete = [](const post::FaceMap& x) {
        return std::ranges::all_of(x.launches, [](const auto& l) { return l.has_value(); });
      };
      if (std::ranges::all_of(all.begin() + long(bases_), all.end(), complete)) {
        const post::FaceGrid nine = post::coarse(grid_);
        const auto base = [&](std::size_t i) { return post::coarse(grid_, all[i]); };
        as_computed = post::shaft_effect(nine, base(m), base(reference_));
        finer = post::shaft_effect(nine, all[bases_ + m], all[bases_ + reference_]);
        if (extra_ > 0) {
          with_mass(*as_computed, post::equivalent_mass(base(m), base(reference_), base(maps_), head, extra_), 4);
          with_mass(*finer,
                    post::equivalent_mass(all[bases_ + m], all[bases_ + reference_], all[bases_ + maps_], head, extra_),
                    4);
        }
      }
    }
    json j;
    out.say(fmt::format("\n{} minus {}", map.title, reference.title));
    for (std::size_t i = 0; i < figures.size(); ++i) {
      const auto& [name, value] = figures[i];
      json& figure = j["figures"][name];
      figure["value"] = value;
      if (finer) {
        const double error = std::abs((*finer)[i].value - (*as_computed)[i].value);
        figure["uncertainty"] = error;
        out.say(fmt::format("  {:<48} {:>12.5g} +- {:.2g}", name, value, error));
      } else {
        out.say(fmt::format("  {:<48} {:>12.5g}", name, value));
      }
    }
    j["uncertainty_source"] = finer ? "finer numerics at the nine corner, edge and centre points"
                                    : "none: no [refinement] declared, or a point of it failed";
    // The page answers with the first map; the others are printed beneath.
    RunPage* page = &map == &all[reference_ == 0 ? 1 : 0] ? &out.page() : nullptr;
    if (page) {
      const std::string note = fmt::format("{} minus {}", map.title, reference.title);
      for (const auto& [name, value] : figures)
        if (std::ranges::find(kAnswers, name) != kAnswers.end()) {
          const SplitName split = split_unit(name);
          page->answer(post::spoken(split.stem), fmt::format("{:+.3g} {}", value, post::symbol(split.unit->suffix)),
                       note);
        }
    }
    std::string statements;
    for (const post::Claim& claim : claims_) {
      const bool holds = claim.holds(figures);
      statements += fmt::format("<tr><td>{}<td class='l'>{}</tr>", holds ? "yes" : "no", post::escape_html(claim.text));
      j["statements"].push_back({{"text", claim.text}, {"holds", holds}});
      out.say(fmt::format("  {}  {}", holds ? "yes" : "NO ", claim.text));
    }
    if (page && !statements.empty())
      page->section("Published statements borne out here", "<table>" + statements + "</table>");
    return j;
  }

  /// How much of what the first map is minus the reference is left in this pair: least squares through the origin over
  /// the face, and one picture.
  json kept(Output& out, const std::vector<post::FaceMap>& maps, const Pair& pair) const {
    const post::FaceMap &map = maps[pair.map], &against = maps[pair.against], &first = maps[pair.first],
                        &reference = maps[reference_];
    post::Figure figure{.title = fmt::format("left: {} minus {}; right: {}", first.title, reference.title, map.title),
                        .columns = 2,
                        .panel_width = 640,
                        .panel_height = 330};
    static constexpr std::array<std::string_view, 4> kShown = {"ball_speed", "launch_angle", "backspin", "sidespin"};
    json j = json::object();
    out.say(fmt::format("\n{} minus {}, as a share of {} minus {}", map.title, against.title, first.title,
                        reference.title));
    for (const post::MapQuantity& q : post::map_quantities(map)) {
      const auto before = post::differences(first, reference, q), now = post::differences(map, against, q);
      if (before.empty() || now.empty()) continue;
      double product = 0, square = 0;
      for (std::size_t k = 0; k < before.size(); ++k)
        if (std::isfinite(before[k]) && std::isfinite(now[k]))
          product += before[k] * now[k], square += before[k] * before[k];
      if (!(square > 0)) continue;
      const std::string unit = post::symbol(q.unit);
      j[q.name + "_share"] = product / square;
      out.say(fmt::format("  {:<48} {:>12.3f}", q.name, product / square));
      if (std::ranges::find(kShown, q.name) == kShown.end()) continue;
      for (const auto* v : {&before, &now})
        figure.panels.push_back(post::face_panel(grid_, *v,
                                                 v == &before
                                                     ? fmt::format("{} [{}]", post::spoken(q.name), unit)
                                                     : fmt::format("{:.0f} % are left", 100 * product / square),
                                                 fmt::format("[{}]", unit), true));
    }
    picture(out, figure, "figures/kept-" + out.file_name(map.title));
    return j;
  }

  /// Of an effect's figures, those that its page begins with.
  static constexpr std::array<std::string_view, 6> kAnswers = {
      "ball_speed_gain_centre_mps",   "ball_speed_gain_mean_mps", "sidespin_difference_toe_rpm",
      "sidespin_difference_heel_rpm", "carry_gain_centre_yd",     "equivalent_head_mass_centre_g"};

  struct Work {
    std::size_t layer, place;
  };
  post::FaceGrid grid_;
  std::size_t reference_ = 0, maps_ = 0, bases_ = 0;  // layers: maps, heavier head, refined
  double extra_ = 0;
  bool figures_ = true;
  std::vector<post::Claim> claims_;
  std::vector<Layer> layers_;
  std::vector<Pair> pairs_;
  std::vector<Work> work_;
};

}  // namespace

std::unique_ptr<Job> read_face_map(CaseFile& file) { return std::make_unique<FaceMapJob>(file); }

}  // namespace hosel::app
