#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "app/kinds/impact_page.hpp"
#include "app/library.hpp"
#include "app/overrides.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_swing.hpp"
#include "app/solution_doubts.hpp"
#include "app/stop.hpp"
#include "app/version.hpp"
#include "golf/face_library.hpp"
#include "golf/parallel.hpp"
#include "models/checked_launch.hpp"
#include "models/fe/impact.hpp"
#include "models/matched_launch.hpp"
#include "models/oblique.hpp"
#include "models/reduced/face_strike.hpp"
#include "models/registry.hpp"
#include "post/file.hpp"
#include "post/impact_recorder.hpp"
#include "post/launch_table.hpp"
#include "post/shaft_loads.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

/// What all columns share: `[[compare]]` sets none of it.
constexpr std::array<std::string_view, 6> kOfTheCase = {"kind",   "title",    "matched_launch",
                                                        "output", "measured", "compare"};

class ImpactJob final : public Job {
 public:
  explicit ImpactJob(CaseFile& file) {
    Table root = file.root();
    own_ = read_side(root);
    missing_ = own_.missing;
    matched_ = root.flag({"matched_launch", "turn the loft until the launch angle is the measured one"}, false);
    if (matched_) own_.file = std::make_shared<CaseFile>(file, file.overrides());
    record_ = read_recorder(root);
    record_.checkpoints = !own_.swung;  // what its shaft carries is told of the whole blow
    if (auto measured = root.optional_table("measured")) read_measured(*measured);
    if (matched_ && own_.swung) root.fail("matched_launch", "the swing says the loft");
    if (matched_ && !launch_angle()) root.fail("matched_launch", "state the measured launch angle in [measured]");
    std::vector<std::string> taken;
    for (Table t : root.tables("compare")) {
      const std::string name = t.name({"name", "of the columns that stand before the case's own"}, taken);
      std::vector<std::string> set = t.texts({"set", "keys in which it differs from the case, table.key=value"});
      for (const std::string& s : set)
        if (const std::string table = s.substr(0, s.find_first_of(".[=")); std::ranges::count(kOfTheCase, table))
          t.fail("set", fmt::format("'{}': {} is the case's own; a column is a blow and its flight", s, table));
      check_kept(t, set, file.overrides());
      set.insert(set.end(), file.overrides().begin(), file.overrides().end());
      CaseFile other(file, set);
      compared_.push_back(read_side(other.root()));
      compared_.back().name = name;
      if (matched_) compared_.back().file = std::make_shared<CaseFile>(file, set);
      for (const std::string_view key : kOfTheCase) other.root().leave({key});
      try {
        other.finish();
      } catch (const InputError& e) {  // the case's own models may know the key
        throw InputError(fmt::format("{} (by the column '{}' of [[compare]])", e.what(), name));
      }
      if (!compared_.back().missing.empty()) missing_ = compared_.back().missing;
    }
  }

