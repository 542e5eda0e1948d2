#include "app/read_solid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "fem/materials/gent.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "fem/materials/linear_elastic.hpp"
#include "fem/materials/ogden.hpp"
#include "fem/materials/st_venant_kirchhoff.hpp"
#include "fem/materials/time_temperature.hpp"
#include "models/fe/changeable_fe.hpp"

namespace hosel::app {
namespace {

fem::Lame read_lame(Table& t) {
  const double young = t.quantity({"young", "Young's modulus at small strain"}, "MPa", Range::positive());
  return fem::Lame::of(young, t.number({"poisson", "Poisson's ratio at small strain"}, {-0.9, 0.49999}));
}

/// c10 and the bulk modulus, which every polynomial law has.
fem::Hyperelastic read_polynomial(Table& t) {
  const double c10 =
      t.quantity({"c10", "coefficient of I1 - 3; twice c10 + c01 is the shear modulus"}, "MPa", Range::positive());
  return {.c10 = c10, .bulk = t.quantity({"bulk", "bulk modulus"}, "MPa", Range::positive())};
}

fem::Elastic neo_hooke(Table& t) {
  return t.has_quantity("c10") ? read_polynomial(t) : fem::Hyperelastic::neo_hooke(read_lame(t));
}

fem::Elastic mooney_rivlin(Table& t) {
  fem::Hyperelastic law = read_polynomial(t);
  law.c01 = t.quantity({"c01", "coefficient of I2 - 3"}, "MPa", Range::non_negative());
  return law;
}

fem::Elastic yeoh(Table& t) {
  fem::Hyperelastic law = read_polynomial(t);
  law.c20 = t.quantity({"c20", "coefficient of (I1 - 3) squared"}, "MPa");
  law.c30 = t.quantity({"c30", "coefficient of (I1 - 3) cubed"}, "MPa", Range::finite(), 0.0);
  return law;
}

fem::Elastic ogden(Table& t) {
  fem::Ogden law{.bulk = t.quantity({"bulk", "bulk modulus"}, "MPa", Range::positive())};
  const auto moduli =
      t.quantities({"moduli", "one modulus for each power of the principal stretches"}, "MPa", 0, Range::finite());
  const auto exponents = t.numbers({"exponents", "one exponent for each modulus"}, moduli.size(), Range::finite());
  for (std::size_t i = 0; i < moduli.size(); ++i) law.powers.push_back({moduli[i], exponents[i]});
  return law;
}

fem::Elastic gent(Table& t) {
  const double shear = t.quantity({"shear", "shear modulus at small strain"}, "MPa", Range::positive());
  const double limit = t.number({"limit", "what I1 - 3 never reaches: chains of limited length"}, Range::positive());
  return fem::Gent(fem::GentEnergy{shear, limit, t.quantity({"bulk", "bulk modulus"}, "MPa", Range::positive())});
}

fem::Elastic st_venant_kirchhoff(Table& t) { return fem::StVenantKirchhoff{read_lame(t)}; }
fem::Elastic linear(Table& t) { return fem::LinearElastic{read_lame(t)}; }

constexpr std::array kLaws = {
    NamedLaw{"neo-hooke", "c10 and bulk modulus, or Young's modulus and Poisson's ratio", neo_hooke},
    NamedLaw{"mooney-rivlin", "c10, c01 and bulk modulus", mooney_rivlin},
    NamedLaw{"yeoh", "c10, c20, c30 and bulk modulus", yeoh},
    NamedLaw{"ogden", "moduli and exponents of principal stretches, and bulk modulus", ogden},
    NamedLaw{"gent", "shear modulus, limit of the chains and bulk modulus", gent},
    NamedLaw{"st-venant-kirchhoff", "Green's strain, linear: Young's modulus and Poisson's ratio", st_venant_kirchhoff},
    NamedLaw{"linear", "small strain: Young's modulus and Poisson's ratio", linear},
};

}  // namespace

std::span<const NamedLaw> solid_laws() { return kLaws; }

namespace {

/// Turns the solids into what they are at the temperature that `table` states, where it does.
void read_temperature(Table& table, std::span<fem::Solid* const> solids, bool of_ball) {
  auto t = table.optional_table("temperature");
  if (!t) return;
  constexpr double zero = 273.15;
  // Between the frost and the sun of a golf course: the constants of the shift are far from the glass there.
  const Range celsius{-20, 60};
  fem::TimeTemperature law;
  const double now = zero + t->number({"now_C", "temperature of the rubber [deg C]"}, celsius);
  law.measured = zero + t->number({"measured_C", "temperature at which its constants hold [deg C]"}, celsius, 23.0);
  law.c1 = t->number({"wlf_c1", "Williams-Landel-Ferry constant at 298 K, of cis-polybutadiene unless stated [-]"},
                     {0, 50}, law.c1);
  law.c2 = t->number({"wlf_c2_K", "the other one [K]"}, {60, 1000}, law.c2);
  if (const auto faults = law.faults(now); !faults.empty()) t->fail("now_C", faults.front());
  constexpr double far = 5;  // [K]
  const auto one_time = [](const fem::Solid* s) { return s->branches.size() == 1; };
  if (of_ball && std::abs(now - law.measured) > far && std::ranges::any_of(solids, one_time))
    t->doubt(fmt::format(
        "a layer with one Maxwell branch loses energy at one frequency, which {:g} K move: whether such a ball is "
        "faster "
        "or slower is no prediction (measured balls are slower when they are colder); branches over two decades of "
        "time are wanted",
        now - law.measured));
  for (fem::Solid* solid : solids) *solid = fem::at_temperature(std::move(*solid), law, now);
}

}  // namespace

fem::Solid read_solid(Table table) {
  const double density =
      table.quantity({"density", "of the unstrained material"}, "kg_per_m3", Range::positive(), 1129.0);
  const std::string name =
      table.choice({"law", "stored energy of the long-term response"}, names_in(kLaws), "neo-hooke");
  const auto law = std::ranges::find(kLaws, name, &NamedLaw::name);
  fem::Solid solid{.elastic = law->read(table), .branches = {}, .density = density};
  const auto moduli = table.quantities({"branch_moduli", "shear moduli of the Maxwell branches of the Prony series"},
                                       "MPa", 0, Range::non_negative(), std::vector<double>{});
  const auto times = table.quantities({"branch_times", "relaxation times of the Maxwell branches"}, "ms", moduli.size(),
                                      Range::positive(), std::vector<double>{});
  if (moduli.size() != times.size()) table.fail("branch_times_ms", "one relaxation time for each branch modulus");
  for (std::size_t i = 0; i < moduli.size(); ++i) solid.branches.push_back({moduli[i], times[i]});
  if (const auto faults = solid.faults(); !faults.empty()) table.fail("law", faults.front());
  fem::Solid* const one[] = {&solid};
  read_temperature(table, one, false);
  return solid;
}

models::FeBall read_layers(Table table) {
  auto layers = table.tables("layers");
  models::FeBall ball{"case", {}};
  for (Table& layer : layers) {
    const double radius = layer.number(
        {"radius_fraction", "outer radius of this layer over the ball's; layers go outwards, the last ends at 1"},
        {0.05, 1}, &layer == &layers.back() ? std::optional<double>(1.0) : std::nullopt);
    ball.layers.push_back({radius, read_solid(layer)});
  }
  if (const auto faults = ball.faults(); !faults.empty()) table.fail("layers", faults.front());
  return ball;
}

namespace {

models::FeBall read_declared_ball(Table& table, const models::FeBall& standard) {
  const auto name = named_entry(table, "model", Shelf::balls);
  if (!table.tables("layers").empty()) {
    if (name) table.fail("model", "either a ball of the library or layers");
    return read_layers(table);
  }
  if (name) return library_ball(*name).layers;
  table.text({"model", "a ball of the library (`hosel list`)"}, standard.name);
  return standard;
}

}  // namespace

models::FeBall read_fe_ball(Table table, const models::FeBall& standard) {
  models::FeBall ball = read_declared_ball(table, standard);
  if (auto t = table.optional_table("changes")) {
    const Range factor{0.05, 20};
    models::FeChange c;
    c.cover_stiffness = std::log(t->number(
        {"cover_moduli_factor",
         "on the shear moduli (elastic and branches) of the outermost layer; a ball of one piece gets a skin"},
        factor, 1.0));
    c.cover_thickness = t->quantity({"added_cover", "thickness added to the outermost layer"}, "mm", {-5e-3, 5e-3}, 0);
    c.losses = std::log(t->number({"branch_moduli_factor", "on the branch moduli of every layer"}, factor, 1.0));
    c.relaxation = std::log(t->number(
        {"branch_times_factor", "on the branch times, moduli at the frequency of the contact kept"}, factor, 1.0));
    try {
      ball = changed(std::move(ball), c,
                     table.quantity({"radius", "of the ball"}, "mm", limits::ball_radius, Ball{}.radius));
    } catch (const std::invalid_argument& e) { t->fail("", e.what()); }
    if (const auto faults = ball.faults(); !faults.empty()) t->fail("", faults.front());
  }
  std::vector<fem::Solid*> rubbers;
  for (models::BallLayer& layer : ball.layers) rubbers.push_back(&layer.material);
  read_temperature(table, rubbers, true);
  return ball;
}

}  // namespace hosel::app
