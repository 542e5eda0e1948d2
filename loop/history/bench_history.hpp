/// Records of a clamped shaft: predictions of their channels.
#pragma once

#include <memory>

#include "loop/history/test_setup.hpp"

namespace hosel::loop {

class BenchHistory final : public HistoryModel {
 public:
  /// Throws std::invalid_argument as models::Bench does.
  BenchHistory(const Club& club, bool with_head, models::BenchOptions options, const models::BenchStart& start,
               std::vector<models::BenchRecord> records, const std::vector<HistoryChannel>& channels);
  bool answer(const TestSetup& setup, std::vector<Prediction>& out) const override;
  /// Circular frequency and damping ratio of the first mode as declared.
  std::pair<double, double> first_mode() const;

 private:
  models::BenchStart start_;
  std::vector<models::BenchRecord> records_;
  std::vector<HistoryChannel> channels_;
  std::vector<std::unique_ptr<models::Bench>> benches_;  ///< one per rate of turning
  std::vector<std::size_t> bench_of_;
};

}  // namespace hosel::loop
