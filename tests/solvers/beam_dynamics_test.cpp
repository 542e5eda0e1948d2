// [@moving-beams], [@waves] and [@integrators]: flexible beams in motion.
#include <gtest/gtest.h>

#include <ostream>

#include <Eigen/LU>

#include "fem/rigid_body.hpp"
#include "solvers/generalized_alpha.hpp"
#include "solvers/modes.hpp"
#include "solvers/statics.hpp"
#include "tests/support/beams.hpp"
#include "tests/support/term_checks.hpp"

namespace hosel::test {
namespace {

using solvers::GeneralizedAlpha;

solvers::GeneralizedAlphaOptions fixed(double rho, double h) {
  return {.rho_inf = rho,
          .newton = {.residual_relative = 1e-8,
                     .residual_absolute = 1e-8,
                     .increment_vector = 1e-7,
                     .increment_rotation = 1e-7},
          .step_max = h,
          .step_min = h / 64};
}

void run_to(GeneralizedAlpha& scheme, double t) {
  while (scheme.time() < t * (1 - 1e-12)) scheme.advance(t);
}

fem::SectionLaw constant(const fem::Section& s) {
  return [s](double) { return s; };
}

Vec3 at(const fem::State& s, const fem::Node& n) { return s.q.segment<3>(n.translation.q); }

/// Momenta of a beam whose inertia is consistent in translation and lumped in rotation: M v, with M from
/// the mass tangent.
struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};
Momentum momentum(const BeamSystem& b, const fem::State& s) {
  DenseSink mass(b.system.dof_map.size());
  b.beam->tangent(s, {0, 0, 1}, mass);
  const fem::Vector p = mass.matrix * s.v;
  Momentum out;
  for (const fem::Node& n : b.beam->nodes()) {
    out.linear += p.segment<3>(n.translation.v);
    out.angular += at(s, n).cross(Vec3(p.segment<3>(n.translation.v))) +
                   fem::rotation(s, n.rotation) * Vec3(p.segment<3>(n.rotation.v));
  }
  return out;
}

TEST(SpinUp, TipInTheRotatingFrame) {
  BeamSystem b(mesh::straight(mesh::graded(10, 10), Vec3::Zero(), Mat3::Identity()),
               constant(uniform(2.8e7, 1e7, 1.4e4, 1.4e4, 1.2, Vec3::Constant(6e-4))));
  const auto psi = [](double t) {
    const double k = 2 * kPi / 15;
    if (t >= 15) return Vec3(6 * t - 45, 6, 0);
    return Vec3(0.4 * (t * t / 2 + (std::cos(k * t) - 1) / (k * k)), 0.4 * (t - std::sin(k * t) / k),
                0.4 * (1 - std::cos(k * t)));
  };
  b.system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(b.beam->nodes().front(), [&](double t) {
    const Vec3 p = psi(t);
    return fem::Pose{.rotation = fem::rotation_exp(Vec3(0, 0, p[0])),
                     .angular_velocity = {0, 0, p[1]},
                     .angular_acceleration = {0, 0, p[2]}};
  }));
  GeneralizedAlpha scheme(b.system, fixed(0.8, 0.01), b.rest);
  double lowest = 0, when = 0, steady = 0;
  int samples = 0;
  const std::array<std::array<double, 2>, 8> table{{{3, -0.21727},
                                                    {5, -0.46848},
                                                    {6.5, -0.56995},
                                                    {8, -0.54284},
                                                    {10, -0.36282},
                                                    {12, -0.15090},
                                                    {15, 0.00131},
                                                    {18, -0.00207}}};
  std::size_t row = 0;
  for (int i = 1; i <= 2000; ++i) {
    run_to(scheme, 0.01 * i);
    const double t = scheme.time();
    const Vec3 u = fem::rotation_exp(Vec3(0, 0, -psi(t)[0])) * at(scheme.state(), b.tip()) - Vec3(10, 0, 0);
    if (u.y() < lowest) lowest = u.y(), when = t;
    if (row < table.size() && std::abs(t - table[row][0]) < 1e-6) {
      // Ten quadratic elements and dt = 0.01: 1e-3 of the length is what the benchmark asks; a tenth of it holds.
      EXPECT_NEAR(u.y(), table[row][1], 1e-3) << "t " << t;
      ++row;
    }
    if (t > 16) steady += u.x(), ++samples;
  }
  EXPECT_EQ(row, table.size());
  EXPECT_NEAR(lowest, -0.57384, 1e-3);
  EXPECT_NEAR(when, 6.762, 0.02);
  EXPECT_NEAR(steady / samples, 5.14317455e-4, 1e-6);
}

