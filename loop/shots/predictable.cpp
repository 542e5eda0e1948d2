#include "loop/shots/audit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "golf/dense.hpp"
#include "loop/deviation.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kLeastRows = 40;
constexpr std::ptrdiff_t kRowsFitted = 5;     // rows for every coefficient,
constexpr std::ptrdiff_t kRowsPerNumber = 7;  // of those that a function holds on: fewer agree by chance,
constexpr std::ptrdiff_t kRowsIfPlain = 3;    // and fewer to far less than the noise
constexpr double kLeastOfRows = 0.25;         // some rows of very many agree with one of so many functions
constexpr std::size_t kMostColumns = 4;
constexpr double kBadRows = 0.1;        // so many may depart from what holds on all rows
constexpr double kLessThanNoise = 0.2;  // of the declared noise: less scatter is none that was declared too large
constexpr double kPart = 0.35;          // of its scatter a part of the rows that is chosen for it keeps of noise

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// y = f(columns) within `scatter` on a share of the rows.
struct Smooth {
  int of = 0;
  std::vector<int> from;
  int degree = 2;
  VectorXd coefficients, weight;  ///< of the terms; probability of each row that f holds there
  double scatter = 1, share = 0.8;
  double likelihood = 0;  ///< log
  double evidence = 0;    ///< log-likelihood beyond that of the same with no less scatter than noise allows
  double gain = 0;        ///< the same beyond a plane through all columns, less what the free numbers cost
  bool plain = false;     ///< it scatters far less than noise

  std::set<int> columns() const { return set_with(from, of); }
};

class Predictable {
 public:
  Predictable(const Shots& shots, const std::map<std::string, double>& noise, const std::set<std::string>& left_out) {
    std::vector<std::size_t> rows = rows_by_value(shots);
    for (const Column& c : shots.columns) {
      if (!c.numeric || c.role == Role::bookkeeping || left_out.contains(c.name)) continue;
      const auto good = std::ranges::count_if(c.value, [](double x) { return std::isfinite(x); });
      if (double(good) >= kNearlyAll * double(shots.rows())) columns_.push_back(&c);
    }
    std::erase_if(rows, [&](std::size_t row) {
      return std::ranges::any_of(columns_, [&](const Column* c) { return !std::isfinite(c->value[row]); });
    });
    complete_ = rows.size();
    if (complete_ < kLeastRows) columns_.clear();
    rows = evenly(rows, kRowsAsked);
    n_ = std::ptrdiff_t(rows.size());
    const auto m = std::ptrdiff_t(columns_.size());
    z_.resize(n_, m);
    sd_.resize(m);
    error_.resize(m);
    rounding_.resize(m);
    told_.resize(columns_.size());
    for (std::ptrdiff_t k = 0; k < m; ++k) {
      const Column& c = *columns_[k];
      for (std::ptrdiff_t i = 0; i < n_; ++i) z_(i, k) = c.value[rows[i]];
      const auto declared = noise.find(c.name);
      const double own = declared == noise.end() ? 0 : declared->second * c.si;
      z_.col(k).array() -= z_.col(k).mean();
      sd_[k] = std::sqrt(z_.col(k).squaredNorm() / double(n_));
      if (!(sd_[k] > 0)) sd_[k] = 1;  // a constant: a column of zeros, which foretells nothing
      z_.col(k) /= sd_[k];
      rounding_[k] = rounding_deviation(c.resolution) / sd_[k];
      error_[k] = std::hypot(own / sd_[k], rounding_[k]);
      told_[k] = own > 0 && error_[k] < 0.5;  // else nothing can be told from its noise
    }
  }

  /// The column that is likeliest a function of others.
  std::optional<DerivedColumn> likeliest() {
    const auto m = int(columns_.size());
    if (m < 3) return {};
    std::vector<Smooth> all;
    for (int y = 0; y < m; ++y)
      if (told_[y])
        for (Smooth& f : functions_of_others(y)) all.push_back(std::move(f));
    const double chance = std::log(double(tried_));
    const auto shown = [&](const Smooth& f) {
      const bool enough = f.weight.sum() >= double((f.plain ? kRowsIfPlain : kRowsPerNumber) * f.coefficients.size());
      return f.gain > chance && f.evidence > kBeyondChance + chance && enough && f.share > kLeastOfRows ? f.gain
                                                                                                        : -kInfinity;
    };
    const auto found = std::ranges::max_element(all, {}, shown);
    if (found == all.end() || !std::isfinite(shown(*found))) return {};
    // A relation may be solved for any of its columns: the one that was computed scatters least.
    const std::set<int> related = found->columns();
    const auto best = std::ranges::max_element(
        all, {}, [&](const Smooth& f) { return std::ranges::includes(related, f.columns()) ? f.gain : -kInfinity; });
    const int column = best->of;
    const Column& c = *columns_[column];
    std::vector<std::string> from;
    for (const int k : best->from) from.push_back(columns_[k]->name);
    const std::string formula = fmt::format("a smooth function of {}", fmt::join(from, ", "));
    DerivedColumn d = derived_column(c, std::move(from), formula, best->scatter * sd_[column]);
    d.share = best->share > 1 - kBadRows ? 1 : best->share;
    d.rows = int(std::lround(d.share * double(complete_)));
    return d;
  }

