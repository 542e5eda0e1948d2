#include "app/kinds/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <tuple>

#include "app/implausible.hpp"
#include "app/kinds/loop_common.hpp"
#include "app/kinds/loop_corrected.hpp"
#include "app/kinds/loop_landings.hpp"
#include "app/kinds/loop_offer.hpp"
#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_shaft.hpp"
#include "loop/shots/run.hpp"
#include "models/fe/changeable_fe.hpp"
#include "models/registry.hpp"

namespace hosel::app {
namespace {

class LoopJob final : public Job {
 public:
  explicit LoopJob(CaseFile& file) {
    Table root = file.root();
    read_loop_case(root, case_, [](const loop::EffectEntry& e) { return e.on_shots != nullptr; });
    Table model = root.table("model");
    model.choice({"base", "the model whose missing effect is sought"}, names_in(models::registry()));
    const bool fe = case_.base.starts_with("fe-");
    std::optional<Shaft> shaft;
    if (auto table = root.optional_table("shaft")) shaft = read_shaft(*table);
    // A free head's shaft is what the loop may hang on it.
    Blow declared;
    const models::Options options = read_options(root, {fe && shaft ? "fe-full-club" : case_.base}, declared);
    if (fe) {
      read_fe_base(root, model.default_table("surrogate"), options, std::move(shaft));
    } else {
      if (model.has("surrogate"))
        model.fail("surrogate", "only a finite-element base stands behind one: the others answer at once");
      model_ = models::find(case_.base)->make(options);
      case_.model = model_.get();
      case_.direct = case_.base == "rigid-planar" || case_.base == "rigid-eccentric";
      case_.blow.club.shaft = std::move(shaft);
    }
    case_.head_turns = case_.base != "rigid-planar";

    case_.blow.ball = read_optional_ball(root);
    case_.blow.contact = read_contact(root, {case_.base});
    case_.blow.contact.patch = declared.contact.patch;
    if (fe) case_.blow.contact.friction = case_.blow.contact.patch.coefficient;
    case_.blow.club.geometry = read_club_geometry(root, root.has("shaft"));
    case_.hosel_declared = root.has("hosel");
    Head& head = case_.blow.club.head;
    if (auto table = root.optional_table("head")) {
      case_.hosel_declared = case_.hosel_declared || table->has("name");
      case_.head_mass_declared = table->has_quantity("mass") || table->has("name");
      head = read_loop_head(*table, case_.head_turns);
    } else if (case_.head_turns) {
      root.fail("", "a table [head] with mass, cg_mm and inertia_kg_m2 is needed for this base");
    } else {
      head.inertia = Vec3::Constant(std::numeric_limits<double>::infinity()).asDiagonal();
    }
    head.compliance = declared.club.head.compliance;
    words_ = head_words(root, head.compliance, options.plate != nullptr);
    case_.inertia_declared = head.inertia.allFinite();
    if (auto flight = root.optional_table("flight")) case_.flight = read_conditions(*flight);

    Table data = root.table("data");
    const std::vector<std::string> unknown =
        data.texts({"unknown", "inputs whose record is not used: dynamic_loft, found from each launch angle"},
                   std::vector<std::string>{});
    for (const std::string& name : unknown)
      if (name != "dynamic_loft") data.fail("unknown", "only dynamic_loft can be found from the launch: its angle");
    case_.loft_unknown = !unknown.empty();
    const auto path = data.data_file({"shots", "CSV of the measured shots"});
    if (data.has("landings")) {
      try {
        landings_ = loop::read_shots(
            post::read_csv(data.file({"landings",
                                      "CSV of launches, named as in the shots: a line for each club, and where "
                                      "its shots land"})));
      } catch (const DataError& e) { throw InputError(e.what()); }
    }
    mirrored_ =
        data.flag({"mirrored", "the shots are a left-handed player's, made those of a right-handed one"}, false);
    const std::string average_by = data.text(
        {"average_by", "column whose shots are compared as their mean, with their own scatter for noise"}, "");
    if (!average_by.empty() && data.has("noise"))
      data.fail("noise", "the noise of a mean is its shots' own scatter: leave out this table or average_by");
    case_.known = read_known(data, "known", {"effect", "of which another measurement tells something"});
    case_.varying = read_known(data, "varying", {"effect", "of which the rows that are compared differ"});
    if (!case_.varying.empty() && average_by.empty())
      data.fail("varying", "rows that share a club or a player differ alike: compare them as means (average_by)");
    std::optional<std::pair<std::filesystem::path, std::string>> joined;
    if (auto table = data.optional_table("join")) {
      joined.emplace(table->data_file({"file", "CSV with further columns"}), "");
      joined->second = table->text({"by", "column that both files have"});
    }
    if (!std::filesystem::exists(path)) skipped_ = path;
    if (skipped_.empty()) try {
        case_.shots = loop::read_shots(post::read_csv(path), case_.flight.has_value());
        if (joined) loop::join(case_.shots, post::read_csv(joined->first), joined->second);
        repeated_ = repeated_rows(case_.shots);
        if (case_.shots.rows() <= loop::kMostShots)  // else it is refused
          for (const std::string& rows : implausible_rows(case_.shots)) data.doubt(rows);
        if (!average_by.empty()) {
          auto [means, about] = loop::average(std::move(case_.shots), average_by);
          case_.shots = std::move(means);
          case_.averages = std::move(about);
        }
      } catch (const DataError& e) { throw InputError(e.what()); }
    const loop::Shots* shots = skipped_.empty() ? &case_.shots : nullptr;
    if (auto noise = data.optional_table("noise"))
      case_.noise = read_noise(*noise, shots, loop::Role::output, "output");
    if (auto noise = data.optional_table("input_noise"))
      case_.input_noise = read_noise(*noise, shots, loop::Role::input, "input");

    if (auto split = root.optional_table("split")) {
      case_.split.by = read_split_by(*split, shots);
      case_.split.leave_one_out = split->choice({"mode", "a held-out share, or each cluster left out in turn"},
                                                {"holdout", "leave-one-out"}, "holdout") == "leave-one-out";
      if (case_.split.leave_one_out && case_.split.by.empty()) split->fail("mode", "leave-one-out needs by = a column");
    }
    if (skipped_.empty()) check_use(root, use_of_shots(case_), {case_.base});
  }

