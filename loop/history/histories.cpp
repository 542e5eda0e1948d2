#include "loop/history/histories.hpp"

#include <fmt/format.h>

#include "loop/verdict.hpp"

namespace hosel::loop {

LoopResult run(const HistoryCase& c) {
  if (c.records.empty()) throw DataError("no record to look at");
  HistoryProblem problem(*c.model, c.setting, c.records, c.split, c.notes, c.own);
  LoopResult result(c, std::size_t(problem.measured().rows()));
  result.forms = problem.forms();
  const Study study(problem, result.forms, c.effects, c.rules, c.told);
  conclude(study, result);
  return result;
}

Shots as_shots(const HistoryCase& c) {
  Shots s;
  Column time{.name = "time_s", .stem = "time", .numeric = true},
      record{.name = "record", .stem = "record", .role = Role::bookkeeping};
  std::vector<Column> channels;
  for (const HistoryChannel& ch : c.setting.channels)
    channels.push_back({.name = ch.name, .stem = ch.name, .role = Role::output, .numeric = true});
  for (const HistoryRecord& r : c.records)
    for (std::size_t i = 0; i < r.times.size(); ++i) {
      s.id.push_back(fmt::format("{}", s.id.size() + 1));
      s.line.push_back(i + 2);
      time.value.push_back(r.times[i]);
      record.text.push_back(r.name);
      for (std::size_t k = 0; k < channels.size(); ++k)
        channels[k].value.push_back(r.measured(std::ptrdiff_t(i), std::ptrdiff_t(k)));
    }
  s.columns.push_back(std::move(time));
  s.columns.push_back(std::move(record));
  for (Column& ch : channels) s.columns.push_back(std::move(ch));
  return s;
}

}  // namespace hosel::loop
