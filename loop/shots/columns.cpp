#include "loop/shots/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "golf/dense.hpp"
#include "golf/parallel.hpp"
#include "golf/quantities.hpp"
#include "loop/deviation.hpp"
#include "loop/rules.hpp"
#include "loop/shots/contact_changes.hpp"
#include "loop/shots/inputs.hpp"
#include "loop/shots/scatter.hpp"
#include "loop/shots/way.hpp"

namespace hosel::loop {
namespace {

constexpr std::size_t kMostRows = 240, kMostOfSlow = 80;
constexpr double kPartOfRows = 15;  // price of one of some forty parts

}  // namespace

/// Rows that share something: from a shot on, or one group.
struct Columns::PartOfRows {
  std::vector<char> member;
  std::string where, elsewhere;           ///< in words; the second is empty where the other rows are no part
  std::vector<std::vector<char>> others;  ///< the other groups, where it is one

  struct Side {
    std::vector<char> member;
    std::string where;
  };
  /// The part, and the other rows where they are one too.
  std::vector<Side> sides() const {
    std::vector<Side> both{{member, where}};
    if (elsewhere.empty()) return both;
    both.push_back({member, elsewhere});
    for (char& m : both.back().member) m = char(!m);
    return both;
  }
};

Columns::~Columns() = default;

Columns::Columns(const ShotCase& c) : case_(c) {
  read();
  if (rows_.size() < 8 || outputs_.empty()) return;
  std::vector<ShotChannel> channels;
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    const Column& column = *columns_[inputs_.size() + k];
    channels.push_back(ShotChannel{{.name = column.name, .si = 1, .resolution = column.resolution}, outputs_[k]});
  }
  std::vector<Shot> shots;
  for (Eigen::Index i = 0; i < values_.rows(); ++i) shots.push_back(shot(i, values_));
  const Eigen::MatrixXd read = values_.rightCols(std::ptrdiff_t(outputs_.size()));
  if (quick() && !c.direct) companion_ = std::make_unique<ShotModel>(*c.model, false, shots, channels, read);
  model_ = std::make_unique<ShotModel>(*c.model, true, std::move(shots), std::move(channels), read, c.surrogate);
  estimate_noise();
  contact_ = contact(values_, noise_);
  as_recorded_ = deviance(values_, noise_, Model{}, {});
  for (ColumnSlip& slip : constant_slips(columns_)) attempt(std::move(slip));
  if (quick()) {
    const std::vector<PartOfRows> parts = this->parts();
    try_parts(parts);
    try_sizes(parts);
  }
  std::ranges::stable_sort(slips_, {}, &ColumnSlip::criterion);
}

bool Columns::quick() const { return case_.direct || (!case_.surrogate && case_.model != &closed_form()); }

void Columns::read() {
  const Shots& shots = case_.shots;
  for (int k = 0; k < kInputs; ++k)
    if (const Column* c = shots.find_stem(stem(Input(k))); c && c->role == Role::input) {
      if (case_.loft_unknown && Input(k) == Input::dynamic_loft) continue;
      columns_.push_back(c);
      inputs_.push_back(Input(k));
    }
  for (int o = 0; o < kOutputs; ++o)
    if (const Column* c = shots.find_stem(stem(Output(o))); c && c->role == Role::output && !of_flight(Output(o))) {
      if (case_.loft_unknown && Output(o) == Output::launch_angle) continue;  // it tells the loft
      columns_.push_back(c);
      outputs_.push_back(Output(o));
    }
  std::vector<double> loft(shots.rows(), kNaN);
  if (case_.loft_unknown) {
    const Inputs found = make_inputs(shots, case_.blow, case_.head_mass_declared, {}, true);
    for (std::size_t t = 0; t < found.trials.size(); ++t)
      loft[std::size_t(found.row_of[t])] = found.trials[t].blow.delivery.dynamic_loft;
  }
  std::vector<int> complete;
  for (std::size_t i = 0; i < shots.rows(); ++i) {
    bool needed = !case_.loft_unknown || std::isfinite(loft[i]), output = false;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const bool there = std::isfinite(columns_[k]->value[i]);
      if (k >= inputs_.size()) output = output || there;
      else if (inputs_[k] == Input::club_speed || inputs_[k] == Input::dynamic_loft) needed = needed && there;
    }
    if (needed && output) complete.push_back(int(i));
  }
  rows_ = evenly(complete, case_.direct ? kMostRows : kMostOfSlow);
  const std::size_t n = rows_.size();
  order_ = session_order(shots, rows_);
  if (case_.loft_unknown)
    for (const int row : rows_) loft_.push_back(loft[std::size_t(row)]);
  values_.resize(std::ptrdiff_t(n), std::ptrdiff_t(columns_.size()));
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    std::vector<double> known;
    for (const double x : columns_[k]->value)
      if (std::isfinite(x)) known.push_back(x);
    const double middle = median(known);
    for (std::size_t i = 0; i < n; ++i) {
      const double x = columns_[k]->value[std::size_t(rows_[i])];
      values_(std::ptrdiff_t(i), std::ptrdiff_t(k)) = std::isfinite(x) || k >= inputs_.size() ? x : middle;
    }
  }
}

