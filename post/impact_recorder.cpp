#include "post/impact_recorder.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "models/club/hosel_load.hpp"
#include "post/ball_mesh.hpp"
#include "post/bodies.hpp"
#include "post/checkpoint.hpp"
#include "post/file.hpp"
#include "post/history.hpp"
#include "post/patch_mesh.hpp"
#include "post/vtk_series.hpp"

namespace hosel::post {
namespace fs = std::filesystem;

namespace {

/// A checkpoint costs the solver its factors, so that a run which goes on from it takes the same steps to the last bit.
constexpr long kFramesPerCheckpoint = 8;

/// The ledger has a strain column for every body; the rigid ones' and the contact's stay zero.
bool deforms(const std::string& body) { return body != "head" && body != "contact"; }

}  // namespace

struct ImpactRecorder::State {
  fs::path directory;
  Blow blow;
  RecorderOptions options;
  VtkMesh face_shape, head_shape;
  std::optional<History> history;
  std::map<std::string, VtkSeries> series;  // by body
  std::string run;
  std::optional<SavedImpact> resumed;
  std::optional<Pose> start;
  std::optional<BallSection> section;
  MovingBlow moving;
  long steps = 0;

  fs::path checkpoint() const { return directory / "checkpoint.cbor"; }
  fs::path history_file() const { return directory / "history.csv"; }

  static VtkSeries::Form form(const std::string& body) {
    return body == "ball" ? VtkSeries::Form::volume : VtkSeries::Form::surface;
  }

  /// Whether all that the stopped run had written up to its checkpoint is there as it was.
  bool whole(const SavedImpact& saved) const {
    if (!History::holds(history_file(), saved.history)) return false;
    for (const auto& [body, mark] : saved.series)
      if (!VtkSeries::holds(directory / "vtk", body, form(body), mark)) return false;
    return saved.series.empty() != options.vtk;
  }

  void write(const std::string& body, double time, const VtkMesh& mesh) {
    const VtkSeries::Mark* kept = resumed ? &resumed->series.at(body) : nullptr;
    series.try_emplace(body, directory / "vtk", body, form(body), kept).first->second.write(time, mesh);
  }
};

ImpactRecorder::ImpactRecorder(fs::path directory, const Blow& blow, RecorderOptions options, std::string run)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.directory = std::move(directory);
  s.options = options;
  s.blow = blow;
  fs::create_directories(s.directory);
  remove_unfinished(s.directory);
  s.face_shape = face_mesh(blow.club.head.face, options.face_width, options.face_height);
  s.head_shape = head_mesh(blow.club.head, options.face_width, options.face_height);
  s.run = std::move(run);
  if (options.checkpoints) s.resumed = load_checkpoint(s.checkpoint(), s.run);
  if (!s.resumed || !s.whole(*s.resumed)) {
    s.resumed.reset();
    remove_file(s.checkpoint());
    return;
  }
  s.start = Pose{s.resumed->face_centre, s.resumed->face_axes};
  s.section = s.resumed->section;
  s.moving = s.resumed->moving;
  s.steps = s.resumed->history.rows;
}

ImpactRecorder::~ImpactRecorder() = default;

const std::optional<BallSection>& ImpactRecorder::at_largest_force() const { return state_->section; }

const MovingBlow& ImpactRecorder::moving() const { return state_->moving; }

const models::ImpactCheckpoint* ImpactRecorder::resume() const {
  return state_->resumed ? &state_->resumed->impact : nullptr;
}

