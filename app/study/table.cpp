#include "app/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "post/digits.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
using nlohmann::json;

StudySeries::Spread StudySeries::spread() const {
  Spread s{NAN, 0, NAN};
  int count = 0;
  for (const double v : y) {
    if (!std::isfinite(v)) continue;
    s.low = std::fmin(s.low, v);
    s.high = std::fmax(s.high, v);
    s.mean += v;
    ++count;
  }
  s.mean /= count;  // NaN of nothing
  return s;
}

bool StudySeries::constant() const {
  const auto [low, mean, high] = spread();
  return std::isfinite(mean) && fmt::format("{:.4g}", low) == fmt::format("{:.4g}", high);
}

/// An entry in words. Which of several of one name is meant stands in the tables before it: "holds" of what?
std::string StudyTable::spoken_entry(std::size_t output) const {
  const auto own = [](std::string entry) {
    if (entry.ends_with(".value")) entry.resize(entry.size() - 6);
    if (const auto at = entry.rfind("statements."); at != entry.npos && entry.ends_with(".share"))
      return fmt::format("statement {} holds", 1 + std::atoi(entry.c_str() + at + 11));
    return post::label(entry);
  };
  const std::string& entry = outputs[output];
  std::string name = own(entry);
  if (std::ranges::count(outputs, name, own) == 1) return name;
  std::string tables = entry.substr(0, std::min(entry.find(".figures."), entry.find(".statements.")));
  if (tables == entry) tables = entry.substr(0, entry.rfind('.'));
  return fmt::format("{}: {}", post::spoken(tables), name);
}

double StudyTable::difference(std::size_t output, double a, double b) const {
  const std::string stem = split_unit(outputs[output]).stem;
  const post::Channel* channel = post::find_channel(stem.substr(stem.rfind('.') + 1));
  if (!channel) return a - b;
  const double scale = split_unit(outputs[output]).unit->si / channel->si;  // angles go round in degrees
  return post::difference(*channel, scale * a, scale * b) / scale;
}

void StudyTable::fill(const std::vector<json>& points) {
  if (outputs.empty()) {
    json all = json::object();
    for (const json& p : points)
      if (!p.contains("error")) all.update(p);
    for (const auto& [name, value] : all.items())
      if (name != "doubts") outputs.push_back(name);
  } else if (asked.empty()) {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const std::string& o : outputs)
        if (!points[i].contains("error") && !points[i].contains(o))
          throw InputError(fmt::format("outputs: point {} has no number '{}' in its summary", i, o));
  }
  series.clear();
  for (std::size_t m = 0; m < models.size(); ++m)
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      StudySeries s{.name = outputs[o], .spoken = spoken_entry(o), .model = m, .output = o};
      if (models.size() > 1) {
        s.name = fmt::format("{}.{}", models[m], outputs[o]);
        s.spoken += ", " + models[m];
      }
      for (std::size_t d = 0; d < design.size(); ++d) {
        const json& p = points[d * models.size() + m];
        s.y.push_back(!p.contains("error") && p.contains(outputs[o]) ? p[outputs[o]].get<double>() : std::nan(""));
      }
      series.push_back(std::move(s));
    }
}

bool StudyTable::one_model(std::size_t model) const {
  if (models[model].empty()) return false;
  for (std::size_t i = model; i < asked.size(); i += models.size())
    if (asked[i] != models[model]) return false;
  return true;
}

std::string StudyTable::csv(const std::vector<json>& points) const {
  const bool other = models.front().empty();
  post::Table table = other ? post::Table{{{"point"}}} : places();
  if (other) table.in_files(design.columns());
  table.in_files(outputs).in_files({"error"});
  for (std::size_t i = 0; i < points.size(); ++i) {
    table.add(i);
    if (!other) table.more(model_of(i));
    table.more(design.cells(i / models.size()));
    const bool failed = points[i].contains("error");
    for (const std::string& o : outputs) table.more(failed || !points[i].contains(o) ? "" : points[i][o].dump());
    table.more(failed ? points[i]["error"].get<std::string>() : "");
  }
  return table.csv();
}

post::Table StudyTable::places() const {
  post::Table table{{{"point"}, {"model"}}};
  return table.in_files(design.columns());
}

bool StudyTable::measures(const MeasuredRange& m, std::size_t output) const {
  if (m.name == outputs[output]) return true;
  const SplitName own = split_unit(m.name), wanted = split_unit(outputs[output]);
  return own.unit && wanted.unit && own.stem == wanted.stem && own.unit->dimension == wanted.unit->dimension;
}

std::optional<MeasuredRange> StudyTable::seen(std::size_t point, std::size_t output) const {
  std::vector<MeasuredRange> all = design.measured(point);
  all.insert(all.end(), measured.begin(), measured.end());
  for (const MeasuredRange& m : all) {
    if (!measures(m, output)) continue;
    if (m.name == outputs[output]) return m;
    const double factor = split_unit(m.name).unit->si / split_unit(outputs[output]).unit->si;
    return MeasuredRange{outputs[output], m.low * factor, m.high * factor};
  }
  return {};
}

post::TextTable StudyTable::rows() const {
  constexpr std::size_t most = 60;
  if (design.size() * models.size() > most) return {};
  post::TextTable table{.rows = {{"point"}}, .margin = 1, .least_width = 9, .even = false};
  if (models.size() > 1) table.rows[0].push_back("model");
  std::vector<bool> measured_too(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    table.rows[0].push_back(spoken_entry(o));
    for (std::size_t d = 0; d < design.size(); ++d) measured_too[o] = measured_too[o] || seen(d, o);
    if (measured_too[o]) table.rows[0].insert(table.rows[0].end(), {"measured", "off [%]"});
  }
  std::vector<double> scale;  // of each series: its round-off is no digit
  for (const StudySeries& s : series) {
    const auto [low, mean, high] = s.spread();
    scale.push_back(std::isfinite(mean) ? std::max(std::abs(low), std::abs(high)) : 0);
  }
  for (std::size_t d = 0; d < design.size(); ++d)
    for (std::size_t m = 0; m < models.size(); ++m) {
      auto& row = table.rows.emplace_back(std::vector{design.said(d)});
      if (row.front().empty()) row.front() = fmt::format("{}", d);
      if (models.size() > 1) row.push_back(models[m]);
      for (std::size_t o = 0; o < outputs.size(); ++o) {
        const double y = at(m, o).y[d];
        row.push_back(std::isfinite(y) ? post::beside(y, scale[m * outputs.size() + o], false, 5) : "-");
        if (!measured_too[o]) continue;
        const auto range = seen(d, o);
        const bool one = range && range->low == range->high;
        row.push_back(!range ? "-"
                      : one  ? fmt::format("{:.5g}", range->low)
                             : fmt::format("{:.4g} to {:.4g}", range->low, range->high));
        row.push_back(one && std::isfinite(y) && range->low != 0 ? fmt::format("{:+.2f}", 100 * (y / range->low - 1))
                                                                 : "-");
      }
    }
  return table;
}

}  // namespace hosel::app
