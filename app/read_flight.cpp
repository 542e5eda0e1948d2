#include "app/read_flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/read_sheet.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
namespace {

/// Columns reynolds, spin_ratio, drag, lift; rows of one Reynolds number follow each other.
models::TableLaw read_coefficients(Table& table) {
  const std::filesystem::path file = table.file({"coefficients", "CSV with columns reynolds, spin_ratio, drag, lift"});
  models::TableLaw law;
  const post::Sheet sheet = read_sheet(file);
  const auto plain = [&](std::string_view name) { return column(sheet, name, Dimension::length, false); };
  const std::vector<double> reynolds = plain("reynolds"), spin = plain("spin_ratio"), drag = plain("drag"),
                            lift = plain("lift");
  for (std::size_t i = 0; i < sheet.rows(); ++i) {
    if (law.rows.empty() || law.rows.back().reynolds != reynolds[i]) law.rows.push_back({reynolds[i], {}, {}, {}});
    law.rows.back().spin.push_back(spin[i]);
    law.rows.back().drag.push_back(drag[i]);
    law.rows.back().lift.push_back(lift[i]);
  }
  if (const auto faults = law.faults(); !faults.empty()) table.fail("coefficients", faults.front());
  return law;
}

models::FlightLaw published(Table& table, std::string_view key, const std::string& name) {
  if (const auto* entry = models::find_flight_law(name)) return entry->make();
  table.fail(key, fmt::format("no flight law '{}'{}", name,
                              or_nearest(name, names_in(models::flight_laws()), "; `hosel list` shows them")));
}

models::FlightLaw read_law(Table& table) {
  models::FlightLaw law;
  const std::string name =
      table.text({"law", "aerodynamic coefficients: a published law (`hosel list`) or table"}, "ferguson-2022");
  if (name == "table") {
    const models::TableLaw form = read_coefficients(table);
    models::FlightLaw::Range spin{INFINITY, -INFINITY};  // of all rows
    for (const models::TableLaw::Row& r : form.rows)
      spin = {std::min(spin.low, r.spin.front()), std::max(spin.high, r.spin.back())};
    law = {.name = "table",
           .source = "the case",
           .reynolds = {form.rows.front().reynolds, form.rows.back().reynolds},
           .spin = spin,
           .form = form,
           .decay = {.rate = table.number({"spin_decay_per_s", "relative loss of spin rate per second"}, {0, 2})}};
  } else {
    law = published(table, "law", name);
    if (table.has("spin_decay_per_s")) {
      law.decay = {.rate = table.number({"spin_decay_per_s", "relative loss of spin rate per second"}, {0, 2})};
      // The last coefficient of an inferred law is its decay, which is told now.
      constexpr int n = models::kInferredCoefficients;
      for (int k = 0; k < n && !law.covariance.empty(); ++k)
        law.covariance[std::size_t(k * n + n - 1)] = law.covariance[std::size_t((n - 1) * n + k)] = 0;
    }
  }
  law.drag_scale = table.number({"drag_scale", "factor on the drag coefficient"}, {0, 10}, 1.0);
  law.lift_scale = table.number({"lift_scale", "factor on the lift coefficient"}, {0, 10}, 1.0);
  return law;
}

/// With what the case multiplies it by: a law beside it is as published.
std::string drawn_name(const models::FlightLaw& law) {
  std::string factors;
  for (const auto& [what, scale] : {std::pair{"drag", law.drag_scale}, {"lift", law.lift_scale}})
    if (scale != 1) factors += fmt::format("{}{} x {:g}", factors.empty() ? "" : "; ", what, scale);
  return factors.empty() ? law.name : fmt::format("{} ({})", law.name, factors);
}

}  // namespace