Shot Columns::shot(Eigen::Index row, const Eigen::MatrixXd& values) const {
  Shot s{.blow = case_.blow, .order = order_[std::size_t(row)]};
  if (companion_) s.blow.contact = companion_->trial(int(row)).blow.contact;
  if (case_.loft_unknown) s.blow.delivery.dynamic_loft = loft_[std::size_t(row)];
  for (std::size_t k = 0; k < inputs_.size(); ++k) set(s.blow, inputs_[k], values(row, std::ptrdiff_t(k)));
  return s;
}

/// Model minus measured [SI], rows x channels; zero where nothing is measured, NaN where the blow cannot be.
Eigen::MatrixXd Columns::residuals(const Eigen::MatrixXd& values, const Model& model, const Eigen::VectorXd& p) const {
  if (!companion_ || model.forms.empty()) return residuals(*model_, values, model, p);
  return residuals(*model_, values, {}, {}) + residuals(*companion_, values, model, p) -
         residuals(*companion_, values, {}, {});
}

Eigen::MatrixXd Columns::residuals(const ShotModel& by, const Eigen::MatrixXd& values, const Model& model,
                                   const Eigen::VectorXd& p) const {
  const auto m = std::ptrdiff_t(outputs_.size()), first = std::ptrdiff_t(inputs_.size());
  Eigen::MatrixXd r(values.rows(), m);
  Eigen::VectorXd out(m);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    bool possible = true;
    for (std::ptrdiff_t k = 0; k < first && possible; ++k) {
      const InputQuantity& q = quantity(inputs_[std::size_t(k)]);
      possible = values(i, k) >= q.low && values(i, k) <= q.high;
    }
    if (!possible || !by.predict(shot(i, values), -1, model, p.data(), out.data())) {
      r.row(i).setConstant(kNaN);
      continue;
    }
    for (std::ptrdiff_t c = 0; c < m; ++c) {
      const double y = values(i, first + c);
      double d = std::isfinite(y) ? out[c] - y : 0.0;
      // Less than a turn may be counted from another zero. Beyond it no angle is written.
      if (is_angle(outputs_[std::size_t(c)]))
        d = std::abs(y) > 2 * kPi ? kNaN : d - 2 * kPi * std::round(d / (2 * kPi));
      r(i, c) = d;
    }
  }
  return r;
}

