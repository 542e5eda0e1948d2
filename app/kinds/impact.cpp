#include "hosel/app/kinds/impact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "hosel/app/read_blow.hpp"
#include "hosel/app/read_options.hpp"
#include "hosel/models/fe_impact.hpp"
#include "hosel/models/registry.hpp"
#include "hosel/post/impact_recorder.hpp"
#include "hosel/post/launch_table.hpp"
#include "hosel/post/patch_figure.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

class ImpactJob final : public Job {
 public:
  explicit ImpactJob(CaseFile& file) {
    Table root = file.root();
    const std::vector<std::string> names = read_models(root);
    blow_ = read_blow(root, names);
    const models::Options options = read_options(root, names);
    for (const std::string& name : names) models_.push_back({name, models::find(name)->make(options)});
    if (auto output = root.optional_table("output")) {
      record_.vtk = output->flag("vtk", record_.vtk);
      record_.steps_per_frame = int(output->integer("steps_per_frame", 1, 100000, record_.steps_per_frame));
      record_.angles = int(output->integer("angles", 8, 256, record_.angles));
      record_.face_width = output->quantity("face_width", "mm", {0.005, 0.5}, record_.face_width);
      record_.face_height = output->quantity("face_height", "mm", {0.005, 0.5}, record_.face_height);
    }
    if (auto measured = root.optional_table("measured"))
      for (const std::string& key : measured->keys()) {
        const SplitName split = split_unit(key);
        const post::Channel* channel = post::find_channel(split.stem);
        if (!channel)
          measured->fail(key, fmt::format("no launch quantity of this name (known: {})", post::channel_names()));
        measured_.emplace_back(channel, measured->quantity(split.stem, std::string(channel->unit)));
      }
  }

  void run(Output& out) override {
    nlohmann::json summary;
    std::vector<post::LaunchColumn> columns;
    std::vector<fs::path> files;
    for (const Entry& entry : models_) {
      if (const models::FeModel* fe = entry.fe()) {
        const models::FeOutcome outcome = run_fe(out, entry.name, *fe, home(out, entry), files);
        columns.push_back({entry.name, outcome.launch});
        summary["models"][entry.name] = post::to_json(outcome.launch);
        if (const auto e_t = tangential_restitution(outcome.launch))
          summary["models"][entry.name]["tangential_restitution"] = *e_t;
        summary["models"][entry.name]["solution"] = solution(out, entry.name, outcome.result);
      } else {
        columns.push_back({entry.name, entry.model->launch(blow_)});
        summary["models"][entry.name] = post::to_json(columns.back().launch);
      }
    }
    for (const auto& [channel, value] : measured_)
      summary["measured"][fmt::format("{}_{}", channel->name, channel->unit)] = value / channel->si;
    out.say(post::launch_table(columns, measured_));
    for (const fs::path& f : files) out.say(fmt::format("ParaView: {}", f.string()));
    out.write_summary(summary);
    for (const Entry& entry : models_)
      if (entry.fe()) fs::remove(home(out, entry) / "checkpoint.cbor");
  }

 private:
  struct Entry {
    std::string name;
    std::unique_ptr<models::ImpactModel> model;
    const models::FeModel* fe() const { return dynamic_cast<const models::FeModel*>(model.get()); }
  };

  /// Where an FE model's files go: OUT itself, or OUT/<model> where several models share it.
  fs::path home(const Output& out, const Entry& entry) const {
    const auto several = std::ranges::count_if(models_, [](const Entry& e) { return e.fe() != nullptr; }) > 1;
    return several ? out.directory() / entry.name : out.directory();
  }

