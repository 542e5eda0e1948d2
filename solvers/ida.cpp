#include "solvers/ida.hpp"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <algorithm>
#include <string>

#include "solvers/errors.hpp"
#include "solvers/sundials.hpp"

namespace hosel::solvers {
namespace {

// Tolerances: relative; of positions [m] and quaternions' components; of velocities [m/s] and [rad/s].
constexpr double kRelative = 1e-6, kAbsolutePosition = 1e-7, kAbsoluteVelocity = 1e-4;

using fem::Index;
using fem::Vector;

struct Problem {
  const fem::System& system;
  std::vector<Index> q_at, v_at;  // place of each block's q and v among the unknowns
  std::vector<bool> imposed;      // by block
  Index size = 0, half_band = 0;

  explicit Problem(const fem::System& s) : system(s) {
    const auto& blocks = s.dof_map.blocks();
    std::vector<bool> held(static_cast<std::size_t>(s.dof_map.size()), false);
    for (const auto& p : s.prescribed)
      for (Index e : p->dofs()) held[static_cast<std::size_t>(e)] = true;
    std::vector<Index> first(static_cast<std::size_t>(s.dof_map.size())), last = first;
    for (const auto& b : blocks) {
      q_at.push_back(size);
      v_at.push_back(size + (b.rotation ? 4 : b.size));
      imposed.push_back(held[static_cast<std::size_t>(b.v)]);
      const Index end = v_at.back() + b.size;
      for (Index i = 0; i < b.size; ++i) {
        first[static_cast<std::size_t>(b.v + i)] = size;
        last[static_cast<std::size_t>(b.v + i)] = end - 1;
      }
      size = end;
    }
    std::vector<std::vector<Index>> pattern;
    for (const auto& term : s.terms) term->pattern(pattern);
    for (const auto& block : pattern) {
      Index low = size, high = 0;
      for (Index e : block) {
        low = std::min(low, first[static_cast<std::size_t>(e)]);
        high = std::max(high, last[static_cast<std::size_t>(e)]);
      }
      half_band = std::max(half_band, high - low);
    }
  }

  fem::State unpack(double t, const double* y, const double* yp) const {
    fem::State s = system.dof_map.rest();
    s.time = t;
    const auto& blocks = system.dof_map.blocks();
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const auto& b = blocks[i];
      const Index nq = b.rotation ? 4 : b.size;
      s.q.segment(b.q, nq) = Eigen::Map<const Vector>(y + q_at[i], nq);
      s.v.segment(b.v, b.size) = Eigen::Map<const Vector>(y + v_at[i], b.size);
      if (yp) s.a.segment(b.v, b.size) = Eigen::Map<const Vector>(yp + v_at[i], b.size);
      if (b.rotation) s.q.segment<4>(b.q).normalize();
    }
    return s;
  }
};

Eigen::Vector4d quaternion_rate(const double* y, const double* w) {
  const Eigen::Vector4d c = Eigen::Map<const Eigen::Vector4d>(y);
  const Eigen::Quaterniond q(c);
  return 0.5 * (q * Eigen::Quaterniond(0, w[0], w[1], w[2])).coeffs();
}

int residual(double t, N_Vector yv, N_Vector ypv, N_Vector fv, void* user) {
  const auto& p = *static_cast<Problem*>(user);
  const double *y = N_VGetArrayPointer(yv), *yp = N_VGetArrayPointer(ypv);
  double* f = N_VGetArrayPointer(fv);
  fem::State s = p.unpack(t, y, yp);
  for (const auto& m : p.system.prescribed) m->impose(s);
  Vector inertia = Vector::Zero(p.system.dof_map.size()), force = inertia;
  for (const auto& term : p.system.terms) term->residual(s, inertia, force);
  const auto& blocks = p.system.dof_map.blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& b = blocks[i];
    const Index nq = b.rotation ? 4 : b.size, q = p.q_at[i], v = p.v_at[i];
    if (p.imposed[i]) {
      double sign = 1;
      if (b.rotation && Eigen::Map<const Eigen::Vector4d>(y + q).dot(s.q.segment<4>(b.q)) < 0) sign = -1;
      for (Index k = 0; k < nq; ++k) f[q + k] = y[q + k] - sign * s.q[b.q + k];
      for (Index k = 0; k < b.size; ++k) f[v + k] = y[v + k] - s.v[b.v + k];
      continue;
    }
    if (b.rotation)
      Eigen::Map<Eigen::Vector4d>(f + q) = Eigen::Map<const Eigen::Vector4d>(yp + q) - quaternion_rate(y + q, y + v);
    else
      for (Index k = 0; k < nq; ++k) f[q + k] = yp[q + k] - y[v + k];
    for (Index k = 0; k < b.size; ++k) f[v + k] = inertia[b.v + k] + force[b.v + k];
  }
  return 0;
}

}  // namespace

