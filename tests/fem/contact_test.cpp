#include "fem/contact.hpp"

#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "fem/contact_method/augmented_lagrangian.hpp"
#include "fem/contact_method/methods.hpp"
#include "fem/face_surface.hpp"
#include "fem/friction/coulomb.hpp"
#include "fem/friction/laws.hpp"
#include "fem/friction/regularised.hpp"
#include "fem/friction/slip_weakening.hpp"
#include "fem/materials/hyperelastic.hpp"
#include "fem/yielding_face.hpp"
#include "golf/units.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::fem {
namespace {

constexpr double kRadius = 0.021335;

/// A ball pressed some way into a curved face that moves across it, with a frictional patch that partly
/// sticks and partly slides. Multipliers, where the method has them, are those of a step solved again.
struct Scene {
  System system;
  HarmonicSolid* ball = nullptr;
  DofMap::Block x, r;
  std::unique_ptr<Contact> contact;
  State s;
  Face face{.bulge = 0.3, .roll = 0.25};
  Vec3 centre;

  Scene(bool symmetric, std::unique_ptr<const FrictionLaw> friction,
        const std::optional<FaceCompliance>& compliance = std::nullopt, const std::string& method = "penalty") {
    const FourierBasis basis = symmetric ? cartesian_basis(2) : cartesian_basis(2, 1);
    const Solid solid{.elastic = Hyperelastic::neo_hooke(Lame::of(60e6, 0.45)), .branches = {}, .density = 1129};
    const Mat3 R = symmetric ? Mat3(Mat3::Identity())
                             : Eigen::Quaterniond(0.5, 0.1, 0.7, -0.3).normalized().toRotationMatrix();
    // The face's normal is the body's x; the ball's contact pole points against it.
    Mat3 axes;
    axes.col(0) = -R.col(0);
    axes.col(1) = R.col(2);
    axes.col(2) = axes.col(0).cross(axes.col(1));
    ball = new HarmonicSolid(
        system.dof_map, mesh::sphere_meridian({kRadius}, {.sector = 2, .rings = 2, .pole = .5, .skin = .5, .core = .4}),
        basis, {symmetric ? half_circle(6) : full_circle(10), 2}, {solid}, {Vec3::Zero(), axes});
    system.terms.emplace_back(ball);
    x = system.dof_map.add_vector(3);
    r = system.dof_map.add_rotation();
    centre = Vec3(0.01, symmetric ? 0 : 0.004, 0.02);
    std::unique_ptr<const ContactSurface> surface = std::make_unique<FaceSurface>(face);
    std::optional<DofMap::Block> travel;
    if (compliance) {
      travel = system.dof_map.add_vector(1);
      surface = std::make_unique<YieldingFace>(face, *compliance, *travel);
    }
    contact = std::make_unique<Contact>(*ball, std::move(surface), SurfaceCarrier{x, r, centre},
                                        ContactLaws{contact_method(method)->make(1e11, 1e-7), std::move(friction)},
                                        symmetric ? half_circle(8) : full_circle(14),
                                        symmetric ? Symmetry::plane : Symmetry::none, 3);
    s = system.dof_map.rest();
    set_rotation(s, r, Eigen::Quaterniond(R));
    const Vec3 spot = face.point(symmetric ? 0 : 0.01, symmetric ? 0 : -0.015);
    s.q.segment<3>(x.q) = R * (Vec3(-kRadius, 0, 0) - centre - spot);
    contact->start(s);
    // Small steps into the face and along it.
    for (int i = 1; i <= 4; ++i) {
      s.q.segment<3>(x.q) += R * Vec3(2e-4, symmetric ? 0 : 3e-6, -4e-6 * i);
      s.time += 1e-5;
      if (travel) s.q[travel->q] += 4e-5;
      contact->begin_step();
      const bool again = contact->augment(s);
      EXPECT_EQ(again, method != "penalty");
      if (i < 4) contact->commit(s);
    }
    s.v = test::random_vector(system.dof_map.size(), 8, 3);
    if (symmetric) s.v.segment<3>(x.v).y() = 0, s.v.segment<3>(r.v) = Vec3(0, 1, 0);
  }
};

using MakeLaw = std::unique_ptr<const FrictionLaw> (*)();
constexpr std::array<MakeLaw, 5> kLaws = {
    [] { return std::unique_ptr<const FrictionLaw>(); },
    [] { return std::unique_ptr<const FrictionLaw>(std::make_unique<Coulomb>(0.01, 5e10)); },
    [] {
      return std::unique_ptr<const FrictionLaw>(
          std::make_unique<SlipWeakening>(0.005, StaticFriction{0.02, 2e-6}, 5e10));
    },
    [] {  // over more than a step slides
      return std::unique_ptr<const FrictionLaw>(
          std::make_unique<SlipWeakening>(0.001, StaticFriction{0.004, 2e-5}, 5e10));
    },
    [] { return std::unique_ptr<const FrictionLaw>(std::make_unique<RegularisedFriction>(0.3, 1)); }};
/// Small, so that the patch lies where it bends.
const FaceCompliance kYielding{.mass = 0.01, .stiffness = 1e7, .half_width = 0.03, .half_height = 0.025};

TEST(Contact, Tangent) {
  for (const NamedContactMethod& method : contact_methods())
    for (const bool yields : {false, true})
      for (const MakeLaw law : kLaws) {
        Scene scene(false, law(), yields ? std::optional(kYielding) : std::nullopt, method.name);
        const ContactReport report = scene.contact->report(scene.s);
        ASSERT_GT(report.points, 20);
        ASSERT_GT(report.normal_force, 10);
        // The curvature of the gap function is taken to first order: relative size gap / face radius. The penalty is
        // most of it: what friction adds is looked at for itself, at one point, below.
        test::check_tangent(*scene.contact, scene.system.dof_map, scene.s, 1e-9, 2e-3, 1e-5);
      }
}

/// Static friction until the point has slid; a third of what it has beyond sliding friction is left after the distance.
TEST(Contact, FrictionFallsWithThePathThatAPointHasSlid) {
  const SlipWeakening law(0.1, {0.4, 2e-6}, 1e12);
  const auto coefficient = [](double path) { return 0.1 + 0.3 * std::exp(-path / 2e-6); };
  // Of a step that slides so far beyond the limit at its start.
  const auto over = [&](double path, double beyond) {
    const Vec3 stretch(0, coefficient(path) * 1e6 / 1e12 + beyond, 0);
    return law.at({.pressure = 1e6, .stretch = stretch, .path = path}, false);
  };
  EXPECT_NEAR(over(0, 0).traction.norm(), 0.4e6, 1e-6);
  EXPECT_NEAR(over(2e-6, 0).traction.norm(), (0.1 + 0.3 / std::exp(1.0)) * 1e6, 1e-6);
  EXPECT_NEAR(over(1e-3, 0).traction.norm(), 0.1e6, 1);
  EXPECT_FALSE(over(0, -1e-9).sliding);
  // The mean over what it slides: two steps have the impulse of one of both, by Simpson's rule the integral's.
  for (const double beyond : {1e-11, 1e-7, 3e-6, 1e-3}) {
    ASSERT_TRUE(over(0, beyond).sliding);
    const double whole = over(0, beyond).traction.norm() * beyond,
                 parts = over(0, beyond / 3).traction.norm() * beyond / 3 +
                         over(beyond / 3, 2 * beyond / 3).traction.norm() * 2 * beyond / 3;
    EXPECT_NEAR(parts, whole, 1e-9 * whole);
    if (beyond > 1e-5) continue;
    const double integral = 1e6 * beyond / 6 * (coefficient(0) + 4 * coefficient(beyond / 2) + coefficient(beyond));
    EXPECT_NEAR(whole, integral, 2e-3 * integral);  // the rule's (3 / 2)^4 / 2880 of 0.3
  }
  EXPECT_NEAR(over(0, 1e-3).traction.norm(), 0.1e6 * (1 + 3 * 2e-3), 1);
  // A point that touches first: its pressure grows from zero along the slip.
  for (const double beyond : {1e-8, 1e-6, 1e-5, 1e-3}) {
    const Vec3 stretch(0, 0.4e-6 + beyond, 0);
    const Friction first = law.at({.pressure = 1e6, .stretch = stretch, .step = stretch}, false);
    double sum = 0;  // of coefficient times pressure over the slip, which is half of the pressure times the slip
    constexpr int kParts = 20000;
    for (int i = 0; i < kParts; ++i) sum += coefficient((i + 0.5) / kParts * beyond) * (i + 0.5) / kParts / kParts;
    EXPECT_NEAR(first.traction.norm(), 2e6 * sum, 1e-4 * first.traction.norm()) << beyond;
  }
  EXPECT_FALSE(SlipWeakening(0.1, {0.05, 2e-6}, 1e12).faults().empty());
  EXPECT_FALSE(SlipWeakening(0.1, {0.4, 0}, 1e12).faults().empty());
}

/// A patch is given the law that its friction states: the same traction as that law's own object.
TEST(Contact, FrictionLawIsTheStatedOne) {
  constexpr double kSpring = 1e12;
  const Slip slip{.pressure = 1e6,
                  .stretch = Vec3(0, 3e-6, 0),
                  .step = Vec3(0, 3e-6, 0),
                  .velocity = Vec3(0, 0.2, 0),
                  .tangent = Vec3(0, 1, 1).asDiagonal(),
                  .path = 1e-6};
  const auto traction = [&](const PatchFriction& stated) {
    return friction_law(stated, kSpring)->at(slip, false).traction;
  };
  const Vec3 coulomb = Coulomb(0.3, kSpring).at(slip, false).traction,
             creeping = RegularisedFriction(0.3, 1.5).at(slip, false).traction,
             weakening = SlipWeakening(0.3, {0.5, 2e-6}, kSpring).at(slip, false).traction;
  ASSERT_GT((coulomb - creeping).norm(), 1e4);  // else the law that is chosen cannot be seen
  ASSERT_GT((coulomb - weakening).norm(), 1e4);
  EXPECT_EQ(traction({.coefficient = 0.3}), coulomb);
  EXPECT_EQ(traction({.coefficient = 0.3, .transition_speed = 1.5}), creeping);
  EXPECT_EQ(traction({.coefficient = 0.3, .at_rest = StaticFriction{0.5, 2e-6}}), weakening);
  EXPECT_EQ(friction_law({.coefficient = 0}, kSpring), nullptr);
  // Held at rest, and free once it slides.
  EXPECT_NE(friction_law({.coefficient = 0, .at_rest = StaticFriction{0.5, 2e-6}}, kSpring), nullptr);
}

/// One point under Coulomb's and the regularised law: the traction by hand, and its derivatives by differences, where
/// it sticks and where it slides.
TEST(Contact, FrictionAtAPointHasItsDerivatives) {
  constexpr double kPressure = 1e6, kCoefficient = 0.3, kSpring = 1e12, kSpeed = 2;
  const Vec3 normal = Vec3(1, 2, -2) / 3, along = Vec3(2, 1, 2) / 3, across = normal.cross(along);
  const Coulomb coulomb(kCoefficient, kSpring);
  const RegularisedFriction regularised(kCoefficient, kSpeed);
  struct Case {
    const FrictionLaw* law;
    double stretch, speed, traction;
    bool sliding;
  };
  // Of Coulomb's law the limit is a stretch of 0.3 um.
  for (const Case& c :
       {Case{&coulomb, 1e-7, 0, 1e5, false}, Case{&coulomb, 2.9e-7, 0, 2.9e5, false},
        Case{&coulomb, 3.1e-7, 0, 3e5, true}, Case{&coulomb, 5e-6, 0, 3e5, true},
        Case{&regularised, 0, 0.02, 3e5 * std::tanh(0.04), true}, Case{&regularised, 0, 1, 3e5 * std::tanh(2.0), true},
        Case{&regularised, 0, 20, 3e5 * std::tanh(40.0), true}}) {
    SCOPED_TRACE(testing::Message() << (c.law == &coulomb ? "Coulomb" : "regularised") << ", stretch " << c.stretch
                                    << " m, speed " << c.speed << " m/s");
    const Slip at{.pressure = kPressure,
                  .stretch = c.stretch * along,
                  .step = c.stretch * along,
                  .velocity = c.speed * along,
                  .tangent = Mat3::Identity() - normal * normal.transpose()};
    const Friction f = c.law->at(at, true);
    EXPECT_LT((f.traction - c.traction * along).norm(), 1e-9 * c.traction);
    if (c.law == &coulomb) { EXPECT_EQ(f.sliding, c.sliding); }
    const auto slope = [&](double pressure, double stretch, double speed, const Vec3& d) -> Vec3 {
      const auto moved = [&](double sign) {
        Slip to = at;
        to.pressure += sign * pressure;
        to.stretch += sign * stretch * d;
        to.velocity += sign * speed * d;
        return c.law->at(to, false).traction;
      };
      return (moved(1) - moved(-1)) / 2;
    };
    // Central differences over 1e-4 of the size: 1e-8 of a derivative of the traction's own size.
    const double h = 1e-4;
    EXPECT_LT((slope(h * kPressure, 0, 0, along) / h - kPressure * f.by_pressure).norm(), 1e-6 * c.traction);
    for (const Vec3& d : {along, across}) {
      if (c.stretch > 0) {
        EXPECT_LT((slope(0, h * c.stretch, 0, d) / h - c.stretch * f.by_stretch * d).norm(), 1e-6 * c.traction);
      }
      if (c.speed > 0) {
        EXPECT_LT((slope(0, 0, h * c.speed, d) / h - c.speed * f.by_velocity * d).norm(), 1e-6 * c.traction);
      }
    }
  }
}

/// Derivatives of the mean over a step, where it slides a little and where it slides far.
TEST(Contact, FrictionThatFallsWithinAStepHasItsDerivatives) {
  const SlipWeakening law(0.1, {0.4, 2e-6}, 1e12);
  const Vec3 along = Vec3(0, 0.6, 0.8);
  for (const bool fresh : {false, true})
    for (const double beyond : {1e-10, 1e-8, 1e-7, 2e-6, 1e-4}) {
      Slip at{.pressure = 1e6, .path = 1e-6};
      at.stretch = ((0.1 + 0.3 * std::exp(-0.5)) * 1e-6 + beyond) * along;
      if (fresh) at.step = at.stretch;
      const Friction f = law.at(at, true);
      ASSERT_TRUE(f.sliding);
      const double size = at.stretch.norm(), h = std::min(1e-4 * size, beyond / 2);
      const auto change = [&](const Vec3& stretch, double pressure) -> Vec3 {
        const auto moved = [&](double sign) {
          Slip to = at;
          to.stretch += sign * stretch;
          if (fresh) to.step = to.stretch;
          to.pressure += sign * pressure;
          return law.at(to, false).traction;
        };
        return (moved(1) - moved(-1)) / 2;
      };
      for (const Vec3& d : {along, Vec3(0, -0.8, 0.6)}) {
        const Vec3 slope = change(h * d, 0) / h;
        EXPECT_LT((slope - f.by_stretch * d).norm(), 1e-4 * slope.norm()) << beyond;
      }
      const double step = h / size * at.pressure;
      const Vec3 slope = change(Vec3::Zero(), step) / step;
      EXPECT_LT((slope - f.by_pressure).norm(), 1e-4 * slope.norm()) << beyond;
    }
}

/// What is reported of an accepted state is what its step was solved with, though the points have slid further since.
TEST(Contact, AnAcceptedStateIsReportedAsItWasSolved) {
  for (const NamedContactMethod& method : contact_methods()) {
    Scene scene(false, std::make_unique<SlipWeakening>(0.001, StaticFriction{0.004, 2e-5}, 5e10), std::nullopt,
                method.name);
    Vector inertia = Vector::Zero(scene.system.dof_map.size()), force = inertia;
    scene.contact->residual(scene.s, inertia, force);
    const auto slid = [&] {
      double sum = 0;
      for (const ContactPoint& p : scene.contact->points(scene.s)) sum += p.slip;
      return sum;
    };
    const double before = slid();
    scene.contact->commit(scene.s);
    ASSERT_GT(slid(), before + 1e-6);
    const Vec3 solved = force.segment<3>(scene.x.v);
    EXPECT_LT((scene.contact->report(scene.s).force - solved).norm(), 1e-9 * solved.norm());
    Vec3 sum = Vec3::Zero();
    for (const ContactPoint& p : scene.contact->points(scene.s)) sum += p.area * p.traction;
    EXPECT_LT((sum - solved).norm(), 1e-9 * solved.norm());
  }
}

/// A ball that meets a wall along its normal and hardly slides: friction that is regularised by velocity takes the work
/// of the sliding alone, not of the approach.
TEST(Contact, RegularisedFrictionWorksAlongTheSlipAlone) {
  constexpr double kTime = 1e-5, kAcross = 0.01;
  System system;
  const Solid solid{.elastic = Hyperelastic::neo_hooke(Lame::of(60e6, 0.45)), .branches = {}, .density = 1129};
  Mat3 axes;
  axes << -1, 0, 0, 0, 1, 0, 0, 0, -1;
  HarmonicSolid ball(system.dof_map,
                     mesh::sphere_meridian({kRadius}, {.sector = 2, .rings = 2, .pole = .5, .skin = .5, .core = .4}),
                     cartesian_basis(2, 1), {full_circle(10), 2}, {solid}, {Vec3::Zero(), axes});
  SurfaceCarrier wall;
  wall.position = Vec3(-kRadius - 1e-6, 0, 0);
  Contact contact(ball, std::make_unique<FaceSurface>(Face{}), wall,
                  {contact_method("penalty")->make(1e11, 1e-7), std::make_unique<RegularisedFriction>(0.3, 1e-3)},
                  full_circle(14), Symmetry::none, 3);
  State s = system.dof_map.rest();
  contact.start(s);
  ball.set_velocity(s, Vec3(-20, kAcross, 0), Vec3::Zero());
  s.q = system.dof_map.advanced(s.q, kTime * s.v);
  s.time = kTime;
  contact.commit(s);
  double most = 0;
  for (const ContactPoint& p : contact.points(s)) most += p.area * (p.traction - p.push).norm() * kAcross * kTime;
  ASSERT_GT(contact.report(s).points, 20);
  ASSERT_GT(most, 0);
  EXPECT_GT(contact.energies(s).friction, 0);
  EXPECT_LE(contact.energies(s).friction, most);
}

/// Pressure is the gradient of the method's energy, by the surface's own unknown as by all others.
TEST(Contact, ForceIsTheGradientOfTheEnergy) {
  for (const NamedContactMethod& method : contact_methods())
    for (const bool yields : {false, true}) {
      Scene scene(false, nullptr, yields ? std::optional(kYielding) : std::nullopt, method.name);
      ASSERT_GT(scene.contact->energies(scene.s).contact, 1e-4);
      test::check_gradient(*scene.contact, scene.system.dof_map, scene.s, 1e-9, 2e-3);
    }
}

/// A spring K pressed by d against the surface: gap g and pressure p = K (d + g). With the multiplier l the solution is
/// g = (l - K d) / (K + k), and each augmentation leaves K / (K + k) of the gap.
TEST(Contact, MultiplierTakesThePressureOver) {
  constexpr double k = 1e10, K = 4e9, d = 1e-4, allowed = 1e-9;
  const AugmentedLagrangian method(k, allowed);
  double l = 0, gap = -K * d / (K + k);
  int again = 0;
  EXPECT_DOUBLE_EQ(method.at(gap, l).pressure(), K * (d + gap));
  while (method.repeats(gap, l)) {
    l = method.next(gap, l);
    const double before = gap;
    gap = (l - K * d) / (K + k);
    EXPECT_NEAR(gap, K / (K + k) * before, 1e-12 * d);
    EXPECT_NEAR(method.at(gap, l).pressure(), K * (d + gap), 1e-9 * K * d);
    ++again;
  }
  EXPECT_EQ(again, 9);  // of 29 um, (2 / 7)^9 leaves 0.4 nm
  EXPECT_LT(std::abs(gap), allowed);
  EXPECT_EQ(method.next(2 * l / k, l), 0);  // a point that the multiplier no longer reaches
  EXPECT_FALSE(AugmentedLagrangian(k, 0).faults().empty());
  EXPECT_FALSE(AugmentedLagrangian(0, allowed).faults().empty());
  EXPECT_TRUE(method.faults().empty());
}

/// A point stores the trapezoidal work of its pressure from where it met the surface.
TEST(Contact, AMultipliersWorkIsStored) {
  constexpr double k = 1e10;
  const AugmentedLagrangian method(k, 1e-9);
  NormalState was{.gap = 1e-5};
  double work = 0, pressure = 0, gap = 0;
  for (const auto& [g, l] : {std::pair{-1e-6, 0.0}, {-2e-6, 1e4}, {-1e-6, 5e4}, {1e-6, 4e4}}) {
    NormalState now{.gap = g, .multiplier = l};
    now.offset = method.offset(was, now);
    const NormalSpring spring = method.at(g, l);
    ASSERT_GT(spring.depth, 0);
    work -= 0.5 * (pressure + spring.pressure()) * (g - gap);
    EXPECT_NEAR(0.5 * spring.stiffness * spring.depth * spring.depth + now.offset, work, 1e-12 * k * 1e-12);
    pressure = spring.pressure(), gap = g, was = now;
  }
  EXPECT_NE(work, 0);
}

/// What lies beyond the reach of a surface does not touch it, whether it gives or stands out; what does touch comes
/// near.
TEST(Contact, NothingTouchesBeyondTheReach) {
  const YieldingFace face({.bulge = 0.3, .roll = 0.25}, {.mass = 0.01, .stiffness = 1e7, .half_width = 0.05},
                          {0, 0, 1});
  for (const double travel : {-1e-3, 1e-3}) {
    const SurfaceUnknowns unknowns = SurfaceUnknowns::Constant(1, travel);
    double highest = -INFINITY;
    for (unsigned i = 0; i < 1000; ++i) {
      Vec3 place = test::random_vector(3, i, 1);
      place = Vec3(2e-3 * place.x(), 0.02 * place.y(), 0.02 * place.z());
      Vec3 seen = place;
      seen.x() += face.travel(place, unknowns);
      if (face.gap(seen) < 0) highest = std::max(highest, place.x());
    }
    EXPECT_LE(highest, face.reach(unknowns));
    EXPECT_GT(highest, face.reach(unknowns) - (travel > 0 ? 1.1e-3 : 2e-4));
  }
}

/// What pushes the ball pushes the head back along the same line: no net force, no net moment.
TEST(Contact, ForcesBalance) {
  int sliding = 0, sticking = 0;
  for (bool symmetric : {false, true}) {
    Scene scene(symmetric, std::make_unique<Coulomb>(0.01, 5e10));
    Vector inertia = Vector::Zero(scene.system.dof_map.size()), force = inertia;
    scene.contact->residual(scene.s, inertia, force);
    const auto& dof_map = scene.system.dof_map;
    // A rigid motion of everything does no work: translation, and rotation about the origin.
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      if (symmetric && axis.y() != 0) continue;
      State rigid = dof_map.rest();
      scene.ball->set_velocity(rigid, axis, Vec3::Zero());
      rigid.v.segment<3>(scene.x.v) = axis;
      const double push = force.segment<3>(scene.x.v).norm();
      ASSERT_GT(push, 10);
      EXPECT_LT(std::abs(force.dot(rigid.v)), 1e-10 * push);
    }
    // The ball has not been deformed, so rotating it about its centre is exact too.
    const Vec3 axis = symmetric ? Vec3(0, 1, 0) : Vec3(0.3, -0.5, 0.8);
    State rigid = dof_map.rest();
    scene.ball->set_velocity(rigid, Vec3::Zero(), axis);
    rigid.v.segment<3>(scene.x.v) = axis.cross(Vec3(scene.s.q.segment<3>(scene.x.q)));
    rigid.v.segment<3>(scene.r.v) = rotation(scene.s, scene.r).conjugate() * axis;
    EXPECT_LT(std::abs(force.dot(rigid.v)), 1e-10 * force.segment<3>(scene.x.v).norm() * kRadius);
    // The friction cone is exact at every point.
    scene.contact->commit(scene.s);
    for (const auto& p : scene.contact->points(scene.s)) {
      if (p.pressure == 0) continue;
      // Friction is what the traction has beside the pressure, which acts along the gradient of the gap
      // h / |g|, h = x - height and g its gradient: g / |g| - h C g / |g|^3, C the curvature.
      const Mat3 R = rotation(scene.s, scene.r).toRotationMatrix();
      const Vec3 y = R.transpose() * (p.position - Vec3(scene.s.q.segment<3>(scene.x.q))) - scene.centre;
      const Vec3 curvature(0, 1 / scene.face.bulge, 1 / scene.face.roll);
      const Vec3 g(1, y.y() * curvature.y(), y.z() * curvature.z());
      const double h = y.x() - scene.face.height(y.y(), y.z());
      const Vec3 slope = g / g.norm() - h / std::pow(g.norm(), 3) * curvature.cwiseProduct(g);
      EXPECT_LE((p.traction - p.pressure * (R * slope)).norm(), 0.01 * p.pressure * (1 + 1e-8));
      ++(p.sliding ? sliding : sticking);
    }
  }
  EXPECT_GT(sliding, 0);
  EXPECT_GT(sticking, 0);
}

}  // namespace
}  // namespace hosel::fem
