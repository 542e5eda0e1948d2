#include "loop/shots/audit.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "golf/dense.hpp"
#include "loop/deviation.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

/// One source term of a formula: a column, or a ratio or product of two.
struct Term {
  int a = 0, b = -1;
  char how = ' ';  ///< ' ', '/', '*'
};

struct Source : FormulaColumn {
  double noise;  ///< declared, SI; 0: none
  bool fine;     ///< enough different values to show a formula with free numbers
};

/// Its value where `of` gives that of a source by its number.
double evaluate(const Term& f, const auto& of) {
  if (f.how == '/') return of(f.a) / of(f.b);
  if (f.how == '*') return of(f.a) * of(f.b);
  return of(f.a);
}

double evaluate(const Term& f, const std::vector<Source>& s, Eigen::Index i) {
  return evaluate(f, [&](int k) { return s[k].x[i]; });
}

/// What one of a term in the units of its headers is in SI.
double term_unit(const Term& f, const std::vector<Source>& s) {
  return evaluate(f, [&](int k) { return s[k].column->si; });
}

std::string term_name(const Term& f, const std::vector<Source>& s) {
  const std::string& a = s[f.a].column->name;
  if (f.how == ' ') return a;
  return fmt::format("{} {} {}", a, f.how, s[f.b].column->name);
}

constexpr double kOutsideEdge = 2 * kBeyondChance;  // price of a row outside, as a deviance

struct Formula {
  std::string text;
  std::set<int> from;    ///< sources
  double residual = 0;   ///< root mean square on rows that were not fitted, without the worst tenth
  double tolerance = 0;  ///< what rounding of all columns allows
  double trimmed = 1;    ///< what is left of that without the worst tenth
  double declared = 0;   ///< what the declared noise of its columns makes of it; 0: none declares any
  int rows = 0;
  int beyond = 0;   ///< rows that miss by more than the column's own last digit and by no more than all rounding
  int outside = 0;  ///< rows that miss by more than all last digits together allow, and by no more than four times that
  bool one_rounds = false;  ///< rounding of one column outweighs that of all others
  double cost = 0;          ///< less is likelier, as a deviance: misfit beyond rounding, terms, and who computes what
  double direction = 0;     ///< the same between the columns that one relation may be solved for
  /// A relation that may be solved for any of its columns is of the same form for each.
  enum class Form { linear, powers, other } form = Form::other;
};

bool same_relation(int target, const Formula& f, int other, const Formula& g) {
  if (target == other) return true;
  return f.form == g.form && f.form != Formula::Form::other && set_with(f.from, target) == set_with(g.from, other);
}

/// What monitors and players compute from two columns, SI.
struct Identity {
  std::string_view of;  ///< name of the result; empty: any column that no model knows
  std::string_view a, b;
  const char* text;
  double (*value)(double, double);
};
constexpr auto kLength = [](double a, double b) { return std::hypot(a, b); };
constexpr auto kDifference = [](double a, double b) { return a - b; };
constexpr Identity kIdentities[] = {
    {"spin_rate", "backspin", "sidespin", "hypot(backspin, sidespin)", kLength},
    {"spin_axis", "sidespin", "backspin", "atan2(sidespin, backspin)",
     [](double a, double b) { return std::atan2(a, b); }},
    {"backspin", "spin_rate", "spin_axis", "spin_rate cos(spin_axis)",
     [](double a, double b) { return a * std::cos(b); }},
    {"sidespin", "spin_rate", "spin_axis", "spin_rate sin(spin_axis)",
     [](double a, double b) { return a * std::sin(b); }},
    {"", "impact_toe", "impact_high", "hypot(impact_toe, impact_high)", kLength},
    {"", "ball_speed", "club_speed", "ball_speed / club_speed: the smash factor",
     [](double a, double b) { return a / b; }},
    {"", "dynamic_loft", "attack_angle", "dynamic_loft - attack_angle: the spin loft", kDifference},
    {"", "face_angle", "club_path", "face_angle - club_path: the face to the path", kDifference},
};

