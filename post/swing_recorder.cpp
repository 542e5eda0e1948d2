#include "hosel/post/swing_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hosel/post/file.hpp"

namespace hosel::post {
namespace fs = std::filesystem;

namespace {
constexpr std::array kBodies = {"shaft", "head", "hands", "trail"};
constexpr double kHeadWidth = 0.11, kHeadHeight = 0.06;  // of the drawn face [m]
}  // namespace

SwingRecorder::SwingRecorder(fs::path directory, const Club& club, const models::Swing& swing,
                             SwingRecorderOptions options)
    : directory_(std::move(directory)),
      club_(club),
      swing_(swing),
      options_(options),
      head_(head_mesh(club.head, kHeadWidth, kHeadHeight)),
      table_("time_s,arc_length_mm,x_mm,y_mm,z_mm,axial_force_N,torque_N_m,bending_moment_N_m\n") {}

void SwingRecorder::finish() const { write_file(directory_ / "shaft.csv", table_); }

void SwingRecorder::write(const char* body, double time, const VtkMesh& mesh) {
  auto it = series_.find(body);
  if (it == series_.end())
    it = series_.emplace(body, VtkSeries(directory_ / "vtk", body, VtkSeries::Form::surface)).first;
  it->second.write(time, mesh);
}

void SwingRecorder::operator()(const models::SwingSample& sample, const fem::State& state) {
  if (steps_++ % options_.steps_per_frame != 0) return;
  const fem::Beam& shaft = swing_.shaft();
  const std::vector<SectionLoad> loads = section_loads(shaft, state);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Vec3 x = 1e3 * state.q.segment<3>(shaft.nodes()[i].translation.q);
    table_ += fmt::format("{:.6f},{:.3f},{:.4f},{:.4f},{:.4f},{:.6g},{:.6g},{:.6g}\n", sample.time,
                          1e3 * shaft.line()[i].arc_length, x.x(), x.y(), x.z(), loads[i].axial, loads[i].torque,
                          loads[i].bending);
  }
  frames_.push_back({sample.time, loads});
  trail_.push_back(sample.head.position);
  if (!options_.vtk) return;
  // Places in space, not warped ones: a swing is no small displacement.
  VtkMesh line = shaft_mesh(shaft, *club_.shaft, state);
  for (std::size_t i = 0; i < line.points.size(); ++i)
    line.points[i] = state.q.segment<3>(shaft.nodes()[i].translation.q);
  line.point_fields.erase(line.point_fields.begin());  // the displacement from the straight shaft at the origin
  write("shaft", sample.time, line);

  const Mat3 axes = sample.head.rotation.toRotationMatrix();
  VtkMesh head = head_;
  std::vector<Vec3> velocity;
  for (Vec3& p : head.points) {
    const Vec3 arm = axes * (p - club_.head.cg);
    p = sample.head.position + arm;
    velocity.push_back(sample.head.velocity + (axes * sample.head.angular_velocity).cross(arm));
  }
  head.point_fields = {vector_field("velocity", "m/s", velocity)};
  write("head", sample.time, head);

  VtkMesh hands;
  hands.points = {sample.grip.position};
  hands.cells = {{CellShape::vertex, {0}}};
  hands.point_fields = {vector_field("force", "N", {sample.force}),
                        vector_field("moment", "N m", {sample.grip.rotation * sample.moment})};
  write("hands", sample.time, hands);

  VtkMesh trail;
  trail.points = trail_;
  if (trail_.size() == 1) trail.cells = {{CellShape::vertex, {0}}};
  for (std::size_t i = 1; i < trail_.size(); ++i)
    trail.cells.push_back({CellShape::line, {std::int64_t(i) - 1, std::int64_t(i)}});
  write("trail", sample.time, trail);
}

Figure SwingRecorder::figure(double span) const {
  constexpr int kInstants = 5;
  const std::string along = "from the grip point along the shaft [mm]";
  Panel bending{.title = "bending moment", .x_label = along, .y_label = "moment [N m]"},
      torque{.title = "torque", .x_label = along, .y_label = "torque [N m]"},
      axial{.title = "axial force", .x_label = along, .y_label = "tension [N]"};
  if (frames_.empty()) return {};
  const double end = frames_.back().time, begin = std::max(frames_.front().time, end - span);
  for (int k = 0; k < kInstants; ++k) {
    const double at = begin + (end - begin) * k / (kInstants - 1);
    const Frame& frame = *std::ranges::min_element(frames_, {}, [&](const Frame& f) { return std::abs(f.time - at); });
    Series m{.label = fmt::format("{:+.3f} s", frame.time)}, t = m, f = m;
    for (std::size_t i = 0; i < frame.loads.size(); ++i) {
      const double x = 1e3 * swing_.shaft().line()[i].arc_length;
      m.x.push_back(x), t.x.push_back(x), f.x.push_back(x);
      m.y.push_back(frame.loads[i].bending);
      t.y.push_back(frame.loads[i].torque);
      f.y.push_back(frame.loads[i].axial);
    }
    bending.series.push_back(std::move(m));
    torque.series.push_back(std::move(t));
    axial.series.push_back(std::move(f));
  }
  return {.panels = {bending, torque, axial}, .columns = 3};
}

std::vector<fs::path> SwingRecorder::files(const fs::path& directory) {
  std::vector<fs::path> out;
  for (const char* body : kBodies)
    if (const fs::path file = directory / "vtk" / fmt::format("{}.pvd", body); fs::exists(file)) out.push_back(file);
  return out;
}

}  // namespace hosel::post
