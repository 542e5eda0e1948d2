#include "models/modal/bench_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "golf/units.hpp"

namespace hosel::models {
namespace {

using Complex = std::complex<double>;

/// exp(s (t - origin)) at every time from the origin on, zero before; by recursion where the times are equidistant.
std::vector<Complex> exponentials(Complex s, const std::vector<double>& times, double origin) {
  std::vector<Complex> out(times.size());
  if (times.empty()) return out;
  const double step = times.size() > 1 ? (times.back() - times.front()) / double(times.size() - 1) : 0;
  bool even = true;
  for (std::size_t i = 0; i < times.size() && even; ++i)
    even = std::abs(times[i] - times.front() - double(i) * step) < 1e-6 * step;
  // Of a fast damped mode the exponential before the origin is no number.
  std::size_t first = 0;
  while (first < times.size() && !(times[first] >= origin)) ++first;
  const Complex factor = std::exp(s * step);
  Complex now;
  for (std::size_t i = first; i < times.size(); ++i) {
    if (!even) out[i] = std::exp(s * (times[i] - origin));
    else if ((i - first) % 256 == 0) out[i] = now = std::exp(s * (times.front() - origin + double(i) * step));
    else out[i] = now *= factor;
  }
  return out;
}

/// Pole of a mode: Re < 0, Im > 0. Beyond critical damping nothing rings; such a mode is taken as just critical.
Complex pole(double omega, double ratio) {
  const double zeta = std::min(ratio, 0.999);
  return {-zeta * omega, omega * std::sqrt(1 - zeta * zeta)};
}

Complex power(Complex s, int order) { return order == 0 ? Complex(1) : order == 1 ? s : s * s; }

/// Value at a time inside the grid from values and slopes at the samples.
double hermite(const std::vector<double>& times, const Eigen::VectorXd& y, const Eigen::VectorXd& slope, double t,
               std::size_t& hint) {
  if (t <= times.front()) return y[0];
  if (t >= times.back()) return y[y.size() - 1];
  while (hint + 2 < times.size() && times[hint + 1] <= t) ++hint;
  while (hint > 0 && times[hint] > t) --hint;
  const auto i = std::ptrdiff_t(hint);
  const double h = times[hint + 1] - times[hint], u = (t - times[hint]) / h;
  const double a = u * u * (3 - 2 * u);
  return (1 - a) * y[i] + a * y[i + 1] + h * u * (1 - u) * ((1 - u) * slope[i] - u * slope[i + 1]);
}

}  // namespace

BenchResponse response(const BenchModes& modes, const BenchStart& start, const BenchRecord& record,
                       const std::vector<BenchReading>& readings) {
  const auto n = std::ptrdiff_t(record.times.size()), m = std::ptrdiff_t(readings.size());
  BenchResponse out{Eigen::MatrixXd::Zero(n, m), {}};
  if (n == 0) return out;
  const auto modes_count = modes.omega.size();
  Eigen::Matrix<double, 6, 1> load;
  load << start.force, start.moment;

  if (start.kind == Start::unknown) {
    // Modes that the sampling can show; their start is fitted. They rang before the record: from the earliest time that
    // a reading shows.
    double earliest = record.times.front();
    for (const BenchReading& r : readings) earliest = std::min(earliest, record.times.front() - r.delay);
    const double nyquist = kPi * double(n - 1) / (record.times.back() - record.times.front() + 1e-300);
    for (std::ptrdiff_t k = 0; k < modes_count && k < 8 && modes.omega[k] < 0.9 * nyquist; ++k) {
      const Complex s = pole(modes.omega[k], modes.ratio[k]);
      Eigen::MatrixXd cosine(n, m), sine(n, m);
      std::vector<Complex> e;  // readings of one delay share it
      for (std::ptrdiff_t c = 0; c < m; ++c) {
        const BenchReading& r = readings[std::size_t(c)];
        if (c == 0 || r.delay != readings[std::size_t(c - 1)].delay)
          e = exponentials(s, record.times, std::min(record.times.front(), earliest + r.delay));
        const Complex factor = modes.sensors(c, k) * power(s, r.order);
        for (std::ptrdiff_t i = 0; i < n; ++i) {
          const Complex y = factor * e[std::size_t(i)];
          cosine(i, c) = y.real();
          sine(i, c) = y.imag();
        }
      }
      out.unknown.push_back(std::move(cosine));
      out.unknown.push_back(std::move(sine));
    }
  }

  if (start.kind == Start::release || start.kind == Start::impulse) {
    for (std::ptrdiff_t k = 0; k < modes_count; ++k) {
      const double push = modes.tip.col(k).dot(load);
      if (push == 0) continue;
      const Complex s = pole(modes.omega[k], modes.ratio[k]);
      // q = Re(amplitude exp(s t)): released from q0 at rest, or with velocity v0.
      const double held = push / (modes.omega[k] * modes.omega[k]);
      const Complex amplitude = start.kind == Start::release ? held * Complex(1, s.real() / s.imag())
                                                             : push / s.imag() * Complex(0, -1);
      std::vector<Complex> e;
      for (std::ptrdiff_t c = 0; c < m; ++c) {
        const auto [order, delay] = readings[std::size_t(c)];
        const double before = start.kind == Start::release && order == 0 ? held : 0, origin = start.at + delay;
        if (c == 0 || delay != readings[std::size_t(c - 1)].delay) e = exponentials(s, record.times, origin);
        const Complex factor = amplitude * power(s, order);
        for (std::ptrdiff_t i = 0; i < n; ++i) {
          const bool moving = record.times[std::size_t(i)] >= origin;
          out.value(i, c) += modes.sensors(c, k) * (moving ? (factor * e[std::size_t(i)]).real() : before);
        }
      }
    }
  }

  if (record.acceleration.size() > 0 || record.force.size() > 0) {
    // Response to a forcing that is linear between samples, exact for each mode; readings and their slopes at the
    // samples, then at the delayed times.
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(n, m), slope = y;
    for (std::ptrdiff_t k = 0; k < modes_count; ++k) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
      if (record.acceleration.size() > 0) f -= record.acceleration * modes.base.col(k);
      if (record.force.size() > 0) f += record.force * modes.tip.col(k).head<3>();
      const double w2 = modes.omega[k] * modes.omega[k], twice = 2 * std::min(modes.ratio[k], 0.999) * modes.omega[k];
      const Complex s = pole(modes.omega[k], modes.ratio[k]);
      double q = 0, v = 0;
      double known_step = -1;
      Complex grow;
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        const double a = f[i] - w2 * q - twice * v;
        double jerk = 0;
        if (i > 0)
          jerk = (f[i] - f[i - 1]) / (record.times[std::size_t(i)] - record.times[std::size_t(i - 1)]) - w2 * v -
                 twice * a;
        const double derivative[] = {q, v, a, jerk};
        for (std::ptrdiff_t c = 0; c < m; ++c) {
          const int order = readings[std::size_t(c)].order;
          y(i, c) += modes.sensors(c, k) * derivative[order];
          slope(i, c) += modes.sensors(c, k) * derivative[order + 1];
        }
        if (i + 1 == n) break;
        const double h = record.times[std::size_t(i + 1)] - record.times[std::size_t(i)], rate = (f[i + 1] - f[i]) / h;
        // Particular solution q = p0 + p1 t, the rest rings freely.
        const double p1 = rate / w2, p0 = (f[i] - twice * p1) / w2;
        if (std::abs(h - known_step) > 1e-12 * h) {
          grow = std::exp(s * h);
          known_step = h;
        }
        const double q0 = q - p0, v0 = v - p1;
        const Complex z = Complex(q0, (s.real() * q0 - v0) / s.imag()) * grow;
        q = z.real() + p0 + p1 * h;
        v = (z * s).real() + p1;
      }
    }
    for (std::ptrdiff_t c = 0; c < m; ++c) {
      const double delay = readings[std::size_t(c)].delay;
      if (delay == 0) {
        out.value.col(c) += y.col(c);
        continue;
      }
      std::size_t hint = 0;
      for (std::ptrdiff_t i = 0; i < n; ++i)
        out.value(i, c) += hermite(record.times, y.col(c), slope.col(c), record.times[std::size_t(i)] - delay, hint);
    }
  }
  return out;
}

}  // namespace hosel::models
