#include "hosel/post/impact_recorder.hpp"

#include <fmt/format.h>

#include <optional>

#include "hosel/post/ball_mesh.hpp"
#include "hosel/post/bodies.hpp"
#include "hosel/post/checkpoint.hpp"
#include "hosel/post/history.hpp"
#include "hosel/post/patch_mesh.hpp"
#include "hosel/post/vtk_series.hpp"

namespace hosel::post {
namespace fs = std::filesystem;

namespace {

/// The traction of the nearest quadrature point of the patch, mirrored where only half of it is computed.
class NearestTraction {
 public:
  explicit NearestTraction(const models::ImpactView& view)
      : ball_(view.ball), points_(view.contact.points(view.state)) {
    half_ = true;
    for (const fem::ContactPoint& p : points_) half_ = half_ && across(p.reference) > -1e-12;
  }

  Vec3 operator()(int node, double theta) const {
    Vec3 x = ball_.reference(node, theta);
    const Vec3 normal = ball_.placement().axes.col(2);
    const bool mirrored = half_ && across(x) < 0;
    if (mirrored) x -= 2 * across(x) * normal;
    const fem::ContactPoint* nearest = nullptr;
    double least = 0;
    for (const fem::ContactPoint& p : points_)
      if (const double d = (p.reference - x).squaredNorm(); !nearest || d < least) {
        nearest = &p;
        least = d;
      }
    if (!nearest || least > 4 * nearest->area) return Vec3::Zero();
    Vec3 t = nearest->traction;
    if (mirrored) t -= 2 * t.dot(normal) * normal;
    return t;
  }

 private:
  double across(const Vec3& x) const { return (x - ball_.placement().origin).dot(ball_.placement().axes.col(2)); }
  const fem::HarmonicSolid& ball_;
  std::vector<fem::ContactPoint> points_;
  bool half_ = true;
};

/// The ledger has a strain column for every body; the rigid ones' and the contact's stay zero.
bool deforms(const std::string& body) { return body != "head" && body != "contact"; }

}  // namespace

struct ImpactRecorder::State {
  fs::path directory;
  Blow blow;
  Vec3 slip;  // of the face along the ball at first touch: the tangential force begins positive and reverses
  RecorderOptions options;
  VtkMesh face_shape, head_shape;
  std::optional<History> history;
  std::optional<VtkSeries> ball, patch, face, head, shaft;
  std::string run;
  std::optional<SavedImpact> resumed;
  std::optional<Pose> start;
  long steps = 0;

  /// Output up to here is kept; negative: none.
  double kept() const { return resumed ? resumed->impact.solver.state.time : -1; }
  fs::path checkpoint() const { return directory / "checkpoint.cbor"; }
};

ImpactRecorder::ImpactRecorder(fs::path directory, const Blow& blow, RecorderOptions options, std::string run)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.directory = std::move(directory);
  s.options = options;
  s.blow = blow;
  s.slip = models::encounter(blow).ball_axes.col(1);
  fs::create_directories(s.directory);
  s.face_shape = face_mesh(blow.club.head.face, options.face_width, options.face_height);
  s.head_shape = head_mesh(blow.club.head, options.face_width, options.face_height);
  s.run = std::move(run);
  s.resumed = load_checkpoint(s.checkpoint(), s.run);
  if (!s.resumed) {
    fs::remove(s.checkpoint());
    return;
  }
  s.start = Pose{s.resumed->face_centre, s.resumed->face_axes};
  s.steps = s.resumed->steps;
}

ImpactRecorder::~ImpactRecorder() = default;

const models::ImpactCheckpoint* ImpactRecorder::resume() const {
  return state_->resumed ? &state_->resumed->impact : nullptr;
}

void ImpactRecorder::operator()(const models::ImpactView& view) {
  State& s = *state_;
  const solvers::Ledger& e = view.ledger;
  if (!s.history) {
    std::vector<std::string> columns = {"time_s",          "normal_force_N",     "force_heel_N",
                                        "force_up_N",      "tangential_force_N", "contact_pressure_Pa",
                                        "contact_area_m2", "penetration_m",      "kinetic_J"};
    for (const auto& [body, joules] : e.strain)
      if (deforms(body)) columns.push_back("strain_" + body + "_J");
    for (const char* name : {"contact_J", "friction_J", "viscous_J", "numerical_J", "external_J", "closure_J"})
      columns.emplace_back(name);
    for (std::size_t layer = 0; layer < view.ball.dissipated().size(); ++layer)
      columns.push_back(fmt::format("viscous_layer{}_J", layer));
    s.history.emplace(s.directory / "history.csv", columns, s.kept());
  }
  const fem::SurfacePose face = view.face;
  const Vec3 force = face.axes.transpose() * view.report.force;
  std::vector<double> row = {view.state.time,
                             force.x(),
                             force.y(),
                             force.z(),
                             view.report.force.dot(s.slip),
                             view.report.pressure,
                             view.report.area,
                             view.report.penetration,
                             e.kinetic};
  for (const auto& [body, joules] : e.strain)
    if (deforms(body)) row.push_back(joules);
  for (double x : {e.contact, e.friction, e.viscous, e.numerical, e.external, e.closure}) row.push_back(x);
  for (double x : view.ball.dissipated()) row.push_back(x);
  s.history->write(row);

  const Pose now{face.centre, face.axes};
  if (!s.start) s.start = now;
  if (s.steps++ % s.options.steps_per_frame != 0) return;
  if (s.options.vtk) {
    const fs::path vtk = s.directory / "vtk";
    if (!s.ball) {
      s.ball.emplace(vtk, "ball", VtkSeries::Form::volume, s.kept());
      s.patch.emplace(vtk, "patch", VtkSeries::Form::surface, s.kept());
      s.face.emplace(vtk, "face", VtkSeries::Form::surface, s.kept());
      s.head.emplace(vtk, "head", VtkSeries::Form::surface, s.kept());
      if (view.shaft) s.shaft.emplace(vtk, "shaft", VtkSeries::Form::surface, s.kept());
    }
    const double time = view.state.time;
    s.ball->write(time, ball_mesh(view.ball, view.state, NearestTraction(view), s.options.angles));
    s.patch->write(time, patch_mesh(view.contact.points(view.state)));
    s.face->write(time, placed(s.face_shape, *s.start, now, face.velocity, face.spin));
    s.head->write(time, placed(s.head_shape, *s.start, now, face.velocity, face.spin));
    if (view.shaft) s.shaft->write(time, shaft_mesh(*view.shaft, *s.blow.club.shaft, view.state));
  }
  save_checkpoint(s.checkpoint(), s.run, {view.checkpoint(), s.start->origin, s.start->rotation, s.steps});
}

std::vector<fs::path> ImpactRecorder::files() const {
  std::vector<fs::path> out;
  for (const char* body : {"ball", "patch", "face", "head", "shaft"})
    if (const fs::path file = state_->directory / "vtk" / fmt::format("{}.pvd", body); fs::exists(file))
      out.push_back(file);
  return out;
}

}  // namespace hosel::post
