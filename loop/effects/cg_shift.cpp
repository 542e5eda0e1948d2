// The centre of gravity is not where it is declared.
#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {
namespace {
constexpr const char* kShifts[] = {"shift_out", "shift_heel", "shift_up"};
}

std::vector<Parametrisation> cg_shift(const Setting& setting) {
  if (!setting.inertia_declared) return {};
  // Usual: assumed, what weights that move shift.
  const auto component = [](const char* name) { return Parameter{name, "mm", 1e-3, -0.02, 0.02, 2e-3}.within(4e-3); };
  const auto along = [&](const std::vector<int>& axes, const char* what) {
    Parametrisation f{.what = what};
    for (const int a : axes) f.parameters.push_back(component(kShifts[a]));
    f.before = [axes](Sizes p, Shot& t) {
      for (std::size_t k = 0; k < axes.size(); ++k) t.blow.club.head.cg[axes[k]] += p[k];
    };
    return f;
  };
  Parametrisation depth = along({0}, "out of the face");
  depth.complexity = 8;  // the depth is what a balance finds first
  Parametrisation all = along({0, 1, 2}, "in three directions");
  all.complexity = 6;
  return {along({1}, "towards the heel"), along({2}, "up"), depth, along({1, 2}, "in the face plane"), all};
}

std::vector<Parametrisation> cg_shift(const HistorySetting& setting) {
  if (!setting.head) return {};
  const auto along = [](const std::vector<int>& axes, const char* what, double complexity) {
    Parametrisation f{.what = what, .complexity = complexity};
    for (const int a : axes) f.parameters.push_back({kShifts[a], "mm", 1e-3, -0.03, 0.03, 1e-3});
    f.setup = [axes](Sizes p, TestSetup& r) {
      for (std::size_t k = 0; k < axes.size(); ++k) r.club.cg[axes[k]] += p[k];
    };
    return f;
  };
  return {along({1}, "towards the heel", 0), along({2}, "up", 0), along({0}, "out of the face", 0),
          along({1, 2}, "in the face plane", 2)};
}

}  // namespace hosel::loop::forms