  void run(Output& out) override {
    if (!missing_.empty()) return out.skip(missing_);
    const bool fe = std::ranges::any_of(own_.models, [](const Entry& e) { return e.fe() != nullptr; });
    if (fe && !own_.yields() && models::wants_yielding_face(own_.blow.club.head)) out.say(rigid_face_costs());
    const std::string off = off_the_face(own_.blow, own_.outline());
    if (!off.empty()) out.warn(off);
    if (own_.flight) own_.flight->show_in(out);
    for (Side& side : compared_) {
      if (side.flight) side.flight->show_in(out);
      if (const std::string text = off_the_face(side.blow, side.outline()); !text.empty() && text != off)
        out.warn(fmt::format("{}: {}", side.name, text));
    }
    for (Side& side : compared_) choose_sets(side);
    choose_sets(own_);
    nlohmann::json summary;
    std::vector<post::LaunchColumn> columns;
    std::vector<fs::path> files;
    std::vector<FeRun> runs;
    for (const Side& side : compared_) compare(out, side, columns, summary["compared"][side.name]);
    const std::size_t compared = columns.size();
    Blow blow = own_.blow;  // of the last model
    for (const Entry& entry : own_.models) {
      blow = at_measured_launch(entry, entry.blow.value_or(own_.blow));
      nlohmann::json& said = summary["models"][entry.name];
      if (const models::Impact* model = entry.fe()) {
        const models::FeOutcome outcome = run_fe(out, entry.name, *model, blow, home(out, entry), files, runs);
        models::check_launch(*model, blow, outcome.launch);
        columns.push_back({entry.name, outcome.launch});
        said = post::to_json(outcome.launch);
        said["solution"] = solution(out, entry.name, blow, outcome);
        if (entry.companion) {
          columns.back().coarser = models::checked_launch(*entry.companion, blow);
          nlohmann::json& error = said["numerical_error"];
          error = numerical_error(outcome.launch, *columns.back().coarser);
          if (error.at("ball_speed_mps") > 0.02 * outcome.launch.ball_speed())
            out.warn(fmt::format("{}: the ball speed moves by more than 2 % with the numerics: a finer accuracy",
                                 entry.name));
        }
      } else {
        columns.push_back({entry.name, models::checked_launch(*entry.model, blow)});
        said = post::to_json(columns.back().launch);
      }
      note_oblique(blow, columns.back(), said);
      if (matched_) note_match(out, columns.back(), blow, said);
      doubt_use(out, own_, entry, blow);
    }
    for (std::size_t c = compared; own_.flight && c < columns.size(); ++c) {
      std::string why, coarser;
      columns[c].flight = landed(*own_.flight, columns[c].launch, own_.blow.ball, why);
      if (!columns[c].flight) out.warn(fmt::format("{}: {}", columns[c].title, why));
      if (columns[c].coarser)
        columns[c].coarser_flight = landed(*own_.flight, *columns[c].coarser, own_.blow.ball, coarser);
    }
    for (const post::MeasuredValue& m : measured_)
      summary["measured"][fmt::format("{}_{}", m.channel->name, m.channel->unit)] = m.value / m.channel->si;
    const post::TextTable table = post::launch_table(columns, measured_, ranges_, out.units());
    const ImpactStory story{
        blow, columns, measured_, table, runs, matched_, own_.yields(), own_.flight.has_value(), record_.vtk};
    show_shaft(out, story);
    for (const post::LaunchColumn& c : columns) {
      if (!c.flight) continue;
      nlohmann::json& said = summary["flights"][c.title] = post::to_json(*c.flight);
      if (c.coarser_flight) said["numerical_error"] = numerical_error(*c.flight, *c.coarser_flight);
      const Side* other = side_of_column(std::size_t(&c - columns.data()));
      if (&c != &columns.back())  // the last one's doubts are told with its budget
        for (const std::string& text :
             {outside_law(other ? *other->flight : *own_.flight, *c.flight), c.flight->no_run})
          if (!text.empty()) out.warn(fmt::format("{}: {}", c.title, text));
      // Where the errors of the answer's carry come from; the other columns have theirs in the summary.
      if (&c == &columns.back()) try {
          said["budget"] = report_flight(out, *own_.flight, c.title, c.launch, own_.blow.ball);
        } catch (const std::invalid_argument& e) { out.warn(fmt::format("{}: {}", c.title, e.what())); }
    }
    for (const fs::path& f : files) out.say(fmt::format("ParaView: {}", f.string()));
    out.say(table.text());
    if (matched_) {
      std::string lofts;
      for (const auto& c : columns)
        lofts += fmt::format("{}{} {:.2f}", lofts.empty() ? "" : ", ", c.title, *c.loft_deg);
      out.say(fmt::format("dynamic loft that gives the measured launch angle [deg]: {}", lofts));
    }
    for (const std::string& sentence : post::outside(columns.back(), measured_, ranges_)) out.say(sentence);
    if (const std::string sentence = shaft_sentence(story, out.units()); !sentence.empty()) out.say(sentence);
    show_impact(out, story);
    out.write_summary(summary);
    for (const Entry& entry : own_.models)  // only now: a disk too full for the summary must not cost the run
      if (entry.fe()) post::remove_file(home(out, entry) / "checkpoint.cbor");
  }

