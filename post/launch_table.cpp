#include "post/launch_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "golf/units.hpp"
#include "post/digits.hpp"
#include "post/labels.hpp"

namespace hosel::post {
namespace {
constexpr std::array kChannels = {
    Channel{"ball_speed", "mps", 1.0, &Launch::ball_speed, 2},
    Channel{"launch_angle", "deg", kRadPerDeg, &Launch::launch_angle, 2},
    Channel{"azimuth", "deg", kRadPerDeg, &Launch::azimuth, 2},
    Channel{"backspin", "rpm", kRadPerSecPerRpm, &Launch::backspin, 0},
    Channel{"sidespin", "rpm", kRadPerSecPerRpm, &Launch::sidespin, 0},
    Channel{"riflespin", "rpm", kRadPerSecPerRpm, &Launch::riflespin, 0},
    Channel{"spin_rate", "rpm", kRadPerSecPerRpm, &Launch::spin_rate, 0},
    Channel{"spin_axis", "deg", kRadPerDeg, &Launch::spin_axis, 2},
};

/// Model minus measurement over the measurement's standard deviation.
double off_by(const Launch& launch, const MeasuredValue& m) {
  const double si = m.channel->si;
  return difference(*m.channel, (launch.*m.channel->value)() / si, m.value / si) * si / m.uncertainty;
}
}  // namespace

const MeasuredValue* find(const Measured& measured, const Channel* channel) {
  const auto it = std::ranges::find(measured, channel, &MeasuredValue::channel);
  return it == measured.end() ? nullptr : &*it;
}

std::vector<std::string> outside(const LaunchColumn& column, const Measured& measured, const MeasuredOblique& ranges) {
  const Launch& launch = column.launch;
  std::vector<std::string> out;
  for (const MeasuredValue& m : measured) {
    if (!(m.uncertainty > 0)) continue;
    const double off = off_by(launch, m);
    if (std::abs(off) <= 2) continue;
    out.push_back(fmt::format("{} is {:.1f} standard deviations of the measurement {}: {}", m.channel->name,
                              std::abs(off), off > 0 ? "too high" : "too low",
                              m.explained.empty() ? "the case gives no reason" : m.explained));
  }
  const auto ranged = [&](const char* name, std::optional<double> value, const Range& range, const std::string& why) {
    if (!value || !range || (*value >= range->first && *value <= range->second)) return;
    out.push_back(fmt::format("{} is {:.3f}, outside the {:g} to {:g} that others measured: {}", name, *value,
                              range->first, range->second, why.empty() ? "the case gives no reason" : why));
  };
  ranged("e_t", column.oblique.tangential_restitution, ranges.tangential_restitution,
         ranges.tangential_restitution_explained);
  ranged("launch ratio", column.oblique.launch_ratio, ranges.launch_ratio, ranges.launch_ratio_explained);
  return out;
}

std::span<const Channel> channels() { return kChannels; }

double difference(const Channel& channel, double a, double b) {
  return channel.unit == "deg" ? std::remainder(a - b, 360) : a - b;
}

const Channel* find_channel(std::string_view name) {
  const auto it = std::ranges::find(kChannels, name, &Channel::name);
  return it == kChannels.end() ? nullptr : &*it;
}

std::string channel_names() {
  std::string all;
  for (const Channel& c : kChannels) all += fmt::format("{}{}", all.empty() ? "" : ", ", c.name);
  return all;
}

TextTable launch_table(const std::vector<LaunchColumn>& columns, const Measured& measured,
                       const MeasuredOblique& ranges, Units units) {
  const bool beside = !measured.empty() || ranges.tangential_restitution || ranges.launch_ratio;
  TextTable table{.rows = {{""}}};
  for (const LaunchColumn& c : columns) table.rows[0].push_back(c.title);
  if (beside) table.rows[0].emplace_back("measured");
  const bool judged = std::ranges::any_of(measured, [](const MeasuredValue& m) { return m.uncertainty > 0; });
  if (judged)
    table.rows[0].push_back(columns.size() > 1 ? fmt::format("{} off by [sd]", columns.back().title) : "off by [sd]");
  for (Channel channel : kChannels) {
    const Channel* const measured_as = find_channel(channel.name);
    if (channel.unit == "mps" && units == Units::golf) channel.unit = "mph", channel.si = kMpsPerMph;
    auto& row = table.rows.emplace_back();
    row.push_back(fmt::format("{} [{}]", spoken(channel.name), channel.unit == "mps" ? "m/s" : channel.unit));
    for (const LaunchColumn& c : columns) {
      double shown = (c.launch.*channel.value)() / channel.si;
      const double error =
          c.coarser ? std::abs(difference(channel, shown, ((*c.coarser).*channel.value)() / channel.si)) : 0;
      // Without spin its axis has no direction.
      if (channel.name == "spin_axis" && rpm(c.launch.spin_rate()) < 0.5) shown = 0;
      row.push_back(fixed(shown, channel.decimals));
      if (c.coarser) row.back() += " +-" + error_bound(error, channel.decimals);
    }
    if (!beside) continue;
    const MeasuredValue* const m = find(measured, measured_as);
    row.push_back(m ? fixed(m->value / channel.si, channel.decimals) : "-");
    if (m && m->uncertainty > 0) row.back() += fmt::format(" +-{:.{}f}", m->uncertainty / channel.si, channel.decimals);
    if (judged) row.push_back(m && m->uncertainty > 0 ? fixed(off_by(columns.back().launch, *m), 1, true) : "-");
  }
  const auto add = [&](const char* name, std::optional<double> Oblique::*value, const Range& range) {
    if (!range && std::ranges::none_of(columns, [&](const LaunchColumn& c) { return (c.oblique.*value).has_value(); }))
      return;
    auto& row = table.rows.emplace_back(1, name);
    for (const LaunchColumn& c : columns) row.push_back(c.oblique.*value ? fixed(*(c.oblique.*value), 3) : "-");
    if (beside) row.push_back(range ? fmt::format("{:g} to {:g}", range->first, range->second) : "-");
    if (judged) row.emplace_back();
  };
  add("e_t [-]", &Oblique::tangential_restitution, ranges.tangential_restitution);
  add("launch ratio [-]", &Oblique::launch_ratio, ranges.launch_ratio);
  const auto flown = std::ranges::find_if(columns, [](const LaunchColumn& c) { return c.flight.has_value(); });
  if (flown == columns.end()) return table;
  for (const FlightChannel& channel : flight_channels(flown->flight->unit)) {
    if (std::ranges::none_of(columns, [&](const LaunchColumn& c) { return c.flight && channel.value(*c.flight); }))
      continue;
    auto& row = table.rows.emplace_back(1, fmt::format("{} [{}]", spoken(channel.name), channel.unit));
    for (const LaunchColumn& c : columns) {
      const auto x = c.flight ? channel.value(*c.flight) : std::nullopt;
      row.push_back(x ? fixed(*x / channel.si, channel.decimals) : "-");
    }
  }
  return table;
}

nlohmann::json to_json(const Launch& launch) {
  nlohmann::json out;
  for (const Channel& c : kChannels) out[fmt::format("{}_{}", c.name, c.unit)] = (launch.*c.value)() / c.si;
  const auto list = [](const Vec3& v) { return nlohmann::json{v.x(), v.y(), v.z()}; };
  out["head_velocity_mps"] = list(launch.head_velocity);
  out["head_spin_rad_per_s"] = list(launch.head_spin);
  return out;
}

}  // namespace hosel::post
