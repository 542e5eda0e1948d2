#include "loop/history/swing_history.hpp"

#include <algorithm>

#include "solvers/errors.hpp"

namespace hosel::loop {

SwingHistory::SwingHistory(Club club, const models::SwingOptions& options, models::GripMotion motion, double begin,
                           std::vector<std::vector<double>> times, const std::vector<HistoryChannel>& channels)
    : club_(std::move(club)),
      options_(options),
      motion_(std::move(motion)),
      begin_(begin),
      times_(std::move(times)),
      channels_(channels) {
  end_ = begin_;
  for (const auto& t : times_) end_ = std::max(end_, t.back());
}

std::pair<double, double> SwingHistory::first_mode() const {
  const models::Bench bench(club_, true, {.shear = options_.shear, .clamped_length = options_.grip_point}, {});
  const models::BenchModes m = bench.modes({}, 1);
  return {m.omega[0], m.ratio[0]};
}

bool SwingHistory::answer(const TestSetup& setup, std::vector<Prediction>& out) const {
  const models::ClubChange& c = setup.club;
  std::vector<models::SwingSample> samples;
  {
    const std::lock_guard lock(mutex_);
    if (const auto it = std::ranges::find(known_, c, &Known::first); it != known_.end()) samples = it->second;
  }
  if (samples.empty()) {
    try {
      samples = models::changed_swing(club_, options_, motion_, c, begin_, end_);
    } catch (const solvers::NonConvergence&) { return false; } catch (const std::invalid_argument&) {
      return false;
    }
    const std::lock_guard lock(mutex_);
    if (known_.size() > 64) known_.clear();
    known_.emplace_back(c, samples);
  }
  const auto lead = [](const models::SwingSample& s) { return s.lead; };
  const auto droop = [](const models::SwingSample& s) { return s.droop; };
  const auto shortening = [](const models::SwingSample& s) { return s.shortening; };
  const auto twist = [](const models::SwingSample& s) { return s.twist.z(); };
  out.assign(times_.size(), {});
  for (std::size_t r = 0; r < times_.size(); ++r) {
    out[r].value.resize(std::ptrdiff_t(times_[r].size()), std::ptrdiff_t(channels_.size()));
    for (std::size_t k = 0; k < channels_.size(); ++k) {
      std::vector<double> at = times_[r];
      for (double& t : at) t -= setup.delay[k];
      const Reading reading = channels_[k].reading;
      out[r].value.col(std::ptrdiff_t(k)) = models::sampled(samples, at,
                                                            reading == Reading::lead         ? +lead
                                                            : reading == Reading::droop      ? +droop
                                                            : reading == Reading::shortening ? +shortening
                                                                                             : +twist);
    }
  }
  return true;
}

}  // namespace hosel::loop
