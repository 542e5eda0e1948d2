#include "app/study/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/study/compare.hpp"
#include "post/digits.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

using nlohmann::json;

class PartsReport {
 public:
  PartsReport(Output& out, const StudyTable& table, const StudyParts& parts)
      : out_(out), table_(table), parts_(parts), columns_(table.design.columns()) {
    const Design& design = table.design;
    block_ = design.size() / design.factors().front().levels.size();
    for (std::size_t c = 1; c < columns_.size(); ++c)
      if (!parts.over || !(c == *parts.over || design.tied(c, *parts.over))) where_.push_back(c);
    std::map<std::vector<std::string>, std::size_t> known;
    for (std::size_t p = 0; p < block_; ++p) {
      std::vector<std::string> cells;
      for (const std::size_t c : where_) cells.push_back(design.cells(p)[c]);
      const auto [at, fresh] = known.try_emplace(cells, places_.size());
      if (fresh) places_.push_back({cells, {}});
      places_[at->second].points.push_back(p);
    }
  }

  json report(bool draw) {
    post::Table table{{{"part"}, {"model"}}};
    for (const std::size_t c : where_) table.in_files({columns_[c]});
    for (const std::string& o : table_.outputs)
      table.in_files(parts_.over ? std::vector{o + "_mean", o + "_low", o + "_high"} : std::vector{o}, "{:.9g}");
    json summary = json::object();
    for (std::size_t m = 0; m < table_.models.size(); ++m)
      for (const StudyParts::Part& part : parts_.all) {
        json& said = table_.models.size() > 1 ? summary[table_.models[m]][part.name] : summary[part.name];
        for (const Place& place : places_) {
          table.add(part.name, table_.one_model(m) ? table_.models[m] : "", place.cells);
          for (std::size_t o = 0; o < table_.outputs.size(); ++o) {
            const StudySeries::Spread s = difference(part, m, o, place).spread();
            table.more(post::if_finite(s.mean));
            if (parts_.over) table.more(post::if_finite(s.low), post::if_finite(s.high));
          }
        }
        tell(part, m, said);
      }
    out_.write("parts.csv", table.csv());
    if (draw && on_face())
      for (std::size_t m = 0; m < table_.models.size(); ++m) maps(m);
    return summary;
  }

 private:
  struct Place {
    std::vector<std::string> cells;
    std::vector<std::size_t> points;  ///< one a value of the column `over`
  };

  StudySeries difference(const StudyParts::Part& part, std::size_t model, std::size_t output,
                         const Place& place) const {
    StudySeries out;
    const std::vector<double>& y = table_.at(model, output).y;
    for (const std::size_t p : place.points)
      out.y.push_back(table_.difference(output, y[part.of * block_ + p], y[part.minus * block_ + p]) / part.per);
    return out;
  }

  /// The largest value of an output in the two variants of a part.
  double size_of(const StudyParts::Part& part, std::size_t model, std::size_t output) const {
    const std::vector<double>& y = table_.at(model, output).y;
    double most = 0;
    for (std::size_t p = 0; p < block_; ++p)
      for (const std::size_t variant : {part.of, part.minus})
        if (const double x = std::abs(y[variant * block_ + p]); x > most) most = x;  // not NaN
    return most;
  }

  /// Of the 95 % interval by independent deviations from the value `parts_from`; NaN where one of them is not known.
  double half_width(const StudySeries& of) const {
    double square = 0;
    for (const double y : of.y) square += std::pow(y - of.y[*parts_.from], 2);
    return 1.96 * std::sqrt(square);
  }

  bool on_face() const { return table_.design.grid() && places_.size() == table_.design.grid()->size(); }