/// All but a twentieth on either side lies between these.
std::pair<double, double> bulk(std::vector<double> x) {
  std::ranges::sort(x);
  const std::size_t beyond = x.size() / 20;
  return {x[beyond], x[x.size() - 1 - beyond]};
}

/// What is left of a deviation without the worst tenth: of noise, and more of one rounding alone.
constexpr double kTrimmedNoise = 0.79, kTrimmedRounding = 0.9;

/// Root mean square of all but the worst tenth: a few bad rows must not hide an identity.
double trimmed_rms(std::vector<double> r) {
  if (r.empty()) return kInfinity;
  for (double& x : r) x *= x;
  std::ranges::sort(r);
  const std::size_t keep = std::max<std::size_t>(1, r.size() - r.size() / 10);
  return std::sqrt(std::accumulate(r.begin(), r.begin() + std::ptrdiff_t(keep), 0.0) / double(keep));
}

class Audit {
 public:
  Audit(const Shots& shots, const Ball& ball, const std::map<std::string, double>& noise) : ball_(ball) {
    // Long sets: an evenly spread sample is enough to find a formula.
    const std::size_t step = std::max<std::size_t>(1, shots.rows() / 1500);
    std::vector<std::size_t> rows;
    const std::vector<std::size_t> sorted = rows_by_value(shots);
    for (std::size_t i = 0; i < sorted.size(); i += step) rows.push_back(sorted[i]);
    for (FormulaColumn& c : formula_columns(shots, rows, kFewestRows)) {
      const std::size_t different = std::set<double>(c.rising.begin(), c.rising.end()).size();
      if (different < 4 || !(c.spread() > 0)) continue;
      const auto declared = noise.find(c.column->name);
      const double own = declared == noise.end() ? 0 : declared->second * c.column->si;
      sources_.push_back({std::move(c), own, different >= kFewestDifferent});
    }
  }

  std::vector<DerivedColumn> run() {
    std::vector<DerivedColumn> found;
    std::set<int> gone;
    const auto accept = [&](int target, const Formula& f) {
      std::vector<std::string> from;
      for (const int k : f.from) from.push_back(source(k).column->name);
      found.push_back(derived_column(*source(target).column, std::move(from), f.text, f.residual));
      found.back().rows = f.rows;
      gone.insert(target);
    };
    // Formulas of the field first, magnitudes before components.
    for (const bool component : {false, true})
      for (int target = 0; target < int(sources_.size()); ++target) {
        const Source& y = source(target);
        const bool part = y.column->stem == "backspin" || y.column->stem == "sidespin";
        if (part != component || y.spread() < 3 * y.step()) continue;
        Formula f;
        if (identity(target, sources_for(target, gone, false), f)) accept(target, f);
      }
    // Then the likeliest unknown formula over all columns, again and again.
    std::map<int, Formula> best;
    std::set<int> stale;
    for (int k = 0; k < int(sources_.size()); ++k) stale.insert(k);
    for (;;) {
      for (const int target : stale) {
        const Source& y = source(target);
        best.erase(target);
        // Coarse columns cannot show a formula with free numbers.
        if (gone.contains(target) || !y.fine || y.spread() < 12 * y.step()) continue;
        if (Formula f; search(target, sources_for(target, gone, true), f)) best[target] = f;
      }
      if (best.empty()) return found;
      const auto likeliest =
          std::ranges::min_element(best, {}, [&](const auto& b) { return b.second.cost + 6 * rank(b.first); });
      const auto [target, formula] = *std::ranges::min_element(best, {}, [&](const auto& b) {
        return same_relation(likeliest->first, likeliest->second, b.first, b.second)
                   ? b.second.direction + 6 * rank(b.first)
                   : kInfinity;
      });
      accept(target, formula);
      stale = {target};
      for (const auto& [other, f] : best)
        if (f.from.contains(target)) stale.insert(other);
    }
  }

 private:
  const Ball ball_;
  std::vector<Source> sources_;

  std::vector<int> sources_for(int target, const std::set<int>& gone, bool fine) const {
    std::vector<int> use;
    for (int k = 0; k < int(sources_.size()); ++k)
      if (k != target && !gone.contains(k) && (!fine || source(k).fine)) use.push_back(k);
    return use;
  }

