#include "post/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "golf/units.hpp"

namespace hosel::post {

Figure trajectory_figure(std::string title, const std::vector<NamedFlight>& flights) {
  const DistanceUnit unit = flights.front().shot.unit;
  const std::string_view shown = suffix(unit);
  Figure figure{.title = std::move(title), .columns = 1, .panel_width = 700};
  // With room for the key below.
  figure.panel_height = 330 + 5 * int(flights.size());
  Panel side{.title = "from the side",
             .x_label = fmt::format("towards the target [{}]", shown),
             .y_label = fmt::format("height [{}]", shown)},
      top = side;
  top.title = "from above";  // the target to the right: left is up, and right is positive as in every table
  top.y_down = true;
  top.y_label = fmt::format("right  <-  [{}]  ->  left", shown);
  // Many flights are told apart by their first words, "7-iron" of "7-iron, measured", in colour; by the others in
  // dashes.
  struct Look {
    std::string name;
    int colour, dashes;
  };
  std::vector<std::string> names, variants;
  std::vector<Look> looks;
  const auto place = [](std::vector<std::string>& in, const std::string& word) {
    const auto at = std::ranges::find(in, word);
    if (at != in.end()) return int(at - in.begin()) + 1;
    in.push_back(word);
    return int(in.size());
  };
  for (const NamedFlight& f : flights) {
    const std::size_t comma = f.title.rfind(", ");
    const std::string name = f.title.substr(0, comma);
    const int dashes = comma == f.title.npos ? 1 : place(variants, f.title.substr(comma + 2));
    looks.push_back({name, place(names, name), dashes});
  }
  const bool grouped = flights.size() > 8 && names.size() <= 8 && variants.size() <= 4 && names.size() < flights.size();
  if (grouped) {
    static constexpr std::array<const char*, 4> kDashes = {"solid", "dashed", "dotted", "dash-dotted"};
    for (std::size_t i = 1; i < variants.size(); ++i)
      figure.title += fmt::format("{}{}: {}", i == 1 ? "; " : ", ", kDashes[i], variants[i]);
    figure.panel_height = 330 + 5 * int(names.size());
  }
  for (std::size_t k = 0; k < flights.size(); ++k) {
    const NamedFlight& f = flights[k];
    Series height{.label = f.title};
    if (grouped) {
      const Look& look = looks[k];
      height.label = k > 0 && std::ranges::any_of(looks.begin(), looks.begin() + std::ptrdiff_t(k),
                                                  [&](const Look& l) { return l.name == look.name; })
                         ? ""
                         : look.name;
      height.colour = look.colour;
      if (look.dashes > 1) height.style = fmt::format("lines dt {}", look.dashes);
    }
    Series aside = height;
    const auto add = [&](const Vec3& x) {
      height.x.push_back(x.x() / size(unit));
      height.y.push_back(x.z() / size(unit));
      aside.x.push_back(x.x() / size(unit));
      aside.y.push_back(0.0 - x.y() / size(unit));
    };
    for (const models::FlightPoint& p : f.shot.flight.path) add(p.position);
    if (f.shot.run)
      for (const Vec3& x : f.shot.run->path) add(x);
    side.series.push_back(std::move(height));
    top.series.push_back(std::move(aside));
  }
  figure.panels = {std::move(side)};
  // Balls that fly straight have no second view.
  const auto curves = [](const Series& s) {
    return std::ranges::any_of(s.y, [](double y) { return std::abs(y) > 1e-6; });
  };
  if (std::ranges::any_of(top.series, curves)) figure.panels.push_back(std::move(top));
  return figure;
}

VtkMesh trajectory_mesh(const models::Flight& flight) {
  VtkMesh mesh;
  std::vector<Vec3> velocity, spin;
  VtkField time{"time", "s", 1, {}}, reynolds{"reynolds", "", 1, {}}, ratio{"spin_ratio", "", 1, {}},
      drag{"drag_coefficient", "", 1, {}}, lift{"lift_coefficient", "", 1, {}};
  for (const models::FlightPoint& p : flight.path) {
    mesh.points.push_back(p.position);
    velocity.push_back(p.velocity);
    spin.push_back(p.spin);
    time.values.push_back(p.time);
    reynolds.values.push_back(p.reynolds);
    ratio.values.push_back(p.spin_ratio);
    drag.values.push_back(p.coefficients.drag);
    lift.values.push_back(p.coefficients.lift);
  }
  for (std::int64_t i = 1; i < std::int64_t(mesh.points.size()); ++i)
    mesh.cells.push_back({CellShape::line, {i - 1, i}});
  mesh.point_fields = {vector_field("velocity", "m/s", velocity),
                       vector_field("spin", "rad/s", spin),
                       time,
                       reynolds,
                       ratio,
                       drag,
                       lift};
  return mesh;
}

}  // namespace hosel::post