struct Flying {
  double EI;
  std::array<std::array<double, 5>, 4> rows;  // t, loaded end, free end
  double H, tolerance;
};

TEST(FlyingRod, Planar) {
  for (const Flying& c : {Flying{500,
                                 {{{2.5, 4.430, -0.785, 5.945, 8.971},
                                   {5, 5.620, 4.764, 15.409, 4.264},
                                   {10, 25.409, 4.790, 15.625, 4.152},
                                   {13, 26.220, -0.956, 27.772, 8.718}}},
                                 -189.28,
                                 0.02},
                          Flying{100,
                                 {{{2.5, 4.963, 4.476, 3.583, 6.112},
                                   {5, 9.783, 8.204, 8.075, 1.760},
                                   {10, 22.974, 6.410, 21.325, 3.612},
                                   {13, 26.798, 3.253, 29.220, 6.329}}},
                                 -229.52,
                                 0.06}}) {
    BeamSystem b(mesh::straight(mesh::graded(10, 20), Vec3(6, 0, 0), mesh::frame_along(Vec3(-6, 8, 0), Vec3(0, 0, 1))),
                 constant(uniform(1e4, 1e4, 500, c.EI, 1, Vec3::Constant(10))));
    bool on = true;
    b.load(b.beam->nodes().front(), [&](double) { return on ? fem::Wrench{{8, 0, 0}, {0, 0, -80}} : fem::Wrench{}; });
    const double h = 0.0125;
    GeneralizedAlpha loaded(b.system, fixed(0.9, h), b.rest);
    run_to(loaded, 2.5);
    on = false;
    GeneralizedAlpha free(b.system, fixed(0.9, h), loaded.state());
    EXPECT_NEAR(momentum(b, free.state()).linear.x(), 20, 1e-6);
    const double energy = free.ledger().initial, H = momentum(b, free.state()).angular.z();
    EXPECT_NEAR(H, c.H, 3e-3 * std::abs(c.H));
    for (const auto& r : c.rows) {
      if (r[0] > free.time()) run_to(free, r[0]);
      const Vec3 x1 = at(free.state(), b.beam->nodes().front()), x2 = at(free.state(), b.tip());
      EXPECT_NEAR(x1.x(), r[1], c.tolerance) << c.EI << " t " << r[0];
      EXPECT_NEAR(x1.y(), r[2], c.tolerance) << c.EI << " t " << r[0];
      EXPECT_NEAR(x2.x(), r[3], c.tolerance) << c.EI << " t " << r[0];
      EXPECT_NEAR(x2.y(), r[4], c.tolerance) << c.EI << " t " << r[0];
    }
    const Momentum end = momentum(b, free.state());
    EXPECT_NEAR(end.linear.x(), 20, 1e-6);
    EXPECT_NEAR(end.angular.z(), H, 2e-3 * std::abs(H));
    EXPECT_NEAR(free.ledger().kinetic + free.ledger().strain_total(), energy, 0.02 * energy);
  }
}

