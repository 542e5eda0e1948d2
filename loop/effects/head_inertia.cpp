// The effective rotational inertia differs: a shaft resists the turn, or the declared tensor is wrong.
#include <cmath>

#include "loop/effects/all.hpp"
#include "loop/history/test_setup.hpp"

namespace hosel::loop::forms {
namespace {

/// The products of inertia go along, so that the axes' correlation stays.
void scale_moment(Head& head, int axis, double log_factor) {
  const double root = std::exp(0.5 * log_factor);
  head.inertia.row(axis) *= root;
  head.inertia.col(axis) *= root;
}

}  // namespace

std::vector<Parametrisation> head_inertia(const Setting& setting) {
  if (!setting.head_turns) return {};
  // Logarithm of the factor: zero is the declared tensor, and no factor can turn negative. Usual: assumed, half again.
  const auto factor = [](const char* name) { return Parameter{name, "1", 1, -0.8, 1.5, 0.1}.within(0.4); };
  Parametrisation all{.what = "one factor on the tensor", .parameters = {factor("log_factor")}};
  all.before = [](Sizes p, Shot& t) { t.blow.club.head.inertia *= std::exp(p[0]); };
  const auto along = [&](int axis, const char* name, const char* what) {
    Parametrisation one{.what = what, .parameters = {factor(name)}};
    one.before = [axis](Sizes p, Shot& t) { scale_moment(t.blow.club.head, axis, p[0]); };
    return one;
  };
  Parametrisation two{.what = "factors about the horizontal and the vertical axis",
                      .parameters = {factor("log_factor_horizontal"), factor("log_factor_vertical")}};
  two.before = [](Sizes p, Shot& t) {
    for (const int k : {0, 1}) scale_moment(t.blow.club.head, k + 1, p[k]);
  };
  return {all, along(2, "log_factor_vertical", "about the vertical axis of the face"),
          along(1, "log_factor_horizontal", "about the horizontal axis of the face"), two};
}

std::vector<Parametrisation> head_inertia(const HistorySetting& setting) {
  if (!setting.head) return {};
  const auto about = [](const char* what, const char* name, double complexity, const Vec3& axes) {
    Parametrisation f{.what = what,
                      .parameters = {{name, "1", 1, -0.8, 1.2, 0.02}},
                      .complexity = complexity,
                      .starts = {{-0.3}, {0.3}}};
    f.setup = [axes](Sizes p, TestSetup& r) { r.club.inertia += p[0] * axes; };
    return f;
  };
  return {about("one factor on the tensor", "log_factor", 0, Vec3::Ones()),
          about("about the face normal", "log_factor_normal", 2, Vec3::UnitX()),
          about("about the horizontal", "log_factor_horizontal", 2, Vec3::UnitY()),
          about("about the vertical", "log_factor_vertical", 2, Vec3::UnitZ())};
}

}  // namespace hosel::loop::forms