models::Air read_air(Table table) {
  if (table.has_quantity("density"))
    return {.density = table.quantity({"density", "of the air; instead of weather"}, "kg_per_m3", {0, 5}),
            .viscosity = models::Air{}.viscosity};
  models::Weather w;
  w.temperature = 273.15 + table.number({"temperature_degC", "of the air"}, {-40, 60}, 15.0);
  w.humidity = table.quantity({"humidity", "relative humidity of the air"}, "pct", Range::fraction(), 0.5);
  const double altitude =
      table.quantity({"altitude", "above sea level; gives the standard pressure"}, "m", {-500, 9000}, 0.0);
  table.decided_by("altitude_m");
  w.pressure = table.quantity({"pressure", "of the air; default: the standard atmosphere's at the altitude"}, "hPa",
                              {2e4, 1.2e5}, models::standard_pressure(altitude));
  return models::air(w);
}

namespace {

models::Wind read_wind(Table table) {
  models::Wind w;
  w.speed = table.quantity({"speed", "of the wind at the reference height"}, "mps", {0, 50});
  w.towards =
      table.quantity({"towards", "where the wind blows to, right of the target; 0 helps, 180 deg is into the face"},
                     "deg", {-2 * kPi, 2 * kPi});
  using Profile = models::WindProfile;
  w.profile = table.one_of<Profile>({"profile", "of the wind over height"},
                                    {{"logarithmic", Profile::logarithmic}, {"uniform", Profile::uniform}},
                                    "logarithmic");
  if (w.profile == models::WindProfile::uniform) return w;
  w.reference = table.quantity({"height", "at which the wind's speed is given"}, "m", {0.1, 200}, w.reference);
  w.roughness = table.quantity({"roughness", "length of the logarithmic wind profile"}, "m", {1e-4, 5}, w.roughness);
  return w;
}

models::LaunchError read_launch_error(Table table, std::vector<std::string>& taken) {
  models::LaunchError e{.source = table.name({"source", "where these standard errors come from"}, taken)};
  using Error = models::LaunchError;
  for (const auto& [key, meaning, unit, error] :
       {std::tuple{"ball_speed", "standard error of the measured ball speed", "mps", &Error::ball_speed},
        {"launch_angle", "standard error of the measured launch angle", "deg", &Error::launch_angle},
        {"azimuth", "standard error of the measured direction", "deg", &Error::azimuth},
        {"backspin", "standard error of the measured backspin", "rpm", &Error::backspin},
        {"sidespin", "standard error of the measured sidespin", "rpm", &Error::sidespin},
        {"spin_rate", "standard error of the measured spin rate", "rpm", &Error::spin_rate},
        {"spin_axis", "standard error of the measured spin axis", "deg", &Error::spin_axis}})
    e.*error = table.quantity({key, meaning}, unit, Range::non_negative(), 0);
  return e;
}

}  // namespace

models::FlightConditions read_conditions(Table table) {
  models::FlightConditions c;
  c.law = read_law(table);
  c.air = read_air(table);
  if (auto wind = table.optional_table("wind")) c.wind = read_wind(*wind);
  if (auto ground = table.optional_table("ground")) {
    c.ground.height = ground->quantity({"height", "of the ground where the ball lands, above the ball at launch"}, "m",
                                       {-500, 500}, 0);
    c.ground.slope = ground->quantity({"slope", "of the ground where the ball lands, uphill towards the target"}, "deg",
                                      {-radians(45), radians(45)}, 0);
  }
  return c;
}

FlightSetup read_flight(Table table) {
  FlightSetup s;
  using Unit = post::DistanceUnit;
  s.unit = table.one_of<Unit>({"units", "of distances in tables and figures"},
                              {{"yards", Unit::yards}, {"metres", Unit::metres}}, "yards");
  s.conditions = read_conditions(table);
  for (const std::string& name : table.texts({"beside",
                                              "further laws drawn and tabled beside the first, as published: the "
                                              "factors and the decay of [flight] are not theirs"},
                                             std::vector<std::string>{}))
    s.others.push_back(published(table, "beside", name));
  s.options.tolerance =
      table.number({"tolerance", "relative tolerance of the trajectory"}, {1e-12, 1e-3}, s.options.tolerance);
  if (auto turf = table.optional_table("turf")) {
    models::BounceRoll t;
    t.friction = turf->number({"friction", "of the ball on the turf while it bounces"}, {0, 2}, t.friction);
    t.rolling =
        turf->number({"rolling", "rolling resistance; 5/7 of it in g is the deceleration"}, {0.01, 1}, t.rolling);
    turf->decided_by("flight.turf.rolling");
    t.rolling_low = turf->number({"rolling_low", "lower end of what rolling may be"}, {0.01, t.rolling},
                                 std::min(t.rolling, t.rolling_low));
    t.rolling_high = turf->number({"rolling_high", "upper end of what rolling may be"}, {t.rolling, 2},
                                  std::max(t.rolling, t.rolling_high));
    s.turf = t;
    if (std::abs(std::tan(s.conditions.ground.slope)) >= t.rolling_low)
      table.fail("turf", "on this slope a rolling ball does not come to rest: leave out [flight.turf] or its slope");
  }
  std::vector<std::string> taken;
  for (const Table& t : table.tables("launch_error")) s.errors.push_back(read_launch_error(t, taken));
  return s;
}

