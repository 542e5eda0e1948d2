#include "hosel/post/flight_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "hosel/golf/units.hpp"

namespace hosel::post {
namespace {

std::array<FlightChannel, 6> channels_in(DistanceUnit unit) {
  const std::string_view name = suffix(unit);
  const double si = size(unit);
  const auto total = [](const ShotFlight& s) { return s.run ? std::optional(s.run->total) : std::nullopt; };
  return {FlightChannel{"carry", name, si, 1, [](const ShotFlight& s) { return std::optional(s.flight.carry); }},
          FlightChannel{"total", name, si, 1, total},
          FlightChannel{"side", name, si, 1, [](const ShotFlight& s) { return std::optional(s.flight.side); }},
          FlightChannel{"apex", name, si, 1, [](const ShotFlight& s) { return std::optional(s.flight.apex); }},
          FlightChannel{"flight_time", "s", 1, 2, [](const ShotFlight& s) { return std::optional(s.flight.time); }},
          FlightChannel{"landing_angle", "deg", kRadPerDeg, 1,
                        [](const ShotFlight& s) { return std::optional(s.flight.landing_angle); }}};
}

/// The rows of models::FlightAnswers.
struct AnswerRow {
  std::string_view name, unit;
  double si;
};
std::array<AnswerRow, models::kFlightAnswers> answer_rows(DistanceUnit unit) {
  const std::string_view d = suffix(unit);
  const double si = size(unit);
  return {AnswerRow{"carry", d, si},
          {"side", d, si},
          {"apex", d, si},
          {"flight_time", "s", 1},
          {"landing_angle", "deg", kRadPerDeg}};
}

}  // namespace

std::string_view suffix(DistanceUnit unit) { return unit == DistanceUnit::yards ? "yd" : "m"; }
double size(DistanceUnit unit) { return unit == DistanceUnit::yards ? 0.9144 : 1.0; }

std::span<const FlightChannel> flight_channels(DistanceUnit unit) {
  static const auto yards = channels_in(DistanceUnit::yards), metres = channels_in(DistanceUnit::metres);
  return unit == DistanceUnit::yards ? yards : metres;
}

nlohmann::json to_json(const ShotFlight& shot) {
  nlohmann::json out;
  for (const FlightChannel& c : flight_channels(shot.unit))
    if (const auto x = c.value(shot)) out[fmt::format("{}_{}", c.name, c.unit)] = *x / c.si;
  if (shot.run) {
    out[fmt::format("total_firm_{}", suffix(shot.unit))] = shot.run->total_firm / size(shot.unit);
    out[fmt::format("total_slow_{}", suffix(shot.unit))] = shot.run->total_slow / size(shot.unit);
  }
  out["outside_law_range"] = shot.flight.outside;
  return out;
}

std::string budget_table(const models::FlightBudget& b, const std::vector<models::LaunchError>& errors,
                         DistanceUnit unit) {
  // A title, then a cell an answer; widths are those of the titles.
  std::vector<std::vector<std::string>> columns = {{""}, {"value"}, {"integration"}};
  for (const models::LaunchError& e : errors) columns.push_back({e.source});
  if (errors.size() > 1) columns.push_back({"launch, all"});
  for (const auto& law : b.laws) columns.push_back({law.name});
  const auto rows = answer_rows(unit);
  for (int a = 0; a < models::kFlightAnswers; ++a) {
    const AnswerRow& row = rows[std::size_t(a)];
    auto column = columns.begin();
    const auto add = [&](std::string cell) { (column++)->push_back(std::move(cell)); };
    add(fmt::format("{} [{}]", row.name, row.unit));
    add(fmt::format("{:.2f}", b.value[a] / row.si));
    add(fmt::format("+- {:.0e}", b.numerical[a] / row.si));
    for (const models::FlightAnswers& sd : b.launch) add(fmt::format("+- {:.2f}", sd[a] / row.si));
    if (errors.size() > 1) add(fmt::format("+- {:.2f}", b.launch_total[a] / row.si));
    for (const auto& law : b.laws) add(fmt::format("{:.2f}", law.value[a] / row.si));
  }
  if (!b.laws.empty()) {
    columns[0].push_back("time outside the law's range");
    for (std::size_t i = 0; i < b.laws.size(); ++i)
      columns[columns.size() - b.laws.size() + i].push_back(fmt::format("{:.0f} %", 100 * b.laws[i].outside));
  }
  std::string text;
  for (std::size_t line = 0; line < columns[0].size(); ++line) {
    if (line) text += '\n';
    text += fmt::format("{:<30}", columns[0][line]);
    for (std::size_t c = 1; c < columns.size(); ++c)
      text += fmt::format("{:>{}}", line < columns[c].size() ? columns[c][line] : "",
                          std::max<std::size_t>(12, columns[c][0].size() + 2));
  }
  return text;
}

nlohmann::json to_json(const models::FlightBudget& b, const std::vector<models::LaunchError>& errors,
                       DistanceUnit unit) {
  nlohmann::json out;
  const auto rows = answer_rows(unit);
  for (int a = 0; a < models::kFlightAnswers; ++a) {
    const AnswerRow& row = rows[std::size_t(a)];
    nlohmann::json& j = out[fmt::format("{}_{}", row.name, row.unit)];
    j = {{"value", b.value[a] / row.si}, {"integration", b.numerical[a] / row.si}};
    for (std::size_t i = 0; i < errors.size(); ++i) j["launch"][errors[i].source] = b.launch[i][a] / row.si;
    if (!errors.empty()) j["launch_total"] = b.launch_total[a] / row.si;
    for (const auto& law : b.laws) j["laws"][law.name] = law.value[a] / row.si;
  }
  return out;
}

}  // namespace hosel::post
