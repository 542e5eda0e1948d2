#include "loop/shots/structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "loop/deviation.hpp"
#include "loop/result.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

/// The reading itself. It names what follows it; the inputs that make the reading find it.
constexpr const char* kGain = "gain";
constexpr double kAbsorbed = 0.05;  // of a regressor's norm: with less left, lines or the fit absorb it

/// Returns the signal, in units of the channel's noise, below which a finding is ignored: two declared standard
/// deviations. It is zero if no noise is declared, or if it was refuted by more than rounding.
double least_signal(const Channel& c) {
  constexpr double of_declared = 2;  // chance reaches 3 in one of so many regressors
  if (!c.declared || (c.refuted && c.noise > 2 * rounding_deviation(c.resolution))) return 0;
  return of_declared * *c.declared / c.noise;
}

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
  if (!(square > 0) || largest < kLastBits * std::abs(sum / count)) return false;
  x /= std::sqrt(square / double(rows.size()));
  return true;
}

/// What a regressor adds to some lines; false where that is little.
bool beside(Eigen::VectorXd& x, const std::vector<const Eigen::VectorXd*>& lines, const std::vector<int>& rows) {
  if (!standardise(x, rows)) return false;
  for (const Eigen::VectorXd* line : lines) {
    const Eigen::VectorXd& l = *line;
    double ll = 0, lx = 0;
    for (const int i : rows) {
      ll += l[i] * l[i];
      lx += l[i] * x[i];
    }
    if (ll > 0) x -= (lx / ll) * l;
  }
  return x.norm() >= kAbsorbed * std::sqrt(double(x.size())) && standardise(x, rows);
}

/// What an instrument does to a reading y: dead band about a value, saturation beyond one, the reading of the shot
/// before mixed in. The value is the base model's, so that noise does not enter.
void add_responses(const ShotModel& model, const std::vector<int>& rows, const Eigen::VectorXd& order,
                   std::vector<Regressor>& all) {
  const int n = model.shots(), m = model.width();
  if (rows.size() < kFewestRows) return;
  Eigen::MatrixXd y(n, m);
  std::vector<double> out(static_cast<std::size_t>(m));
  for (int i = 0; i < n; ++i) {
    const bool good = model.predict(i, Model{}, nullptr, out.data());
    for (int c = 0; c < m; ++c) y(i, c) = good ? out[c] : kNaN;
  }
  const std::vector<int> by_order = rising_order(std::size_t(n), [&](int i) { return order[i]; });
  for (int c = 0; c < m; ++c) {
    const std::string& name = model.channel(c).name;
    std::vector<double> sorted;
    for (const int i : rows)
      if (std::isfinite(y(i, c))) sorted.push_back(y(i, c));
    if (sorted.size() < kFewestRows) continue;
    std::ranges::sort(sorted);
    const auto at = [&](double q) { return at_share(sorted, q); };
    Eigen::VectorXd line = y.col(c);
    if (!standardise(line, rows)) continue;
    all.push_back({name, kGain, "", false, line, c});
    const auto add = [&](std::string detail, auto&& value) {
      Eigen::VectorXd x(n);
      for (int i = 0; i < n; ++i) x[i] = value(y(i, c));
      if (beside(x, {&line}, rows)) all.push_back({name, "response", std::move(detail), false, x, c});
    };
    for (const double share : {0.3, 0.5, 0.7}) {
      const double half = (at((1 + share) / 2) - at((1 - share) / 2)) / 2, centre = at(0.5);
      add(fmt::format("dead band about {:.4g}", centre),
          [&](double v) { return std::abs(v - centre) < half ? v - centre : 0.0; });
    }
    for (const double q : {0.2, 0.4, 0.6, 0.8})
      add(fmt::format("kink at {:.4g}", at(q)),
          [&](double v) { return q < 0.5 ? std::min(0.0, v - at(q)) : std::max(0.0, v - at(q)); });
    Eigen::VectorXd lag = Eigen::VectorXd::Zero(n);
    for (int k = 1; k < n; ++k) lag[by_order[k]] = y(by_order[k - 1], c) - y(by_order[k], c);
    if (standardise(lag, rows)) all.push_back({"shot", "lag", "the reading of the shot before", true, lag, c});
  }
}

