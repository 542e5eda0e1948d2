// The effective rotational inertia differs: a shaft resists the turn, or the declared tensor is wrong.
#include <cmath>

#include "hosel/loop/effects/all.hpp"

namespace hosel::loop::forms {

std::vector<Form> head_inertia(const Setting& setting) {
  if (!setting.head_turns) return {};
  // Logarithm of the factor: zero is the declared tensor, and no factor can turn negative.
  const auto factor = [](const char* name) { return Parameter{name, "1", 1, -0.8, 1.5, 0.1}; };
  Form all{.effect = "head-inertia", .what = "one factor on the tensor", .parameters = {factor("log_factor")}};
  all.before = [](std::span<const double> p, Trial& t) { t.blow.club.head.inertia *= std::exp(p[0]); };
  const auto along = [&](int axis, const char* name, const char* what) {
    Form one{.effect = "head-inertia", .what = what, .parameters = {factor(name)}};
    one.before = [axis](std::span<const double> p, Trial& t) {
      Mat3& inertia = t.blow.club.head.inertia;
      const double root = std::exp(0.5 * p[0]);
      inertia.row(axis) *= root;
      inertia.col(axis) *= root;
    };
    return one;
  };
  Form two{.effect = "head-inertia",
           .what = "factors about the horizontal and the vertical axis",
           .parameters = {factor("log_factor_horizontal"), factor("log_factor_vertical")}};
  two.before = [](std::span<const double> p, Trial& t) {
    Mat3& inertia = t.blow.club.head.inertia;
    for (const int k : {0, 1}) {
      const double root = std::exp(0.5 * p[std::size_t(k)]);
      inertia.row(k + 1) *= root;
      inertia.col(k + 1) *= root;
    }
  };
  return {all, along(2, "log_factor_vertical", "about the vertical axis of the face"),
          along(1, "log_factor_horizontal", "about the horizontal axis of the face"), two};
}

}  // namespace hosel::loop::forms
