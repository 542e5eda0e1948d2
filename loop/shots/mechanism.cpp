#include "loop/shots/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "golf/dense.hpp"
#include "golf/first_contact.hpp"
#include "golf/parallel.hpp"
#include "loop/rules.hpp"
#include "loop/shots/way.hpp"
#include "solvers/kriging.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kKnots = 150;  // rows whose covariance makes a basis

/// Functions of one quantity: each a basis over the rows with the variance of its coefficients, a level apart. The
/// basis is orthonormal over the knots.
struct Field {
  std::string along;
  bool place = false, step = false;  ///< over the place of impact; one step in the session
  struct Basis {
    Eigen::MatrixXd phi;       // rows x terms
    Eigen::VectorXd variance;  // mean variance over the knots is one
  };
  std::vector<Basis> smoothness;
};

/// The leading terms of a covariance between rows and knots, which are some of the rows, its level taken out. Over the
/// other rows its eigenfunctions are continued by the covariance [@gp-ml].
Field::Basis basis(const Eigen::MatrixXd& covariance, const std::vector<int>& knots) {
  constexpr Eigen::Index most = 12;
  const Eigen::RowVectorXd mean = covariance(knots, Eigen::all).colwise().mean();
  Eigen::MatrixXd centred = covariance;
  centred.rowwise() -= mean;
  centred.colwise() -= covariance.rowwise().mean();
  centred.array() += mean.mean();
  const dense::Eigenpairs all = dense::eigenpairs(centred(knots, Eigen::all));
  const Eigen::Index terms =
      std::clamp<Eigen::Index>((all.values.array() > kFaint * all.values.maxCoeff()).count(), 1, most);
  const Eigen::VectorXd values = all.values.tail(terms).cwiseMax(0);
  Field::Basis b{centred * all.vectors.rightCols(terms), values};
  for (Eigen::Index k = 0; k < terms; ++k) b.phi.col(k) /= std::max(values[k], kTiny);
  const double whole = b.variance.sum() / double(knots.size());
  if (whole > 0) b.variance /= whole;
  return b;
}

constexpr std::string_view kIncidence = "angle of incidence";

/// Between the head's velocity where it meets the ball and the face's normal [rad]: what the contact sees of loft,
/// attack angle, face and path.
Eigen::VectorXd incidence(const ShotModel& model) {
  Eigen::VectorXd x(model.shots());
  for (int i = 0; i < model.shots(); ++i) {
    const FirstContact at = first_contact(model.trial(i).blow);
    x[i] = std::atan2(at.slip().norm(), at.approach.dot(at.normal));
  }
  return x;
}