BeamSystem flying_3d(int elements) {
  BeamSystem b(
      mesh::straight(mesh::graded(10, elements), Vec3(6, 0, 0), mesh::frame_along(Vec3(-6, 8, 0), Vec3(0, 0, 1))),
      constant(uniform(1e4, 1e4, 500, 500, 1, Vec3::Constant(10))));
  b.load(b.beam->nodes().front(), [](double t) {
    const double T = t < 2.5 ? 80 * t : t < 5 ? 80 * (5 - t) : 0;
    return fem::Wrench{{T / 10, 0, 0}, {0, -T / 2, -T}};
  });
  return b;
}

TEST(FlyingRod, ThreeDimensional) {
  BeamSystem b = flying_3d(20);
  GeneralizedAlpha scheme(b.system, fixed(0.9, 0.005), b.rest);
  struct Row {
    double t;
    Vec3 loaded, free;
  };
  for (const Row& r : {Row{2.5, {3.4129, 0.1969, 0.0174}, {4.0238, 8.4956, -0.7330}},
                       Row{5, {19.5628, 1.5214, -1.5078}, {11.8789, 6.8813, 1.8301}},
                       Row{8, {30.872, -0.978, 0.365}, {29.863, 8.9485, -0.227}},
                       Row{10, {44.402, 1.669, -2.065}, {36.409, 6.335, 1.679}}}) {
    run_to(scheme, r.t);
    // The benchmark's own second-order rod of 20 elements is 0.03 (t = 5) and 0.12 (t = 10) off.
    const double allowed = r.t <= 5 ? 0.03 : 0.12;
    EXPECT_LT((at(scheme.state(), b.beam->nodes().front()) - r.loaded).norm(), allowed) << r.t;
    EXPECT_LT((at(scheme.state(), b.tip()) - r.free).norm(), allowed) << r.t;
    if (r.t >= 5) {
      const Momentum m = momentum(b, scheme.state());
      EXPECT_LT((m.linear - Vec3(50, 0, 0)).norm(), 2e-3);
      EXPECT_LT((m.angular - Vec3(0, -295.703, -553.002)).norm(), 2e-3 * 627);
    }
  }
}

TEST(FlyingRod, MomentaAndEnergyOverTenThousandSteps) {
  // Load for 5 s, then 10,000 steps of free flight. Linear momentum stays to round-off, angular momentum and
  // energy to the scheme's order: halving the step quarters what they lose.
  double angular = 0, energy = 0;
  for (double h : {4e-3, 2e-3}) {
    BeamSystem b = flying_3d(6);
    GeneralizedAlpha scheme(b.system, fixed(0.9, h), b.rest);
    run_to(scheme, 5);
    const Momentum before = momentum(b, scheme.state());
    const double E0 = scheme.ledger().kinetic + scheme.ledger().strain_total();
    EXPECT_NEAR(E0, 884, 20);
    double worst_angular = 0, worst_energy = 0;
    for (int i = 0; i < 10000; ++i) {
      run_to(scheme, 5 + (i + 1) * h);
      if (i % 100) continue;
      worst_angular = std::max(worst_angular, (momentum(b, scheme.state()).angular - before.angular).norm());
      worst_energy = std::max(worst_energy, std::abs(scheme.ledger().kinetic + scheme.ledger().strain_total() - E0));
    }
    const Momentum after = momentum(b, scheme.state());
    EXPECT_LT((after.linear - before.linear).norm(), 1e-8 * before.linear.norm());
    EXPECT_LT(worst_angular, 2e-3 * before.angular.norm());
    EXPECT_LT(worst_energy, 1e-2 * E0);
    if (angular > 0) {
      EXPECT_LT(worst_angular, angular / 3);
      EXPECT_LT(worst_energy, energy / 3);
    }
    angular = worst_angular;
    energy = worst_energy;
  }
}

