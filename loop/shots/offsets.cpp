#include "loop/shots/offsets.hpp"

#include <algorithm>

namespace hosel::loop {
namespace {

constexpr double kOffsetPrice = 8;  // as of an offset alone: loop/shots/columns

/// Usual: assumed, places within 5 mm and directions within 1.5 deg of a good record. The loft's offset is an effect.
std::optional<Parametrisation> offset_of(Input input) {
  Parameter p{"offset", "", 1, 0, 0, 0};
  switch (input) {
    case Input::impact_toe:
    case Input::impact_high: p = Parameter{"offset", "mm", 1e-3, -0.02, 0.02, 1e-3}.within(5e-3); break;
    case Input::face_angle:
    case Input::club_path:
    case Input::attack_angle:
      p = Parameter{"offset", "deg", kRadPerDeg, radians(-8), radians(8), radians(0.5)}.within(radians(1.5));
      break;
    default: return {};
  }
  Parametrisation form{
      .effect = "offset", .what = std::string(stem(input)), .parameters = {p}, .complexity = kOffsetPrice};
  form.before = [input](Sizes q, Shot& t) { set(t.blow, input, get(t.blow, input) + q[0]); };
  return form;
}

}  // namespace

std::optional<InputOffset> likelier_offset(const Problem& problem, const Study& study,
                                           const std::vector<Input>& recorded) {
  const Selection& s = study.selection;
  if (s.level == 0) return {};
  const std::size_t declared = study.base.size();
  const auto price = [&](const Fit& f) {
    return criterion(f, study.rules) + study.rules.further_gain * double(f.model.forms.size() - declared);
  };
  const Fit& chosen = s.chosen;
  std::vector<Fit> cores;
  for (std::size_t out = declared; out < chosen.model.forms.size(); ++out)
    cores.push_back(part_of(chosen, [&](const Parametrisation& form) { return &form != chosen.model.forms[out]; }));
  std::size_t singles = 0;
  for (const Candidate& c : s.candidates)
    if (c.effects.size() == 1 && singles++ < kLikeliest) cores.push_back(c.fit);

  double least = price(chosen) - study.rules.tie;
  std::optional<InputOffset> found;
  for (const Input input : recorded) {
    const auto form = offset_of(input);
    if (!form) continue;
    for (const Fit& core : cores) {
      const Fit start = beside(core, &*form);
      const Fit f = fit(problem, Part::select, start.model, {start.p}, 1, true);
      if (f.at_bound || !(price(f) < least)) continue;
      least = price(f);
      found = {input, f.p[f.p.size() - 1], core.model.effects(declared)};
    }
  }
  return found;
}

}  // namespace hosel::loop
