/// A measured swing from a case's table `[markers]`: optical markers on a body clamped to the shaft and on the head.
#pragma once

#include <filesystem>

#include "app/reader.hpp"
#include "models/club/marker_swing.hpp"

namespace hosel::app {

/// `[markers]`: `file`, smoothing and how long the club hangs still at first.
struct MarkerInput {
  std::filesystem::path file;
  double smoothing = 0, still = 0;  ///< [s]
};
MarkerInput read_markers(Table& table);

/// The swing until `end` [s], in the file's columns `time_s`, `shaft_1_x_m` ... `shaft_3_z_m`, `head_1_x_m` ...
/// `head_3_z_m`, `left_wrist_x_m` ... `right_wrist_z_m`; a drop-out is an empty cell. Throws InputError.
models::MarkerSwing read_marker_swing(const MarkerInput& in, double end);

}  // namespace hosel::app
