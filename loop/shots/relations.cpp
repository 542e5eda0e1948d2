#include "loop/shots/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "golf/vector.hpp"
#include "loop/deviation.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

constexpr double kLeastHeld = 0.35;  // of the rows
constexpr std::size_t kMostRelated = 300;

/// y = formula(x, k) on some rows: how many, and how much they stand out.
struct Relation {
  int target = 0;
  std::vector<int> from;
  std::string text;
  double residual = 0;
  int rows = 0, held = 0;
  double evidence = 0;  ///< log-likelihood beyond that of scatter alone
  double score() const { return held - 3.0 * double(from.size()); }
  std::set<int> columns() const { return set_with(from, target); }
};

double up(const Vec3& v) { return std::asin(v.z() / v.norm()); }
double right(const Vec3& v) { return std::atan2(-v.y(), v.x()); }

/// Student's density with four degrees of freedom.
double student(double r, double scale) { return 0.375 / scale * std::pow(1 + r * r / (4 * scale * scale), -2.5); }

/// How much likelier the residuals are where a share of them is nothing but rounding, within t, than where all are
/// scatter: the difference of the two log-likelihoods at their most likely shares and scales. What computes a column
/// leaves an edge at its last digit; scatter of the size of that digit has none.
double edge_evidence(const std::vector<double>& residual, double t) {
  std::vector<double> own(residual.size(), 1.0);  // probability that a row is scatter
  const auto scale_of = [&](double scale) {
    for (int pass = 0; pass < 25; ++pass) {
      double sum = 0, count = 0;
      for (std::size_t i = 0; i < residual.size(); ++i) {
        const double r = residual[i];
        sum += own[i] * 5 / (4 + r * r / (scale * scale)) * r * r;
        count += own[i];
      }
      if (!(sum > 0)) return t;
      scale = std::max(std::sqrt(sum / count), kNothing * t);
    }
    return scale;
  };
  double rms = 0;
  for (const double r : residual) rms += r * r / double(residual.size());
  double scatter = scale_of(std::sqrt(rms)), alone = 0;
  for (const double r : residual) alone += std::log(student(r, scatter));
  double share = 0.5, both = 0;
  const double most = 1 - 1 / (2 * double(residual.size()));
  for (int pass = 0; pass < kPasses; ++pass) {
    double held = 0;
    both = 0;
    for (std::size_t i = 0; i < residual.size(); ++i) {
      const double r = residual[i], rounding = std::abs(r) <= t ? share / (2 * t) : 0,
                   rest = (1 - share) * student(r, scatter);
      both += std::log(rounding + rest);
      held += rounding / (rounding + rest);
      own[i] = rest / (rounding + rest);
    }
    share = std::clamp(held / double(residual.size()), 0.01, most);
    scatter = std::max(scale_of(scatter), t);
  }
  return both - alone;
}

/// Where an interval begins (1) or ends (-1).
using End = std::pair<double, int>;
/// Middle of the stretch that most intervals cover, and how many do; `ends` rising.
End most_covered(const std::vector<End>& ends) {
  double middle = 0;
  int open = 0, most = 0;
  for (std::size_t e = 0; e + 1 < ends.size(); ++e)
    if ((open += ends[e].second) > most) {
      most = open;
      middle = 0.5 * (ends[e].first + ends[e + 1].first);
    }
  return {middle, most};
}

class Relations {
 public:
  explicit Relations(const Shots& shots) {
    const std::vector<std::size_t> rows = evenly(rows_by_value(shots), kMostRelated);
    sources_ = formula_columns(shots, rows, std::max(kFewestToLearn, (rows.size() + 1) / 2));
    // A coarse column cannot show a formula.
    std::erase_if(sources_, [](const FormulaColumn& s) { return !(s.spread() > 5 * s.step()); });
  }

  std::vector<Relation> run() {
    for (int y = 0; y < count(); ++y) {
      scalars(y);
      directions(y);
    }
    // A number that most rows agree on is sought at the ends of all of them.
    const double chance = std::log(double(tried_ + 1)) + std::log(double(2 * rows() + 1));
    std::erase_if(found_, [&](const Relation& r) { return r.evidence < kBeyondChance + chance; });
    // Solved for another of its columns a relation holds on a row more or less, as these are rounded: what an
    // instrument is likely to compute decides between them, not a unit.
    std::map<std::set<int>, double> best;
    for (const Relation& r : found_) {
      const auto known = best.try_emplace(r.columns(), r.score()).first;
      known->second = std::max(known->second, r.score());
    }
    std::ranges::stable_sort(found_, std::ranges::greater{}, [&](const Relation& r) {
      const double most = best.at(r.columns());
      return std::tuple(most, r.score() > kNearlyAll * most, -rank_if_computed(column(r.target)), r.score());
    });
    return found_;
  }
  const std::string& header(int k) const { return source(k).column->name; }
  const Column& column(int k) const { return *source(k).column; }

