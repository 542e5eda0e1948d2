/// The thresholds of the loop. The README of this folder gives their reasons.
#pragma once

#include <cstddef>
#include <numbers>

#include "loop/deviation.hpp"

namespace hosel::loop {

/// What may come by chance: one in a thousand, and the logarithm of the evidence that is beyond it.
inline constexpr double kByChance = 1e-3;
inline constexpr double kBeyondChance = 3 * std::numbers::ln10;
/// Twice the logarithm of evidence that is worth a mention [@bayes-factors].
inline constexpr double kMention = 2;
/// Fewer rows test nothing, and have no scatter of their own.
inline constexpr std::size_t kFewestToTest = 4;
/// Fewer rows have no form.
inline constexpr int kFewestRows = 12;
/// Fewer rows, or different numbers, show no relation between columns and no distribution.
inline constexpr std::size_t kFewestToLearn = 20;
/// A column with fewer different values is too coarse to show how it was made.
inline constexpr std::size_t kFewestDifferent = 8;
/// Of a column that other rows lack: fewer tell neither their own noise nor what the column is.
inline constexpr int kFewestOfRows = 10;

/// Steps of differences, in scales of what is changed: those that are to be accurate, and those that need two digits.
inline constexpr double kStep = 1e-3, kCoarseStep = 0.01;
/// Of the session: a step is sought between so many equal parts.
inline constexpr int kPartsOfSession = 12;
/// Of candidates, by what they promise: so many are looked at again, through or beside something else.
inline constexpr std::size_t kLikeliest = 6;
/// Passes after which an iteration has settled.
inline constexpr int kPasses = 40;
/// Findings of one kind that are told, at most.
inline constexpr std::size_t kMostTold = 4;

/// Level at which a finding is told beside the plainest, or where the declared noise is refuted.
inline constexpr double kTold = 0.05;
/// Squared reading, in units of its own sigma, beyond which it counts the same.
inline constexpr double kMostSquare = 36;
/// Share of the shots beyond which those far off are no exceptions. At least three shots; two if they are far off
/// without a recording error, and for flights.
inline constexpr double kMany = 0.08;
/// No fit explains data of which such a share is flagged or explained by nothing, or whose scatter is so many times
/// what is declared.
inline constexpr double kLost = 0.2, kWide = 1.75;

struct Rules {
  double gate = 0.01;             ///< level of the test for structure at all
  double remaining = 0.005;       ///< level of the test for what is left
  double remaining_signal = 4.9;  ///< or a signal of that size, where the noise is declared
  double gain = 22;               ///< least fall of the deviance for a first effect
  double further_gain = 16;       ///< least fall of the criterion for one more effect; twice that of the deviance by a
                                  ///< threshold effect opens the gate on its own
  double further_share = 0.7;     ///< of it is enough where structure is left without it
  double parameter_cost = 4;      ///< criterion = deviance + cost * parameters + complexity of the forms; the held-out
                                  ///< deviance must not rise by more
  double tie = 7;                 ///< candidates within this of the best criterion tie with it
  double steady = 0.2;          ///< of its size an effect may differ between parts of the rows where structure is left,
  double present = 4;           ///< and be there in each by so many standard errors
  double worse = 0.02;          ///< of its held-out error a channel may lose by what is kept there
  double stand_in = 0.97;       ///< of the fall of the deviance makes another effect a rival there
  double noise_change = 0.03;   ///< relative; more, and effects are selected anew
  double scatter_error = 4.2;   ///< declared noise is refuted beyond so many standard errors of its logarithm
  double scatter_ratio = 1.25;  ///< and beyond this factor either way
  int flips = 999;              ///< of signs in the tests that are calibrated so

  /// Time histories: the tests for structure have closed-form levels, adjusted for their number.
  static Rules of_histories() {
    Rules r;
    r.gate = r.remaining = 1e-4;
    r.remaining_signal = kInfinity;
    return r;
  }

  /// Flights: six forms are looked at, not seventy, for the same level of chance.
  static Rules of_flights() {
    Rules r;
    r.gain = 16;
    return r;
  }
};

}  // namespace hosel::loop
