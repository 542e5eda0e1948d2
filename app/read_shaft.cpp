#include "hosel/app/read_shaft.hpp"

#include <cmath>
#include <stdexcept>

#include "hosel/app/read_blow.hpp"
#include "hosel/golf/shaft_library.hpp"

namespace hosel::app {
namespace {

Shaft by_name(Table& table) {
  std::vector<std::string> names;
  for (const NamedShaft& s : shaft_library()) names.emplace_back(s.name);
  const std::string wanted = table.choice("name", names);
  for (const NamedShaft& s : shaft_library())
    if (s.name == wanted) return s.make();
  return {};
}

Shaft by_stations(Table table) {
  const auto arc = table.quantities("arc_length", "mm", 0);
  const std::size_t n = arc.size();
  if (n < 2) table.fail("arc_length", "a shaft needs at least two stations");
  for (std::size_t i = 1; i < n; ++i)
    if (!(arc[i] > arc[i - 1])) table.fail("arc_length", "stations run from butt to tip with increasing arc length");
  const auto EI = table.quantities("bending_stiffness", "N_m2", n, Range::positive());
  const auto GJ = table.quantities("torsional_stiffness", "N_m2", n, Range::positive());
  const auto mu = table.quantities("mass_per_length", "g_per_m", n, Range::positive());
  const auto r = table.quantities("mean_radius", "mm", n, Range::positive());
  std::vector<CompositeStation> stations;
  for (std::size_t i = 0; i < n; ++i) stations.push_back({arc[i], EI[i], GJ[i], mu[i], r[i]});
  return composite_shaft(stations);
}

Shaft by_polynomials(Table table) {
  CompositePolynomials p;
  p.length = table.quantity("length", "m", Range::positive());
  p.bending_stiffness = table.quantities("bending_stiffness", "N_m2", 0);
  p.torsional_stiffness = table.quantities("torsional_stiffness", "N_m2", 0);
  p.mass_per_length = table.quantities("mass_per_length", "kg_per_m", 0);
  p.mean_radius = table.quantities("mean_radius", "m", 0);
  return polynomial_shaft(p);
}

Shaft by_tube(Table table) {
  const auto arc = table.quantities("arc_length", "mm", 0);
  const auto radius = table.quantities("outer_radius", "mm", arc.size(), Range::positive());
  const auto wall = table.quantities("wall", "mm", arc.size(), Range::positive());
  std::vector<TubeStation> tube;
  for (std::size_t i = 0; i < arc.size(); ++i) tube.push_back({arc[i], radius[i], wall[i]});
  std::vector<ShaftLayer> layers;
  for (Table layer : table.tables("layer"))
    layers.push_back({layer.number("share", Range::fraction(), 1.0), layer.quantity("E", "GPa", Range::positive()),
                      layer.quantity("G", "GPa", Range::positive()),
                      layer.quantity("density", "kg_per_m3", Range::positive())});
  if (layers.empty()) table.fail("layer", "a tube needs at least one [[shaft.tube.layer]]");
  const double kappa = table.number("shear_factor", {0, 1, true});
  return tube_shaft(tube, layers, kappa);
}

/// Centres off the line, at stations of their own, linear between them and held beyond.
void read_offsets(Table table, Shaft& shaft) {
  const auto arc = table.quantities("arc_length", "mm", 0);
  for (std::size_t i = 1; i < arc.size(); ++i)
    if (!(arc[i] > arc[i - 1])) table.fail("arc_length", "stations run from butt to tip with increasing arc length");
  if (arc.empty()) table.fail("arc_length", "offsets need at least one station");
  Shaft offsets;
  for (const double s : arc) offsets.stations.push_back({.arc_length = s});
  const auto read = [&](const char* key, std::array<double, 2> CentreOffsets::*centre, std::size_t axis) {
    const auto values = table.quantities(key, "mm", arc.size(), Range::finite(), std::vector<double>(arc.size(), 0.0));
    for (std::size_t i = 0; i < arc.size(); ++i) (offsets.stations[i].centres.*centre)[axis] = values[i];
  };
  read("elastic_centre_y", &CentreOffsets::elastic, 0);
  read("elastic_centre_z", &CentreOffsets::elastic, 1);
  read("shear_centre_y", &CentreOffsets::shear, 0);
  read("shear_centre_z", &CentreOffsets::shear, 1);
  read("mass_centre_y", &CentreOffsets::mass, 0);
  read("mass_centre_z", &CentreOffsets::mass, 1);
  for (ShaftStation& s : shaft.stations) s.centres = offsets.at(s.arc_length).centres;
}

}  // namespace

Shaft read_shaft(Table table) {
  Shaft shaft;
  try {
    if (table.has("name")) shaft = by_name(table);
    else if (auto stations = table.optional_table("table")) shaft = by_stations(*stations);
    else if (auto polynomial = table.optional_table("polynomial")) shaft = by_polynomials(*polynomial);
    else if (auto tube = table.optional_table("tube")) shaft = by_tube(*tube);
    else table.fail("name", "say which shaft: `name`, or a table `table`, `polynomial` or `tube`");
  } catch (const std::invalid_argument& e) { table.fail("", e.what()); }
  shaft = scaled(std::move(shaft), table.number("bending_scale", Range::positive(), 1.0),
                 table.number("torsion_scale", Range::positive(), 1.0));
  const double mass_scale = table.number("mass_scale", Range::positive(), 1.0);
  for (ShaftStation& s : shaft.stations) {
    s.mass_per_length *= mass_scale;
    s.rotary_inertia_y *= mass_scale;
    s.rotary_inertia_z *= mass_scale;
  }
  if (auto offsets = table.optional_table("offsets")) read_offsets(*offsets, shaft);
  // Stiffness-proportional: the damping ratio holds at one frequency and grows in proportion to it.
  const double ratio = table.number("damping_ratio", {0, 1}, 0.0);
  if (ratio > 0)
    shaft.damping_time = 2 * ratio / (2 * kPi * table.quantity("damping_frequency", "Hz", Range::positive()));
  if (const auto wrong = faults(shaft); !wrong.empty()) table.fail("", wrong.front());
  return shaft;
}

ClubGeometry read_club_geometry(Table table) {
  const ClubGeometry standard;
  ClubGeometry g;
  g.hosel = table.vector("position", "mm", limits::head_place, standard.hosel);
  // The shaft's direction from tip to butt: lie in the plane of the face's Yc and Zc, lean about Yc.
  const double lie =
      table.quantity("lie", "deg", {0, kPi / 2}, std::atan2(standard.shaft_axis.z(), standard.shaft_axis.y()));
  const double lean = table.quantity("lean", "deg", {-kPi / 4, kPi / 4}, 0);
  g.shaft_axis = Vec3(std::sin(lean) * std::sin(lie), std::cos(lie), std::cos(lean) * std::sin(lie));
  return g;
}

}  // namespace hosel::app