/// A clamped beam whose stress is C (strain + tau rate), set swinging in one of its modes of bending: it loses energy
/// as exp(-2 zeta omega t), zeta = omega tau / 2, and no other mode joins in. Counted after ten whole periods; a
/// hundred steps a period are late by (2 pi / 100)^2 / 12 of it.
TEST(DampedCantilever, EachModeLosesByHalfItsFrequencyTimesTheDampingTime) {
  const fem::Section section = b2(Theory::timoshenko)(0.5);
  BeamSystem free(mesh::straight(mesh::graded(1, 6), Vec3::Zero(), Mat3::Identity()), constant(section));
  free.clamp_first();
  const solvers::Modes modes = solvers::modes(free.system, free.rest, 6);  // in pairs: the tube is round
  const double tau = 2 * 0.004 / modes.omega[0];
  for (const std::size_t mode : {0U, 2U, 4U}) {
    BeamSystem b(mesh::straight(mesh::graded(1, 6), Vec3::Zero(), Mat3::Identity()), constant(section),
                 {.damping_time = tau});
    b.clamp_first();
    fem::State start = b.rest;
    start.v = 1e-3 * modes.shapes.col(static_cast<fem::Index>(mode));
    const double omega = modes.omega[mode], zeta = omega * tau / 2,
                 period = 2 * kPi / (omega * std::sqrt(1 - zeta * zeta));
    GeneralizedAlpha scheme(b.system, fixed(1, period / 100), start);
    run_to(scheme, 10 * period);
    const solvers::Ledger& l = scheme.ledger();
    const double kept = (l.kinetic + l.strain_total()) / l.initial;
    EXPECT_NEAR(-std::log(kept) / (2 * omega * scheme.time()), zeta, 0.01 * zeta) << mode;
    EXPECT_NEAR(l.viscous, (1 - kept) * l.initial, 0.01 * (1 - kept) * l.initial) << mode;
  }
  ASSERT_GT(modes.omega[4], 15 * modes.omega[0]);  // ratios of damping from 0.4 to 7 %
}

TEST(RightAngleCantilever, PeaksOfElbowAndTip) {
  const fem::Section section = uniform(1e6, 1e6, 1e3, 1e3, 1, Vec3(20, 10, 10));
  BeamSystem b(mesh::straight(mesh::graded(10, 10), Vec3::Zero(), Mat3::Identity()), constant(section));
  b.clamp_first();
  const fem::Node elbow = b.tip();
  auto leg = std::make_unique<fem::Beam>(
      b.system.dof_map,
      mesh::straight(mesh::graded(10, 10), Vec3(10, 0, 0), mesh::frame_along(Vec3(0, 1, 0), Vec3(0, 0, 1))),
      constant(section), fem::BeamOptions{.first = elbow});
  const fem::Node tip = leg->nodes().back();
  b.rest = b.system.dof_map.rest();
  b.beam->place(b.rest);
  leg->place(b.rest);
  b.system.terms.push_back(std::move(leg));
  b.load(elbow, [](double t) { return fem::Wrench{.force = {0, 0, t < 1 ? 50 * t : t < 2 ? 50 * (2 - t) : 0}}; });
  GeneralizedAlpha scheme(b.system, fixed(0.9, 0.02), b.rest);
  double elbow_max = 0, elbow_time = 0, tip_max = 0, tip_time = 0;
  for (int i = 1; i <= 1500; ++i) {
    run_to(scheme, 0.02 * i);
    const double t = scheme.time(), ze = at(scheme.state(), elbow).z(), zt = at(scheme.state(), tip).z();
    if (ze > elbow_max && t < 6) elbow_max = ze, elbow_time = t;
    if (zt > tip_max) tip_max = zt, tip_time = t;
    if (i == 250) {
      EXPECT_NEAR(ze, 3.114, 0.03);
      EXPECT_NEAR(zt, 5.481, 0.03);
    }
    if (i == 100) { EXPECT_NEAR(scheme.ledger().kinetic + scheme.ledger().strain_total(), 114.87, 0.1); }
    if (i == 500) {
      EXPECT_NEAR(ze, -3.100, 0.05);
      EXPECT_NEAR(zt, 4.459, 0.05);
    }
  }
  EXPECT_NEAR(elbow_max, 5.512, 0.002 * 5.512);
  EXPECT_NEAR(elbow_time, 3.0985, 0.04);
  EXPECT_NEAR(tip_max, 8.253, 0.002 * 8.253);
  EXPECT_NEAR(tip_time, 7.436, 0.04);
}

