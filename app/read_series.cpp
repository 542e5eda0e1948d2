#include "app/read_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "app/read_sheet.hpp"
#include "golf/units.hpp"

namespace hosel::app {
namespace {

/// Numbers of a column; NaN where empty, and where the cell is not a finite number.
std::vector<double> values(const post::Sheet& sheet, std::size_t c, bool gaps) {
  std::vector<double> out;
  for (std::size_t r = 0; r < sheet.rows(); ++r) {
    double x = number_in(sheet, c, r);
    if (!std::isfinite(x)) {
      if (!gaps)
        throw InputError(fmt::format("{}:{}: {} may have no empty cell", sheet.file, sheet.lines[r], sheet.names[c]));
      x = kNaN;
    }
    out.push_back(x);
  }
  return out;
}

/// The step of the last digit that is written.
double recording_step(const std::vector<std::string>& cells) {
  int most = 0;
  for (const std::string& cell : cells) {
    if (cell.find_first_of("eE") != std::string::npos) return 0;
    const auto dot = cell.find('.');
    most = std::max(most, dot == std::string::npos ? 0 : int(cell.size() - dot - 1));
  }
  return std::pow(10.0, -most);
}

struct Meaning {
  loop::Reading reading;
  int order;
  double si;
};

/// Units of strain, in m/m.
constexpr std::array<std::pair<std::string_view, double>, 4> kStrains = {
    {{"_um_per_m", 1e-6}, {"_ustrain", 1e-6}, {"_mm_per_m", 1e-3}, {"_pct", 1e-2}}};

/// What a column's name says; nothing where it is no channel. Throws std::invalid_argument where a strain has a unit
/// that is not known.
std::optional<Meaning> meaning(const std::string& name) {
  using loop::Reading;
  const SplitName split = split_unit(name);
  if (name.starts_with("strain")) {
    const auto unit = std::ranges::find_if(kStrains, [&](const auto& u) { return name.ends_with(u.first); });
    if (unit == kStrains.end() && name != "strain" && name != "strain_lead" && name != "strain_droop")
      throw std::invalid_argument(
          fmt::format("column '{}' ends with no unit of strain: _um_per_m, _ustrain, _mm_per_m or _pct; `strain`, "
                      "`strain_lead` and `strain_droop` alone are in m/m",
                      name));
    const bool droop = name.find("droop") != std::string::npos;
    return Meaning{droop ? Reading::strain_droop : Reading::strain_lead, 0, unit == kStrains.end() ? 1 : unit->second};
  }
  if (!split.unit) return {};
  const auto is = [&](std::string_view stem) {
    return split.stem == stem || split.stem.starts_with(std::string(stem) + "_");
  };
  const bool turn = is("twist");
  const Reading reading = turn               ? Reading::twist
                          : is("droop")      ? Reading::droop
                          : is("shortening") ? Reading::shortening
                                             : Reading::lead;
  if (!turn && !is("lead") && !is("droop") && !is("shortening")) return {};
  const Dimension d = split.unit->dimension;
  if (d == (turn ? Dimension::angle : Dimension::length)) return Meaning{reading, 0, split.unit->si};
  if (d == (turn ? Dimension::angular_velocity : Dimension::speed)) return Meaning{reading, 1, split.unit->si};
  if (!turn && d == Dimension::acceleration) return Meaning{reading, 2, split.unit->si};
  return {};
}

}  // namespace

double read_gauge_radius(Table& place) {
  return place.quantity({"radius", "of the strain gauge from the shaft's axis; none: the shaft's outer radius"}, "mm",
                        {1e-3, 0.03});
}

Series read_series(const std::filesystem::path& file, Table* sensors, double tip, double clamp, std::size_t most,
                   std::vector<std::string>& notes) {
  const post::Sheet sheet = read_sheet(file);
  Series out;
  out.record.name = file.filename().string();
  std::vector<double> times;
  std::vector<std::vector<double>> measured;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::string& name = sheet.names[c];
    const SplitName split = split_unit(name);
    if (split.stem == "time" && split.unit && split.unit->dimension == Dimension::time) {
      times = values(sheet, c, false);
      for (double& t : times) t *= split.unit->si;
      continue;
    }
    const auto driven = [&](std::string_view stem, Dimension dimension, Eigen::MatrixXd& into) {
      static constexpr std::string_view axes[] = {"lead", "droop", "axial"};
      for (int a = 0; a < 3; ++a) {
        if (split.stem != fmt::format("{}_{}", stem, axes[a]) || !split.unit || split.unit->dimension != dimension)
          continue;
        const std::vector<double> x = values(sheet, c, false);
        if (into.size() == 0) into = Eigen::MatrixXd::Zero(std::ptrdiff_t(x.size()), 3);
        for (std::size_t i = 0; i < x.size(); ++i) into(std::ptrdiff_t(i), a) = x[i] * split.unit->si;
        return true;
      }
      return false;
    };
    if (driven("clamp", Dimension::acceleration, out.drive.acceleration) ||
        driven("force", Dimension::force, out.drive.force))
      continue;
    std::optional<Meaning> m;
    try {
      m = meaning(name);
    } catch (const std::invalid_argument& e) { throw InputError(fmt::format("{}:1: {}", sheet.file, e.what())); }
    if (!m) {
      notes.push_back(
          fmt::format("{}: column '{}' is no channel that the model knows, and is not used", out.record.name, name));
      continue;
    }
    loop::HistoryChannel channel{{.name = name, .si = m->si}, m->reading, m->order};
    const bool strain = m->reading == loop::Reading::strain_lead || m->reading == loop::Reading::strain_droop;
    channel.arc_length = strain ? clamp : tip;
    if (sensors && sensors->has(name)) {
      Table place = sensors->table({name, "", "<channel>"});
      place.decided_by("channel");
      channel.arc_length = place.quantity({"arc_length", "of the sensor from the butt"}, "mm", Range::non_negative(),
                                          channel.arc_length);
      if (strain) {
        channel.reading = place.choice({"axis", "bending that the strain gauge feels"}, {"lead", "droop"},
                                       m->reading == loop::Reading::strain_droop ? "droop" : "lead") == "droop"
                              ? loop::Reading::strain_droop
                              : loop::Reading::strain_lead;
        if (place.has_quantity("radius")) channel.radius = read_gauge_radius(place);
      }
      if (channel.arc_length < clamp || channel.arc_length > tip + 1e-9)
        place.fail("arc_length", "the sensor is not on the free shaft");
    }
    channel.resolution = recording_step(sheet.columns[c]);
    out.channels.push_back(channel);
    measured.push_back(values(sheet, c, true));
  }
  if (times.empty())
    throw InputError(
        fmt::format("{}:1: a column time_s (or another unit of time) is needed, with at least one row", sheet.file));
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      throw InputError(fmt::format("{}:{}: time does not go on", sheet.file, sheet.lines[i]));
  if (measured.empty())
    throw InputError(
        fmt::format("{}:1: no measured channel (lead_*, droop_*, shortening_*, twist_*, strain_*)", sheet.file));

  const std::size_t stride = (times.size() + most - 1) / most;
  if (stride > 1)
    notes.push_back(fmt::format("{}: every {}th of {} samples is used", out.record.name, stride, times.size()));
  const auto thin = [&](Eigen::MatrixXd& m) {
    if (stride <= 1 || m.size() == 0) return;
    Eigen::MatrixXd some(std::ptrdiff_t((times.size() + stride - 1) / stride), m.cols());
    for (std::ptrdiff_t i = 0; i < some.rows(); ++i) some.row(i) = m.row(i * std::ptrdiff_t(stride));
    m = some;
  };
  out.record.measured.resize(std::ptrdiff_t(times.size()), std::ptrdiff_t(measured.size()));
  for (std::size_t k = 0; k < measured.size(); ++k)
    out.record.measured.col(std::ptrdiff_t(k)) =
        Eigen::Map<const Eigen::VectorXd>(measured[k].data(), std::ptrdiff_t(times.size()));
  thin(out.record.measured);
  thin(out.drive.acceleration);
  thin(out.drive.force);
  for (std::size_t i = 0; i < times.size(); i += stride) out.record.times.push_back(times[i]);
  out.drive.times = out.record.times;
  return out;
}

}  // namespace hosel::app
