#include "solvers/generalized_alpha.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

/// x with q1 = q0 o exp(x).
Vector difference(const fem::DofMap& dof_map, const Vector& q0, const Vector& q1) {
  Vector x(dof_map.size());
  for (const auto& b : dof_map.blocks()) {
    if (!b.rotation) {
      x.segment(b.v, b.size) = q1.segment(b.q, b.size) - q0.segment(b.q, b.size);
      continue;
    }
    const Eigen::Quaterniond r0(Eigen::Vector4d(q0.segment<4>(b.q))), r1(Eigen::Vector4d(q1.segment<4>(b.q)));
    x.segment<3>(b.v) = fem::rotation_log(r0.conjugate() * r1);
  }
  return x;
}

/// The mean of all rotations; the identity where there are none.
Mat3 mean_rotation(const fem::DofMap& dof_map, const Vector& q) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const auto& b : dof_map.blocks()) {
    if (!b.rotation) continue;
    const auto r = q.segment<4>(b.q);
    sum += r.dot(sum) < 0 ? -r : Eigen::Vector4d(r);
  }
  return sum.isZero() ? Mat3(Mat3::Identity()) : Eigen::Quaterniond(sum.normalized()).toRotationMatrix();
}

}  // namespace

std::vector<std::string> GeneralizedAlphaOptions::faults() const {
  std::vector<std::string> out = newton.faults();
  if (!(rho_inf >= 0 && rho_inf <= 1)) out.emplace_back("state rho_inf, in [0, 1]");
  if (!(step_max > 0)) out.emplace_back("state step_max, above zero");
  if (!(step_min > 0 && step_min <= step_max)) out.emplace_back("state step_min, above zero and not above step_max");
  if (!(step_first >= 0 && step_first <= step_max)) out.emplace_back("step_first lies between zero and step_max");
  return out;
}

double Ledger::strain_total() const {
  double sum = 0;
  for (const auto& [body, value] : strain) sum += value;
  return sum;
}

GeneralizedAlpha::GeneralizedAlpha(fem::System& system, GeneralizedAlphaOptions options, fem::State initial)
    : system_(system),
      options_(options),
      contact_(std::ranges::any_of(system.terms, [](const auto& term) { return term->abrupt(); })),
      tangent_(system, contact_ ? SparseTangent::Terms::smooth : SparseTangent::Terms::all),
      newton_(system, tangent_, options.newton),
      contact_newton_(system, tangent_, options.newton),
      state_(std::move(initial)) {
  if (const auto faults = options.faults(); !faults.empty())
    throw std::invalid_argument("generalized-alpha: " + faults.front());
  const double rho = options.rho_inf;
  am_ = (2 * rho - 1) / (rho + 1);
  af_ = rho / (rho + 1);
  gamma_ = 0.5 + af_ - am_;
  beta_ = 0.25 * (gamma_ + 0.5) * (gamma_ + 0.5);
  for (const auto& p : system.prescribed) imposed_.insert(imposed_.end(), p->dofs().begin(), p->dofs().end());
  step_ = options.step_first > 0 ? options.step_first : options.step_max;

  state_.a = Vector::Zero(system.dof_map.size());
  impose(state_);
  evaluate(state_, trial_inertia_, trial_force_);
  if (tangent_.size() > 0) {
    const Vector right = -tangent_.gather(trial_inertia_ + trial_force_);
    // A residual that Newton's method would leave needs no acceleration: what starts unloaded.
    if (right.norm() > options_.newton.residual_absolute) {
      tangent_.assemble(system_, state_, {0, 0, 1});
      Factorisation mass;
      mass.factorise(tangent_);
      tangent_.scatter(mass.solve(right), state_.a);
    }
  }
  auxiliary_ = state_.a;
  evaluate(state_, inertia_, trial_force_);
  residual_ = inertia_ + trial_force_;
  for (const auto& term : system_.terms) term->commit(state_);
  take_stock();
  ledger_.initial = ledger_.kinetic + ledger_.strain_total() + ledger_.contact;
  friction_before_ = ledger_.friction;
  viscous_before_ = ledger_.viscous;
  external_before_ = ledger_.external;
  take_stock();
}

void GeneralizedAlpha::impose(fem::State& s) const {
  for (const auto& p : system_.prescribed) p->impose(s);
}

void GeneralizedAlpha::evaluate(const fem::State& s, Vector& inertia, Vector& force, Vector* abrupt) const {
  inertia.setZero(system_.dof_map.size());
  force.setZero(system_.dof_map.size());
  for (const auto& term : system_.terms)
    if (!abrupt || !term->abrupt()) term->residual(s, inertia, force);
  if (!abrupt) return;
  *abrupt = abrupt_residual(system_, s);
  force += *abrupt;
}

