/// A club test as recorded: the club, its clamp or grip motion, and its sensors. Effects change it.
#pragma once

#include <optional>
#include <vector>

#include "loop/problem.hpp"
#include "models/modal/bench_response.hpp"

namespace hosel::loop {

using Reading = models::BenchSensor::Quantity;

struct HistoryChannel : Channel {
  Reading reading = Reading::lead;
  int order = 0;                 ///< 0 the quantity, 1 its rate, 2 its acceleration
  double arc_length = 0;         ///< from the butt [m]
  std::optional<double> radius;  ///< of a strain gauge from the shaft's axis; none: the shaft's outer radius [m]
  double colour = 0;             ///< correlation of neighbouring readings
};

/// What effects change; everything zero is the declared test.
struct TestSetup {
  models::ClubChange club;
  std::vector<double> delay;   ///< of each channel [s]
  std::vector<double> gain;    ///< reading = (1 + gain) * quantity + offset
  std::vector<double> offset;  ///< [SI]

  explicit TestSetup(std::size_t channels) : delay(channels), gain(channels), offset(channels) {}
};

/// What the forms of an effect depend on.
struct HistorySetting {
  std::vector<HistoryChannel> channels;
  bool head = false;      ///< a head hangs on the shaft
  bool driven = false;    ///< what moves the club is declared; otherwise its state at the start is unknown
  bool turning = false;   ///< the bench turns
  bool swing = false;     ///< geometrically exact, driven at the grip
  double compliance = 0;  ///< of the shaft in bending, length over mean stiffness [rad/(N m)]
  double frequency = 0;   ///< of the first mode [rad/s]
  double ratio = 0;       ///< its declared damping ratio
};

/// What a channel reads of a test before gain and offset.
using Prediction = models::BenchResponse;

/// Answers for every record of a test.
class HistoryModel {
 public:
  virtual ~HistoryModel() = default;
  /// False where the test cannot happen.
  virtual bool answer(const TestSetup& setup, std::vector<Prediction>& out) const = 0;
  virtual bool slow() const { return false; }  ///< a second or so each
};

}  // namespace hosel::loop
