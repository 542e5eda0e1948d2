/// An FE impact under way on disk: CBOR, every number to the last bit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hosel/models/fe_impact.hpp"

namespace hosel::post {

struct SavedImpact {
  models::ImpactCheckpoint impact;
  Vec3 face_centre = Vec3::Zero();    ///< at the start, global [m]
  Mat3 face_axes = Mat3::Identity();  ///< at the start: columns, face frame in the global one
  long steps = 0;                     ///< recorded
};

/// Written beside and renamed. `run` names what is computed: nothing else may go on from it.
void save_checkpoint(const std::filesystem::path& file, const std::string& run, const SavedImpact& saved);

/// Nothing where the file is missing, damaged, or of another run.
std::optional<SavedImpact> load_checkpoint(const std::filesystem::path& file, const std::string& run);

}  // namespace hosel::post