 private:
  struct Entry {
    std::string name;
    std::unique_ptr<models::ImpactModel> model;
    std::unique_ptr<models::ImpactModel> companion = nullptr;  ///< the same on coarser numerics
    std::string set = {};           ///< of the ball's parameters that the matched loft chooses; empty: the case's
    std::optional<Blow> blow = {};  ///< with that set
    const models::Impact* fe() const { return model->impact(); }
  };
  /// The case itself, or one that it is compared with.
  struct Side {
    std::string name;  ///< empty: the case itself
    bool swung = false;
    fs::path missing;  ///< a recorded swing that is not there: the side has no models
    Blow blow;
    models::FeImpactOptions fe;
    std::vector<Entry> models;
    std::optional<FlightSetup> flight;
    std::shared_ptr<CaseFile> file = {};  ///< of a side whose loft is sought
    std::optional<LoftSets> sets = {};    ///< of the ball, where the loft chooses one of several
    std::shared_ptr<const models::PlateOnDemand> plate = {};
    bool yields() const { return fe.face || blow.club.head.compliance; }
    const mesh::PlateOutline* outline() const { return plate ? &plate->design().outline : nullptr; }
  };

  /// Overrides of the whole case come after those of a column, which would no longer differ as its name says.
  static void check_kept(const Table& column, const std::vector<std::string>& own,
                         const std::vector<std::string>& all) {
    for (const std::string& s : own)
      for (const std::string& other : all)
        if (const std::string lost = replaced(other, s); !lost.empty())
          column.fail("set", fmt::format("'{}' is also set for every column ({}): this one would not differ by it; "
                                         "`--set compare=[]` leaves the columns out",
                                         lost, key_of(other)));
  }

  static Side read_side(Table root) {
    Side side;
    const std::vector<std::string> names = read_models(root);
    side.blow = read_blow(root, names);
    check_shaft(root, side.blow, names);
    models::Options options = read_options(root, names, side.blow);
    side.flight = read_optional_flight(root);
    side.sets = sets_by_loft(root);
    if (const auto swung = read_swung_club(root, names, options.shaft_mount)) {
      side.swung = true;
      if (!swung->motion.present) {
        side.missing = swung->motion.file;
      } else {
        swung->begin(swung->swing(side.blow.club), side.blow, options.shaft_mount);
        check_use(root, use_of(side.blow), names);
      }
    }
    side.fe = options.fe;
    side.plate = options.plate;
    for (const std::string& name : names) side.models.push_back({name, models::find(name)->make(options)});
    // A coarser companion costs a seventh of a run at the default accuracy, and every number gets its error.
    if (std::ranges::none_of(side.models, [](const Entry& e) { return e.fe() != nullptr; })) return side;
    const auto coarser = options.fe.coarser();
    root.decided_by("accuracy");
    if (!root.flag({"error_estimate", "run a coarser companion too: every number of a launch gets its numerical error"},
                   coarser.has_value() && root.has("accuracy")))
      return side;
    if (!coarser)
      root.fail("error_estimate",
                "the numerics are as coarse as they can be: accuracy = \"default\" has a coarser companion");
    models::Options companion = options;
    companion.fe = *coarser;
    for (Entry& e : side.models)
      if (e.fe()) e.companion = models::find(e.name)->make(companion);
    return side;
  }

  void read_measured(Table measured) {
    auto uncertainty = measured.optional_table("uncertainty");
    auto explained = measured.optional_table("explained");
    for (const std::string& key : measured.keys()) {
      if (key == "uncertainty" || key == "explained") continue;
      if (post::Range* range = key == "tangential_restitution" ? &ranges_.tangential_restitution
                               : key == "launch_ratio"         ? &ranges_.launch_ratio
                                                               : nullptr) {
        const auto ends = measured.numbers({key, "lowest and highest that was measured"}, 2);
        if (ends[0] > ends[1]) measured.fail(key, "give the lowest and the highest that was measured");
        *range = std::pair{ends[0], ends[1]};
        if (explained && explained->has(key))
          (key == "launch_ratio" ? ranges_.launch_ratio_explained : ranges_.tangential_restitution_explained) =
              explained->text({key, "why the model may lie outside the range", "<launch quantity>"});
        continue;
      }
      const std::string stem = split_unit(key).stem;
      const post::Channel* channel = post::find_channel(stem);
      if (!channel)
        measured.fail(key, fmt::format("no launch quantity of this name (known: {})", post::channel_names()));
      const std::string unit(channel->unit);
      measured_.push_back(
          {channel, measured.quantity({stem, "what was measured of this blow", "<launch quantity>"}, unit)});
      if (uncertainty && uncertainty->has_quantity(stem))
        measured_.back().uncertainty = uncertainty->quantity(
            {stem, "standard deviation of the comparison: the instrument and what the delivery is known to",
             "<launch quantity>"},
            unit, Range::positive());
      if (explained && explained->has(stem))
        measured_.back().explained =
            explained->text({stem, "why the model may lie outside the uncertainty", "<launch quantity>"});
    }
  }

