#include "app/study/landing.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "post/digits.hpp"
#include "post/labels.hpp"
#include "post/scatter.hpp"

namespace hosel::app {
namespace {

using Eigen::Vector2d;

std::size_t within(const post::Scatter& balls, double width) {
  return std::size_t(std::ranges::count_if(balls.at, [&](const Vector2d& p) { return std::abs(p.x()) <= width / 2; }));
}

std::size_t output_of(const Table& table, const StudyTable& study, std::string_view stem) {
  for (std::size_t o = 0; o < study.outputs.size(); ++o)
    if (const SplitName s = split_unit(study.outputs[o]); s.stem == stem && s.unit) return o;
  table.fail("", fmt::format("needs an output '{}', as {}_m is", stem, stem));
}

}  // namespace

std::optional<StudyLanding> read_landing(Table root, const StudyTable& table) {
  auto t = root.optional_table("landing");
  if (!t) return {};
  StudyLanding out{.carry = output_of(*t, table, "carry"), .side = output_of(*t, table, "side")};
  out.fairway = t->quantity({"fairway", "width of the fairway, its middle at the target"}, "m", {1, 500});
  out.draws = std::size_t(
      t->integer({"draws", "deliveries drawn through the emulator of a [sample], if it predicts well enough; 0: none"},
                 0, 1000000, 10000));
  return out;
}

nlohmann::json report_landing(Output& out, const StudyTable& table, const StudyEffects& effects,
                              const StudyLanding& landing, const std::vector<bool>& answered, bool draw,
                              const std::string& title) {
  const Unit unit = *split_unit(table.outputs[landing.carry]).unit;
  const double from_side = split_unit(table.outputs[landing.side]).unit->si / unit.si;
  const double fairway = landing.fairway / unit.si;
  const std::string m = post::symbol(unit.suffix);
  nlohmann::json json = nlohmann::json::object();
  post::Figure figure{.title = title, .columns = 2, .panel_width = 520, .panel_height = 620};
  for (std::size_t model = 0; model < table.models.size(); ++model) {
    const std::size_t carry = model * table.outputs.size() + landing.carry,
                      side = model * table.outputs.size() + landing.side;
    std::vector<Vector2d> landed;
    std::size_t balls_struck = 0;
    for (std::size_t d = 0; d < table.design.size(); ++d) {
      balls_struck += answered[d * table.models.size() + model];
      const Vector2d p(from_side * table.series[side].y[d], table.series[carry].y[d]);
      if (p.allFinite()) landed.push_back(p);
    }
    const std::string& name = table.models[model];
    const std::string whose = name.empty() || table.models.size() == 1 ? "" : name + ": ";
    if (landed.size() < 3) {
      out.say(fmt::format("{}fewer than three balls landed: nothing is said of their scatter", whose));
      continue;
    }
    const post::Scatter all(std::move(landed));
    using Binomial = boost::math::binomial_distribution<>;
    const double n = double(balls_struck), hit = double(within(all, fairway));
    if (all.at.size() < balls_struck)
      out.warn(fmt::format("{}{} of {} balls do not land: they count as out of the fairway, and in no mean", whose,
                           balls_struck - all.at.size(), balls_struck));
    const double low = Binomial::find_lower_bound_on_p(n, hit, 0.025),
                 high = Binomial::find_upper_bound_on_p(n, hit, 0.025);
    const Vector2d extent = all.extent(0.95), sd = all.covariance.diagonal().cwiseSqrt(),
                   longer = all.longer().cwiseAbs();
    const double from_line = degrees(std::atan2(longer.x(), longer.y()));
    const double carried = all.mean.y();
    std::string said = fmt::format(
        "{}{:.0f} % of {} balls (95 % interval {:.0f} to {:.0f} %) land in the fairway, {:.4g} {} wide. Carry is "
        "{:.0f} "
        "{} with a standard deviation of {:.1f} {}, side {} {} with {:.1f} {}. The axes of the ellipse for 95 % are "
        "{:.0f} and {:.0f} {}, the longer one {:.0f} deg from the target line.",
        whose, 100 * hit / n, balls_struck, 100 * low, 100 * high, fairway, m, carried, m, sd.y(), m,
        post::fixed(all.mean.x(), 1, true), m, sd.x(), m, extent.x(), extent.y(), m, from_line);
    auto& entry = json[name.empty() ? "case" : name];
    entry = {{"balls", balls_struck},
             {"landed", all.at.size()},
             {"fairway_share", hit / n},
             {"fairway_share_low", low},
             {"fairway_share_high", high},
             {"carry_mean_" + std::string(unit.suffix), carried},
             {"carry_sd_" + std::string(unit.suffix), sd.y()},
             {"side_mean_" + std::string(unit.suffix), all.mean.x()},
             {"side_sd_" + std::string(unit.suffix), sd.x()},
             {"ellipse_length_" + std::string(unit.suffix), extent.x()},
             {"ellipse_width_" + std::string(unit.suffix), extent.y()}};
    const auto &of_carry = effects.emulators[carry], &of_side = effects.emulators[side];
    if (landing.draws > 0 && of_side && of_carry) {
      std::mt19937_64 random(1987);
      std::size_t held = 0;
      for (std::size_t k = 0; k < landing.draws; ++k) {
        Eigen::VectorXd u(Eigen::Index(of_side->columns().size()));
        for (double& x : u) x = solvers::uniform(random);
        held += std::abs(from_side * (*of_side)(of_side->at_shares(u))) <= fairway / 2;
      }
      entry["fairway_share_emulated"] = double(held) / double(landing.draws);
      const double share = double(held) / double(landing.draws);
      said += fmt::format(" Of {} deliveries drawn through the emulator {:.1f} % do; it is off by {:.2g} {} in side.",
                          landing.draws, 100 * share, from_side * of_side->error(), m);
      if (share < low || share > high)
        said += " The two disagree: these balls are few, or the emulator is off; more points of the sample decide.";
    }
    out.say(said);
    out.page().sentence(said);
    post::Series balls{.label = "a ball", .style = "points"};
    for (const Vector2d& p : all.at) balls.add(p.x(), p.y());
    const double reach = 2.6 * sd.y();  // a little beyond the larger ellipse
    post::Panel panel{.title = table.models.size() > 1 ? name : "",
                      .x_label = fmt::format("side, to the right [{}]", m),
                      .y_label = fmt::format("carry [{}]", m)};
    panel.series = {std::move(balls), all.ellipse(0.5, "ellipse for half of them"),
                    all.ellipse(0.95, "ellipse for 95 %")};
    for (const double edge : {-fairway / 2, fairway / 2})
      panel.series.push_back({.label = edge < 0 ? "fairway" : "",
                              .x = {edge, edge},
                              .y = {carried - reach, carried + reach},
                              .style = "lines",
                              .colour = 4});
    figure.panels.push_back(std::move(panel));
  }
  if (draw && post::shows(figure)) out.draw(figure, "figures/landing");
  return json;
}

}  // namespace hosel::app
