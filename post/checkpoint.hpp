/// An FE impact under way on disk: a line with format and digest, then CBOR, every number to the last bit.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "models/fe/impact.hpp"
#include "post/ball_section.hpp"
#include "post/history.hpp"
#include "post/moving_blow.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {

struct SavedImpact {
  models::ImpactCheckpoint impact;
  Vec3 face_centre = Vec3::Zero();                ///< at the start, global [m]
  Mat3 face_axes = Mat3::Identity();              ///< at the start: columns, face frame in the global one
  std::optional<BallSection> section;             ///< at the largest force so far
  MovingBlow moving;                              ///< so far
  History::Mark history;                          ///< one row a recorded step
  std::map<std::string, VtkSeries::Mark> series;  ///< by body
};

/// `run` names what is computed, and by which build: nothing else may go on from it.
void save_checkpoint(const std::filesystem::path& file, const std::string& run, const SavedImpact& saved);

/// Nothing where the file is missing, damaged, of another format or of another run.
std::optional<SavedImpact> load_checkpoint(const std::filesystem::path& file, const std::string& run);

}  // namespace hosel::post