 private:
  std::vector<FormulaColumn> sources_;
  std::vector<Relation> found_;
  long tried_ = 0;  ///< formulas

  const FormulaColumn& source(int k) const { return sources_[k]; }
  int count() const { return int(sources_.size()); }
  double x(int k, std::size_t row) const { return source(k).x[Eigen::Index(row)]; }
  std::size_t rows() const { return sources_.empty() ? 0 : std::size_t(sources_[0].x.size()); }

  bool same_dimension(int a, int b) const {
    const auto p = split_unit(header(a)).unit, q = split_unit(header(b)).unit;
    return p && q && p->dimension == q->dimension;
  }
  double si(int k) const { return column(k).si; }
  double half_step(int k) const { return 0.5 * source(k).step(); }
  bool divides(int k) const { return may_divide(at_share(source(k).rising, 0.05), at_share(source(k).rising, 0.95)); }
  /// A number and the header that it multiplies, as they stand in the units of the headers: none where it is one.
  std::string times(double number, int k, int y) const {
    number *= si(k) / si(y);
    return std::abs(number - 1) < kRoundOff ? header(k) : fmt::format("{:.5g} * {}", number, header(k));
  }
  std::string plus(double number, int k, int y) const {
    number *= si(k) / si(y);
    if (std::abs(std::abs(number) - 1) < kRoundOff) return fmt::format("{} {}", number < 0 ? '-' : '+', header(k));
    return fmt::format("{:+.5g} * {}", number, header(k));
  }

  struct Residual {
    std::size_t row;
    double value;
  };
  /// Do so many of the residuals lie within rounding that scatter would not? Rows that repeat (one value per cluster,
  /// zeros where nothing was read) count once.
  void judge(int y, const std::vector<int>& from, const std::string& text, const std::vector<Residual>& residual) {
    ++tried_;
    const double t = half_step(y) * 1.02 + kRoundOff * source(y).spread();
    const auto within = [&](const Residual& r) { return std::abs(r.value) <= t; };
    const int rows = int(std::ranges::count_if(residual, within));
    if (residual.size() < kFewestToLearn || rows < kLeastHeld * double(residual.size())) return;
    std::set<std::vector<double>> seen;
    std::set<double> values;
    std::vector<double> distinct;
    double square = 0;
    for (const Residual& r : residual) {
      if (within(r)) {
        square += r.value * r.value;
        values.insert(x(y, r.row));
      }
      std::vector<double> key{x(y, r.row)};
      for (const int k : from) key.push_back(x(k, r.row));
      if (seen.insert(std::move(key)).second) distinct.push_back(r.value);
    }
    if (values.size() < kFewestDifferent || distinct.size() < kFewestToLearn) return;
    const double evidence = edge_evidence(distinct, t);
    if (evidence > kBeyondChance)
      found_.push_back({y, from, text, std::sqrt(square / rows), int(residual.size()), rows, evidence});
  }

  /// y = u + k v: the number that most rows agree on, to rounding.
  template <class U, class V>
  void linear(int y, const std::vector<int>& from, std::optional<double> known, U&& u, V&& v, auto&& text) {
    std::vector<End> ends;
    struct Part {
      std::size_t row;
      double a, b;  // y - u, v
    };
    std::vector<Part> parts;
    const double t = half_step(y);
    for (std::size_t i = 0; i < rows(); ++i) {
      const double a = x(y, i) - u(i), b = v(i);
      if (!std::isfinite(a) || !std::isfinite(b) || b == 0) continue;
      parts.push_back({i, a, b});
      ends.emplace_back(a / b - t / std::abs(b), 1);
      ends.emplace_back(a / b + t / std::abs(b), -1);
    }
    if (parts.size() < kFewestToLearn) return;
    double k = known.value_or(0);
    if (!known) {
      std::ranges::sort(ends, {}, &End::first);
      const End agreed = most_covered(ends);
      if (agreed.second < kLeastHeld * double(parts.size())) return;
      k = agreed.first;
    }
    std::vector<Residual> residual;
    for (const auto& [row, a, b] : parts) residual.push_back({row, a - k * b});
    judge(y, from, text(k), residual);
  }

