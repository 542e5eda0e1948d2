/// The loop on time histories: from records of a club test and a beam model to a verdict, in the words of the contract.
#pragma once

#include "hosel/loop/history/problem.hpp"
#include "hosel/loop/run.hpp"

namespace hosel::loop {

struct HistoryCase {
  std::string title;
  std::string base = "shaft";
  const HistoryModel* model = nullptr;
  HistorySetting setting;              ///< channels with their declared noise
  std::vector<HistoryRecord> records;  ///< `train` is filled by the split
  bool start_unknown = false;          ///< every record has unknowns of its own: stretches of time are held out
  std::vector<std::string> effects;    ///< declared part of the base; their parameters are fitted
  Split split;
  Rules rules;
  std::vector<std::string> notes;
};

/// Rows of the result count the samples of all records one after the other. Throws DataError where the records
/// cannot be used at all.
LoopResult run(const HistoryCase& c);

/// The records as a table: `time_s`, `record` and the channels, for figures.
Shots as_shots(const HistoryCase& c);

/// `record,time_s,set` and for each channel `__measured`, `__before`, `__after`.
std::string history_residuals_csv(const HistoryCase& c, const LoopResult& r);

}  // namespace hosel::loop
