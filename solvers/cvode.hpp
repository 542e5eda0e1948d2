/// Stiff ordinary differential equations up to an event, by SUNDIALS CVODE.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace hosel::solvers {

struct CvodeOptions {
  double relative_tolerance = 1e-9;
  double absolute_tolerance = 1e-12;  ///< of every component where `absolute` is empty
  std::vector<double> absolute;       ///< per component
  double first_step = 0;              ///< [s], 0: CVODE chooses
  double largest_step = 0;            ///< [s], 0: no limit
  long most_steps = 100000;
};

struct CvodeStatistics {
  long steps = 0, rate_calls = 0, root_calls = 0, factorisations = 0;
};

/// Integrates y' = rate(t, y) by variable-order BDF with a dense Newton matrix (difference quotients)
/// from t0 until event(t, y) falls through zero. `y` is advanced to the event; the event's time is
/// returned. `watch`, where given, sees every accepted step.
/// Throws NonConvergence where no event comes before `latest`, or CVODE gives up.
/// Source: Hindmarsh et al. (2005), SUNDIALS, ACM TOMS 31:363.
double integrate_to_event(const std::function<void(double, const double*, double*)>& rate,
                          const std::function<double(double, const double*)>& event, double t0, double latest,
                          std::span<double> y, const CvodeOptions& options = {}, CvodeStatistics* statistics = nullptr,
                          const std::function<void(double, const double*)>& watch = {});

}  // namespace hosel::solvers
