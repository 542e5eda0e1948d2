#include "app/study/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "golf/first_contact.hpp"
#include "golf/quantities.hpp"
#include "models/checked_launch.hpp"
#include "models/matched_launch.hpp"
#include "models/oblique.hpp"
#include "models/registry.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/stick_slip.hpp"

namespace hosel::app {
namespace {

using MaybeNumber = std::optional<double>;

Vec3 momentum(const StudyAnswer& a) { return a.blow.ball.mass * a.launch.velocity; }

/// Along the slip at first contact, zero before and after the contact; nothing where no forces were kept.
MaybeNumber extreme_force(const StudyAnswer& a, double sign) {
  if (a.history.empty()) return {};
  double out = 0;
  for (const ForceSample& s : a.history) out = std::max(out, sign * s.tangential);
  return sign * out;
}

/// Beyond the launch's and the flight's own.
struct BlowQuantity {
  std::string_view name;  ///< without its unit
  std::string_view unit;  ///< that it has where the table of units knows none for it
  std::optional<Dimension> dimension;
  MaybeNumber (*value)(const StudyAnswer&);
  bool cause = false;
};
constexpr std::array kBlowQuantities = {
    BlowQuantity{"contact_time", {}, Dimension::time, [](const StudyAnswer& a) { return a.launch.contact_time; }, true},
    BlowQuantity{"peak_force", {}, Dimension::force, [](const StudyAnswer& a) { return a.launch.peak_force; }, true},
    BlowQuantity{"normal_impulse",
                 "N_s",
                 {},
                 [](const StudyAnswer& a) -> MaybeNumber { return momentum(a).dot(first_contact(a.blow).normal); },
                 true},
    BlowQuantity{"tangential_impulse",
                 "N_s",
                 {},
                 [](const StudyAnswer& a) -> MaybeNumber {
                   const Vec3 n = first_contact(a.blow).normal, J = momentum(a);
                   return (J - J.dot(n) * n).norm();
                 },
                 true},
    BlowQuantity{"head_rotation",
                 {},
                 Dimension::angular_velocity,
                 [](const StudyAnswer& a) -> MaybeNumber {
                   return (a.launch.head_spin - a.blow.delivery.head_angular_velocity).norm();
                 },
                 true},
    BlowQuantity{"tangential_restitution",
                 {},
                 {},
                 [](const StudyAnswer& a) { return models::tangential_restitution(a.blow, a.launch); }},
    BlowQuantity{"launch_ratio", {}, {}, [](const StudyAnswer& a) { return models::launch_ratio(a.blow, a.launch); }},
    BlowQuantity{
        "smash_factor",
        {},
        {},
        [](const StudyAnswer& a) -> MaybeNumber { return a.launch.ball_speed() / a.blow.delivery.club_speed; }},
    BlowQuantity{"spin_over_rolling",
                 {},
                 {},
                 [](const StudyAnswer& a) -> MaybeNumber {
                   Blow rolling = a.blow;
                   rolling.contact = {};
                   const double spin = models::StickSlip().launch(rolling).spin_rate();
                   return spin > 0 ? MaybeNumber(a.launch.spin_rate() / spin) : MaybeNumber();
                 }},
    BlowQuantity{
        "largest_tangential_force", {}, Dimension::force, [](const StudyAnswer& a) { return extreme_force(a, 1); }},
    BlowQuantity{"least_tangential_force",
                 {},
                 Dimension::force,  // below zero where it reverses
                 [](const StudyAnswer& a) { return extreme_force(a, -1); }},
    BlowQuantity{"dynamic_loft",
                 {},
                 Dimension::angle,
                 [](const StudyAnswer& a) -> MaybeNumber { return a.blow.delivery.dynamic_loft; }},
    BlowQuantity{
        "wall_restitution",
        {},
        {},
        [](const StudyAnswer& a) { return a.bounce ? MaybeNumber(a.bounce->point.restitution) : MaybeNumber(); }},
    BlowQuantity{
        "wall_contact_time",
        {},
        Dimension::time,
        [](const StudyAnswer& a) { return a.bounce ? MaybeNumber(a.bounce->point.contact_time) : MaybeNumber(); }},
    BlowQuantity{"elastic_factor",
                 {},
                 {},
                 [](const StudyAnswer& a) { return a.bounce ? MaybeNumber(a.bounce->elastic) : MaybeNumber(); }},
    BlowQuantity{"viscous_factor",
                 {},
                 {},
                 [](const StudyAnswer& a) { return a.bounce ? MaybeNumber(a.bounce->viscous) : MaybeNumber(); }},
};

/// Moduli and branches are scaled until restitution and contact time on a wall are the reference's again: a change of
/// the ball is else judged by its bounce.
KeptBounce keep_bounce(models::FeImpactOptions& fe, const Ball& ball, double speed,
                       const models::NormalImpactPoint& own, const models::NormalImpactPoint& reference) {
  KeptBounce out{.point = own};
  if (std::abs(own.restitution - reference.restitution) < 5e-4 &&
      std::abs(own.contact_time / reference.contact_time - 1) < 2e-3)
    return out;
  models::FeImpactOptions axial = fe;
  axial.harmonics = 0;
  axial.face.reset();
  const models::NormalImpactTarget target{.speeds = {speed},
                                          .restitution = reference.restitution,
                                          .restitution_slope = 0,
                                          .restitution_sigma = 5e-4,
                                          .contact_speed = speed,
                                          .contact_time = reference.contact_time,
                                          .contact_time_sigma = 2e-3 * reference.contact_time};
  using What = models::FreeParameter::What;
  const models::BallCalibration fit = models::calibrate_ball(
      {.options = axial, .ball = ball, .wall = target, .free = {{What::long_term}, {What::branches}}});
  fe.ball = fit.ball;
  return {fit.points.front(), fit.values[0] / fit.start[0], fit.values[1] / fit.start[1]};
}

/// The launch of a model that tells its forces as it goes.
Launch launch_with_history(const std::string& model, const models::Options& options, const Blow& blow,
                           std::vector<ForceSample>& history) {
  const Vec3 along = models::impulse_problem(blow).contact.slip().normalized();
  const auto add = [&](const auto& s) { history.push_back({s.time, s.normal_force, s.tangential_force.dot(along)}); };
  if (model == "hertz-maw")
    return models::hertz_maw_impact(blow, options.hertz_maw, options.hertz_maw_solution, add).launch;
  models::VolumetricOptions fine = options.volumetric_solution;
  fine.tolerance = std::min(fine.tolerance, 1e-6);  // the steps are those of the integration
  return models::volumetric_impact(blow, options.volumetric, fine, nullptr, add).launch;
}

}  // namespace

StudyBlow read_study_blow(Table root) {
  StudyBlow out{.models = read_models(root)};
  out.blow = read_blow(root, out.models);
  out.options = read_options(root, out.models);
  out.flight = read_optional_flight(root);
  return out;
}

StudyOutput find_study_output(const Table& table, std::string_view key, const std::string& name, bool flies) {
  const SplitName split = split_unit(name);
  std::vector<std::string> known;
  const auto unit_of = [&](std::string_view stem, Dimension dimension) -> std::optional<Unit> {
    for (const Unit& u : units())
      if (u.dimension == dimension) {
        known.push_back(fmt::format("{}_{}", stem, u.suffix));
        break;
      }
    if (split.stem != stem || !split.unit || split.unit->dimension != dimension) return {};
    return split.unit;
  };
  for (int o = 0; o < kOutputs; ++o) {
    const OutputQuantity& q = quantity(hosel::Output(o));
    const auto unit = of_flight(hosel::Output(o)) ? std::nullopt : unit_of(q.name, q.dimension);
    if (!unit) continue;
    return {name, split.stem, std::string(unit->suffix), unit->si,
            [of = q.of](const StudyAnswer& a) -> MaybeNumber { return (a.launch.*of)(); }};
  }
  for (const post::FlightChannel& c : post::flight_channels(post::DistanceUnit::metres)) {
    const auto all = units();
    const auto unit = unit_of(c.name, std::ranges::find(all, c.unit, &Unit::suffix)->dimension);
    if (!unit) continue;
    if (!flies) table.fail(key, fmt::format("'{}' is of the flight, and there is no [flight]", name));
    return {name, split.stem, std::string(unit->suffix), unit->si,
            [value = c.value](const StudyAnswer& a) { return a.flight ? value(*a.flight) : MaybeNumber(); }};
  }
  for (const BlowQuantity& q : kBlowQuantities) {
    const std::string whole = q.unit.empty() ? std::string(q.name) : fmt::format("{}_{}", q.name, q.unit);
    if (q.dimension) {
      if (const auto unit = unit_of(q.name, *q.dimension))
        return {name, split.stem, std::string(unit->suffix), unit->si, q.value, q.cause};
    } else {
      known.push_back(whole);
      if (name == whole) return {name, std::string(q.name), std::string(q.unit), 1, q.value, q.cause};
    }
  }
  const std::string near = nearest(name, known);
  std::string all;
  for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
  table.fail(key, fmt::format(
                      "nothing of a blow is called '{}'; {}", name,
                      near.empty() ? "known, with any unit of the dimension: " + all : "did you mean '" + near + "'?"));
}

models::NormalImpactPoint wall_bounce(const StudyBlow& blow, double speed) {
  models::FeImpactOptions axial = blow.options.fe;
  axial.harmonics = 0;
  axial.face.reset();  // of the club: the wall is rigid
  return models::normal_impact(axial, blow.blow.ball, speed);
}

StudyAnswer answer(const std::string& model, const StudyBlow& asked, const StudyConditions& conditions,
                   const std::optional<double>& launch_angle, const models::NormalImpactPoint* reference) {
  StudyAnswer out{.blow = asked.blow};
  models::Options options = asked.options;
  if (conditions.bounce_speed) {
    const models::NormalImpactPoint own = wall_bounce(asked, *conditions.bounce_speed);
    out.bounce = reference ? keep_bounce(options.fe, asked.blow.ball, *conditions.bounce_speed, own, *reference)
                           : KeptBounce{.point = own};
  }
  const auto made = models::find(model)->make(options);
  if (conditions.matched_launch) {
    constexpr double tolerance = radians(0.03);
    auto found = models::match_launch_angle(*made, out.blow, launch_angle.value(), tolerance);
    out.blow = std::move(found.blow);
    out.launch = found.launch;
  } else if (conditions.histories) {
    out.launch = launch_with_history(model, options, out.blow, out.history);
    models::check_launch(*made, out.blow, out.launch);
  } else {
    out.launch = models::checked_launch(*made, out.blow);
  }
  if (asked.flight) try {
      out.flight = asked.flight->follow(out.launch, asked.blow.ball);
    } catch (const std::invalid_argument&) {
    }  // the ball does not reach the landing: the launch is an answer all the same
  return out;
}

}  // namespace hosel::app