/// Derivatives of the channels by the parameter of a form: rows x channels.
Eigen::MatrixXd Columns::sensitivity(const Parametrisation& form) const {
  const double h = form.parameters.front().scale;
  const Model with{{&form}};
  const Eigen::MatrixXd d = (residuals(values_, with, Eigen::VectorXd::Constant(1, h)) -
                             residuals(values_, with, Eigen::VectorXd::Constant(1, -h))) /
                            (2 * h);
  return d.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

/// Derivatives of the channels by an input column, or minus one for the channel itself: rows x channels.
Eigen::MatrixXd Columns::sensitivity(const Eigen::MatrixXd& values, int column) const {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(values.rows(), std::ptrdiff_t(outputs_.size()));
  if (std::size_t(column) >= inputs_.size()) {
    d.col(column - std::ptrdiff_t(inputs_.size())).setConstant(-1);
    return d;
  }
  const double h = quantity(inputs_[std::size_t(column)]).step;
  Eigen::MatrixXd up = values, down = values;
  up.col(column).array() += h;
  down.col(column).array() -= h;
  d = (residuals(up, {}, {}) - residuals(down, {}, {})) / (2 * h);
  return d.unaryExpr([](double x) { return std::isfinite(x) ? x : 0.0; });
}

/// Inverse factor of the covariance of a typical shot: instrument, and the inputs' noise through the base.
Eigen::MatrixXd Columns::whitening(const Eigen::MatrixXd& values, const Eigen::VectorXd& noise) const {
  Eigen::MatrixXd cov = noise.cwiseAbs2().asDiagonal();
  if (input_noise_.maxCoeff() > 0) {
    const Eigen::Index some = std::min<Eigen::Index>(values.rows(), 12), n = values.rows();
    Eigen::MatrixXd few(some, values.cols());
    for (Eigen::Index i = 0; i < some; ++i) few.row(i) = values.row(i * n / some);
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      if (const double s = input_noise_[std::ptrdiff_t(k)]; s > 0) {
        const Eigen::MatrixXd J = sensitivity(few, int(k));
        cov += s * s / double(some) * J.transpose() * J;
      }
  }
  return dense::Cholesky(cov).lower_inverse();
}

/// Twice the logarithm of the density's scale: of every channel the values that are there.
double Columns::log_scale(const Eigen::MatrixXd& values, const Eigen::MatrixXd& whitening) const {
  double sum = 0;
  for (Eigen::Index c = 0, m = whitening.rows(); c < m; ++c)
    sum -= 2 * double(values.col(values.cols() - m + c).array().isFinite().count()) * std::log(whitening(c, c));
  return sum;
}

/// Of every row.
Eigen::VectorXd Columns::losses(const Eigen::MatrixXd& r, const Eigen::MatrixXd& whitening) const {
  const solvers::Loss loss = loss_of_shot(int(r.cols())).uncapped();
  Eigen::VectorXd of_row(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    of_row[i] = loss(r.row(i).allFinite() ? (whitening * r.row(i).transpose()).squaredNorm()
                                          : std::pow(kNoBlow, 2) * double(r.cols()));
  return of_row;
}

double Columns::deviance(const Eigen::MatrixXd& values, const Eigen::VectorXd& noise, const Model& model,
                         const Eigen::VectorXd& p) const {
  const Eigen::MatrixXd W = whitening(values, noise);
  return log_scale(values, W) + losses(residuals(values, model, p), W).sum();
}

/// The likeliest contact of the ball: as declared, or with another restitution and tangential restitution, which no
/// case knows well. A column is judged beside it.
Columns::Contact Columns::contact(const Eigen::MatrixXd& values, const Eigen::VectorXd& noise) const {
  static const std::array<ContactChange, 3> ball = of_another_ball();
  static const Eigen::Vector2d largest(0.2, 0.5);
  const Eigen::MatrixXd W = whitening(values, noise), declared = residuals(values, {}, {});
  const double scale = log_scale(values, W);
  Contact out{{}, {}, scale + losses(declared, W).sum()};
  if (!quick()) return out;
  const Model model{{&ball[0].form, &ball[1].form}};
  Eigen::MatrixXd without;
  if (companion_) without = residuals(*companion_, values, {}, {});
  const auto at = [&](const Eigen::VectorXd& size) -> Eigen::MatrixXd {
    if (!companion_) return residuals(*model_, values, model, size);
    return declared + residuals(*companion_, values, model, size) - without;
  };
  const solvers::Loss loss = loss_of_shot(int(W.rows())).uncapped();
  Eigen::VectorXd size = Eigen::VectorXd::Zero(2);
  std::array<Eigen::MatrixXd, 2> J;
  for (int pass = 0; pass < 3; ++pass) {
    const Eigen::MatrixXd z = at(size) * W.transpose();
    for (int k = 0; k < 2; ++k) {
      constexpr double step = 0.01;
      Eigen::VectorXd there = size;
      there[k] += step;
      if (pass == 0) J[std::size_t(k)] = (at(there) * W.transpose() - z) / step;
    }
    Eigen::Matrix2d normal = 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (Eigen::Index i = 0; i < z.rows(); ++i) {
      Eigen::MatrixXd j(z.cols(), 2);
      j << J[0].row(i).transpose(), J[1].row(i).transpose();
      if (!z.row(i).allFinite() || !j.allFinite()) continue;
      const double weight = loss.weight(z.row(i).squaredNorm());
      normal += weight * j.transpose() * j;
      gradient += weight * j.transpose() * z.row(i).transpose();
    }
    size = (size - normal.inverse() * gradient).cwiseMax(-largest).cwiseMin(largest);
  }
  const double value = scale + losses(at(size), W).sum() + 2 * case_.rules.parameter_cost;
  if (value < out.deviance) out = {model, size, value};
  return out;
}

void Columns::estimate_noise() {
  const auto m = std::ptrdiff_t(outputs_.size());
  noise_ = Eigen::VectorXd::Zero(m);
  input_noise_ = Eigen::VectorXd::Zero(std::ptrdiff_t(inputs_.size()));
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    const auto it = case_.input_noise.find(columns_[k]->name);
    if (it != case_.input_noise.end()) input_noise_[std::ptrdiff_t(k)] = error_of(*columns_[k], it->second);
  }
  std::vector<int> all(rows_.size());
  std::iota(all.begin(), all.end(), 0);
  Eigen::MatrixXd r = residuals(values_, {}, {});
  for (std::ptrdiff_t c = 0; c < m; ++c) {
    const auto read = values_.col(std::ptrdiff_t(inputs_.size()) + c).array();
    r.col(c) = read.isFinite().select(r.col(c), kNaN);  // what was not read has no scatter
    const Column& column = *columns_[inputs_.size() + std::size_t(c)];
    const double rounding = rounding_deviation(column.resolution);
    if (const auto it = case_.noise.find(column.name); it != case_.noise.end())
      noise_[c] = std::hypot(it->second * column.si, rounding);
    else noise_[c] = std::max(smooth_scatter(*model_, all, int(c), r), rounding);
    std::vector<double> size;
    for (const double y : read)
      if (std::isfinite(y)) size.push_back(std::abs(y));
    noise_[c] = std::max(noise_[c], 1e-6 * median(size) + 1e-12);
  }
}

/// A column's value so many rows below in the file; its own where there is none.
double Columns::neighbour(Eigen::Index i, int column, int rows) const {
  const auto& x = columns_[std::size_t(column)]->value;
  const std::ptrdiff_t at = rows_[std::size_t(i)] + rows;
  const bool there = at >= 0 && at < std::ptrdiff_t(x.size()) && std::isfinite(x[std::size_t(at)]);
  return there ? x[std::size_t(at)] : values_(i, column);
}

Eigen::MatrixXd Columns::corrected(const ColumnSlip& s) const {
  Eigen::MatrixXd values = values_;
  if (s.finding == "swapped") {
    // The numbers were written under each other's header.
    const double a = columns_[std::size_t(s.column)]->si, b = columns_[std::size_t(s.second)]->si;
    values.col(s.column) = values_.col(s.second) * (a / b);
    values.col(s.second) = values_.col(s.column) * (b / a);
    return values;
  }
  if (s.rows != 0) {
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      if (s.member.empty() || s.member[std::size_t(i)]) values(i, s.column) = neighbour(i, s.column, s.rows);
    return values;
  }
  for (const int k : {s.column, s.second}) {
    if (k < 0) continue;
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      if (s.member.empty() || s.member[std::size_t(i)]) values(i, k) = s.factor * values(i, k) + s.offset;
  }
  return values;
}

/// Noise of the corrected numbers: what was estimated is that of the written ones, and goes with them.
Eigen::VectorXd Columns::noise_of(const ColumnSlip& slip) const {
  Eigen::VectorXd noise = noise_;
  const auto first = std::ptrdiff_t(inputs_.size());
  for (const auto& [k, other] : {std::pair{slip.column, slip.second}, {slip.second, slip.column}}) {
    if (k < first || !slip.member.empty() || case_.noise.contains(columns_[std::size_t(k)]->name)) continue;
    if (slip.finding != "swapped") noise[k - first] *= std::abs(slip.factor);
    else if (other >= first)
      noise[k - first] = noise_[other - first] * columns_[std::size_t(k)]->si / columns_[std::size_t(other)]->si;
  }
  return noise;
}

/// Whether a column has enough to be told from another; zeros are zeros in any unit.
bool Columns::tells(const ColumnSlip& slip) const {
  const auto x = values_.col(slip.column).array();
  const auto read = x.isFinite().count();
  if (slip.finding == "scale" && std::size_t(slip.column) < inputs_.size()) {
    // The answers to a noisy record are those of a narrower one, by the share of noise in its variance and what else
    // that share makes uncertain.
    const double share = std::pow(input_noise_[slip.column], 2) / (x - x.mean()).square().mean();
    if (slip.factor < 1 && slip.factor > 1 - 2 * share) return false;
  }
  return (read >= kFewestOfRows || read == x.size()) && (slip.factor == 1 || (x.isFinite() && x != 0).any());
}

void Columns::attempt(ColumnSlip slip) {
  if (!tells(slip)) return;
  slip.deviance = slip.free() ? deviance(corrected(slip), noise_of(slip), {}, {})
                              : contact(corrected(slip), noise_of(slip)).deviance;
  // The density of the written numbers.
  for (const int k : {slip.column, slip.second})
    if (slip.member.empty() && k >= int(inputs_.size()))
      slip.deviance -= 2 * double(values_.col(k).array().isFinite().count()) * std::log(std::abs(slip.factor));
  slips_.push_back(std::move(slip));
}

/// The same on a part of the rows, the part that says most: an instrument was set anew in the session.
void Columns::try_parts(const std::vector<PartOfRows>& parts) {
  const Eigen::MatrixXd W = whitening(values_, noise_);
  const Eigen::VectorXd recorded = losses(residuals(values_, contact_.model, contact_.size), W);
  std::vector<ColumnSlip> on_parts;
  for (const ColumnSlip& whole : slips_) {
    if (whole.finding == "swapped" || whole.second >= 0) continue;
    const bool output = whole.column >= int(inputs_.size());
    // Where its noise was estimated, that of the written numbers goes with them. Their density, as for all rows.
    const Eigen::MatrixXd V = whitening(values_, noise_of(whole));
    Eigen::VectorXd better = recorded - losses(residuals(corrected(whole), contact_.model, contact_.size), V);
    const Eigen::VectorXd scale = 2 * (V.diagonal().array() / W.diagonal().array()).log();
    for (Eigen::Index i = 0; i < better.size(); ++i) {
      for (Eigen::Index c = 0; c < scale.size(); ++c)
        if (std::isfinite(values_(i, std::ptrdiff_t(inputs_.size()) + c))) better[i] += scale[c];
      if (output && std::isfinite(values_(i, whole.column))) better[i] += 2 * std::log(std::abs(whole.factor));
    }
    ColumnSlip best = whole;
    best.deviance = kInfinity;
    best.cost += kPartOfRows;
    for (const PartOfRows& part : parts)
      for (PartOfRows::Side& side : part.sides()) {
        double deviance = contact_.deviance;
        for (Eigen::Index i = 0; i < better.size(); ++i) deviance -= side.member[std::size_t(i)] ? better[i] : 0;
        if (!(deviance < best.deviance)) continue;
        best.deviance = deviance;
        best.member = std::move(side.member);
        best.where = std::move(side.where);
      }
    if (best.deviance < kInfinity) on_parts.push_back(std::move(best));
  }
  std::ranges::move(on_parts, std::back_inserter(slips_));
}

namespace {

/// The size t that brings whitened residuals z + j t down most, and their deviance: from the middle of what single
/// shots ask for.
std::pair<double, double> fitted(const Eigen::MatrixXd& z, const Eigen::MatrixXd& j) {
  const Eigen::Index n = z.rows();
  const solvers::Loss loss = loss_of_shot(int(z.cols())).uncapped();
  std::vector<std::pair<double, double>> asked;  // by a shot, its weight
  double total = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double jj = j.row(i).squaredNorm();
    if (!(jj > 0) || !z.row(i).allFinite()) continue;
    asked.emplace_back(-j.row(i).dot(z.row(i)) / jj, std::sqrt(jj));
    total += std::sqrt(jj);
  }
  std::ranges::sort(asked);
  double t = 0, sum = 0, value = 0;
  for (const auto& [x, weight] : asked)
    if ((sum += weight) > total / 2) {
      t = x;
      break;
    }
  for (int pass = 0; pass < 5; ++pass) {
    double a = 0, b = 0;
    value = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!z.row(i).allFinite()) continue;
      const Eigen::VectorXd at = (z.row(i) + t * j.row(i)).transpose();
      const double w = loss.weight(at.squaredNorm());
      value += loss(at.squaredNorm());
      a += w * j.row(i).squaredNorm();
      b += w * j.row(i).dot(at);
    }
    if (a > 0) t -= b / a;
  }
  return {t, value};
}