std::vector<Field> fields(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                          const std::vector<int>& rows, bool session) {
  const auto n = Eigen::Index(rows.size());
  const auto scaled = [&](const Eigen::VectorXd& x) {
    Eigen::VectorXd out(n);
    for (Eigen::Index i = 0; i < n; ++i) out[i] = x[rows[i]];
    double sum = 0, count = 0;
    for (const double v : out)
      if (std::isfinite(v)) sum += v, ++count;
    for (double& v : out) v = (std::isfinite(v) ? v : sum / count) - sum / count;
    const double sd = std::sqrt(out.squaredNorm() / double(n));
    return Eigen::VectorXd(varies(sd, sum / count) ? out / (2 * sd) : Eigen::VectorXd());
  };
  std::vector<int> every(rows.size());
  std::iota(every.begin(), every.end(), 0);
  const std::vector<int> knots = evenly(every, kKnots);
  std::vector<Field> all;
  /// Between each row and each knot.
  const auto covariance = [&](auto&& value) {
    Eigen::MatrixXd K(n, Eigen::Index(knots.size()));
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < K.cols(); ++j) K(i, j) = value(i, Eigen::Index(knots[j]));
    return K;
  };
  const auto smooth_covariance = [&](const std::vector<Eigen::VectorXd>& x, double length) {
    Eigen::ArrayXXd square = Eigen::ArrayXXd::Zero(n, Eigen::Index(knots.size()));
    for (const Eigen::VectorXd& v : x)
      square += ((v.replicate(1, square.cols()).rowwise() - v(knots).transpose()).array() / length).square();
    return Eigen::MatrixXd(solvers::matern(square));
  };
  const auto smooth = [&](std::string along, const std::vector<Eigen::VectorXd>& x, bool place) {
    Field f{.along = std::move(along), .place = place};
    for (const double length : {0.5, 1.0, 2.0, 4.0}) f.smoothness.push_back(basis(smooth_covariance(x, length), knots));
    all.push_back(std::move(f));
  };
  Eigen::VectorXd toe, high;
  std::vector<Eigen::MatrixXd> steps;  // covariances of one step each
  for (const Line& line : columns_of(shots, row_of, model)) {
    const Eigen::VectorXd x = scaled(line.x);
    if (!x.size() || (line.name == "shot" && !session)) continue;
    if (const Column* c = shots.find(line.name)) {
      if (c->stem == stem(Input::impact_toe)) toe = x;
      if (c->stem == stem(Input::impact_high)) high = x;
    }
    smooth(line.name, {x}, false);
    if (line.name != "shot") continue;
    const auto product = [&](auto i, auto j) { return x[i] * x[j]; };
    all.push_back({.along = line.name, .smoothness = {basis(covariance(product), knots)}});  // a steady drift
    // A walk: steps and slow wander.
    const double first = x.minCoeff();
    const auto walk = [&](auto i, auto j) { return std::min(x[i], x[j]) - first; };
    (all.end() - 2)->smoothness.push_back(basis(covariance(walk), knots));
    // One step, wherever it is: no drift.
    Field step{.along = line.name, .step = true};
    std::vector<double> sorted(x.begin(), x.end());
    std::ranges::sort(sorted);
    constexpr Eigen::Index places = 15;
    for (Eigen::Index k = 1; k <= places; ++k) {
      const double from = sorted[k * n / (places + 1)];
      steps.push_back(covariance([&](auto i, auto j) { return double(x[i] >= from && x[j] >= from); }));
      step.smoothness.push_back(basis(steps.back(), knots));
    }
    all.push_back(std::move(step));
  }
  if (const Eigen::VectorXd x = scaled(incidence(model)); x.size()) smooth(std::string(kIncidence), {x}, false);
  if (toe.size() && high.size()) {
    smooth(shots.find_stem(stem(Input::impact_toe))->name, {toe, high}, true);
    // A step that differs over the place of impact: a crack, a weight come loose.
    Field damage{.along = "shot", .step = true};
    const Eigen::MatrixXd even = smooth_covariance({toe, high}, 1).array() + 1;
    for (const Eigen::MatrixXd& step : steps) damage.smoothness.push_back(basis(step.cwiseProduct(even), knots));
    if (!steps.empty()) all.push_back(std::move(damage));
  }
  for (const Column& c : shots.columns) {
    if (c.numeric || c.role == Role::output) continue;
    const Groups g = groups(c);
    if (g.name.size() < 2 || g.name.size() > kMostGroups) continue;
    const auto group = [&](auto i) { return g.of_row[row_of[rows[i]]]; };
    const auto same = [&](auto i, auto j) { return double(group(i) == group(j)); };
    all.push_back({.along = c.name, .smoothness = {basis(covariance(same), knots)}});
  }
  return all;
}

/// The function of largest posterior density for one way and one basis, over a grid of amplitudes.
struct Found {
  double fall = -kInfinity;  ///< of -2 log evidence, with the weights given
  Eigen::VectorXd g;         ///< per row, in the way's scale
  double price = 0;          ///< of the function: prior and determinant
};

/// `z` (width x rows) whitened residuals, `j` their derivatives by the way, `w` the weights of the rows.
Found likeliest(const Eigen::MatrixXd& z, const Eigen::MatrixXd& j, const Eigen::VectorXd& w, const Field& field) {
  const Eigen::Index n = z.cols();
  const Eigen::VectorXd precision = w.cwiseProduct(j.colwise().squaredNorm().transpose()),
                        pull = -w.cwiseProduct(z.cwiseProduct(j).colwise().sum().transpose());
  const double typical = precision.mean();
  if (!(typical > 0)) return {};
  Found best;
  std::vector<double> falls;
  for (const Field::Basis& b : field.smoothness) {
    const Eigen::Index terms = b.phi.cols();
    Eigen::MatrixXd phi(n, terms + 1);
    phi << Eigen::VectorXd::Ones(n), b.phi;
    const Eigen::MatrixXd A = phi.transpose() * precision.asDiagonal() * phi;
    const Eigen::VectorXd rhs = phi.transpose() * pull;
    for (const double level : {0.0, 0.1, 0.4, 1.6, 6.4, 25.0})
      for (const double size : {0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8, 25.6}) {
        // Standard deviations in noise units of a typical shot.
        Eigen::VectorXd root(terms + 1);
        root << level, size * b.variance.cwiseSqrt();
        root /= std::sqrt(typical);
        const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(terms + 1, terms + 1) +
                                  root.asDiagonal() * A * root.asDiagonal();
        const dense::Cholesky factor(M);
        const Eigen::VectorXd scaled = root.cwiseProduct(rhs), solved = factor.solve(scaled);
        const double determinant = factor.log_determinant();
        const double fall = scaled.dot(solved) - determinant;
        falls.push_back(fall);
        if (fall > best.fall) {
          best.fall = fall;
          best.g = phi * root.cwiseProduct(solved);
          best.price = solved.squaredNorm() + determinant;
        }
      }
  }
  // The evidence is the mean over the grid, not its largest.
  double mean = 0;
  for (const double f : falls) mean += std::exp(0.5 * (f - best.fall)) / double(falls.size());
  best.price -= 2 * std::log(mean);
  best.fall += 2 * std::log(mean);
  return best;
}

