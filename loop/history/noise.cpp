#include "loop/history/noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "loop/deviation.hpp"

namespace hosel::loop {
namespace {

constexpr double kFewestInRow = 8;        // readings that make a periodogram, ordinates that make a band
constexpr std::size_t kFewestOfAll = 16;  // of all records: fewer tell no level and no structure

/// |sum x exp(-i w t)|^2 / n at the frequencies 1 ... of the padded length.
std::vector<double> periodogram(std::vector<double> x, double n) {
  const std::size_t size = std::bit_ceil(x.size());
  x.resize(size, 0.0);
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, x);
  std::vector<double> out;
  for (std::size_t k = 1; k < size / 2; ++k) out.push_back(std::norm(spectrum[k]) / n);
  return out;
}

double tail(double chi2, double dof) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(dof), std::max(0.0, chi2)));
}

/// Standard deviation of a channel of whitened residuals, by the lower four fifths of its periodogram: an oscillation
/// stands in few frequencies.
double level(const HistoryProblem& problem, const Eigen::VectorXd& z, int channel) {
  std::vector<double> power;
  std::ptrdiff_t at = 0;
  for (const HistoryRecord& record : problem.records()) {
    const auto rows = record.measured.rows();
    std::vector<double> x(std::size_t(rows), 0.0);
    double n = 0;
    for (std::ptrdiff_t i = 0; i < rows; ++i) {
      x[i] = z[at + channel * rows + i];
      n += x[i] != 0;
    }
    at += record.measured.size();
    if (n < kFewestInRow) continue;
    for (const double I : periodogram(x, n)) power.push_back(I);
  }
  if (power.size() < kFewestOfAll) return 1;
  std::ranges::sort(power);
  power.resize(power.size() * 4 / 5);
  double mean = 0;
  for (const double x : power) mean += x / double(power.size());
  // Mean of the lower four fifths of an exponential variate: (1 - 0.2 (1 + ln 5)) / 0.8.
  return std::max(1e-12, std::sqrt(mean / 0.597640));
}

}  // namespace

Colour colour(const HistoryProblem& problem, const Eigen::MatrixXd& residuals, int channel, bool white) {
  // Stretches of training readings without a gap, each its own periodogram.
  std::vector<double> power, angle;
  double square = 0, count = 0;
  Eigen::Index first = 0;
  for (const HistoryRecord& record : problem.records()) {
    std::vector<double> run;
    const auto close = [&] {
      const double n = double(run.size());
      if (n >= kFewestInRow) {
        double mean = 0;
        for (const double x : run) mean += x / n;
        for (double& x : run) x -= mean;
        // A cosine window: what a strong slow motion leaves does not leak over all frequencies.
        double weight = 0;
        for (std::size_t i = 0; i < run.size(); ++i) {
          const double w = 1 - std::cos(2 * kPi * (double(i) + 0.5) / n);
          run[i] *= w;
          weight += w * w;
        }
        const std::size_t size = std::bit_ceil(run.size());
        const std::vector<double> I = periodogram(run, weight);
        for (std::size_t k = 0; k < I.size(); ++k) {
          power.push_back(std::max(I[k], kTiny));
          angle.push_back(2 * kPi * double(k + 1) / double(size));
        }
      }
      run.clear();
    };
    for (std::ptrdiff_t i = 0; i < record.measured.rows(); ++i) {
      const double x = residuals(first + i, channel);
      if (record.train[i] && std::isfinite(x)) {
        run.push_back(x);
        square += x * x;
        ++count;
      } else {
        close();
      }
    }
    close();
    first += record.measured.rows();
  }
  if (power.size() < kFewestOfAll) return {std::sqrt(square / std::max(1.0, count)), 0, count};
  Colour best;
  double least = kInfinity;
  std::vector<double> level(power.size());
  for (double rho = 0; rho < 0.985; rho += 0.02) {
    for (std::size_t k = 0; k < power.size(); ++k)
      level[k] = std::log(power[k] * (1 - 2 * rho * std::cos(angle[k]) + rho * rho) / (1 - rho * rho));
    const double middle = median(level);
    double spread = 0;
    for (const double l : level) spread += std::abs(l - middle);
    if (spread < least * (1 - kNothing)) {  // colour only where it helps
      least = spread;
      // The median of an exponential variate of mean one is ln 2.
      best = {std::sqrt(std::exp(middle) / std::numbers::ln2), rho, count};
    }
    if (white) break;
  }
  return best;
}