NewtonReport GeneralizedAlpha::attempt(double h) {
  // The auxiliary acceleration stands for vdot at t_n + (am - af) h: it moves when h changes.
  Vector a0 = auxiliary_;
  if (last_step_ > 0 && h != last_step_) a0 = state_.a + (h / last_step_) * (auxiliary_ - state_.a);

  const double to_v = gamma_ / (beta_ * h), to_a = (1 - am_) / (beta_ * h * h * (1 - af_));
  trial_ = state_;
  trial_.time = state_.time + h;
  Vector a1;
  if (options_.predict_acceleration) {
    // Through three states where steps are equal, else through two.
    if (earliest_a_.size() > 0 && h == last_step_) trial_.a += 2 * state_.a - 3 * earlier_a_ + earliest_a_;
    else if (earlier_a_.size() > 0) trial_.a += (h / last_step_) * (state_.a - earlier_a_);
    a1 = ((1 - af_) * trial_.a + af_ * state_.a - am_ * a0) / (1 - am_);
  } else {
    a1 = (1 - 0.5 / beta_) * a0;  // increment h v_n
    trial_.a = ((1 - am_) * a1 + am_ * a0 - af_ * state_.a) / (1 - af_);
  }
  increment_ = h * state_.v + h * h * ((0.5 - beta_) * a0 + beta_ * a1);
  trial_.v = state_.v + h * ((1 - gamma_) * a0 + gamma_ * a1);
  trial_.q = system_.dof_map.advanced(state_.q, increment_);
  if (!imposed_.empty()) {
    impose(trial_);
    const Vector x = difference(system_.dof_map, state_.q, trial_.q);
    for (Index e : imposed_) increment_[e] = x[e];
  }

  Vector full = Vector::Zero(system_.dof_map.size());
  const auto residual = [&](double& scale, Vector* abrupt = nullptr) {
    evaluate(trial_, trial_inertia_, trial_force_, abrupt);
    if (abrupt) *abrupt = tangent_.gather(*abrupt);
    scale = trial_inertia_.norm() + trial_force_.norm();
    return tangent_.gather(trial_inertia_ + trial_force_);
  };
  const auto assemble = [&](double inertia) {
    // Without the exponential map's tangent: by a step's turn it refines little, and with contact it would leave the
    // factors not symmetric.
    tangent_.assemble(system_, trial_, {1, to_v, inertia * to_a});
    tangent_step_ = h;
    return tangent_.round_off(system_, trial_);
  };
  const auto advance = [&](const Vector& dx) {
    tangent_.scatter(dx, full);
    increment_ += full;
    trial_.v += to_v * full;
    trial_.a += to_a * full;
    trial_.q = system_.dof_map.advanced(state_.q, increment_);
    if (!imposed_.empty()) impose(trial_);
  };
  if (std::abs(h - tangent_step_) > 0.1 * tangent_step_) {
    newton_.forget();
    contact_newton_.forget();
  }
  fem::begin_step(system_);
  const auto solve = [&] {
    if (!contact_)
      return newton_.solve({[&](double& scale) { return residual(scale); }, [&] { return assemble(1); }, advance,
                            [&] { return mean_rotation(system_.dof_map, trial_.q); }});
    return contact_newton_.solve({[&](double& scale, Vector& abrupt) { return residual(scale, &abrupt); }, assemble,
                                  [&] { return tangent_.gather(abrupt_residual(system_, trial_)); },
                                  [&](DenseTangent& sink) {
                                    abrupt_tangent(system_, trial_, {1, to_v, to_a}, sink);
                                  },
                                  advance});
  };
  NewtonReport report;
  for (int solutions = 0; solutions == 0 || fem::augment(system_, trial_); ++solutions) {
    report = solve();
    counts_.iterations += report.iterations;
    counts_.factorisations += report.factorisations;
    counts_.dense_factorisations += report.dense_factorisations;
    if (report.converged && solutions == options_.newton.max_iterations) {
      report.converged = false;
      report.reason = "the multipliers of the contact do not settle";
    }
    if (!report.converged) return report;
  }

  trial_auxiliary_ = ((1 - af_) * trial_.a + af_ * state_.a - am_ * a0) / (1 - am_);
  return report;
}