/// Holds all but flapping: displacement along z and rotation about y.
class Flap final : public fem::Prescribed {
 public:
  explicit Flap(const fem::Beam& beam) {
    for (std::size_t i = 0; i < beam.nodes().size(); ++i)
      for (fem::Index c = 0; c < 3; ++c) {
        if (i == 0 || c != 2) held_.push_back(beam.nodes()[i].translation.v + c);
        if (i == 0 || c != 1) held_.push_back(beam.nodes()[i].rotation.v + c);
      }
  }
  const std::vector<fem::Index>& dofs() const override { return held_; }
  void impose(fem::State&) const override {}

 private:
  std::vector<fem::Index> held_;
};

struct Rotor {
  double eta, hub, tip_mass;
  double height_taper, breadth_taper;
  std::vector<double> flap;
};

/// Spins a beam of unit length, stiffness and mass steadily about z, finds its stretched equilibrium, then
/// the flapping modes about it.
std::vector<double> flap_modes(const Rotor& c) {
  const fem::SectionLaw law = [&](double x) {
    const double h = 1 - c.height_taper * x, w = 1 - c.breadth_taper * x;
    return fem::Section{.axial = 1e7,
                        .shear_y = kInf,
                        .shear_z = kInf,
                        .torsion = 1,
                        .bending_y = h * h * h * w,
                        .bending_z = h * h * h * w,
                        .mass = h * w,
                        .rotary = Vec3::Constant(1e-9)};
  };
  BeamSystem b(mesh::straight(mesh::graded(1, 20), Vec3(c.hub, 0, 0), Mat3::Identity()), law);
  if (c.tip_mass > 0)
    b.system.terms.push_back(
        std::make_unique<fem::RigidBody>("mass", b.tip().translation, b.tip().rotation,
                                         fem::RigidBodyProperties{c.tip_mass, 1e-9 * Mat3::Identity(), Vec3::Zero()}));
  for (const fem::Node& n : b.beam->nodes()) {
    const Vec3 x = at(b.rest, n);
    b.rest.v.segment<3>(n.translation.v) = Vec3(0, 0, c.eta).cross(x);
    b.rest.v.segment<3>(n.rotation.v) = Vec3(0, 0, c.eta);
    b.rest.a.segment<3>(n.translation.v) = -c.eta * c.eta * x;
  }
  fem::State spun = b.rest;
  {
    BeamSystem& held = b;
    held.system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(b.beam->nodes().front(), [&](double) {
      return fem::Pose{.position = {c.hub, 0, 0},
                       .velocity = {0, c.eta * c.hub, 0},
                       .acceleration = {-c.eta * c.eta * c.hub, 0, 0},
                       .angular_velocity = {0, 0, c.eta}};
    }));
    spun = solvers::solve_static(held.system, b.rest, {.newton = tight(), .load_steps = 1});
    held.system.prescribed.clear();
  }
  b.system.prescribed.push_back(std::make_unique<Flap>(*b.beam));
  return solvers::modes(b.system, spun, 3).omega;
}

