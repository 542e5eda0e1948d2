// The clamp (or the hands) yields.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> clamp_compliance(const HistorySetting& setting) {
  const double unit = setting.compliance;
  const auto form = [&](const char* what, double complexity, const Vec3& axes) {
    Parametrisation f{.what = what,
                      .parameters = {{"compliance", "mrad/(N m)", 1e-3, 0, 2 * unit, 0.01 * unit}},
                      .complexity = complexity,
                      .starts = {{0.05 * unit}, {0.3 * unit}}};
    f.setup = [axes](Sizes p, TestSetup& r) { r.club.clamp += p[0] * axes; };
    return f;
  };
  std::vector<Parametrisation> forms = {form("alike in both planes", 0, Vec3(1, 1, 0)),
                                        form("in the lead plane", 2, Vec3::UnitY()),
                                        form("in the droop plane", 2, Vec3::UnitX())};
  if (setting.head) forms.push_back(form("about the shaft", 2, Vec3::UnitZ()));
  return forms;
}

}  // namespace hosel::loop::forms