 private:
  std::vector<const Column*> columns_;
  std::size_t complete_ = 0;
  std::ptrdiff_t n_ = 0;
  MatrixXd z_;                      ///< rows x columns, each of mean 0 and deviation 1
  VectorXd sd_, error_, rounding_;  ///< SI; in standard deviations
  std::vector<char> told_;
  std::size_t tried_ = 0;

  /// Columns of every term of a polynomial: {} is 1, {0, 0, 2} the first squared by the third.
  static std::vector<std::vector<std::size_t>> terms(std::size_t columns, int degree) {
    std::vector<std::vector<std::size_t>> all{{}};
    for (std::size_t from = 0; degree > 0; --degree) {
      const std::size_t to = all.size();
      for (; from < to; ++from)
        for (std::size_t k = all[from].empty() ? 0 : all[from].back(); k < columns; ++k) {
          all.push_back(all[from]);
          all.back().push_back(k);
        }
    }
    return all;
  }

  MatrixXd features(const std::vector<int>& from, int degree) const {
    const auto all = terms(from.size(), degree);
    MatrixXd a = MatrixXd::Ones(n_, std::ptrdiff_t(all.size()));
    for (std::size_t t = 0; t < all.size(); ++t)
      for (const std::size_t k : all[t]) a.col(std::ptrdiff_t(t)).array() *= z_.col(from[k]).array();
    return a;
  }

  /// Of y, by its least-squares combination of these columns.
  static ArrayXd left_by(const MatrixXd& a, const VectorXd& y) {
    MatrixXd gram = a.transpose() * a;
    gram.diagonal().array() += 1e-8 * gram.trace() / double(a.cols());
    return (y - a * dense::Ldlt(gram).solve(VectorXd(a.transpose() * y))).array();
  }

  /// Variance of y - f that such errors of all columns make, in the mean over the rows where f holds.
  double variance_by(const VectorXd& error, const Smooth& f) const {
    const auto all = terms(f.from.size(), f.degree);
    double sum = error[f.of] * error[f.of];
    for (std::size_t q = 0; q < f.from.size(); ++q) {
      ArrayXd slope = ArrayXd::Zero(n_);
      for (std::size_t t = 0; t < all.size(); ++t)
        for (std::size_t factor = 0; factor < all[t].size(); ++factor) {
          if (all[t][factor] != q) continue;
          ArrayXd rest = ArrayXd::Constant(n_, f.coefficients[std::ptrdiff_t(t)]);
          for (std::size_t other = 0; other < all[t].size(); ++other)
            if (other != factor) rest *= z_.col(f.from[all[t][other]]).array();
          slope += rest;
        }
      sum += (f.weight.array() * slope.square()).sum() / f.weight.sum() * std::pow(error[f.from[q]], 2);
    }
    return sum;
  }

  /// So many steps of expectation and maximisation: f on a share of the rows, `elsewhere` (log-density) on the others.
  void improve(Smooth& f, const MatrixXd& a, const VectorXd& y, const ArrayXd& elsewhere, int steps,
               double least_scatter) const {
    const auto p = a.cols();
    for (int step = 0; step < steps; ++step) {
      const bool first = f.coefficients.size() == 0;
      const MatrixXd weighted = f.weight.asDiagonal() * a;
      MatrixXd gram = weighted.transpose() * a;
      gram.diagonal().array() += 1e-8 * gram.trace() / double(p);
      f.coefficients = dense::Ldlt(gram).solve(VectorXd(weighted.transpose() * y));
      const ArrayXd r = (y - a * f.coefficients).array();
      const double rows = f.weight.sum();
      const double free = std::max(rows - double(p), 1.0);
      f.scatter = rows > double(p) + 2 ? std::sqrt((f.weight.array() * r.square()).sum() / free) : 1;
      // The fit to all rows is drawn to those where f does not hold.
      if (first) f.scatter *= 0.7;
      f.scatter = std::max(f.scatter, least_scatter);
      const ArrayXd here = -0.5 * (r / f.scatter).square() - std::log(f.scatter) - kLogRootTwoPi + std::log(f.share);
      const ArrayXd there = elsewhere + std::log(1 - f.share), most = here.max(there);
      const ArrayXd both = most + ((here - most).exp() + (there - most).exp()).log();
      f.likelihood = both.sum();
      f.weight = (here - both).exp().matrix();
      f.share = std::clamp(f.weight.mean(), 0.05, 0.99);
    }
  }