  const Source& source(int k) const { return sources_[k]; }
  int rank(int k) const { return rank_if_computed(*source(k).column); }

  bool divides(int k) const {
    const auto [low, high] = bulk(source(k).rising);
    return may_divide(low, high);
  }

  int of(std::string_view stem, const std::vector<int>& use) const {
    for (const int k : use)
      if (source(k).column->stem == stem) return k;
    return -1;
  }

  /// Residual of so many rows over what rounding leaves, at most: what is computed has rounding alone, to four standard
  /// errors of a scatter, and to a fifth for constants of the instrument's own. Noise of coarse columns is little more.
  /// Where their noise is declared, `rounding_alone` decides, and a formula of the instrument's own may be a curve.
  static double most_by_rounding(const Formula& f, std::size_t rows) {
    return (f.declared > 0 ? 1 : f.trimmed) * std::clamp(1 + 4 / std::sqrt(2.0 * double(rows)), 1.2, 1.6);
  }

  /// Rounding alone is likelier than the noise that its columns declare, with or without rounding, beyond chance: a
  /// ball that rolls obeys a relation too, and coarse columns that are measured miss it by little more than rounding.
  static bool rounding_alone(const Formula& f, std::size_t rows, double spread) {
    // Beside one coarse column the size of the misses says little, since what is measured with less noise than it is
    // rounded obeys the physics as well. Rounding has an edge, noise has none.
    if (f.one_rounds && f.outside > kByChance * double(rows)) return false;
    if (!(f.declared > 0)) return true;
    const auto likelihood = [](double deviation, double scatter) {
      return -std::log(scatter) - 0.5 * std::pow(deviation / scatter, 2);
    };
    const double rounding = f.tolerance + kRoundOff * spread, noise = f.residual / kTrimmedNoise;
    const double scatter = std::clamp(noise, std::max(f.declared, rounding), std::hypot(f.declared, rounding));
    const double by_rounding = likelihood(f.residual / f.trimmed, rounding), by_noise = likelihood(noise, scatter);
    return double(rows) * (by_rounding - by_noise) > kBeyondChance;
  }

  /// Judges y = f(sources): rounding of every column passed through f by differences.
  template <class F>
  bool judge(int target, const std::set<int>& from, int parameters, const std::vector<Eigen::Index>& rows, F&& f,
             Formula& out) const {
    const Source& y = source(target);
    if (rows.empty()) return false;
    std::vector<double> residual, edges, wobbles, noises, uneven, x(sources_.size());
    for (const Eigen::Index i : rows) {
      for (const int k : from) x[k] = source(k).x[i];
      residual.push_back(y.x[i] - f(x));
    }
    out.residual = trimmed_rms(residual);
    // More than the largest tolerance below allows: most formulas end here.
    const double finer = parameters ? 12 : 6;
    if (!(out.residual < (1.6 / finer + 2e-9) * y.spread())) return false;
    for (const Eigen::Index i : rows) {
      for (const int k : from) x[k] = source(k).x[i];
      const auto variance_by = [&](int k, double deviation) {
        const double at = x[k];
        x[k] = at + deviation;
        const double up = f(x);
        x[k] = at - deviation;
        const double change = (up - f(x)) / 2;
        x[k] = at;
        return change * change;
      };
      double wobble = std::pow(rounding_deviation(y.step()), 2), squares = wobble * wobble, noise = y.noise * y.noise,
             outermost = 0.5 * y.step();
      for (const int k : from) {
        const double by = variance_by(k, rounding_deviation(source(k).step()));
        outermost += std::sqrt(3 * by);
        wobble += by;
        squares += by * by;
        noise += variance_by(k, source(k).noise);
      }
      edges.push_back(outermost);
      wobbles.push_back(wobble);
      noises.push_back(noise);
      // The tails of a sum of roundings: by its kurtosis between those of one of them and of noise.
      uneven.push_back(wobble > 0 ? squares / (wobble * wobble) : 1);
    }
    // The typical row: a few rows next to a singularity of f must not excuse the others.
    out.tolerance = std::sqrt(median(std::move(wobbles)));
    out.declared = std::sqrt(median(std::move(noises)));
    const double share = median(std::move(uneven));
    out.trimmed = kTrimmedNoise + (kTrimmedRounding - kTrimmedNoise) * share;
    out.one_rounds = y.column->role != Role::other && share > kNearlyAll;
    out.from = from;
    // The numbers of the formula are fitted: the edge is not sharper than they are.
    const double fitted = kRoundOff * y.spread() + 2 * out.residual * std::sqrt(parameters / double(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double outermost = edges[i] + fitted, miss = std::abs(residual[i]);
      out.outside += miss > outermost && miss < 4 * outermost;
    }
    const double edge = y.step() / 2 + fitted;
    out.beyond = int(std::ranges::count_if(
        residual, [&](double r) { return std::abs(r) > edge && std::abs(r) < 4 * out.tolerance; }));
    // Within rounding, and rounding itself far below how the column varies: the less so, the fewer numbers are free.
    return out.residual < most_by_rounding(out, rows.size()) * out.tolerance + kRoundOff * y.spread() &&
           out.tolerance * finer < y.spread();
  }

  std::vector<Eigen::Index> complete(int target, const std::set<int>& from) const {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < sources_[0].x.size(); ++i) {
      bool good = std::isfinite(source(target).x[i]);
      for (const int k : from) good = good && std::isfinite(source(k).x[i]);
      if (good) rows.push_back(i);
    }
    return rows;
  }

