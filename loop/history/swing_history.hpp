/// Records of a swing: the hosel in the grip frame, the grip's motion given, the club geometrically exact.
#pragma once

#include <mutex>

#include "loop/history/test_setup.hpp"
#include "models/club/changed_swing.hpp"
#include "models/club/grip_motion.hpp"

namespace hosel::loop {

class SwingHistory final : public HistoryModel {
 public:
  /// Every record is of the same motion; `times` per record.
  SwingHistory(Club club, const models::SwingOptions& options, models::GripMotion motion, double begin,
               std::vector<std::vector<double>> times, const std::vector<HistoryChannel>& channels);
  bool answer(const TestSetup& setup, std::vector<Prediction>& out) const override;
  bool slow() const override { return true; }
  /// Circular frequency and damping ratio of the first mode with the grip held.
  std::pair<double, double> first_mode() const;

 private:
  Club club_;
  models::SwingOptions options_;
  models::GripMotion motion_;
  double begin_, end_ = 0;
  std::vector<std::vector<double>> times_;
  std::vector<HistoryChannel> channels_;
  // A delay or gain leaves the motion as it is: the last swings are kept.
  mutable std::mutex mutex_;
  using Known = std::pair<models::ClubChange, std::vector<models::SwingSample>>;
  mutable std::vector<Known> known_;
};

}  // namespace hosel::loop
