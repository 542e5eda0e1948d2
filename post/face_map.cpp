#include "post/face_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "golf/units.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"
#include "post/table.hpp"

namespace hosel::post {
namespace {

using OfLaunch = std::function<std::optional<double>(const Launch&)>;

std::vector<MapQuantity> launch_quantities() {
  std::vector<MapQuantity> all;
  const auto add = [&](std::string name, std::string unit, double si, OfLaunch value) {
    all.push_back(
        {std::move(name), std::move(unit), si, false, [value = std::move(value)](const FaceMap& map, std::size_t p) {
           return map.launches[p] ? value(*map.launches[p]) : std::nullopt;
         }});
  };
  for (const Channel& c : channels())
    add(std::string(c.name), std::string(c.unit), c.si, [value = c.value](const Launch& l) { return (l.*value)(); });
  add("head_speed", "mps", 1.0, [](const Launch& l) { return l.head_velocity.norm(); });
  add("head_rotation", "rad_per_s", 1.0, [](const Launch& l) { return l.head_spin.norm(); });
  for (int axis = 0; axis < 3; ++axis)
    add(fmt::format("head_spin_{}", "xyz"[axis]), "rad_per_s", 1.0,
        [axis](const Launch& l) { return l.head_spin[axis]; });
  add("contact_time", "ms", 1e-3, [](const Launch& l) { return l.contact_time; });
  add("peak_force", "N", 1.0, [](const Launch& l) { return l.peak_force; });
  add("peak_compression", "mm", 1e-3, [](const Launch& l) { return l.peak_compression; });
  return all;
}

std::optional<double> lost_carry(const FaceMap& map, std::size_t p) {
  double longest = 0;
  for (const auto& f : map.flights)
    if (f) longest = std::max(longest, f->flight.carry);
  return map.flights[p] ? std::optional(longest - map.flights[p]->flight.carry) : std::nullopt;
}

std::vector<MapQuantity> all_quantities(DistanceUnit unit) {
  std::vector<MapQuantity> all = launch_quantities();
  for (const FlightChannel& c : flight_channels(unit))
    all.push_back(
        {std::string(c.name), std::string(c.unit), c.si, true, [value = c.value](const FaceMap& map, std::size_t p) {
           return map.flights[p] ? value(*map.flights[p]) : std::nullopt;
         }});
  all.push_back({"lost_carry", std::string(suffix(unit)), size(unit), true, lost_carry});
  return all;
}

bool nowhere(const std::vector<double>& v) {
  return std::ranges::none_of(v, [](double x) { return std::isfinite(x); });
}

/// Of the maps, or of those that have a reference minus it.
std::string csv(const FaceGrid& grid, const std::vector<FaceMap>& maps, const References* references) {
  Table out{{{"model"}, {"impact_toe_mm", "{:.6g}"}, {"impact_high_mm", "{:.6g}"}}};
  std::span<const MapQuantity> quantities;  // those of a map that has flights, where one has
  for (const FaceMap& map : maps)
    if (map_quantities(map).size() > quantities.size()) quantities = map_quantities(map);
  for (const MapQuantity& q : quantities) out.in_files({fmt::format("{}_{}", q.name, q.unit)}, "{:.9g}");
  for (std::size_t m = 0; m < maps.size(); ++m) {
    if (references && !(*references)[m]) continue;
    std::vector<std::vector<double>> columns;
    for (const MapQuantity& q : quantities)
      columns.push_back(references ? differences(maps[m], maps[*(*references)[m]], q) : values(maps[m], q));
    for (std::size_t p = 0; p < grid.size(); ++p) {
      out.add(maps[m].title, 1e3 * grid.toe_at(p), 1e3 * grid.high_at(p));
      for (const auto& c : columns) out.more(if_finite(c.empty() ? kNaN : c[p]));
    }
  }
  return out.csv();
}

}  // namespace

std::span<const MapQuantity> map_quantities(const FaceMap& map) {
  static const std::vector<MapQuantity> launch = launch_quantities(), yards = all_quantities(DistanceUnit::yards),
                                        metres = all_quantities(DistanceUnit::metres);
  if (map.flights.empty()) return launch;
  return map.distances == DistanceUnit::yards ? yards : metres;
}

std::vector<double> values(const FaceMap& map, const MapQuantity& q) {
  std::vector<double> out;
  if (q.of_flight && map.flights.empty()) return out;
  out.reserve(map.launches.size());
  for (std::size_t p = 0; p < map.launches.size(); ++p) {
    const auto x = q.value(map, p);
    out.push_back(x ? *x / q.si : kNaN);
  }
  if (nowhere(out)) out.clear();
  return out;
}

std::vector<double> differences(const FaceMap& map, const FaceMap& reference, const MapQuantity& q) {
  std::vector<double> a = values(map, q);
  const std::vector<double> b = values(reference, q);
  if (a.empty() || b.empty()) return {};
  const Channel* channel = q.of_flight ? nullptr : find_channel(q.name);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = channel ? difference(*channel, a[i], b[i]) : a[i] - b[i];
  return a;
}

std::string face_map_csv(const FaceGrid& grid, const std::vector<FaceMap>& maps) { return csv(grid, maps, nullptr); }

std::string difference_csv(const FaceGrid& grid, const std::vector<FaceMap>& maps, const References& references) {
  return csv(grid, maps, &references);
}

void frame_face(Panel& p) {
  p.x_label = "heel  <-  impact toe [mm]  ->  toe";
  p.y_label = "impact high [mm]";
  p.map_equal_axes = true;
  Series circle{.style = "lines dt 2"};
  for (int k = 0; k <= 72; ++k) {
    circle.x.push_back(12 * std::cos(k * kPi / 36));
    circle.y.push_back(12 * std::sin(k * kPi / 36));
  }
  p.series.push_back(std::move(circle));
}

Panel face_panel(const FaceGrid& grid, const std::vector<double>& v, std::string title, std::string label,
                 bool symmetric) {
  Panel p;
  p.title = std::move(title);
  p.map_label = std::move(label);
  p.map_symmetric = symmetric;
  for (int i = 0; i < grid.columns; ++i) p.map_x.push_back(1e3 * grid.toe(i));
  for (int j = 0; j < grid.rows; ++j) p.map_y.push_back(1e3 * grid.high(j));
  p.map = v;
  frame_face(p);
  return p;
}

VtkMesh face_map_mesh(const Face& face, const FaceGrid& grid, const std::vector<FaceMap>& maps,
                      const References& references) {
  VtkMesh mesh;
  for (std::size_t p = 0; p < grid.size(); ++p) mesh.points.push_back(face.point(-grid.toe_at(p), grid.high_at(p)));
  for (int j = 0; j + 1 < grid.rows; ++j)
    for (int i = 0; i + 1 < grid.columns; ++i) {
      const std::int64_t a = std::int64_t(j) * grid.columns + i, b = a + grid.columns;
      mesh.cells.push_back({CellShape::quad, {a, b, b + 1, a + 1}});  // normal out of the face
    }
  for (std::size_t k = 0; k < maps.size(); ++k)
    for (const MapQuantity& q : map_quantities(maps[k])) {
      const FaceMap& m = maps[k];
      if (auto v = values(m, q); !v.empty())
        mesh.point_fields.push_back({fmt::format("{}.{}", m.title, q.name), symbol(q.unit), 1, std::move(v)});
      if (!references[k]) continue;
      const FaceMap& reference = maps[*references[k]];
      if (auto v = differences(m, reference, q); !v.empty())
        mesh.point_fields.push_back(
            {fmt::format("{}-minus-{}.{}", m.title, reference.title, q.name), symbol(q.unit), 1, std::move(v)});
    }
  return mesh;
}

}  // namespace hosel::post