TEST(RotatingBeam, StiffensAsItShould) {
  for (const Rotor& c :
       {Rotor{0, 0, 0, 0, 0, {3.51602, 22.03449, 61.69721}}, Rotor{4, 0, 0, 0, 0, {5.58500, 24.27335, 63.96676}},
        Rotor{12, 0, 0, 0, 0, {13.17015, 37.60311, 79.61448}}, Rotor{12, 1, 0, 0, 0, {19.72154, 51.07013, 98.52680}},
        Rotor{0, 0, 0, 0.4, 0.4, {4.31878, 20.04998, 51.33463}}, Rotor{4, 0, 0, 0.5, 0, {5.87876, 20.68516, 49.64564}},
        Rotor{12, 0, 0, 0.5, 0, {13.47113, 34.08767, 65.52365}}, Rotor{4, 0, 1, 0, 0, {4.54291, 23.02287, 59.29359}},
        Rotor{12, 0, 1, 0, 0, {12.48137, 50.85939, 104.09102}}}) {
    const auto omega = flap_modes(c);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(omega[i] / c.flap[i], 1, 2e-4) << "eta " << c.eta << " mode " << i + 1;
  }
  // Southwell's coefficient near standstill.
  const double eta = 0.2, w0 = flap_modes({0, 0, 0, 0, 0, {}})[0], w1 = flap_modes({eta, 0, 0, 0, 0, {}})[0];
  EXPECT_NEAR((w1 * w1 - w0 * w0) / (eta * eta), 1.19330, 5e-3);
}

TEST(Waves, ArriveAtTheirOwnSpeed) {
  // A unit step of axial force or torque at the tip of the steel tube: the front (half its plateau) passes
  // the butt half at s/c within the transit of one element.
  const double E = 205e9, G = 79e9, rho = 7850;
  for (bool torsion : {false, true}) {
    const int elements = 100;
    BeamSystem b(mesh::straight(mesh::graded(1, elements), Vec3::Zero(), Mat3::Identity()),
                 [](double) { return b2(Theory::timoshenko)(0.5); });
    b.clamp_first();
    b.load(b.tip(), [&](double) {
      return torsion ? fem::Wrench{.moment = {1, 0, 0}} : fem::Wrench{.force = {1, 0, 0}};
    });
    const double c = std::sqrt((torsion ? G : E) / rho), transit = 1.0 / elements / c;
    const fem::Section s = b2(Theory::timoshenko)(0.5);
    const double plateau = torsion ? 1 / (s.rotary.x() * c) : 1 / (s.mass * c);
    GeneralizedAlpha scheme(b.system, fixed(0.8, transit / 4), b.rest);
    const fem::Node& watched = b.beam->nodes()[static_cast<std::size_t>(elements)];  // the middle, s = 0.5
    double arrival = 0;
    while (arrival == 0 && scheme.time() < 1 / c) {
      scheme.advance(1);
      const double rate = scheme.state().v[torsion ? watched.rotation.v : watched.translation.v];
      if (rate > plateau / 2) arrival = scheme.time();
    }
    EXPECT_NEAR(arrival, 0.5 / c, transit) << (torsion ? "torsion" : "axial");
    run_to(scheme, 0.9 / c);
    EXPECT_NEAR(scheme.state().v[torsion ? b.tip().rotation.v : b.tip().translation.v], plateau, 0.05 * plateau);
  }
}

TEST(Waves, TorsionAtTheClamp) {
  // A step of torque at the tip: doubled at the clamp from L/c on until its reflection is back from the tip after
  // 3 L/c; in a tapered tube it arrives no sooner and no later (0.31523 ms per metre of this steel).
  const double c = std::sqrt(79e9 / 7850), arrival = 1 / c;
  EXPECT_NEAR(arrival, 0.31523e-3, 1e-8);
  for (bool tapered : {false, true}) {
    const int elements = 100;
    BeamSystem b(mesh::straight(mesh::graded(1, elements), Vec3::Zero(), Mat3::Identity()),
                 [&](double x) { return b2(Theory::timoshenko)(tapered ? x : 0.5); });
    b.clamp_first();
    b.load(b.tip(), [&](double) { return fem::Wrench{.moment = {1, 0, 0}}; });
    // Towards the butt the torque of the front grows as the root of the impedance.
    const auto z = [&](double x) { return b2(Theory::timoshenko)(tapered ? x : 0.5).rotary.x() * c; };
    const double front = 2 * std::sqrt(z(0) / z(1)), transit = arrival / elements;
    GeneralizedAlpha scheme(b.system, fixed(0.8, transit / 4), b.rest);
    const fem::Index at = b.beam->nodes().front().rotation.v;
    const auto torque = [&] { return -scheme.reactions()[at]; };
    while (torque() < front / 2 && scheme.time() < 2 * arrival) scheme.advance(1);
    EXPECT_NEAR(scheme.time(), arrival, transit) << tapered;
    if (tapered) continue;
    run_to(scheme, 1.3 * arrival);
    double sum = 0, from = scheme.time();
    while (scheme.time() < 2.7 * arrival) {
      const double h = scheme.advance(2.7 * arrival);
      sum += h * torque();
    }
    EXPECT_NEAR(sum / (scheme.time() - from), 2, 0.02);
  }
}

