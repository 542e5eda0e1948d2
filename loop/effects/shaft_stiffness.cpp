// The shaft is stiffer or softer than its table.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> shaft_stiffness(const Setting& setting) {
  if (!setting.full_club) return {};
  return {{.what = "one factor on bending and torsion",
           .parameters = {{"log_factor", "1", 1, -1.2, 1.2, 0.1}},
           .before = [](Sizes p, Shot& s) { s.change.shaft_stiffness += p[0]; }}};
}

std::vector<Parametrisation> shaft_stiffness(const HistorySetting& setting) {
  // Logarithm of the factor: zero is the table, and no factor can turn negative.
  const auto form = [](const char* what, const char* name, auto&& apply) {
    return Parametrisation{.what = what,
                           .parameters = {{name, "1", 1, -1.2, 1.2, 0.02}},
                           .starts = {{-0.4}, {-0.2}, {0.2}, {0.4}},
                           .setup = apply};
  };
  std::vector<Parametrisation> forms = {
      form("factor on bending", "log_factor_bending", [](Sizes p, TestSetup& r) { r.club.bending += p[0]; })};
  if (setting.head && !setting.swing) {
    forms.push_back(
        form("factor on torsion", "log_factor_torsion", [](Sizes p, TestSetup& r) { r.club.torsion += p[0]; }));
    forms.push_back(form("one factor on bending and torsion", "log_factor", [](Sizes p, TestSetup& r) {
      r.club.bending += p[0];
      r.club.torsion += p[0];
    }));
  }
  return forms;
}

}  // namespace hosel::loop::forms
