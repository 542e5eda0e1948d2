#include "hosel/solvers/cvode.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <memory>
#include <string>

#include "hosel/solvers/errors.hpp"

namespace hosel::solvers {
namespace {

struct Problem {
  const std::function<void(double, const double*, double*)>& rate;
  const std::function<double(double, const double*)>& event;
};

int rate_of(realtype t, N_Vector y, N_Vector dy, void* data) {
  static_cast<Problem*>(data)->rate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
  return 0;
}

int event_of(realtype t, N_Vector y, realtype* g, void* data) {
  g[0] = static_cast<Problem*>(data)->event(t, N_VGetArrayPointer(y));
  return 0;
}

void quiet(int, const char*, const char*, char*, void*) {}  // failures come back as codes

void check(int code, const char* what) {
  if (code < 0) throw NonConvergence(std::string("CVODE: ") + what + " failed with code " + std::to_string(code));
}

struct FreeContext {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
};
struct FreeVector {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
struct FreeMatrix {
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
};
struct FreeSolver {
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
struct FreeMemory {
  void operator()(void* m) const { CVodeFree(&m); }
};
template <class Handle, class Deleter>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Deleter>;

}  // namespace

double integrate_to_event(const std::function<void(double, const double*, double*)>& rate,
                          const std::function<double(double, const double*)>& event, double t0, double latest,
                          std::span<double> y, const CvodeOptions& options, CvodeStatistics* statistics,
                          const std::function<void(double, const double*)>& watch) {
  SUNContext raw = nullptr;
  check(SUNContext_Create(nullptr, &raw), "context");
  const Owned<SUNContext, FreeContext> context(raw);
  const auto n = static_cast<sunindextype>(y.size());
  const Owned<N_Vector, FreeVector> state(N_VMake_Serial(n, y.data(), raw));
  const Owned<N_Vector, FreeVector> absolute(N_VNew_Serial(n, raw));
  for (sunindextype i = 0; i < n; ++i)
    NV_Ith_S(absolute.get(), i) = options.absolute.empty() ? options.absolute_tolerance : options.absolute[i];
  const Owned<void*, FreeMemory> memory(CVodeCreate(CV_BDF, raw));
  Problem problem{rate, event};
  check(CVodeInit(memory.get(), rate_of, t0, state.get()), "initialisation");
  check(CVodeSetErrHandlerFn(memory.get(), quiet, nullptr), "initialisation");
  check(CVodeSetUserData(memory.get(), &problem), "initialisation");
  check(CVodeSVtolerances(memory.get(), options.relative_tolerance, absolute.get()), "tolerances");
  check(CVodeSetMaxNumSteps(memory.get(), options.most_steps), "step limit");
  if (options.first_step > 0) check(CVodeSetInitStep(memory.get(), options.first_step), "first step");
  if (options.largest_step > 0) check(CVodeSetMaxStep(memory.get(), options.largest_step), "largest step");
  const Owned<SUNMatrix, FreeMatrix> matrix(SUNDenseMatrix(n, n, raw));
  const Owned<SUNLinearSolver, FreeSolver> solver(SUNLinSol_Dense(state.get(), matrix.get(), raw));
  check(CVodeSetLinearSolver(memory.get(), solver.get(), matrix.get()), "linear solver");
  check(CVodeRootInit(memory.get(), 1, event_of), "event");
  int falling = -1;
  check(CVodeSetRootDirection(memory.get(), &falling), "event");

  realtype t = t0;
  int code = CV_SUCCESS;
  while (code != CV_ROOT_RETURN) {
    code = CVode(memory.get(), latest, state.get(), &t, watch ? CV_ONE_STEP : CV_NORMAL);
    check(code, "integration");
    if (watch) watch(t, y.data());
    if (code != CV_ROOT_RETURN && t >= latest) throw NonConvergence("CVODE: the event did not come in time");
  }
  if (statistics) {
    CVodeGetNumSteps(memory.get(), &statistics->steps);
    CVodeGetNumRhsEvals(memory.get(), &statistics->rate_calls);
    long by_matrix = 0;
    CVodeGetNumLinRhsEvals(memory.get(), &by_matrix);
    statistics->rate_calls += by_matrix;
    CVodeGetNumGEvals(memory.get(), &statistics->root_calls);
    CVodeGetNumLinSolvSetups(memory.get(), &statistics->factorisations);
  }
  return t;
}

}  // namespace hosel::solvers