  /// The blow as the model is asked about it: with the loft that gives the launch angle, where the loft is not known.
  /// Finite elements look for it on their coarser numerics and correct it by one blow of their own.
  Blow at_measured_launch(const Entry& entry, const Blow& blow) const {
    if (!matched_) return blow;
    const bool coarse = entry.fe() && entry.companion;
    Blow found =
        models::match_launch_angle(coarse ? *entry.companion : *entry.model, blow, *launch_angle(), radians(0.03)).blow;
    if (coarse)
      found.delivery.dynamic_loft += (*launch_angle() - entry.model->launch(found).launch_angle()) /
                                     models::kLaunchPerLoft;
    return found;
  }

  /// Of a ball of several sets, each model takes the one that its own matched loft chooses, wherever the search begins.
  void choose_sets(Side& side) const {
    if (!matched_ || !side.sets) return;
    std::map<std::string, Side> of_set;
    for (std::size_t k = 0; k < side.models.size(); ++k) {
      Entry& entry = side.models[k];
      if (!side.sets->matter_to(entry.name)) continue;
      const auto with = [&](const std::string& set) -> Side& {
        const auto [at, fresh] = of_set.try_emplace(set);
        if (fresh) at->second = read_side(CaseFile(*side.file, with_set(side.file->overrides(), set)).root());
        return at->second;
      };
      entry.set = consistent_set(
          *side.sets, [&](const std::string& set) { return at_measured_launch(with(set).models[k], with(set).blow); });
      Side& chosen = with(entry.set);
      entry.model = std::move(chosen.models[k].model);
      entry.companion = std::move(chosen.models[k].companion);
      entry.blow = chosen.blow;
    }
  }

  /// A matched loft may lie where what is used was never seen.
  void doubt_use(Output& out, const Side& side, const Entry& entry, const Blow& blow) const {
    if (!matched_) return;
    std::vector<std::string> set = side.file->overrides();
    if (!entry.set.empty()) set.push_back(fmt::format("ball.reduced=\"{}\"", entry.set));
    if (const std::string text = used_beyond(*side.file, set, blow, entry.name); !text.empty())
      out.warn(fmt::format("{}{}{}, at the loft of {:.2f} deg that was found: {}", side.name,
                           side.name.empty() ? "" : ": ", entry.name, degrees(blow.delivery.dynamic_loft), text));
  }

  void note_match(Output& out, post::LaunchColumn& column, const Blow& blow, nlohmann::json& said) const {
    column.loft_deg = degrees(blow.delivery.dynamic_loft);
    said["dynamic_loft_deg"] = *column.loft_deg;
    if (const double off = degrees(column.launch.launch_angle() - *launch_angle()); std::abs(off) > 0.1)
      out.warn(fmt::format("{}: the launch angle is {:+.2f} deg off the one that it was to match", column.title, off));
  }

  /// A launch is an answer too where its ball does not reach the landing; `why` is then the reason.
  static std::optional<post::ShotFlight> landed(const FlightSetup& flight, const Launch& launch, const Ball& ball,
                                                std::string& why) {
    try {
      return flight.follow(launch, ball);
    } catch (const std::invalid_argument& e) {
      why = e.what();
      return {};
    }
  }

  /// Of what the case is compared with; nullptr of the case itself.
  const Side* side_of_column(std::size_t column) const {
    for (const Side& side : compared_) {
      if (column < side.models.size()) return &side;
      column -= side.models.size();
    }
    return nullptr;
  }