void ImpactRecorder::operator()(const models::ImpactView& view) {
  State& s = *state_;
  const solvers::Ledger& e = view.ledger;
  if (!s.history) {
    std::vector<std::string> columns = {"time_s",        "normal_force_N",     "force_out_N",         "force_heel_N",
                                        "force_up_N",    "tangential_force_N", "contact_pressure_Pa", "contact_area_m2",
                                        "penetration_m", "kinetic_J"};
    for (const auto& [body, joules] : e.strain)
      if (deforms(body)) columns.push_back("strain_" + body + "_J");
    for (const char* name : {"contact_J", "friction_J", "viscous_J", "numerical_J", "external_J", "closure_J"})
      columns.emplace_back(name);
    for (std::size_t layer = 0; layer < view.ball.dissipated().size(); ++layer)
      columns.push_back(fmt::format("viscous_layer{}_J", layer));
    s.history.emplace(s.history_file(), columns, s.resumed ? &s.resumed->history : nullptr);
  }
  const fem::SurfacePose face = view.face;
  // Of the face along the ball at first touch: the tangential force begins positive and reverses.
  const Vec3 slip = view.bodies.frame.ball_axes.col(1);
  const Vec3 force = face.axes.transpose() * view.report.force;
  std::vector<double> row = {view.state.time,
                             view.report.normal_force,
                             force.x(),
                             force.y(),
                             force.z(),
                             view.report.force.dot(slip),
                             view.report.pressure,
                             view.report.area,
                             view.report.penetration,
                             e.kinetic};
  for (const auto& [body, joules] : e.strain)
    if (deforms(body)) row.push_back(joules);
  for (double x : {e.contact, e.friction, e.viscous, e.numerical, e.external, e.closure}) row.push_back(x);
  for (double x : view.ball.dissipated()) row.push_back(x);
  s.history->write(row);

  if (view.report.normal_force > (s.section ? s.section->force : 0))
    s.section = ball_section(view, s.blow.club.head.face);

  const Pose now{face.centre, face.axes};
  if (!s.start) s.start = now;
  const long step = s.steps++;
  const bool frame = step % s.options.steps_per_frame == 0, moves = s.moving.wants(step);
  if (!frame && !moves) return;
  const double time = view.state.time;
  const std::vector<fem::ContactPoint> points = view.contact.points(view.state);
  const fem::TractionField acting(view.ball, points);
  const VtkMesh ball = ball_mesh(view.ball, view.state, acting, s.options.angles);
  std::vector<double> travel;
  for (const Vec3& p : s.face_shape.points) travel.push_back(view.contact.surface_travel(view.state, p));
  const VtkMesh struck = placed(s.face_shape, *s.start, now, face.velocity, face.spin, travel),
                head = placed(s.head_shape, *s.start, now, face.velocity, face.spin);
  const std::optional<VtkMesh> shaft =
      view.shaft ? std::optional(shaft_mesh(*view.shaft, *s.blow.club.shaft, view.state)) : std::nullopt;
  if (moves) s.moving.add(view, ball, s.options.angles, struck, head, shaft ? &*shaft : nullptr);
  if (!frame) return;
  if (s.options.vtk) {
    s.write("ball", time, ball);
    s.write("patch", time, patch_mesh(points, acting));
    s.write("face", time, struck);
    s.write("head", time, head);
    if (shaft) {
      s.write("shaft", time, *shaft);
      const Vec3 start = view.shaft->line().front().position,
                 grip = view.state.q.segment<3>(view.shaft->nodes().front().translation.q);
      VtkMesh hands = hands_mesh(start, models::grip_load(*view.shaft, view.state));
      hands.point_fields.push_back(vector_field("displacement", "m", {grip - start}));
      s.write("hands", time, hands);
    }
  }
  if (!s.options.checkpoints) return;
  if (step / s.options.steps_per_frame % kFramesPerCheckpoint != 0) return;
  SavedImpact saved{view.checkpoint(), s.start->origin, s.start->rotation, s.section, s.moving, s.history->mark(), {}};
  for (const auto& [body, series] : s.series) saved.series[body] = series.mark();
  save_checkpoint(s.checkpoint(), s.run, saved);
}

std::vector<fs::path> ImpactRecorder::files() const {
  return series_in(state_->directory / "vtk", {"ball", "patch", "face", "head", "shaft", "hands"});
}

}  // namespace hosel::post