  /// Formulas of the field without free numbers.
  bool identity(int target, const std::vector<int>& use, Formula& best) const {
    const Column& y = *source(target).column;
    // `given`: columns state the same twice, whatever is declared of their noise.
    const double spread = source(target).spread();
    const auto attempt = [&](const std::set<int>& from, bool given, std::string text, auto f) {
      const auto rows = complete(target, from);
      if (rows.size() < kFewestRows) return false;
      Formula out;
      if (!judge(target, from, 0, rows, f, out) || (!given && !rounding_alone(out, rows.size(), spread))) return false;
      out.text = std::move(text);
      out.rows = int(rows.size());
      best = out;
      return true;
    };
    using V = const std::vector<double>&;
    for (const Identity& i : kIdentities) {
      const int a = of(i.a, use), b = of(i.b, use);
      if ((i.of.empty() ? y.role == Role::other : y.stem == i.of) && a >= 0 && b >= 0 &&
          attempt({a, b}, true, i.text, [&](V x) { return i.value(x[a], x[b]); }))
        return true;
    }
    const int back = of("backspin", use), rate = of("spin_rate", use), launch = of("launch_angle", use),
              speed = of("ball_speed", use);
    const int spin = back >= 0 ? back : rate;
    if (y.stem == "dynamic_loft" && launch >= 0 && speed >= 0 && spin >= 0) {
      const double arm = ball_.inertia_factor * ball_.radius;
      if (attempt({launch, speed, spin}, false,
                  fmt::format("launch angle + asin({:.4g} m * spin / ball speed): the loft of a rolling ball", arm),
                  [&](V x) {
                    const double rim = arm * x[spin] / x[speed];
                    return x[launch] + std::asin(std::clamp(rim, -1.0, 1.0));
                  }))
        return true;
    }
    return false;
  }

