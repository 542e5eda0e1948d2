#include "models/fe/elastic_plate.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/materials/linear_elastic.hpp"
#include "golf/first_contact.hpp"
#include "models/oblique.hpp"
#include "models/sliding_friction.hpp"

namespace hosel::models {
namespace {

double shear(const ElasticSolid& s) { return s.young / (2 * (1 + s.poisson)); }

/// A uniform sphere with a heavier core inside `radius`, so that I = i m r^2.
FeBall with_inertia(FeBall ball, double inertia_factor) {
  constexpr double radius = 0.6;  // deep below any patch
  const double volume = std::pow(radius, 3), moment = std::pow(radius, 5);
  const double excess = (0.4 - inertia_factor) / (inertia_factor * volume - 0.4 * moment);
  if (!(excess > -1)) throw std::invalid_argument("elastic plate: no core makes the stand-in's moment of inertia");
  BallLayer core = ball.layers.front();
  core.radius = radius;
  core.material.density = (1 + excess) * ball.layers.front().material.density;
  ball.layers.insert(ball.layers.begin(), core);
  return ball;
}

}  // namespace

ContactPair ContactPair::of(const ElasticSolid& a, const ElasticSolid& b) {
  const auto of_both = [&](auto what) { return what(a) / shear(a) + what(b) / shear(b); };
  const double normal = of_both([](const ElasticSolid& s) { return 1 - s.poisson; });
  const double across = of_both([](const ElasticSolid& s) { return 2 - s.poisson; });
  const double coupling = (1 - 2 * a.poisson) / shear(a) - (1 - 2 * b.poisson) / shear(b);
  return {2 / normal, 2 * normal / across, std::abs(coupling) / (2 * normal)};
}

RigidPlateStandIn RigidPlateStandIn::of(const ContactPair& pair, double inertia_factor) {
  RigidPlateStandIn out;
  const double nu = (1 - 2 * pair.dundurs) / (2 - 2 * pair.dundurs);
  out.sphere = {pair.modulus * (1 - nu * nu), nu};
  const double kappa = 2 * (1 - nu) / (2 - nu);
  out.friction = kappa / pair.tangential;
  out.inertia_factor = 1 / ((1 + 1 / inertia_factor) / out.friction - 1);
  return out;
}

ElasticPlate::ElasticPlate(FeImpactOptions sphere, const ElasticSolid& plate, const Ball& thrown)
    : stand_in_(std::move(sphere)) {
  FeBall& ball = stand_in_.ball;
  if (ball.layers.size() != 1 || !ball.layers.front().material.branches.empty())
    throw std::invalid_argument("elastic plate: the sphere is one elastic layer");
  fem::Solid& material = ball.layers.front().material;
  const double G = material.shear(), K = material.bulk();
  const ElasticSolid own{9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G))};
  const ContactPair pair = ContactPair::of(own, plate);
  if (!(pair.dundurs > 0.005)) throw std::invalid_argument("elastic plate: like bodies have no compressible stand-in");
  const RigidPlateStandIn instead = RigidPlateStandIn::of(pair, thrown.inertia_factor);
  material.elastic = fem::LinearElastic{fem::Lame::of(instead.sphere.young, instead.sphere.poisson)};
  ball = with_inertia(ball, instead.inertia_factor);
  friction_ = instead.friction;
  if (const auto faults = stand_in_.faults(); !faults.empty())
    throw std::invalid_argument("elastic plate: " + faults.front());
}

FeOutcome ElasticPlate::run(const Blow& blow) const {
  if (std::isfinite(blow.club.head.mass)) throw std::invalid_argument("elastic plate: it is a wall, not a head");
  Blow instead = blow;
  slide(instead.contact.patch, friction_ * blow.contact.patch.coefficient);
  FeOutcome outcome = Impact(stand_in_).run(instead);
  Launch& out = outcome.launch;
  const std::optional<double> e_t = tangential_restitution(blow, out);
  if (!e_t) return outcome;
  const FirstContact contact = first_contact(blow);
  const Vec3 &normal = contact.normal, slip = contact.slip();
  const double i = blow.ball.inertia_factor;
  const Vec3 push = (1 + *e_t) * i / (1 + i) * slip;
  out.velocity = out.velocity.dot(normal) * normal + push;
  out.spin = -normal.cross(push) / (i * blow.ball.radius);
  return outcome;
}

}  // namespace hosel::models