  /// The mean over the places, and each of them where they are few.
  void tell(const StudyParts::Part& part, std::size_t model, json& said) const {
    constexpr std::size_t few = 9;
    // A row is a change at a place, or the mean of several; over `over` each row is a mean.
    post::TextTable shown{
        .rows = {{"output", parts_.over ? "mean" : "change"}}, .margin = 1, .least_width = 10, .even = false};
    if (parts_.over) shown.rows[0].insert(shown.rows[0].end(), {"lowest", "highest"});
    if (parts_.from) shown.rows[0].push_back(table_.design.levels(*parts_.over)[*parts_.from] + ", 95 %");
    if (places_.size() > 1) shown.rows[0].push_back("where");
    const auto add = [&](std::size_t o, const StudySeries& of, const std::string& where, json& at) {
      const StudySeries::Spread s = of.spread();
      if (!std::isfinite(s.mean)) return;
      json& j = at[table_.outputs[o]];
      j = s.mean;
      // What both variants have in common is the scale of their difference's round-off.
      const double scale = size_of(part, model, o) / part.per;
      const auto number = [&](double x) { return post::beside(x, scale, true); };
      auto& row = shown.rows.emplace_back(std::vector{post::label(table_.outputs[o]), number(s.mean)});
      if (parts_.over) {
        j = {{"mean", s.mean}, {"low", s.low}, {"high", s.high}};
        for (std::size_t k = 0; k < of.y.size(); ++k)
          if (std::isfinite(of.y[k])) j["each"][table_.design.cells(places_.front().points[k])[*parts_.over]] = of.y[k];
        row.insert(row.end(), {number(s.low), number(s.high)});
        if (parts_.from && std::isfinite(of.y[*parts_.from])) {
          const double own = of.y[*parts_.from], half = half_width(of);
          j["from"] = own;
          if (std::isfinite(half)) j["half_width_95"] = half;
          row.push_back(number(own) + (std::isfinite(half) ? fmt::format(" ± {:.2g}", half) : ", a row has no answer"));
        }
      }
      if (places_.size() > 1) row.push_back(where);
    };
    std::vector<std::string> equal;  // outputs that are the same in both, at every place
    for (std::size_t o = 0; o < table_.outputs.size(); ++o) {
      const std::size_t rows = shown.rows.size();
      bool differs = false;
      StudySeries mean;
      mean.y.resize(places_.front().points.size());
      std::vector<std::size_t> known(mean.y.size());
      for (std::size_t k = 0; k < places_.size(); ++k) {
        const StudySeries there = difference(part, model, o, places_[k]);
        differs = differs || std::ranges::any_of(there.y, [](double y) { return y != 0; });
        for (std::size_t i = 0; i < mean.y.size(); ++i)
          if (std::isfinite(there.y[i])) mean.y[i] += there.y[i], ++known[i];
        if (places_.size() > few || places_.size() == 1) continue;
        std::string where;
        for (std::size_t c = 0; c < where_.size(); ++c)
          where += (c ? ", " : "") + said_cell(columns_[where_[c]], places_[k].cells[c]);
        add(o, there, where, said["at"][k]);
      }
      for (std::size_t i = 0; i < mean.y.size(); ++i) mean.y[i] /= double(known[i]);  // NaN of nothing
      const std::size_t least = std::ranges::min(known);
      add(o, mean, least == places_.size() ? "mean" : "mean of " + post::counted(least, "place"), said["mean"]);
      if (differs) continue;
      shown.rows.resize(rows);
      equal.push_back(post::spoken_key(table_.outputs[o]).words);
    }
    const std::string title = fmt::format("{}{}: {} minus {}",
                                          table_.models.size() > 1 ? table_.models[model] + ", " : "", part.name,
                                          variant(part.of), variant(part.minus));
    out_.tell(title);
    if (shown.rows.size() > 1) out_.show(shown, title);
    if (!equal.empty()) out_.say(fmt::format("{}: no difference in {}", part.name, fmt::join(equal, ", ")));
  }

  std::string variant(std::size_t level) const { return table_.design.factors().front().levels[level].cells.front(); }

