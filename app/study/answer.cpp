#include "app/study/answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/read_blow.hpp"
#include "app/read_face.hpp"
#include "app/read_options.hpp"
#include "app/read_plate.hpp"
#include "app/solution_doubts.hpp"
#include "golf/first_contact.hpp"
#include "golf/quantities.hpp"
#include "models/checked_launch.hpp"
#include "models/fe/impact.hpp"
#include "models/fe/plate_strike.hpp"
#include "models/matched_launch.hpp"
#include "models/oblique.hpp"
#include "models/reduced/face_strike.hpp"
#include "models/registry.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/stick_slip.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

using MaybeNumber = std::optional<double>;

/// The ball's momentum along the normal of first contact, and the rest of it [N s].
std::pair<double, double> impulse(const StudyAnswer& a) {
  const Vec3 n = first_contact(a.blow).normal, J = a.blow.ball.mass * a.launch.velocity;
  return {J.dot(n), (J - J.dot(n) * n).norm()};
}

double head_turn(const StudyAnswer& a) { return (a.launch.head_spin - a.blow.delivery.head_angular_velocity).norm(); }

/// Along the slip at first contact, zero before and after the contact; nothing where no forces were kept.
MaybeNumber extreme_force(const StudyAnswer& a, double sign) {
  if (a.history.empty()) return {};
  double out = 0;
  for (const ForceSample& s : a.history) out = std::max(out, sign * s.tangential);
  return sign * out;
}

/// Of a blow by a wall; `oblique`: one that has a direction along the wall.
MaybeNumber off_wall(const StudyAnswer& a, bool oblique, double (*value)(const models::WallBounce&)) {
  if (!std::isinf(a.blow.club.head.mass)) return {};
  const models::WallBounce bounce = models::off_wall(a.blow, a.launch);
  return oblique && !(bounce.along > 0) ? MaybeNumber() : MaybeNumber(value(bounce));
}

models::PlateStrike plate_strike(const StudyAnswer& a) {
  return {a.face_plate->on(a.blow.club.head.face), a.blow.club.head};
}

/// A normal blow of ball, face and head in series, at the club's speed and the place of the impact.
struct SeriesStrike {
  double mass, restitution, speed_ratio;  ///< of the head at that place [kg]; of the ball's speed over the head's
  double contact_time;                    ///< [s]
  MaybeNumber face_energy;                ///< left in a lumped face [J]
};
SeriesStrike in_series(const StudyAnswer& a, bool yields) {
  const double yc = -a.blow.delivery.impact_toe, zc = a.blow.delivery.impact_high;
  const double mass = models::mass_at(a.blow.club.head, yc, zc), ball = a.blow.ball.mass;
  const auto face = yields ? a.face : std::nullopt;
  const models::Striker striker = models::golf_ball(a.blow.ball);
  const double speed = a.blow.delivery.club_speed;
  const auto told = [&](const auto& strike, MaybeNumber energy) {
    const double e = strike.restitution;
    return SeriesStrike{mass, e, (1 + e) * mass / (mass + ball), strike.contact_time, energy};
  };
  if (yields && a.face_plate) {
    const models::PlateStrike plate = plate_strike(a);
    return told(plate.strike(striker, plate.at({yc, zc}, models::kBallPatch), speed), {});
  }
  const models::FaceStrike s = models::strike(striker, mass, face, face ? face->shape(yc, zc).value : 0, speed);
  return told(s, s.energy);
}

/// The rules' pendulum at the place of the impact: a sphere of 11 mm at models::pendulum_speeds().
models::CharacteristicTime pendulum(const StudyAnswer& a) {
  const double yc = -a.blow.delivery.impact_toe, zc = a.blow.delivery.impact_high;
  const models::Striker sphere = models::steel_sphere(0.011);
  if (a.face_plate) return plate_strike(a).characteristic_time(sphere, {yc, zc}, models::pendulum_speeds());
  return models::characteristic_time(sphere, models::mass_at(a.blow.club.head, yc, zc), a.face,
                                     a.face ? a.face->shape(yc, zc).value : 0, models::pendulum_speeds());
}