  models::FeOutcome run_fe(Output& out, const std::string& name, const models::FeModel& model, const fs::path& home,
                           std::vector<fs::path>& files) const {
    if (out.force()) fs::remove(home / "checkpoint.cbor");
    post::ImpactRecorder recorder(home, blow_, record_, name + "\n" + out.resolved_case());
    if (const models::ImpactCheckpoint* from = recorder.resume())
      out.say(fmt::format("{}: goes on from t = {:.3f} ms, where an earlier run was stopped", name,
                          1e3 * from->solver.state.time));
    Progress progress = out.progress(name);
    const models::FeOutcome outcome = model.solve(
        blow_,
        [&](const models::ImpactView& view) {
          recorder(view);
          progress.update(
              std::min(0.99, view.state.time / view.expected_end),
              fmt::format("t = {:.3f} ms, force {:.1f} kN", 1e3 * view.state.time, 1e-3 * view.report.normal_force));
        },
        recorder.resume());
    progress.finish(fmt::format("{} steps", outcome.result.counts.steps));
    for (const fs::path& f : recorder.files()) files.push_back(f);
    if (record_.vtk) {
      const post::PatchHistory patch = post::read_patch(home / "vtk", models::encounter(blow_).ball_axes);
      if (const std::string why = post::draw_patch(patch, home / "patch"); !why.empty()) out.say(why);
    }
    return outcome;
  }

  /// Slip speed of ball over face at the contact point after the blow, over that before it, reversed: 1 for a perfect
  /// superball, 0 for rolling. None where there was no slip. The head is taken in the attitude of first contact.
  std::optional<double> tangential_restitution(const Launch& launch) const {
    const models::Encounter e = models::encounter(blow_);
    const Vec3 slip = e.approach - e.normal_speed * e.normal;
    if (slip.norm() < 1e-9 * e.approach.norm()) return std::nullopt;
    const Vec3 arm = e.point - (e.face_centre + e.face_axes * blow_.club.head.cg);
    const Vec3 face = launch.head_velocity +
                      (std::isfinite(blow_.club.head.mass) ? Vec3(launch.head_spin.cross(arm)) : Vec3::Zero());
    const Vec3 ball = launch.velocity + launch.spin.cross(-blow_.ball.radius * e.normal);
    return (ball - face).dot(slip) / slip.squaredNorm();
  }

  /// What the solution was and how well its energy adds up: for the person and the summary.
  nlohmann::json solution(Output& out, const std::string& name, const models::FeImpactResult& r) const {
    const double closure = r.ledger.closure / r.ledger.initial;
    out.say(fmt::format(
        "{}: contact {:.4f} ms, peak force {:.3f} kN, compression {:.2f} mm, penetration {:.1f} um, "
        "energy closes to {:.1e} of the initial",
        name, 1e3 * r.contact_time, 1e-3 * r.peak_force, 1e3 * r.compression, 1e6 * r.penetration, closure));
    nlohmann::json j = {{"contact_time_ms", 1e3 * r.contact_time},
                        {"peak_force_N", r.peak_force},
                        {"peak_time_ms", 1e3 * r.peak_time},
                        {"compression_mm", 1e3 * r.compression},
                        {"penetration_um", 1e6 * r.penetration},
                        {"tangential_creep_um", 1e6 * r.creep},
                        {"steps", r.counts.steps},
                        {"rejected_steps", r.counts.rejected},
                        {"newton_iterations", r.counts.iterations},
                        {"factorisations", r.counts.factorisations},
                        {"dissipated_by_layer_J", r.dissipated}};
    j["energy_J"] = {
        {"initial", r.ledger.initial},     {"kinetic", r.ledger.kinetic},   {"strain", r.ledger.strain_total()},
        {"contact", r.ledger.contact},     {"friction", r.ledger.friction}, {"viscous", r.ledger.viscous},
        {"numerical", r.ledger.numerical}, {"external", r.ledger.external}, {"closure", r.ledger.closure}};
    return j;
  }

  std::vector<Entry> models_;
  Blow blow_;
  post::RecorderOptions record_;
  post::Measured measured_;
};

}  // namespace

std::unique_ptr<Job> read_impact(CaseFile& file) { return std::make_unique<ImpactJob>(file); }

}  // namespace hosel::app