  /// Columns without records: the same models, another ball, face, friction.
  void compare(Output& out, const Side& side, std::vector<post::LaunchColumn>& columns, nlohmann::json& said) const {
    const std::size_t first = columns.size(), count = side.models.size();
    columns.resize(first + count);
    std::vector<Blow> blows(count);
    std::vector<std::string> why(count);
    for_all(std::size_t{0}, count, [&](std::size_t k) {
      const Entry& entry = side.models[k];
      blows[k] = at_measured_launch(entry, entry.blow.value_or(side.blow));
      columns[first + k] = {fmt::format("{}: {}", side.name, entry.name),
                            models::checked_launch(*entry.model, blows[k])};
      if (side.flight)
        columns[first + k].flight = landed(*side.flight, columns[first + k].launch, side.blow.ball, why[k]);
    });
    for (std::size_t k = 0; k < count; ++k) {
      if (!why[k].empty()) out.warn(fmt::format("{}: {}", columns[first + k].title, why[k]));
      nlohmann::json& one = said[side.models[k].name] = post::to_json(columns[first + k].launch);
      doubt_use(out, side, side.models[k], blows[k]);
      note_oblique(blows[k], columns[first + k], one);
      if (matched_) columns[first + k].loft_deg = one["dynamic_loft_deg"] = degrees(blows[k].delivery.dynamic_loft);
    }
  }

  /// What a driver-like head loses by a rigid face, along the normal.
  std::string rigid_face_costs() const {
    const models::Striker ball = models::golf_ball(own_.blow.ball);
    const double mass =
        models::mass_at(own_.blow.club.head, -own_.blow.delivery.impact_toe, own_.blow.delivery.impact_high);
    const FaceCompliance face = find_face("modern-driver")->face;
    const double shape = face.shape(-own_.blow.delivery.impact_toe, own_.blow.delivery.impact_high).value;
    const double speed = first_contact(own_.blow).closing_speed();
    const double gain = (1 + models::strike(ball, mass, face, shape, speed).restitution) /
                            (1 + models::strike(ball, mass, {}, 0, speed).restitution) -
                        1;
    return fmt::format(
        "the face of this driver-like head is rigid: a modern one, [face] name = \"modern-driver\", would give the "
        "ball "
        "some {:.1f} % more speed here",
        100 * gain);
  }

  /// Where an FE model's files go: OUT itself, or OUT/<model> where several models share it.
  fs::path home(const Output& out, const Entry& entry) const {
    const auto several = std::ranges::count_if(own_.models, [](const Entry& e) { return e.fe() != nullptr; }) > 1;
    return several ? out.directory() / entry.name : out.directory();
  }

  models::FeOutcome run_fe(Output& out, const std::string& name, const models::Impact& model, const Blow& blow,
                           const fs::path& home, std::vector<fs::path>& files, std::vector<FeRun>& runs) const {
    if (out.force()) post::remove_file(home / "checkpoint.cbor");
    post::ImpactRecorder recorder(home, blow, record_,
                                  fmt::format("{}\n{}\n{}", name, program_version(), out.fingerprint()));
    if (const models::ImpactCheckpoint* from = recorder.resume())
      out.tell(fmt::format("{}: goes on from t = {:.3f} ms, where an earlier run was stopped", name,
                           1e3 * from->solver.state.time));
    Progress progress = out.progress(name);
    const StopSignals stop;
    post::ShaftLoads carried;
    const models::FeOutcome outcome = model.run(
        blow,
        [&](const models::ImpactView& view) {
          recorder(view);
          if (own_.swung && view.shaft) carried.add(view.state.time, *view.shaft, view.state);
          stop.check();
          progress.update(
              std::min(0.99, view.state.time / view.bodies.contact_time),
              fmt::format("t = {:.3f} ms, force {:.1f} kN", 1e3 * view.state.time, 1e-3 * view.report.normal_force));
        },
        recorder.resume());
    progress.finish(fmt::format("{} steps", outcome.result.counts.steps));
    for (const fs::path& f : recorder.files()) files.push_back(f);
    if (std::vector<post::Panel> along = carried.panels(1e-3); !along.empty()) {
      post::write_file(home / "shaft.csv", carried.table());
      out.draw({.panels = std::move(along), .columns = 3},
               fs::relative(home / "shaft", out.directory()).lexically_normal().string());
    }
    runs.push_back({name, home, outcome.result});
    runs.back().section = recorder.at_largest_force();
    runs.back().moving = recorder.moving();
    if (record_.vtk) runs.back().patch = post::read_patch(home / "vtk", outcome.frame.ball_axes, outcome.mesh_axes);
    return outcome;
  }

