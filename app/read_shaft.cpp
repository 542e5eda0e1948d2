#include "app/read_shaft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>

#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_sheet.hpp"
#include "golf/shaft_library.hpp"

namespace hosel::app {
namespace {

Shaft by_name(Table& table) {
  const std::string wanted = table.choice({"name", "a shaft of the library (`hosel list`)"}, names_in(shaft_library()));
  for (const NamedShaft& s : shaft_library())
    if (s.name == wanted) return s.make();
  return {};
}

void check_order(const Table& table, const char* key, const std::vector<double>& arc) {
  for (std::size_t i = 1; i < arc.size(); ++i)
    if (!(arc[i] > arc[i - 1])) table.fail(key, "stations run from butt to tip with increasing arc length");
}

void from_butt_to_tip(const Table& table, const char* key, const std::vector<double>& arc) {
  if (arc.size() < 2) table.fail(key, "a shaft needs at least two stations");
  check_order(table, key, arc);
  if (arc.front() != 0)
    table.fail(key, fmt::format("the first station is the butt, at 0, not at {:g} m: what a shaft is before its first "
                                "station, nothing says",
                                arc.front()));
}

/// Lists in the case, or columns of the same names in a CSV file.
Shaft by_stations(Table table) {
  std::optional<post::Sheet> sheet;
  if (table.has("file"))
    sheet = read_sheet(
        table.file({"file", "CSV whose columns are the keys of this table, each with a unit; instead of them"}));
  const auto read = [&](Key key, std::string_view unit, Dimension dimension, std::size_t n, Range range) {
    if (!sheet) return table.quantities(key, unit, n, range);
    const std::vector<double> x = column(*sheet, key.name, dimension);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!range.contains(x[i]))
        throw InputError(fmt::format("{}:{}: {} is {}", sheet->file, sheet->lines[i], key.name, range.sentence()));
    return x;
  };
  const auto arc =
      read({"arc_length", "stations from the butt at 0 to the tip"}, "mm", Dimension::length, 0, Range::finite());
  const std::size_t n = arc.size();
  const char* at = sheet ? "file" : "arc_length";
  from_butt_to_tip(table, at, arc);
  const Range positive = Range::positive();
  const auto EI = read({"bending_stiffness", "EI at the stations"}, "N_m2", Dimension::bending_stiffness, n, positive);
  const auto GJ =
      read({"torsional_stiffness", "GJ at the stations"}, "N_m2", Dimension::bending_stiffness, n, positive);
  const auto mu = read({"mass_per_length", "at the stations"}, "g_per_m", Dimension::line_density, n, positive);
  const auto r = read({"mean_radius", "of the wall at the stations"}, "mm", Dimension::length, n, positive);
  std::vector<CompositeStation> stations;
  for (std::size_t i = 0; i < n; ++i) stations.push_back({arc[i], EI[i], GJ[i], mu[i], r[i]});
  return composite_shaft(stations);
}

Shaft by_polynomials(Table table) {
  CompositePolynomials p;
  p.length =
      table.quantity({"length", "of the shaft; the polynomials run over it from the butt"}, "m", Range::positive());
  p.bending_stiffness = table.quantities(
      {"bending_stiffness", "EI: coefficients of a polynomial in the arc length [m], constant first"}, "N_m2", 0);
  p.torsional_stiffness = table.quantities(
      {"torsional_stiffness", "GJ: coefficients of a polynomial in the arc length [m], constant first"}, "N_m2", 0);
  p.mass_per_length = table.quantities(
      {"mass_per_length", "coefficients of a polynomial in the arc length [m], constant first"}, "kg_per_m", 0);
  p.mean_radius = table.quantities(
      {"mean_radius", "of the wall: coefficients of a polynomial in the arc length [m], constant first"}, "m", 0);
  return polynomial_shaft(p);
}

Shaft by_tube(Table table) {
  const auto arc = table.quantities({"arc_length", "stations from the butt at 0 to the tip"}, "mm", 0);
  from_butt_to_tip(table, "arc_length", arc);
  const auto radius =
      table.quantities({"outer_radius", "of the tube at the stations"}, "mm", arc.size(), Range::positive());
  const auto wall =
      table.quantities({"wall", "thickness of the tube at the stations"}, "mm", arc.size(), Range::positive());
  std::vector<TubeStation> tube;
  for (std::size_t i = 0; i < arc.size(); ++i) tube.push_back({arc[i], radius[i], wall[i]});
  std::vector<ShaftLayer> layers;
  for (Table layer : table.tables("layer"))
    layers.push_back({layer.number({"share", "of the wall's thickness that is this layer"}, Range::fraction(), 1.0),
                      layer.quantity({"E", "Young's modulus of the layer along the shaft"}, "GPa", Range::positive()),
                      layer.quantity({"G", "shear modulus of the layer"}, "GPa", Range::positive()),
                      layer.quantity({"density", "of the layer"}, "kg_per_m3", Range::positive())});
  if (layers.empty()) table.fail("layer", "a tube needs at least one [[shaft.tube.layer]]");
  const double kappa = table.number({"shear_factor", "Timoshenko's shear correction of the tube"}, {0, 1, true});
  return tube_shaft(tube, layers, kappa);
}

/// Centres off the line, at stations of their own, linear between them and held beyond.
void read_offsets(Table table, Shaft& shaft) {
  const auto arc = table.quantities(
      {"arc_length",
       "stations of the offsets; linear between, held beyond. y is the lead (XG), z against the droop (-YG)"},
      "mm", 0);
  check_order(table, "arc_length", arc);
  if (arc.empty()) table.fail("arc_length", "offsets need at least one station");
  Shaft offsets;
  for (const double s : arc) offsets.stations.push_back({.arc_length = s});
  const auto read = [&](Key key, std::array<double, 2> CentreOffsets::*centre, std::size_t axis) {
    const auto values = table.quantities(key, "mm", arc.size(), Range::finite(), std::vector<double>(arc.size(), 0.0));
    for (std::size_t i = 0; i < arc.size(); ++i) (offsets.stations[i].centres.*centre)[axis] = values[i];
  };
  read({"elastic_centre_y", "offset of the axis about which EI acts"}, &CentreOffsets::elastic, 0);
  read({"elastic_centre_z", "offset of the axis about which EI acts"}, &CentreOffsets::elastic, 1);
  read({"shear_centre_y", "offset of the axis about which GJ acts"}, &CentreOffsets::shear, 0);
  read({"shear_centre_z", "offset of the axis about which GJ acts"}, &CentreOffsets::shear, 1);
  read({"mass_centre_y", "offset of the centre of mass"}, &CentreOffsets::mass, 0);
  read({"mass_centre_z", "offset of the centre of mass"}, &CentreOffsets::mass, 1);
  for (ShaftStation& s : shaft.stations) s.centres = offsets.at(s.arc_length).centres;
}

/// What a maker says of a shaft.
std::string figures(const Shaft& shaft) {
  const ShaftStation &butt = shaft.stations.front(), &tip = shaft.stations.back();
  const double balance = balance_point(shaft);
  std::string out = fmt::format("length {:.1f} mm, mass {:.2f} g, balance point {:.1f} mm from the butt ({:.1f} %)\n",
                                1e3 * shaft.length(), 1e3 * mass(shaft), 1e3 * balance, 100 * balance / shaft.length());
  out +=
      fmt::format("EI at the butt {:.4g}, at the tip {:.4g} N m^2", butt.bending_stiffness_y, tip.bending_stiffness_y);
  if (butt.bending_stiffness_y != butt.bending_stiffness_z || tip.bending_stiffness_y != tip.bending_stiffness_z)
    out += fmt::format(" about y, {:.4g} and {:.4g} N m^2 about z", butt.bending_stiffness_z, tip.bending_stiffness_z);
  return out + fmt::format("\nGJ at the butt {:.4g}, at the tip {:.4g} N m^2", butt.torsional_stiffness,
                           tip.torsional_stiffness);
}

/// Where a unit or a decimal point has slipped: far outside what clubs have, and yet a beam.
void doubt_slips(Table& table, const Shaft& shaft) {
  const auto within = [&](std::string_view what, double x, double least, double most, std::string_view unit) {
    if (least <= x && x <= most) return;
    table.doubt(
        fmt::format("{} is {:.4g} {}; golf shafts have {:g} to {:g}: is a unit wrong?", what, x, unit, least, most));
  };
  within("the length", shaft.length(), 0.5, 1.4, "m");
  within("the mass", 1e3 * mass(shaft), 25, 250, "g");
  double least = INFINITY, most = 0;
  for (const ShaftStation& s : shaft.stations)
    for (const double EI : {s.bending_stiffness_y, s.bending_stiffness_z})
      least = std::min(least, EI), most = std::max(most, EI);
  within("the smallest EI", least, 2, 500, "N m^2");
  within("the largest EI", most, 2, 500, "N m^2");
}

}  // namespace

