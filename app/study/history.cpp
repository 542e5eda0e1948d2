#include "app/study/history.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/stored_launch.hpp"

namespace hosel::app {

nlohmann::json stored(const std::vector<ForceSample>& history) {
  nlohmann::json out = nlohmann::json::array();
  for (const ForceSample& s : history) out.push_back({s.time, s.normal, s.tangential});
  return out;
}

namespace {

/// hosel.csv: force and moment of the shaft on the head at every point.
void report_hosels(Output& out, const StudyTable& table, const std::vector<nlohmann::json>& points) {
  post::Table hosel = table.places().in_files({"time_ms"}, "{:.6f}");
  hosel.in_files({"force_x_N", "force_y_N", "force_z_N", "moment_x_N_m", "moment_y_N_m", "moment_z_N_m"}, "{:.6g}");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].contains("hosel")) continue;
    for (const nlohmann::json& row : points[i]["hosel"]["history"])
      hosel.add(i, table.model_of(i), table.design.cells(i / table.models.size()), 1e3 * row.at(0).get<double>(),
                vector_from(row.at(1)), vector_from(row.at(2)));
  }
  out.write("hosel.csv", hosel.csv());
}

}  // namespace

void report_histories(Output& out, const StudyTable& table, const std::vector<nlohmann::json>& points, bool draw) {
  if (!table.design.grid() && std::ranges::any_of(points, [](const auto& p) { return p.contains("hosel"); }))
    report_hosels(out, table, points);
  if (std::ranges::none_of(points, [](const nlohmann::json& p) { return p.contains("history"); })) return;
  post::Table histories = table.places().in_files({"time_ms", "normal_force_N", "tangential_force_N"}, "{:.8g}");
  post::Figure figure{.columns = 2};
  for (std::size_t m = 0; m < table.models.size(); ++m) {
    post::Panel tangential{.title = table.models[m], .x_label = "time [ms]", .y_label = "tangential force [kN]"},
        ratio{.title = table.models[m], .x_label = "time [ms]", .y_label = "tangential over normal force [-]"};
    for (std::size_t d = 0; d < table.design.size(); ++d) {
      const std::size_t point = d * table.models.size() + m;
      if (!points[point].contains("history")) continue;
      const std::string label = table.design.said(d);
      post::Series line{.label = label}, share{.label = label};
      for (const nlohmann::json& s : points[point]["history"]) {
        const double time = 1e3 * s.at(0).get<double>(), normal = s.at(1).get<double>(), along = s.at(2).get<double>();
        histories.add(point, table.model_of(point), table.design.cells(d), time, normal, along);
        line.add(time, 1e-3 * along);
        if (normal <= 1) continue;  // [N]: nothing over nothing
        share.add(time, along / normal);
      }
      tangential.series.push_back(std::move(line));
      ratio.series.push_back(std::move(share));
    }
    figure.panels.insert(figure.panels.end(), {tangential, ratio});
  }
  out.write("histories.csv", histories.csv());
  if (draw) out.draw(figure, "figures/histories");
}

}  // namespace hosel::app