  void scalars(int y) {
    const auto one = [](std::size_t) { return 1.0; };
    const auto zero = [](std::size_t) { return 0.0; };
    for (int a = 0; a < count(); ++a) {
      if (a == y) continue;
      const auto xa = [&, a](std::size_t i) { return x(a, i); };
      linear(y, {a}, {}, zero, xa, [&](double k) { return fmt::format("{:.5g} * {}", k * si(a) / si(y), header(a)); });
      if (same_dimension(y, a))
        linear(y, {a}, {}, xa, one, [&](double k) { return fmt::format("{} {:+.5g}", times(1, a, y), k / si(y)); });
      for (int b = 0; b < count(); ++b) {
        if (b == y || b == a) continue;
        const auto xb = [&, b](std::size_t i) { return x(b, i); };
        if (a < b)
          linear(
              y, {a, b}, {}, zero, [&](std::size_t i) { return x(a, i) * x(b, i); },
              [&](double k) {
                return fmt::format("{:.5g} * {} * {}", k * si(a) * si(b) / si(y), header(a), header(b));
              });
        if (divides(b))
          linear(
              y, {a, b}, {}, zero, [&](std::size_t i) { return x(a, i) / x(b, i); },
              [&](double k) {
                return fmt::format("{:.5g} * {} / {}", k * si(a) / si(b) / si(y), header(a), header(b));
              });
        if (same_dimension(a, b)) {
          // A mean of the two, or one beyond the other.
          linear(
              y, {a, b}, {}, xb, [&](std::size_t i) { return x(a, i) - x(b, i); },
              [&](double k) { return fmt::format("{} {}", times(k, a, y), plus(1 - k, b, y)); });
          linear(
              y, {a, b}, 1.0, xa, [&](std::size_t i) { return -x(b, i); },
              [&](double) { return fmt::format("{} {}", times(1, a, y), plus(-1, b, y)); });
          if (a < b)
            linear(y, {a, b}, 1.0, xa, xb, [&](double) { return fmt::format("{} {}", times(1, a, y), plus(1, b, y)); });
        } else if (same_dimension(y, a)) {
          linear(y, {a, b}, {}, xa, xb, [&](double k) { return fmt::format("{} {}", times(1, a, y), plus(k, b, y)); });
        }
        if (!same_dimension(y, a)) continue;
        for (int c = 0; c < count(); ++c)
          if (c != y && c != a && c != b && divides(c))
            linear(
                y, {a, b, c}, {}, xa, [&](std::size_t i) { return x(b, i) / x(c, i); },
                [&](double k) {
                  return fmt::format("{} {:+.5g} * {} / {}", times(1, a, y), k * si(b) / si(c) / si(y), header(b),
                                     header(c));
                });
      }
    }
  }

  int of(std::string_view stem) const {
    for (int k = 0; k < count(); ++k)
      if (column(k).stem == stem && column(k).role != Role::other) return k;
    return -1;
  }

  /// y = value(row, k) [SI], the number between 0.4 and 1.1 that most rows agree on.
  void directed(int y, const std::vector<int>& from, bool free, const std::string& text, auto&& value) {
    const double t = half_step(y);
    const auto miss = [&](std::size_t i, double k) { return x(y, i) - value(i, k); };
    std::vector<std::size_t> good;
    for (std::size_t i = 0; i < rows(); ++i)
      if (std::isfinite(miss(i, 0.8))) good.push_back(i);
    if (good.size() < kFewestToLearn) return;
    double k = 1;
    if (free) {
      std::vector<End> ends;
      for (const std::size_t i : good) {
        double at = 0.8, slope = 0;
        for (int pass = 0; pass < 6; ++pass) {
          slope = (miss(i, at + 1e-5) - miss(i, at - 1e-5)) / 2e-5;
          at -= std::clamp(miss(i, at) / slope, -0.2, 0.2);
        }
        if (!(at > 0.4 && at < 1.1)) continue;
        ends.emplace_back(at - t / std::abs(slope), 1);
        ends.emplace_back(at + t / std::abs(slope), -1);
      }
      std::ranges::sort(ends);
      const End agreed = most_covered(ends);
      if (agreed.second < kLeastHeld * double(good.size())) return;
      k = agreed.first;
    }
    std::vector<Residual> residual;
    for (const std::size_t i : good) residual.push_back({i, miss(i, k)});
    judge(y, from, free ? fmt::format("{}, k = {:.4g}", text, k) : text, residual);
  }

