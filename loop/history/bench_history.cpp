#include "loop/history/bench_history.hpp"

#include <map>
#include <stdexcept>

namespace hosel::loop {

BenchHistory::BenchHistory(const Club& club, bool with_head, models::BenchOptions options,
                           const models::BenchStart& start, std::vector<models::BenchRecord> records,
                           const std::vector<HistoryChannel>& channels)
    : start_(start), records_(std::move(records)), channels_(channels) {
  std::vector<models::BenchSensor> sensors;
  for (const HistoryChannel& c : channels) sensors.push_back({c.reading, c.arc_length, c.radius});
  std::map<double, std::size_t> known;
  for (const models::BenchRecord& r : records_) {
    const auto [it, fresh] = known.emplace(r.rotation_rate, benches_.size());
    if (fresh) {
      options.rotation_rate = r.rotation_rate;
      benches_.push_back(std::make_unique<models::Bench>(club, with_head, options, sensors));
    }
    bench_of_.push_back(it->second);
  }
}

std::pair<double, double> BenchHistory::first_mode() const {
  const models::BenchModes m = benches_.front()->modes({}, 1);
  return {m.omega[0], m.ratio[0]};
}

bool BenchHistory::answer(const TestSetup& setup, std::vector<Prediction>& out) const {
  std::vector<models::BenchModes> modes;
  try {
    for (const auto& b : benches_) modes.push_back(b->modes(setup.club));
  } catch (const std::invalid_argument&) { return false; }
  std::vector<models::BenchReading> readings;
  for (std::size_t c = 0; c < channels_.size(); ++c) readings.push_back({channels_[c].order, setup.delay[c]});
  out.clear();
  for (std::size_t r = 0; r < records_.size(); ++r)
    out.push_back(models::response(modes[bench_of_[r]], start_, records_[r], readings));
  return true;
}

}  // namespace hosel::loop