  void run(Output& out) override {
    if (!skipped_.empty()) return out.skip(skipped_);
    if (!repeated_.empty()) out.lack(repeated_);
    const loop::LoopResult result = run_loop(out, case_);
    if (result.corrected) write_corrected(out, result, *fe_, case_.loft_unknown);
    withdraw_offers(out);
    offer_corrected(out, case_, result, fe_.get(), words_);
    report_loop(out, result, case_.shots, "rows", [&] {
      if (!landings_) return;
      // A mean is no shot of a file.
      const auto flagged = case_.averages ? std::set<std::size_t>{} : flagged_rows(result.flagged, *landings_);
      show_landings(out, *landings_, flagged, case_.blow.ball, case_.flight.value_or(models::FlightConditions{}),
                    mirrored_);
    });
  }

 private:
  /// `face` as the base reads it; one that it does not read is the named head's.
  static HeadWords head_words(Table root, const std::optional<FaceCompliance>& face, bool plate) {
    HeadWords words;
    if (auto head = root.optional_table("head"))
      if (const auto name = named_entry(*head, "name", Shelf::heads)) {
        const HeadEntry entry = library_head(*name);
        words.loft = entry.loft;
        if (!entry.face.empty()) words.face = entry.face;
      }
    if (plate) words.face.clear();
    if (!face) return words;
    if (auto own = root.optional_table("face"); own && own->has("name"))
      words.face = *named_entry(*own, "name", Shelf::faces);
    const auto same = [](const FaceCompliance& a, const FaceCompliance& b) {
      return std::tie(a.mass, a.stiffness, a.damping, a.half_width, a.half_height) ==
             std::tie(b.mass, b.stiffness, b.damping, b.half_width, b.half_height);
    };
    if (words.face == kRigidFace || !same(library_face(words.face).face, *face)) words.face.clear();
    return words;
  }

  /// `[head]` of a loop: the mass may stand in the shots instead; cg and inertia are needed where the head turns.
  Head read_loop_head(Table table, bool turns) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    std::optional<Head> named;
    if (const auto name = named_entry(table, "name", Shelf::heads)) named = library_head(*name).head;
    Head head;
    table.decided_by("head.name");
    head.mass = case_.head_mass_declared ? table.quantity({"mass", "of the clubhead"}, "kg", Range::positive(),
                                                          standard_of(named, &Head::mass))
                                         : 0.2;
    head.face.bulge = table.quantity({"bulge", "radius of the face's curvature from heel to toe; inf is flat"}, "mm",
                                     {0.01, inf}, named ? named->face.bulge : inf);
    head.face.roll = table.quantity({"roll", "radius of the face's curvature up the face; inf is flat"}, "mm",
                                    {0.01, inf}, named ? named->face.roll : inf);
    if (!turns && !named && !table.has_quantity("inertia")) {
      head.cg = table.vector({"cg", "centre of gravity in the face frame"}, "mm", Vec3::Zero());
      head.inertia = Vec3::Constant(inf).asDiagonal();
      return head;
    }
    head.cg = table.vector({"cg", "centre of gravity in the face frame"}, "mm", standard_of(named, &Head::cg));
    head.inertia = table.matrix({"inertia", "inertia tensor about the centre of gravity, face frame"}, "kg_m2",
                                standard_of(named, &Head::inertia));
    // A tensor that no body quite can have still gives an answer, and effects may be asked about it: said, not refused.
    const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Mat3>(head.inertia).eigenvalues();
    const auto faults = head.faults();
    if (!faults.empty())
      for (const std::string& key : table.keys())
        if (key.starts_with("inertia")) {
          if (!(principal[0] > 0) || !head.inertia.isApprox(head.inertia.transpose(), 1e-6))
            table.fail(key, faults.front());
          case_.notes.push_back(fmt::format("{}: {}", key, faults.front()));
        }
    return head;
  }

