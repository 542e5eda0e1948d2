#include "loop/shots/between.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <utility>

#include "golf/dense.hpp"
#include "loop/rules.hpp"
#include "loop/shots/way.hpp"

namespace hosel::loop {
namespace {

constexpr int kFewest = 5, kStretch = 50;  // shots of a group

/// Means of groups, and the variance of each: their shots scatter alike, in `rest` degrees of freedom.
struct Means {
  std::vector<double> mean, variance;
  double rest = 0;

  /// Squares about the common mean over variances that have `between` added.
  double square_sum(double between) const {
    double weights = 0, centre = 0, sum = 0;
    for (std::size_t g = 0; g < mean.size(); ++g) {
      const double w = 1 / (variance[g] + between);
      weights += w;
      centre += w * mean[g];
    }
    centre /= weights;
    for (std::size_t g = 0; g < mean.size(); ++g) sum += std::pow(mean[g] - centre, 2) / (variance[g] + between);
    return sum;
  }

  /// The standard deviation between groups that makes the square sum this large: it falls as that grows. Zero: none
  /// does.
  double deviation(double wanted) const {
    const auto excess = [&](double sd) { return square_sum(sd * sd) - wanted; };
    if (!(excess(0) > 0)) return 0;
    double high = std::sqrt(*std::ranges::max_element(variance));
    while (excess(high) > 0) high *= 4;
    std::uintmax_t evaluations = 100;
    const auto [a, b] = boost::math::tools::toms748_solve(excess, 0.0, high,
                                                          boost::math::tools::eps_tolerance<double>(30), evaluations);
    return 0.5 * (a + b);
  }
};

/// Of what whitened residuals `z` (width x rows) say of a quantity with derivatives `j`, per scale; `w` weights the
/// rows. Of groups of at least `fewest` shots.
Means means(const Eigen::MatrixXd& z, const Eigen::MatrixXd& j, const Eigen::VectorXd& w, const std::vector<int>& group,
            int groups, int fewest) {
  struct Sums {
    double precision = 0, pull = 0, square = 0;
    int shots = 0;
  };
  std::vector<Sums> of(std::size_t(groups), Sums{});
  const Eigen::VectorXd precision = w.cwiseProduct(j.colwise().squaredNorm().transpose()),
                        pull = -w.cwiseProduct(z.cwiseProduct(j).colwise().sum().transpose());
  const auto each = [&](const auto& act) {
    for (Eigen::Index i = 0; i < z.cols(); ++i)
      if (const int g = group[i]; g >= 0 && precision[i] > 0) act(of[g], precision[i], pull[i]);
  };
  each([](Sums& s, double p, double b) { s.precision += p, s.pull += b, ++s.shots; });
  each([](Sums& s, double p, double b) { s.square += std::pow(b - p * s.pull / s.precision, 2) / p; });
  Means out;
  double square = 0;
  for (const Sums& s : of) {
    if (s.shots < fewest) continue;
    out.mean.push_back(s.pull / s.precision);
    out.variance.push_back(1 / s.precision);
    square += s.square;
    out.rest += s.shots - 1;
  }
  for (double& v : out.variance) v *= square / out.rest;
  return out;
}

/// Of rows by one column.
struct Grouping {
  std::string along;
  std::vector<int> of;  // per row; -1: in none
  int groups = 0;
};

/// By every text column and by `by`.
std::vector<Grouping> by_columns(const Shots& shots, const std::vector<int>& row_of, const std::vector<int>& rows,
                                 const std::string& by) {
  std::vector<Grouping> all;
  for (const Column& c : shots.columns) {
    if (c.role == Role::output || (c.numeric && c.name != by)) continue;
    const Groups g = groups(c);
    Grouping own{c.name, {}, int(g.name.size())};
    for (const int i : rows) own.of.push_back(g.of_row[row_of[i]]);
    all.push_back(std::move(own));
  }
  return all;
}

Eigen::VectorXd weights(const Eigen::MatrixXd& z) {
  const solvers::Loss loss = loss_of_shot(int(z.rows()));
  Eigen::VectorXd w(z.cols());
  for (Eigen::Index i = 0; i < z.cols(); ++i) w[i] = loss.weight(z.col(i).squaredNorm());
  return w;
}

/// Errors that the shots of a group share.
class SharedErrors {
 public:
  /// `w` weights the rows; `seen` (width x rows): 1 where a shot has a channel, else 0.
  SharedErrors(const Grouping& grouping, const Eigen::VectorXd& w, const Eigen::MatrixXd& seen)
      : grouping_(grouping), w_(w), seen_(seen) {}

