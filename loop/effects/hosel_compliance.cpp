// The joint between shaft tip and head yields.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> hosel_compliance(const HistorySetting& setting) {
  if (!setting.head) return {};
  const double unit = setting.compliance;
  const auto form = [&](const char* what, double complexity, const Vec3& axes) {
    Parametrisation f{.what = what,
                      .parameters = {{"compliance", "mrad/(N m)", 1e-3, 0, 2 * unit, 0.01 * unit}},
                      .complexity = complexity,
                      .starts = {{0.05 * unit}, {0.3 * unit}}};
    f.setup = [axes](Sizes p, TestSetup& r) { r.club.hosel += p[0] * axes; };
    return f;
  };
  return {form("alike about all axes", 0, Vec3::Ones()), form("across the shaft", 0, Vec3(1, 1, 0)),
          form("about the shaft", 2, Vec3::UnitZ())};
}

}  // namespace hosel::loop::forms
