/// Is the machine large enough for what a case asks?
#pragma once

#include "app/reader.hpp"
#include "models/fe/fe_impact.hpp"

namespace hosel::app {

/// Memory of a finite-element blow without a plane of symmetry [B]: element matrices and the factor, which grow alike.
/// Within a factor of two of what was measured, 3 x 3 x N = 4 to 2 x 2 x N = 8; a planar blow takes a half of it.
double memory_of(const models::FeImpactOptions& fe);

/// While it lives, what this thread reads is computed on all cores, a blow on each.
class BlowsBeside {
 public:
  BlowsBeside();
  ~BlowsBeside();
  BlowsBeside(const BlowsBeside&) = delete;
  BlowsBeside& operator=(const BlowsBeside&) = delete;

 private:
  int before_;
};

/// What `ulimit -v` leaves this process [B]; infinity where it is not limited.
double address_limit();

/// Refuses, at `[mesh]`, what the memory of this machine cannot hold, as many blows at a time as there will be; and
/// what the address space of this process cannot.
void check_memory(const Table& root, const models::FeImpactOptions& fe);

}  // namespace hosel::app