  /// Every part over the face, and along its middle row with bars for the band: the upper one of two.
  void maps(std::size_t model) const {
    const post::FaceGrid& grid = *table_.design.grid();
    post::Figure face{.title = fmt::format("part by part; {}", post::kFaceView),
                      .columns = int(parts_.all.size()),
                      .panel_width = 640,
                      .panel_height = 330};
    const int middle = grid.rows / 2;
    post::Figure along{
        .title = (grid.rows % 2 ? std::string("along the middle of the face")
                                : fmt::format("along the face, {:.1f} mm above its middle", 1e3 * grid.high(middle))) +
                 (parts_.over ? "; bars: from the lowest to the highest over each " + columns_[*parts_.over] : ""),
        .columns = 2,
        .panel_width = 560,
        .panel_height = 330};
    for (std::size_t o = 0; o < table_.outputs.size(); ++o) {
      const std::string name = post::label(table_.outputs[o]),
                        unit = name.substr(std::min(name.find(" ["), name.size()));
      post::Panel panel{.x_label = "heel  <-  impact toe [mm]  ->  toe", .y_label = "change of " + name};
      for (const StudyParts::Part& part : parts_.all) {
        std::vector<double> mean;
        post::Series line{.label = part.name, .style = "linespoints"};
        for (std::size_t p = 0; p < grid.size(); ++p) {
          const StudySeries::Spread s = difference(part, model, o, places_[p]).spread();
          mean.push_back(s.mean);
          if (p / std::size_t(grid.columns) != std::size_t(middle)) continue;
          line.add(1e3 * grid.toe_at(p), (s.low + s.high) / 2);
          line.error.push_back((s.high - s.low) / 2);
        }
        const std::string what = part.name + ": " + name.substr(0, name.size() - unit.size());
        face.panels.push_back(post::face_panel(grid, mean, what, unit, true));
        panel.series.push_back(std::move(line));
      }
      along.panels.push_back(std::move(panel));
    }
    const std::string whose = table_.models.size() > 1 ? "-" + out_.file_name(table_.models[model]) : "";
    out_.draw(face, "figures/parts" + whose, false);
    out_.draw(along, "figures/along" + whose);
  }

  Output& out_;
  const StudyTable& table_;
  const StudyParts& parts_;
  std::vector<std::string> columns_;
  std::vector<std::size_t> where_;  ///< columns that say a place
  std::size_t block_ = 0;           ///< points of one variant
  std::vector<Place> places_;
};

}  // namespace

StudyParts read_parts(Table root, const StudyTable& table) {
  StudyParts out;
  std::vector<std::string> taken;
  const bool varies = table.design.has(DesignFactor::Kind::variants);
  for (Table t : root.tables("part")) {
    if (!varies) t.fail("of", "a part is one [[variant]] minus another");
    const auto variants = table.design.levels(0);
    const auto variant = [&](Key key) { return number_of(t, key.name, "variant", t.text(key), variants); };
    out.all.push_back({t.name({"name", "of the part"}, taken), variant({"of", "the variant"}),
                       variant({"minus", "the variant that is taken from it"}),
                       t.number({"per", "by which the difference is divided"}, Range::positive(), 1.0)});
    if (out.all.back().of == out.all.back().minus) t.fail("minus", "is the variant of `of`: their difference is zero");
  }
  if (!root.has("parts_over")) return out;
  const auto columns = table.design.columns();
  out.over = number_of(
      root, "parts_over", "column",
      root.text({"parts_over", "column of the design over whose values each [[part]] has mean, lowest and highest"}),
      columns);
  if (out.all.empty() || *out.over == 0)
    root.fail("parts_over", "a column beside the variants, of a study with a [[part]]");
  if (!table.design.tells_apart(*out.over))
    root.fail("parts_over", "some of its values stand there twice: a column that tells them apart, as their `name`");
  if (root.has("parts_from"))
    out.from =
        number_of(root, "parts_from", "value",
                  root.text({"parts_from", "one of these values: each other is a standard deviation away from it"}),
                  table.design.levels(*out.over));
  return out;
}

nlohmann::json report_parts(Output& out, const StudyTable& table, const StudyParts& parts, bool draw) {
  return PartsReport(out, table, parts).report(draw);
}

}  // namespace hosel::app