/// The rows of `j` that are members.
Eigen::MatrixXd members_only(const Eigen::MatrixXd& j, const std::vector<char>& member) {
  Eigen::MatrixXd out = j;
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    if (!member[std::size_t(i)]) out.row(i).setZero();
  return out;
}

/// Whether these groups differ among each other too: then a group is no exception.
bool spread_over(const Eigen::MatrixXd& z, const Eigen::MatrixXd& j, const std::vector<std::vector<char>>& groups) {
  const solvers::Loss loss = loss_of_shot(int(z.cols())).uncapped();
  double square = 0, pull = 0, weight = 0;
  int count = 0;
  for (const std::vector<char>& member : groups) {
    double a = 0, b = 0;
    for (Eigen::Index i = 0; i < j.rows(); ++i) {
      if (!member[std::size_t(i)] || !z.row(i).allFinite()) continue;
      const double w = loss.weight(z.row(i).squaredNorm());
      a += w * j.row(i).squaredNorm();
      b += w * j.row(i).dot(z.row(i));
    }
    if (!(a > 0)) continue;
    ++count;
    square += b * b / a;
    pull += b;
    weight += a;
  }
  if (count < 2) return false;
  const double about_mean = square - pull * pull / weight;
  return about_mean > boost::math::quantile(complement(boost::math::chi_squared(double(count - 1)), kByChance));
}

}  // namespace

