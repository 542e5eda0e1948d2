#include "app/read_markers.hpp"

#include <fmt/format.h>

#include <array>

#include "app/read_sheet.hpp"

namespace hosel::app {
namespace {

std::vector<Vec3> points(const post::Sheet& sheet, const std::string& stem) {
  const auto x = column_with_gaps(sheet, stem + "_x_m"), y = column_with_gaps(sheet, stem + "_y_m"),
             z = column_with_gaps(sheet, stem + "_z_m");
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < x.size(); ++i) out.emplace_back(x[i], y[i], z[i]);
  return out;
}

}  // namespace

MarkerInput read_markers(Table& table) {
  MarkerInput in;
  in.file = table.data_file({"file", "CSV of the markers on grip and head"});
  in.smoothing = table.quantity({"smoothing", "time constant of the smoothing spline"}, "ms", Range::positive());
  in.still = table.quantity({"still", "how long the club hangs still at the start of the record"}, "s",
                            Range::positive(), 0.1);
  return in;
}

models::MarkerSwing read_marker_swing(const MarkerInput& in, double end) {
  const post::Sheet sheet = read_sheet(in.file);
  models::MarkerTrack track;
  track.times = column_with_gaps(sheet, "time_s");
  std::array<std::vector<Vec3>, 3> shaft, head;
  for (std::size_t k = 0; k < 3; ++k) {
    shaft[k] = points(sheet, fmt::format("shaft_{}", k + 1));
    head[k] = points(sheet, fmt::format("head_{}", k + 1));
  }
  const auto left = points(sheet, "left_wrist"), right = points(sheet, "right_wrist");
  for (std::size_t i = 0; i < track.times.size(); ++i) {
    track.shaft.push_back({shaft[0][i], shaft[1][i], shaft[2][i]});
    track.head.push_back({head[0][i], head[1][i], head[2][i]});
    track.wrists.push_back(0.5 * (left[i] + right[i]));
  }
  const models::MarkerSwing swing = models::marker_swing(track, in.still, end);
  if (const auto wrong = swing.clamp.faults(0.02); !wrong.empty())
    throw InputError(fmt::format("{}: {}", in.file.string(), wrong.front()));
  return swing;
}

}  // namespace hosel::app