/// An input as it was on the shot before or after: what a record that is smoothed, held or shifted misses.
void add_neighbours(const std::vector<Line>& lines, const std::vector<int>& rows, const Eigen::VectorXd& order,
                    std::vector<Regressor>& all) {
  const auto n = order.size();
  const std::vector<int> by_order = rising_order(std::size_t(n), [&](int i) { return order[i]; });
  for (const Line& l : lines) {
    Eigen::VectorXd own = l.x;
    if (l.foreign || !standardise(own, rows)) continue;
    for (const int away : {-1, 1}) {
      Eigen::VectorXd x(n);
      for (Eigen::Index k = 0; k < n; ++k) x[by_order[k]] = own[by_order[std::clamp<Eigen::Index>(k + away, 0, n - 1)]];
      if (beside(x, {&own}, rows))
        all.push_back({l.name, "lag", fmt::format("value on the shot {}", away < 0 ? "before" : "after"), true, x});
    }
  }
}

/// Balls, clubs or players in turn: one shot of every two to eight. Such a period is too short for an oscillation.
void add_turns(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
               std::vector<Regressor>& all) {
  constexpr long longest = 8;
  const Column* shot = shots.find("shot");
  if (!shots.has_shot_column || !shot || !shot->numeric) return;
  const auto number = [&](Eigen::Index i) { return shot->value[row_of[i]]; };
  const auto n = Eigen::Index(row_of.size());
  for (Eigen::Index i = 0; i < n; ++i)
    if (!std::isfinite(number(i)) || number(i) != std::round(number(i)) || std::abs(number(i)) > 1e9) return;
  for (long period = 2; period <= longest; ++period)
    for (long turn = 0; turn < (period == 2 ? 1 : period); ++turn) {
      Eigen::VectorXd x(n);
      for (Eigen::Index i = 0; i < n; ++i) x[i] = ((long(number(i)) - turn) % period) == 0;
      // A column that names who or what is in turn says more.
      const auto named = [&](const Regressor& r) {
        Eigen::VectorXd left = x;
        return r.kind == "group" && !beside(left, {&r.value}, rows);
      };
      if (std::ranges::none_of(all, named) && standardise(x, rows))
        all.push_back({"shot", "turn",
                       fmt::format("one of every {} shots, number {} among them", period, turn ? turn : period), true,
                       x});
    }
}

}  // namespace

std::vector<Line> columns_of(const Shots& shots, const std::vector<int>& row_of, const ShotModel& model) {
  const int n = model.shots();
  std::vector<Line> lines;
  for (const Column& c : shots.columns) {
    if (c.role == Role::output || !c.numeric || c.role == Role::bookkeeping) continue;
    Eigen::VectorXd x(n);
    for (int i = 0; i < n; ++i) {
      x[i] = c.value[row_of[i]];
      // What the fit sees of an input (filled, shrunk towards its mean) is what the residual depends on.
      if (c.role == Role::input) x[i] = get(model.trial(i).blow, *input_of(c.stem));
    }
    lines.push_back({c.name, c.role == Role::other, std::move(x)});
  }
  Eigen::VectorXd order(n);
  for (int i = 0; i < n; ++i) order[i] = model.trial(i).order;
  lines.push_back({"shot", true, std::move(order)});
  return lines;
}

std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const ShotModel& model) {
  std::vector<Line> lines = columns_of(shots, row_of, model);
  const Eigen::VectorXd order = lines.back().x;
  lines.pop_back();
  std::vector<Regressor> all = regressors(shots, row_of, rows, lines, order);
  // Before what only the place in the session drives.
  const auto session =
      std::ranges::find_if(all, [](const Regressor& r) { return r.kind == "step" || r.kind == "oscillation"; });
  std::vector<Regressor> responses;
  add_responses(model, rows, order, responses);
  if (rows.size() >= kFewestRows) add_neighbours(lines, rows, order, responses);
  all.insert(session, std::make_move_iterator(responses.begin()), std::make_move_iterator(responses.end()));
  return all;
}

