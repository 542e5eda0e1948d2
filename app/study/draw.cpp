#include "app/study/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "post/face_map.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

/// More lines than eyes can part.
constexpr std::size_t kMostLines = 12;

/// The design's columns, and which points a picture shows.
class StudyView {
 public:
  StudyView(const StudyTable& table, const std::vector<StudySeries>& against) : table_(table), against_(against) {
    names_ = table.design.columns();
    for (std::size_t c = 0; c < names_.size(); ++c) {
      numbers_.push_back(table.design.numbers(c));
      levels_.push_back(table.design.levels(c));
    }
    for (std::size_t d = 0; d < table.design.size(); ++d) cells_.push_back(table.design.cells(d));
  }

  const std::string& name(std::size_t column) const { return names_[column]; }
  std::size_t columns() const { return names_.size(); }
  const std::vector<double>& numbers(std::size_t column) const { return numbers_[column]; }
  std::size_t levels(std::size_t column) const { return levels_[column].size(); }
  std::optional<std::size_t> column(const std::string& name) const {
    const auto at = std::ranges::find(names_, name);
    return at == names_.end() ? std::nullopt : std::optional(std::size_t(at - names_.begin()));
  }
  /// The column of numbers with most values, the first of several, but `but`; none where there are only words.
  std::optional<std::size_t> longest(std::optional<std::size_t> but = {}) const {
    std::optional<std::size_t> out;
    for (std::size_t c = 0; c < columns(); ++c)
      if (c != but && !numbers_[c].empty() && levels(c) > 1 && (!out || levels(c) > levels(*out))) out = c;
    return out;
  }
  double value(const StudySeries& s, std::size_t d, bool difference) const {
    return difference ? table_.difference(s.output, s.y[d], against_[s.model * table_.outputs.size() + s.output].y[d])
                      : s.y[d];
  }
  /// Whether every column but those that are free stands at the middle of its values.
  bool in_middle(std::size_t d, const std::set<std::size_t>& free) const {
    for (std::size_t c = 0; c < columns(); ++c)
      if (!free.contains(c) && cells_[d][c] != levels_[c][levels(c) / 2]) return false;
    return true;
  }
  std::string middle(const std::set<std::size_t>& free) const {
    std::string text;
    for (std::size_t c = 0; c < columns(); ++c)
      if (!free.contains(c) && levels(c) > 1)
        text += (text.empty() ? "" : ", ") + said_cell(names_[c], levels_[c][levels(c) / 2], 4);
    return text;
  }
  /// The columns of words: they have no middle.
  std::set<std::size_t> words() const {
    std::set<std::size_t> out;
    for (std::size_t c = 0; c < columns(); ++c)
      if (numbers_[c].empty()) out.insert(c);
    return out;
  }
  /// Every combination of the words, as they come; at most as many as pictures are looked at.
  std::vector<std::string> wordings() const {
    std::vector<std::string> out;
    for (std::size_t d = 0; d < cells_.size() && out.size() < kMostLines; ++d)
      if (const std::string w = wording(d); std::ranges::find(out, w) == out.end()) out.push_back(w);
    return out;
  }
  std::string wording(std::size_t d) const {
    std::string text;
    for (const std::size_t c : words())
      if (levels(c) > 1) text += (text.empty() ? "" : ", ") + cells_[d][c];
    return text;
  }
  /// What tells a line from the others.
  std::string line(const StudySeries& s, std::size_t d, const std::set<std::size_t>& told) const {
    std::string text = table_.models.size() > 1 ? table_.models[s.model] : "";
    for (std::size_t c = 0; c < columns(); ++c)
      if (told.contains(c) && levels(c) > 1) text += (text.empty() ? "" : ", ") + said_cell(names_[c], cells_[d][c]);
    return text;
  }
  /// The values of a column from the lowest to the highest.
  std::vector<double> rising(std::size_t column) const {
    const std::set<double> all(numbers_[column].begin(), numbers_[column].end());
    return {all.begin(), all.end()};
  }

 private:
  const StudyTable& table_;
  const std::vector<StudySeries>& against_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> numbers_;
  std::vector<std::vector<std::string>> levels_, cells_;
};

std::string spoken_series(const StudyTable& table, const StudySeries& s) {
  return table.models.size() > 1 ? post::label(table.outputs[s.output]) : s.spoken;
}

std::string behind(std::string title, const std::string& rest) {
  return rest.empty() ? title : fmt::format("{}{}{}", title, title.empty() ? "" : "; ", rest);
}

