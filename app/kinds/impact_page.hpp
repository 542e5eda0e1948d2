/// The page of a blow: the answer, what happened while the ball touched the face, how exact it is.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/output.hpp"
#include "models/fe/impact.hpp"
#include "post/ball_section.hpp"
#include "post/launch_table.hpp"
#include "post/moving_blow.hpp"
#include "post/patch_figure.hpp"

namespace hosel::app {

/// What a finite-element model left behind.
struct FeRun {
  std::string model;
  std::filesystem::path home;  ///< of history.csv
  models::FeImpactResult result;
  std::optional<post::BallSection> section = {};  ///< at the step with the largest force
  post::MovingBlow moving = {};
  std::optional<post::PatchHistory> patch = {};  ///< where series were written
};

struct ImpactStory {
  const Blow& blow;                                ///< of the last column
  const std::vector<post::LaunchColumn>& columns;  ///< a model each; the last answers
  const post::Measured& measured;
  const post::TextTable& table;
  const std::vector<FeRun>& runs;
  bool matched;  ///< every model stands at the loft that gives the measured launch angle
  bool yields;   ///< the face does
  bool flies;    ///< the case asks for the flight
  bool vtk;      ///< there are series
};

/// What the full club does beside its head alone, in a sentence; empty where the two are not among the columns.
std::string shaft_sentence(const ImpactStory& story, post::Units units);
/// That sentence on the page, before the sections of the flight.
void show_shaft(Output& out, const ImpactStory& story);
void show_impact(Output& out, const ImpactStory& story);

}  // namespace hosel::app
