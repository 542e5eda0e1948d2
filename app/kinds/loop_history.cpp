#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include "app/kinds/loop_common.hpp"
#include "app/read_blow.hpp"
#include "app/read_markers.hpp"
#include "app/read_series.hpp"
#include "app/read_shaft.hpp"
#include "app/read_swing.hpp"
#include "loop/history/swing_history.hpp"

namespace hosel::app {
namespace {

constexpr std::size_t kMostSamples = 8000;  ///< of a bench record; a swing takes as long whatever its samples

class HistoryJob final : public Job {
 public:
  explicit HistoryJob(CaseFile& file) {
    Table root = file.root();
    read_loop_case(root, case_, [](const loop::EffectEntry& e) { return e.on_tests != nullptr; });
    club_.shaft = read_shaft(root.table("shaft"));
    loop::HistorySetting& setting = case_.setting;
    if (auto head = root.optional_table("head")) {
      club_.head = read_head(*head);
      setting.head = true;
    }
    club_.geometry = read_club_geometry(root, false);
    setting.swing = root.has("motion") || root.has("markers");
    if (setting.swing && !setting.head) root.fail("head", "a swing needs a head");
    if (auto grip = root.optional_table("grip");
        grip && grip->choice({"hold", "of the butt"}, {"clamped", "free"}, "clamped") == "free")
      grip->fail("hold", "the records of a free shaft are not modelled: clamp the butt");
    if (auto split = root.optional_table("split"); split && split->has_quantity("holdout")) {
      const auto span =
          split->quantities({"holdout", "first and last instant of every record that no fit sees"}, "s", 2);
      if (!(span[0] < span[1])) split->fail("holdout_s", "the first instant comes before the last");
      case_.split.span = {span[0], span[1]};
    }
    root.has("markers") ? read_marker_test(root) : setting.swing ? read_swing_test(root) : read_bench_test(root);
  }

  void run(Output& out) override {
    if (!skipped_.empty()) return out.skip(skipped_);
    const loop::LoopResult result = run_loop(out, case_);
    report_loop(out, result, loop::as_shots(case_), "readings");
  }

 private:
  /// `[data]`: the records, the same channels in each; noise by header.
  std::vector<models::BenchRecord> read_records(Table root, double clamp, std::size_t most) {
    Table data = root.table("data");
    const std::vector<std::filesystem::path> files = data.data_files({"series", "CSV of a record, or a list of them"});
    std::optional<Table> sensors = root.optional_table("sensors");
    std::vector<models::BenchRecord> drives;
    std::vector<loop::HistoryChannel>& channels = case_.setting.channels;
    for (const auto& f : files) {
      if (!std::filesystem::exists(f)) {
        skipped_ = f;
        break;
      }
      Series s = read_series(f, sensors ? &*sensors : nullptr, club_.shaft->length(), clamp, most, case_.notes);
      if (channels.empty()) {
        channels = s.channels;
      } else {
        const auto same = [](const loop::HistoryChannel& a, const loop::HistoryChannel& b) { return a.name == b.name; };
        if (!std::ranges::equal(channels, s.channels, same))
          throw InputError(fmt::format("{}:1: other channels than in {}", f.string(), files.front().string()));
        for (std::size_t k = 0; k < channels.size(); ++k)
          channels[k].resolution = std::max(channels[k].resolution, s.channels[k].resolution);
      }
      case_.records.push_back(std::move(s.record));
      drives.push_back(std::move(s.drive));
    }
    if (sensors && !skipped_.empty())
      for (const std::string& key : sensors->keys()) {
        Table place = sensors->table({key, "", "<channel>"});
        place.quantity({"arc_length", "of the sensor from the butt"}, "mm", Range::non_negative(), 0);
        if (place.has("axis")) place.choice({"axis", "bending that the strain gauge feels"}, {"lead", "droop"});
        if (place.has_quantity("radius")) read_gauge_radius(place);
      }
    read_noise(data);
    return drives;
  }

