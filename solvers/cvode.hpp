/// Ordinary differential equations with events, by SUNDIALS CVODE.
/// Source: Hindmarsh et al. (2005), SUNDIALS, ACM TOMS 31:363.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace hosel::solvers {

enum class CvodeMethod {
  bdf,    ///< stiff: variable-order BDF, Newton with a dense matrix of difference quotients
  adams,  ///< smooth and not stiff: variable-order Adams-Moulton, fixed-point iteration
};

struct CvodeOptions {
  CvodeMethod method = CvodeMethod::bdf;
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

/// y' = rate(t, y) of `size` components with `events` functions that each stop it where they fall through zero.
/// The memory is kept: start() as often as needed. Not for two threads at once.
class Cvode {
 public:
  using Rate = std::function<void(double t, const double* y, double* dy)>;
  using Events = std::function<void(double t, const double* y, double* g)>;
  Cvode(int size, Rate rate, int events, Events g, const CvodeOptions& options = {});
  ~Cvode();
  Cvode(Cvode&&) noexcept;

  /// From here on, with fresh statistics.
  void start(double t0, std::span<const double> y0);

  struct Stop {
    double time;
    std::optional<int> event;  ///< the first that fell; none: `latest` is reached
  };
  /// On to the next event or to `latest`. `watch`, where given, sees every accepted step and the stop.
  /// Throws NonConvergence where CVODE gives up.
  Stop run(double latest, const std::function<void(double, const double*)>& watch = {});

  std::span<const double> state() const;                  ///< at the last stop
  void interpolate(double t, std::span<double> y) const;  ///< at a time inside the last accepted step
  CvodeStatistics statistics() const;                     ///< since start()

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One run from t0 until event(t, y) falls through zero. `y` is advanced to the event; the event's time is
/// returned. `watch`, where given, sees every accepted step.
/// Throws NonConvergence where no event comes before `latest`, or CVODE gives up.
double integrate_to_event(const std::function<void(double, const double*, double*)>& rate,
                          const std::function<double(double, const double*)>& event, double t0, double latest,
                          std::span<double> y, const CvodeOptions& options = {}, CvodeStatistics* statistics = nullptr,
                          const std::function<void(double, const double*)>& watch = {});

}  // namespace hosel::solvers