/// What was measured of an output, over `x` of each point: one mark a value, two a range.
template <typename F>
post::Series measured_at(const StudyTable& table, std::size_t output, F x) {
  post::Series s{.label = "measured", .style = "points"};
  for (std::size_t d = 0; d < table.design.size(); ++d)
    if (const auto seen = table.seen(d, output))
      for (const double y : {seen->low, seen->high}) s.add(x(d), y);
  return s;
}

/// With which column an output goes most, over all models: a panel has one horizontal axis.
std::optional<std::size_t> strongest(const StudyTable& table, std::size_t output, const StudyEffects& effects) {
  std::vector<double> share(effects.columns.size(), 0);
  for (std::size_t m = 0; m < table.models.size(); ++m)
    if (const auto& of = effects.of[m * table.outputs.size() + output]; of)
      for (std::size_t f = 0; f < share.size(); ++f) share[f] += of->factors[f].share;
  const auto most = std::ranges::max_element(share);
  if (most == share.end() || !(*most > 0)) return {};
  return effects.columns[std::size_t(most - share.begin())];
}

post::Figure lines(const StudyTable& table, const StudyView& view, const std::string& title, const StudyFigure& wanted,
                   const std::vector<std::size_t>& outputs, const StudyEffects& effects, bool sampled) {
  post::Figure figure{.title = title, .columns = 2};
  const auto across = wanted.x.empty() ? view.longest() : view.column(wanted.x);
  for (const std::size_t o : outputs) {
    post::Panel panel;
    std::optional<std::size_t> x = across;
    if (sampled && wanted.x.empty())
      if (const auto most = strongest(table, o, effects)) x = most;
    for (std::size_t m = 0; m < table.models.size(); ++m) {
      const StudySeries& s = table.at(m, o);
      if (!x || view.numbers(*x).empty() || (sampled && s.constant())) continue;
      std::set<std::size_t> told, free = {*x};  // in a line's name; as they come
      std::size_t many = table.models.size();
      for (std::size_t c = 0; c < view.columns(); ++c) {
        if (c == *x || sampled || table.design.tied(c, *x)) {
          free.insert(c);
        } else if (many * view.levels(c) <= kMostLines) {
          told.insert(c);
          free.insert(c);
          many *= view.levels(c);
        }
      }
      if (!sampled) figure.title = behind(title, view.middle(free));
      panel.x_label = post::label(view.name(*x));
      panel.y_label = (wanted.difference ? "difference of " : "") + spoken_series(table, s);
      for (std::size_t d = 0; d < s.y.size(); ++d) {
        const double y = view.value(s, d, wanted.difference);
        if (!std::isfinite(y) || !view.in_middle(d, free)) continue;
        const std::string name = view.line(s, d, told);
        auto line = std::ranges::find(panel.series, name, &post::Series::label);
        if (line == panel.series.end())
          line = panel.series.insert(line, {.label = name, .style = sampled ? "points" : "linespoints"});
        // From left to right, whatever the order of the rows.
        const auto at = (sampled ? line->x.end() : std::ranges::upper_bound(line->x, view.numbers(*x)[d])) -
                        line->x.begin();
        line->x.insert(line->x.begin() + at, view.numbers(*x)[d]);
        line->y.insert(line->y.begin() + at, y);
      }
      if (m + 1 < table.models.size() || wanted.difference) continue;
      const auto measured = measured_at(table, o, [&](std::size_t d) { return view.numbers(*x)[d]; });
      if (measured.x.empty()) continue;
      for (post::Series& one : panel.series)
        if (one.label.empty()) one.label = "computed";
      panel.series.push_back(measured);
    }
    if (!panel.series.empty()) figure.panels.push_back(std::move(panel));
  }
  return figure;
}

