#include "post/energy_table.hpp"

#include "post/digits.hpp"

namespace hosel::post {

TextTable energy_table(const std::vector<std::pair<std::string, solvers::Ledger>>& runs, EnergyOf what) {
  const bool blow = what == EnergyOf::blow;
  TextTable t{.rows = {{"energy [J]"}}};
  for (const auto& [name, ledger] : runs) t.rows[0].push_back(name);
  const auto row = [&](const char* name, auto value) {
    auto& cells = t.rows.emplace_back(1, name);
    for (const auto& [run, ledger] : runs) cells.push_back(fixed(value(ledger), 4));
  };
  using L = solvers::Ledger;
  row("before", [](const L& l) { return l.initial; });
  row(blow ? "work of hands, gravity and driven grip" : "work of grip and gravity",
      [](const L& l) { return l.external; });
  row("of motion, after", [](const L& l) { return l.kinetic; });
  row("of strain, after", [](const L& l) { return l.strain_total(); });
  row(blow ? "turned into heat: ball, face, shaft, grip" : "turned into heat: shaft, joint, hands",
      [](const L& l) { return l.viscous; });
  if (blow) {
    row("lost in friction", [](const L& l) { return l.friction; });
    row("in the contact's penalty", [](const L& l) { return l.contact; });
  }
  row("lost by the time scheme", [](const L& l) { return l.numerical; });
  row("unaccounted for", [](const L& l) { return l.closure; });
  return t;
}

}  // namespace hosel::post