  std::optional<double> launch_angle() const {
    const post::MeasuredValue* m = post::find(measured_, post::find_channel("launch_angle"));
    return m ? std::optional(m->value) : std::nullopt;
  }

  static void note_oblique(const Blow& blow, post::LaunchColumn& column, nlohmann::json& said) {
    column.oblique = {models::tangential_restitution(blow, column.launch), models::launch_ratio(blow, column.launch)};
    if (column.oblique.tangential_restitution) said["tangential_restitution"] = *column.oblique.tangential_restitution;
    if (column.oblique.launch_ratio) said["launch_ratio"] = *column.oblique.launch_ratio;
  }

  static nlohmann::json numerical_error(const post::ShotFlight& flight, const post::ShotFlight& coarser) {
    nlohmann::json j;
    for (const post::FlightChannel& c : post::flight_channels(flight.unit)) {
      const auto x = c.value(flight), y = c.value(coarser);
      if (x && y) j[fmt::format("{}_{}", c.name, c.unit)] = std::abs(*x - *y) / c.si;
    }
    return j;
  }
  /// By how much the launch moves against the coarser companion: a bound of what is left where both converge.
  static nlohmann::json numerical_error(const Launch& launch, const Launch& coarser) {
    nlohmann::json j;
    for (const post::Channel& c : post::channels())
      j[fmt::format("{}_{}", c.name, c.unit)] =
          std::abs(post::difference(c, (launch.*c.value)() / c.si, (coarser.*c.value)() / c.si));
    return j;
  }

  /// What the solution was and how well its energy adds up: for the person and the summary.
  nlohmann::json solution(Output& out, const std::string& name, const Blow& blow,
                          const models::FeOutcome& outcome) const {
    const models::FeImpactResult& r = outcome.result;
    const double closure = r.ledger.closure / r.ledger.initial;
    for (const SolutionDoubt& d : solution_doubts(blow, outcome)) out.warn(fmt::format("{}: {}", name, d.sentence()));
    // Pressure alone turns no sphere; but the ball is flattened, and a face that turns or dishes carries the flat
    // round.
    if (const double spin = outcome.launch.spin.norm(); own_.blow.contact.patch.coefficient == 0 && spin > 1)
      out.warn(
          fmt::format("{}: without friction the ball leaves with {:.1f} rad/s ({:.0f} rpm): the face turns or dishes "
                      "under the flattened ball; \"look\" is off by as much (docs/limits.md)",
                      name, spin, rpm(spin)));
    out.say(fmt::format(
        "{}: contact {:.4f} ms, peak force {:.3f} kN, compression {:.2f} mm, penetration {:.1f} um, "
        "energy closes to {:.1e} of the initial",
        name, 1e3 * r.contact_time, 1e-3 * r.peak_force, 1e3 * r.compression, 1e6 * r.penetration, closure));
    nlohmann::json j = {{"contact_time_ms", 1e3 * r.contact_time},
                        {"peak_force_N", r.peak_force},
                        {"peak_time_ms", 1e3 * r.peak_time},
                        {"compression_mm", 1e3 * r.compression},
                        {"closure_of_relative_energy", r.ledger.closure / relative_energy(blow, outcome)},
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
    if (own_.yields()) {
      j["face_travel_mm"] = 1e3 * r.face_travel;
      j["face_energy_J"] = r.face_energy;
    }
    j["energy_J"] = {
        {"initial", r.ledger.initial},     {"kinetic", r.ledger.kinetic},   {"strain", r.ledger.strain_total()},
        {"contact", r.ledger.contact},     {"friction", r.ledger.friction}, {"viscous", r.ledger.viscous},
        {"numerical", r.ledger.numerical}, {"external", r.ledger.external}, {"closure", r.ledger.closure}};
    return j;
  }

  Side own_;
  std::vector<Side> compared_;
  fs::path missing_;
  post::RecorderOptions record_;
  post::Measured measured_;
  post::MeasuredOblique ranges_;
  bool matched_ = false;
};

}  // namespace

std::unique_ptr<Job> read_impact(CaseFile& file) { return std::make_unique<ImpactJob>(file); }

}  // namespace hosel::app
