#include "hosel/app/read_solid.hpp"

#include <array>

namespace hosel::app {
namespace {

constexpr std::array kLaws = {
    NamedLaw{"neo-hooke", "c10 and bulk modulus, or Young's modulus and Poisson's ratio"},
    NamedLaw{"mooney-rivlin", "c10, c01 and bulk modulus"},
    NamedLaw{"yeoh", "c10, c20, c30 and bulk modulus"},
    NamedLaw{"ogden", "moduli and exponents of principal stretches, and bulk modulus"},
    NamedLaw{"st-venant-kirchhoff", "Green's strain, linear: Young's modulus and Poisson's ratio"},
    NamedLaw{"linear", "small strain: Young's modulus and Poisson's ratio"},
};

}  // namespace

std::span<const NamedLaw> solid_laws() { return kLaws; }

fem::Solid read_solid(Table table) {
  const Range positive = Range::positive(), some = Range::non_negative();
  fem::Solid solid;
  solid.density = table.quantity("density", "kg_per_m3", positive, 1129.0);
  std::vector<std::string> laws;
  for (const NamedLaw& l : kLaws) laws.emplace_back(l.name);
  const std::string law = table.choice("law", laws, "neo-hooke");
  if (law == "mooney-rivlin" || law == "yeoh" || (law == "neo-hooke" && table.has_quantity("c10"))) {
    fem::Hyperelastic h;
    h.c10 = table.quantity("c10", "MPa", positive);
    h.bulk = table.quantity("bulk", "MPa", positive);
    if (law == "mooney-rivlin") h.c01 = table.quantity("c01", "MPa", some);
    if (law == "yeoh") {
      h.c20 = table.quantity("c20", "MPa");
      h.c30 = table.quantity("c30", "MPa", Range::finite(), 0.0);
    }
    solid.elastic = h;
  } else if (law == "ogden") {
    fem::Ogden o{.bulk = table.quantity("bulk", "MPa", positive)};
    const auto moduli = table.quantities("moduli", "MPa", 0, Range::finite());
    const auto exponents = table.numbers("exponents", moduli.size(), Range::finite());
    for (std::size_t i = 0; i < moduli.size(); ++i) o.powers.push_back({moduli[i], exponents[i]});
    solid.elastic = o;
  } else {
    const auto lame = fem::Lame::of(table.quantity("young", "MPa", positive), table.number("poisson", {-0.9, 0.49999}));
    if (law == "neo-hooke") solid.elastic = fem::Hyperelastic::neo_hooke(lame);
    if (law == "st-venant-kirchhoff") solid.elastic = fem::StVenantKirchhoff{lame};
    if (law == "linear") solid.elastic = fem::LinearElastic{lame};
  }
  const auto moduli = table.quantities("branch_moduli", "MPa", 0, some, std::vector<double>{});
  const auto times = table.quantities("branch_times", "ms", moduli.size(), positive, std::vector<double>{});
  if (moduli.size() != times.size()) table.fail("branch_times_ms", "one relaxation time for each branch modulus");
  for (std::size_t i = 0; i < moduli.size(); ++i) solid.branches.push_back({moduli[i], times[i]});
  if (const auto faults = solid.faults(); !faults.empty()) table.fail("law", faults.front());
  return solid;
}

models::FeBall read_fe_ball(Table table, const models::FeBall& standard) {
  auto layers = table.tables("layers");
  if (layers.empty()) {
    std::vector<std::string> names;
    for (const auto& named : models::ball_library()) names.emplace_back(named.name);
    const std::string name = table.choice("model", names, standard.name);
    for (const auto& named : models::ball_library())
      if (named.name == name) return named.make();
    return standard;
  }
  models::FeBall ball{"case", {}};
  for (Table& layer : layers) {
    const double radius = layer.number("radius_fraction", {0.05, 1},
                                       &layer == &layers.back() ? std::optional<double>(1.0) : std::nullopt);
    ball.layers.push_back({radius, read_solid(layer)});
  }
  if (const auto faults = ball.faults(); !faults.empty()) table.fail("layers", faults.front());
  return ball;
}

}  // namespace hosel::app
