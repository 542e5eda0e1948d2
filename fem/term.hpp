/// One physical contribution to the equations of motion, and the system that gathers them.
///
/// The equations at time t are   inertia(q, v, a, t) + force(q, v, t) = 0,
/// `force` being internal minus external. A term adds to one or both, gives its tangent and its
/// energies, and owns its history (viscous strains, friction tractions): history moves only in
/// commit(). Evaluations at a trial state are made against the last accepted state.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "fem/state.hpp"

namespace hosel::fem {

/// Weights of the tangent: stiffness * d/dq + damping * d/dv + mass * d/da, where d/dq is taken
/// along body-frame increments for rotations.
struct Weights {
  double stiffness = 0, damping = 0, mass = 0;
};

/// Where a tangent goes: dense blocks at lists of equation numbers; the pattern is fixed at set-up.
class TangentSink {
 public:
  virtual ~TangentSink() = default;
  /// Adds `block` (row-major meaning irrelevant: block(i, j) at row rows[i], column columns[j]).
  virtual void add(const std::vector<Index>& rows, const std::vector<Index>& columns,
                   const Eigen::Ref<const Eigen::MatrixXd>& block) = 0;
  /// Adds blocks whose rows and columns are alike, one after the other or at once.
  virtual void add_all(const std::vector<std::vector<Index>>& equations, const std::vector<Eigen::MatrixXd>& blocks);
};

/// Joules. Stored energies are states; dissipations and external work are cumulative since the start.
struct Energies {
  double kinetic = 0;
  double strain = 0;    ///< elastic storage, equilibrium and viscous branches
  double contact = 0;   ///< stored by the contact's penalty
  double friction = 0;  ///< dissipated by sliding, cumulative
  double viscous = 0;   ///< dissipated by materials and dampers, cumulative
  double external = 0;  ///< work done on the system by loads, gravity and prescribed motion, cumulative
};

class Term {
 public:
  virtual ~Term() = default;
  /// "ball", "shaft", "head", "contact": the body whose column of the ledger this term feeds.
  virtual std::string body() const = 0;
  /// Lists of equations that this term couples (each a dense block of the pattern).
  virtual void pattern(std::vector<std::vector<Index>>& blocks) const = 0;
  /// Adds to both vectors (DofMap::size() entries).
  virtual void residual(const State& trial, Vector& inertia, Vector& force) const = 0;
  virtual void tangent(const State& trial, const Weights& weights, TangentSink& sink) const = 0;
  /// Whether the tangent changes at once as points touch, stick or slide, and is unsymmetric: solvers keep
  /// what is smooth and symmetric apart.
  virtual bool abrupt() const { return false; }
  /// Equations, appended, that the others feel little through this term's stiffness and not at all through its mass:
  /// factors that a solver iterates with may leave their coupling out.
  virtual void weakly_coupled(std::vector<Index>& equations) const { (void)equations; }
  /// A step is attempted from the last accepted state: multipliers become those that it begins with.
  virtual void begin_step() {}
  /// The step has been solved at `trial`: whether multipliers have changed, so that it is to be solved again.
  virtual bool augment(const State& trial) {
    (void)trial;
    return false;
  }
  /// At the accepted state (cumulative figures as of the last commit()).
  virtual Energies energies(const State& accepted) const = 0;
  /// The step from the last accepted state to this one is accepted: history moves, work accumulates.
  /// The initial state of a run is accepted first.
  virtual void commit(const State& accepted) { (void)accepted; }
  /// The history as numbers, appended for a restart; restore() takes them back from the front.
  virtual void save(std::vector<double>& history) const { (void)history; }
  virtual void restore(std::span<const double>& history) { (void)history; }
};

/// Appends numbers, flags and ranges of numbers to a history.
template <class... Part>
void put(std::vector<double>& history, const Part&... parts) {
  const auto one = [&](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(part)>>) history.push_back(part);
    else history.insert(history.end(), part.begin(), part.end());
  };
  (one(parts), ...);
}
/// Takes them back from its front, in the same order. Throws std::invalid_argument(`fault`) where it is too short.
template <class... Part>
void take(std::span<const double>& history, const char* fault, Part&... parts) {
  const auto number = [&] {
    if (history.empty()) throw std::invalid_argument(fault);
    const double x = history.front();
    history = history.subspan(1);
    return x;
  };
  const auto one = [&](auto& part) {
    if constexpr (std::is_same_v<decltype(part), bool&>) part = number() != 0;
    else if constexpr (std::is_same_v<decltype(part), double&>) part = number();
    else
      for (double& x : part) x = number();
  };
  (one(parts), ...);
}

/// A motion imposed on some equations: q, v, a are given, the residual there is a reaction.
class Prescribed {
 public:
  virtual ~Prescribed() = default;
  virtual const std::vector<Index>& dofs() const = 0;
  /// Writes q (whole blocks), v and a of the imposed motion at state.time.
  virtual void impose(State& state) const = 0;
};

struct System {
  DofMap dof_map;
  std::vector<std::unique_ptr<Term>> terms;
  std::vector<std::unique_ptr<Prescribed>> prescribed;
};

/// inertia + force of all terms. `scale`, where given, becomes what that is small against: the sum of their norms.
Vector unbalanced(const System& system, const State& trial, double* scale = nullptr);
/// Term::begin_step() and Term::augment() of all terms.
void begin_step(const System& system);
bool augment(const System& system, const State& trial);

}  // namespace hosel::fem
