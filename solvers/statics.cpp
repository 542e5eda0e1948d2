#include "solvers/statics.hpp"

#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

#include "solvers/contact_newton.hpp"
#include "solvers/errors.hpp"
#include "solvers/sundials.hpp"

namespace hosel::solvers {
namespace {

constexpr int kBisections = 8;  // of failing load steps

}  // namespace

fem::State solve_static(const fem::System& system, const fem::State& start, const StaticsOptions& options) {
  if (options.load_steps < 1) throw std::invalid_argument("statics: at least one load step");
  const bool contact = std::ranges::any_of(system.terms, [](const auto& term) { return term->abrupt(); });
  SparseTangent tangent(system, contact ? SparseTangent::Terms::smooth : SparseTangent::Terms::all);
  Newton newton(system, tangent, options.newton);
  ContactNewton contact_newton(system, tangent, options.newton);
  fem::State out = start;
  for (const auto& p : system.prescribed) p->impose(out);
  double scale0 = 0;
  fem::begin_step(system);
  const Vector r0 = tangent.gather(fem::unbalanced(system, out, &scale0));
  double done = 0, step = 1.0 / options.load_steps;
  int bisections = 0, augmented = 0;
  fem::State trial = out;
  while (done < 1) {
    double next = done + step;
    if (next > 1 - 1e-9) next = 1;
    trial = out;
    Vector full = Vector::Zero(system.dof_map.size());
    const auto residual = [&](double& scale) {
      const Vector r = tangent.gather(fem::unbalanced(system, trial, &scale)) - (1 - next) * r0;
      scale = std::max(scale, scale0);
      return r;
    };
    const auto assemble = [&] {
      tangent.assemble(system, trial, {1, 0, 0});
      return tangent.round_off(system, trial);
    };
    // What contact alone holds has no stiffness of its own: a trace on the diagonal lets it be factorised.
    const auto assemble_held = [&](double trace) {
      const double round_off = assemble();
      for (std::size_t c = 0; c + 1 < tangent.column_starts().size(); ++c)
        for (int k = tangent.column_starts()[c]; k < tangent.column_starts()[c + 1]; ++k)
          if (tangent.row_indices()[static_cast<std::size_t>(k)] == static_cast<int>(c))
            tangent.values()[static_cast<std::size_t>(k)] *= 1 + 1e-9 * trace;
      return round_off;
    };
    const auto advance = [&](const Vector& dx) {
      tangent.scatter(dx, full);
      trial.q = system.dof_map.advanced(trial.q, full);
    };
    const NewtonReport report =
        contact ? contact_newton.solve({[&](double& scale, Vector& abrupt) {
                                          abrupt = tangent.gather(abrupt_residual(system, trial));
                                          return residual(scale);
                                        },
                                        assemble_held, [&] { return tangent.gather(abrupt_residual(system, trial)); },
                                        [&](DenseTangent& sink) {
                                          abrupt_tangent(system, trial, {1, 0, 0}, sink);
                                        },
                                        advance})
                : newton.solve({residual, assemble, advance});
    if (report.converged && next == 1 && fem::augment(system, trial)) {
      out = trial;
      if (++augmented > options.newton.max_iterations)
        throw NonConvergence("no static equilibrium found: the multipliers of the contact do not settle");
    } else if (report.converged) {
      out = trial;
      done = next;
    } else if (++bisections > kBisections) {
      throw NonConvergence("no static equilibrium found at " + std::to_string(100 * next) + " % of the load (" +
                           report.reason + "): use more load steps, or look for a body that nothing holds");
    } else {
      step /= 2;
    }
  }
  return out;
}

namespace {

struct KinsolProblem {
  const fem::System& system;
  const fem::State& start;
  SparseTangent tangent;
  fem::State trial;
  Vector x;  // full increment from the start

  void set(N_Vector y) {
    tangent.scatter(Eigen::Map<const Vector>(N_VGetArrayPointer(y), tangent.size()), x);
    trial.q = system.dof_map.advanced(start.q, x);
  }
};

int kinsol_residual(N_Vector y, N_Vector f, void* user) {
  auto& p = *static_cast<KinsolProblem*>(user);
  p.set(y);
  Eigen::Map<Vector>(N_VGetArrayPointer(f), p.tangent.size()) = p.tangent.gather(fem::unbalanced(p.system, p.trial));
  return 0;
}

int kinsol_tangent(N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector) {
  auto& p = *static_cast<KinsolProblem*>(user);
  p.set(y);
  p.tangent.assemble(p.system, p.trial, {1, 0, 0});
  Eigen::Map<Eigen::MatrixXd> columns(SUNDenseMatrix_Data(J), p.tangent.size(), p.tangent.size());
  columns = p.tangent.dense();
  // Unknown is the whole rotation since the start, not the next increment.
  for (const auto& b : p.system.dof_map.blocks())
    if (const int first = p.tangent.row(b.v); b.rotation && first >= 0 && p.tangent.row(b.v + 2) == first + 2)
      columns.middleCols<3>(first) *= fem::rotation_tangent(p.x.segment<3>(b.v));
  return 0;
}

}  // namespace

fem::State solve_static_kinsol(const fem::System& system, const fem::State& start, double residual_tolerance) {
  fem::State from = start;
  for (const auto& p : system.prescribed) p->impose(from);
  KinsolProblem problem{system, from, SparseTangent(system), from, Vector::Zero(system.dof_map.size())};
  const auto n = static_cast<sunindextype>(problem.tangent.size());
  const sundials::Context owner = sundials::context();
  SUNContext context = owner.get();
  const sundials::Vector y(N_VNew_Serial(n, context)), ones(N_VNew_Serial(n, context));
  N_VConst(0, y.get());
  N_VConst(1, ones.get());
  const sundials::Matrix J(SUNDenseMatrix(n, n, context));
  const sundials::LinearSolver linear(SUNLinSol_Dense(y.get(), J.get(), context));
  const sundials::Memory<KINFree> memory(KINCreate(context));
  void* const kin = memory.get();
  sundials::check(KINInit(kin, kinsol_residual, y.get()), "KINSOL: initialisation");
  sundials::check(KINSetErrHandlerFn(kin, sundials::quiet, nullptr), "KINSOL: initialisation");
  sundials::check(KINSetUserData(kin, &problem), "KINSOL: initialisation");
  sundials::check(KINSetLinearSolver(kin, linear.get(), J.get()), "KINSOL: linear solver");
  sundials::check(KINSetJacFn(kin, kinsol_tangent), "KINSOL: tangent");
  sundials::check(KINSetFuncNormTol(kin, residual_tolerance), "KINSOL: tolerance");
  sundials::check(KINSetMaxNewtonStep(kin, 1e3), "KINSOL: largest step");
  sundials::check(KINSetMaxSetupCalls(kin, 1), "KINSOL: tangents");
  const int status = KINSol(kin, y.get(), KIN_LINESEARCH, ones.get(), ones.get());
  problem.set(y.get());
  if (status != KIN_SUCCESS && status != KIN_INITIAL_GUESS_OK)  // a step too short to go on is no equilibrium
    throw NonConvergence("KINSOL found no static equilibrium (flag " + std::to_string(status) +
                         "): start nearer to it, or look for a body that nothing holds");
  return problem.trial;
}

}  // namespace hosel::solvers
