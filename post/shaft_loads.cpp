#include "post/shaft_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hosel::post {

std::vector<SectionLoad> section_loads(const fem::Beam& beam, const fem::State& state) {
  const std::vector<fem::Beam::Resultant> at = beam.resultants(state);
  std::vector<SectionLoad> out;
  std::size_t k = 0;
  for (const mesh::LineNode& node : beam.line()) {
    while (k + 2 < at.size() && at[k + 1].arc_length < node.arc_length) ++k;
    const double w = (node.arc_length - at[k].arc_length) / (at[k + 1].arc_length - at[k].arc_length);
    const Vec3 force = (1 - w) * at[k].force + w * at[k + 1].force;
    const Vec3 moment = (1 - w) * at[k].moment + w * at[k + 1].moment;
    out.push_back({force.x(), moment.x(), moment.tail<2>().norm()});
  }
  return out;
}

void ShaftLoads::add(double time, const fem::Beam& shaft, const fem::State& state) {
  if (instants_.empty())
    for (const mesh::LineNode& node : shaft.line()) arc_length_.push_back(node.arc_length);
  instants_.push_back({time, section_loads(shaft, state)});
  for (std::size_t i = 0; i < arc_length_.size(); ++i) {
    const SectionLoad& load = instants_.back().loads[i];
    const Vec3 x = 1e3 * state.q.segment<3>(shaft.nodes()[i].translation.q);
    table_ += fmt::format("{:.7f},{:.3f},{:.4f},{:.4f},{:.4f},{:.6g},{:.6g},{:.6g}\n", time, 1e3 * arc_length_[i],
                          x.x(), x.y(), x.z(), load.axial, load.torque, load.bending);
  }
}

std::vector<Panel> ShaftLoads::panels(double span) const {
  if (instants_.empty()) return {};
  constexpr int kCurves = 5;
  const std::string along = "from the grip point along the shaft [mm]";
  Panel bending{.title = "bending moment", .x_label = along, .y_label = "moment [N m]"},
      torque{.title = "torque", .x_label = along, .y_label = "torque [N m]"},
      axial{.title = "axial force", .x_label = along, .y_label = "tension [N]"};
  const double end = instants_.back().time, begin = std::max(instants_.front().time, end - span);
  for (int k = 0; k < kCurves; ++k) {
    const double at = begin + (end - begin) * k / (kCurves - 1);
    const Instant& i =
        *std::ranges::min_element(instants_, {}, [&](const Instant& x) { return std::abs(x.time - at); });
    Series m{.label = span < 0.01 ? fmt::format("{:.2f} ms", 1e3 * i.time) : fmt::format("{:+.3f} s", i.time)};
    for (const double s : arc_length_) m.x.push_back(1e3 * s);
    Series t = m, f = m;
    for (const SectionLoad& load : i.loads) {
      m.y.push_back(load.bending);
      t.y.push_back(load.torque);
      f.y.push_back(load.axial);
    }
    bending.series.push_back(std::move(m));
    torque.series.push_back(std::move(t));
    axial.series.push_back(std::move(f));
  }
  return {bending, torque, axial};
}

}  // namespace hosel::post