std::optional<FlightSetup> read_optional_flight(Table root) {
  if (auto table = root.optional_table("flight")) return read_flight(*table);
  return {};
}

StatedLaunch read_launch(Table table, bool whole) {
  const auto asked = [&](Key key, std::string_view unit, Range range, std::optional<double> otherwise) {
    const bool read = whole || table.has_quantity(key.name);
    return read ? std::optional(table.quantity(key, unit, range, otherwise)) : std::nullopt;
  };
  StatedLaunch l{.ball_speed = asked({"ball_speed", "of the launch"}, "mps", {0, 120, true}, {}),
                 .launch_angle = asked({"launch_angle", "of the launch, up"}, "deg", {-kPi / 2, kPi / 2}, {}),
                 .azimuth = asked({"azimuth", "of the launch, right of the target"}, "deg", {-kPi / 2, kPi / 2}, 0),
                 .spin = {}};
  if (!whole) l.speed_scale = table.number({"speed_scale", "factor on the ball's speed"}, {0.1, 10}, 1.0);
  const bool rate = table.has_quantity("spin_rate");
  if (!whole && !rate && !table.has_quantity("backspin")) return l;
  double back = 0, side = 0;
  if (rate) {
    const double size =
        table.quantity({"spin_rate", "of the launch, without riflespin; instead of backspin and sidespin"}, "rpm",
                       Range::non_negative());
    const double axis = table.quantity({"spin_axis", "tilt of the spin, positive for a fade"}, "deg", {-kPi, kPi}, 0);
    back = size * std::cos(axis);
    side = size * std::sin(axis);
  } else {
    back = table.quantity({"backspin", "of the launch"}, "rpm");
    side = table.quantity({"sidespin", "of the launch, positive for a fade"}, "rpm", Range::finite(), 0);
  }
  l.spin = Vec3(
      table.quantity({"riflespin", "of the launch, about +X, which points to the target"}, "rpm", Range::finite(), 0),
      -back, -side);
  return l;
}

Launch StatedLaunch::in_place_of(Launch launch) const {
  if (ball_speed || launch_angle || azimuth) {
    const double speed = ball_speed.value_or(launch.ball_speed()), up = launch_angle.value_or(launch.launch_angle()),
                 right = azimuth.value_or(launch.azimuth());
    launch.velocity = speed * Vec3(std::cos(up) * std::cos(right), -std::cos(up) * std::sin(right), std::sin(up));
  }
  launch.velocity *= speed_scale;
  if (spin) launch.spin = *spin;
  return launch;
}

void FlightSetup::show_in(const Output& out) {
  if (const auto asked = out.asked_units())
    unit = *asked == post::Units::golf ? post::DistanceUnit::yards : post::DistanceUnit::metres;
}

post::ShotFlight FlightSetup::follow(const Launch& launch, const Ball& ball, double sample) const {
  post::ShotFlight s{
      models::fly(launch, ball, conditions, {.tolerance = options.tolerance, .sample = sample}), {}, unit};
  if (turf) try {
      s.run = models::run_out(s.flight.landing, ball, conditions.ground, *turf);
    } catch (const std::logic_error& e) { s.no_run = fmt::format("the carry has no total: {}", e.what()); }
  return s;
}

