#include "hosel/loop/shots/model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "hosel/models/rigid_eccentric.hpp"

namespace hosel::loop {
namespace {

constexpr double kImpossible = 100;                 // noise units
constexpr double kCentral = 1e-3, kForward = 1e-5;  // difference steps, of a parameter's scale

const models::RigidEccentric& companion() {
  static const models::RigidEccentric model;
  return model;
}

Launch plus(Launch a, const Launch& b, double sign) {
  a.velocity += sign * b.velocity;
  a.spin += sign * b.spin;
  a.head_velocity += sign * b.head_velocity;
  a.head_spin += sign * b.head_spin;
  return a;
}

/// Angles are compared on the circle.
bool is_angle(Output o) { return o == Output::launch_angle || o == Output::azimuth || o == Output::spin_axis; }

}  // namespace

ShotModel::ShotModel(const models::ImpactModel& base, bool direct, std::vector<Shot> trials,
                     std::vector<ShotChannel> channels, Eigen::MatrixXd measured)
    : base_(base),
      direct_(direct),
      trials_(std::move(trials)),
      channels_(std::move(channels)),
      measured_(std::move(measured)) {
  if (!direct_) {
    offset_.reserve(trials_.size());
    for (Shot& t : trials_) {
      offset_.push_back(plus(base_.launch(t.blow), companion().launch(t.blow), -1));
      t.blow.club.shaft.reset();  // the companion needs none, and copies stay cheap
    }
  }
}

Launch ShotModel::answer(const Shot& trial, int shot) const {
  if (direct_) return base_.launch(trial.blow);
  const Launch l = companion().launch(trial.blow);
  return shot < 0 ? l : plus(l, offset_[std::size_t(shot)], 1);
}

void ShotModel::change(const Model& model, const double* p, Shot& trial) {
  for (const Parametrisation* f : model.forms) {
    if (f->before) f->before({p, f->parameters.size()}, trial);
    p += f->parameters.size();
  }
}

void ShotModel::change(const Model& model, const double* p, const Shot& trial, Launch& launch) {
  for (const Parametrisation* f : model.forms) {
    if (f->after) f->after({p, f->parameters.size()}, trial, launch);
    p += f->parameters.size();
  }
}

bool ShotModel::read(const Shot& trial, int shot, const Model& model, const double* parameters, const Launch& launch,
                     double* out) const {
  bool good = true;
  for (int c = 0; c < width(); ++c) {
    const ShotChannel& channel = channels_[std::size_t(c)];
    double value = get(launch, channel.output);
    const double* p = parameters;
    for (const Parametrisation* f : model.forms) {
      if (f->reading) value = f->reading({p, f->parameters.size()}, trial, channel.output, value);
      p += f->parameters.size();
    }
    if (shot >= 0 && is_angle(channel.output) && observed(shot, c))
      value -= 2 * kPi * std::round((value - measured_(shot, c) * channel.si) / (2 * kPi));
    out[c] = value / channel.si;
    good = good && std::isfinite(out[c]);
  }
  return good;
}

bool ShotModel::predict(const Shot& trial, int shot, const Model& model, const double* parameters, double* out) const {
  try {
    Shot t = trial;
    change(model, parameters, t);
    Launch l = answer(t, shot);
    change(model, parameters, t, l);
    return read(t, shot, model, parameters, l, out);
  } catch (const std::invalid_argument&) { return false; }
}

bool ShotModel::differences(const Shot& trial, int shot, const Model& model, const double* parameters, double step,
                            bool central, double* out, double* derivative) const {
  try {
    Shot t = trial;
    change(model, parameters, t);
    const Launch bare = answer(t, shot);
    Launch l = bare;
    change(model, parameters, t, l);
    if (!read(t, shot, model, parameters, l, out)) return false;
    const int m = width();
    std::array<double, 64> moved{}, there{}, here{};
    const int n = model.size();
    if (n > int(moved.size()) || m > int(there.size())) throw std::length_error("too many parameters for one model");
    std::copy_n(parameters, n, moved.begin());
    int k = 0;
    for (const Parametrisation* f : model.forms)
      for (const Parameter& q : f->parameters) {
        const double h = step * q.scale, at = moved[std::size_t(k)];
        const auto look = [&](double x, double* values) {
          moved[std::size_t(k)] = x;
          bool good = false;
          if (f->before) {
            good = predict(trial, shot, model, moved.data(), values);
          } else if (f->after) {
            Launch other = bare;
            change(model, moved.data(), t, other);
            good = read(t, shot, model, moved.data(), other, values);
          } else {
            good = read(t, shot, model, moved.data(), l, values);
          }
          moved[std::size_t(k)] = at;
          return good;
        };
        if (!look(at + h, there.data())) return false;
        if (central && !look(at - h, here.data())) return false;
        for (int c = 0; c < m; ++c)
          derivative[k * m + c] = central ? (there[std::size_t(c)] - here[std::size_t(c)]) / (2 * step)
                                          : (there[std::size_t(c)] - out[c]) / step;
        ++k;
      }
    return true;
  } catch (const std::invalid_argument&) { return false; }
}

bool ShotModel::launch(Shot t, const Model& model, const double* parameters, Launch& out) const {
  try {
    change(model, parameters, t);
    out = answer(t, -1);
    change(model, parameters, t, out);
    return out.velocity.allFinite() && out.spin.allFinite();
  } catch (const std::invalid_argument&) { return false; }
}

Eigen::MatrixXd ShotModel::input_jacobian(int shot, const Model& model, const double* parameters, unsigned mask) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(width(), kInputs);
  Eigen::VectorXd up(width()), down(width());
  for (int k = 0; k < kInputs; ++k) {
    if (!(mask >> k & 1U)) continue;
    Shot t = trial(shot);
    const double x = get(t.blow, Input(k)), h = quantity(Input(k)).step;
    set(t.blow, Input(k), x + h);
    const bool a = predict(t, shot, model, parameters, up.data());
    set(t.blow, Input(k), x - h);
    const bool b = predict(t, shot, model, parameters, down.data());
    if (a && b) J.col(k) = (up - down) / (2 * h);
  }
  return J;
}