  /// Fits y to one, two or three features on every second row and judges it on the others.
  bool search(int target, const std::vector<int>& use, Formula& best) const {
    const Source& y = source(target);
    bool found = false;
    const auto consider = [&](const std::vector<Term>& features, bool logarithmic) {
      std::set<int> from;
      for (const Term& f : features) {
        from.insert(f.a);
        if (f.b >= 0) from.insert(f.b);
      }
      auto rows = complete(target, from);
      const auto p = std::ptrdiff_t(features.size()) + 1;
      if (std::ptrdiff_t(rows.size()) < 10 + 5 * p) return false;
      // Rows that repeat (one value per cluster) count once.
      const auto needed = std::size_t(8 + 4 * p);
      std::set<std::vector<double>> distinct;
      for (const Eigen::Index i : rows) {
        if (distinct.size() == needed) break;
        std::vector<double> key;
        for (const int k : from) key.push_back(source(k).x[i]);
        distinct.insert(std::move(key));
      }
      if (distinct.size() < needed) return false;
      const auto transform = [&](double x) { return logarithmic ? std::log(std::abs(x)) : x; };
      std::vector<Eigen::Index> fitted, judged;
      for (std::size_t k = 0; k < rows.size(); ++k) (k % 2 ? judged : fitted).push_back(rows[k]);
      Eigen::VectorXd c = Eigen::VectorXd::Zero(p), weight = Eigen::VectorXd::Ones(std::ptrdiff_t(fitted.size()));
      const auto n = std::ptrdiff_t(fitted.size());
      Eigen::MatrixXd A(n, p);
      Eigen::VectorXd b(n);
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        A(i, 0) = 1;
        for (std::ptrdiff_t j = 1; j < p; ++j) A(i, j) = transform(evaluate(features[j - 1], sources_, fitted[i]));
        b[i] = transform(y.x[fitted[i]]);
      }
      if (!A.allFinite() || !b.allFinite()) return false;
      Eigen::VectorXd unit = A.colwise().norm().transpose();
      for (std::ptrdiff_t j = 0; j < p; ++j)
        if (!(unit[j] > 0)) return false;
      A = A * unit.cwiseInverse().asDiagonal();
      for (int pass = 0; pass < 6; ++pass) {
        const Eigen::MatrixXd G = A.transpose() * weight.asDiagonal() * A;
        const Eigen::VectorXd rhs = A.transpose() * weight.asDiagonal() * b;
        c = dense::Ldlt(G + 1e-13 * Eigen::MatrixXd::Identity(p, p)).solve(rhs);
        // Redescending: a tenth of the rows may be bad.
        const Eigen::VectorXd r = (b - A * c).cwiseAbs();
        const double fence = 4 * std::max(median(std::vector<double>(r.data(), r.data() + n)), 1e-14);
        bool settled = true;
        for (std::ptrdiff_t i = 0; i < n; ++i) {
          const double w = r[i] < fence ? 1 : 0;
          settled = settled && w == weight[i];
          weight[i] = w;
        }
        if (weight.sum() < double(2 * p)) return false;
        if (settled) break;
      }
      c = c.cwiseQuotient(unit);
      Formula out;
      const auto f = [&](const std::vector<double>& x) {
        double sum = c[0];
        for (std::ptrdiff_t j = 1; j < p; ++j)
          sum += c[j] * transform(evaluate(features[j - 1], [&](int k) { return x[k]; }));
        return logarithmic ? std::exp(sum) : sum;
      };
      // It must hold on the rows that it was fitted to as well: the fence could leave out those that it missed.
      Formula again;
      if (!judge(target, from, int(p), judged, f, out) || !judge(target, from, int(p), fitted, f, again)) return false;
      out.outside += again.outside;
      if (!(std::hypot(out.residual, again.residual) <
            std::sqrt(2.0) * most_by_rounding(out, rows.size()) * out.tolerance + kRoundOff * y.spread()) ||
          !rounding_alone(out, rows.size(), y.spread()))
        return false;
      // Every term must matter: a source that could be left out is no source.
      for (std::ptrdiff_t j = 1; j < p; ++j) {
        const auto [lo, hi] =
            range_of(judged, [&](Eigen::Index i) { return c[j] * transform(evaluate(features[j - 1], sources_, i)); });
        const double scale = logarithmic ? y.x.cwiseAbs().maxCoeff() : 1;
        if ((hi - lo) * scale < 4 * out.tolerance) return false;
      }
      out.rows = int(rows.size());
      // Numbers as they stand in the units of the headers.
      const auto unit_of = [&](std::ptrdiff_t j) { return term_unit(features[j - 1], sources_); };
      const double own_unit = y.column->si;
      if (logarithmic) {
        double number = std::exp(c[0]) / own_unit;
        for (std::ptrdiff_t j = 1; j < p; ++j) number *= std::pow(unit_of(j), c[j]);
        out.text = fmt::format("{:.5g}", number);
        for (std::ptrdiff_t j = 1; j < p; ++j)
          out.text += fmt::format(" * ({})^{:.4g}", term_name(features[j - 1], sources_), c[j]);
      } else {
        out.text = fmt::format("{:.5g}", c[0] / own_unit);
        for (std::ptrdiff_t j = 1; j < p; ++j)
          out.text += fmt::format(" {:+.5g} * {}", c[j] * unit_of(j) / own_unit, term_name(features[j - 1], sources_));
      }
      // Few rows do not part formulas whose sources go together (club speed and ball speed): then the simpler one is
      // taken, and for an input one of outputs alone, since an instrument computes what it does not see from what it
      // sees. Each counts as e^3 times as likely.
      const bool seen = y.column->role == Role::input &&
                        std::ranges::all_of(from, [&](int k) { return source(k).column->role == Role::output; });
      const auto composite = std::ranges::count_if(features, [](const Term& g) { return g.b >= 0; });
      const double own = rounding_deviation(y.step()) + kRoundOff * y.spread();
      const double all_rounding = out.tolerance + kRoundOff * y.spread(),
                   share = std::pow(out.residual / all_rounding, 2), terms = 6 * double(p + composite - seen),
                   n_judged = double(judged.size());
      out.cost = n_judged * (share - 1 + 2 * std::log(std::max(1.0, out.residual / own))) + terms;
      // Between the columns of a relation the rounding of all of them is no evidence. That one of them is missed by
      // nothing but its own rounding is: it was computed from the others as they stand. Nor does an instrument compute
      // what is made of the others' last digits: twice their rounding counts as one more term.
      const double uniform = std::log(2 * std::sqrt(3.0) * own / all_rounding) - kLogRootTwoPi;
      out.form = composite ? Formula::Form::other : logarithmic ? Formula::Form::powers : Formula::Form::linear;
      out.direction = n_judged * (share - 1) + terms + 6 * std::log2(all_rounding / own) +
                      std::min(0.0, n_judged * (2 * uniform - share) + kOutsideEdge * out.beyond);
      if (!found || out.cost < best.cost) best = out;
      found = true;
      return true;
    };

