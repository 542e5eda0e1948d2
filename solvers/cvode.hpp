/// Stiff ordinary differential equations up to an event, by SUNDIALS CVODE.
/// Source: Hindmarsh et al. (2005), SUNDIALS, ACM TOMS 31:363.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace hosel::solvers {

struct CvodeOptions {
  double relative_tolerance = 1e-9;
  std::vector<double> absolute;  ///< tolerance of each component
  double first_step = 0;         ///< [s], 0: CVODE chooses
  double largest_step = 0;       ///< [s], 0: no limit
};

struct CvodeStatistics {
  long steps = 0, rate_calls = 0;
};

/// y' = rate(t, y) from t0 until event(t, y) falls through zero: variable-order BDF, Newton with a dense matrix of
/// difference quotients. `y` is advanced to the event; the event's time is returned. `watch`, where given, sees every
/// accepted step and the event.
/// Throws NonConvergence where no event comes before `latest`, or CVODE gives up.
double integrate_to_event(const std::function<void(double, const double*, double*)>& rate,
                          const std::function<double(double, const double*)>& event, double t0, double latest,
                          std::span<double> y, const CvodeOptions& options, CvodeStatistics* statistics = nullptr,
                          const std::function<void(double, const double*)>& watch = {});

}  // namespace hosel::solvers
