/// The line that a beam is drawn along: nodes of three-node elements with their frames.
#pragma once

#include <vector>

#include "golf/vector.hpp"

namespace hosel::mesh {

struct LineNode {
  double arc_length = 0;          ///< from the first node [m]
  Vec3 position = Vec3::Zero();   ///< [m]
  Mat3 frame = Mat3::Identity();  ///< columns: tangent, and the section's y and z
};

/// Ends of elements on [0, length], each `growth` times as long as the one before (1: equal).
/// growth < 1 refines towards the end.
std::vector<double> graded(double length, int elements, double growth = 1);

/// Nodes of three-node elements between `ends` (two nodes more than twice the elements less one).
/// Straight from `start` along the frame's first column.
std::vector<LineNode> straight(const std::vector<double>& ends, const Vec3& start, const Mat3& frame);

/// A circular arc of `radius` that begins at `start` and bends towards the frame's second column.
std::vector<LineNode> arc(const std::vector<double>& ends, double radius, const Vec3& start, const Mat3& frame);

/// A frame whose first column is `along` and whose second is as near to `towards` as can be.
Mat3 frame_along(const Vec3& along, const Vec3& towards);

}  // namespace hosel::mesh