std::vector<Regressor> regressors(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                  const std::vector<Line>& columns, const Eigen::VectorXd& order) {
  const auto n = order.size();
  std::vector<Regressor> all;
  all.push_back({"constant", "constant", "", false, Eigen::VectorXd::Ones(n)});

  std::vector<Line> lines;
  const auto add_line = [&](const std::string& name, bool foreign, Eigen::VectorXd x) {
    if (!standardise(x, rows)) return;
    x = x.cwiseMax(-4.0).cwiseMin(4.0).eval();  // one wild cell must not be the regressor
    if (!standardise(x, rows)) return;
    lines.push_back({name, foreign, x});
  };
  for (const Line& l : columns) add_line(l.name, l.foreign, l.x);
  add_line("shot", true, order);

  for (const Line& l : lines) all.push_back({l.name, "trend", "", l.foreign, l.x});
  for (const Line& l : lines) {
    Eigen::VectorXd q = l.x.cwiseAbs2();
    if (beside(q, {&l.x}, rows)) all.push_back({l.name, "curvature", "", l.foreign, q});
  }
  const std::size_t most_products = 40;
  std::size_t products = 0;
  for (std::size_t a = 0; a < lines.size(); ++a)
    for (std::size_t b = a + 1; b < lines.size() && products < most_products; ++b) {
      // Unknown columns act on the physics through speed, loft and offsets; two of them together do not.
      if (lines[a].foreign && lines[b].foreign) continue;
      Eigen::VectorXd q = lines[a].x.cwiseProduct(lines[b].x);
      if (!beside(q, {&lines[a].x, &lines[b].x}, rows)) continue;
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
      for (Eigen::Index i = 0; i < n; ++i) x[i] = g.of_row[row_of[i]] == int(k);
      double members = 0;
      for (const int i : rows) members += x[i];
      if (members < 2 || members > double(rows.size()) - 1) continue;
      if (g.name.size() == 2 && k == 1) continue;  // the complement
      if (standardise(x, rows)) all.push_back({c.name, "group", "= " + g.name[k], true, x});
    }
  }

  if (rows.size() >= kFewestRows) {
    for (int k = 1; k < kPartsOfSession; ++k) {
      Eigen::VectorXd x(n);
      for (Eigen::Index i = 0; i < n; ++i) x[i] = order[i] > double(k) / kPartsOfSession;
      if (standardise(x, rows))
        all.push_back(
            {"shot", "step", fmt::format("at {:.0f} % of the session", 100.0 * k / kPartsOfSession), true, x});
    }
    const int fastest = std::clamp(int(rows.size()) / 4, 2, 16);
    // Half periods too: the slow ones need not close over the session.
    for (int half = 2; half <= 2 * fastest; half += half < 12 ? 1 : 2)
      for (const bool sine : {true, false}) {
        Eigen::VectorXd x(n);
        for (Eigen::Index i = 0; i < n; ++i) {
          const double phase = kPi * half * order[i];
          x[i] = sine ? std::sin(phase) : std::cos(phase);
        }
        if (standardise(x, rows))
          all.push_back({"shot", "oscillation", fmt::format("{:g} periods in the session", 0.5 * half), true, x});
      }
    add_turns(shots, row_of, rows, all);
  }
  return all;
}