void integrate_ida(const fem::System& system, const fem::State& initial, const std::vector<double>& times,
                   const std::function<void(const fem::State&)>& observer) {
  Problem problem(system);
  const sundials::Context owner = sundials::context();
  SUNContext context = owner.get();
  const auto n = static_cast<sunindextype>(problem.size);
  const sundials::Vector y(N_VNew_Serial(n, context)), yp(N_VNew_Serial(n, context)),
      tolerance(N_VNew_Serial(n, context));
  double *py = N_VGetArrayPointer(y.get()), *pyp = N_VGetArrayPointer(yp.get()),
         *pt = N_VGetArrayPointer(tolerance.get());
  const auto& blocks = system.dof_map.blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& b = blocks[i];
    const Index nq = b.rotation ? 4 : b.size;
    for (Index k = 0; k < nq; ++k)
      py[problem.q_at[i] + k] = initial.q[b.q + k], pt[problem.q_at[i] + k] = kAbsolutePosition;
    for (Index k = 0; k < b.size; ++k) {
      py[problem.v_at[i] + k] = initial.v[b.v + k];
      pyp[problem.v_at[i] + k] = initial.a[b.v + k];
      pt[problem.v_at[i] + k] = kAbsoluteVelocity;
      if (!b.rotation) pyp[problem.q_at[i] + k] = initial.v[b.v + k];
    }
    if (b.rotation)
      Eigen::Map<Eigen::Vector4d>(pyp + problem.q_at[i]) = quaternion_rate(py + problem.q_at[i], py + problem.v_at[i]);
  }
  const auto band = static_cast<sunindextype>(problem.half_band);
  const sundials::Matrix J(SUNBandMatrix(n, band, band, context));
  const sundials::LinearSolver linear(SUNLinSol_Band(y.get(), J.get(), context));
  const sundials::Memory<IDAFree> memory(IDACreate(context));
  void* const ida = memory.get();
  sundials::check(IDAInit(ida, residual, initial.time, y.get(), yp.get()), "IDA: initialisation");
  sundials::check(IDASetErrHandlerFn(ida, sundials::quiet, nullptr), "IDA: initialisation");
  sundials::check(IDASVtolerances(ida, kRelative, tolerance.get()), "IDA: tolerances");
  sundials::check(IDASetUserData(ida, &problem), "IDA: initialisation");
  sundials::check(IDASetMaxNumSteps(ida, 1000000), "IDA: step limit");
  sundials::check(IDASetLinearSolver(ida, linear.get(), J.get()), "IDA: linear solver");
  double reached = initial.time;
  for (double t : times) {
    sundials::check(IDASetStopTime(ida, t), "IDA: stop time");
    const int status = IDASolve(ida, t, &reached, y.get(), yp.get(), IDA_NORMAL);
    if (status < 0)
      throw NonConvergence("IDA stopped at t = " + std::to_string(reached) + " s (flag " + std::to_string(status) +
                           "): loosen its tolerances, or look for a jump in the motion");
    fem::State s = problem.unpack(t, py, pyp);
    for (const auto& m : system.prescribed) m->impose(s);
    observer(s);
  }
}

}  // namespace hosel::solvers