Shaft read_shaft(Table table) {
  Shaft shaft;
  std::vector<std::string> given;
  for (const char* how : {"name", "table", "polynomial", "tube"})
    if (table.has(how)) given.emplace_back(how);
  if (given.size() > 1) table.fail(given[1], fmt::format("give one of `{}`, not both", fmt::join(given, "` and `")));
  try {
    if (table.has("name")) shaft = by_name(table);
    else if (auto stations = table.optional_table("table")) shaft = by_stations(*stations);
    else if (auto polynomial = table.optional_table("polynomial")) shaft = by_polynomials(*polynomial);
    else if (auto tube = table.optional_table("tube")) shaft = by_tube(*tube);
    else table.fail("name", "say which shaft: `name`, or a table `table`, `polynomial` or `tube`");
  } catch (const std::invalid_argument& e) { table.fail("", e.what()); }
  if (!table.has("name")) doubt_slips(table, shaft);
  const double bending_scale = table.number({"bending_scale", "factor on EI everywhere"}, Range::positive(), 1.0);
  const double torsion_scale = table.number({"torsion_scale", "factor on GJ everywhere"}, Range::positive(), 1.0);
  shaft = scaled(std::move(shaft), bending_scale, torsion_scale);
  if (auto tip = table.optional_table("tip")) {
    const double from = tip->quantity({"from", "arc length from the butt where the factors begin to grow from 1"}, "mm",
                                      Range::positive());
    if (!(from < shaft.length())) tip->fail("from", fmt::format("the shaft ends at {:g} m", shaft.length()));
    const double bending = tip->number(
        {"bending_scale", "factor on EI at the tip; between `from` and the tip it is linear"}, Range::positive());
    const double torsion = tip->number(
        {"torsion_scale", "factor on GJ at the tip; between `from` and the tip it is linear"}, Range::positive());
    shaft = scaled_tip(std::move(shaft), from, bending, torsion);
  }
  const double mass_scale =
      table.number({"mass_scale", "factor on mass and rotary inertia everywhere"}, Range::positive(), 1.0);
  for (ShaftStation& s : shaft.stations) {
    s.mass_per_length *= mass_scale;
    s.rotary_inertia_y *= mass_scale;
    s.rotary_inertia_z *= mass_scale;
  }
  for (const ShaftStation& s : shaft.stations) {
    const auto within = [&](const char* what, double x, double least, double most) {
      if (!(least <= x && x <= most))
        table.fail("", fmt::format("{} is {:g} at {:g} m; the range of shafts, stiff and light ones far included, is "
                                   "{:g} to {:g}",
                                   what, x, s.arc_length, least, most));
    };
    for (const double x : {s.bending_stiffness_y, s.bending_stiffness_z}) within("EI [N m2]", x, 1e-6, 1e12);
    within("GJ [N m2]", s.torsional_stiffness, 1e-6, 1e12);
    within("the mass per length [kg/m]", s.mass_per_length, 1e-9, 1e4);
  }
  if (auto offsets = table.optional_table("offsets")) read_offsets(*offsets, shaft);
  // Stiffness-proportional: the damping ratio holds at one frequency and grows in proportion to it.
  const double ratio =
      table.number({"damping_ratio", "of stiffness-proportional damping at damping_frequency"}, {0, 1}, 0.0);
  if (ratio > 0)
    shaft.damping_time =
        2 * ratio /
        (2 * kPi *
         table.quantity(
             {"damping_frequency", "where damping_ratio, if above 0, holds; it grows in proportion to frequency"}, "Hz",
             Range::positive()));
  if (const auto wrong = faults(shaft); !wrong.empty()) table.fail("", wrong.front());
  table.tell(figures(shaft));
  return shaft;
}