StructureMap structure(const Problem& problem, const Whitened& view, const Fit& fit, const Fit& near,
                       const std::vector<Regressor>& regressors, const Eigen::MatrixXd& directions,
                       const Rules& rules) {
  const std::vector<int>& rows = view.rows;
  const int n = int(rows.size()), m = problem.width();
  const Eigen::VectorXd z = whitened(problem, Part::select, fit.model, fit.p),
                        noise = whitened(problem, Part::select, near.model, near.p);
  if (!z.size() || !noise.size()) return {};
  const solvers::Loss loss = problem.stages().back().loss;
  Eigen::VectorXd weights(n);
  for (int i = 0; i < n; ++i) weights[i] = loss.weight(noise.segment(std::ptrdiff_t(i) * m, m).squaredNorm());
  const Eigen::MatrixXd Q = orthonormal(problem.jacobian(Part::select, fit.model, fit.p));

  StructureMap map;
  std::vector<Eigen::VectorXf> scores;  // normalised contributions of the shots
  Eigen::VectorXd a(std::ptrdiff_t(n) * m);
  const auto add = [&](int channel, const Regressor* r) {
    const double before = a.norm();
    if (!(before > 0)) return;
    if (Q.cols()) a -= Q * (Q.transpose() * a);
    const double after = a.norm();
    if (after < kAbsorbed * before) return;  // what was fitted absorbs this regressor
    Eigen::VectorXd u(n);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const auto ai = a.segment(std::ptrdiff_t(i) * m, m);
      sum += weights[i] * ai.dot(z.segment(std::ptrdiff_t(i) * m, m));
      u[i] = weights[i] * ai.dot(noise.segment(std::ptrdiff_t(i) * m, m));
    }
    const double norm = u.norm();
    if (!(norm > 0)) return;
    Finding f{.channel = channel, .statistic = sum / norm, .signal = sum / after};
    if (r) f.regressor = r->column, f.kind = r->kind, f.detail = r->detail, f.foreign = r->foreign;
    map.findings.push_back(std::move(f));
    scores.push_back((u / norm).cast<float>());
  };
  for (const Regressor& r : regressors)
    for (int c = 0; c < m; ++c) {
      if (r.channel >= 0 && r.channel != c) continue;
      Eigen::VectorXd value(n);
      for (int i = 0; i < n; ++i) value[i] = r.value[rows[i]];
      a = view.column(c, value);
      add(c, &r);
    }
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    a = directions.col(k);
    add(-1, nullptr);
  }
  const std::size_t plain = scores.size();

  // Neighbours alike: products of standardised residuals of successive shots, in session order.
  const std::vector<int> by_order = rising_order(rows.size(), [&](int i) { return view.order[i]; });
  for (int c = 0; c < m && n >= kFewestRows; ++c) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
    double square = 0;
    for (int k = 0; k + 1 < n; ++k) {
      const int i = by_order[k], j = by_order[k + 1];
      const double x = weights[i] * noise[std::ptrdiff_t(i) * m + c], y = weights[j] * noise[std::ptrdiff_t(j) * m + c];
      u[k] = x * y;
      square += x * x;
    }
    const double norm = u.norm();
    if (!(norm > 0)) continue;
    map.findings.push_back({.channel = c,
                            .regressor = "shot",
                            .kind = "neighbours",
                            .detail = "alike",
                            .foreign = true,
                            .statistic = u.sum() / norm,
                            .signal = u.sum() / std::sqrt(std::max(1.0, square))});
    scores.push_back((u / norm).cast<float>());
  }
  if (map.findings.empty()) return map;

  Eigen::MatrixXf U(n, std::ptrdiff_t(plain)), V(n, std::ptrdiff_t(scores.size() - plain));
  for (std::size_t k = 0; k < scores.size(); ++k)
    (k < plain ? U.col(std::ptrdiff_t(k)) : V.col(std::ptrdiff_t(k - plain))) = scores[k];
  std::mt19937_64 random(1);
  std::vector<double> largest;
  constexpr int batch = 128;
  Eigen::MatrixXf S(batch, n), P(batch, n);
  for (int done = 0; done < rules.flips; done += batch) {
    for (int b = 0; b < batch; ++b) {
      std::uint64_t bits = 0;
      for (int i = 0; i < n; ++i) {
        if (i % 64 == 0) bits = random();
        S(b, i) = (bits >> (i % 64) & 1U) ? 1.0F : -1.0F;
      }
      for (int k = 0; k < n; ++k) P(b, k) = k + 1 < n ? S(b, by_order[k]) * S(b, by_order[k + 1]) : 1.0F;
    }
    const Eigen::MatrixXf A = S * U, B = P * V;
    for (int b = 0; b < batch && done + b < rules.flips; ++b)
      largest.push_back(double(std::max(U.cols() ? A.row(b).cwiseAbs().maxCoeff() : 0.0F,
                                        V.cols() ? B.row(b).cwiseAbs().maxCoeff() : 0.0F)));
  }
  std::ranges::sort(largest);
  bool all = true;
  double least_of_any = kInfinity;
  for (int c = 0; c < m; ++c) {
    all = all && problem.channel(c).trusted();
    least_of_any = std::min(least_of_any, least_signal(problem.channel(c)));
  }
  const auto known = [&](const Finding& f) { return f.channel >= 0 ? problem.channel(f.channel).trusted() : all; };
  double top = 0;
  for (Finding& f : map.findings) {
    const double t = std::abs(f.statistic);
    const auto above = largest.end() - std::ranges::lower_bound(largest, t - 1e-5);
    f.p_adjusted = (1.0 + double(above)) / (1.0 + double(largest.size()));
    if (f.kind == kGain) continue;
    if (std::abs(f.signal) > (f.channel >= 0 ? least_signal(problem.channel(f.channel)) : least_of_any))
      top = std::max(top, t);
    else f.p_adjusted = 1;
  }
  map.p = (1.0 + double(largest.end() - std::ranges::lower_bound(largest, top - 1e-5))) /
          (1.0 + double(largest.size()));
  std::ranges::stable_sort(map.findings, std::ranges::greater{}, [](const Finding& f) { return std::abs(f.signal); });
  Eigen::VectorXd square = Eigen::VectorXd::Zero(m), values = square;
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < m; ++c)
      if (const double x = z[std::ptrdiff_t(i) * m + c]; x != 0)
        square[c] += weights[i] * x * x, values[c] += weights[i];
  // What the channel, or all of them, scatters without the finding; at least what is declared.
  const auto scatter_beside = [&](const Finding& f) {
    const double whole = f.channel < 0 ? square.sum() : square[f.channel],
                 count = f.channel < 0 ? values.sum() : values[f.channel];
    return std::sqrt(std::max(1.0, (whole - f.signal * f.signal) / std::max(1.0, count - 1)));
  };
  for (const Finding& f : map.findings) {
    if (f.kind == kGain || !known(f)) continue;
    map.signal = std::max(map.signal, std::abs(f.signal));
    map.beside = std::max(map.beside, std::abs(f.signal) / scatter_beside(f));
  }
  return map;
}

