/// A swing with changes of the declared club and its supports.
#pragma once

#include "models/club/grip_motion.hpp"
#include "models/club/swing.hpp"
#include "models/modal/bench.hpp"

namespace hosel::models {

/// Samples from equilibrium at `begin` to `end` [s], the grip's motion given. Mass damping, modal damping ratios and
/// centrifugal stiffening of the change are matters of the linear bench: the swing has none of them to change. Throws
/// solvers::NonConvergence, and std::invalid_argument on a club that no body can be, or on a yielding hosel where the
/// declared joint is not rigid.
std::vector<SwingSample> changed_swing(const Club& declared, const SwingOptions& as_declared, const GripMotion& motion,
                                       const ClubChange& change, double begin, double end);

/// A value of the samples at rising times [s]: cubic through four samples; before the first and after the last theirs.
Eigen::VectorXd sampled(const std::vector<SwingSample>& samples, const std::vector<double>& times,
                        double (*value)(const SwingSample&));

}  // namespace hosel::models
