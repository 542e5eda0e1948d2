#include <algorithm>
#include <array>

#include "hosel/loop/history/effects/all.hpp"

namespace hosel::loop {
namespace {

using namespace history_forms;
constexpr std::array kEffects = {
    HistoryEffect{"shaft-stiffness", "the shaft is stiffer or softer than its table",
                  "bending stiffness of the bare shaft (three-point bending)", shaft_stiffness},
    HistoryEffect{"shaft-damping", "vibrations die away faster or slower",
                  "decay of a long record after the same release", shaft_damping},
    HistoryEffect{"clamp-compliance", "the clamp yields",
                  "rotation of the shaft at the clamp (dial gauge or strain near the clamp)", clamp_compliance},
    HistoryEffect{"hosel-compliance", "the joint of tip and head yields", "rotation of the head against the tip",
                  hosel_compliance},
    HistoryEffect{"tip-mass", "mass at the tip that is not declared", "mass of head and hosel (scales)", tip_mass},
    HistoryEffect{"cg-shift", "the head's centre of gravity is not where it is declared",
                  "centre of gravity of the head (balance)", cg_shift},
    HistoryEffect{"head-inertia", "the head's moment of inertia is not the declared one",
                  "moment of inertia of the head (torsion pendulum)", head_inertia},
    HistoryEffect{"rotational-stiffening", "the pull of turning stiffens the shaft",
                  "the same test at another rate of turning, and at rest", rotational_stiffening},
    HistoryEffect{"sensor-delay", "a channel lags behind", "a common event in all channels (a tap)", sensor_delay},
    HistoryEffect{"sensor-gain", "a channel shows a multiple", "a known displacement of the sensor", sensor_gain},
    HistoryEffect{"sensor-offset", "a channel's zero is not zero", "a reading at rest", sensor_offset},
};

}  // namespace

std::span<const HistoryEffect> history_effects() { return kEffects; }

const HistoryEffect* find_history_effect(std::string_view name) {
  const auto it = std::ranges::find(kEffects, name, &HistoryEffect::name);
  return it == kEffects.end() ? nullptr : &*it;
}

}  // namespace hosel::loop
