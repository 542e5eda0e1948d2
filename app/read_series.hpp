/// Time histories of a club test from their files.
#pragma once

#include <filesystem>

#include "app/reader.hpp"
#include "loop/history/bench_history.hpp"
#include "loop/history/histories.hpp"

namespace hosel::app {

/// One file: times, the measured channels, and what drove the club (`clamp_lead_m_per_s2`, `force_lead_N`, ... ; grip
/// axes; missing axes are zero).
struct Series {
  loop::HistoryRecord record;
  models::BenchRecord drive;
  std::vector<loop::HistoryChannel> channels;
};

/// `radius` of a strain channel.
double read_gauge_radius(Table& channel);

/// Channels by the names of their columns: `lead_*`, `droop_*`, `shortening_*`, `twist_*`, `strain_*`, with any unit of
/// length or angle, of its rate (mps, deg_per_s) or its acceleration (m_per_s2); strain is a plain number, or
/// millionths as `_um_per_m`. `sensors` says where each is read and along which axis; without it motions are the
/// hosel's and strain is that at the clamp. Long records are thinned to `most` samples. Throws InputError.
Series read_series(const std::filesystem::path& file, Table* sensors, double tip, double clamp, std::size_t most,
                   std::vector<std::string>& notes);

}  // namespace hosel::app