/// Parts are the shots from some shot on, and the rows with one value of a text column, if these are between a quarter
/// and three quarters of all.
std::vector<Columns::PartOfRows> Columns::parts() const {
  const Eigen::Index n = values_.rows();
  std::vector<PartOfRows> parts;
  const auto by_order = rising_order<Eigen::Index>(order_.size(), [&](auto i) { return order_[std::size_t(i)]; });
  for (Eigen::Index k = n / 6; n >= kFewestRows && k <= n - n / 6; k += std::max<Eigen::Index>(1, n / 60)) {
    std::vector<char> member(static_cast<std::size_t>(n), 0);
    for (Eigen::Index i = k; i < n; ++i) member[std::size_t(by_order[std::size_t(i)])] = 1;
    const std::string& first = case_.shots.id[std::size_t(rows_[std::size_t(by_order[std::size_t(k)])])];
    parts.push_back({member, fmt::format("from shot {} on", first), fmt::format("before shot {}", first), {}});
  }
  for (const Column& c : case_.shots.columns) {
    if (c.numeric || c.role == Role::output) continue;
    const Groups g = groups(c);
    if (g.name.size() < 2 || g.name.size() > kMostGroups) continue;
    std::vector<std::vector<char>> of(g.name.size(), std::vector<char>(static_cast<std::size_t>(n), 0));
    for (Eigen::Index i = 0; i < n; ++i)
      if (const int group = g.of_row[std::size_t(rows_[std::size_t(i)])]; group >= 0)  // the cell may be empty
        of[std::size_t(group)][std::size_t(i)] = 1;
    for (std::size_t k = g.name.size() == 2; k < g.name.size(); ++k) {
      const auto inside = std::ranges::count(of[k], 1);
      // A smaller group that recorded something else is a finding about rows.
      if (inside * 4 < n || inside * 4 > 3 * n) continue;
      std::vector<std::vector<char>> others = of;
      others.erase(others.begin() + std::ptrdiff_t(k));
      const auto is = [&](std::size_t group) { return fmt::format("where {} is {}", c.name, g.name[group]); };
      parts.push_back({of[k], is(k), g.name.size() == 2 ? is(0) : "", std::move(others)});
    }
  }
  return parts;
}

