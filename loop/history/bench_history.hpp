/// Records of a clamped shaft: released, struck, driven, or found in motion.
#pragma once

#include <memory>

#include "hosel/loop/history/rig.hpp"

namespace hosel::loop {

/// How a bench test begins.
enum class Start {
  unknown,  ///< in motion; displacement and velocity of its modes are fitted
  release,  ///< held by a load at the hosel, which goes at time `at`
  impulse,  ///< at rest, struck at the hosel at time `at`
  rest,     ///< at rest; what moves it is in the records
};

struct BenchStart {
  Start kind = Start::unknown;
  double at = 0;               ///< [s]
  Vec3 force = Vec3::Zero();   ///< release: load [N]; impulse [N s]; at the hosel, grip axes
  Vec3 moment = Vec3::Zero();  ///< release [N m]; impulse [N m s]
};

/// One record: times, and what drives the club between them (linear from sample to sample).
struct BenchRecord {
  std::vector<double> times;     ///< increasing [s]
  Eigen::MatrixXd acceleration;  ///< of the clamp, samples x 3, grip axes; empty: none [m/s^2]
  Eigen::MatrixXd force;         ///< on the hosel, samples x 3; empty: none [N]
  double rotation_rate = 0;      ///< of the bench [rad/s]
};

class BenchHistory final : public HistoryModel {
 public:
  /// Throws std::invalid_argument as models::Bench does.
  BenchHistory(const Club& club, bool with_head, models::BenchOptions options, const BenchStart& start,
               std::vector<BenchRecord> records, const std::vector<HistoryChannel>& channels);
  bool answer(const Rig& rig, std::vector<Answer>& out) const override;
  /// Circular frequency and damping ratio of the first mode as declared.
  std::pair<double, double> first_mode() const;

 private:
  void one(const models::BenchModes& modes, const Rig& rig, const BenchRecord& record, Answer& out) const;

  BenchStart start_;
  std::vector<BenchRecord> records_;
  std::vector<HistoryChannel> channels_;
  std::vector<std::unique_ptr<models::Bench>> benches_;  ///< one per rate of turning
  std::vector<std::size_t> bench_of_;
};

}  // namespace hosel::loop
