/// Forces and moments at the ends of the shaft during a blow: on the head at the hosel, from the hands at the grip.
#pragma once

#include <vector>

#include "fem/beam.hpp"
#include "fem/supports.hpp"

namespace hosel::models {

/// Force of the shaft on the head, and moment about the hosel, in the axes of the shaft's tip: the head's (face) axes
/// where the joint is rigid.
fem::Wrench hosel_load(const fem::Beam& shaft, const fem::State& s);
/// Force and moment of the hands on the shaft's butt, whatever holds it, global axes.
fem::Wrench grip_load(const fem::Beam& shaft, const fem::State& s);

struct HoselHistory {
  std::vector<double> times;  ///< [s]
  std::vector<fem::Wrench> loads;

  void add(const fem::Beam& shaft, const fem::State& s);
  fem::Wrench impulse() const;  ///< [N s], [N m s]; trapezoids
};

}  // namespace hosel::models
