#include "loop/shots/model.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <stdexcept>

#include "golf/dense.hpp"
#include "golf/first_contact.hpp"
#include "golf/quantities.hpp"
#include "loop/rules.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "solvers/errors.hpp"

namespace hosel::loop {
namespace {

constexpr double kForward = 1e-5;  // one-sided difference steps, of a parameter's scale
// Flights step where their error tells them to, so that neighbours differ by their tolerance: closer, and wider apart.
constexpr double kFlightStep = 1e-2;
constexpr models::FlightOptions kFlight = {.tolerance = 1e-6};

/// Moves the loft by secants until `miss`, which rises with it, is less than `enough` or no number. Returns the last
/// miss that was computed.
double follow_loft(double& loft, int most, double enough, const auto& miss) {
  double slope = kLaunchPerLoft, before = 0, step = 0;
  for (int k = 0; k < most; ++k) {
    const double now = miss();
    if (!std::isfinite(now) || std::abs(now) < enough) return now;
    if (k > 0 && std::abs(now - before) > 1e-14) slope = std::clamp((now - before) / step, 0.2, 2.0);
    before = now;
    step = -now / slope;
    loft += step;
  }
  return before;
}

}  // namespace

Launch plus(Launch a, const Launch& b, double times) {
  a.velocity += times * b.velocity;
  a.spin += times * b.spin;
  a.head_velocity += times * b.head_velocity;
  a.head_spin += times * b.head_spin;
  return a;
}

int flight_answer(Output o) {
  static_assert(
      models::kFlightAnswers == kOutputs - kLaunchOutputs && int(Output::carry) - kLaunchOutputs == models::kCarry &&
      int(Output::side) - kLaunchOutputs == models::kSide && int(Output::apex) - kLaunchOutputs == models::kApex &&
      int(Output::flight_time) - kLaunchOutputs == models::kTime &&
      int(Output::landing_angle) - kLaunchOutputs == models::kLandingAngle);
  return int(o) - kLaunchOutputs;
}

const models::ImpactModel& closed_form() {
  static const models::RigidEccentric model;
  return model;
}

namespace {

/// The contact law by which the closed form makes the base's speed along the normal and its spin, as far as one does:
/// what an effect changes depends on it.
ContactLaw like(Blow blow, const Launch& base) {
  const ContactLaw declared = blow.contact;
  const FirstContact g = first_contact(blow);
  const Vec3 axis = g.normal.cross(g.slip()).normalized();
  const auto of = [&](const Launch& l) { return Eigen::Vector2d(l.velocity.dot(g.normal), l.spin.dot(axis)); };
  for (int pass = 0; pass < 3; ++pass) {
    const Eigen::Vector2d now = of(closed_form().launch(blow));
    Eigen::Matrix2d slope;
    int column = 0;
    for (double* x : {&blow.contact.restitution, &blow.contact.tangential_restitution}) {
      *x += kCoarseStep;
      slope.col(column++) = (of(closed_form().launch(blow)) - now) / kCoarseStep;
      *x -= kCoarseStep;
    }
    const Eigen::Vector2d change = slope.inverse() * (of(base) - now);
    blow.contact.restitution += change[0];
    blow.contact.tangential_restitution += change[1];
  }
  const ContactLaw& law = blow.contact;
  const bool possible = law.normal_restitution(g.closing_speed(), 0) > 0 && std::abs(law.tangential_restitution) < 1;
  return possible ? law : declared;
}

}  // namespace

solvers::Loss loss_of_shot(int channels) {
  const double knee = quantile(complement(boost::math::chi_squared(channels), kByChance));
  return {solvers::Loss::Tail::logarithmic, knee, 12 * knee, channels};
}

std::vector<Stage> stages_of_shots(int channels) {
  const solvers::Loss loss = loss_of_shot(channels);
  return {{.loss = loss.uncapped()}, {.loss = loss}};
}

ShotModel::ShotModel(const models::ImpactModel& base, bool direct, std::vector<Shot> trials,
                     std::vector<ShotChannel> channels, Eigen::MatrixXd measured, const Surrogate* surrogate,
                     std::optional<SeenLaunch> seen, std::optional<models::FlightConditions> flight)
    : base_(base),
      direct_(direct || surrogate),
      surrogate_(surrogate),
      seen_(std::move(seen)),
      trials_(std::move(trials)),
      channels_(std::move(channels)),
      measured_(std::move(measured)),
      flight_(std::move(flight)),
      flies_(std::ranges::any_of(channels_, [](const ShotChannel& c) { return of_flight(c.output); })) {
  if (flies_)
    for (int i = 0; i < shots(); ++i) follow_seen(i);
  expected_ = measured_;
  if (!direct_) {
    offset_.reserve(trials_.size());
    for (Shot& t : trials_) {
      try {
        const Launch by_base = base_.launch(t.blow);
        t.blow.contact = like(t.blow, by_base);
        offset_.emplace_back(plus(by_base, closed_form().launch(t.blow), -1));
      } catch (const std::invalid_argument&) { offset_.emplace_back(); } catch (const solvers::NonConvergence&) {
        offset_.emplace_back();
      }
      t.blow.club.shaft.reset();  // the companion needs none, and copies stay cheap
    }
  }
}

std::map<Output, double> ShotModel::seen(int shot) const {
  std::map<Output, double> out;
  for (int c = 0; c < width(); ++c)
    if (observed(shot, c)) out[channel(c).output] = measured_(shot, c) * channel(c).si;
  if (seen_) out[seen_->channel.output] = seen_->value[shot] * seen_->channel.si;
  return out;
}

Launch ShotModel::answer(const Shot& trial, int shot) const {
  if (surrogate_) return surrogate_->launch(trial);
  if (direct_) return base_.launch(trial.blow);
  const Launch l = closed_form().launch(trial.blow);
  if (shot < 0) return l;
  if (!offset_[shot]) throw std::invalid_argument("the base has no answer to this blow");
  return plus(l, *offset_[shot], 1);
}

void ShotModel::change(const Model& model, const double* parameters, Shot& trial) {
  model.each(parameters, [&](const Parametrisation& f, Sizes p) {
    if (f.before) f.before(p, trial);
  });
}

void ShotModel::change(const Model& model, const double* parameters, const Shot& trial, Launch& launch) {
  model.each(parameters, [&](const Parametrisation& f, Sizes p) {
    if (f.after) f.after(p, trial, launch);
  });
}

Launch ShotModel::launched(Shot& trial, int shot, const Model& model, const double* parameters) const {
  change(model, parameters, trial);
  Launch launch = answer(trial, shot);
  change(model, parameters, trial, launch);
  return launch;
}

double ShotModel::reading(const ShotChannel& channel, const Shot& trial, const Model& model, const double* parameters,
                          double value) const {
  model.each(parameters, [&](const Parametrisation& f, Sizes p) {
    if (f.reading) value = f.reading(p, trial, channel.output, value);
  });
  return value;
}

double ShotModel::seen_angle(const Shot& trial, const Model& model, const double* parameters, const Launch& l) const {
  return reading(seen_->channel, trial, model, parameters, get(l, seen_->channel.output));
}

void ShotModel::follow_seen(int shot) {
  std::optional<Launch>& seen = trials_[shot].seen;
  models::FlightAnswers& flight = flights_.emplace_back(models::FlightAnswers::Zero());
  try {
    if (seen) flight = models::answers(models::fly(*seen, trials_[shot].blow.ball, *flight_, kFlight));
  } catch (const std::invalid_argument&) { seen.reset(); } catch (const solvers::NonConvergence&) {
    seen.reset();
  }
  if (seen) return;
  for (int c = 0; c < width(); ++c)
    if (of_flight(channels_[c].output)) measured_(shot, c) = kNaN;
}

models::FlightConditions ShotModel::conditions(const Model& model, const double* parameters) const {
  models::FlightConditions changed = *flight_;
  model.each(parameters, [&](const Parametrisation& f, Sizes p) {
    if (f.flight) f.flight(p, changed);
  });
  return changed;
}

models::FlightAnswers ShotModel::follow(const Shot& trial, int shot, const Model& model, const double* p,
                                        const Launch& launch) const {
  const bool changed = std::ranges::any_of(model.forms, [](const Parametrisation* f) { return bool(f->flight); });
  // Not seen: no reading is compared with what stands here.
  if (shot >= 0 && (!changed || !trial.seen)) return flights_[shot];
  try {
    return models::answers(models::fly(trial.seen.value_or(launch), trial.blow.ball, conditions(model, p), kFlight));
  } catch (const solvers::NonConvergence& e) { throw std::invalid_argument(e.what()); }
}

bool ShotModel::read(const Shot& trial, int shot, const Model& model, const double* parameters, const Launch& launch,
                     double* out) const {
  bool good = true;
  models::FlightAnswers flight;
  if (flies_) flight = follow(trial, shot, model, parameters, launch);
  for (int c = 0; c < width(); ++c) {
    const ShotChannel& channel = channels_[c];
    const double base = of_flight(channel.output) ? flight[flight_answer(channel.output)] : get(launch, channel.output);
    double value = reading(channel, trial, model, parameters, base);
    if (shot >= 0 && is_angle(channel.output) && observed(shot, c))
      value -= 2 * kPi * std::round((value - measured_(shot, c) * channel.si) / (2 * kPi));
    out[c] = value / channel.si;
    good = good && std::isfinite(out[c]);
  }
  return good;
}

bool ShotModel::find_loft(Shot& trial, int shot, const Model& model, const double* parameters) const {
  const double left = follow_loft(trial.blow.delivery.dynamic_loft, 30, 1e-11, [&] {
    Shot t = trial;
    const Launch l = launched(t, shot, model, parameters);
    return seen_angle(t, model, parameters, l) - seen_->value[shot] * seen_->channel.si;
  });
  return std::abs(left) < 1e-7;
}

bool ShotModel::asked(int shot, const Model& model, const double* parameters, Shot& out) const {
  try {
    out = trial(shot);
    if (seen_ && !find_loft(out, shot, model, parameters)) return false;
    change(model, parameters, out);
    return true;
  } catch (const std::invalid_argument&) { return false; }
}

bool ShotModel::predict_by(const Surrogate::Answer& other, int shot, const Model& model, const double* parameters,
                           double* out) const {
  Shot there = trial(shot);
  if (seen_ && !find_loft(there, shot, model, parameters)) return false;
  Shot t;
  Launch l;
  const double enough = radians(0.02);
  const double left = follow_loft(there.blow.delivery.dynamic_loft, 12, enough, [&] {
    t = there;
    change(model, parameters, t);
    l = other(t);
    change(model, parameters, t, l);
    return seen_ ? seen_angle(t, model, parameters, l) - seen_->value[shot] * seen_->channel.si : 0.0;
  });
  return std::abs(left) < enough && read(t, shot, model, parameters, l, out);
}

bool ShotModel::predict(const Shot& trial, int shot, const Model& model, const double* parameters, double* out) const {
  try {
    Shot t = trial;
    if (seen_ && shot >= 0 && !find_loft(t, shot, model, parameters)) return false;
    const Launch l = launched(t, shot, model, parameters);
    return read(t, shot, model, parameters, l, out);
  } catch (const std::invalid_argument&) { return false; }
}

bool ShotModel::differences(const Shot& trial, int shot, const Model& model, const double* parameters, bool central,
                            double* out, double* derivative) const {
  const double step = central ? kStep : kForward;
  try {
    Shot near = trial;
    if (seen_ && shot >= 0 && !find_loft(near, shot, model, parameters)) return false;
    Shot t = near;
    change(model, parameters, t);
    const Launch bare = answer(t, shot);
    Launch l = bare;
    change(model, parameters, t, l);
    if (!read(t, shot, model, parameters, l, out)) return false;
    const int m = width();
    std::array<double, 64> moved{};
    std::array<double, 16> there{}, here{};
    const int n = model.size();
    if (n > int(moved.size()) || m > int(there.size())) throw std::length_error("too many parameters for one model");
    std::copy_n(parameters, n, moved.begin());
    int k = 0;
    for (const Parametrisation* f : model.forms)
      for (const Parameter& q : f->parameters) {
        const double share = f->flight ? std::max(step, kFlightStep) : step;
        const double h = share * q.scale, at = moved[k];
        const auto look = [&](double x, double* values) {
          moved[k] = x;
          bool good = false;
          if (f->before || seen_) {
            good = predict(near, shot, model, moved.data(), values);
          } else if (f->after) {
            Launch other = bare;
            change(model, moved.data(), t, other);
            good = read(t, shot, model, moved.data(), other, values);
          } else {
            good = read(t, shot, model, moved.data(), l, values);
          }
          moved[k] = at;
          return good;
        };
        if (!look(at + h, there.data())) return false;
        if (central && !look(at - h, here.data())) return false;
        for (int c = 0; c < m; ++c)
          derivative[k * m + c] = central ? (there[c] - here[c]) / (2 * share) : (there[c] - out[c]) / share;
        ++k;
      }
    return true;
  } catch (const std::invalid_argument&) { return false; }
}

bool ShotModel::launch(Shot t, const Model& model, const double* parameters, Launch& out) const {
  try {
    out = launched(t, -1, model, parameters);
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

Eigen::VectorXd ShotModel::by_curvature(int shot, const Model& model, const double* parameters,
                                        const Eigen::MatrixXd& covariance) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(width()), up(width()), middle(width()), down(width());
  if (!predict(shot, model, parameters, middle.data())) return sum;
  const auto [variances, directions, converged] = dense::eigenpairs(covariance);
  for (Eigen::Index k = 0; k < kInputs; ++k) {
    if (!(variances[k] > 0)) continue;
    const Eigen::VectorXd step = std::sqrt(variances[k]) * directions.col(k);
    const auto look = [&](double way, Eigen::VectorXd& out) {
      Shot t = trial(shot);
      for (int i = 0; i < kInputs; ++i)
        if (step[i] != 0) set(t.blow, Input(i), get(t.blow, Input(i)) + way * step[i]);
      return predict(t, shot, model, parameters, out.data());
    };
    if (look(1, up) && look(-1, down)) sum += (up + down) / 2 - middle;
  }
  return sum;
}

ShotModel::Shown ShotModel::shown(int shot, const Shot& t, const Model& model, const double* parameters) const {
  const int m = width();
  // What the channels (and, last, the launch angle) show of an error of the answer.
  const auto show = [&](const Shot& s, Launch l) {
    change(model, parameters, s, l);
    Eigen::VectorXd out(m + 1);
    read(s, shot, model, parameters, l, out.data());
    out[m] = seen_ ? seen_angle(s, model, parameters, l) / seen_->channel.si : 0;
    return out;
  };
  Shown out{Eigen::VectorXd::Zero(m), Eigen::MatrixXd::Zero(m, 6)};
  if (seen_) {
    const double h = 1e-4;
    Shot up = t, down = t;
    up.blow.delivery.dynamic_loft += h;
    down.blow.delivery.dynamic_loft -= h;
    const Eigen::VectorXd d = show(up, answer(up, shot)) - show(down, answer(down, shot));
    out.by_launch = d.head(m) / d[m];
  }
  if (!surrogate_) return out;
  const double h = 1e-5;
  const Launch told = answer(t, shot);
  const auto off = [&](const Vec6& error) { return show(t, Surrogate::shifted(told, t, error)); };
  for (Eigen::Index k = 0; k < out.by_error.cols(); ++k) {
    const Eigen::VectorXd d = (off(h * Vec6::Unit(k)) - off(-h * Vec6::Unit(k))) / (2 * h);
    out.by_error.col(k) = d.head(m) - out.by_launch * d[m];
  }
  return out;
}

Eigen::MatrixXd ShotModel::found_covariance(int shot, const Model& model, const double* parameters) const {
  Shot t;
  Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(width(), width());
  if (!asked(shot, model, parameters, t)) return cov;
  try {
    const Shown see = shown(shot, t, model, parameters);
    if (seen_) cov += std::pow(seen_->channel.noise, 2) * see.by_launch * see.by_launch.transpose();
    if (surrogate_) cov += see.by_error * surrogate_->error(t) * see.by_error.transpose();
  } catch (const std::invalid_argument&) {}
  return cov;
}

Eigen::MatrixXd ShotModel::surrogate_errors(const std::vector<int>& shots, const Model& model,
                                            const double* parameters) const {
  const int m = width();
  const auto n = Eigen::Index(shots.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n * m, n * m);
  if (!surrogate_) return out;
  std::vector<Shot> asks(shots.size());
  Eigen::MatrixXd show = Eigen::MatrixXd::Zero(n * m, 6);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int shot = shots[i];
    Shot& t = asks[i];
    if (!asked(shot, model, parameters, t)) t = trial(shot);  // shows nothing
    else show.middleRows(i * m, m) = whitening(shot) * shown(shot, t, model, parameters).by_error;
  }
  const Eigen::MatrixXd together = surrogate_->errors_together(asks);
  const Mat6 scale = surrogate_->error_scale();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      out.block(i * m, j * m, m, m) = together(i, j) *
                                      (show.middleRows(i * m, m) * scale * show.middleRows(j * m, m).transpose());
  return out;
}

void ShotModel::add_launch_noise(int shot, const models::FlightConditions& conditions,
                                 Eigen::MatrixXd& covariance) const {
  const std::optional<Launch>& seen = trial(shot).seen;
  if (!seen || !(seen->spin_rate() > 0)) return;  // without spin a flight has no derivative
  const models::FlightJacobian by = models::flight_jacobian(*seen, trial(shot).blow.ball, conditions);
  const double tilt = seen->spin_axis(), rate = seen->spin_rate();
  for (int c = 0; c < width(); ++c) {
    const ShotChannel& launch = channels_[c];
    if (of_flight(launch.output) || !observed(shot, c)) continue;
    models::FlightAnswers slope;
    switch (launch.output) {
      case Output::ball_speed: slope = by.col(models::kBallSpeed); break;
      case Output::launch_angle: slope = by.col(models::kLaunchAngle); break;
      case Output::azimuth: slope = by.col(models::kAzimuth); break;
      case Output::backspin: slope = by.col(models::kBackspin); break;
      case Output::sidespin: slope = by.col(models::kSidespin); break;
      case Output::spin_rate:
        slope = std::cos(tilt) * by.col(models::kBackspin) + std::sin(tilt) * by.col(models::kSidespin);
        break;
      default:  // spin_axis
        slope = rate * (std::cos(tilt) * by.col(models::kSidespin) - std::sin(tilt) * by.col(models::kBackspin));
    }
    const double sd = launch.noise * launch.si;
    const auto moved = [&](int a) {
      const ShotChannel& f = channels_[a];
      return of_flight(f.output) ? sd * slope[flight_answer(f.output)] / f.si : 0.0;
    };
    for (int a = 0; a < width(); ++a) {
      for (int b = 0; b < width(); ++b) covariance(a, b) += moved(a) * moved(b);
      // A launch read too high lowers its own residual and raises the flight's.
      covariance(a, c) -= moved(a) * launch.noise;
      covariance(c, a) -= moved(a) * launch.noise;
    }
  }
}

Eigen::MatrixXd ShotModel::scattered(int shot, const Model& model, const double* parameters) const {
  const int m = width();
  Eigen::MatrixXd carried = Eigen::MatrixXd::Zero(m, scatter_.cols());  // model minus measured
  unsigned mask = 0;
  for (int k = 0; k < kInputs; ++k)
    if (scatter_(k, k) > 0 && !(seen_ && Input(k) == Input::dynamic_loft)) mask |= 1U << k;
  if (mask) carried.leftCols(kInputs) = input_jacobian(shot, model, parameters, mask);
  if (Shot t; seen_ && asked(shot, model, parameters, t)) try {
      carried.col(kInputs + int(seen_->channel.output)) = shown(shot, t, model, parameters).by_launch /
                                                          seen_->channel.si;
    } catch (const std::invalid_argument&) {}
  for (int c = 0; c < m; ++c) carried(c, kInputs + int(channel(c).output)) -= 1 / channel(c).si;
  return carried * scatter_ * carried.transpose() / count(shot);
}

ShotModel::Varied ShotModel::varied(int shot, const Model& model, const double* parameters, const Varying& by) const {
  const Model with = model.with(&by.form);
  std::vector<double> p(parameters, parameters + model.size());
  p.resize(p.size() + by.form.parameters.size(), 0.0);
  double& value = p[std::size_t(model.size()) + by.parameter];
  Eigen::VectorXd up(width()), middle(width()), down(width());
  if (predict(shot, with, p.data(), middle.data()))
    for (double part = 1; part > 1e-2; part /= 2) {  // so near a limit of the model, a smaller difference
      value = part * by.sd;
      if (!predict(shot, with, p.data(), up.data())) continue;
      value = -part * by.sd;
      if (!predict(shot, with, p.data(), down.data())) continue;
      return {(up - down) / (2 * part), ((up + down) / 2 - middle) / (part * part)};
    }
  return {Eigen::VectorXd::Zero(width()), Eigen::VectorXd::Zero(width())};
}

void ShotModel::set_covariance(const std::vector<Eigen::MatrixXd>& inputs, const Model& model,
                               const double* parameters) {
  const int m = width();
  whiten_.assign(std::size_t(shots()) * std::size_t(m) * std::size_t(m), 0.0);
  sigma_.resize(shots(), m);
  expected_ = measured_;
  for (int i = 0; i < shots(); ++i) {
    Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(m, m);
    if (count_.empty())
      for (int c = 0; c < m; ++c) cov(c, c) = std::pow(channel(c).noise, 2);
    else cov = scattered(i, model, parameters);
    if (flies_) add_launch_noise(i, conditions(model, parameters), cov);
    if (!inputs.empty()) {
      const Eigen::MatrixXd& sx = inputs[i];
      unsigned mask = 0;
      for (int k = 0; k < kInputs; ++k) mask |= unsigned(sx(k, k) > 0) << k;
      if (mask) {
        const Eigen::MatrixXd J = input_jacobian(i, model, parameters, mask);
        cov += J * sx * J.transpose();
        expected_.row(i) -= by_curvature(i, model, parameters, sx).transpose();
      }
    }
    for (const Varying& v : varying_) {
      const auto [linear, square] = varied(i, model, parameters, v);
      cov += linear * linear.transpose() + 2 * square * square.transpose();
      expected_.row(i) -= square.transpose();  // heads that differ miss by that much on average
    }
    if (surrogate_ || seen_) cov += found_covariance(i, model, parameters);
    sigma_.row(i) = cov.diagonal().cwiseSqrt().transpose();
    std::vector<int> seen;
    for (int c = 0; c < m; ++c)
      if (observed(i, c)) seen.push_back(c);
    const int k = int(seen.size());
    if (!k) continue;
    const Eigen::MatrixXd W = dense::Cholesky(cov(seen, seen)).lower_inverse();
    double* out = whiten_.data() + std::ptrdiff_t(i) * m * m;
    for (int a = 0; a < k; ++a)
      for (int b = 0; b <= a; ++b) out[seen[a] * m + seen[b]] = W(a, b);
  }
}

Eigen::MatrixXd ShotModel::residuals(const Model& model, const double* parameters) const {
  Eigen::MatrixXd r(shots(), width());
  Eigen::VectorXd out(width());
  for (int i = 0; i < shots(); ++i) {
    if (predict(i, model, parameters, out.data())) r.row(i) = out.transpose() - expected_.row(i);
    else r.row(i).setConstant(kNaN);
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
  for (int c = 0; c < m; ++c) scratch[c] = observed(shot, c) ? scratch[c] - expected_(shot, c) : 0.0;
  out.noalias() = whitening(shot) * Eigen::Map<const Eigen::VectorXd>(scratch, m);
}

void ShotModel::linearise(int shot, const Model& model, const double* p, bool central, Eigen::Ref<Eigen::VectorXd> z,
                          Eigen::MatrixXd& J) const {
  const int m = width();
  std::array<double, 16> scratch{};
  if (!differences(trial(shot), shot, model, p, central, scratch.data(), J.data())) {
    J.setZero();
    whiten(shot, model, p, scratch.data(), z.data());
    return;
  }
  for (int c = 0; c < m; ++c) {
    const bool seen = observed(shot, c);
    scratch[c] = seen ? scratch[c] - expected_(shot, c) : 0.0;
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
                          Eigen::VectorXd& z, Eigen::MatrixXd& J, bool central) const {
  const int m = width();
  z.resize(std::ptrdiff_t(shots.size()) * m);
  J.resize(z.size(), p.size());
  Eigen::MatrixXd part(m, p.size());
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto at = std::ptrdiff_t(i) * m;
    linearise(shots[i], model, p.data(), central, z.segment(at, m), part);
    J.middleRows(at, m) = part;
  }
}

Eigen::MatrixXd ShotModel::jacobian(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p) const {
  Eigen::MatrixXd J;
  Eigen::VectorXd z;
  linearise(shots, model, p, z, J, true);
  return J;
}

}  // namespace hosel::loop
