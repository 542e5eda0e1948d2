#include "hosel/loop/history/histories.hpp"

#include <fmt/format.h>

#include <cmath>

#include "hosel/loop/history/verdict.hpp"
#include "hosel/post/csv.hpp"

namespace hosel::loop {

LoopResult run(const HistoryCase& c) {
  if (c.records.empty()) throw DataError("no record to look at");
  HistoryStudy study(c);
  conclude(study);
  return std::move(study.result);
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

std::string history_residuals_csv(const HistoryCase& c, const LoopResult& r) {
  std::string out = "record,time_s,set";
  for (const ChannelResult& ch : r.channels) out += fmt::format(",{0}__measured,{0}__before,{0}__after", ch.name);
  out += '\n';
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format(",{:.9g}", x) : std::string(","); };
  std::size_t row = 0;
  for (const HistoryRecord& record : c.records)
    for (std::size_t i = 0; i < record.times.size() && row < r.shots.size(); ++i, ++row) {
      const UsedShot& u = r.shots[row];
      out += fmt::format("{},{:.9g},{}", post::csv_cell(record.name), record.times[i], u.holdout ? "holdout" : "train");
      for (std::size_t k = 0; k < u.measured.size(); ++k)
        out += cell(u.measured[k]) + cell(u.measured[k] + u.before[k]) + cell(u.measured[k] + u.after[k]);
      out += '\n';
    }
  return out;
}

}  // namespace hosel::loop