/// A club or a ball that changes there moves a reading as one that is off from there on does: a face the same all over,
/// or the more the farther from its centre, or another centre of gravity. Deviance of the best such change, by part;
/// "": of all rows.
std::map<std::string, double> Columns::by_contact(const Eigen::MatrixXd& z, const Eigen::MatrixXd& W,
                                                  const std::vector<PartOfRows>& parts) const {
  const auto index = [&](Input i) { return std::ranges::find(inputs_, i) - inputs_.begin(); };
  Eigen::VectorXd square = Eigen::VectorXd::Zero(values_.rows());
  for (const Input i : {Input::impact_toe, Input::impact_high})
    if (index(i) < std::ptrdiff_t(inputs_.size())) square += (values_.col(index(i)) / 0.01).cwiseAbs2();
  std::map<std::string, double> best;
  const auto rival = [&](const std::string& where, double value) {
    const auto known = best.try_emplace(where, value).first;
    known->second = std::min(known->second, value);
  };
  struct Change {
    Eigen::MatrixXd by;
    double largest;
  };
  const auto moving = [&](std::span<const ContactChange> of) {
    std::vector<Change> changes;
    for (const ContactChange& c : of)
      if (Eigen::MatrixXd by = sensitivity(c.form) * W.transpose(); !(by.norm() < kNoMotion))
        changes.push_back({std::move(by), c.largest});
    return changes;
  };
  const std::vector<Change> of_ball = moving(of_another_ball()), of_head = moving(of_another_head());
  const auto of_side = [&](const PartOfRows::Side& side) {
    for (const Change& first : of_head) {
      const Eigen::MatrixXd by = members_only(first.by, side.member);
      const auto [size, value] = fitted(z, by);
      if (std::abs(size) > first.largest) continue;
      rival(side.where, value);
      const Eigen::MatrixXd beside = z + size * by;
      for (const Change& second : of_head) {
        if (&second == &first) continue;
        if (const auto [more, both] = fitted(beside, members_only(second.by, side.member));
            std::abs(more) <= second.largest)
          rival(side.where, both + case_.rules.parameter_cost);
      }
    }
    Eigen::MatrixXd left;  // by the first change: another ball differs in both
    for (const Change& c : of_ball) {
      const Eigen::MatrixXd even = members_only(c.by, side.member);
      if (left.size())
        if (const auto [size, value] = fitted(left, even); std::abs(size) <= c.largest)
          rival(side.where, value + case_.rules.parameter_cost);
      const auto [size, value] = fitted(z, even);
      if (std::abs(size) > c.largest) continue;
      rival(side.where, value);
      const Eigen::MatrixXd off_centre = square.asDiagonal() * even, beside = z + size * even;
      if (off_centre.norm() > kNoMotion)
        rival(side.where, fitted(beside, off_centre).second + case_.rules.parameter_cost);
      left = beside;
    }
  };
  for (const PartOfRows& part : parts) std::ranges::for_each(part.sides(), of_side);
  for (const Change& c : moving(of_one_direction()))
    if (const auto [size, value] = fitted(z, c.by); std::abs(size) <= c.largest) rival("", value);
  return best;
}