    std::vector<Term> raw, all;
    for (const int k : use) raw.push_back({k, -1, ' '});
    all = raw;
    for (std::size_t i = 0; i < use.size(); ++i)
      for (std::size_t j = 0; j < use.size(); ++j) {
        if (i == j) continue;
        if (divides(use[j])) all.push_back({use[i], use[j], '/'});
        if (i < j) all.push_back({use[i], use[j], '*'});
      }
    // Fewest terms first: a formula found is not improved by more columns.
    for (const Term& f : all) consider({f}, false);
    std::vector<Term> logs;  // columns that have a logarithm
    for (const Term& f : raw)
      if (divides(f.a)) logs.push_back(f);
    if (!divides(target)) logs.clear();
    for (const Term& f : logs) consider({f}, true);
    if (found) return true;
    for (const auto& [f, g] : promising(target, all)) consider({f, g}, false);
    for (const bool logarithmic : {false, true}) {
      const std::vector<Term>& of = logarithmic ? logs : raw;
      for (std::size_t i = 0; i < of.size(); ++i)
        for (std::size_t j = i + 1; j < of.size(); ++j) consider({of[i], of[j]}, logarithmic);
    }
    if (found) return true;
    for (const bool logarithmic : {false, true}) {
      const std::vector<Term>& of = logarithmic ? logs : raw;
      for (std::size_t i = 0; i < of.size(); ++i)
        for (std::size_t j = i + 1; j < of.size(); ++j)
          for (std::size_t k = j + 1; k < of.size(); ++k) consider({of[i], of[j], of[k]}, logarithmic);
    }
    return found;
  }

  /// Pairs of features whose joint correlation with y is near one on the complete rows.
  std::vector<std::pair<Term, Term>> promising(int target, const std::vector<Term>& all) const {
    std::vector<Eigen::VectorXd> columns;
    std::vector<const Term*> kept;
    std::set<int> everything;
    for (const Term& f : all) everything.insert(f.a);
    const std::vector<Eigen::Index> rows =
        evenly(complete(target, everything), kRowsAsked);  // in the order of their values
    if (rows.size() < 25) return {};                       // missing cells: only plain columns are tried
    const auto n = std::ptrdiff_t(rows.size());
    const auto ranks = [&](auto&& value) {
      Eigen::VectorXd v(n);
      for (std::ptrdiff_t i = 0; i < n; ++i) v[i] = value(rows[i]);
      const auto [lo, hi] = bulk({v.data(), v.data() + n});
      v = v.cwiseMax(lo).cwiseMin(hi);  // bad rows drawn in
      v.array() -= v.mean();
      return Eigen::VectorXd(v / std::max(v.norm(), kTiny));
    };
    for (const Term& f : all) {
      const Eigen::VectorXd v = ranks([&](Eigen::Index i) { return evaluate(f, sources_, i); });
      if (!v.allFinite()) continue;
      columns.push_back(v);
      kept.push_back(&f);
    }
    const Eigen::VectorXd y = ranks([&](Eigen::Index i) { return source(target).x[i]; });
    Eigen::MatrixXd X(n, std::ptrdiff_t(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) X.col(std::ptrdiff_t(k)) = columns[k];
    const Eigen::MatrixXd G = X.transpose() * X;
    const Eigen::VectorXd b = X.transpose() * y;
    struct Pair {
      double r2;
      std::size_t i, j;
    };
    std::vector<Pair> good;
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (std::size_t j = i + 1; j < columns.size(); ++j) {
        const double g = G(std::ptrdiff_t(i), std::ptrdiff_t(j)), det = 1 - g * g;
        if (det < kFaint) continue;
        const double bi = b[std::ptrdiff_t(i)], bj = b[std::ptrdiff_t(j)];
        const double r2 = (bi * bi + bj * bj - 2 * g * bi * bj) / det;
        if (r2 > 0.9) good.push_back({r2, i, j});
      }
    std::ranges::stable_sort(good, std::ranges::greater{}, &Pair::r2);
    if (good.size() > 60) good.resize(60);
    std::vector<std::pair<Term, Term>> out;
    for (const Pair& p : good) out.emplace_back(*kept[p.i], *kept[p.j]);
    return out;
  }
};

}  // namespace