  void read_noise(Table& table) {
    auto noise = table.optional_table("noise");
    if (!noise) return;
    std::vector<loop::HistoryChannel>& channels = case_.setting.channels;
    for (const std::string& key : noise->keys()) {
      const double sigma = noise->number({key, "standard deviation of the channel", "<channel>"}, Range::positive());
      const auto it = std::ranges::find(channels, key, &loop::HistoryChannel::name);
      if (it != channels.end()) {
        it->declared = sigma;
      } else if (skipped_.empty()) {
        noise->fail(key, "no measured channel of this name");
      }
    }
  }

  void read_bench_test(Table root) {
    models::BenchOptions options;
    models::BenchStart start;
    std::vector<double> rates{0};
    if (auto t = root.optional_table("bench")) {
      options.clamped_length =
          t->quantity({"clamped_length", "of the butt that the clamp holds"}, "mm", Range::non_negative(), 0);
      if (options.clamped_length >= club_.shaft->length())
        t->fail("clamped_length_mm", "the clamp holds the whole shaft");
      options.elements = int(t->integer({"elements", "finite elements along the free shaft"}, 2, 60, options.elements));
      options.shear = t->flag({"shear", "Timoshenko (true) or shear-rigid (false)"}, true);
      const std::string hang =
          t->choice({"shaft", "how gravity acts along the shaft"}, {"horizontal", "hanging", "standing"}, "horizontal");
      if (hang != "horizontal") options.gravity = Vec3(0, 0, hang == "hanging" ? -kGravity : kGravity);
      using models::Start;
      start.kind = t->one_of<Start>({"start", "how the vibration begins"},
                                    {{"unknown", Start::unknown},
                                     {"release", Start::release},
                                     {"impulse", Start::impulse},
                                     {"rest", Start::rest}},
                                    "unknown");
      if (start.kind == Start::release) {
        start.force = t->vector({"load", "force that held the hosel before its release"}, "N", Vec3::Zero());
        start.moment = t->vector({"load_moment", "moment that held the hosel before its release"}, "N_m", Vec3::Zero());
        if (start.force.norm() + start.moment.norm() == 0)
          t->fail("load_N", "a release needs the load that held the hosel");
      }
      if (start.kind == Start::impulse) {
        const auto j = t->numbers({"impulse_N_s", "given to the hosel"}, 3);
        start.force = Vec3(j[0], j[1], j[2]);
      }
      if (start.kind == Start::release || start.kind == Start::impulse)
        start.at = t->quantity({"at", "instant of release or impulse in the records"}, "s", Range::finite(), 0);
      rates = t->quantities({"rotation_rate", "of the bench, one or one for each record"}, "rpm", 0, Range::finite(),
                            std::vector<double>{0});
      if (t->has("rotation_axis"))
        options.rotation_axis =
            t->choice({"rotation_axis", "of the bench"}, {"lead", "droop"}) == "lead" ? Vec3::UnitX() : Vec3::UnitY();
      options.hub =
          t->quantity({"hub", "distance from the axis of rotation to the clamp"}, "mm", Range::non_negative(), 0);
    }
    std::vector<models::BenchRecord> records = read_records(root, options.clamped_length, kMostSamples);
    if (!skipped_.empty()) return;
    if (rates.size() != 1 && rates.size() != records.size())
      root.table("bench").fail("rotation_rate", "one rate for all records, or one for each");
    loop::HistorySetting& setting = case_.setting;
    for (std::size_t k = 0; k < records.size(); ++k) {
      records[k].rotation_rate = rates[rates.size() == 1 ? 0 : k];
      setting.turning = setting.turning || records[k].rotation_rate != 0;
    }
    try {
      auto bench = std::make_unique<loop::BenchHistory>(club_, setting.head, options, start, std::move(records),
                                                        setting.channels);
      std::tie(setting.frequency, setting.ratio) = bench->first_mode();
      model_ = std::move(bench);
    } catch (const std::invalid_argument& e) { root.fail("", e.what()); }
    setting.driven = start.kind != models::Start::unknown;
    const double free = club_.shaft->length() - options.clamped_length;
    setting.compliance = free / club_.shaft->at(options.clamped_length + 0.5 * free).bending_stiffness_y;
    case_.model = model_.get();
  }