std::optional<ShotChannel> find_shot_channel(std::string_view name, const std::optional<FlightSetup>& flight,
                                             const Ball& ball) {
  if (const post::Channel* c = post::find_channel(name))
    return ShotChannel{std::string(name), std::string(c->unit), c->si,
                       [value = c->value](const Launch& l) { return (l.*value)(); }};
  if (!flight) return {};
  for (const post::FlightChannel& c : post::flight_channels(flight->unit))
    if (c.name == name && (name != "total" || flight->turf))
      return ShotChannel{std::string(name), std::string(c.unit), c.si,
                         [setup = *flight, ball, value = c.value](const Launch& l) {
                           if (const auto x = value(setup.follow(l, ball))) return *x;
                           throw std::invalid_argument(setup.follow(l, ball).no_run);
                         }};
  return {};
}

std::string outside_law(const FlightSetup& setup, const post::ShotFlight& shot) {
  const models::Flight& flight = shot.flight;
  if (!(flight.outside > 0)) return {};
  const auto region = [](const models::FlightLaw::Range& re, const models::FlightLaw::Range& spin) {
    return fmt::format("Re {:.0f} to {:.0f}, spin ratio {:.3f} to {:.3f}", re.low, re.high, spin.low, spin.high);
  };
  const models::FlightLaw& law = setup.conditions.law;
  return fmt::format("{:.0f} % of the flight is outside the range of {} ({}); the flight has {}", 100 * flight.outside,
                     law.name, region(law.reynolds, law.spin), region(flight.reynolds, flight.spin));
}

nlohmann::json report_flight(Output& out, const FlightSetup& setup, const std::string& name, const Launch& launch,
                             const Ball& ball, post::Table* by_law, bool draw) {
  constexpr double sample = 0.05;  // [s]
  std::vector<post::NamedFlight> flights = {{setup.conditions.law.name, setup.follow(launch, ball, sample)}};
  for (const models::FlightLaw& law : setup.others) {
    FlightSetup other = setup;
    other.conditions.law = law;
    flights.push_back({law.name, other.follow(launch, ball, sample)});
  }
  if (by_law) {
    const auto channels = post::flight_channels(setup.unit);
    if (by_law->columns.empty()) {
      by_law->in_files({"launch", "law"});
      for (const post::FlightChannel& c : channels) by_law->in_files({fmt::format("{}_{}", c.name, c.unit)}, "{:.8g}");
      by_law->in_files({"outside_law_range"}, "{:.4g}");
    }
    for (const auto& [law, shot] : flights) {
      by_law->add(name, law);
      for (const post::FlightChannel& c : channels) {
        const auto x = c.value(shot);
        by_law->more(x ? std::optional(*x / c.si) : std::nullopt);
      }
      by_law->more(shot.flight.outside);
    }
  }
  const models::FlightBudget budget =
      models::flight_budget(launch, ball, setup.conditions, setup.options, setup.errors, setup.others);
  flights.front().title = drawn_name(setup.conditions.law);
  const std::string how =
      fmt::format("{}, {} in air of {:.4f} kg/m³", name, flights.front().title, setup.conditions.air.density);
  out.tell(fmt::format("\n{}:", how));  // the page has it as the table's heading
  out.show(post::budget_table(budget, setup.errors, setup.unit), "The flight: " + how);
  const models::Flight& flight = flights.front().shot.flight;
  if (const std::string text = outside_law(setup, flights.front().shot); !text.empty())
    out.warn(fmt::format("{}: {}", name, text));
  if (const std::string& text = flights.front().shot.no_run; !text.empty()) out.warn(fmt::format("{}: {}", name, text));
  const std::string file = out.file_name(name);
  if (draw) out.draw(post::trajectory_figure(name, flights), "figures/flight-" + file);
  post::VtkSeries(out.directory() / "vtk", "flight-" + file, post::VtkSeries::Form::surface)
      .write(flight.time, post::trajectory_mesh(flight));
  return post::to_json(budget, setup.errors, setup.unit);
}

}  // namespace hosel::app
