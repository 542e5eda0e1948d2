#include "solvers/cvode.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
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
struct FreeFixedPoint {
  void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFree(s); }
};
struct FreeMemory {
  void operator()(void* m) const { CVodeFree(&m); }
};
template <class Handle, class Deleter>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Deleter>;

}  // namespace

struct Cvode::Impl {
  Rate rate;
  Events events;
  CvodeMethod method;
  std::vector<int> fallen;
  // Freed in the order opposite to this one.
  Owned<SUNContext, FreeContext> context;
  Owned<N_Vector, FreeVector> state, between, absolute;
  Owned<SUNMatrix, FreeMatrix> matrix;
  Owned<SUNLinearSolver, FreeSolver> linear;
  Owned<SUNNonlinearSolver, FreeFixedPoint> fixed_point;
  Owned<void*, FreeMemory> memory;

  static int rate_of(realtype t, N_Vector y, N_Vector dy, void* data) {
    static_cast<Impl*>(data)->rate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
  }
  static int events_of(realtype t, N_Vector y, realtype* g, void* data) {
    static_cast<Impl*>(data)->events(t, N_VGetArrayPointer(y), g);
    return 0;
  }

  Impl(int size, Rate f, int count, Events g, const CvodeOptions& options)
      : rate(std::move(f)), events(std::move(g)), method(options.method), fallen(std::size_t(count)) {
    SUNContext raw = nullptr;
    check(SUNContext_Create(nullptr, &raw), "context");
    context.reset(raw);
    state.reset(N_VNew_Serial(size, raw));
    between.reset(N_VNew_Serial(size, raw));
    absolute.reset(N_VNew_Serial(size, raw));
    N_VConst(0, state.get());
    for (sunindextype i = 0; i < size; ++i)
      NV_Ith_S(absolute.get(), i) = options.absolute.empty() ? options.absolute_tolerance
                                                             : options.absolute[std::size_t(i)];
    memory.reset(CVodeCreate(method == CvodeMethod::bdf ? CV_BDF : CV_ADAMS, raw));
    check(CVodeInit(memory.get(), rate_of, 0, state.get()), "initialisation");
    check(CVodeSetErrHandlerFn(memory.get(), quiet, nullptr), "initialisation");
    check(CVodeSetUserData(memory.get(), this), "initialisation");
    check(CVodeSVtolerances(memory.get(), options.relative_tolerance, absolute.get()), "tolerances");
    check(CVodeSetMaxNumSteps(memory.get(), options.most_steps), "step limit");
    if (options.first_step > 0) check(CVodeSetInitStep(memory.get(), options.first_step), "first step");
    if (options.largest_step > 0) check(CVodeSetMaxStep(memory.get(), options.largest_step), "largest step");
    if (method == CvodeMethod::bdf) {
      matrix.reset(SUNDenseMatrix(size, size, raw));
      linear.reset(SUNLinSol_Dense(state.get(), matrix.get(), raw));
      check(CVodeSetLinearSolver(memory.get(), linear.get(), matrix.get()), "linear solver");
    } else {
      fixed_point.reset(SUNNonlinSol_FixedPoint(state.get(), 0, raw));
      check(CVodeSetNonlinearSolver(memory.get(), fixed_point.get()), "fixed-point solver");
    }
    check(CVodeRootInit(memory.get(), count, events_of), "events");
    std::vector<int> falling(std::size_t(count), -1);
    check(CVodeSetRootDirection(memory.get(), falling.data()), "events");
  }
};

Cvode::Cvode(int size, Rate rate, int events, Events g, const CvodeOptions& options)
    : impl_(std::make_unique<Impl>(size, std::move(rate), events, std::move(g), options)) {}
Cvode::~Cvode() = default;
Cvode::Cvode(Cvode&&) noexcept = default;

void Cvode::start(double t0, std::span<const double> y0) {
  std::ranges::copy(y0, N_VGetArrayPointer(impl_->state.get()));
  check(CVodeReInit(impl_->memory.get(), t0, impl_->state.get()), "initialisation");
}

Cvode::Stop Cvode::run(double latest, const std::function<void(double, const double*)>& watch) {
  Impl& s = *impl_;
  // Single steps would go past `latest`; otherwise CVODE interpolates there.
  if (watch) check(CVodeSetStopTime(s.memory.get(), latest), "stop time");
  realtype t = 0;
  for (;;) {
    const int code = CVode(s.memory.get(), latest, s.state.get(), &t, watch ? CV_ONE_STEP : CV_NORMAL);
    check(code, "integration");
    if (watch) watch(t, N_VGetArrayPointer(s.state.get()));
    if (code == CV_ROOT_RETURN) {
      check(CVodeGetRootInfo(s.memory.get(), s.fallen.data()), "events");
      return {t, int(std::ranges::find_if(s.fallen, [](int i) { return i != 0; }) - s.fallen.begin())};
    }
    if (t >= latest) return {t, {}};
  }
}

void Cvode::interpolate(double t, std::span<double> y) const {
  check(CVodeGetDky(impl_->memory.get(), t, 0, impl_->between.get()), "interpolation");
  std::ranges::copy_n(N_VGetArrayPointer(impl_->between.get()), long(y.size()), y.begin());
}

std::span<const double> Cvode::state() const {
  return {N_VGetArrayPointer(impl_->state.get()), std::size_t(NV_LENGTH_S(impl_->state.get()))};
}

CvodeStatistics Cvode::statistics() const {
  CvodeStatistics out;
  void* m = impl_->memory.get();
  CVodeGetNumSteps(m, &out.steps);
  CVodeGetNumRhsEvals(m, &out.rate_calls);
  CVodeGetNumGEvals(m, &out.root_calls);
  if (impl_->method == CvodeMethod::bdf) {
    long by_matrix = 0;
    CVodeGetNumLinRhsEvals(m, &by_matrix);
    out.rate_calls += by_matrix;
    CVodeGetNumLinSolvSetups(m, &out.factorisations);
  }
  return out;
}

double integrate_to_event(const std::function<void(double, const double*, double*)>& rate,
                          const std::function<double(double, const double*)>& event, double t0, double latest,
                          std::span<double> y, const CvodeOptions& options, CvodeStatistics* statistics,
                          const std::function<void(double, const double*)>& watch) {
  Cvode solver(
      int(y.size()), rate, 1, [&](double t, const double* state, double* g) { g[0] = event(t, state); }, options);
  solver.start(t0, y);
  const Cvode::Stop stop = solver.run(latest, watch);
  if (!stop.event) throw NonConvergence("CVODE: the event did not come in time");
  std::ranges::copy(solver.state(), y.begin());
  if (statistics) *statistics = solver.statistics();
  return stop.time;
}

}  // namespace hosel::solvers
