/// The result of a test for structure in a residual. The tests depend on the kind of data: shots/structure,
/// history/noise.
#pragma once

#include <string>
#include <vector>

namespace hosel::loop {

struct Finding {
  int channel = 0;        ///< -1: all channels
  std::string regressor;  ///< header, "shot" for the order, "constant", "time_s"
  std::string kind;       ///< constant, trend, curvature, interaction, group, step, oscillation, band, neighbours, ...
  std::string detail;     ///< "with club_speed_mps", "= 7i", "at 4.1 Hz"
  bool foreign = false;   ///< no model of the family knows this regressor (unknown columns, clusters, order)
  double statistic = 0;   ///< signed, in units of its own standard deviation
  double signal = 0;      ///< the same in units of the noise at hand
  double p_adjusted = 1;  ///< corrected for the number of tests

  std::string what() const { return detail.empty() ? kind : kind + " " + detail; }
};

struct StructureMap {
  std::vector<Finding> findings;  ///< the plainest first
  double p = 1;                   ///< of the largest statistic, corrected
  double signal = 0;              ///< the largest where the noise is declared and not refuted
  double beside = 0;              ///< the same in units of at least the scatter beside it
};

}  // namespace hosel::loop
