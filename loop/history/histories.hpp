/// The loop on time histories: from records of a club test and a beam model to a verdict.
#pragma once

#include "loop/history/problem.hpp"

namespace hosel::loop {

struct HistoryCase : Case {
  HistoryCase() { base = "shaft", rules = Rules::of_histories(); }
  const HistoryModel* model = nullptr;
  HistorySetting setting;              ///< channels with their declared noise
  std::vector<HistoryRecord> records;  ///< `train` is filled by the split
};

/// Rows of the result count the samples of all records one after the other. Throws DataError where the records
/// cannot be used at all.
LoopResult run(const HistoryCase& c);

/// The records as a table: `time_s`, `record` and the channels, for figures.
Shots as_shots(const HistoryCase& c);

}  // namespace hosel::loop
