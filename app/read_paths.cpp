#include "app/read_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "app/read_flight.hpp"
#include "app/read_sheet.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

constexpr int kTerms = 7;

/// Ascending powers of the time.
struct Polynomial {
  std::array<double, kTerms> c;

  double at(double t) const {
    double sum = 0;
    for (int k = kTerms; k-- > 0;) sum = sum * t + c[std::size_t(k)];
    return sum;
  }
  bool finite() const {
    return std::ranges::all_of(c, [](double x) { return std::isfinite(x); });
  }
};

struct Polynomials {
  std::array<std::vector<double>, kTerms> columns;

  Polynomials(const post::Sheet& sheet, char axis) {
    for (int k = 0; k < kTerms; ++k) columns[std::size_t(k)] = column_with_gaps(sheet, fmt::format("{}{}", axis, k));
  }
  Polynomial row(std::size_t i) const {
    Polynomial p{};
    for (std::size_t k = 0; k < kTerms; ++k) p.c[k] = columns[k][i];
    return p;
  }
};

const std::vector<std::string>& text_column(Table& table, std::string_view key, const post::Sheet& sheet,
                                            const std::string& name) {
  const auto it = std::ranges::find(sheet.names, name);
  if (it == sheet.names.end()) table.fail(key, fmt::format("{}: no column '{}'", sheet.file, name));
  return sheet.columns[std::size_t(it - sheet.names.begin())];
}

/// Standard deviations of what a shot has of its own.
models::ShotUnknowns read_own(Table t) {
  models::ShotUnknowns sd;
  sd[models::kAxis] =
      t.quantity({"axis", "tilt of the spin, which is not recorded"}, "deg", Range::non_negative(), 0.15);
  sd[models::kLogSpin] = 0;  // by how the spin was found
  sd[models::kOwnDrag] = t.number({"drag", "share by which a ball's drag differs from the law's"}, {0, 1}, 0.03);
  sd[models::kOwnLift] = t.number({"lift", "share by which a ball's lift differs from the law's"}, {0, 1}, 0.03);
  sd[models::kOwnSpeed] = t.quantity({"ball_speed", "error of the recorded ball speed"}, "mps", {0, 10}, 0.3);
  sd[models::kOwnAngle] =
      t.quantity({"launch_angle", "error of the recorded launch angle"}, "deg", {0, radians(12)}, 0.003);
  sd[models::kOwnAzimuth] = t.quantity({"azimuth", "error of the recorded direction"}, "deg", {0, radians(12)}, 0.003);
  sd[models::kGustAlong] = sd[models::kGustRight] =
      t.quantity({"gust", "by which the wind of a shot differs from its group's, each direction"}, "mps", {0, 20}, 1.2);
  return sd;
}

}  // namespace

bool held_out(const std::string& player) {
  std::uint32_t hash = 2166136261U;
  for (const char c : player) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash & 1U;
}

std::vector<std::string> RadarPaths::not_used() const {
  std::vector<std::string> out;
  for (const auto& [reason, rows] : left_out)
    out.push_back(fmt::format("{} {}: not used", post::counted(std::size_t(rows), "row"), reason));
  return out;
}

std::vector<models::MeasuredPath> RadarPaths::paths(bool held) const {
  std::vector<models::MeasuredPath> out;
  for (const RadarFlight* f : flights_of(held)) out.push_back(f->path);
  return out;
}

std::vector<const RadarFlight*> RadarPaths::flights_of(bool held) const {
  std::vector<const RadarFlight*> out;
  for (const RadarFlight& f : flights)
    if (f.held_out == held) out.push_back(&f);
  return out;
}

