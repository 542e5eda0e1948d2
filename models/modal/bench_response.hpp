/// Sensor readings of a club on the bench: released, struck, driven, or with unknown initial motion. Every mode is
/// stepped exactly between samples.
#pragma once

#include "models/modal/bench.hpp"

namespace hosel::models {

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

/// How a sensor is read.
struct BenchReading {
  int order = 0;     ///< 0 the quantity, 1 its rate, 2 its acceleration
  double delay = 0;  ///< the reading shows what was so long ago [s]
};

/// Samples x sensors, SI.
struct BenchResponse {
  Eigen::MatrixXd value;
  std::vector<Eigen::MatrixXd> unknown;  ///< what each unknown of the state at the start adds; none where it is known
};

/// `readings`: one per sensor of the modes.
BenchResponse response(const BenchModes& modes, const BenchStart& start, const BenchRecord& record,
                       const std::vector<BenchReading>& readings);

}  // namespace hosel::models
