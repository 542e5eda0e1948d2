/// Launch conditions as people and files read them: names, units, tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golf/launch.hpp"
#include "post/flight_table.hpp"
#include "post/text_table.hpp"

namespace hosel::post {

/// In which speeds and distances are shown: m/s and m, or mph and yards.
enum class Units { metric, golf };

/// One launch quantity in the unit in which it is shown.
struct Channel {
  std::string_view name;  ///< as in files, without unit
  std::string_view unit;  ///< suffix
  double si;              ///< one of the unit in SI
  double (Launch::*value)() const;
  int decimals;
};
std::span<const Channel> channels();
const Channel* find_channel(std::string_view name);  ///< nullptr where unknown
std::string channel_names();                         ///< for messages
/// a minus b, both in the channel's unit; of angles the shorter way round, in -180 to 180 deg.
double difference(const Channel& channel, double a, double b);

/// One measured quantity of a launch.
struct MeasuredValue {
  const Channel* channel;
  double value;                ///< SI
  double uncertainty = 0;      ///< one standard deviation, SI; 0: not stated
  std::string explained = {};  ///< why a model may lie outside it
};
using Measured = std::vector<MeasuredValue>;
/// nullptr where it was not measured.
const MeasuredValue* find(const Measured& measured, const Channel* channel);

/// What a blow says beside its launch; absent where it says nothing (models/oblique.hpp).
struct Oblique {
  std::optional<double> tangential_restitution, launch_ratio;
};
struct LaunchColumn {
  std::string title;
  Launch launch;
  Oblique oblique = {};
  std::optional<ShotFlight> flight = {};
  std::optional<double> loft_deg = {};            ///< at which it stands, where that was looked for
  std::optional<Launch> coarser = {};             ///< the same on coarser numerics: shown as the error of each quantity
  std::optional<ShotFlight> coarser_flight = {};  ///< from there
};
/// Ranges that others measured on such blows: lowest and highest.
using Range = std::optional<std::pair<double, double>>;
struct MeasuredOblique {
  Range tangential_restitution, launch_ratio;
  std::string tangential_restitution_explained, launch_ratio_explained;  ///< why a model may lie outside
};
/// A row per quantity, a column per model, the measurement last where there is one, and where its uncertainty is stated
/// by how many of its standard deviations the last model is off; then the flights, where the columns have them.
TextTable launch_table(const std::vector<LaunchColumn>& columns, const Measured& measured = {},
                       const MeasuredOblique& ranges = {}, Units units = Units::metric);
/// Sentences about the quantities in which a launch is more than two standard deviations off the measurement, or
/// outside the range that others measured.
std::vector<std::string> outside(const LaunchColumn& column, const Measured& measured, const MeasuredOblique& ranges);
/// {"ball_speed_mps": ..., ...}, all channels and the head after the blow.
nlohmann::json to_json(const Launch& launch);

}  // namespace hosel::post