  /// The likeliest functions of other columns that `target` may be, with their evidence where they leave it less
  /// scatter than noise allows.
  std::vector<Smooth> functions_of_others(int target) {
    const VectorXd y = z_.col(target);
    std::vector<int> others;
    for (int k = 0; k < int(columns_.size()); ++k)
      if (k != target) others.push_back(k);
    MatrixXd plane(n_, std::ptrdiff_t(others.size()) + 1);
    plane.col(0).setOnes();
    for (std::size_t k = 0; k < others.size(); ++k) plane.col(std::ptrdiff_t(k) + 1) = z_.col(others[k]);
    const ArrayXd apart = left_by(plane, y);
    const double scatter =
        std::max(std::sqrt(apart.square().sum() / std::max(1.0, double(n_ - plane.cols()))), error_[target]);
    const ArrayXd elsewhere = -0.5 * (apart / scatter).square() - std::log(scatter) - kLogRootTwoPi;
    const double numbers = std::log(double(n_)) / 2, by_plane = elsewhere.sum() - numbers * double(plane.cols());

    // All sets of up to three columns, the likeliest three with a fourth.
    std::vector<std::vector<int>> sets;
    for (std::size_t i = 0; i < others.size(); ++i) {
      sets.push_back({others[i]});
      for (std::size_t j = i + 1; j < others.size(); ++j) {
        sets.push_back({others[i], others[j]});
        for (std::size_t k = j + 1; k < others.size(); ++k) sets.push_back({others[i], others[j], others[k]});
      }
    }
    tried_ += sets.size();
    std::vector<Smooth> found = settled(target, y, elsewhere, sets);
    sets.clear();
    std::set<std::vector<int>> larger;
    for (const Smooth& f : found)
      if (f.from.size() + 1 == kMostColumns && larger.size() < 4 * others.size())
        for (const int k : others)
          if (std::ranges::find(f.from, k) == f.from.end()) {
            std::vector<int> more = f.from;
            more.push_back(k);
            std::ranges::sort(more);
            larger.insert(more);
          }
    sets.assign(larger.begin(), larger.end());
    tried_ += sets.size();
    for (Smooth& f : settled(target, y, elsewhere, sets)) found.push_back(std::move(f));

    std::erase_if(found, [&](Smooth& f) {
      f.gain -= by_plane + 2 * numbers;
      // Noise with heavy tails has a core so narrow: Student's of three degrees of freedom.
      const double declared = std::sqrt(variance_by(error_, f)), allowed = declared / std::sqrt(3);
      if (!(f.scatter < allowed)) return !(f.gain > 0);
      Smooth measured = f;
      const MatrixXd a = features(f.from, f.degree);
      improve(measured, a, y, elsewhere, 10, allowed);
      f.evidence = f.likelihood - measured.likelihood;
      f.plain = f.scatter < kLessThanNoise * declared;
      // Where one function of all rows leaves less than the declared noise, and a part of them no less than a part of
      // noise does, noise was declared too large.
      const ArrayXd r = left_by(a, y);
      const double all_rows = std::sqrt(r.square().sum() / std::max(1.0, double(n_ - a.cols())));
      return all_rows < 0.7 * declared && all_rows > kLessThanNoise * declared && f.scatter > kPart * all_rows &&
             all_rows > 3 * std::sqrt(variance_by(rounding_, f));
    });
    return found;
  }

  /// The likeliest functions of these sets of columns: all of them a few steps, the foremost to their ends.
  std::vector<Smooth> settled(int target, const VectorXd& y, const ArrayXd& elsewhere,
                              const std::vector<std::vector<int>>& sets) const {
    // Of columns on coarse grids some rows agree more closely than the last digit allows: by chance.
    const double numbers = std::log(double(n_)) / 2,
                 least = std::max(kNothing * std::max(error_[target], kNothing), rounding_[target]);
    std::vector<Smooth> all;
    for (const std::vector<int>& from : sets) {
      const MatrixXd a = features(from, 2);
      if (n_ < kRowsFitted * a.cols()) continue;
      Smooth f{.of = target, .from = from, .degree = 2, .coefficients = {}, .weight = VectorXd::Ones(n_)};
      improve(f, a, y, elsewhere, 10, least);
      f.gain = f.likelihood - numbers * double(a.cols());
      all.push_back(std::move(f));
    }
    std::ranges::stable_sort(all, std::ranges::greater{}, &Smooth::gain);
    if (all.size() > 40) all.resize(40);
    for (Smooth& f : all)
      for (const int degree : {2, 3}) {
        const MatrixXd a = features(f.from, degree);
        if (n_ < kRowsFitted * a.cols()) continue;
        Smooth finer = f;
        finer.degree = degree;
        improve(finer, a, y, elsewhere, 20, least);
        finer.gain = finer.likelihood - numbers * double(a.cols());
        if (degree == 2 || finer.gain > f.gain) f = std::move(finer);
      }
    std::ranges::stable_sort(all, std::ranges::greater{}, &Smooth::gain);
    return all;
  }
};

}  // namespace

std::vector<DerivedColumn> predictable(const Shots& shots, const std::map<std::string, double>& noise,
                                       const std::vector<DerivedColumn>& known) {
  std::set<std::string> left_out;
  for (const DerivedColumn& d : known) left_out.insert(d.column);
  std::vector<DerivedColumn> told;
  while (std::optional<DerivedColumn> d = Predictable(shots, noise, left_out).likeliest()) {
    left_out.insert(d->column);
    told.push_back(std::move(*d));
  }
  return told;
}

}  // namespace hosel::loop
