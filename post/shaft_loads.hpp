/// What the sections of a shaft carry: at an instant, and over time as a table and as curves along it.
#pragma once

#include <string>
#include <vector>

#include "fem/beam.hpp"
#include "post/figure.hpp"

namespace hosel::post {

/// What a section of the shaft carries [N, N m].
struct SectionLoad {
  double axial = 0;    ///< tension is positive
  double torque = 0;   ///< about the line, from its first node to its last
  double bending = 0;  ///< moment across the line
};
/// At each node of a beam: linear in arc length between the Gauss points, and beyond the outermost.
std::vector<SectionLoad> section_loads(const fem::Beam& beam, const fem::State& state);

class ShaftLoads {
 public:
  /// One more instant of the same shaft [s].
  void add(double time, const fem::Beam& shaft, const fem::State& state);
  /// CSV: a row for every node of every instant, its place in space and its load.
  const std::string& table() const { return table_; }
  /// Bending moment, torque and axial force along the shaft at five instants of the last `span` [s], evenly; times are
  /// told in ms where the span is below 10 ms. Empty where nothing was added.
  std::vector<Panel> panels(double span) const;

 private:
  struct Instant {
    double time;
    std::vector<SectionLoad> loads;  // by node
  };
  std::vector<double> arc_length_;  // of the nodes [m]
  std::vector<Instant> instants_;
  std::string table_ = "time_s,arc_length_mm,x_mm,y_mm,z_mm,axial_force_N,torque_N_m,bending_moment_N_m\n";
};

}  // namespace hosel::post