StructureMap history_structure(const HistoryProblem& problem, const Eigen::VectorXd& z,
                               const Eigen::MatrixXd& directions) {
  StructureMap map;
  double tests = 0;
  const auto add = [&](int channel, const char* kind, std::string detail, double signal, double p, double equivalents) {
    map.findings.push_back({.channel = channel,
                            .regressor = "time_s",
                            .kind = kind,
                            .detail = std::move(detail),
                            .statistic = signal,
                            .signal = signal,
                            .p_adjusted = p});
    tests += equivalents;
  };
  for (int c = 0; c < problem.width(); ++c) {
    // In units of the scatter that is there: a level that is not the declared one is another finding.
    const double scale = level(problem, z, c);
    double n = 0, sum = 0, slope = 0, time2 = 0, lag = 0, pairs = 0;
    std::ptrdiff_t at = 0;
    struct Peak {
      double power = 0, frequency = 0;
    } peak;
    double ordinates = 0;
    std::vector<double> band(24, 0.0), band_count(24, 0.0);
    for (const HistoryRecord& record : problem.records()) {
      const auto rows = record.measured.rows();
      const auto first = at + c * rows;
      at += record.measured.size();
      std::vector<double> x(std::size_t(rows), 0.0);
      double here = 0, middle = 0;
      for (std::ptrdiff_t i = 0; i < rows; ++i)
        if (z[first + i] != 0) {
          ++here;
          middle += record.times[i];
        }
      if (here < kFewestInRow) continue;
      middle /= here;
      for (std::ptrdiff_t i = 0; i < rows; ++i) {
        const double v = z[first + i] / scale;
        x[i] = v;
        if (v == 0) continue;
        const double t = record.times[i] - middle;
        sum += v;
        slope += v * t;
        time2 += t * t;
        if (i > 0 && z[first + i - 1] != 0) {
          lag += v * z[first + i - 1] / scale;
          ++pairs;
        }
      }
      n += here;
      const double span = record.times.back() - record.times.front(), step = span / double(rows - 1);
      const std::size_t size = std::bit_ceil(x.size());
      const std::vector<double> I = periodogram(x, here);
      ordinates += 0.5 * here;
      for (std::size_t k = 0; k < I.size(); ++k) {
        const double f = double(k + 1) / (double(size) * step);
        if (I[k] > peak.power) peak = {I[k], f};
        const auto b = std::min(band.size() - 1, std::size_t(std::log2(double(k + 1))));
        band[b] += I[k];
        ++band_count[b];
      }
      // Padding makes neighbours depend on one another: fewer than counted are free.
      const double free = here / double(size);
      for (std::size_t b = 0; b < band.size(); ++b)
        if (band_count[b] * free >= kFewestInRow) {
          const double mean = band[b] / band_count[b], dof = 2 * band_count[b] * free;
          add(c, "band",
              fmt::format("{:.3g} to {:.3g} Hz", double(std::size_t(1) << b) / (double(size) * step),
                          double(std::size_t(2) << b) / (double(size) * step)),
              (mean - 1) * std::sqrt(dof / 2), tail(mean * dof, dof), 1);
        }
      std::ranges::fill(band, 0.0);
      std::ranges::fill(band_count, 0.0);
    }
    if (n < kFewestOfAll) continue;
    add(c, "constant", "", sum / std::sqrt(n), tail(sum * sum / n, 1), 1);
    if (time2 > 0) add(c, "trend", "", slope / std::sqrt(time2), tail(slope * slope / time2, 1), 1);
    if (pairs > kFewestOfAll) add(c, "neighbours", "alike", lag / std::sqrt(pairs), tail(lag * lag / pairs, 1), 1);
    add(c, "oscillation", fmt::format("at {:.3g} Hz", peak.frequency), std::sqrt(2 * peak.power), std::exp(-peak.power),
        std::max(1.0, 1.5 * ordinates));
  }
  // Directions are tests of their own, fewer and sharper: each by the size of its part of the residual.
  for (Finding& f : map.findings) f.p_adjusted *= tests;
  for (Eigen::Index k = 0; k < directions.cols(); ++k)
    if (const double norm = directions.col(k).norm(); norm > 0) {
      const double part = directions.col(k).dot(z) / norm;
      map.findings.push_back({.channel = -1,
                              .kind = "effect",
                              .statistic = part,
                              .signal = part,
                              .p_adjusted = tail(part * part, 1) * double(directions.cols())});
    }
  std::ranges::stable_sort(map.findings, {}, &Finding::p_adjusted);
  for (Finding& f : map.findings) f.p_adjusted = std::min(1.0, f.p_adjusted);
  if (!map.findings.empty()) map.p = map.findings.front().p_adjusted;
  return map;
}

}  // namespace hosel::loop