struct StruckBar {
  double ratio;          ///< mass of the bar over that of the body
  double held, parting;  ///< largest force at the clamp over rho A c V; end of contact times c / L
};
void PrintTo(const StruckBar& s, std::ostream* out) { *out << s.ratio; }
class SaintVenant : public testing::TestWithParam<StruckBar> {};

TEST_P(SaintVenant, RigidBodyOnAClampedBar) {
  // The wave that leaves the struck end, over rho A c V and with time in L / c: exp(-a t) until its echo is back at
  // t = 2, then exp(-a t) + (1 - 2 a (t - 2)) exp(-a (t - 2)). The struck end feels sent(t) + sent(t - 2), the clamp
  // 2 sent(t - 1).
  const StruckBar& row = GetParam();
  const double a = row.ratio;
  const auto sent = [a](double t) {
    if (t < 0) return 0.0;
    return std::exp(-a * t) + (t < 2 ? 0 : (1 - 2 * a * (t - 2)) * std::exp(-a * (t - 2)));
  };
  ASSERT_NEAR(2 * sent(2), row.held, 5e-4);  // the last row prints 2.0363 for 2 (1 + exp(-4)) = 2.0366

  const int elements = 200;
  const fem::Section section = b2(Theory::timoshenko)(0.5);
  const double c = std::sqrt(section.axial / section.mass), V = 0.1, unit = section.mass * c * V;
  BeamSystem b(mesh::straight(mesh::graded(1, elements), Vec3::Zero(), Mat3::Identity()), constant(section));
  b.clamp_first();
  const double mass = section.mass / a;
  b.system.terms.push_back(std::make_unique<fem::RigidBody>("body", b.tip().translation, b.tip().rotation,
                                                            fem::RigidBodyProperties{mass, 1e-4 * Mat3::Identity()}));
  fem::State start = b.rest;
  start.v[b.tip().translation.v] = -V;
  GeneralizedAlpha scheme(b.system, fixed(0.8, 0.25 / elements / c), start);
  const fem::Index butt = b.beam->nodes().front().translation.v;
  const auto speed = [&] { return scheme.state().v[b.tip().translation.v]; };

  // Means over a tenth of L/c, not beside a front, which is several elements wide; the ripple behind it leaves 2 % of
  // the largest force in them.
  const int pieces = 10;
  const double window = 0.1;
  const auto mean = [&](auto&& f, double t) {
    double sum = 0;
    for (int i = 0; i < 100; ++i) sum += f(t + window * (i + 0.5) / 100) / 100;
    return sum;
  };
  double parting = 0;
  int compared = 0;
  for (int k = 0; parting == 0 && k < 80; ++k) {
    double force = 0, reaction = 0;
    for (int i = 0; i < pieces; ++i) {
      const double end = window * (k + (i + 1.0) / pieces) / c, before = speed();
      while (scheme.time() < end * (1 - 1e-9)) {
        const double h = scheme.advance(end);
        reaction += h * scheme.reactions()[butt] * c / window / unit;
      }
      const double push = mass * (speed() - before) * c / window / unit;
      if (parting == 0 && k > 0 && push < 0) parting = scheme.time() * c;
      force += push;
    }
    if (parting != 0 || k % 10 == 0 || k % 10 == 9) continue;
    const double t = window * k;
    if (t < 4) {
      EXPECT_NEAR(force, mean([&](double x) { return sent(x) + sent(x - 2); }, t), 0.02 * row.held) << "at " << t;
    }
    if (t < 5) {
      EXPECT_NEAR(reaction, mean([&](double x) { return 2 * sent(x - 1); }, t), 0.02 * row.held) << "at " << t;
    }
    ++compared;
  }
  EXPECT_GE(compared, 20);
  EXPECT_NEAR(parting, row.parting, 0.01 * row.parting);
}

