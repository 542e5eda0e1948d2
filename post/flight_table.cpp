#include "post/flight_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "golf/units.hpp"
#include "post/labels.hpp"

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

}  // namespace

std::string_view suffix(DistanceUnit unit) { return unit == DistanceUnit::yards ? "yd" : "m"; }
double size(DistanceUnit unit) { return unit == DistanceUnit::yards ? 0.9144 : 1.0; }

std::span<const FlightChannel> flight_channels(DistanceUnit unit) {
  static const auto yards = channels_in(DistanceUnit::yards), metres = channels_in(DistanceUnit::metres);
  return unit == DistanceUnit::yards ? yards : metres;
}

namespace {

/// The rows of models::FlightAnswers: the channels without a run.
std::vector<FlightChannel> answer_rows(DistanceUnit unit) {
  const auto all = flight_channels(unit);
  std::vector<FlightChannel> rows(all.begin(), all.end());
  std::erase_if(rows, [](const FlightChannel& c) { return c.name == "total"; });
  return rows;
}

}  // namespace

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

TextTable budget_table(const models::FlightBudget& b, const std::vector<models::LaunchError>& errors,
                       DistanceUnit unit) {
  TextTable table{.rows = {{"", "value", "integration"}}, .first_width = 30, .least_width = 12, .even = false};
  auto& head = table.rows[0];
  for (const models::LaunchError& e : errors) head.push_back(e.source);
  if (errors.size() > 1) head.emplace_back("launch, all");
  if (b.law) head.emplace_back("law");
  for (const auto& law : b.laws) head.push_back(law.name);
  const auto rows = answer_rows(unit);
  for (int a = 0; a < models::kFlightAnswers; ++a) {
    const FlightChannel& r = rows[std::size_t(a)];
    auto& row = table.rows.emplace_back();
    row = {fmt::format("{} [{}]", spoken(r.name), r.unit), fmt::format("{:.2f}", b.value[a] / r.si),
           fmt::format("+- {:.0e}", b.numerical[a] / r.si)};
    for (const models::FlightAnswers& sd : b.launch) row.push_back(fmt::format("+- {:.2f}", sd[a] / r.si));
    if (errors.size() > 1) row.push_back(fmt::format("+- {:.2f}", b.launch_total[a] / r.si));
    if (b.law) row.push_back(fmt::format("+- {:.2f}", (*b.law)[a] / r.si));
    for (const auto& law : b.laws) row.push_back(fmt::format("{:.2f}", law.value[a] / r.si));
  }
  if (!b.laws.empty()) {
    auto& row = table.rows.emplace_back(table.rows[0].size() - b.laws.size());
    row[0] = "time outside the law's range";
    row[1] = fmt::format("{:.0f} %", 100 * b.outside);
    for (const auto& law : b.laws) row.push_back(fmt::format("{:.0f} %", 100 * law.outside));
  }
  return table;
}

nlohmann::json to_json(const models::FlightBudget& b, const std::vector<models::LaunchError>& errors,
                       DistanceUnit unit) {
  nlohmann::json out;
  const auto rows = answer_rows(unit);
  for (int a = 0; a < models::kFlightAnswers; ++a) {
    const FlightChannel& row = rows[std::size_t(a)];
    nlohmann::json& j = out[fmt::format("{}_{}", row.name, row.unit)];
    j = {{"value", b.value[a] / row.si}, {"integration", b.numerical[a] / row.si}};
    for (std::size_t i = 0; i < errors.size(); ++i) j["launch"][errors[i].source] = b.launch[i][a] / row.si;
    if (!errors.empty()) j["launch_total"] = b.launch_total[a] / row.si;
    if (b.law) j["law"] = (*b.law)[a] / row.si;
    for (const auto& law : b.laws) j["laws"][law.name] = law.value[a] / row.si;
  }
  return out;
}

}  // namespace hosel::post
