#include "app/read_plate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/read_sheet.hpp"

namespace hosel::app {
namespace {

using mesh::PlateOutline;
using mesh::PlateThickness;

constexpr Range kPlace = Range{-0.1, 0.1}.because("no face is wider");
constexpr Range kHalf = Range{5e-3, 0.1}.because("no face is wider");
constexpr Range kThickness = Range{2e-4, 0.05}.because("a plate is thinner than wide");

/// Places of a CSV by `toe_*`, `high_*`; y points to the heel.
std::vector<Eigen::Vector2d> places(const post::Sheet& sheet) {
  const std::vector<double> toe = column(sheet, "toe", Dimension::length),
                            high = column(sheet, "high", Dimension::length);
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < toe.size(); ++i) {
    for (const double x : {toe[i], high[i]})
      if (!kPlace.contains(x))
        throw InputError(fmt::format("{}:{}: {:g} mm is no place on a face ({} mm at most)", sheet.file, sheet.lines[i],
                                     1e3 * x, 1e3 * kPlace.max));
    out.emplace_back(-toe[i], high[i]);
  }
  return out;
}

PlateOutline read_outline(Table t) {
  PlateOutline out;
  const std::string form = t.choice({"form", "of the outline; a polygon's corners stand in a CSV"},
                                    {"ellipse", "superellipse", "rectangle", "polygon"}, "ellipse");
  if (form != "polygon") {
    out.form = form == "rectangle" ? PlateOutline::Form::rectangle : PlateOutline::Form::superellipse;
    out.half_width = t.quantity({"half_width", "heel to toe"}, "mm", kHalf, out.half_width);
    out.half_height = t.quantity({"half_height", "up and down"}, "mm", kHalf, out.half_height);
    if (form == "superellipse")
      out.exponent = t.number({"exponent", "n of |y/w|^n + |z/h|^n = 1; 2 is the ellipse"},
                              Range{1.5, 20}.because("beyond, it is a rectangle"), 2.5);
    return out;
  }
  out.form = PlateOutline::Form::polygon;
  const post::Sheet sheet = read_sheet(t.file({"file", "CSV with a corner in each row: toe_mm, high_mm"}));
  out.corners = places(sheet);
  if (out.corners.size() < 3) throw InputError(fmt::format("{}: an outline needs three corners", sheet.file));
  if (const auto at = out.turned_back())
    throw InputError(
        fmt::format("{}:{}: the outline turns back here: every ray from the face's centre must meet it "
                    "once",
                    sheet.file, sheet.lines[*at]));
  if (const auto faults = out.faults(); !faults.empty())
    throw InputError(fmt::format("{}: {}", sheet.file, faults.front()));
  return out;
}

PlateThickness::Grid read_grid(const post::Sheet& sheet) {
  const std::vector<Eigen::Vector2d> at = places(sheet);
  const std::vector<double> thickness = column(sheet, "thickness", Dimension::length);
  PlateThickness::Grid out;
  const auto line = [](std::vector<double>& lines, double x) {
    constexpr double kSame = 1e-7;  // two cells of one line of the grid [m]
    const auto near = std::ranges::find_if(lines, [&](double l) { return std::abs(l - x) < kSame; });
    if (near == lines.end()) lines.push_back(x);
  };
  for (const auto& p : at) {
    line(out.y, p.x());
    line(out.z, p.y());
  }
  std::ranges::sort(out.y);
  std::ranges::sort(out.z);
  if (out.y.size() < 2 || out.z.size() < 2)
    throw InputError(fmt::format("{}:1: a thickness grid needs two places each way", sheet.file));
  const auto number = [](const std::vector<double>& lines, double x) {
    return std::size_t(std::ranges::min_element(lines, {}, [&](double l) { return std::abs(l - x); }) - lines.begin());
  };
  out.value.assign(out.y.size() * out.z.size(), 0);
  std::vector<std::size_t> from(out.value.size(), 0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!kThickness.contains(thickness[i]))
      throw InputError(fmt::format("{}:{}: a thickness of {:g} mm is out of range (allowed: {:g} to {:g} mm)",
                                   sheet.file, sheet.lines[i], 1e3 * thickness[i], 1e3 * kThickness.min,
                                   1e3 * kThickness.max));
    const std::size_t cell = number(out.z, at[i].y()) * out.y.size() + number(out.y, at[i].x());
    if (out.value[cell] > 0)
      throw InputError(
          fmt::format("{}:{}: this place stands in line {} already", sheet.file, sheet.lines[i], from[cell]));
    out.value[cell] = thickness[i];
    from[cell] = sheet.lines[i];
  }
  for (std::size_t cell = 0; cell < out.value.size(); ++cell)
    if (!(out.value[cell] > 0)) {
      throw InputError(fmt::format("{}:1: no row has toe {:g} mm, high {:g} mm, where other rows' places cross",
                                   sheet.file, -1e3 * out.y[cell % out.y.size()], 1e3 * out.z[cell / out.y.size()]));
    }
  return out;
}

