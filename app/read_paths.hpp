/// `[paths]`: flights that a radar followed, as polynomials of time, with the air of each site and what a shot may have
/// of its own.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/reader.hpp"
#include "models/flight/flight_inference.hpp"

namespace hosel::app {

/// One followed flight: what enters the fit, and what the radar made of it at launch level.
struct RadarFlight {
  models::MeasuredPath path;
  std::size_t line = 0;  ///< in the file
  std::string player, group;
  bool held_out = false;
  bool spin_tracked = false;                       ///< else estimated by the radar
  double carry = 0, side = 0, apex = 0, time = 0;  ///< where it is at the height of its launch again [m, s]
};

struct RadarPaths {
  std::vector<RadarFlight> flights;
  std::vector<std::string> groups;      ///< by the number in MeasuredPath::group
  std::map<std::string, int> left_out;  ///< reason, rows
  models::PathModel model;
  std::filesystem::path missing;  ///< not empty: the file is not on this machine, and nothing else is here

  std::vector<std::string> not_used() const;  ///< a sentence for each reason
  std::vector<models::MeasuredPath> paths(bool held_out) const;
  std::vector<const RadarFlight*> flights_of(bool held_out) const;
};

/// A player is held out where the FNV-1a hash (32 bit) of the name is odd: who is, depends on nothing but the name.
bool held_out(const std::string& player);

RadarPaths read_paths(Table table, const Ball& ball);

}  // namespace hosel::app