  /// Their variance in each channel, as residuals `z` (width x rows) have it [squared noise units]; also the
  /// probability that groups which do not differ do so as much.
  Eigen::VectorXd learn(const Eigen::MatrixXd& z) {
    const auto width = z.rows();
    variance_ = Eigen::VectorXd::Zero(width);
    p = 1;
    double sum = 0, freedom = 0, rest = 0;
    for (Eigen::Index c = 0; c < width; ++c) {
      Eigen::MatrixXd one = Eigen::MatrixXd::Zero(width, z.cols());
      one.row(c) = seen_.row(c);
      // The scatter is pooled over groups: two shots of one tell of it.
      const Means m = means(z, one, w_, grouping_.of, grouping_.groups, 2);
      if (m.mean.size() < kFewestGroups || !(m.variance.front() > 0)) continue;  // too few have this reading
      const auto own = double(m.mean.size() - 1);
      // Few groups say little of it: at the upper end of one standard error.
      const double low = quantile(boost::math::fisher_f(own, m.rest), 0.16);
      variance_[c] = std::pow(m.deviation(own * low), 2);
      sum += m.square_sum(0);
      freedom += own;
      rest += m.rest;
    }
    if (freedom > 0) p = cdf(complement(boost::math::fisher_f(freedom, rest), sum / freedom));
    return variance_;
  }

  /// Columns `a` (width * rows high) as generalised least squares weighs them.
  Eigen::MatrixXd partly_demeaned(Eigen::MatrixXd a) const {
    const Eigen::Index width = variance_.size();
    for (Eigen::Index c = 0; c < width; ++c) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(grouping_.groups, a.cols());
      Eigen::VectorXd count = Eigen::VectorXd::Zero(grouping_.groups);
      const auto each = [&](const auto& act) {
        for (Eigen::Index i = 0; i < w_.size(); ++i) act(grouping_.of[i], w_[i] * seen_(c, i), a.row(i * width + c));
      };
      each([&](int g, double w, const auto& row) {
        if (g >= 0) sum.row(g) += w * row, count[g] += w;
      });
      each([&](int g, double w, auto&& row) {
        if (g >= 0 && count[g] > 0) row -= (1 - 1 / std::sqrt(1 + count[g] * variance_[c])) / count[g] * sum.row(g);
        row *= std::sqrt(w);
      });
    }
    return a;
  }

  double p = 1;

 private:
  static constexpr std::size_t kFewestGroups = 3;
  const Grouping& grouping_;
  const Eigen::VectorXd& w_;
  const Eigen::MatrixXd& seen_;
  Eigen::VectorXd variance_;
};

}  // namespace

