#include "app/kinds/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/library.hpp"
#include "app/read_blow.hpp"
#include "app/read_flight.hpp"
#include "app/read_options.hpp"
#include "app/read_parameter.hpp"
#include "models/checked_launch.hpp"
#include "models/registry.hpp"
#include "models/rigid/hertz_maw.hpp"
#include "models/rigid/stick_slip.hpp"
#include "post/csv.hpp"
#include "post/figure.hpp"
#include "post/labels.hpp"
#include "post/launch_table.hpp"

namespace hosel::app {
namespace {

class CurvesJob final : public Job {
 public:
  explicit CurvesJob(CaseFile& file) {
    Table root = file.root();
    models_ = read_models(root);
    blow_ = read_blow(root, models_);
    options_ = read_options(root, models_);
    family_ = read_axis(root.table("family"));
    history_ = root.flag({"history", "force histories instead of launches over x"}, false);
    if (history_) {
      for (const std::string& m : models_)
        if (m != "volumetric" && m != "hertz-maw")
          root.fail("models", "force histories come from volumetric and hertz-maw");
      return;
    }
    x_ = read_axis(root.table("x"));
    check_use(root, use_of_axes(options_, blow_, std::array{family_, x_}), models_);
    const std::optional<FlightSetup> flight = read_optional_flight(root);
    for (const std::string& name : root.texts({"channels", "launch quantities drawn over x"})) {
      const auto c = find_shot_channel(name, flight, blow_.ball);
      if (!c)
        root.fail("channels", fmt::format("no launch quantity '{}' (known: {}; with a [flight]: carry, side, apex, "
                                          "flight_time, landing_angle, and total with its turf)",
                                          name, post::channel_names()));
      channels_.push_back(*c);
    }
    if (channels_.empty()) root.fail("channels", "name at least one launch quantity");
  }

  void run(Output& out) override { history_ ? histories(out) : curves(out); }

 private:
  std::string member(double value) const {
    return fmt::format("{} {:g}{}{}", post::spoken(family_.parameter->name), value / family_.si,
                       family_.parameter->unit.empty() ? "" : " ", post::symbol(family_.parameter->unit));
  }

  void curves(Output& out) const {
    std::string csv = fmt::format("model,{},{}", column(*family_.parameter), column(*x_.parameter));
    for (const ShotChannel& c : channels_) csv += fmt::format(",{}_{}", c.name, c.unit);
    csv += '\n';
    post::Figure figure{.columns = 2};
    for (const ShotChannel& c : channels_)
      for (const std::string& m : models_) {
        std::string name(c.name);
        std::ranges::replace(name, '_', ' ');
        figure.panels.push_back(
            {.title = m, .x_label = x_.label, .y_label = fmt::format("{} [{}]", name, post::symbol(c.unit))});
      }
    post::TextTable table{.rows = {{family_.label, "model"}}};
    for (const ShotChannel& c : channels_)
      table.rows[0].push_back(fmt::format("{} [{}]", post::spoken(c.name), post::symbol(c.unit)));
    nlohmann::json failed = nlohmann::json::array();
    for (std::size_t m = 0; m < models_.size(); ++m)
      for (const double f : family_.values) {
        std::vector<post::Series> lines(channels_.size(), post::Series{.label = member(f)});
        for (const double x : x_.values) {
          models::Options options = options_;
          Blow blow = blow_;
          family_.parameter->set(options, blow, f);
          x_.parameter->set(options, blow, x);
          std::vector<double> values;
          try {
            const Launch launch = models::checked_launch(*models::find(models_[m])->make(options), blow);
            for (const ShotChannel& c : channels_) values.push_back(c.value(launch) / c.si);
          } catch (const std::exception& e) {
            failed.push_back(fmt::format("{}, {} {:g}, {} {:g}: {}", models_[m], column(*family_.parameter),
                                         f / family_.si, column(*x_.parameter), x / x_.si, e.what()));
            continue;
          }
          csv += fmt::format("{},{:.8g},{:.8g}", post::csv_cell(models_[m]), f / family_.si, x / x_.si);
          for (std::size_t c = 0; c < channels_.size(); ++c) {
            csv += fmt::format(",{:.8g}", values[c]);
            lines[c].x.push_back(x / x_.si);
            lines[c].y.push_back(values[c]);
          }
          csv += '\n';
        }
        auto& row = table.rows.emplace_back();
        row = {member(f), models_[m]};
        for (std::size_t c = 0; c < channels_.size(); ++c) {
          const auto [low, high] = std::ranges::minmax_element(lines[c].y);
          row.push_back(lines[c].y.empty() ? "-" : fmt::format("{:.4g} to {:.4g}", *low, *high));
          figure.panels[c * models_.size() + m].series.push_back(lines[c]);
        }
      }
    out.page().answer(table);
    finish(out, csv, figure, failed);
  }