std::vector<FormulaColumn> formula_columns(const Shots& shots, const std::vector<std::size_t>& rows,
                                           std::size_t fewest) {
  std::vector<FormulaColumn> all;
  for (const Column& c : shots.columns) {
    if (!c.numeric || c.role == Role::bookkeeping) continue;
    FormulaColumn f{&c, Eigen::VectorXd(Eigen::Index(rows.size())), {}};
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double x = f.x[Eigen::Index(k)] = c.value[rows[k]];
      if (std::isfinite(x)) f.rising.push_back(x);
    }
    if (f.rising.size() < fewest) continue;
    std::ranges::sort(f.rising);
    all.push_back(std::move(f));
  }
  return all;
}

bool may_divide(double low, double high) {
  constexpr double factor = 8;  // between them, about
  return low * high > 0 && std::max(std::abs(low), std::abs(high)) < factor * std::min(std::abs(low), std::abs(high));
}

int rank_if_computed(const Column& c) {
  if (c.role == Role::other) return 0;
  if (c.role == Role::input) return c.stem == "dynamic_loft" ? 1 : 2;
  return c.stem == "spin_rate" || c.stem == "spin_axis" ? 3 : 4;
}

DerivedColumn derived_column(const Column& y, std::vector<std::string> from, std::string formula, double residual) {
  return {.column = y.name,
          .from = std::move(from),
          .formula = std::move(formula),
          .residual_sd = residual / y.si,
          .recording_resolution = y.resolution / y.si,
          .input = y.role == Role::input};
}

std::vector<DerivedColumn> audit(const Shots& shots, const Ball& ball, const std::map<std::string, double>& noise) {
  std::vector<DerivedColumn> found = Audit(shots, ball, noise).run();
  std::ranges::move(partly_derived(shots, found), std::back_inserter(found));
  std::ranges::move(predictable(shots, noise, found), std::back_inserter(found));
  return found;
}

}  // namespace hosel::loop