/// From each record to the mean over these rows [SI]; a missing one is at it.
Eigen::VectorXd towards_mean(const Column& column, const std::vector<int>& row_of, const std::vector<int>& rows) {
  Eigen::VectorXd x(Eigen::Index(rows.size()));
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    x[Eigen::Index(i)] = column.value[row_of[rows[i]]];
    if (std::isfinite(x[Eigen::Index(i)])) sum += x[Eigen::Index(i)], ++count;
  }
  for (double& v : x) v = std::isfinite(v) ? sum / count - v : 0;
  return x;
}

/// What noise of inputs does to whitened residuals (width x rows), by its shares in their variances of largest
/// posterior density, none below zero. `by`: of each input, by a share of one; `w` as above.
Eigen::MatrixXd by_noise(const Eigen::MatrixXd& z, const std::vector<Eigen::MatrixXd>& by, const Eigen::VectorXd& w) {
  constexpr double usual = 0.05;  // an error of a quarter of the spread
  const Eigen::VectorXd root = w.cwiseSqrt(), seen = (z * root.asDiagonal()).reshaped();
  Eigen::MatrixXd columns(z.size(), Eigen::Index(by.size()));
  for (std::size_t k = 0; k < by.size(); ++k)
    columns.col(Eigen::Index(k)) = usual * (by[k] * root.asDiagonal()).reshaped();
  std::vector<Eigen::Index> used(by.size());
  std::iota(used.begin(), used.end(), Eigen::Index(0));
  Eigen::VectorXd share;
  for (bool again = true; again && !used.empty();) {
    const Eigen::MatrixXd C = columns(Eigen::all, used);
    const auto n = Eigen::Index(used.size());
    const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n) + C.transpose() * C;
    share = dense::Cholesky(A).solve(Eigen::VectorXd(-C.transpose() * seen));
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 0; k < n; ++k)
      if (share[k] > 0) kept.push_back(used[k]);
    again = kept.size() < used.size();
    used = std::move(kept);
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(z.rows(), z.cols());
  for (std::size_t k = 0; k < used.size(); ++k) out += usual * share[Eigen::Index(k)] * by[used[k]];
  return out;
}

/// Whether a function hardly varies: what it is called by is its level.
bool level(const Eigen::VectorXd& g) {
  constexpr double varies_by = 0.05;  // of its square
  return (g.array() - g.mean()).square().sum() < varies_by * g.squaredNorm();
}

bool monotone(const Eigen::VectorXd& g, const std::vector<double>& order) {
  const auto by = rising_order<std::size_t>(order.size(), [&](std::size_t i) { return order[i]; });
  double way = 0, path = 0;
  for (std::size_t i = 1; i < by.size(); ++i) {
    const double d = g[Eigen::Index(by[i])] - g[Eigen::Index(by[i - 1])];
    way += d;
    path += std::abs(d);
  }
  return std::abs(way) > kNearlyAll * path;
}

/// The effects that such a function is.
std::vector<std::string> names_of(const Way& way, const Field& field, const Shots& shots, bool steady) {
  const Column* along = shots.find(field.along);
  const auto is = [&](Input i) { return along && along->stem == stem(i); };
  using Through = OneFunction::Through;
  std::optional<OneFunction> function;
  if (field.place || is(Input::impact_toe) || is(Input::impact_high)) function.emplace().of = OneFunction::Of::place;
  else if (is(Input::club_speed) || is(Input::dynamic_loft) || is(Input::attack_angle) || field.along == kIncidence)
    function.emplace();
  if (function) switch (way.kind) {
      case Way::Kind::normal: function->through = Through::normal_restitution; break;
      case Way::Kind::tangential: function->through = Through::tangential_restitution; break;
      case Way::Kind::input:
        if (way.column == field.along && is(Input::dynamic_loft)) function->through = Through::recorded_loft;
        break;
      case Way::Kind::reading: break;
    }
  std::vector<std::string> names;
  for (const EffectEntry& e : effects())
    if (function && function->through != Through::several && e.function == *function) names.emplace_back(e.name);
  if (names.empty() && field.along == "shot" && steady && !field.step) return {"session-drift"};
  return names;
}

}  // namespace

