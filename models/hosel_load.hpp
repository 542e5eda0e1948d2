/// What the shaft does to the head at the hosel, during a blow.
#pragma once

#include <vector>

#include "hosel/fem/beam.hpp"
#include "hosel/fem/supports.hpp"

namespace hosel::models {

/// Force of the shaft on the head, and moment about the hosel, in the head's (face) axes. `shaft` ends at the
/// head's node.
fem::Wrench hosel_load(const fem::Beam& shaft, const fem::State& s);

struct HoselHistory {
  std::vector<double> times;  ///< [s]
  std::vector<fem::Wrench> loads;

  void add(const fem::Beam& shaft, const fem::State& s);
  fem::Wrench impulse() const;  ///< [N s], [N m s]; trapezoids
};

}  // namespace hosel::models