// [@waves]
INSTANTIATE_TEST_SUITE_P(Table, SaintVenant,
                         testing::Values(StruckBar{0.25, 3.2130, 5.8996}, StruckBar{0.5, 2.7358, 4.7086},
                                         StruckBar{1, 2.2707, 3.0677}, StruckBar{2, 2.0363, 2.5046}));

TEST(DrivenBase, TransferToTheTip) {
  BeamSystem b(mesh::straight(mesh::graded(1, 20), Vec3::Zero(), Mat3::Identity()),
               constant({.axial = 1e6,
                         .shear_y = kInf,
                         .shear_z = kInf,
                         .torsion = 1,
                         .bending_y = 1,
                         .bending_z = 1,
                         .mass = 1,
                         .rotary = Vec3::Constant(1e-9)}));
  DenseSink K(b.system.dof_map.size()), M(b.system.dof_map.size());
  b.beam->tangent(b.rest, {1, 0, 0}, K);
  b.beam->tangent(b.rest, {0, 0, 1}, M);
  const auto n = static_cast<Eigen::Index>(b.system.dof_map.size()) - 6;
  for (const auto& [w, H] : {std::pair{1.0, 1.13614486},
                             {2.0, 1.74230989},
                             {3.0, 5.17628797},
                             {5.0, -2.14209841},
                             {10.0, -1.00025348},
                             {20.0, -4.62361108},
                             {30.0, 1.43524166}}) {
    const Eigen::MatrixXd A = K.matrix - w * w * M.matrix;
    const Eigen::VectorXd u = A.bottomRightCorner(n, n).lu().solve(-A.bottomLeftCorner(n, 6).col(1));
    EXPECT_NEAR(u[n - 5] / H, 1, 1e-3) << w;
  }
}

TEST(RigidMotion, OfTheBaseStrainsNothing) {
  // A beam without mass (but for round-off) that starts with the base's motion follows it stiffly.
  BeamSystem b(mesh::straight(mesh::graded(1, 4), Vec3::Zero(), Mat3::Identity()),
               constant(uniform(10, 10, 1, 1, 1e-13, Vec3::Constant(1e-15))));
  const Vec3 w(0.3, 0.5, 2), v(1, 2, 3);
  b.system.prescribed.push_back(std::make_unique<fem::ImposedMotion>(b.beam->nodes().front(), [&](double t) {
    return fem::Pose{.position = t * v, .rotation = fem::rotation_exp(t * w), .velocity = v, .angular_velocity = w};
  }));
  for (const fem::Node& n : b.beam->nodes()) {
    b.rest.v.segment<3>(n.translation.v) = v + w.cross(at(b.rest, n));
    b.rest.v.segment<3>(n.rotation.v) = w;
  }
  solvers::GeneralizedAlphaOptions options = fixed(0.9, 1e-3);
  options.newton = {
      .residual_relative = 0, .residual_absolute = 1e-14, .increment_vector = 1e-12, .increment_rotation = 1e-12};
  GeneralizedAlpha scheme(b.system, options, b.rest);
  run_to(scheme, 1);
  for (const auto& s : b.beam->strains(scheme.state())) EXPECT_LT(s.gamma.norm() + s.kappa.norm(), 1e-12);
}

}  // namespace
}  // namespace hosel::test