double off_rules_line(const StudyAnswer& a) {
  return in_series(a, true).restitution - models::rules_line(pendulum(a).time);
}

/// Static, of a plate at the place of the impact [m/N]; nothing without a plate.
MaybeNumber give(const StudyAnswer& a, bool under_pendulum) {
  if (!a.face_plate) return {};
  const auto plate = a.face_plate->on(a.blow.club.head.face);
  const Eigen::Vector2d at(-a.blow.delivery.impact_toe, a.blow.delivery.impact_high);
  return plate->compliance(at, under_pendulum ? models::pendulum_patch(*plate, at) : models::kBallPatch);
}

MaybeNumber spin_over_rolling(const StudyAnswer& a) {
  Blow rolling = a.blow;
  rolling.contact = {};
  const double spin = models::StickSlip().launch(rolling).spin_rate();
  return spin > 0 ? MaybeNumber(a.launch.spin_rate() / spin) : MaybeNumber();
}

/// Impulse of the shaft on the head, face axes: of force 0 to 2 [N s], of moment 3 to 5 [N m s].
template <int Part>
MaybeNumber hosel_impulse(const StudyAnswer& a) {
  if (a.hosel.times.empty()) return {};
  const fem::Wrench all = a.hosel.impulse();
  return Part < 3 ? all.force[Part % 3] : all.moment[Part % 3];
}

/// Of the swing that delivered the club.
template <class Value>
MaybeNumber of_swing(const StudyAnswer& a, const Value& value) {
  return a.end ? MaybeNumber(value(*a.end)) : MaybeNumber();
}

MaybeNumber kept(const StudyAnswer& a, double KeptBounce::*value) {
  return a.bounce ? MaybeNumber((*a.bounce).*value) : MaybeNumber();
}