void ShotModel::set_covariance(const std::vector<Eigen::MatrixXd>& inputs, const Model& model,
                               const double* parameters) {
  const int m = width();
  whiten_.assign(std::size_t(shots()) * std::size_t(m) * std::size_t(m), 0.0);
  sigma_.resize(shots(), m);
  for (int i = 0; i < shots(); ++i) {
    Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(m, m);
    for (int c = 0; c < m; ++c) {
      const ShotChannel& ch = channels_[std::size_t(c)];
      cov(c, c) = ch.noise * ch.noise;
    }
    if (!inputs.empty()) {
      const Eigen::MatrixXd& sx = inputs[std::size_t(i)];
      unsigned mask = 0;
      for (int k = 0; k < kInputs; ++k) mask |= unsigned(sx(k, k) > 0) << k;
      if (mask) {
        const Eigen::MatrixXd J = input_jacobian(i, model, parameters, mask);
        cov += J * sx * J.transpose();
      }
    }
    sigma_.row(i) = cov.diagonal().cwiseSqrt().transpose();
    std::vector<int> seen;
    for (int c = 0; c < m; ++c)
      if (observed(i, c)) seen.push_back(c);
    const int k = int(seen.size());
    if (!k) continue;
    Eigen::MatrixXd part(k, k);
    for (int a = 0; a < k; ++a)
      for (int b = 0; b < k; ++b) part(a, b) = cov(seen[std::size_t(a)], seen[std::size_t(b)]);
    const Eigen::LLT<Eigen::MatrixXd> llt(part);
    const Eigen::MatrixXd W = llt.matrixL().solve(Eigen::MatrixXd::Identity(k, k));
    double* out = whiten_.data() + std::ptrdiff_t(i) * m * m;
    for (int a = 0; a < k; ++a)
      for (int b = 0; b <= a; ++b) out[seen[std::size_t(a)] * m + seen[std::size_t(b)]] = W(a, b);
  }
}

Eigen::MatrixXd ShotModel::residuals(const Model& model, const double* parameters) const {
  Eigen::MatrixXd r(shots(), width());
  Eigen::VectorXd out(width());
  for (int i = 0; i < shots(); ++i) {
    if (predict(i, model, parameters, out.data())) r.row(i) = out.transpose() - measured_.row(i);
    else r.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return r;
}

void ShotModel::whiten(int shot, const Model& model, const double* p, double* scratch, double* z) const {
  const int m = width();
  Eigen::Map<Eigen::VectorXd> out(z, m);
  if (!predict(shot, model, p, scratch)) {
    out.setConstant(kImpossible);
    return;
  }
  for (int c = 0; c < m; ++c) scratch[c] = observed(shot, c) ? scratch[c] - measured_(shot, c) : 0.0;
  out.noalias() = whitening(shot) * Eigen::Map<const Eigen::VectorXd>(scratch, m);
}

void ShotModel::linearise(int shot, const Model& model, const double* p, double step, bool central,
                          Eigen::Ref<Eigen::VectorXd> z, Eigen::MatrixXd& J) const {
  const int m = width();
  std::array<double, 16> scratch{};
  if (!differences(trial(shot), shot, model, p, step, central, scratch.data(), J.data())) {
    J.setZero();
    whiten(shot, model, p, scratch.data(), z.data());
    return;
  }
  for (int c = 0; c < m; ++c) {
    const bool seen = observed(shot, c);
    scratch[std::size_t(c)] = seen ? scratch[std::size_t(c)] - measured_(shot, c) : 0.0;
    if (!seen) J.row(c).setZero();
  }
  const auto W = whitening(shot).triangularView<Eigen::Lower>();
  z = W * Eigen::Map<const Eigen::VectorXd>(scratch.data(), m);
  J = (W * J).eval();
}

Eigen::VectorXd ShotModel::whitened(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p) const {
  const int m = width();
  Eigen::VectorXd z(std::ptrdiff_t(shots.size()) * m), scratch(m);
  for (std::size_t i = 0; i < shots.size(); ++i)
    whiten(shots[i], model, p.data(), scratch.data(), z.data() + std::ptrdiff_t(i) * m);
  return z;
}

void ShotModel::linearise(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p,
                          Eigen::VectorXd& z, Eigen::MatrixXd& J) const {
  const int m = width();
  z.resize(std::ptrdiff_t(shots.size()) * m);
  J.resize(z.size(), p.size());
  Eigen::MatrixXd part(m, p.size());
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto at = std::ptrdiff_t(i) * m;
    linearise(shots[i], model, p.data(), kForward, false, z.segment(at, m), part);
    J.middleRows(at, m) = part;
  }
}

Eigen::MatrixXd ShotModel::jacobian(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p) const {
  const int m = width();
  Eigen::MatrixXd J(std::ptrdiff_t(shots.size()) * m, p.size()), part(m, p.size());
  Eigen::VectorXd z(m);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    linearise(shots[i], model, p.data(), kCentral, true, z, part);
    J.middleRows(std::ptrdiff_t(i) * m, m) = part;
  }
  return J;
}

}  // namespace hosel::loop
