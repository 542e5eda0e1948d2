// Vibrations die away faster or slower than declared. Parameters are damping ratios at the first mode's frequency.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> shaft_damping(const HistorySetting& setting) {
  const double first = setting.frequency;
  // What is taken away cannot exceed what is declared.
  const Parameter ratio{"damping_ratio", "1", 1, -0.999 * setting.ratio, 0.3, 1e-3};
  const auto form = [&](const char* what, double complexity, auto&& apply) {
    return Parametrisation{
        .what = what, .parameters = {ratio}, .complexity = complexity, .starts = {{0.01}}, .setup = apply};
  };
  std::vector<Parametrisation> forms = {form("in proportion to the stiffness", 0, [first](Sizes p, TestSetup& r) {
    r.club.damping_time += 2 * p[0] / first;
  })};
  if (setting.swing) return forms;
  forms.push_back(
      form("the same ratio for every mode", 0, [](Sizes p, TestSetup& r) { r.club.damping_ratio += p[0]; }));
  forms.push_back(form("in proportion to the mass", 0,
                       [first](Sizes p, TestSetup& r) { r.club.mass_damping += 2 * p[0] * first; }));
  return forms;
}

}  // namespace hosel::loop::forms
