// What sensors read of modes that are stepped exactly, against the same modes in many small steps.
#include "models/modal/bench_response.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

namespace hosel::models {
namespace {

constexpr double kSample = 2e-3;  // [s]

BenchModes two_modes() {
  BenchModes m;
  m.omega = Eigen::Vector2d(31, 170);
  m.ratio = Eigen::Vector2d(0.02, 0.3);
  m.sensors.resize(3, 2);
  m.sensors << 1.0, 0.4, -0.3, 0.8, 0.5, 0.6;
  m.tip.resize(6, 2);
  m.tip << 0.9, -0.5, 0.2, 0.7, 0.1, 0.3, 0.4, 0.2, -0.6, 0.1, 0.05, 0.9;
  m.base.resize(3, 2);
  m.base << 0.3, -0.2, 0.5, 0.1, 0.2, 0.4;
  return m;
}

BenchRecord at_samples(int n) {
  BenchRecord r;
  for (int i = 0; i < n; ++i) r.times.push_back(kSample * i);
  return r;
}

/// q, q' and q'' of a mode at the samples: Runge and Kutta's method in steps of a hundredth of a sample.
Eigen::MatrixXd stepped(double omega, double ratio, double q, double v, int n, const std::function<double(double)>& f) {
  constexpr int steps = 100;
  const double h = kSample / steps;
  const auto a = [&](double t, double x, double w) { return f(t) - omega * omega * x - 2 * ratio * omega * w; };
  Eigen::MatrixXd out(n, 3);
  for (int i = 0; i < n; ++i) {
    out.row(i) << q, v, a(kSample * i, q, v);
    for (int s = 0; s < steps; ++s) {
      const double t = kSample * i + h * s;
      const double k1 = a(t, q, v), v2 = v + h / 2 * k1, k2 = a(t + h / 2, q + h / 2 * v, v2), v3 = v + h / 2 * k2,
                   k3 = a(t + h / 2, q + h / 2 * v2, v3), v4 = v + h * k3, k4 = a(t + h, q + h * v3, v4);
      q += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return out;
}

double load_of(const BenchModes& m, const BenchStart& s, int k) {
  Eigen::Matrix<double, 6, 1> load;
  load << s.force, s.moment;
  return m.tip.col(k).dot(load);
}

TEST(BenchResponse, ReleasedAndStruckAsStepByStep) {
  const BenchModes m = two_modes();
  const BenchRecord record = at_samples(120);
  constexpr int late = 10, delayed = 5;  // samples; a rounding before, for a struck rate jumps
  for (const Start kind : {Start::release, Start::impulse}) {
    const BenchStart start{
        .kind = kind, .at = kSample * late - 1e-13, .force = Vec3(3, -2, 5), .moment = Vec3(0.3, 0.2, -0.1)};
    const BenchResponse found = response(m, start, record, {{0, 0}, {1, kSample * delayed}, {2, 0}});
    Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(120, 3);
    for (int k = 0; k < 2; ++k) {
      const double push = load_of(m, start, k), held = push / (m.omega[k] * m.omega[k]);
      const bool release = kind == Start::release;
      const Eigen::MatrixXd q =
          stepped(m.omega[k], m.ratio[k], release ? held : 0, release ? 0 : push, 120, [](double) { return 0.0; });
      for (int i = 0; i < 120; ++i)
        for (int c = 0; c < 3; ++c) {
          const int since = i - late - (c == 1 ? delayed : 0);
          const double before = release && c == 0 ? held : 0;
          wanted(i, c) += m.sensors(c, k) * (since < 0 ? before : q(since, c));
        }
    }
    ASSERT_GT(found.value.cwiseAbs().colwise().maxCoeff().minCoeff(), 0);
    for (int c = 0; c < 3; ++c)
      EXPECT_LT((found.value - wanted).col(c).cwiseAbs().maxCoeff(), 1e-8 * wanted.col(c).cwiseAbs().maxCoeff()) << c;
    EXPECT_TRUE(found.unknown.empty());
  }
}

TEST(BenchResponse, DrivenByClampAndForceAsStepByStep) {
  const BenchModes m = two_modes();
  constexpr int n = 150;
  BenchRecord record = at_samples(n);
  record.acceleration.resize(n, 3);
  record.force.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    const double t = kSample * i;
    record.acceleration.row(i) << std::sin(40 * t), 2 * std::cos(90 * t), t;
    record.force.row(i) << std::cos(31 * t), -0.5, std::sin(160 * t);
  }
  const double part = 0.4;  // of a sample: between two of them
  const BenchResponse found =
      response(m, {.kind = Start::rest}, record, {{0, 3 * kSample}, {1, 0}, {1, part * kSample}});
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(n, 3);
  for (int k = 0; k < 2; ++k) {
    const auto f = [&](double t) {
      const int i = std::clamp(int(t / kSample), 0, n - 2);
      const double w = t / kSample - i;
      const auto at = [&](int j) {
        return double(record.force.row(j) * m.tip.col(k).head<3>()) -
               double(record.acceleration.row(j) * m.base.col(k));
      };
      return (1 - w) * at(i) + w * at(i + 1);
    };
    const Eigen::MatrixXd q = stepped(m.omega[k], m.ratio[k], 0, 0, n, f);
    for (int i = 3; i < n; ++i) {
      wanted(i, 0) += m.sensors(0, k) * q(i - 3, 0);
      wanted(i, 1) += m.sensors(1, k) * q(i, 1);
      // From the rate and its slope at the two samples around it.
      const double u = 1 - part, a = u * u * (3 - 2 * u);
      wanted(i, 2) += m.sensors(2, k) * ((1 - a) * q(i - 1, 1) + a * q(i, 1) +
                                         kSample * u * (1 - u) * ((1 - u) * q(i - 1, 2) - u * q(i, 2)));
    }
  }
  for (int c = 0; c < 3; ++c) {
    const double size = wanted.col(c).cwiseAbs().maxCoeff();
    ASSERT_GT(size, 0);
    EXPECT_LT((found.value - wanted).bottomRows(n - 3).col(c).cwiseAbs().maxCoeff(), 1e-7 * size) << c;
  }
}

/// A mode that dies within a sample, released or struck long after the record's start, against its closed form: its
/// exponential before that is beyond every number.
TEST(BenchResponse, AFastModeStaysFiniteBeforeALateStart) {
  constexpr double omega = 22e3, zeta = 0.5, at = 0.1, delay = 0.07;
  const double decay = zeta * omega, rate = omega * std::sqrt(1 - zeta * zeta);
  ASSERT_GT(decay * delay, 710);  // exp() overflows
  BenchModes m;
  m.omega = Eigen::VectorXd::Constant(1, omega);
  m.ratio = Eigen::VectorXd::Constant(1, zeta);
  m.sensors = Eigen::MatrixXd::Ones(2, 1);
  m.tip = Eigen::MatrixXd::Ones(6, 1);
  m.base = Eigen::MatrixXd::Zero(3, 1);
  for (const bool even : {true, false}) {
    BenchRecord record;
    for (int i = 0; i < 40000; ++i) record.times.push_back(5e-6 * i + (even ? 0 : 1e-6 * (i % 2)));
    for (const Start kind : {Start::release, Start::impulse}) {
      const BenchStart start{.kind = kind, .at = at, .force = Vec3(2, 0, 0)};
      const BenchResponse found = response(m, start, record, {{0, 0}, {0, delay}});
      const double held = 2 / (omega * omega), size = kind == Start::release ? held : 2 / omega;
      double moved = 0;
      for (Eigen::Index c = 0; c < 2; ++c)
        for (Eigen::Index i = 0; i < found.value.rows(); ++i) {
          const double t = record.times[std::size_t(i)] - at - (c == 1 ? delay : 0), e = std::exp(-decay * t);
          if (std::abs(t) < 1e-9) continue;  // either side of the jump
          const double wanted = kind == Start::impulse ? (t < 0 ? 0 : 2 / rate * e * std::sin(rate * t))
                                : t < 0                ? held
                                        : held * e * (std::cos(rate * t) + decay / rate * std::sin(rate * t));
          // 256 products of the recursion, and phases up to 1e3 that times of 0.1 s give to 1e-16 of them.
          ASSERT_NEAR(found.value(i, c), wanted, 1e-10 * size) << c << ' ' << i;
          if (t > 0) moved = std::max(moved, std::abs(wanted));
        }
      EXPECT_GT(moved, 0.5 * size);
    }
    // Where the start is unknown it rang before, and a delayed reading shows that.
    const BenchResponse unknown = response(m, {}, record, {{0, 0}, {0, delay}});
    ASSERT_EQ(unknown.unknown.size(), 2U);
    for (const Eigen::MatrixXd& u : unknown.unknown) {
      EXPECT_TRUE(u.allFinite());
      EXPECT_GT(u.col(1).cwiseAbs().maxCoeff(), 0.4);  // the sine's; the cosine's is 1
    }
  }
}

/// Each mode that the sampling shows adds two unknowns, which a free motion is a sum of.
TEST(BenchResponse, AnUnknownStartIsASumOfItsUnknowns) {
  const BenchModes m = two_modes();
  const BenchRecord record = at_samples(100);
  const BenchResponse found = response(m, {}, record, {{0, 0}, {1, 0}, {2, 0}});
  ASSERT_EQ(found.unknown.size(), 4U);
  EXPECT_EQ(found.value, Eigen::MatrixXd::Zero(100, 3));
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(300);
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd q = stepped(m.omega[k], m.ratio[k], 0.1 + k, -2, 100, [](double) { return 0.0; });
    for (int c = 0; c < 3; ++c) wanted.segment(100 * c, 100) += m.sensors(c, k) * q.col(c);
  }
  Eigen::MatrixXd basis(300, 4);
  for (int j = 0; j < 4; ++j) basis.col(j) = found.unknown[std::size_t(j)].reshaped();
  const Eigen::VectorXd off = wanted - basis * basis.colPivHouseholderQr().solve(wanted);
  EXPECT_LT(off.norm(), 1e-7 * wanted.norm());
  // 80 Hz of sampling do not show the second mode.
  BenchRecord slow = record;
  for (double& t : slow.times) t *= 20;
  EXPECT_EQ(response(m, {}, slow, {{0, 0}, {1, 0}, {2, 0}}).unknown.size(), 2U);
}

}  // namespace
}  // namespace hosel::models
