#include "models/fe/changeable_fe.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "golf/shaft_library.hpp"
#include "golf/units.hpp"
#include "models/fe/impact.hpp"
#include "models/reduced/face_strike.hpp"
#include "models/sliding_friction.hpp"

namespace hosel::models {
namespace {

void scale(fem::Solid& m, double factor) {
  m.elastic = m.elastic.stiffened(factor);
  for (fem::MaxwellBranch& b : m.branches) b.modulus *= factor;
}

void relax(fem::Solid& m, double factor, double frequency) {
  double stored = 0;
  for (fem::MaxwellBranch& b : m.branches) {
    const double x = frequency * b.time, y = x * factor;
    const double loss = b.modulus * x / (1 + x * x);
    const double modulus = loss * (1 + y * y) / y;
    stored += loss * (y - x);  // modulus x^2 / (1 + x^2) is loss x
    b = {modulus, b.time * factor};
  }
  const double left = 1 - stored / m.shear();
  if (!(left > 0)) throw std::invalid_argument("relaxation: so slow a branch leaves no stiffness of the long term");
  m.elastic = m.elastic.stiffened(left);
}

}  // namespace

FeBall changed(FeBall ball, const FeChange& c, double radius, double contact_time) {
  if (ball.layers.size() == 1) {  // whatever changes: a mesh that comes with the first change would be a change itself
    ball.layers.push_back(ball.layers.front());
    ball.layers.front().radius = 1 - kSkin / radius;
  }
  if (c.cover_stiffness != 0 || c.cover_thickness != 0) {
    BallLayer& core = *(ball.layers.end() - 2);
    core.radius -= c.cover_thickness / radius;
    if (!(core.radius < 1)) throw std::invalid_argument("cover: no thickness left");
    scale(ball.layers.back().material, std::exp(c.cover_stiffness));
  }
  for (BallLayer& layer : ball.layers) {
    if (c.losses != 0)
      for (fem::MaxwellBranch& b : layer.material.branches) b.modulus *= std::exp(c.losses);
    if (c.relaxation != 0) relax(layer.material, std::exp(c.relaxation), kPi / contact_time);
  }
  return ball;
}

Shaft changed(Shaft shaft, double share, double stiffness) {
  if (!(share > 0)) throw std::invalid_argument("shaft: its share must be positive");
  const double bend = share * std::exp(stiffness);
  shaft = scaled(std::move(shaft), bend, bend);
  for (ShaftStation& s : shaft.stations)
    for (double* x : {&s.mass_per_length, &s.rotary_inertia_y, &s.rotary_inertia_z}) *x *= share;
  return shaft;
}

std::optional<FaceCompliance> changed(std::optional<FaceCompliance> face, double compliance, const Head& head) {
  if (compliance == 0) return face;
  if (face) compliance += 1 / face->stiffness;
  else face = usual_face(head);
  if (!(compliance > 0)) throw std::invalid_argument("face: no compliance left");
  face->stiffness = 1 / compliance;
  return face;
}

ChangeableFe::ChangeableFe(FeImpactOptions impact, ShaftMount mount, std::optional<Shaft> shaft, bool full_club)
    : impact_(std::move(impact)), mount_(std::move(mount)), shaft_(std::move(shaft)), full_club_(full_club) {
  if (const auto faults = impact_.faults(); !faults.empty())
    throw std::invalid_argument("fe impact: " + faults.front());
}

Launch ChangeableFe::launch(const Blow& blow, const FeChange& change) const {
  FeImpactOptions impact = impact_;
  impact.ball = changed(impact.ball, change, blow.ball.radius);
  Blow struck = blow;
  struck.club.head.compliance = changed(blow.club.head.compliance, change.face_compliance, blow.club.head);
  if (std::isfinite(blow.contact.friction)) slide(struck.contact.patch, blow.contact.friction);
  if (share(change) == 0) return Impact(impact).launch(struck);
  if (!shaft_) throw std::invalid_argument("the club has no shaft");
  struck.club.shaft = changed(*shaft_, share(change), change.shaft_stiffness);
  return Impact(impact, mount_).launch(struck);
}

}  // namespace hosel::models