/// Beyond the launch's and the flight's own.
struct BlowQuantity {
  std::string_view name;               ///< whole, where the table of units knows none for it
  std::optional<Dimension> dimension;  ///< of the unit behind the name
  MaybeNumber (*value)(const StudyAnswer&);
  bool cause = false, followed = false;
  bool of_face = false;  ///< what the club's face and head make of a strike of their own, whichever model answers
};
using Given = const StudyAnswer&;
const std::array kBlowQuantities = {
    BlowQuantity{"contact_time", Dimension::time, [](Given a) { return a.launch.contact_time; }, true},
    BlowQuantity{"peak_force", Dimension::force, [](Given a) { return a.launch.peak_force; }, true},
    BlowQuantity{"normal_impulse_N_s", {}, [](Given a) { return MaybeNumber(impulse(a).first); }, true},
    BlowQuantity{"tangential_impulse_N_s", {}, [](Given a) { return MaybeNumber(impulse(a).second); }, true},
    BlowQuantity{"head_rotation", Dimension::angular_velocity, [](Given a) { return MaybeNumber(head_turn(a)); }, true},
    BlowQuantity{
        "tangential_restitution", {}, [](Given a) { return models::tangential_restitution(a.blow, a.launch); }},
    BlowQuantity{"launch_ratio", {}, [](Given a) { return models::launch_ratio(a.blow, a.launch); }},
    BlowQuantity{"tangential_ratio",
                 {},
                 [](Given a) { return off_wall(a, true, [](auto& b) { return b.along_after / b.along; }); }},
    BlowQuantity{
        "normal_restitution", {}, [](Given a) { return off_wall(a, false, [](auto& b) { return b.restitution(); }); }},
    BlowQuantity{"rebound_angle", Dimension::angle,
                 [](Given a) { return off_wall(a, true, [](auto& b) { return b.rebound_angle(); }); }},
    BlowQuantity{
        "smash_factor", {}, [](Given a) { return MaybeNumber(a.launch.ball_speed() / a.blow.delivery.club_speed); }},
    BlowQuantity{"spin_over_rolling", {}, spin_over_rolling},
    BlowQuantity{"striking_mass_kg", {}, [](Given a) { return MaybeNumber(in_series(a, false).mass); }},
    BlowQuantity{"face_restitution",
                 {},
                 [](Given a) { return MaybeNumber(in_series(a, true).restitution); },
                 false,
                 false,
                 true},
    BlowQuantity{"rigid_restitution", {}, [](Given a) { return MaybeNumber(in_series(a, false).restitution); }},
    BlowQuantity{"face_speed_ratio",
                 {},
                 [](Given a) { return MaybeNumber(in_series(a, true).speed_ratio); },
                 false,
                 false,
                 true},
    BlowQuantity{"rigid_speed_ratio", {}, [](Given a) { return MaybeNumber(in_series(a, false).speed_ratio); }},
    BlowQuantity{"face_contact_time", Dimension::time,
                 [](Given a) { return MaybeNumber(in_series(a, true).contact_time); }, false, false, true},
    BlowQuantity{"face_energy", Dimension::energy, [](Given a) { return in_series(a, true).face_energy; }, false, false,
                 true},
    BlowQuantity{"characteristic_time", Dimension::time, [](Given a) { return MaybeNumber(pendulum(a).time); }, false,
                 false, true},
    // By how much the sphere's contact at 1 m/s is longer, and the largest distance of a time from the straight line.
    BlowQuantity{"pendulum_slope", Dimension::time, [](Given a) { return MaybeNumber(pendulum(a).slope); }, false,
                 false, true},
    BlowQuantity{"pendulum_departure", Dimension::time, [](Given a) { return MaybeNumber(pendulum(a).departure); },
                 false, false, true},
    BlowQuantity{
        "restitution_off_rules_line", {}, [](Given a) { return MaybeNumber(off_rules_line(a)); }, false, false, true},
    BlowQuantity{"give_to_ball_m_per_N", {}, [](Given a) { return give(a, false); }, false, false, true},
    BlowQuantity{"give_to_pendulum_m_per_N", {}, [](Given a) { return give(a, true); }, false, false, true},
    BlowQuantity{"peak_stress", Dimension::pressure, [](Given a) { return a.face_stress; }, false, true},
    BlowQuantity{"largest_tangential_force", Dimension::force, [](Given a) { return extreme_force(a, 1); }},
    BlowQuantity{"least_tangential_force", Dimension::force, [](Given a) { return extreme_force(a, -1); }},
    BlowQuantity{"head_speed", Dimension::speed, [](Given a) { return MaybeNumber(a.launch.head_velocity.norm()); }},
    BlowQuantity{"head_spin", Dimension::angular_velocity,
                 [](Given a) { return MaybeNumber(a.launch.head_spin.norm()); }},
    BlowQuantity{"riflespin", Dimension::angular_velocity, [](Given a) { return MaybeNumber(a.launch.riflespin()); }},
    BlowQuantity{"hosel_impulse_x_N_s", {}, hosel_impulse<0>, false, true},
    BlowQuantity{"hosel_impulse_y_N_s", {}, hosel_impulse<1>, false, true},
    BlowQuantity{"hosel_impulse_z_N_s", {}, hosel_impulse<2>, false, true},
    BlowQuantity{"hosel_moment_impulse_x_N_m_s", {}, hosel_impulse<3>, false, true},
    BlowQuantity{"hosel_moment_impulse_y_N_m_s", {}, hosel_impulse<4>, false, true},
    BlowQuantity{"hosel_moment_impulse_z_N_m_s", {}, hosel_impulse<5>, false, true},
    BlowQuantity{"club_speed", Dimension::speed, [](Given a) { return MaybeNumber(a.blow.delivery.club_speed); }},
    BlowQuantity{"attack_angle", Dimension::angle, [](Given a) { return MaybeNumber(a.blow.delivery.attack_angle); }},
    BlowQuantity{"club_path", Dimension::angle, [](Given a) { return MaybeNumber(a.blow.delivery.club_path); }},
    BlowQuantity{"face_angle", Dimension::angle, [](Given a) { return MaybeNumber(a.blow.delivery.face_angle); }},
    BlowQuantity{"dynamic_lie", Dimension::angle, [](Given a) { return of_swing(a, [](auto& e) { return e.lie; }); }},
    BlowQuantity{"lead", Dimension::length, [](Given a) { return of_swing(a, [](auto& e) { return e.lead; }); }},
    BlowQuantity{"droop", Dimension::length, [](Given a) { return of_swing(a, [](auto& e) { return e.droop; }); }},
    BlowQuantity{"hands_force", Dimension::force,
                 [](Given a) { return of_swing(a, [](auto& e) { return e.shaft.grip.force.norm(); }); }},
    BlowQuantity{"hands_moment", Dimension::moment,
                 [](Given a) { return of_swing(a, [](auto& e) { return e.shaft.grip.moment.norm(); }); }},
    BlowQuantity{"head_acceleration", Dimension::acceleration,
                 [](Given a) { return of_swing(a, [](auto& e) { return e.shaft.head_acceleration.norm(); }); }},
    BlowQuantity{"dynamic_loft", Dimension::angle, [](Given a) { return MaybeNumber(a.blow.delivery.dynamic_loft); }},
    BlowQuantity{"wall_restitution", {}, [](Given a) { return kept(a, &KeptBounce::restitution); }},
    BlowQuantity{"wall_contact_time", Dimension::time, [](Given a) { return kept(a, &KeptBounce::contact_time); }},
    BlowQuantity{"elastic_factor", {}, [](Given a) { return kept(a, &KeptBounce::elastic); }},
    BlowQuantity{"viscous_factor", {}, [](Given a) { return kept(a, &KeptBounce::viscous); }},
};

