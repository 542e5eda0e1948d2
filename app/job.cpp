#include "app/job.hpp"

#include <fmt/format.h>

#include <array>

#include "app/kinds/kinds.hpp"

namespace hosel::app {
namespace {

/// Of a shaft where the case has one, else of a ball.
std::unique_ptr<Job> read_either_modes(CaseFile& file) {
  return file.root().has("shaft") ? read_shaft_modes(file) : read_modes(file);
}

constexpr std::array kKinds = {
    Kind{"impact", "one blow through one or several models, with the measured launch beside",
         "What does the ball do after this blow?", read_impact},
    Kind{"flight-law", "a law of drag, lift and spin decay from followed flights, judged on players left out",
         "What are drag and lift of a ball in flight, and does that hold for players that were not seen?",
         read_flight_law},
    Kind{"landing-times", "launches at several sites with the time of their landing, and what the air makes of it",
         "Does the air's density carry what the sites differ by?", read_landing_times},
    Kind{"tune", "parameters of a model against measured shots",
         "Which parameters make the model agree with the shots, and on shots it has not seen?", read_tune},
    Kind{"study", "a design of blows (axes, sample, variants, rows, places) through models or another case",
         "How does the answer change with these inputs, and what matters most?", read_study},
    Kind{"loop", "measured shots against a model: which effect does the model lack?",
         "Which effect does the model lack?", read_loop},
    Kind{"modes", "free vibrations of a ball, harmonic by harmonic, or of a shaft with its head",
         "How does the body ring?", read_either_modes},
    Kind{"swing", "a flexible club driven by the motion of the grip, up to impact",
         "What does the shaft do on the way to the ball, and how does the head arrive?", read_swing},
    Kind{"identify-shaft", "stiffness scale and damping of a shaft from measured swings",
         "How stiff is the shaft, and how much does it damp?", read_identify_shaft},
    Kind{"material-point", "one material along a strain path: stress, work, dissipation",
         "What does this material do along a path of strain?", read_material_point},
    Kind{"calibrate-ball", "a ball's material from its normal impacts on a wall",
         "Which material makes the ball bounce as measured?", read_calibrate_ball},
    Kind{"calibrate-reduced", "parameters of the reduced models from what the finite-element ball does",
         "What do the models without a deformable ball need of this ball?", read_calibrate_reduced},
    Kind{"plate-face", "a face with a thickness: modes, characteristic time and restitution over it, balls, stress",
         "What does a face of this thickness do?", read_plate_face},
    Kind{"calibrate-face", "a face that yields from characteristic times, restitution and mass",
         "Which face behaves as measured?", read_calibrate_face},
};

/// Kinds that were: what their cases say now.
struct FormerKind {
  std::string_view name, now;
};
constexpr std::array kFormerKinds = {
    FormerKind{"face-map",
               "[[variants]] is [[variant]], reference is [compare], [[statements]] is [[statement]] with one formula, "
               "[refinement] is a study of this one with finer numerics as a [[variant]]"},
    FormerKind{"sweep", "[[parameters]] is [[axis]], record is outputs, sweep.csv is points.csv"},
    FormerKind{"variants", "[[variants]] is [[variant]], outputs names the quantities, variants.csv is points.csv"},
    FormerKind{"clubs", "each club is a row of [rows] or a [[variant]], beside and model are models"},
    FormerKind{"restitution-face", "[grid] is two [[axis]], face_restitution is one of the outputs"},
    FormerKind{"bounce", "the plate is a head of mass inf, the angle its club_path, balls are variants"},
    FormerKind{"curves", "[family] and [x] are an [[axis]] each, channels is outputs, history is histories"},
    FormerKind{"loaded-club",
               "[motion] stands for the delivery, each club is a [[variant]] with grip.start and grip.hold, [points] "
               "are an [[axis]], a difference is a [[part]]; kind = \"impact\" follows one such blow"},
    FormerKind{"loaded-face-map",
               "[motion] stands for the delivery, [[swings]] are [rows], each club is a [[variant]] with grip.start "
               "and grip.hold, parts are [[part]] over the rows, [[statements]] is [[statement]] with one formula, "
               "[refinement] and [[assumptions]] are variants of a study of this one"},
    FormerKind{"characteristic-time",
               "[line] is two [[axis]] over effective_mass and stiffness of [face], the tap is the outputs "
               "characteristic_time, pendulum_slope and restitution_off_rules_line at the place of the blow"},
    FormerKind{
        "ball-rule",
        "a test is a [[solve]] whose `set` states [launch], [[player]] are [rows], a way to change the ball is a "
        "[[variant]], a loss is a [[part]]"},
    FormerKind{"slopes",
               "[step] is four [[variant]] and two [[part]], [data] is [regression], heads are [rows] with parts_from"},
    FormerKind{"flight",
               "without models [launch] is the whole launch, each [[launch]] is a [[variant]] that sets it, measured "
               "stands in the variant, outputs names the quantities"},
    FormerKind{"cross-check", "[[grid]] is [[axis]], reference is [compare], outputs names the quantities"},
};

}  // namespace

std::span<const Kind> kinds() { return kKinds; }

std::unique_ptr<Job> read_job(CaseFile& file) {
  Table root = file.root();
  root.text({"title", "of tables, pages and figures"}, "");
  if (root.has("kind"))
    for (const FormerKind& f : kFormerKinds)
      if (root.text({"kind", "what the case does (`hosel list`)"}, "impact") == f.name)
        root.fail("kind", fmt::format("'{}' is now 'study': {} (docs/how-to.md)", f.name, f.now));
  const std::string wanted = root.choice({"kind", "what the case does (`hosel list`)"}, names_in(kKinds), "impact");
  for (const Kind& k : kKinds)
    if (k.name == wanted) {
      auto job = k.read(file);
      file.finish();
      return job;
    }
  return nullptr;
}

}  // namespace hosel::app