  void read_swing_test(Table root) {
    Table table = root.table("motion");
    const MotionInput motion = read_motion(table);
    const models::SwingOptions options = read_swing_options(root);
    std::vector<models::BenchRecord> records = read_records(root, 0, kMostSamples);
    if (!motion.present) skipped_ = motion.file;
    if (!skipped_.empty()) return;
    for (const loop::HistoryChannel& c : case_.setting.channels)
      if (c.reading == loop::Reading::strain_lead || c.reading == loop::Reading::strain_droop || c.order > 0)
        throw InputError(
            fmt::format("{}:1: channel '{}': of a swing, lead, droop, shortening and twist of the hosel are known",
                        case_.records.front().name, c.name));
    std::vector<std::vector<double>> times;
    for (const auto& r : records) {
      if (r.times.front() < motion.begin - 1e-9 || r.times.back() > motion.end + 1e-9)
        throw InputError(fmt::format("{}: the record reaches beyond the motion ({:g} to {:g} s)",
                                     case_.records[times.size()].name, motion.begin, motion.end));
      times.push_back(r.times);
    }
    use_swing(options, models::GripMotion(motion.track, motion.smoothing), motion.begin, std::move(times));
  }

  /// Lead and droop of the hosel as the markers on the head show them, the markers on the shaft driving.
  void read_marker_test(Table root) {
    Table table = root.table("markers");
    const MarkerInput in = read_markers(table);
    const auto span = table.quantities({"span", "first and last instant whose deflection is a reading"}, "s", 2);
    models::SwingOptions options = read_swing_options(root);
    std::vector<loop::HistoryChannel>& channels = case_.setting.channels;
    for (const auto& [name, reading] :
         {std::pair{"lead_mm", loop::Reading::lead}, {"droop_mm", loop::Reading::droop}}) {
      loop::HistoryChannel c;
      c.name = name;
      c.si = 1e-3;
      c.reading = reading;
      channels.push_back(c);
    }
    if (auto data = root.optional_table("data")) read_noise(*data);
    if (!std::filesystem::exists(in.file)) {
      skipped_ = in.file;
      return;
    }
    const models::MarkerSwing swing = read_marker_swing(in, span[1]);
    options.grip_point = club_.shaft->length() - swing.length;
    loop::HistoryRecord record{.name = in.file.filename().string(), .times = {}, .measured = {}, .train = {}};
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < swing.times.size(); ++i)
      if (swing.times[i] >= span[0] && swing.times[i] <= span[1]) rows.push_back(i);
    record.measured.resize(Eigen::Index(rows.size()), 2);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      record.times.push_back(swing.times[rows[k]]);
      record.measured.row(Eigen::Index(k)) << 1e3 * swing.lead[rows[k]], 1e3 * swing.droop[rows[k]];
    }
    if (rows.empty()) table.fail("span_s", "no head markers in it");
    models::GripMotion motion(swing.clamp, in.smoothing);
    const double begin = motion.first();
    std::vector<std::vector<double>> times{record.times};
    case_.records.push_back(std::move(record));
    use_swing(options, std::move(motion), begin, std::move(times));
  }

  void use_swing(const models::SwingOptions& options, models::GripMotion motion, double begin,
                 std::vector<std::vector<double>> times) {
    auto swing = std::make_unique<loop::SwingHistory>(club_, options, std::move(motion), begin, std::move(times),
                                                      case_.setting.channels);
    loop::HistorySetting& setting = case_.setting;
    setting.driven = true;
    std::tie(setting.frequency, setting.ratio) = swing->first_mode();
    const double free = club_.shaft->length() - options.grip_point;
    setting.compliance = free / club_.shaft->at(options.grip_point + 0.5 * free).bending_stiffness_y;
    model_ = std::move(swing);
    case_.model = model_.get();
  }

  Club club_;
  loop::HistoryCase case_;
  std::unique_ptr<loop::HistoryModel> model_;
  std::filesystem::path skipped_;
};

}  // namespace

std::unique_ptr<Job> read_loop_history(CaseFile& file) { return std::make_unique<HistoryJob>(file); }

}  // namespace hosel::app