std::vector<GroupSpread> between_groups(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                        const std::vector<int>& rows, const std::string& by, bool session,
                                        const Fit& fit) {
  const auto n = Eigen::Index(rows.size()), width = Eigen::Index(model.width());
  std::vector<Grouping> groupings = by_columns(shots, row_of, rows, by);
  if (session) {
    std::vector<int> stretch(rows.size());
    const auto in_order = rising_order(rows.size(), [&](int i) { return model.trial(rows[i]).order; });
    const int stretches = std::max(1, int(rows.size()) / kStretch);
    for (std::size_t i = 0; i < rows.size(); ++i) stretch[in_order[i]] = int(i * std::size_t(stretches) / rows.size());
    groupings.push_back({"shot", std::move(stretch), stretches});
  }
  if (groupings.empty()) return {};

  const Eigen::MatrixXd z = model.whitened(rows, fit.model, fit.p).reshaped(width, n);
  const Eigen::VectorXd w = weights(z);
  std::vector<GroupSpread> out;
  for (const Way& way : ways(model, shots)) {
    if (way.kind == Way::Kind::input) continue;
    const Fit with = beside(fit, &way.form);
    const Eigen::MatrixXd j = model.jacobian(rows, with.model, with.p).rightCols(1).reshaped(width, n);
    if (!(j.norm() > kNoMotion)) continue;
    const std::optional<Unit> of = split_unit(way.column).unit;
    const double unit = way.form.parameters.front().scale / (of ? of->si : 1);
    for (const Grouping& g : groupings) {
      const Means m = means(z, j, w, g.of, g.groups, kFewest);
      if (m.mean.size() < 2 || !(m.variance.front() > 0)) continue;
      const auto freedom = double(m.mean.size() - 1);
      const boost::math::fisher_f chance(freedom, m.rest);
      out.push_back({.along = g.along,
                     .of = way.kind == Way::Kind::normal       ? "restitution"
                           : way.kind == Way::Kind::tangential ? "tangential_restitution"
                                                               : way.column,
                     .unit = of ? std::string(of->suffix) : "1",
                     .groups = int(m.mean.size()),
                     .sd = unit * m.deviation(freedom),
                     .low = unit * m.deviation(freedom * quantile(chance, 1 - kTold / 2)),
                     .high = unit * m.deviation(freedom * quantile(chance, kTold / 2)),
                     .p = cdf(complement(chance, m.square_sum(0) / freedom))});
    }
  }
  return out;
}

std::optional<Clustered> clustered(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                   const std::vector<int>& rows, const std::string& by, const Fit& base,
                                   const Fit& fit) {
  constexpr int passes = 30;
  const auto n = Eigen::Index(rows.size()), width = Eigen::Index(model.width());
  const Eigen::VectorXd z = model.whitened(rows, fit.model, fit.p), of_base = model.whitened(rows, base.model, base.p);
  const Eigen::MatrixXd J = model.jacobian(rows, fit.model, fit.p);
  const Eigen::VectorXd w = weights(z.reshaped(width, n));
  Eigen::MatrixXd seen(width, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index c = 0; c < width; ++c) seen(c, i) = model.observed(rows[i], int(c)) ? 1 : 0;
  std::optional<Clustered> out;
  double likeliest = Rules{}.gate;
  for (const Grouping& g : by_columns(shots, row_of, rows, by)) {
    SharedErrors shared(g, w, seen);
    // From all that groups differ in to what the effects leave of it.
    Eigen::VectorXd variance = shared.learn(of_base.reshaped(width, n)), step;
    Eigen::MatrixXd covariance;
    for (int pass = 0; pass < passes; ++pass) {
      const Eigen::MatrixXd A = shared.partly_demeaned(J);
      covariance = dense::Ldlt(Eigen::MatrixXd(A.transpose() * A)).inverse();
      step = -covariance * (A.transpose() * shared.partly_demeaned(z));
      const Eigen::VectorXd before = std::exchange(variance, shared.learn((z + J * step).reshaped(width, n)));
      if ((variance - before).cwiseAbs().maxCoeff() < kNothing) break;
    }
    if (!(shared.p < likeliest)) continue;
    likeliest = shared.p;
    const Eigen::VectorXd size = step + fit.p.cwiseQuotient(scales(fit.model));
    const Eigen::Index effects = size.size() - base.size();
    const dense::Ldlt of_effects(Eigen::MatrixXd(covariance.bottomRightCorner(effects, effects)));
    out = Clustered{g.along, size.tail(effects).dot(of_effects.solve(Eigen::VectorXd(size.tail(effects))))};
  }
  return out;
}

}  // namespace hosel::loop