  void histories(Output& out) const {
    std::string csv = fmt::format("model,{},time_ms,normal_force_N,tangential_force_N\n", column(*family_.parameter));
    post::Figure figure{.columns = 2};
    nlohmann::json summary = nlohmann::json::array();
    for (const std::string& m : models_) {
      post::Panel tangential{.title = m, .x_label = "time [ms]", .y_label = "tangential force [kN]"},
          ratio{.title = m, .x_label = "time [ms]", .y_label = "tangential over normal force [-]"};
      for (const double f : family_.values) {
        models::Options options = options_;
        Blow blow = blow_;
        family_.parameter->set(options, blow, f);
        const Vec3 along = models::impulse_problem(blow).contact.slip().normalized();
        post::Series line{.label = member(f)}, share = line;
        double least = 0, most = 0;
        const auto add = [&](double t, double normal, const Vec3& force) {
          const double value = force.dot(along);
          line.x.push_back(t * 1e3);
          line.y.push_back(value * 1e-3);
          if (normal > 1) {
            share.x.push_back(t * 1e3);
            share.y.push_back(value / normal);
          }
          least = std::min(least, value);
          most = std::max(most, value);
          csv += fmt::format("{},{:.8g},{:.8g},{:.8g},{:.8g}\n", m, f / family_.si, t * 1e3, normal, value);
        };
        Launch launch;
        if (m == "volumetric") {
          models::VolumetricOptions fine = options.volumetric_solution;
          fine.tolerance = std::min(fine.tolerance, 1e-6);
          launch = volumetric_impact(blow, options.volumetric, fine, nullptr, [&](const models::ContactSample& s) {
                     add(s.time, s.normal_force, s.tangential_force);
                   }).launch;
        } else {
          launch = hertz_maw_impact(
                       blow, options.hertz_maw, options.hertz_maw_solution,
                       [&](const models::HertzMawSample& s) { add(s.time, s.normal_force, s.tangential_force); })
                       .launch;
        }
        Blow rolling = blow;
        rolling.contact = {};
        const double spin = models::StickSlip().launch(rolling).spin_rate();
        summary.push_back({{"model", m},
                           {column(*family_.parameter), f / family_.si},
                           {"largest_tangential_N", most},
                           {"reversed_tangential_N", least},
                           {"spin_over_rolling", launch.spin_rate() / spin},
                           {"contact_ms", *launch.contact_time * 1e3}});
        out.say(fmt::format("{:<11} {:<34} force {:7.0f} to {:7.0f} N   spin / rolling {:.3f}", m, member(f), least,
                            most, launch.spin_rate() / spin));
        out.page().answer(fmt::format("{}, {}", m, member(f)), fmt::format("{:.3f}", launch.spin_rate() / spin),
                          fmt::format("spin over rolling; {:.1f} to {:.1f} kN", 1e-3 * least, 1e-3 * most));
        tangential.series.push_back(line);
        ratio.series.push_back(share);
      }
      figure.panels.push_back(tangential);
      figure.panels.push_back(ratio);
    }
    finish(out, csv, figure, summary);
  }

  void finish(Output& out, const std::string& csv, const post::Figure& figure, const nlohmann::json& notes) const {
    out.write("curves.csv", csv);
    out.draw(figure, "curves");
    if (!history_)
      for (const auto& n : notes) out.say(n.get<std::string>());
    out.tell("wrote curves.csv and curves.png");
    out.write_summary({{history_ ? "histories" : "failed", notes}});
  }

  std::vector<std::string> models_;
  Blow blow_;
  models::Options options_;
  Axis family_, x_;
  bool history_ = false;
  std::vector<ShotChannel> channels_;
};

}  // namespace

std::unique_ptr<Job> read_curves(CaseFile& file) { return std::make_unique<CurvesJob>(file); }

}  // namespace hosel::app
