#include "hosel/loop/structure.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace hosel::loop {
namespace {

/// Centred over the rows, unit mean square; false where it does not vary.
bool standardise(Eigen::VectorXd& x, const std::vector<int>& rows) {
  double sum = 0, count = 0;
  for (const int i : rows)
    if (std::isfinite(x[i])) {
      sum += x[i];
      ++count;
    }
  if (count < 3) return false;
  double square = 0, largest = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = std::isfinite(x[i]) ? x[i] - sum / count : 0.0;
  for (const int i : rows) {
    square += x[i] * x[i];
    largest = std::max(largest, std::abs(x[i]));
  }
  if (!(square > 0) || largest < 1e-12 * std::abs(sum / count)) return false;
  x /= std::sqrt(square / double(rows.size()));
  return true;
}

Eigen::VectorXd ranks_clipped(Eigen::VectorXd x) {
  // One wild cell must not be the regressor: beyond four robust deviations values are drawn in.
  return x.cwiseMax(-4.0).cwiseMin(4.0);
}

void remove_trend(Eigen::VectorXd& q, const Eigen::VectorXd& x, const std::vector<int>& rows) {
  double xx = 0, xq = 0;
  for (const int i : rows) {
    xx += x[i] * x[i];
    xq += x[i] * q[i];
  }
  if (xx > 0) q -= (xq / xx) * x;
}

/// What an instrument does to a reading y: dead band about a value, saturation beyond one, the reading of the shot
/// before mixed in. The value is the base model's, so that noise does not enter.
void add_responses(const Problem& problem, const std::vector<int>& rows, const Eigen::VectorXd& order,
                   std::vector<Regressor>& all) {
  const int n = problem.shots(), m = problem.width();
  if (rows.size() < 12) return;
  Eigen::MatrixXd y(n, m);
  std::vector<double> out(static_cast<std::size_t>(m));
  for (int i = 0; i < n; ++i) {
    const bool good = problem.predict(i, Model{}, nullptr, out.data());
    for (int c = 0; c < m; ++c) y(i, c) = good ? out[std::size_t(c)] : std::nan("");
  }
  std::vector<int> by_order(static_cast<std::size_t>(n));
  std::iota(by_order.begin(), by_order.end(), 0);
  std::ranges::stable_sort(by_order, {}, [&](int i) { return order[i]; });
  for (int c = 0; c < m; ++c) {
    const std::string& name = problem.channels()[std::size_t(c)].name;
    std::vector<double> sorted;
    for (const int i : rows)
      if (std::isfinite(y(i, c))) sorted.push_back(y(i, c));
    if (sorted.size() < 12) continue;
    std::ranges::sort(sorted);
    const auto at = [&](double q) { return sorted[std::size_t(q * double(sorted.size() - 1))]; };
    Eigen::VectorXd line = y.col(c);
    if (!standardise(line, rows)) continue;
    const auto add = [&](const char* kind, std::string detail, const std::string& column, auto&& value) {
      Eigen::VectorXd x(n);
      for (int i = 0; i < n; ++i) x[i] = value(y(i, c));
      if (!standardise(x, rows)) return;
      remove_trend(x, line, rows);
      if (x.norm() < 0.05 * std::sqrt(double(n)) || !standardise(x, rows)) return;
      all.push_back({column, kind, std::move(detail), false, x, c});
    };
    for (const double share : {0.3, 0.5, 0.7}) {
      const double half = 0.5 * (at(0.5 + share / 2) - at(0.5 - share / 2)), centre = at(0.5);
      add("response", fmt::format("dead band about {:.4g}", centre), name,
          [&](double v) { return std::abs(v - centre) < half ? v - centre : 0.0; });
    }
    for (const double q : {0.2, 0.4, 0.6, 0.8})
      add("response", fmt::format("kink at {:.4g}", at(q)), name,
          [&](double v) { return q < 0.5 ? std::min(0.0, v - at(q)) : std::max(0.0, v - at(q)); });
    Eigen::VectorXd lag = Eigen::VectorXd::Zero(n);
    for (int k = 1; k < n; ++k)
      lag[by_order[std::size_t(k)]] = y(by_order[std::size_t(k) - 1], c) - y(by_order[std::size_t(k)], c);
    if (standardise(lag, rows)) all.push_back({"shot", "lag", "the reading of the shot before", true, lag, c});
  }
}

}  // namespace

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  Eigen::MatrixXd scaled = columns;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k)
    if (const double norm = scaled.col(k).norm(); norm > 0) scaled.col(k) /= norm;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(1e-8);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const Problem& problem) {
  const int n = problem.shots();
  std::vector<Regressor> all;
  all.push_back({"constant", "constant", "", false, Eigen::VectorXd::Ones(n)});

  struct Line {
    std::string name;
    bool foreign;
    Eigen::VectorXd x;
  };
  std::vector<Line> lines;
  const auto add_line = [&](const std::string& name, bool foreign, Eigen::VectorXd x) {
    if (!standardise(x, rows)) return;
    x = ranks_clipped(x);
    if (!standardise(x, rows)) return;
    lines.push_back({name, foreign, x});
  };
  for (const Column& c : shots.columns) {
    if (c.role == Role::output || !c.numeric || c.name == "shot") continue;
    if (c.role == Role::bookkeeping) continue;
    Eigen::VectorXd x(n);
    for (int i = 0; i < n; ++i) {
      x[i] = c.value[std::size_t(row_of[std::size_t(i)])];
      // What the fit sees of an input (filled, shrunk towards its mean) is what the residual depends on.
      if (c.role == Role::input)
        for (int k = 0; k < kInputs; ++k)
          if (stem(Input(k)) == c.stem) x[i] = get(problem.trial(i).blow, Input(k));
    }
    add_line(c.name, c.role == Role::other, x);
  }
  Eigen::VectorXd order(n);
  for (int i = 0; i < n; ++i) order[i] = problem.trial(i).order;
  add_line("shot", true, order);

  for (const Line& l : lines) all.push_back({l.name, "trend", "", l.foreign, l.x});
  for (const Line& l : lines) {
    Eigen::VectorXd q = l.x.cwiseAbs2();
    if (!standardise(q, rows)) continue;
    remove_trend(q, l.x, rows);
    if (q.norm() < 0.05 * std::sqrt(double(n)) || !standardise(q, rows)) continue;
    all.push_back({l.name, "curvature", "", l.foreign, q});
  }
  const std::size_t most_products = 40;
  std::size_t products = 0;
  for (std::size_t a = 0; a < lines.size(); ++a)
    for (std::size_t b = a + 1; b < lines.size() && products < most_products; ++b) {
      // Unknown columns act on the physics through speed, loft and offsets; two of them together do not.
      if (lines[a].foreign && lines[b].foreign) continue;
      Eigen::VectorXd q = lines[a].x.cwiseProduct(lines[b].x);
      if (!standardise(q, rows)) continue;
      remove_trend(q, lines[a].x, rows);
      remove_trend(q, lines[b].x, rows);
      if (q.norm() < 0.05 * std::sqrt(double(n)) || !standardise(q, rows)) continue;
      const bool second = lines[b].foreign;
      all.push_back({lines[second ? b : a].name, "interaction", "with " + lines[second ? a : b].name,
                     lines[a].foreign || second, q});
      ++products;
    }

  for (const Column& c : shots.columns) {
    if (c.numeric || c.role == Role::output) continue;
    const Groups g = groups(c);
    if (g.name.size() < 2 || g.name.size() > 40) continue;
    for (std::size_t k = 0; k < g.name.size(); ++k) {
      Eigen::VectorXd x(n);
      for (int i = 0; i < n; ++i) x[i] = g.of_row[std::size_t(row_of[std::size_t(i)])] == int(k);
      double members = 0;
      for (const int i : rows) members += x[i];
      if (members < 2 || members > double(rows.size()) - 1) continue;
      if (g.name.size() == 2 && k == 1) continue;  // the complement
      if (standardise(x, rows)) all.push_back({c.name, "group", "= " + g.name[k], true, x});
    }
  }

  add_responses(problem, rows, order, all);

  if (rows.size() >= 12) {
    for (int k = 1; k < 12; ++k) {
      Eigen::VectorXd x(n);
      for (int i = 0; i < n; ++i) x[i] = order[i] > k / 12.0;
      if (standardise(x, rows))
        all.push_back({"shot", "step", fmt::format("at {:.0f} % of the session", 100 * k / 12.0), true, x});
    }
    const int fastest = std::clamp(int(rows.size()) / 4, 2, 16);
    // Half periods too: the slow ones need not close over the session.
    for (int half = 2; half <= 2 * fastest; half += half < 12 ? 1 : 2)
      for (const bool sine : {true, false}) {
        Eigen::VectorXd x(n);
        for (int i = 0; i < n; ++i) {
          const double phase = kPi * half * order[i];
          x[i] = sine ? std::sin(phase) : std::cos(phase);
        }
        if (standardise(x, rows))
          all.push_back({"shot", "oscillation", fmt::format("{:g} periods in the session", 0.5 * half), true, x});
      }
  }
  return all;
}