std::vector<Location> plainest_places(const Problem& problem, const Selection& s) {
  std::vector<Location> told;
  const auto add = [&](const Finding* f) {
    if (!f) return;
    const Location l = place_of(problem, *f);
    const auto same = [&](const Location& k) { return k.channel == l.channel && k.regressor == l.regressor; };
    if (std::ranges::none_of(told, same)) told.push_back(l);
  };
  // Blocks of one player, ball or club after another look like a swing of the session: what the record names says more.
  constexpr double nearly = 0.7;
  const auto names_it = [&](const Finding& f, const Finding& group) {
    return f.regressor == "shot" && group.kind == "group" && group.channel == f.channel &&
           std::abs(group.signal) > nearly * std::abs(f.signal);
  };
  const auto first = [&](const StructureMap& map) -> const Finding* {
    const auto it = std::ranges::find_if(map.findings, [](const Finding& f) { return f.channel >= 0; });
    if (it == map.findings.end()) return nullptr;
    const auto group = std::ranges::find_if(map.findings, [&](const Finding& f) { return names_it(*it, f); });
    return group == map.findings.end() ? &*it : &*group;
  };
  const Finding* left = first(s.after);
  if (!left || !left->foreign) add(first(s.before));
  add(left);
  // What the map shows nearly as plainly may be the driver: few shots do not part correlated columns.
  for (const StructureMap* map : {&s.after, &s.before})
    for (const Finding& f : map->findings)
      if (f.channel >= 0 && told.size() < kMostTold &&
          std::abs(f.signal) > 0.85 * std::abs(map->findings.front().signal) && f.p_adjusted < kTold &&
          std::ranges::none_of(map->findings, [&](const Finding& group) { return names_it(f, group); }))
        add(&f);
  return told;
}

}  // namespace hosel::loop