HoselPlace read_hosel(Table table, const std::optional<HoselPlace>& standard) {
  HoselPlace at;
  table.decided_by("head.name");
  at.position = table.vector({"position", "the hosel (where the shaft's axis enters the head) in the face frame"}, "mm",
                             limits::head_place, standard_of(standard, &HoselPlace::position));
  // The shaft's direction from tip to butt: lie in the plane of the face's Yc and Zc, lean about Yc.
  at.lie = table.quantity({"lie", "angle of the shaft above the ground, in the plane of the face's Yc and Zc"}, "deg",
                          {0, kPi / 2}, standard_of(standard, &HoselPlace::lie));
  at.lean = table.quantity({"lean", "tilt of the shaft towards the target"}, "deg", {-radians(70), radians(70)},
                           standard_of(standard, &HoselPlace::lean));
  return at;
}

ClubGeometry HoselPlace::geometry() const {
  return {position, Vec3(std::sin(lean) * std::sin(lie), std::cos(lie), std::cos(lean) * std::sin(lie))};
}

ClubGeometry read_club_geometry(Table root, bool wanted) {
  const ClubGeometry any;
  std::optional<HoselPlace> standard;
  if (auto head = root.optional_table("head"); head && head->has("name"))
    standard = library_head(*named_entry(*head, "name", Shelf::heads)).hosel;
  if (!wanted && !root.has("hosel")) return standard ? standard->geometry() : any;
  if (!standard) standard = {any.hosel, std::atan2(any.shaft_axis.z(), any.shaft_axis.y()), 0};
  return read_hosel(root.default_table("hosel"), standard).geometry();
}

}  // namespace hosel::app