RadarPaths read_paths(Table table, const Ball& ball) {
  RadarPaths out;
  const auto file =
      table.data_file({"file", "CSV of the followed flights: x0 to x6, y, z [m], powers of the time [s]"});
  const std::vector<std::string> group_by =
      table.texts({"group_by", "columns whose values together name a group with a wind of its own"});
  if (group_by.empty()) table.fail("group_by", "name at least one column");
  const double sample = table.quantity({"sample", "interval of the positions"}, "s", {0.05, 5}, 0.5);
  const double least_time = table.quantity({"least_time", "a shot must have been followed so long"}, "s", {0, 20}, 3.0),
               least_carry = table.quantity({"least_carry", "and carry so far"}, "m", Range::non_negative(), 180.0),
               least_angle = table.quantity({"least_launch_angle", "and start so high"}, "deg",
                                            {-radians(30), radians(60)}, radians(4));
  const double tracked =
                   table.number({"tracked_spin_error", "relative error of a spin that was tracked"}, {0, 1}, 0.01),
               estimated = table.number({"estimated_spin_error", "relative error of one that the radar estimated"},
                                        {0, 1}, 0.1);
  const double least_spin = table.quantity({"least_spin", "below it an estimated spin is none"}, "rpm",
                                           Range::non_negative(), 1200 * kRadPerSecPerRpm);
  const std::vector<double> decay = table.numbers(
      {"credible_decay_per_s", "of a tracked spin: least and most relative loss"}, 2, {0, 10}, std::vector{0.02, 0.2});
  out.model.ball = ball;
  out.model.noise = table.quantity({"noise", "of a position, each axis"}, "m", Range::positive(), out.model.noise);
  out.model.wind_sd = table.quantity({"wind", "standard deviation of a group's wind, each direction"}, "mps",
                                     Range::positive(), out.model.wind_sd);
  out.model.mean_wind_sd = table.quantity({"mean_wind", "of the mean of all groups' winds, each direction"}, "mps",
                                          Range::positive(), out.model.mean_wind_sd);
  const models::ShotUnknowns own = read_own(table.default_table("own"));
  const std::vector<std::string> only =
      table.texts({"only", "values of the column `event` that are looked at; empty: all"}, std::vector<std::string>{});
  std::map<std::string, models::Air> airs;
  for (Table t : table.tables("site")) {
    const std::string event = t.text({"event", "value of the column `event` that this air belongs to"});
    if (!airs.try_emplace(event, read_air(t)).second) t.fail("event", fmt::format("'{}' is there twice", event));
  }
  if (!std::filesystem::exists(file)) {
    out.missing = file;
    return out;
  }
  const post::Sheet sheet = read_sheet(file);
  const auto number = [&](const char* name) { return column_with_gaps(sheet, name); };
  const Polynomials x(sheet, 'x'), y(sheet, 'y'), z(sheet, 'z');
  const auto carry = number("carry_m_level"), apex = number("apex_m_poly"), level = number("time_level_s"),
             measured = number("measured_time_s"), spin = number("spin0_fit_rpm"), loss = number("spin_decay_per_s"),
             recorded = number("launch_spin_rpm");
  const auto& player = text_column(table, "file", sheet, "player");
  const auto& event = text_column(table, "file", sheet, "event");
  std::vector<const std::vector<std::string>*> naming;
  for (const std::string& name : group_by) naming.push_back(&text_column(table, "group_by", sheet, name));
  for (std::size_t i = 0; i < sheet.rows(); ++i) {
    if (!only.empty() && !std::ranges::count(only, event[i])) continue;
    const auto air = airs.find(event[i]);
    if (air == airs.end()) table.fail("site", fmt::format("no [[paths.site]] for event '{}'", event[i]));
    const bool is_tracked = spin[i] > 0 && loss[i] > decay[0] && loss[i] < decay[1];
    const double rate = is_tracked ? spin[i] * kRadPerSecPerRpm : recorded[i] * kRadPerSecPerRpm;
    if (!is_tracked && !(rate > least_spin)) {
      ++out.left_out["without a spin"];
      continue;
    }
    const Polynomial px = x.row(i), py = y.row(i), pz = z.row(i);
    if (!px.finite() || !py.finite() || !pz.finite() || !std::isfinite(level[i]) || !std::isfinite(apex[i])) {
      ++out.left_out["with an empty cell in its polynomials, its time to level or its apex"];
      continue;
    }
    // x to the target, y up, z to the right.
    const Vec3 velocity(px.c[1], -pz.c[1], py.c[1]);
    RadarFlight f{.path = {.id = fmt::format("row {}", sheet.lines[i]), .launch = {}, .air = air->second, .sd = own},
                  .line = sheet.lines[i],
                  .player = player[i],
                  .held_out = held_out(player[i]),
                  .spin_tracked = is_tracked,
                  .carry = carry[i],
                  .apex = apex[i],
                  .time = level[i]};
    f.side = pz.at(level[i]) - pz.c[0];
    f.path.launch.velocity = velocity;
    if (!(carry[i] > least_carry) || !(measured[i] > least_time) || !(f.path.launch.launch_angle() > least_angle)) {
      ++out.left_out["too short, too low or not followed long enough"];
      continue;
    }
    const Vec3 left = Vec3::UnitZ().cross(Vec3(velocity.x(), velocity.y(), 0).normalized());
    f.path.launch.spin = -rate * left;
    f.path.sd[models::kLogSpin] = is_tracked ? tracked : estimated;
    for (double t = sample; t <= std::min(measured[i], level[i]) + 1e-9; t += sample) {
      f.path.times.push_back(t);
      f.path.positions.emplace_back(px.at(t) - px.c[0], -(pz.at(t) - pz.c[0]), py.at(t) - py.c[0]);
    }
    std::string group;
    for (const auto* names : naming) group += (group.empty() ? "" : "/") + (*names)[i];
    const auto known = std::ranges::find(out.groups, group);
    f.path.group = int(known - out.groups.begin());
    f.group = group;
    if (known == out.groups.end()) out.groups.push_back(group);
    out.flights.push_back(std::move(f));
  }
  return out;
}

}  // namespace hosel::app