/// Slips whose size is found: offset, scale, and offset of a part of the session. All by linear algebra about the
/// recorded values, the best of them again about themselves.
void Columns::try_sizes(const std::vector<PartOfRows>& parts) {
  const Eigen::MatrixXd W = whitening(values_, noise_), z = residuals(values_, {}, {}) * W.transpose();
  std::vector<ColumnSlip> trials;
  for (int k = 0; k < int(columns_.size()); ++k) {
    const Eigen::MatrixXd J = sensitivity(values_, k) * W.transpose();
    if (J.norm() < kNoMotion) continue;
    const auto consider = [&](ColumnSlip slip, const Eigen::MatrixXd& j) {
      const auto [t, value] = fitted(z, j);
      (slip.finding == "scale" ? slip.factor : slip.offset) += t;
      slip.deviance = value;
      trials.push_back(std::move(slip));
    };
    consider({.finding = "offset", .column = k, .cost = 8}, J);
    const Eigen::VectorXd x = values_.col(k).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
    consider({.finding = "scale", .column = k, .cost = 9}, x.asDiagonal() * J);
    for (const PartOfRows& part : parts) {
      ColumnSlip shift{
          .finding = "level-shift", .column = k, .member = part.member, .where = part.where, .cost = kPartOfRows};
      shift.disputed = spread_over(z, J, part.others);
      consider(std::move(shift), members_only(J, part.member));
    }
  }
  const std::map<std::string, double> physics = by_contact(z, W, parts);
  const auto dispute = [&](ColumnSlip& t, double scale) {
    if (const auto it = physics.find(t.where); it != physics.end())
      t.disputed = t.disputed || it->second + scale + t.cost < t.criterion() + case_.rules.tie;
  };
  for (ColumnSlip& t : trials) dispute(t, 0);
  for (ColumnSlip& s : slips_)  // whose deviance has the density's scale
    if (!s.where.empty()) dispute(s, log_scale(values_, W));
  std::ranges::stable_sort(trials, {}, &ColumnSlip::criterion);
  // The best few, of different columns or kinds, about themselves.
  std::vector<ColumnSlip> kept;
  for (const ColumnSlip& t : trials) {
    if (kept.size() == 10) break;
    const auto same = std::ranges::count_if(
        kept, [&](const ColumnSlip& s) { return s.column == t.column && s.finding == t.finding; });
    if (same < (t.finding == "level-shift" ? 2 : 1)) kept.push_back(t);
  }
  for (ColumnSlip& slip : kept) {
    for (int pass = 0; pass < 3; ++pass) {
      const Eigen::MatrixXd at = corrected(slip), V = whitening(at, noise_of(slip));
      Eigen::MatrixXd j = sensitivity(at, slip.column) * V.transpose();
      for (Eigen::Index i = 0; i < j.rows(); ++i) {
        const double x = values_(i, slip.column);
        j.row(i) *= slip.finding == "scale" ? (std::isfinite(x) ? x : 0.0)
                                            : double(slip.member.empty() || slip.member[std::size_t(i)]);
      }
      const double t = fitted(residuals(at, {}, {}) * V.transpose(), j).first;
      (slip.finding == "scale" ? slip.factor : slip.offset) += t;
    }
    attempt(std::move(slip));
  }
}

