// A thin face yields: the ball loses less on it, most at the face centre.
#include "loop/effects/all.hpp"
#include "models/reduced/face_strike.hpp"

namespace hosel::loop::forms {

std::vector<Parametrisation> face_compliance(const Setting& s) {
  // Up to faces a third softer than the rules' limit (186 nm/N), with the fall-off of a face of that kind.
  Parametrisation f{.what = "compliance at the face centre, falling to the edge like a clamped plate's",
                    .parameters = {{"compliance", "nm/N", 1e-9, 0, 250e-9, 20e-9}}};
  if (s.deformable) {  // its face is a surface that moves: irons' as well
    f.before = [](Sizes p, Shot& t) { t.change.face_compliance += p[0]; };
    return {f};
  }
  f.before = [face = s.face](Sizes p, Shot& t) {
    const double shape = face.shape(-t.blow.delivery.impact_toe, t.blow.delivery.impact_high).value;
    const double left = models::loss_on_face(p[0] * shape * shape);
    ContactLaw& law = t.blow.contact;
    law.restitution += (1 - left) * (1 - law.restitution);
    law.restitution_slope *= left;
    law.restitution_falloff *= left;
  };
  return {f};
}

}  // namespace hosel::loop::forms
