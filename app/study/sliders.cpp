#include "app/study/sliders.hpp"

#include <nlohmann/json.hpp>

#include "post/labels.hpp"

namespace hosel::app {
namespace {

using nlohmann::json;

json list(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

/// "ball speed [mph], volumetric": the words, and the unit alone.
std::pair<std::string, std::string> without_unit(std::string spoken) {
  const auto open = spoken.find(" ["), close = spoken.find(']', open);
  if (close == spoken.npos) return {spoken, ""};
  const std::string unit = spoken.substr(open + 2, close - open - 2);
  return {spoken.erase(open, close + 1 - open), unit == "-" ? "" : unit};
}

}  // namespace

json sliders(const StudyTable& table, const StudyEffects& effects) {
  json answers = json::array();
  const StudyEmulator* any = nullptr;
  for (std::size_t s = 0; s < effects.emulators.size(); ++s) {
    if (!effects.emulators[s]) continue;
    any = &*effects.emulators[s];
    const solvers::Kriging::Parts parts = any->parts();
    const auto [low, middle, high] = table.series[s].spread();
    const auto [words, unit] = without_unit(table.series[s].spoken);
    json points = json::array();
    for (const auto& point : parts.points.colwise()) points.push_back(list(point));
    answers.push_back({{"label", words},
                       {"unit", unit},
                       {"error", any->error()},
                       {"nugget", parts.nugget},
                       {"process", parts.process(0, 0)},
                       {"low", low},
                       {"high", high},
                       {"length", list(parts.length)},
                       {"plane", list(parts.plane.col(0))},
                       {"weight", list(parts.weight.col(0))},
                       {"points", std::move(points)}});
  }
  if (!any) return {};
  json parameters = json::array();
  const auto names = table.design.columns();
  for (std::size_t c = 0; c < names.size(); ++c) {
    const StudyEmulator::Scale scale = any->scale(c);
    const auto [words, unit] = without_unit(post::label(names[c]));
    parameters.push_back({{"label", words},
                          {"unit", unit},
                          {"centre", scale.centre},
                          {"half", scale.half},
                          {"low", scale.centre - scale.half},
                          {"high", scale.centre + scale.half}});
  }
  return {{"parameters", std::move(parameters)}, {"answers", std::move(answers)}};
}

}  // namespace hosel::app
