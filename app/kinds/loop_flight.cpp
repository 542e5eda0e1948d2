#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "app/implausible.hpp"
#include "app/kinds/loop_common.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_paths.hpp"
#include "app/read_sheet.hpp"
#include "loop/flights/problem.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

bool acts_on_flights(const loop::EffectEntry& e) {
  return e.on_shots && std::ranges::any_of(e.on_shots({.flies = true, .no_blow = true}),
                                           [](const auto& f) { return !f.before && !f.after && (f.seen || f.flight); });
}

constexpr std::array kAxes = {"along_m", "right_m", "up_m"};

class LoopFlightJob final : public Job {
 public:
  explicit LoopFlightJob(CaseFile& file) {
    Table root = file.root();
    read_loop_case(root, case_, acts_on_flights);
    case_.ball = read_optional_ball(root);
    Table flight = root.default_table("flight");
    if (flight.has("turf")) flight.fail("turf", "the loop compares flights, which end at the first landing");
    case_.conditions = read_conditions(flight);
    if (root.has("paths")) {
      if (root.has("data")) root.fail("data", "the flights are those of [paths]: leave out one of the two");
      read_radar(root);
    } else {
      read_shots(root);
    }
    if (auto split = root.optional_table("split"))
      case_.split.by = read_split_by(*split, skipped_.empty() ? &case_.shots : nullptr);
  }

  void run(Output& out) override {
    if (!skipped_.empty()) return out.skip(skipped_);
    if (const std::string repeated = repeated_rows(case_.shots); !repeated.empty()) out.lack(repeated);
    for (const std::string& note : case_.notes) out.say(note);
    const loop::LoopResult result = run_loop(out, case_);
    report_loop(out, result, case_.shots, "flights");
    for (const std::string& note : result.notes)
      if (note.starts_with("wind")) out.log(note);
  }

 private:
  /// Of [data.paths].
  struct Position {
    std::size_t line;
    double time;
    std::array<double, 3> x;
  };
  using Paths = std::map<std::string, std::vector<Position>>;  // by shot, by rising time

  void read_unknown(Table t) {
    loop::FlightUnknowns& u = case_.unknown;
    u.axis = t.quantity({"spin_axis", "standard deviation of a spin's tilt that is not recorded"}, "deg", {0, kPi / 2},
                        radians(8));
    if (t.has_quantity("spin_rate")) {
      u.spin_rate = t.quantity({"spin_rate", "usual spin where none is recorded"}, "rpm", Range::positive());
      u.spin_rate_sd = t.number({"spin_rate_sd", "its relative standard deviation"}, {0, 1}, 0.2);
    }
    u.drag = t.number({"drag", "relative standard deviation of a ball's drag about the law's"}, {0, 1}, 0.0);
    u.lift = t.number({"lift", "the same of its lift"}, {0, 1}, 0.0);
    u.gust = t.quantity({"gust", "standard deviation of a shot's wind about its group's, each direction"}, "mps",
                        {0, 20}, 0.0);
    u.wind = t.quantity({"wind", "standard deviation of a group's wind about the declared one, each direction"}, "mps",
                        {0, 20}, 0.0);
    u.slope = t.quantity({"slope", "standard deviation of the ground's slope where a group's shots land"}, "deg",
                         {0, radians(20)}, 0.0);
  }

  void read_shots(Table& root) {
    read_unknown(root.default_table("unknown"));
    Table data = root.table("data");
    const auto path = data.data_file({"shots", "CSV of the launches and what was measured of their flights"});
    case_.group_by = data.texts({"group_by", "columns whose values together name a group with a wind of its own"},
                                std::vector<std::string>{});
    std::filesystem::path points;
    if (data.has("paths")) {
      points = data.data_file({"paths", "CSV of positions: shot, time_s, along_m, right_m, up_m from the launch"});
      case_.position_noise =
          data.quantity({"position_noise", "standard deviation of a position, each axis"}, "m", Range::positive());
    }
    if (!std::filesystem::exists(path)) skipped_ = path;
    if (skipped_.empty()) try {
        const post::Sheet sheet = post::read_csv(path);
        const Paths paths = points.empty() ? Paths{} : read_positions(points);
        case_.shots = loop::read_shots(sheet, true, cells_of_paths(paths));
        if (!points.empty()) place_positions(paths, points, loop::ids_of(sheet));
        for (const std::string& rows : implausible_rows(case_.shots)) data.doubt(rows);
      } catch (const DataError& e) { throw InputError(e.what()); }
    for (const std::string& name : case_.group_by)
      if (skipped_.empty() && !case_.shots.find(name))
        data.fail("group_by", fmt::format("no column '{}' in the shots", name));
    if (auto noise = data.optional_table("noise"))
      case_.noise =
          read_noise(*noise, skipped_.empty() ? &case_.shots : nullptr, loop::Role::output, "launch or flight");
  }

