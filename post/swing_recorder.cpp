#include "post/swing_recorder.hpp"

#include "post/file.hpp"

namespace hosel::post {
namespace fs = std::filesystem;

namespace {
constexpr double kHeadWidth = 0.11, kHeadHeight = 0.06;  // of the drawn face [m]
}  // namespace

SwingRecorder::SwingRecorder(fs::path directory, const Club& club, const models::Swing& swing,
                             SwingRecorderOptions options)
    : directory_(std::move(directory)),
      club_(club),
      swing_(swing),
      options_(options),
      head_(head_mesh(club.head, kHeadWidth, kHeadHeight)) {}

void SwingRecorder::finish() const { write_file(directory_ / "shaft.csv", loads_.table()); }

void SwingRecorder::write(const char* body, double time, const VtkMesh& mesh) {
  series_.try_emplace(body, directory_ / "vtk", body, VtkSeries::Form::surface).first->second.write(time, mesh);
}

void SwingRecorder::operator()(const models::SwingSample& sample, const fem::State& state) {
  if (steps_++ % options_.steps_per_frame != 0) return;
  const fem::Beam& shaft = swing_.shaft();
  loads_.add(sample.time, shaft, state);
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

  write("hands", sample.time, hands_mesh(sample.grip.position, {sample.force, sample.grip.rotation * sample.moment}));

  VtkMesh trail;
  trail.points = trail_;
  if (trail_.size() == 1) trail.cells = {{CellShape::vertex, {0}}};
  for (std::size_t i = 1; i < trail_.size(); ++i)
    trail.cells.push_back({CellShape::line, {std::int64_t(i) - 1, std::int64_t(i)}});
  write("trail", sample.time, trail);
}

Figure SwingRecorder::figure(double span) const { return {.panels = loads_.panels(span), .columns = 3}; }

std::vector<fs::path> SwingRecorder::files(const fs::path& directory) {
  return series_in(directory / "vtk", {"shaft", "head", "hands", "trail"});
}

}  // namespace hosel::post
