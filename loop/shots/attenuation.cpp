#include "loop/shots/attenuation.hpp"

#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "loop/fit.hpp"
#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

/// What a form does to the records x of one input.
struct Change {
  int input = 0;
  double mean = 0;      ///< of the change [SI]
  double slope = 0;     ///< of the change over x
  double variance = 0;  ///< of x [SI]
};

/// Absent where it changes no input, or several.
std::optional<Change> change(const ShotModel& model, const std::vector<int>& rows, const Parametrisation& form,
                             Sizes p) {
  const auto n = Eigen::Index(rows.size());
  Eigen::MatrixXd x(n, kInputs), by(n, kInputs);
  for (Eigen::Index i = 0; i < n; ++i) {
    Shot shot = model.trial(rows[i]);
    for (int k = 0; k < kInputs; ++k) x(i, k) = get(shot.blow, Input(k));
    form.before(p, shot);
    for (int k = 0; k < kInputs; ++k) by(i, k) = get(shot.blow, Input(k)) - x(i, k);
  }
  std::optional<Change> out;
  for (int k = 0; k < kInputs; ++k) {
    if (!(by.col(k).cwiseAbs().maxCoeff() > 0)) continue;
    if (out) return {};
    const Eigen::VectorXd apart = x.col(k).array() - x.col(k).mean();
    const double square = apart.squaredNorm();
    out = Change{k, by.col(k).mean(), square > 0 ? apart.dot(by.col(k)) / square : 0, square / double(n)};
  }
  return out;
}

}  // namespace

std::vector<Attenuation> attenuations(const ShotModel& model, const Shots& shots, const std::vector<int>& rows,
                                      const Fit& fit, const Eigen::MatrixXd& covariance) {
  std::vector<Attenuation> told;
  Eigen::Index at = 0;
  fit.model.each(fit.p.data(), [&](const Parametrisation& form, Sizes p) {
    const auto n = Eigen::Index(p.size());
    const Eigen::Index first = std::exchange(at, at + n);
    if (!form.before) return;
    const auto c = change(model, rows, form, p);
    const Column* column = c ? shots.find_stem(stem(Input(c->input))) : nullptr;
    if (!column || !(c->slope < 0)) return;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    std::vector<double> moved(p.begin(), p.end());
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const double step = kCoarseStep * form.parameters[k].scale;
      moved[k] += step;
      if (const auto other = change(model, rows, form, moved))
        gradient[Eigen::Index(k)] = (other->mean - c->mean) / step;
      moved[k] = p[k];
    }
    // The mean is uncertain by the parameters and, were it noise, by that of so many records.
    const double by_noise = -c->slope * c->variance / double(rows.size());
    const double error = std::sqrt(gradient.dot(covariance.block(first, first, n, n) * gradient) + by_noise);
    if (std::abs(c->mean) < 2 * error) told.push_back({form.effect, column->name, -c->slope});
  });
  return told;
}

}  // namespace hosel::loop
