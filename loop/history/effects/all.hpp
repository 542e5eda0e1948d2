/// The effects' forms, one function per file of this folder.
#pragma once

#include "hosel/loop/history/rig.hpp"

namespace hosel::loop::history_forms {

std::vector<HistoryForm> shaft_stiffness(const HistorySetting&);
std::vector<HistoryForm> shaft_damping(const HistorySetting&);
std::vector<HistoryForm> clamp_compliance(const HistorySetting&);
std::vector<HistoryForm> hosel_compliance(const HistorySetting&);
std::vector<HistoryForm> tip_mass(const HistorySetting&);
std::vector<HistoryForm> cg_shift(const HistorySetting&);
std::vector<HistoryForm> head_inertia(const HistorySetting&);
std::vector<HistoryForm> rotational_stiffening(const HistorySetting&);
std::vector<HistoryForm> sensor_delay(const HistorySetting&);
std::vector<HistoryForm> sensor_gain(const HistorySetting&);
std::vector<HistoryForm> sensor_offset(const HistorySetting&);

}  // namespace hosel::loop::history_forms
