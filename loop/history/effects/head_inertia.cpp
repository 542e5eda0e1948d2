// The head's moment of inertia is not the declared one.
#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> head_inertia(const HistorySetting& setting) {
  if (!setting.head) return {};
  const auto about = [](const char* what, const char* name, double rarity, Vec3 axes) {
    HistoryForm f{{.effect = "head-inertia",
                   .what = what,
                   .parameters = {{name, "1", 1, -0.8, 1.2, 0.02}},
                   .rarity = rarity,
                   .starts = {{-0.3}, {0.3}}},
                  {}};
    f.apply = [axes](std::span<const double> p, Rig& r) { r.club.inertia += p[0] * axes; };
    return f;
  };
  return {about("one factor on the tensor", "log_factor", 0, Vec3::Ones()),
          about("about the face normal", "log_factor_normal", 2, Vec3::UnitX()),
          about("about the horizontal", "log_factor_horizontal", 2, Vec3::UnitY()),
          about("about the vertical", "log_factor_vertical", 2, Vec3::UnitZ())};
}

}  // namespace hosel::loop::history_forms