post::Figure maps(const StudyTable& table, const StudyView& view, const std::string& title, const StudyFigure& wanted,
                  const std::vector<std::size_t>& outputs, std::size_t model, std::size_t x, std::size_t y,
                  const std::string& wording) {
  std::set<std::size_t> free = view.words();
  free.insert({x, y});
  const bool face = view.name(x) == "delivery.impact_toe_mm" && view.name(y) == "delivery.impact_high_mm";
  post::Figure figure{.title = behind(title, view.middle(free)), .columns = 3, .panel_width = 520, .panel_height = 400};
  if (face) {
    figure.title = behind(figure.title, post::kFaceView);
    figure.panel_width = 640;
    figure.panel_height = 330;
  }
  const std::vector<double> xs = view.rising(x), ys = view.rising(y);
  for (const std::size_t o : outputs) {
    const StudySeries& s = table.at(model, o);
    const std::string label = post::label(table.outputs[o]);
    const auto cut = label.find(" [");
    const std::string unit = cut == label.npos ? "[-]" : label.substr(cut + 1);
    post::Panel panel{.title = wanted.difference ? label.substr(0, cut) : spoken_series(table, s),
                      .x_label = post::label(view.name(x)),
                      .y_label = post::label(view.name(y)),
                      .map_x = xs,
                      .map_y = ys,
                      .map = std::vector<double>(xs.size() * ys.size(), NAN),
                      .map_label = wanted.difference ? "difference " + unit : unit,
                      .map_symmetric = wanted.difference};
    if (face) post::frame_face(panel);
    for (std::size_t d = 0; d < s.y.size(); ++d) {
      if (!view.in_middle(d, free) || view.wording(d) != wording) continue;
      const auto at = [](const std::vector<double>& all, double v) {
        return std::size_t(std::ranges::lower_bound(all, v) - all.begin());
      };
      panel.map[at(ys, view.numbers(y)[d]) * xs.size() + at(xs, view.numbers(x)[d])] =
          view.value(s, d, wanted.difference);
    }
    // Where both say the same everywhere there is nothing to see: the table says so.
    if (wanted.difference && std::ranges::all_of(panel.map, [](double v) { return !(std::abs(v) > 1e-9); })) continue;
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

/// A name that leaves a picture its width: of a longer one the middle is left out, whole characters of it.
std::string shortened(const std::string& name) {
  constexpr std::size_t most = 60, begin = 40, end = 17;
  if (name.size() <= most) return name;
  const auto whole = [&](std::size_t at) {
    while (at < name.size() && (static_cast<unsigned char>(name[at]) & 0xC0) == 0x80) ++at;
    return at;
  };
  return name.substr(0, whole(begin)) + "..." + name.substr(whole(name.size() - end));
}

/// Every point in a row, what was measured beside.
post::Figure bars(const StudyTable& table, const std::string& title, const std::vector<std::size_t>& outputs) {
  std::size_t widest = 0;
  std::vector<std::string> names;
  for (std::size_t d = 0; d < table.design.size(); ++d) {
    names.push_back(shortened(table.design.said(d)));
    widest = std::max(widest, names.back().size());
  }
  post::Figure figure{
      .title = title, .columns = 3, .panel_width = 400 + 8 * int(widest), .panel_height = 130 + 22 * int(names.size())};
  for (const std::size_t o : outputs) {
    post::Panel panel{.x_label = post::label(table.outputs[o]), .y_names = names};
    for (std::size_t m = 0; m < table.models.size(); ++m) {
      post::Series s{.label = table.one_model(m) ? table.models[m] : "computed", .style = "points"};
      for (std::size_t d = 0; d < names.size(); ++d)
        if (const double y = table.at(m, o).y[d]; std::isfinite(y)) s.add(y, -double(d));
      panel.series.push_back(std::move(s));
    }
    post::Series measured = measured_at(table, o, [](std::size_t d) { return -double(d); });
    std::swap(measured.x, measured.y);
    if (!measured.x.empty()) panel.series.push_back(std::move(measured));
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

std::vector<StudyFigure> suggested(const StudyTable& table, const StudyView& view, const StudyEffects& effects,
                                   const std::optional<StudyReference>& reference) {
  using Kind = StudyFigure::Kind;
  std::vector<StudyFigure> out;
  const bool models = reference && reference->model;
  const bool effect = std::ranges::any_of(effects.of, [](const auto& e) { return e.has_value(); });
  const auto x = view.longest(), y = view.longest(x);
  if (table.design.grid() && table.design.columns().size() <= 3) {
    if (reference && (models || reference->variant)) out.push_back({.kind = Kind::map, .difference = true});
    out.push_back({.kind = Kind::map});
    return out;
  }
  if (table.design.has(DesignFactor::Kind::variants) || table.design.has(DesignFactor::Kind::rows)) {
    if (table.design.size() <= 60) out.push_back({.kind = Kind::bars});
  } else if (table.design.has(DesignFactor::Kind::sample)) {
    if (effect) out.push_back({.kind = Kind::tornado});
    out.push_back({.kind = Kind::line});
    return out;
  } else if (models) {
    out.push_back({.kind = y ? Kind::map : Kind::line, .difference = true});
  } else if (x) {
    const bool wide = y && view.columns() == 2 && std::min(view.levels(*x), view.levels(*y)) > 8;
    out.push_back({.kind = wide ? Kind::map : Kind::line});
  }
  if (effect && effects.columns.size() > 2) out.push_back({.kind = Kind::tornado});
  return out;
}

}  // namespace

std::vector<StudyFigure> read_study_figures(Table root, const StudyTable& table, bool compared) {
  std::vector<StudyFigure> out;
  const auto columns = table.design.columns();
  for (Table t : root.tables("figure")) {
    StudyFigure f;
    using Figure = StudyFigure::Kind;
    f.kind = t.one_of<Figure>(
        {"kind", "lines over a column, a map over two, every point in a row, or what moves the answers most"},
        {{"line", Figure::line}, {"map", Figure::map}, {"bars", Figure::bars}, {"tornado", Figure::tornado}});
    f.outputs = t.texts({"outputs", "that are drawn; empty: all"}, std::vector<std::string>{});
    for (const std::string& o : f.outputs)
      if (!table.outputs.empty() && std::ranges::find(table.outputs, o) == table.outputs.end())
        t.fail("outputs", fmt::format("'{}' is no output of this study", o));
    for (auto [key, meaning, to] : {std::tuple{"x", "column of the design along x; empty: that of most values", &f.x},
                                    {"y", "column along y of a map; empty: the next", &f.y}}) {
      *to = t.text({key, meaning}, "");
      const auto at = std::ranges::find(columns, *to);
      if (to->empty()) continue;
      if (at == columns.end())
        t.fail(key, fmt::format("'{}' is no column of this design ({})", *to, fmt::join(columns, ", ")));
      if (table.design.numbers(std::size_t(at - columns.begin())).empty())
        t.fail(key, fmt::format("'{}' holds words: it cannot be an axis", *to));
    }
    f.difference = t.flag({"difference", "to what [compare] names"}, false);
    if (f.difference && !compared) t.fail("difference", "there is no [compare]");
    out.push_back(std::move(f));
  }
  return out;
}

void draw_study(Output& out, const StudyTable& table, const std::string& title, std::vector<StudyFigure> figures,
                const StudyEffects& effects, const std::optional<StudyReference>& reference,
                const std::vector<StudySeries>& against) {
  const StudyView view(table, against);
  if (figures.empty()) figures = suggested(table, view, effects, reference);
  const bool sampled = table.design.has(DesignFactor::Kind::sample);
  std::set<std::string> taken;
  const auto draw = [&](const post::Figure& figure, std::string stem, bool on_page = true) {
    for (int k = 2; taken.contains(stem); ++k)
      stem = fmt::format("{}-{}", stem.substr(0, stem.find_last_not_of("-0123456789") + 1), k);
    taken.insert(stem);
    if (post::shows(figure)) out.draw(figure, "figures/" + stem, on_page);
    return post::shows(figure);
  };
  for (const StudyFigure& f : figures) {
    std::vector<std::size_t> outputs;
    for (std::size_t o = 0; o < table.outputs.size(); ++o)
      if (f.outputs.empty() || std::ranges::find(f.outputs, table.outputs[o]) != f.outputs.end()) outputs.push_back(o);
    const std::string of = f.difference && reference ? fmt::format("minus {}", reference->name) : "";
    switch (f.kind) {
      case StudyFigure::Kind::line:
        draw(lines(table, view, behind(title, of), f, outputs, effects, sampled), "line");
        break;
      case StudyFigure::Kind::bars: draw(bars(table, title, outputs), "bars"); break;
      case StudyFigure::Kind::tornado: {
        std::vector<std::size_t> series;
        for (std::size_t m = 0; m < table.models.size(); ++m)
          for (const std::size_t o : outputs) series.push_back(m * table.outputs.size() + o);
        draw(tornado(table, effects, series), "tornado");
        break;
      }
      case StudyFigure::Kind::map: {
        const auto x = f.x.empty() ? view.longest(view.column(f.y)) : view.column(f.x);
        const auto y = f.y.empty() ? view.longest(x) : view.column(f.y);
        if (!x || !y) break;
        bool on_page = true;  // of a face the first map alone; the others are links
        for (const std::string& wording : view.wordings())
          for (std::size_t m = 0; m < table.models.size(); ++m) {
            if (f.difference && reference && reference->model == m) continue;
            std::string name = wording;
            if (name.empty() || table.models.size() > 1) name += (name.empty() ? "" : ", ") + table.models[m];
            const std::string what = f.difference   ? fmt::format("{} {}", name, of)
                                     : name.empty() ? title
                                                    : behind(name, title);
            const bool drawn = draw(
                maps(table, view, what, f, outputs, m, *x, *y, wording),
                (f.difference ? "difference" : "map") + (name.empty() ? name : "-" + out.file_name(name)), on_page);
            if (drawn && table.design.grid()) on_page = false;
          }
      }
    }
  }
}

}  // namespace hosel::app