/// The least criterion of the likeliest rivals and of the other forms of their effects, all fitted to the rows that
/// slips are tried on.
double Columns::library(const std::vector<Fit>& rivals, const std::vector<Parametrisation>& forms) const {
  constexpr std::size_t likeliest = 6;
  const auto price = [&](const Model& m) {
    return case_.rules.parameter_cost * m.size() + case_.rules.further_gain * (double(m.forms.size()) - 1);
  };
  std::vector<std::pair<double, const Fit*>> order;
  for (const Fit& f : rivals)
    if (!f.at_bound) order.emplace_back(deviance(values_, noise_, f.model, f.p) + price(f.model), &f);
  std::ranges::stable_sort(order, {}, [](const auto& o) { return o.first; });
  if (order.size() > likeliest) order.resize(likeliest);
  std::vector<std::pair<Model, Eigen::VectorXd>> from;
  std::set<std::string> effects;
  double least = as_recorded_;
  for (const auto& [value, f] : order) {
    least = std::min(least, value);
    from.emplace_back(f->model, f->p);
    if (f->model.forms.size() == 1) effects.insert(f->model.forms.front()->effect);
  }
  for (const Parametrisation& form : forms)
    if (effects.contains(form.effect) && !form.threshold)
      from.emplace_back(Model{{&form}}, Eigen::VectorXd::Zero(Eigen::Index(form.parameters.size())));

  const Eigen::MatrixXd W = whitening(values_, noise_);
  const Eigen::Index width = W.rows();
  std::vector<double> found(from.size(), kInfinity);
  for_all(std::size_t(0), from.size(), [&](std::size_t k) {
    const auto& [model, start] = from[k];
    const auto whitened = [&](const Eigen::VectorXd& p, Eigen::VectorXd& z) {
      const Eigen::MatrixXd r = residuals(values_, model, p) * W.transpose();
      z = r.transpose().reshaped().unaryExpr([](double x) { return std::isfinite(x) ? x : kNoBlow; });
      return true;
    };
    found[k] =
        log_scale(values_, W) + price(model) +
        refitted(model, start, int(values_.rows() * width), loss_of_shot(int(width)).uncapped(), whitened).deviance;
  });
  found.push_back(least);
  return std::ranges::min(found);
}

std::vector<WrongColumn> Columns::contradicted(const std::vector<Fit>& rivals,
                                               const std::vector<Parametrisation>& forms) const {
  if (slips_.empty()) return {};
  const double values = double(values_.rightCols(std::ptrdiff_t(outputs_.size())).array().isFinite().count());
  const double scale = log_scale(values_, whitening(values_, noise_));
  double library = as_recorded_;
  const auto holds = [&](const ColumnSlip& s) {
    return contradicts(s, s.free() ? as_recorded_ : contact_.deviance, library, scale, values, case_.rules.tie);
  };
  if (std::ranges::none_of(slips_, holds)) return {};
  if (quick()) library = this->library(rivals, forms);
  return told(columns_, slips_, case_.rules.tie, holds);
}

}  // namespace hosel::loop