Eigen::MatrixXd whitened_regressors(const Problem& problem, const std::vector<int>& rows,
                                    const std::vector<const Regressor*>& which) {
  const int m = problem.width();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(std::ptrdiff_t(rows.size()) * m, std::ptrdiff_t(which.size()) * m);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto W = problem.whitening(rows[i]);
    for (std::size_t k = 0; k < which.size(); ++k)
      for (int c = 0; c < m; ++c)
        if (problem.observed(rows[i], c))
          A.block(std::ptrdiff_t(i) * m, std::ptrdiff_t(k) * m + c, m, 1) = W.col(c) * which[k]->value[rows[i]];
  }
  return A;
}

StructureMap structure(const Problem& problem, const std::vector<int>& rows, const Eigen::VectorXd& z,
                       const Eigen::VectorXd& noise, const Eigen::VectorXd& weights, const Eigen::MatrixXd& nuisance,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions,
                       const std::vector<int>& cluster, int flips, unsigned long seed) {
  const int n = int(rows.size()), m = problem.width();
  const Eigen::MatrixXd Q = orthonormal(nuisance);

  StructureMap map;
  std::vector<Eigen::VectorXf> scores;  // normalised contributions of the shots
  Eigen::VectorXd a(std::ptrdiff_t(n) * m);
  const auto add = [&](int channel, int regressor) {
    const double before = a.norm();
    if (!(before > 0)) return;
    if (Q.cols()) a -= Q * (Q.transpose() * a);
    const double after = a.norm();
    if (after < 0.05 * before) return;  // what was fitted absorbs this regressor
    Eigen::VectorXd u(n);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const auto ai = a.segment(std::ptrdiff_t(i) * m, m);
      sum += weights[i] * ai.dot(z.segment(std::ptrdiff_t(i) * m, m));
      u[i] = weights[i] * ai.dot(noise.segment(std::ptrdiff_t(i) * m, m));
    }
    const double norm = u.norm();
    if (!(norm > 0)) return;
    map.findings.push_back({channel, regressor, sum / norm, sum / after, 1});
    scores.push_back((u / norm).cast<float>());
  };
  for (std::size_t r = 0; r < regressors.size(); ++r)
    for (int c = 0; c < m; ++c) {
      if (regressors[r].channel >= 0 && regressors[r].channel != c) continue;
      for (int i = 0; i < n; ++i) {
        auto part = a.segment(std::ptrdiff_t(i) * m, m);
        if (problem.observed(rows[std::size_t(i)], c))
          part = problem.whitening(rows[std::size_t(i)]).col(c) * regressors[r].value[rows[std::size_t(i)]];
        else part.setZero();
      }
      add(c, int(r));
    }
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    a = directions.col(k);
    add(-1, int(regressors.size()) + int(k));
  }
  const std::size_t plain = scores.size();

  // Neighbours alike: products of standardised residuals of successive shots, in session order.
  std::vector<int> by_order(rows.size());
  std::iota(by_order.begin(), by_order.end(), 0);
  std::ranges::stable_sort(by_order, {}, [&](int i) { return problem.trial(rows[std::size_t(i)]).order; });
  for (int c = 0; c < m && n >= 12; ++c) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
    double square = 0;
    for (int k = 0; k + 1 < n; ++k) {
      const int i = by_order[std::size_t(k)], j = by_order[std::size_t(k) + 1];
      const double x = weights[i] * noise[std::ptrdiff_t(i) * m + c], y = weights[j] * noise[std::ptrdiff_t(j) * m + c];
      u[k] = x * y;
      square += x * x;
    }
    const double norm = u.norm();
    if (!(norm > 0)) continue;
    map.findings.push_back({c, -1, u.sum() / norm, u.sum() / std::sqrt(std::max(1.0, square)), 1});
    scores.push_back((u / norm).cast<float>());
  }
  if (map.findings.empty()) return map;

  Eigen::MatrixXf U(n, std::ptrdiff_t(plain)), V(n, std::ptrdiff_t(scores.size() - plain));
  for (std::size_t k = 0; k < scores.size(); ++k)
    (k < plain ? U.col(std::ptrdiff_t(k)) : V.col(std::ptrdiff_t(k - plain))) = scores[k];
  std::mt19937_64 random(seed);
  int n_cluster = 0;
  for (const int g : cluster) n_cluster = std::max(n_cluster, g + 1);
  std::vector<double> largest;
  constexpr int batch = 128;
  Eigen::MatrixXf S(batch, n), P(batch, n);
  for (int done = 0; done < flips; done += batch) {
    for (int b = 0; b < batch; ++b) {
      std::vector<float> sign_of(std::size_t(n_cluster), 1.0F);
      for (float& s : sign_of) s = (random() >> 63) ? 1.0F : -1.0F;
      std::uint64_t bits = 0;
      for (int i = 0; i < n; ++i) {
        if (i % 64 == 0) bits = random();
        const int g = cluster.empty() ? -1 : cluster[std::size_t(i)];
        S(b, i) = g >= 0 ? sign_of[std::size_t(g)] : ((bits >> (i % 64) & 1U) ? 1.0F : -1.0F);
      }
      for (int k = 0; k < n; ++k)
        P(b, k) = k + 1 < n ? S(b, by_order[std::size_t(k)]) * S(b, by_order[std::size_t(k) + 1]) : 1.0F;
    }
    const Eigen::MatrixXf A = S * U, B = P * V;
    for (int b = 0; b < batch && done + b < flips; ++b)
      largest.push_back(double(std::max(U.cols() ? A.row(b).cwiseAbs().maxCoeff() : 0.0F,
                                        V.cols() ? B.row(b).cwiseAbs().maxCoeff() : 0.0F)));
  }
  std::ranges::sort(largest);
  map.threshold = largest[std::size_t(0.99 * double(largest.size() - 1))];
  double top = 0;
  for (Finding& f : map.findings) {
    const double t = std::abs(f.statistic);
    const auto above = largest.end() - std::ranges::lower_bound(largest, t - 1e-5);
    f.p_adjusted = (1.0 + double(above)) / (1.0 + double(largest.size()));
    top = std::max(top, t);
  }
  map.p = (1.0 + double(largest.end() - std::ranges::lower_bound(largest, top - 1e-5))) /
          (1.0 + double(largest.size()));
  std::ranges::stable_sort(map.findings, std::ranges::greater{}, [](const Finding& f) { return std::abs(f.signal); });
  return map;
}

}  // namespace hosel::loop
