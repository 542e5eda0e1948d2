/// Time integration of a fem::System: Lie-group generalized-alpha with fixed steps, halved where one fails.
///
/// M. Arnold, O. Bruels, "Convergence of the generalized-alpha scheme for constrained mechanical
/// systems", Multibody Syst. Dyn. 18 (2007) 185-202, in the form without constraints:
///   x          = h v_n + h^2 ((1/2 - beta) a_n + beta a_{n+1}),   q_{n+1} = q_n o exp(x)
///   v_{n+1}    = v_n + h ((1 - gamma) a_n + gamma a_{n+1})
///   (1 - am) a_{n+1} + am a_n = (1 - af) vdot_{n+1} + af vdot_n
///   inertia(q, v, vdot) + force(q, v) = 0   at t_{n+1}
/// with am = (2 rho - 1)/(rho + 1), af = rho/(rho + 1), gamma = 1/2 + af - am, beta = (gamma + 1/2)^2/4.
/// fem::State::a holds vdot; the auxiliary acceleration a is the scheme's own.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "solvers/contact_newton.hpp"

namespace hosel::solvers {

struct GeneralizedAlphaOptions {
  double rho_inf = -1;  ///< spectral radius at infinite frequency, in [0, 1]; must be stated
  NewtonOptions newton;
  double step_max = 0;    ///< the fixed step [s]
  double step_min = 0;    ///< below this a failing step gives up [s]
  double step_first = 0;  ///< 0: step_max [s]
  /// First guess of a step: accelerations go on as they changed in the last one or two, or (false) there are none: the
  /// better guess where contact makes them jump.
  bool predict_acceleration = true;

  std::vector<std::string> faults() const;
};

/// Where the energy is [J]. Each column is worked out for itself; `closure` is what does not add up:
/// initial total + external - (kinetic + strain + contact + friction + viscous + numerical).
struct Ledger {
  double time = 0;
  double kinetic = 0;
  std::vector<std::pair<std::string, double>> strain;  ///< by body, in order of first appearance
  double contact = 0, friction = 0, viscous = 0;
  /// Taken by the scheme: sum over steps of 1/2 (I_n + I_{n+1}) . x - (T_{n+1} - T_n), with I the
  /// inertial forces.
  double numerical = 0;
  double external = 0;  ///< by loads, gravity and imposed motions
  double initial = 0;   ///< kinetic + strain + contact at the start
  double closure = 0;

  double strain_total() const;
};

/// All that a run needs to go on where it was: exactly, unless it foresees accelerations (`predict_acceleration`),
/// whose first step then begins from another guess.
struct Checkpoint {
  fem::State state;
  Vector auxiliary;
  double step = 0, last_step = 0;
  Ledger ledger;
  double friction_before = 0, viscous_before = 0, external_before = 0;
  std::vector<double> history;  ///< of the terms, in their order
};

class GeneralizedAlpha {
 public:
  /// `system` must outlive this. Imposed motions overwrite the initial state; State::a is ignored: zero where the start
  /// is balanced to the absolute tolerance of Newton, solved for else. Throws std::invalid_argument on bad options,
  /// NonConvergence where a mass matrix that is asked is singular.
  GeneralizedAlpha(fem::System& system, GeneralizedAlphaOptions options, fem::State initial);

  /// One accepted step, no further than `end`; shortened on failure of Newton. Throws
  /// NonConvergence when it would fall below step_min. Returns the size of the step [s].
  double advance(double end);
  /// Tries one step of exactly `h`; on failure nothing has changed but the multipliers that contact begins with.
  NewtonReport step(double h);

  const fem::State& state() const { return state_; }
  double time() const { return state_.time; }
  const Ledger& ledger() const { return ledger_; }
  /// inertia + force at the accepted state: on imposed equations what holds them there, zero elsewhere
  /// to the tolerance of Newton.
  const Vector& reactions() const { return residual_; }

  struct Counts {
    long steps = 0, rejected = 0, iterations = 0, factorisations = 0, dense_factorisations = 0;
    double worst_residual = 0;  ///< that an accepted step left, over the scale of the forces [-]
    friend Counts operator+(const Counts& a, const Counts& b) {
      return {a.steps + b.steps,
              a.rejected + b.rejected,
              a.iterations + b.iterations,
              a.factorisations + b.factorisations,
              a.dense_factorisations + b.dense_factorisations,
              std::max(a.worst_residual, b.worst_residual)};
    }
  };
  const Counts& counts() const { return counts_; }

  Checkpoint checkpoint() const;
  void restore(const Checkpoint& saved);

 private:
  /// `abrupt`, where given: the share of the abrupt terms, already in `force`.
  void evaluate(const fem::State& s, Vector& inertia, Vector& force, Vector* abrupt = nullptr) const;
  void impose(fem::State& s) const;
  NewtonReport attempt(double h);
  void accept(double h, const NewtonReport& report);
  void take_stock();  // fills the ledger's state columns

  fem::System& system_;
  GeneralizedAlphaOptions options_;
  double am_, af_, beta_, gamma_;
  bool contact_;  // whether some term is abrupt
  SparseTangent tangent_;
  Newton newton_;
  ContactNewton contact_newton_;  // instead, where some term is
  fem::State state_, trial_;
  Vector auxiliary_, trial_auxiliary_, increment_;
  Vector earlier_a_, earliest_a_;  // of the one and two states before, a step apart; empty at the start
  Vector inertia_, trial_inertia_, trial_force_, residual_;
  std::vector<Index> imposed_;
  double step_ = 0, last_step_ = 0, tangent_step_ = 0;
  double friction_before_ = 0, viscous_before_ = 0,
         external_before_ = 0;  // what the terms' cumulative figures began with
  double imposed_work_ = 0;
  Ledger ledger_;
  Counts counts_;
};

}  // namespace hosel::solvers
