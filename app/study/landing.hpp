/// Where the balls of a study land: their ellipse, and the share in a fairway.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "app/study/effects.hpp"
#include "app/study/table.hpp"

namespace hosel::app {

/// `[landing]`: a study whose outputs hold carry and side.
struct StudyLanding {
  std::size_t carry = 0, side = 0;  ///< outputs
  double fairway = 0;               ///< width [m]
  std::size_t draws = 0;            ///< deliveries drawn through the emulator
};
std::optional<StudyLanding> read_landing(Table root, const StudyTable& table);

/// Says mean and spread of carry and side, the axes of the ellipse that holds 95 % of a normal distribution, and the
/// share within the fairway with its 95 % interval; with an emulator also the share of deliveries drawn through it. A
/// ball that was struck (`answered`: of each point a model) and does not land is out of the fairway. Draws
/// figures/landing. For the summary: one entry a model.
nlohmann::json report_landing(Output& out, const StudyTable& table, const StudyEffects& effects,
                              const StudyLanding& landing, const std::vector<bool>& answered, bool draw,
                              const std::string& title);

}  // namespace hosel::app
