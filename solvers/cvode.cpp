#include "solvers/cvode.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>

#include "solvers/sundials.hpp"

namespace hosel::solvers {
namespace {

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
  const sundials::Context context = sundials::context();
  SUNContext raw = context.get();
  const sundials::Vector state(N_VNew_Serial(size, raw)), absolute(N_VNew_Serial(size, raw));
  std::ranges::copy(y, N_VGetArrayPointer(state.get()));
  std::ranges::copy(options.absolute, N_VGetArrayPointer(absolute.get()));
  const sundials::Matrix matrix(SUNDenseMatrix(size, size, raw));
  const sundials::LinearSolver linear(SUNLinSol_Dense(state.get(), matrix.get(), raw));
  const sundials::Memory<CVodeFree> memory(CVodeCreate(CV_BDF, raw));
  void* const m = memory.get();
  sundials::check(CVodeInit(m, Functions::rate_of, t0, state.get()), "CVODE: initialisation");
  sundials::check(CVodeSetErrHandlerFn(m, sundials::quiet, nullptr), "CVODE: initialisation");
  sundials::check(CVodeSetUserData(m, &functions), "CVODE: initialisation");
  sundials::check(CVodeSVtolerances(m, options.relative_tolerance, absolute.get()), "CVODE: tolerances");
  sundials::check(CVodeSetMaxNumSteps(m, 100000), "CVODE: step limit");
  // By default seven: a corner of friction may ask for a smaller step than they lead to.
  sundials::check(CVodeSetMaxErrTestFails(m, 30), "CVODE: failures of a step");
  if (options.first_step > 0) sundials::check(CVodeSetInitStep(m, options.first_step), "CVODE: first step");
  if (options.largest_step > 0) sundials::check(CVodeSetMaxStep(m, options.largest_step), "CVODE: largest step");
  sundials::check(CVodeSetLinearSolver(m, linear.get(), matrix.get()), "CVODE: linear solver");
  sundials::check(CVodeRootInit(m, 1, Functions::event_of), "CVODE: events");
  int falling = -1;
  sundials::check(CVodeSetRootDirection(m, &falling), "CVODE: events");
  // Single steps would go past `latest`; otherwise CVODE interpolates there.
  if (watch) sundials::check(CVodeSetStopTime(m, latest), "CVODE: stop time");
  realtype t = t0;
  for (;;) {
    const int code = CVode(m, latest, state.get(), &t, watch ? CV_ONE_STEP : CV_NORMAL);
    sundials::check(code, "CVODE: integration");
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
