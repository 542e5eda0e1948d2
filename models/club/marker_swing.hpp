/// A swing measured by markers: three on a body clamped to the shaft, three on the head.
#pragma once

#include <array>
#include <vector>

#include "models/calibration/shaft_identification.hpp"
#include "models/club/grip_motion.hpp"

namespace hosel::models {

/// Marker positions over time; a drop-out is NaN.
struct MarkerTrack {
  std::vector<double> times;                     ///< [s]
  std::vector<std::array<Vec3, 3>> shaft, head;  ///< global [m]
  std::vector<Vec3> wrists;                      ///< midpoint [m]
};

/// Best rigid placement of three points on three others (W. Kabsch, Acta Cryst. A32 (1976) 922).
struct Placement {
  Eigen::Quaterniond rotation;
  Vec3 translation;  ///< to = rotation * from + translation
};
Placement place(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to);

/// The markers as a swing of the model. At address (the mean over the first `still` seconds) the shaft is
/// taken as unloaded: the head rests on the ground. The shaft's line runs from the middle of the head markers
/// to the middle of the wrists; the clamp is the point of that line nearest the shaft markers; the lead
/// direction is the global X, across the line.
struct MarkerSwing {
  GripTrack clamp;                  ///< pose of the grip frame at the clamp, of the samples with all shaft markers
  double length = 0;                ///< from the clamp to the hosel [m]
  std::vector<double> times;        ///< of the samples with all head markers
  std::vector<double> lead, droop;  ///< of the hosel, measured [m]
  std::vector<std::array<Vec3, 3>> head;  ///< measured at those times, global
  std::array<Vec3, 3> head_reference;     ///< in grip axes from the clamp, unloaded
};
MarkerSwing marker_swing(const MarkerTrack& track, double still, double end);

/// Root mean square distance of predicted and measured head markers between two times [m]. `samples` empty: a
/// rigid shaft.
double marker_error(const MarkerSwing& swing, const GripMotion& motion, const std::vector<SwingSample>& samples,
                    double from, double to);

}  // namespace hosel::models
