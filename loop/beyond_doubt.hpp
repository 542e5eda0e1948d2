/// Effects that are adopted although structure remains that no candidate explains.
#pragma once

#include "loop/study.hpp"

namespace hosel::loop {

struct BeyondDoubt {
  std::vector<std::string> adopted;            ///< empty: nothing is
  std::vector<std::vector<std::string>> ties;  ///< an adopted slot that another effect fills nearly as well
  Fit fit;                                     ///< of these alone, to all training rows
};

/// A name given while structure remains is usually wrong: a stand-in for what the library lacks. What gives it away is
/// that its size depends on where one looks. Of the chosen set, and of every other of as many effects that explains
/// `Rules::stand_in` of the same, those effects are kept that, at no bound, have one size: every parameter within
/// `Rules::steady` of it, or two errors, in both halves of the rows by every input, in every quarter of the session and
/// on the holdout, and there in each of them by `Rules::present` standard errors; also when what is not kept is taken
/// out. Of two that pass, or of three effects, nothing is kept: their sum follows many a form. It must let the held-out
/// deviance fall by more than a first effect must bring, and make no channel worse there by more than `Rules::worse`.
/// Where several sets keep something, the likeliest counts, and what differs is told as a tie.
BeyondDoubt beyond_doubt(const Study& study);

}  // namespace hosel::loop