std::vector<Mechanism> mechanisms(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                                  const std::vector<int>& rows, bool session, const std::set<std::string>& noisy,
                                  const Fit& base, const Fit& chosen, const Rules& rules) {
  const auto n = Eigen::Index(rows.size()), width = Eigen::Index(model.width());
  if (n < kFewestRows) return {};
  const solvers::Loss loss = loss_of_shot(model.width());
  const Eigen::MatrixXd z = model.whitened(rows, base.model, base.p).reshaped(width, n),
                        after = model.whitened(rows, chosen.model, chosen.p).reshaped(width, n);
  // The deviance of residuals as fits count it, and the weights by it.
  const auto weighed = [&](const Eigen::MatrixXd& of, Eigen::VectorXd& w) {
    double deviance = 0;
    w.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double square = of.col(i).squaredNorm();
      w[i] = loss.weight(square);
      deviance += loss(square);
    }
    return deviance;
  };
  Eigen::VectorXd weight, w;
  const double of_chosen = weighed(after, weight);
  const std::vector<Way> every = ways(model, shots);
  const std::vector<Field> functions = fields(model, shots, row_of, rows, session);
  std::vector<double> order;
  for (const int i : rows) order.push_back(model.trial(i).order);

  struct Trial {
    std::size_t way, field;
    Found found;
  };
  std::vector<Eigen::MatrixXd> columns(every.size());
  for_all(std::size_t(0), every.size(), [&](std::size_t k) {
    const Fit with = beside(base, &every[k].form);
    columns[k] = model.jacobian(rows, with.model, with.p).rightCols(1).reshaped(width, n);
  });
  // Inputs that declare no noise have some: a record is in the mean too far from the mean of all, by the share of noise
  // in their variance. What that takes up is no function. Names had no such help: beside them there is none.
  const bool alone = chosen.size() == base.size();
  std::vector<Eigen::MatrixXd> shrinks;
  for (std::size_t k = 0; alone && k < every.size(); ++k)
    if (every[k].kind == Way::Kind::input && !noisy.contains(every[k].column) && columns[k].norm() > kNoMotion)
      shrinks.emplace_back(columns[k] * towards_mean(*shots.find(every[k].column), row_of, rows).asDiagonal() /
                           every[k].form.parameters.front().scale);
  Eigen::MatrixXd left = z;
  for (int pass = 0; pass < 3 && !shrinks.empty(); ++pass) {
    weighed(left, w);
    left = z + by_noise(z, shrinks, w);
  }
  const double bare = weighed(z, w) - weighed(left, w);

  std::vector<std::vector<Trial>> of_way(every.size());
  for_all(std::size_t(0), every.size(), [&](std::size_t k) {
    if (!(columns[k].norm() > kNoMotion)) return;
    for (std::size_t f = 0; f < functions.size(); ++f)
      of_way[k].push_back({k, f, likeliest(left, columns[k], weight, functions[f])});
  });
  std::vector<Trial> trials;
  for (auto& t : of_way)
    for (Trial& trial : t)
      if (std::isfinite(trial.found.fall)) trials.push_back(std::move(trial));
  // Of the choice, beside nothing: each function through each mechanism is as likely as any other before the data are
  // seen.
  const double price = alone ? 2 * std::log(double(std::max<std::size_t>(trials.size(), 1))) : 2 * rules.parameter_cost;
  std::ranges::stable_sort(trials, std::ranges::greater{}, [](const Trial& t) { return t.found.fall; });
  if (trials.size() > 12) trials.resize(12);

  std::vector<Mechanism> out;
  for (Trial& t : trials) {
    const Eigen::MatrixXd& j = columns[t.way];
    double deviance = weighed(left + j * t.found.g.asDiagonal(), w);
    for (int pass = 0; pass < 2; ++pass) {
      Found again = likeliest(left, j, w, functions[t.field]);
      if (!again.g.size()) break;
      t.found = std::move(again);
      deviance = weighed(left + j * t.found.g.asDiagonal(), w);
    }
    Mechanism m{.acts = every[t.way].acts,
                .along = level(t.found.g) ? "constant" : functions[t.field].along,
                .step = functions[t.field].step};
    const Eigen::VectorXd moved = (j * t.found.g.asDiagonal()).rowwise().squaredNorm();
    Eigen::Index most = 0;
    moved.maxCoeff(&most);
    m.channel = int(most);
    m.criterion = chosen.deviance + deviance + bare - of_chosen + t.found.price + price;
    m.names = names_of(every[t.way], functions[t.field], shots, monotone(t.found.g, order));
    out.push_back(std::move(m));
  }
  std::ranges::stable_sort(out, {}, &Mechanism::criterion);
  if (out.empty()) return {};
  const double within = out.front().criterion + rules.tie;
  std::erase_if(out, [&](const Mechanism& m) { return m.criterion > within; });
  return out;
}

}  // namespace hosel::loop