/// Moduli and branches are scaled until restitution and contact time on a wall are the reference's again: a change of
/// the ball is else judged by its bounce.
KeptBounce keep_bounce(models::FeImpactOptions& fe, const Ball& ball, double speed,
                       const models::NormalImpactPoint& own, const models::NormalImpactPoint& reference) {
  KeptBounce out{own.restitution, own.contact_time};
  constexpr double restitution_sd = 5e-4, time_sd = 2e-3;  // of the time relative
  const auto near = [&](const models::NormalImpactPoint& p, double times) {
    return std::abs(p.restitution - reference.restitution) < times * restitution_sd &&
           std::abs(p.contact_time / reference.contact_time - 1) < times * time_sd;
  };
  if (near(own, 1)) return out;
  models::FeImpactOptions axial = fe;
  axial.harmonics = 0;
  axial.face.reset();
  const models::NormalImpactTarget target{.speeds = {speed},
                                          .restitution = reference.restitution,
                                          .restitution_slope = 0,
                                          .restitution_sigma = restitution_sd,
                                          .contact_speed = speed,
                                          .contact_time = reference.contact_time,
                                          .contact_time_sigma = time_sd * reference.contact_time};
  using What = models::FreeParameter::What;
  const models::BallCalibration fit = models::calibrate_ball(
      {.options = axial, .ball = ball, .wall = target, .free = {{What::long_term}, {What::branches}}});
  fe.ball = fit.ball;
  const models::NormalImpactPoint& then = fit.points.front();
  if (!near(then, 3))
    throw solvers::NonConvergence(fmt::format(
        "keep_bounce: restitution {:.4f} and contact {:.4f} ms are wanted at {:g} m/s; {:.4f} and {:.4f} ms "
        "are as near as the ball's moduli come",
        reference.restitution, 1e3 * reference.contact_time, speed, then.restitution, 1e3 * then.contact_time));
  return {then.restitution, then.contact_time, fit.values[0] / fit.start[0], fit.values[1] / fit.start[1]};
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

/// A finite-element model that keeps what its last blow was solved to.
class Remembering final : public models::ImpactModel {
 public:
  explicit Remembering(const models::Impact& fe) : fe_(fe) {}
  Launch launch(const Blow& blow) const override {
    last_ = fe_.run(blow);
    return last_->launch;
  }
  const models::Impact* impact() const override { return &fe_; }
  const models::FeOutcome& last() const { return *last_; }

 private:
  const models::Impact& fe_;
  mutable std::optional<models::FeOutcome> last_;
};

void doubt_solution(StudyAnswer& a, const std::string& model, const models::FeOutcome& outcome) {
  for (const SolutionDoubt& d : solution_doubts(a.blow, outcome))
    a.doubts.push_back({fmt::format("{}: {} is above {:g}", model, d.what, d.limit), d.value, d.sentence()});
}

}  // namespace