PlateThickness read_thickness(Table t, std::string& file) {
  PlateThickness out;
  const std::string map =
      t.choice({"map", "how thickness varies over the face"}, {"constant", "rings", "bulge", "grid"}, "constant");
  if (map == "constant") {
    out.map = PlateThickness::Constant{t.quantity({"value", "thickness"}, "mm", kThickness)};
  } else if (map == "rings") {
    PlateThickness::Rings r;
    r.share =
        t.numbers({"share", "stations from the centre, 0, to the rim, 1; straight between them"}, 0, Range::fraction());
    r.value = t.quantities({"value", "thickness at each station"}, "mm", 0, kThickness);
    out.map = r;
  } else if (map == "bulge") {
    PlateThickness::Bulge b;
    b.centre = t.quantity({"centre", "thickness at the face's centre"}, "mm", kThickness);
    b.rim = t.quantity({"rim", "thickness outside the bulge"}, "mm", kThickness);
    b.half_width = t.quantity({"half_width", "of the bulge of thickness, heel to toe"}, "mm", kHalf);
    b.half_height = t.quantity({"half_height", "of the bulge of thickness, up and down"}, "mm", kHalf);
    out.map = b;
  } else {
    const post::Sheet sheet =
        read_sheet(t.file({"file", "CSV with a row for each crossing of a grid: toe_mm, high_mm, thickness_mm"}));
    file = sheet.file;
    out.map = read_grid(sheet);
  }
  if (const auto faults = out.faults(); !faults.empty()) t.fail(map == "rings" ? "share" : map, faults.front());
  return out;
}

fem::PlateMaterial read_material(Table& t) {
  const std::string name = t.choice({"material", "titanium is Ti-6Al-4V; own: state the three constants"},
                                    {"titanium", "maraging-steel", "own"}, "titanium");
  std::optional<fem::PlateMaterial> named;
  if (name == "titanium") named = fem::PlateMaterial{114e9, 0.34, 4430};
  if (name == "maraging-steel") named = fem::PlateMaterial{190e9, 0.30, 8000};
  fem::PlateMaterial out;
  out.young =
      t.quantity({"young", "Young's modulus"}, "GPa", {1e9, 1e12}, standard_of(named, &fem::PlateMaterial::young));
  out.poisson = t.number({"poisson", "Poisson's ratio"}, {0, 0.49}, standard_of(named, &fem::PlateMaterial::poisson));
  out.density = t.quantity({"density", "of the face"}, "kg_per_m3", {500, 2.5e4},
                           standard_of(named, &fem::PlateMaterial::density));
  return out;
}

fem::RimSupport read_rim(Table t, const fem::PlateMaterial& material) {
  fem::RimSupport out;
  const std::string support =
      t.choice({"support", "what crown and sole do to the rim: a shell is a thin one of the face's material"},
               {"clamped", "shell", "springs"}, "shell");
  if (support == "clamped") return out;
  const bool shell = support == "shell";
  if (shell) {
    const double thickness =
        t.quantity({"thickness", "of crown and sole beside the face"}, "mm", Range{1e-4, 0.01}, 0.8e-3);
    const double radius = t.quantity({"radius", "of their curvature across the rim"}, "mm", Range{5e-3, 1}, 0.04);
    const double length = t.quantity({"length", "from the face to the back of the head"}, "mm", Range{5e-3, 0.5}, 0.1);
    out = fem::RimSupport::of_shell(material, thickness, radius, length);
  }
  const Range some = Range::non_negative().or_infinite(), positive = Range::positive().or_infinite();
  const auto standard = [&](double x) { return shell ? std::optional(x) : std::nullopt; };
  // The shell couples its own springs, and none that is stated.
  const bool own = shell && !t.has_quantity("rotation") && !t.has_quantity("stretch");
  out.rotation =
      t.quantity({"rotation", "moment per length of rim and radian; inf: held"}, "N", some, standard(out.rotation));
  out.deflection = t.quantity({"deflection", "force across the face per length of rim and deflection; inf: held"},
                              "GPa", positive, standard(out.deflection));
  out.stretch =
      t.quantity({"stretch", "the same in the face's plane; inf: held"}, "GPa", positive, standard(out.stretch));
  t.decided_by("support");
  out.lean = t.number({"lean_per_m",
                       "turn about the rim where no moment acts, per displacement in the face's plane; 0 where "
                       "rotation or stretch is stated"},
                      {-1e4, 1e4}, own ? out.lean : 0);
  return out;
}

}  // namespace

models::PlateDesign read_plate(Table t) {
  models::PlateDesign d;
  d.material = read_material(t);
  if (t.has_quantity("yield"))
    d.yield =
        t.quantity({"yield", "yield strength of the material: a stress beyond it is said to be so; none by default"},
                   "MPa", {1e6, 5e9});
  d.outline = read_outline(t.default_table("outline"));
  std::string grid;
  d.thickness = read_thickness(t.table("thickness"), grid);
  d.rim = read_rim(t.default_table("rim"), d.material);
  d.damping = t.number({"damping", "of each mode, over the critical"}, {0, 0.2}, d.damping);
  Table mesh = t.default_table("mesh");
  d.mesh.core = int(mesh.integer({"core", "elements along a side of the core block, across the height of a rectangle"},
                                 2, 40, d.mesh.core));
  d.mesh.rings = int(mesh.integer({"rings", "rings of elements around the core block"}, 1, 40, d.mesh.rings));
  d.modes = int(mesh.integer({"modes", "of the plate that a blow keeps beside four static shapes"}, 1, 27, d.modes));
  for (const auto& [key, faults] :
       {std::pair{"outline", d.outline.faults()}, {"rim", d.rim.faults()}, {"mesh", d.mesh.faults()}, {"", d.faults()}})
    if (!faults.empty()) t.fail(key, faults.front());
  try {
    for (const auto& node : mesh::plate_mesh(d.outline, d.mesh).nodes)
      d.thickness.at(node, std::min(1.0, d.outline.share(node)));
  } catch (const std::invalid_argument& e) {
    if (!grid.empty()) throw InputError(fmt::format("{}: {}", grid, e.what()));
    t.fail("outline", e.what());
  }
  return d;
}

std::optional<models::PlateDesign> read_optional_plate(Table root) {
  auto face = root.optional_table("face");
  if (!face || !face->has("plate")) return {};
  if (face->has("name")) face->fail("name", "either a face of the library or [face.plate]");
  return read_plate(face->table("plate"));
}

}  // namespace hosel::app
