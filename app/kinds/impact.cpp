#include "hosel/app/kinds/impact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "hosel/app/kinds/impact_page.hpp"
#include "hosel/app/read_blow.hpp"
#include "hosel/app/read_flight.hpp"
#include "hosel/app/read_options.hpp"
#include "hosel/app/stop.hpp"
#include "hosel/app/version.hpp"
#include "hosel/golf/face_library.hpp"
#include "hosel/models/checked_launch.hpp"
#include "hosel/models/face_strike.hpp"
#include "hosel/models/fe_impact.hpp"
#include "hosel/models/matched_launch.hpp"
#include "hosel/models/oblique.hpp"
#include "hosel/models/registry.hpp"
#include "hosel/post/impact_recorder.hpp"
#include "hosel/post/launch_table.hpp"

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
    face_ = options.fe.face;
    fe_ = options.fe;
    for (const std::string& name : names) models_.push_back({name, models::find(name)->make(options)});
    // A coarser companion costs a seventh of a run at the default accuracy, and every number gets its error.
    if (std::ranges::any_of(models_, [](const Entry& e) { return e.fe() != nullptr; })) {
      const auto coarser = options.fe.coarser();
      if (root.flag(
              {"error_estimate", "run a coarser companion too: every number of a launch gets its numerical error"},
              coarser.has_value() && root.has("accuracy"))) {
        if (!coarser)
          root.fail("error_estimate",
                    "the numerics are as coarse as they can be: accuracy = \"default\" has a coarser companion");
        models::Options companion = options;
        companion.fe = *coarser;
        for (Entry& e : models_)
          if (e.fe()) e.companion = models::find(e.name)->make(companion);
      }
    }
    matched_ = root.flag({"matched_launch", "turn the loft until the launch angle is the measured one"}, false);
    record_ = read_recorder(root);
    if (auto measured = root.optional_table("measured"))
      for (const std::string& key : measured->keys()) {
        if (post::Range* range = key == "tangential_restitution" ? &ranges_.tangential_restitution
                                 : key == "launch_ratio"         ? &ranges_.launch_ratio
                                                                 : nullptr) {
          const auto ends = measured->numbers({key, "lowest and highest that was measured"}, 2);
          if (ends[0] > ends[1]) measured->fail(key, "give the lowest and the highest that was measured");
          *range = std::pair{ends[0], ends[1]};
          continue;
        }
        const SplitName split = split_unit(key);
        const post::Channel* channel = post::find_channel(split.stem);
        if (!channel)
          measured->fail(key, fmt::format("no launch quantity of this name (known: {})", post::channel_names()));
        measured_.emplace_back(channel,
                               measured->quantity({split.stem, "what was measured of this blow", "<launch quantity>"},
                                                  std::string(channel->unit)));
      }
    if (matched_ && !launch_angle()) root.fail("matched_launch", "state the measured launch angle in [measured]");
    flight_ = read_optional_flight(root);
  }

  void run(Output& out) override {
    const bool fe = std::ranges::any_of(models_, [](const Entry& e) { return e.fe() != nullptr; });
    if (fe && !face_ && models::wants_yielding_face(blow_.club.head)) out.say(rigid_face_costs());
    if (flight_) flight_->show_in(out);
    nlohmann::json summary;
    std::vector<post::LaunchColumn> columns;
    std::vector<fs::path> files;
    std::vector<FeRun> runs;
    for (const Entry& entry : models_) {
      if (const models::FeModel* model = entry.fe()) {
        const models::FeOutcome outcome = run_fe(out, entry.name, *model, home(out, entry), files, runs);
        models::check_launch(blow_, outcome.launch);
        columns.push_back({entry.name, outcome.launch});
        summary["models"][entry.name] = post::to_json(outcome.launch);
        summary["models"][entry.name]["solution"] = solution(out, entry.name, outcome.result);
        if (entry.companion) {
          columns.back().coarser = models::checked_launch(*entry.companion, blow_);
          nlohmann::json& error = summary["models"][entry.name]["numerical_error"];
          error = numerical_error(outcome.launch, *columns.back().coarser);
          if (error.at("ball_speed_mps") > 0.02 * outcome.launch.ball_speed())
            out.warn(fmt::format("{}: the ball speed moves by more than 2 % with the numerics: a finer accuracy",
                                 entry.name));
        }
      } else {
        columns.push_back({entry.name, models::checked_launch(*entry.model, blow_)});
        summary["models"][entry.name] = post::to_json(columns.back().launch);
      }
      note_oblique(blow_, columns.back(), summary["models"][entry.name]);
      if (!matched_) continue;
      // The loft may have been computed from the ball: the same again with the loft unknown and the launch angle seen.
      const models::MatchedLaunch found =
          models::match_launch_angle(*entry.model, blow_, *launch_angle(), radians(0.03));
      const double loft = degrees(found.blow.delivery.dynamic_loft);
      columns.push_back({fmt::format("loft {:.2f}", loft), found.launch});
      nlohmann::json& said = summary["matched_launch"][entry.name] = post::to_json(found.launch);
      said["dynamic_loft_deg"] = loft;
      note_oblique(found.blow, columns.back(), said);
    }
    if (flight_)
      for (post::LaunchColumn& c : columns) c.flight = flight_->follow(c.launch, blow_.ball);
    for (const auto& [channel, value] : measured_)
      summary["measured"][fmt::format("{}_{}", channel->name, channel->unit)] = value / channel->si;
    const post::TextTable table = post::launch_table(columns, measured_, ranges_, out.units());
    out.say(table.text());
    show_impact(out, {blow_, columns, measured_, table, runs, face_.has_value(), flight_.has_value(), record_.vtk});
    if (flight_)
      for (const post::LaunchColumn& c : columns) {
        nlohmann::json& said = summary["flights"][c.title] = post::to_json(*c.flight);
        said["budget"] = report_flight(out, *flight_, c.title, c.launch, blow_.ball);
      }
    for (const fs::path& f : files) out.say(fmt::format("ParaView: {}", f.string()));
    out.write_summary(summary);
    for (const Entry& entry : models_)  // only now: a disk too full for the summary must not cost the run
      if (entry.fe()) fs::remove(home(out, entry) / "checkpoint.cbor");
  }

 private:
  /// What a driver-like head loses by a rigid face, along the normal.
  std::string rigid_face_costs() const {
    const models::Striker ball = models::golf_ball(blow_.ball);
    const double mass = models::mass_at(blow_.club.head, -blow_.delivery.impact_toe, blow_.delivery.impact_high);
    const FaceCompliance face = find_face("modern-driver")->face;
    const double shape = face.shape(-blow_.delivery.impact_toe, blow_.delivery.impact_high).value;
    const double speed = models::encounter(blow_).normal_speed;
    const double gain = (1 + models::strike(ball, mass, face, shape, speed).restitution) /
                            (1 + models::strike(ball, mass, {}, 0, speed).restitution) -
                        1;
    return fmt::format(
        "the face of this driver-like head is rigid: a modern one, [face] name = \"modern-driver\", would give the "
        "ball "
        "some {:.1f} % more speed here",
        100 * gain);
  }

  struct Entry {
    std::string name;
    std::unique_ptr<models::ImpactModel> model;
    std::unique_ptr<models::ImpactModel> companion = nullptr;  ///< the same on coarser numerics
    const models::FeModel* fe() const { return dynamic_cast<const models::FeModel*>(model.get()); }
  };

  /// Where an FE model's files go: OUT itself, or OUT/<model> where several models share it.
  fs::path home(const Output& out, const Entry& entry) const {
    const auto several = std::ranges::count_if(models_, [](const Entry& e) { return e.fe() != nullptr; }) > 1;
    return several ? out.directory() / entry.name : out.directory();
  }

  models::FeOutcome run_fe(Output& out, const std::string& name, const models::FeModel& model, const fs::path& home,
                           std::vector<fs::path>& files, std::vector<FeRun>& runs) const {
    if (out.force()) fs::remove(home / "checkpoint.cbor");
    post::ImpactRecorder recorder(home, blow_, record_,
                                  fmt::format("{}\n{}\n{}", name, program_version(), out.resolved_case()));
    if (const models::ImpactCheckpoint* from = recorder.resume())
      out.tell(fmt::format("{}: goes on from t = {:.3f} ms, where an earlier run was stopped", name,
                           1e3 * from->solver.state.time));
    Progress progress = out.progress(name);
    const StopSignals stop;
    const models::FeOutcome outcome = model.solve(
        blow_,
        [&](const models::ImpactView& view) {
          recorder(view);
          stop.check();
          progress.update(
              std::min(0.99, view.state.time / view.expected_end),
              fmt::format("t = {:.3f} ms, force {:.1f} kN", 1e3 * view.state.time, 1e-3 * view.report.normal_force));
        },
        recorder.resume());
    progress.finish(fmt::format("{} steps", outcome.result.counts.steps));
    for (const fs::path& f : recorder.files()) files.push_back(f);
    runs.push_back({name, home, outcome.result});
    runs.back().section = recorder.at_largest_force();
    if (record_.vtk)
      runs.back().patch =
          post::read_patch(home / "vtk", models::encounter(blow_).ball_axes, models::mesh_axes(blow_, fe_));
    return outcome;
  }

  std::optional<double> launch_angle() const {
    for (const auto& [channel, value] : measured_)
      if (channel->name == "launch_angle") return value;
    return std::nullopt;
  }

  static void note_oblique(const Blow& blow, post::LaunchColumn& column, nlohmann::json& said) {
    column.oblique = {models::tangential_restitution(blow, column.launch), models::launch_ratio(blow, column.launch)};
    if (column.oblique.tangential_restitution) said["tangential_restitution"] = *column.oblique.tangential_restitution;
    if (column.oblique.launch_ratio) said["launch_ratio"] = *column.oblique.launch_ratio;
  }

  /// By how much the launch moves against the coarser companion: a bound of what is left where both converge.
  static nlohmann::json numerical_error(const Launch& launch, const Launch& coarser) {
    nlohmann::json j;
    for (const post::Channel& c : post::channels())
      j[fmt::format("{}_{}", c.name, c.unit)] = std::abs((launch.*c.value)() - (coarser.*c.value)()) / c.si;
    return j;
  }

  /// What the solution was and how well its energy adds up: for the person and the summary.
  nlohmann::json solution(Output& out, const std::string& name, const models::FeImpactResult& r) const {
    const double closure = r.ledger.closure / r.ledger.initial;
    // What the blow can change is the energy of the relative motion, not that of a head that flies on.
    const models::Encounter e = models::encounter(blow_);
    const double head = blow_.club.head.mass, ball = blow_.ball.mass;
    const double relative = 0.5 * (std::isfinite(head) ? head * ball / (head + ball) : ball) * e.approach.squaredNorm();
    const auto doubt = [&](const char* what, double value, double limit, const char* remedy) {
      if (std::abs(value) > limit)
        out.warn(fmt::format("{}: {} is {:.2g} (wanted: below {:g}): {}", name, what, value, limit, remedy));
    };
    doubt("the energy unaccounted for, of that of the relative motion,", r.ledger.closure / relative, 0.005,
          "more steps_per_contact");
    doubt("the penetration, of the compression,", r.penetration / r.compression, 0.02, "a higher contact.penalty");
    doubt("the elastic slip, of the compression,", r.creep / r.compression, 0.02,
          "a higher contact.tangential_penalty");
    out.say(fmt::format(
        "{}: contact {:.4f} ms, peak force {:.3f} kN, compression {:.2f} mm, penetration {:.1f} um, "
        "energy closes to {:.1e} of the initial",
        name, 1e3 * r.contact_time, 1e-3 * r.peak_force, 1e3 * r.compression, 1e6 * r.penetration, closure));
    nlohmann::json j = {{"contact_time_ms", 1e3 * r.contact_time},
                        {"peak_force_N", r.peak_force},
                        {"peak_time_ms", 1e3 * r.peak_time},
                        {"compression_mm", 1e3 * r.compression},
                        {"closure_of_relative_energy", r.ledger.closure / relative},
                        {"penetration_of_compression", r.penetration / r.compression},
                        {"slip_error_of_compression", r.creep / r.compression},
                        {"penetration_um", 1e6 * r.penetration},
                        {"tangential_creep_um", 1e6 * r.creep},
                        {"steps", r.counts.steps},
                        {"rejected_steps", r.counts.rejected},
                        {"newton_iterations", r.counts.iterations},
                        {"factorisations", r.counts.factorisations},
                        {"worst_residual_of_forces", r.counts.worst_residual},
                        {"dissipated_by_layer_J", r.dissipated}};
    if (face_) {
      j["face_travel_mm"] = 1e3 * r.face_travel;
      j["face_energy_J"] = r.face_energy;
    }
    j["energy_J"] = {
        {"initial", r.ledger.initial},     {"kinetic", r.ledger.kinetic},   {"strain", r.ledger.strain_total()},
        {"contact", r.ledger.contact},     {"friction", r.ledger.friction}, {"viscous", r.ledger.viscous},
        {"numerical", r.ledger.numerical}, {"external", r.ledger.external}, {"closure", r.ledger.closure}};
    return j;
  }

  std::vector<Entry> models_;
  Blow blow_;
  models::FeImpactOptions fe_;
  std::optional<FaceCompliance> face_;
  post::RecorderOptions record_;
  post::Measured measured_;
  post::MeasuredOblique ranges_;
  bool matched_ = false;
  std::optional<FlightSetup> flight_;
};

}  // namespace

std::unique_ptr<Job> read_impact(CaseFile& file) { return std::make_unique<ImpactJob>(file); }

}  // namespace hosel::app