  /// Every instant that some shot has is a channel for each axis.
  Paths read_positions(const std::filesystem::path& file) {
    const post::Sheet sheet = read_sheet(file);
    const auto& ids = cells_of(sheet, "shot");
    const std::vector<double> time = column_with_gaps(sheet, "time_s");
    std::vector<double> instants;
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (!(time[i] > 0))
        throw InputError(fmt::format("{}:{}: time_s: times are positive", sheet.file, sheet.lines[i]));
      if (std::ranges::find(instants, time[i]) == instants.end()) instants.push_back(time[i]);
    }
    constexpr std::size_t most = 40;
    if (instants.size() > most)
      throw InputError(fmt::format("{}: {} different times; all paths are read at the same ones, at most {}",
                                   sheet.file, instants.size(), most));
    std::ranges::sort(instants);
    for (const double t : instants)
      for (int axis = 0; axis < 3; ++axis) case_.points.push_back({axis, t});
    std::array<std::vector<double>, 3> x;
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] = column_with_gaps(sheet, kAxes[axis]);
    Paths paths;
    for (std::size_t i = 0; i < ids.size(); ++i)
      paths[ids[i]].push_back({sheet.lines[i], time[i], {x[0][i], x[1][i], x[2][i]}});
    for (auto& [id, path] : paths) std::ranges::stable_sort(path, {}, &Position::time);
    return paths;
  }

  /// By value: two files may write one number in two ways.
  static std::map<std::string, std::vector<std::string>> cells_of_paths(const Paths& paths) {
    std::map<std::string, std::vector<std::string>> cells;
    for (const auto& [id, path] : paths)
      for (const Position& p : path)
        for (const double value : {p.time, p.x[0], p.x[1], p.x[2]}) cells[id].push_back(fmt::format("{}", value));
    return cells;
  }

  /// `ids`: of all rows of the shots' file, copies too.
  void place_positions(const Paths& paths, const std::filesystem::path& file, const std::vector<std::string>& ids) {
    const loop::Shots& shots = case_.shots;
    case_.positions = Eigen::MatrixXd::Constant(Eigen::Index(shots.rows()), Eigen::Index(case_.points.size()),
                                                std::numeric_limits<double>::quiet_NaN());
    std::size_t of_copies = 0;
    for (const auto& [id, path] : paths) {
      const auto fail = [&](const Position& p, const std::string& why) {
        throw InputError(fmt::format("{}:{}: {}", file.string(), p.line, why));
      };
      const auto count = std::ranges::count(shots.id, id);
      if (count > 1)
        fail(path.front(), fmt::format("shot '{}' stands {} times in {}: number them anew", id, count, shots.file));
      if (count == 0 && !std::ranges::count(ids, id))
        fail(path.front(), fmt::format("no shot '{}' in {}", id, shots.file));
      for (std::size_t k = 1; k < path.size(); ++k)
        if (path[k].time == path[k - 1].time)
          fail(path[k], fmt::format("shot '{}' has a position at {:g} s already", id, path[k].time));
      if (count == 0) {
        of_copies += path.size();
        continue;
      }
      const auto row = std::ranges::find(shots.id, id) - shots.id.begin();
      for (const Position& p : path)
        for (Eigen::Index c = 0; c < case_.positions.cols(); ++c)
          if (const loop::PathPoint& at = case_.points[std::size_t(c)]; at.time == p.time)
            case_.positions(row, c) = p.x[std::size_t(at.axis)];
    }
    if (of_copies > 0)
      case_.notes.push_back(
          fmt::format("{} of shots that repeat an earlier one: not used", post::counted(of_copies, "position")));
  }

  void read_radar(Table& root) {
    Table table = root.table("paths");
    const std::string what =
        table.choice({"channels", "of the loop: where each flight ends, or its path"}, {"ends", "path"}, "ends");
    const double every =
        table.quantity({"every", "interval of the positions that are channels of a path"}, "s", {0.25, 5}, 1.0);
    const RadarPaths data = read_paths(table, case_.ball);
    std::map<std::string, double> noise;
    if (what == "ends") {
      const auto sd = [&](const char* key, const char* of, std::string_view unit, const char* column, double si) {
        noise[column] = table.quantity({key, of}, unit, Range::positive()) / si;
      };
      sd("carry_noise", "of the radar's carry", "m", "carry_m", 1);
      sd("side_noise", "of the radar's side", "m", "side_m", 1);
      sd("apex_noise", "of the radar's apex", "m", "apex_m", 1);
      sd("time_noise", "of the radar's time in the air", "s", "flight_time_s", 1);
    }
    if (!data.missing.empty()) {
      skipped_ = data.missing;
      return;
    }
    case_.notes = data.not_used();
    case_.noise = std::move(noise);
    case_.group_by = {"group"};
    case_.unknown.wind = data.model.wind_sd;
    post::Sheet sheet{
        .file = "radar",
        .names = {"shot", "player", "group", "ball_speed_mps", "launch_angle_deg", "azimuth_deg", "spin_rate_rpm"},
        .columns = {},
        .lines = {}};
    if (what == "ends") sheet.names.insert(sheet.names.end(), {"carry_m", "side_m", "apex_m", "flight_time_s"});
    sheet.columns.resize(sheet.names.size());
    for (const RadarFlight& f : data.flights) {
      const Launch& l = f.path.launch;
      const auto text = [](double x) { return fmt::format("{:.10g}", x); };
      std::vector<std::string> cells = {f.path.id,
                                        f.player,
                                        f.group,
                                        text(l.ball_speed()),
                                        text(degrees(l.launch_angle())),
                                        text(degrees(l.azimuth())),
                                        text(l.spin_rate() / kRadPerSecPerRpm)};
      if (what == "ends")
        for (const double x : {f.carry, f.side, f.apex, f.time}) cells.push_back(text(x));
      for (std::size_t c = 0; c < cells.size(); ++c) sheet.columns[c].push_back(cells[c]);
      sheet.lines.push_back(f.line);
    }
    case_.shots = loop::read_shots(sheet, true);
    std::vector<const models::MeasuredPath*> flights;  // of the rows that are left: copies are not
    loop::Column& group = *case_.shots.find("group");  // a name even where it is written as a number
    group.numeric = false;
    group.value.clear();
    group.text.clear();
    for (const std::size_t line : case_.shots.line) {
      const RadarFlight& f = *std::ranges::find(data.flights, line, &RadarFlight::line);
      flights.push_back(&f.path);
      group.text.push_back(f.group);
      case_.air.push_back(f.path.air);
      case_.deviations.push_back(f.path.sd);
    }
    if (what == "ends") return;
    case_.position_noise = data.model.noise;
    std::vector<double> instants;
    const auto seen = [&](double t) {
      return std::ranges::any_of(data.flights, [&](const RadarFlight& f) {
        return std::ranges::any_of(f.path.times, [&](double at) { return std::abs(at - t) < 1e-6; });
      });
    };
    for (double t = every; t <= 8; t += every)
      if (seen(t)) instants.push_back(t);
    for (const double t : instants)
      for (int axis = 0; axis < 3; ++axis) case_.points.push_back({axis, t});
    case_.positions = Eigen::MatrixXd::Constant(Eigen::Index(flights.size()), Eigen::Index(case_.points.size()),
                                                std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < flights.size(); ++i) {
      const models::MeasuredPath& p = *flights[i];
      for (std::size_t k = 0; k < p.times.size(); ++k)
        for (std::size_t j = 0; j < instants.size(); ++j)
          if (std::abs(p.times[k] - instants[j]) < 1e-6) {
            const Vec3& x = p.positions[k];
            case_.positions.row(Eigen::Index(i)).segment<3>(3 * Eigen::Index(j)) << x.x(), -x.y(), x.z();
          }
    }
  }

  loop::FlightCase case_;
  std::filesystem::path skipped_;
};

}  // namespace

std::unique_ptr<Job> read_loop_flight(CaseFile& file) { return std::make_unique<LoopFlightJob>(file); }

}  // namespace hosel::app
