#include "hosel/app/kinds/loop.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "hosel/app/kinds/loop_common.hpp"
#include "hosel/app/kinds/loop_history.hpp"
#include "hosel/app/read_blow.hpp"
#include "hosel/app/read_options.hpp"
#include "hosel/app/read_shaft.hpp"
#include "hosel/loop/shots/run.hpp"
#include "hosel/loop/shots/spread.hpp"
#include "hosel/models/registry.hpp"
#include "hosel/models/response_surface.hpp"

namespace hosel::app {
namespace {

std::map<std::string, double> read_noise(Table table, const loop::Shots& shots, loop::Role role,
                                         std::string_view what) {
  std::map<std::string, double> noise;
  for (const std::string& key : table.keys()) {
    const loop::Column* column = shots.find(key);
    if (!column || column->role != role) {
      std::vector<std::string> known;
      for (const auto& c : shots.columns)
        if (c.role == role) known.push_back(c.name);
      const std::string near = nearest(key, known);
      table.fail(key, fmt::format("no {} column of this name{}", what,
                                  near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
    }
    noise[key] = table.number({key, "standard deviation of the column", "<column>"}, Range::non_negative());
  }
  return noise;
}

class LoopJob final : public Job {
 public:
  explicit LoopJob(CaseFile& file) {
    Table root = file.root();
    read_loop_case(root, case_, [](const loop::EffectEntry& e) { return e.on_shots != nullptr; });
    Table model = root.table("model");
    std::vector<std::string> names;
    for (const auto& m : models::registry()) names.emplace_back(m.name);
    model.choice({"base", "the model whose missing effect is sought"}, names);
    model_ = models::find(case_.base)->make(read_options(root, {case_.base}));
    case_.model = model_.get();
    case_.direct = case_.base == "rigid-planar" || case_.base == "rigid-eccentric";
    if (auto surface = model.optional_table("surrogate")) {
      if (case_.direct) surface->fail("", "this base answers in microseconds and needs no surrogate");
      points_ = int(surface->integer({"points", "blows through which the surrogate goes"}, 8, 100000, 80));
      surface_seed_ =
          static_cast<unsigned long>(surface->integer({"seed", "of the surrogate's blows"}, 0, 1L << 53, 1));
    }
    case_.head_turns = case_.base != "rigid-planar";

    case_.blow.ball = root.has("ball") ? read_ball(root.table("ball")) : Ball{};
    if (auto contact = root.optional_table("contact")) case_.blow.contact = read_contact_law(*contact);
    if (auto shaft = root.optional_table("shaft")) case_.blow.club.shaft = read_shaft(*shaft);
    if (auto hosel = root.optional_table("hosel")) case_.blow.club.geometry = read_club_geometry(*hosel);
    Head& head = case_.blow.club.head;
    if (auto table = root.optional_table("head")) {
      case_.head_mass_declared = table->has_quantity("mass");
      head = read_loop_head(*table, case_.head_turns);
    } else if (case_.head_turns) {
      root.fail("", "a table [head] with mass, cg_mm and inertia_kg_m2 is needed for this base");
    } else {
      head.inertia = std::numeric_limits<double>::infinity() * Mat3::Identity();
    }
    case_.inertia_declared = head.inertia.allFinite();

    Table data = root.table("data");
    const auto path = data.data_file({"shots", "CSV of the measured shots"});
    if (!std::filesystem::exists(path)) skipped_ = path;
    if (skipped_.empty()) {
      try {
        case_.shots = loop::read_shots(post::read_csv(path));
        if (auto joined = data.optional_table("join")) {
          const auto other = joined->data_file({"file", "CSV with further columns"});
          const std::string by = joined->text({"by", "column that both files have"});
          loop::join(case_.shots, post::read_csv(other), by);
        }
      } catch (const DataError& e) { throw InputError(e.what()); }
      if (auto noise = data.optional_table("noise"))
        case_.noise = read_noise(*noise, case_.shots, loop::Role::output, "output");
      if (auto noise = data.optional_table("input_noise"))
        case_.input_noise = read_noise(*noise, case_.shots, loop::Role::input, "input");
    } else {
      if (auto joined = data.optional_table("join")) {
        joined->data_file({"file", "CSV with further columns"});
        joined->text({"by", "column that both files have"});
      }
      for (const char* key : {"noise", "input_noise"})
        if (auto noise = data.optional_table(key))
          for (const std::string& header : noise->keys())
            noise->number({header, "standard deviation of the column", "<column>"}, Range::non_negative());
    }

    if (auto split = root.optional_table("split")) {
      case_.split.by = split->text({"by", "column whose values stay together in training or holdout"}, "");
      case_.split.leave_one_out = split->choice({"mode", "a held-out share, or each cluster left out in turn"},
                                                {"holdout", "leave-one-out"}, "holdout") == "leave-one-out";
      if (case_.split.leave_one_out && case_.split.by.empty()) split->fail("mode", "leave-one-out needs by = a column");
      if (!case_.split.by.empty() && skipped_.empty() && !case_.shots.find(case_.split.by))
        split->fail("by", fmt::format("no column '{}' in the shots", case_.split.by));
    }
  }

  void run(Output& out) override {
    if (!skipped_.empty()) return out.skip(skipped_);
    loop::LoopResult result;
    try {
      if (points_ > 0) build_surrogate(out);
      result = loop::run(case_);
    } catch (const DataError& e) { throw InputError(e.what()); }
    report_loop(out, result, case_.shots, "rows");
  }

 private:
  /// `[head]` of a loop: the mass may stand in the shots instead; cg and inertia are needed where the head turns.
  Head read_loop_head(Table table, bool turns) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    Head head;
    head.mass = case_.head_mass_declared ? table.quantity({"mass", "of the clubhead"}, "kg", Range::positive()) : 0.2;
    head.face.bulge = table.quantity({"bulge", "radius of the face's curvature from heel to toe; inf is flat"}, "mm",
                                     {0.01, inf}, inf);
    head.face.roll =
        table.quantity({"roll", "radius of the face's curvature up the face; inf is flat"}, "mm", {0.01, inf}, inf);
    if (!turns && !table.has_quantity("inertia")) {
      head.cg = table.vector({"cg", "centre of gravity in the face frame"}, "mm", Vec3::Zero());
      head.inertia = inf * Mat3::Identity();
      return head;
    }
    head.cg = table.vector({"cg", "centre of gravity in the face frame"}, "mm");
    head.inertia = table.matrix({"inertia", "inertia tensor about the centre of gravity, face frame"}, "kg_m2");
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

  /// The base behind a response surface over the recorded inputs, its error beside the channels' names.
  void build_surrogate(Output& out) {
    const std::vector<Delivery> deliveries = loop::spread(case_.shots, points_, surface_seed_);
    std::unique_ptr<models::ResponseSurface> surface;
    try {
      surface = std::make_unique<models::ResponseSurface>(*model_, case_.blow, deliveries);
    } catch (const std::invalid_argument& e) {
      throw InputError(fmt::format("{}: surrogate of {}: {}", case_.shots.file, case_.base, e.what()));
    }
    std::string errors;
    for (const loop::Column& c : case_.shots.columns) {
      if (c.role != loop::Role::output) continue;
      const std::optional<hosel::Output> output = output_of(c.stem);
      if (!output) continue;
      double square = 0;
      for (std::size_t i = 0; i < deliveries.size(); ++i) {
        const double e = (get(surface->predicted()[i], *output) - get(surface->answers()[i], *output)) / c.si;
        square += e * e / double(deliveries.size());
      }
      errors += fmt::format("{}{} {:.3g}", errors.empty() ? "" : ", ", c.name, std::sqrt(square));
    }
    case_.notes.push_back(
        fmt::format("{} stands behind a response surface of degree {} through {} of its answers; error of each answer "
                    "predicted from the others: {}",
                    case_.base, surface->degree(), deliveries.size(), errors));
    out.say(case_.notes.back());
    model_ = std::move(surface);
    case_.model = model_.get();
    case_.direct = true;
  }

  loop::ShotCase case_;
  std::unique_ptr<models::ImpactModel> model_;
  std::filesystem::path skipped_;
  int points_ = 0;  ///< of the surrogate; 0: none
  unsigned long surface_seed_ = 1;
};

}  // namespace

std::unique_ptr<Job> read_loop(CaseFile& file) {
  if (file.root().table("model").text({"base", "the model whose missing effect is sought"}) == "shaft")
    return read_loop_history(file);
  return std::make_unique<LoopJob>(file);
}

}  // namespace hosel::app