bool asks_for_the_face(const std::string& output) {
  return std::ranges::any_of(kBlowQuantities, [&](const BlowQuantity& q) {
    return q.of_face && (output == q.name || split_unit(output).stem == q.name);
  });
}

StudyBlow read_study_blow(Table root, bool of_face) {
  if (!root.has("models") && root.has("launch")) {
    StudyBlow stated{.models = {""}};
    stated.blow.ball = read_optional_ball(root);
    stated.launch = read_launch(root.table("launch"), true);
    stated.flight = read_optional_flight(root);
    return stated;
  }
  StudyBlow out{.models = read_models(root)};
  out.blow = read_blow(root, out.models);
  out.sets = sets_by_loft(root);
  out.options = read_options(root, out.models, out.blow);
  out.swung = read_swung_club(root, out.models, out.options.shaft_mount);
  if (auto t = root.optional_table("launch")) out.launch = read_launch(*t, false);
  out.flight = read_optional_flight(root);
  if (of_face && !out.blow.club.head.compliance && !out.options.plate) {
    out.face = read_club_face(root);
    const auto plate = read_optional_plate(root);
    if (plate && root.has("motion"))
      root.table("face").fail("plate",
                              "a plate does not turn with the head of a swing: give a lumped face (`hosel list`)");
    if (plate) out.face_plate = std::make_shared<const models::PlateOnDemand>(*plate);
  }
  if (auto t = root.optional_table("plate")) {
    out.plate = {
        t->quantity({"young", "Young's modulus of a thick elastic plate; absent: rigid"}, "GPa", Range::positive()),
        t->number({"poisson", "Poisson's ratio of the plate"}, {0, 0.49})};
    if (const double mass = out.blow.club.head.mass; !std::isinf(mass))
      root.table("head").fail("mass", fmt::format("{:g} kg beside [plate], which is a wall (allowed: inf)", mass));
    try {
      models::ElasticPlate(out.options.fe, *out.plate, out.blow.ball);
    } catch (const std::invalid_argument& e) {
      const bool of_ball = std::string_view(e.what()).find("sphere") != std::string_view::npos;
      if (of_ball) root.default_table("ball").fail("layers", e.what());
      t->fail("young", e.what());
    }
  }
  return out;
}

StudyOutput find_study_output(const Table& table, std::string_view key, const std::string& name, bool flies,
                              bool struck) {
  const SplitName split = split_unit(name);
  std::vector<std::string> known;
  const auto unit_of = [&](std::string_view stem, Dimension dimension) -> std::optional<Unit> {
    for (const Unit& u : all_units())
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
    return {name, unit->si, [of = q.of](const StudyAnswer& a) -> MaybeNumber { return (a.launch.*of)(); }};
  }
  for (const post::FlightChannel& c : post::flight_channels(post::DistanceUnit::metres)) {
    const auto all = all_units();
    const auto unit = unit_of(c.name, std::ranges::find(all, c.unit, &Unit::suffix)->dimension);
    if (!unit) continue;
    if (!flies) table.fail(key, fmt::format("'{}' is of the flight, and there is no [flight]", name));
    return {name, unit->si,
            [value = c.value](const StudyAnswer& a) { return a.flight ? value(*a.flight) : MaybeNumber(); }};
  }
  for (const BlowQuantity& q : kBlowQuantities) {
    if (!struck) break;
    if (q.dimension) {
      if (const auto unit = unit_of(q.name, *q.dimension)) return {name, unit->si, q.value, q.cause, q.followed};
    } else {
      known.emplace_back(q.name);
      if (name == q.name) return {name, 1, q.value, q.cause, q.followed};
    }
  }
  table.fail(
      key, fmt::format("nothing of a blow is called '{}'{}", name,
                       or_nearest(name, known,
                                  fmt::format("; known, with any unit of the dimension: {}", fmt::join(known, ", ")))));
}

