/// The contact patch over time, along the line of slip.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "golf/vector.hpp"
#include "post/figure.hpp"

namespace hosel::post {

/// Values at (time[i], position[j]) stand in [j * time.size() + i]; the material points lie on the ball's great circle
/// through the first point of contact along the slip.
struct PatchHistory {
  std::vector<double> time;      ///< [s]
  std::vector<double> position;  ///< arc from the first point of contact, along the slip positive [m]
  std::vector<double> pressure;  ///< of the field (fem::TractionField) [Pa]
  std::vector<double> traction;  ///< of it, on the ball along the slip [Pa]
  std::vector<double> slip;      ///< path slid so far [m]
};

/// Reads the frames of a patch series (`vtk`/patch/patch_*.vtp). `ball_axes`: from the ball's centre to the first point
/// of contact, direction of slip, across both; `mesh_axes`: those of its mesh (models::FeOutcome::mesh_axes). Positions
/// that touch, and the next on either side.
PatchHistory read_patch(const std::filesystem::path& vtk, const Mat3& ball_axes, const Mat3& mesh_axes);

/// Pressure, traction and slip as maps; no panel where nothing was seen to
/// touch, and none of what is zero throughout.
Figure patch_figure(const PatchHistory& patch, std::string_view model);

}  // namespace hosel::post