  /// A finite-element base: asked at the surrogate's accuracy where the effects are sought, at its own in the end.
  void read_fe_base(Table& root, Table surrogate, const models::Options& options, std::optional<Shaft> shaft) {
    const bool full = case_.base == "fe-full-club";
    if (full && !shaft) root.fail("shaft", "a full club needs a table [shaft]");
    case_.deformable = true;
    case_.full_club = full;
    case_.shaft_declared = shaft.has_value();
    models::FeImpactOptions coarse = options.fe;
    const std::string accuracy =
        surrogate.choice({"accuracy", "of the blows that the surrogate learns from; case: the case's own"},
                         {"look", "default", "reference", "case"}, "look");
    if (accuracy != "case") coarse.resolve(accuracy_named(accuracy));
    slow_.runs = int(surrogate.integer({"runs", "such blows; 0: as many as the effects need"}, 0, 100000, 0));
    slow_.fine_runs = int(surrogate.integer({"fine_runs", "blows at the case's own accuracy that correct it"}, 8,
                                            100000, slow_.fine_runs));
    slow_.checked = int(surrogate.integer({"checked", "held-out shots that the base itself is asked about, at most"}, 0,
                                          100000, slow_.checked));
    slow_.seed = static_cast<unsigned long>(surrogate.integer({"seed", "of the surrogate's blows"}, 0, 1L << 53, 1));
    fe_ = std::make_unique<models::ChangeableFe>(options.fe, options.shaft_mount, shaft, full);
    slow_.coarse = [base = models::ChangeableFe(coarse, options.shaft_mount, std::move(shaft), full)](
                       const loop::Shot& s) { return base.launch(s.blow, s.change); };
    const auto same = [](const models::FeImpactOptions& a, const models::FeImpactOptions& b) {
      return a.mesh.sector == b.mesh.sector && a.mesh.rings == b.mesh.rings && a.harmonics == b.harmonics &&
             a.antisymmetric == b.antisymmetric && a.steps_per_contact == b.steps_per_contact;
    };
    if (!same(coarse, options.fe)) slow_.fine = [this](const loop::Shot& s) { return fe_->launch(s.blow, s.change); };
    case_.slow = &slow_;
  }

  /// A table for every parameter of the effects that can act on this base.
  std::vector<loop::Known> read_known(Table data, const char* name, const Key& effect) {
    std::vector<hosel::Output> launch;
    for (int k = 0; k < kLaunchOutputs; ++k) launch.push_back(hosel::Output(k));
    const loop::Setting setting{.head_turns = true,
                                .inertia_declared = true,
                                .outputs = launch,
                                .flies = true,
                                .deformable = case_.deformable,
                                .shaft = case_.shaft_declared,
                                .full_club = case_.full_club};
    std::vector<loop::Known> all;
    for (Table table : data.tables(name)) {
      loop::Known known;
      known.effect = table.text(effect);
      const loop::EffectEntry* entry = loop::find_effect(known.effect);
      if (!entry || !entry->on_shots) table.fail("effect", fmt::format("no effect '{}' on shots", known.effect));
      std::map<std::string, std::string> units;
      for (const loop::Parametrisation& form : entry->on_shots(setting))
        for (const loop::Parameter& p : form.parameters) units[p.name] = p.unit;
      known.parameter = table.text({"parameter", "of the effect, zero where the case is right"});
      if (!units.contains(known.parameter)) {
        std::vector<std::string> names;
        for (const auto& [parameter, unit] : units) names.push_back(fmt::format("{} [{}]", parameter, unit));
        table.fail("parameter", fmt::format("{} has here: {}", known.effect, fmt::join(names, ", ")));
      }
      known.sd = table.number({"sd", "standard deviation, in the unit that reports print"}, Range::positive());
      known.source = table.text({"source", "the measurement, or whose judgement, that tells it"});
      all.push_back(std::move(known));
    }
    return all;
  }

  loop::ShotCase case_;
  std::unique_ptr<models::ImpactModel> model_;
  loop::SlowBase slow_;
  std::unique_ptr<models::ChangeableFe> fe_;  ///< of a finite-element base
  std::filesystem::path skipped_;
  std::optional<loop::Shots> landings_;
  bool mirrored_ = false;
  std::string repeated_;  // of the file's rows, not of their means
  HeadWords words_;
};

}  // namespace

std::unique_ptr<Job> read_loop(CaseFile& file) {
  const std::string base = file.root().table("model").text({"base", "the model whose missing effect is sought"});
  if (base == "shaft") return read_loop_history(file);
  if (base == "flight") return read_loop_flight(file);
  return std::make_unique<LoopJob>(file);
}

}  // namespace hosel::app