  /// The face's normal, the club's direction and the ball's: b ~ k n + (1 - k) v, and the spin square to n and v.
  void directions(int y) {
    const int loft = of("dynamic_loft"), face = of("face_angle"), attack = of("attack_angle"), path = of("club_path"),
              launch = of("launch_angle"), azimuth = of("azimuth"), back = of("backspin"), side = of("sidespin");
    if (attack < 0 || path < 0) return;
    const auto club = [&](std::size_t i) { return direction(x(attack, i), x(path, i)); };
    if (loft >= 0 && face >= 0 && launch >= 0 && azimuth >= 0) {
      const auto normal = [&](std::size_t i, double k) {
        return Vec3(direction(x(launch, i), x(azimuth, i)) - (1 - k) * club(i));
      };
      const auto ball = [&](std::size_t i, double k) {
        return Vec3(k * direction(x(loft, i), x(face, i)) + (1 - k) * club(i));
      };
      const char* from_ball = "direction of ball - (1 - k) club";
      const char* from_face = "direction of k face + (1 - k) club";
      if (y == loft)
        directed(y, {face, launch, azimuth, attack, path}, true, from_ball,
                 [&](auto i, double k) { return up(normal(i, k)); });
      if (y == face)
        directed(y, {loft, launch, azimuth, attack, path}, true, from_ball,
                 [&](auto i, double k) { return right(normal(i, k)); });
      if (y == launch)
        directed(y, {azimuth, loft, face, attack, path}, true, from_face,
                 [&](auto i, double k) { return up(ball(i, k)); });
      if (y == azimuth)
        directed(y, {launch, loft, face, attack, path}, true, from_face,
                 [&](auto i, double k) { return right(ball(i, k)); });
    }
    if (loft < 0 || face < 0) return;
    const auto normal = [&](std::size_t i) { return direction(x(loft, i), x(face, i)); };
    const auto spin = [&](std::size_t i) { return Vec3(club(i).cross(normal(i))); };
    const std::vector<int> planes{loft, face, attack, path};
    const char* square = "spin square to face and club";
    if (column(y).stem == "spin_axis")
      directed(y, planes, false, square, [&](auto i, double) {
        const Vec3 w = spin(i);
        return std::atan2(-w.z(), -w.y());
      });
    if (y == side && back >= 0)
      directed(y, {loft, face, attack, path, back}, false, square,
               [&](auto i, double) { return x(back, i) * spin(i).z() / spin(i).y(); });
    if (y == back && side >= 0)
      directed(y, {loft, face, attack, path, side}, false, square,
               [&](auto i, double) { return x(side, i) * spin(i).y() / spin(i).z(); });
    if (const auto unit = split_unit(header(y)).unit;
        column(y).role == Role::other && unit && unit->dimension == Dimension::angle)
      directed(y, planes, false, "angle between face and club: the spin loft",
               [&](auto i, double) { return std::acos(std::clamp(normal(i).dot(club(i)), -1.0, 1.0)); });
  }
};

}  // namespace

std::vector<DerivedColumn> partly_derived(const Shots& shots, const std::vector<DerivedColumn>& whole) {
  Relations relations(shots);
  std::vector<DerivedColumn> told;
  for (const Relation& r : relations.run()) {
    std::set<std::string> columns;
    for (const int k : r.columns()) columns.insert(relations.header(k));
    // A relation can be solved for any column in it: the likeliest, then nothing that follows from it on the same rows.
    const auto follows = [&](const DerivedColumn& d) {
      const auto common = [&](const std::string& name) { return columns.contains(name); };
      return d.column == relations.header(r.target) || std::ranges::count_if(d.from, common) + common(d.column) >= 2;
    };
    if (std::ranges::any_of(whole, follows) || std::ranges::any_of(told, follows)) continue;
    std::vector<std::string> from;
    for (const int k : r.from) from.push_back(relations.header(k));
    told.push_back(derived_column(relations.column(r.target), std::move(from), r.text, r.residual));
    told.back().rows = r.held;
    told.back().share = double(r.held) / double(r.rows);
  }
  return told;
}

}  // namespace hosel::loop
