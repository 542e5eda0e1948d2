/// A club test as recorded: what stands on the bench or in the hands, and what is read. Effects change it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hosel/loop/effect.hpp"
#include "hosel/models/bench.hpp"

namespace hosel::loop {

enum class Reading { lead, droop, shortening, twist, strain_lead, strain_droop };

struct HistoryChannel {
  std::string name;  ///< the header
  Reading reading = Reading::lead;
  int order = 0;          ///< 0 the quantity, 1 its rate, 2 its acceleration
  double arc_length = 0;  ///< from the butt [m]
  double si = 1;          ///< one of the header's unit in SI
  double noise = 0;       ///< standard deviation of one reading, header's unit
  double colour = 0;      ///< correlation of neighbouring readings
  bool declared = false;
  double resolution = 0;  ///< header's unit
};

/// What effects change; everything zero is the declared test.
struct Rig {
  models::ClubChange club;
  std::vector<double> delay;   ///< of each channel [s]
  std::vector<double> gain;    ///< reading = (1 + gain) * quantity + offset
  std::vector<double> offset;  ///< [SI]

  explicit Rig(std::size_t channels) : delay(channels), gain(channels), offset(channels) {}
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

struct HistoryForm {
  Form form;  ///< name, parameters, starts; its hooks for shots are empty
  std::function<void(std::span<const double>, Rig&)> apply;
};

struct HistoryEffect {
  std::string_view name;
  std::string_view what;
  std::string_view sensor;
  std::vector<HistoryForm> (*forms)(const HistorySetting&);
};

/// Every effect on time histories, in the order of the contract.
std::span<const HistoryEffect> history_effects();
const HistoryEffect* find_history_effect(std::string_view name);

/// What a channel reads of a test before gain and offset, SI: samples x channels; and what each unknown of the
/// state at the start adds to it.
struct Answer {
  Eigen::MatrixXd value;
  std::vector<Eigen::MatrixXd> unknown;
};

/// Answers for every record of a test.
class HistoryModel {
 public:
  virtual ~HistoryModel() = default;
  /// False where the test cannot happen.
  virtual bool answer(const Rig& rig, std::vector<Answer>& out) const = 0;
  virtual bool slow() const { return false; }  ///< a second or so each
};

}  // namespace hosel::loop