models::NormalImpactPoint wall_bounce(const StudyBlow& blow, double speed) {
  models::FeImpactOptions axial = blow.options.fe;
  axial.harmonics = 0;
  axial.face.reset();  // of the club: the wall is rigid
  return models::normal_impact(axial, blow.blow.ball, speed);
}

StudyAnswer answer(const std::string& model, const StudyBlow& asked, const StudyConditions& conditions,
                   const std::optional<double>& launch_angle, const models::NormalImpactPoint* reference) {
  const std::optional<FaceCompliance>& face = asked.blow.club.head.compliance;  // turned with a swung club
  StudyAnswer out{.blow = asked.blow,
                  .face = face ? face : asked.face,
                  .face_plate = asked.options.plate ? asked.options.plate : asked.face_plate};
  out.end = asked.end;
  models::Options options = asked.options;
  if (conditions.bounce_speed) {
    const models::NormalImpactPoint own = wall_bounce(asked, *conditions.bounce_speed);
    out.bounce = reference ? keep_bounce(options.fe, asked.blow.ball, *conditions.bounce_speed, own, *reference)
                           : KeptBounce{own.restitution, own.contact_time};
  }
  const std::unique_ptr<models::ImpactModel> made =
      model.empty() ? nullptr
      : asked.plate && model.starts_with("fe-")
          ? std::make_unique<models::ElasticPlate>(options.fe, *asked.plate, asked.blow.ball)
          : models::find(model)->make(options);
  if (!made) {  // the stated launch is all there is
  } else if (conditions.matched_launch) {
    constexpr double tolerance = radians(0.03);
    const models::Impact* fe = made->impact();
    const std::optional<Remembering> remembering = fe ? std::optional<Remembering>(*fe) : std::nullopt;
    const models::ImpactModel& asks = remembering ? static_cast<const models::ImpactModel&>(*remembering) : *made;
    auto found = models::match_launch_angle(asks, out.blow, launch_angle.value(), tolerance);
    out.blow = std::move(found.blow);
    out.launch = found.launch;
    if (remembering) doubt_solution(out, model, remembering->last());
  } else if (const auto* wall = dynamic_cast<const models::ElasticPlate*>(made.get())) {
    const models::FeOutcome outcome = wall->run(out.blow);
    out.launch = outcome.launch;
    models::check_launch(*made, out.blow, out.launch);
    doubt_solution(out, model, outcome);
  } else if (const models::Impact* fe = made->impact()) {
    models::FaceStress stress;
    std::function<void(const models::ImpactView&)> watch;
    if (conditions.histories || conditions.followed)
      watch = [&](const models::ImpactView& v) {
        if (v.shaft) out.hosel.add(*v.shaft, v.state);
        if (conditions.followed) stress.see(v);
      };
    const models::FeOutcome outcome = fe->run(out.blow, watch);
    out.launch = outcome.launch;
    if (stress.peak()) out.face_stress = stress.peak()->stress;
    models::check_launch(*made, out.blow, out.launch);
    doubt_solution(out, model, outcome);
  } else if (conditions.histories && (model == "hertz-maw" || model == "volumetric")) {
    out.launch = launch_with_history(model, options, out.blow, out.history);
    models::check_launch(*made, out.blow, out.launch);
  } else {
    out.launch = models::checked_launch(*made, out.blow);
  }
  if (asked.launch) out.launch = asked.launch->in_place_of(out.launch);
  if (asked.flight) try {
      out.flight = asked.flight->follow(out.launch, asked.blow.ball);
      if (const std::string sentence = outside_law(*asked.flight, *out.flight); !sentence.empty())
        out.doubts.push_back({fmt::format("a flight outside the range of {}", asked.flight->conditions.law.name),
                              out.flight->flight.outside, sentence});
      if (const std::string& sentence = out.flight->no_run; !sentence.empty())
        out.doubts.push_back({"a flight without a total", 1, sentence});
    } catch (const std::invalid_argument& e) {  // the launch is an answer all the same
      out.doubts.push_back({"a launch without a landing", 1, e.what()});
    }
  return out;
}

}  // namespace hosel::app