void GeneralizedAlpha::accept(double h, const NewtonReport& report) {
  const double kinetic = ledger_.kinetic;
  for (Index e : imposed_) imposed_work_ += 0.5 * (residual_[e] + trial_inertia_[e] + trial_force_[e]) * increment_[e];
  const double inertial_work = 0.5 * (inertia_ + trial_inertia_).dot(increment_);
  std::swap(state_, trial_);
  if (!contact_ && h == last_step_) std::swap(earliest_a_, earlier_a_);
  else earliest_a_.resize(0);
  std::swap(earlier_a_, trial_.a);
  auxiliary_ = trial_auxiliary_;
  residual_ = trial_inertia_ + trial_force_;
  std::swap(inertia_, trial_inertia_);
  last_step_ = h;
  for (const auto& term : system_.terms) term->commit(state_);
  take_stock();
  ledger_.numerical += inertial_work - (ledger_.kinetic - kinetic);
  ledger_.closure = ledger_.initial + ledger_.external - ledger_.kinetic - ledger_.strain_total() - ledger_.contact -
                    ledger_.friction - ledger_.viscous - ledger_.numerical;
  ++counts_.steps;
  if (report.scale > 0) counts_.worst_residual = std::max(counts_.worst_residual, report.residual / report.scale);
}

void GeneralizedAlpha::take_stock() {
  ledger_.time = state_.time;
  ledger_.kinetic = ledger_.contact = ledger_.friction = ledger_.viscous = 0;
  ledger_.external = imposed_work_ - external_before_;
  for (auto& [body, value] : ledger_.strain) value = 0;
  for (const auto& term : system_.terms) {
    const fem::Energies e = term->energies(state_);
    ledger_.kinetic += e.kinetic;
    ledger_.contact += e.contact;
    ledger_.friction += e.friction;
    ledger_.viscous += e.viscous;
    ledger_.external += e.external;
    const std::string body = term->body();
    auto it = std::ranges::find(ledger_.strain, body, &std::pair<std::string, double>::first);
    if (it == ledger_.strain.end()) it = ledger_.strain.insert(it, {body, 0.0});
    it->second += e.strain;
  }
  ledger_.viscous -= viscous_before_;
  ledger_.friction -= friction_before_;
}

NewtonReport GeneralizedAlpha::step(double h) {
  NewtonReport report = attempt(h);
  if (report.converged) accept(h, report);
  else ++counts_.rejected;
  return report;
}

double GeneralizedAlpha::advance(double end) {
  const double left = end - state_.time;
  if (!(left > 0)) throw std::invalid_argument("generalized-alpha: the end of a step lies not ahead of it");
  double h = std::max(step_, options_.step_min);
  // The last two steps share what is left, so that no sliver remains.
  if (h >= left * (1 - 1e-9)) h = left;
  else if (2 * h > left) h = left / 2;
  for (;;) {
    const NewtonReport report = attempt(h);
    if (report.converged) {
      accept(h, report);
      step_ = std::min(options_.step_max, 2 * step_);  // back up after a failure
      return h;
    }
    ++counts_.rejected;
    h *= 0.5;
    step_ = h;
    if (h < options_.step_min) {
      std::ostringstream text;
      text << "at t = " << state_.time << " s the time step fell below its minimum of " << options_.step_min << " s ("
           << report.reason << "): allow smaller steps, or look for a load or stiffness that is out of scale";
      throw NonConvergence(text.str());
    }
  }
}

Checkpoint GeneralizedAlpha::checkpoint() const {
  Checkpoint c{state_,  auxiliary_,       step_,           last_step_,
               ledger_, friction_before_, viscous_before_, external_before_ - imposed_work_,
               {}};
  for (const auto& term : system_.terms) term->save(c.history);
  return c;
}

void GeneralizedAlpha::restore(const Checkpoint& saved) {
  if (saved.state.q.size() != state_.q.size() || saved.state.v.size() != state_.v.size() ||
      saved.state.a.size() != state_.a.size() || saved.auxiliary.size() != auxiliary_.size())
    throw std::invalid_argument("the checkpoint is of another system");
  state_ = saved.state;
  auxiliary_ = saved.auxiliary;
  step_ = saved.step;
  last_step_ = saved.last_step;
  ledger_ = saved.ledger;
  friction_before_ = saved.friction_before;
  viscous_before_ = saved.viscous_before;
  external_before_ = saved.external_before;
  imposed_work_ = 0;
  earlier_a_.resize(0);
  earliest_a_.resize(0);
  std::span<const double> history = saved.history;
  for (const auto& term : system_.terms) term->restore(history);
  if (!history.empty()) throw std::invalid_argument("the checkpoint is of another system");
  evaluate(state_, inertia_, trial_force_);
  residual_ = inertia_ + trial_force_;
  newton_.forget();
  contact_newton_.forget();
}

}  // namespace hosel::solvers
