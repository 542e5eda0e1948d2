#include "solvers/cvode.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <memory>
#include <string>

#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

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

/// What CVODE calls back.
struct Functions {
  const std::function<void(double, const double*, double*)>& rate;
  const std::function<double(double, const double*)>& event;

  static int rate_of(realtype t, N_Vector y, N_Vector dy, void* data) {
    static_cast<Functions*>(data)->rate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
  }
  static int event_of(realtype t, N_Vector y, realtype* g, void* data) {
    g[0] = static_cast<Functions*>(data)->event(t, N_VGetArrayPointer(y));
    return 0;
  }
};

}  // namespace

double integrate_to_event(const std::function<void(double, const double*, double*)>& rate,
                          const std::function<double(double, const double*)>& event, double t0, double latest,
                          std::span<double> y, const CvodeOptions& options, CvodeStatistics* statistics,
                          const std::function<void(double, const double*)>& watch) {
  const auto size = sunindextype(y.size());
  Functions functions{rate, event};
  SUNContext raw = nullptr;
  check(SUNContext_Create(nullptr, &raw), "context");
  // Freed in the order opposite to this one.
  const Owned<SUNContext, FreeContext> context(raw);
  const Owned<N_Vector, FreeVector> state(N_VNew_Serial(size, raw)), absolute(N_VNew_Serial(size, raw));
  std::ranges::copy(y, N_VGetArrayPointer(state.get()));
  std::ranges::copy(options.absolute, N_VGetArrayPointer(absolute.get()));
  const Owned<SUNMatrix, FreeMatrix> matrix(SUNDenseMatrix(size, size, raw));
  const Owned<SUNLinearSolver, FreeSolver> linear(SUNLinSol_Dense(state.get(), matrix.get(), raw));
  const Owned<void*, FreeMemory> memory(CVodeCreate(CV_BDF, raw));
  void* const m = memory.get();
  check(CVodeInit(m, Functions::rate_of, t0, state.get()), "initialisation");
  check(CVodeSetErrHandlerFn(m, quiet, nullptr), "initialisation");
  check(CVodeSetUserData(m, &functions), "initialisation");
  check(CVodeSVtolerances(m, options.relative_tolerance, absolute.get()), "tolerances");
  check(CVodeSetMaxNumSteps(m, options.most_steps), "step limit");
  if (options.first_step > 0) check(CVodeSetInitStep(m, options.first_step), "first step");
  if (options.largest_step > 0) check(CVodeSetMaxStep(m, options.largest_step), "largest step");
  check(CVodeSetLinearSolver(m, linear.get(), matrix.get()), "linear solver");
  check(CVodeRootInit(m, 1, Functions::event_of), "events");
  int falling = -1;
  check(CVodeSetRootDirection(m, &falling), "events");
  // Single steps would go past `latest`; otherwise CVODE interpolates there.
  if (watch) check(CVodeSetStopTime(m, latest), "stop time");
  realtype t = t0;
  for (;;) {
    const int code = CVode(m, latest, state.get(), &t, watch ? CV_ONE_STEP : CV_NORMAL);
    check(code, "integration");
    if (watch) watch(t, N_VGetArrayPointer(state.get()));
    if (code == CV_ROOT_RETURN) break;
    if (t >= latest) throw NonConvergence("CVODE: the event did not come in time");
  }
  std::ranges::copy_n(N_VGetArrayPointer(state.get()), size, y.begin());
  if (statistics) {
    long by_matrix = 0;
    CVodeGetNumSteps(m, &statistics->steps);
    CVodeGetNumRhsEvals(m, &statistics->rate_calls);
    CVodeGetNumLinRhsEvals(m, &by_matrix);
    statistics->rate_calls += by_matrix;
  }
  return t;
}

}  // namespace hosel::solvers
