#include "app/study/effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "post/digits.hpp"
#include "post/labels.hpp"

namespace hosel::app {
namespace {

std::string percent(double share) { return fmt::format("{:.0f}", 100 * share); }

/// What changes where a column says which variant or row is meant.
std::string spoken_column(const std::string& column) {
  return column == "variant" || column == "row" ? "the " + column : post::label(column);
}

std::string capital(std::string text) {
  if (!text.empty()) text.front() = char(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// An emulator that predicts well knows the shares better than a regression on one parameter at a time: those replace
/// the effects' own. Returns the shares with all interactions.
std::vector<StudyEmulator::Share> emulated(solvers::MainEffects& effects, const StudyEffects& study) {
  const StudyEmulator::Shares shares = study.emulators.back()->shares();
  for (std::size_t f = 0; f < effects.factors.size(); ++f) {
    const StudyEmulator::Share& own = shares.alone[study.columns[f]];
    effects.factors[f].share = own.value;
    effects.factors[f].low = own.low;
    effects.factors[f].high = own.high;
  }
  std::ranges::stable_sort(effects.order, std::greater(), [&](std::size_t f) { return effects.factors[f].share; });
  effects.first_is_certain = effects.factors[effects.order[0]].low > effects.factors[effects.order[1]].high;
  effects.separable = true;  // an emulator is asked where each parameter varies alone
  return shares.together;
}

/// Of the variance, by one parameter at a time.
double alone(const solvers::MainEffects& e) {
  double share = 0;
  for (const solvers::MainEffect& f : e.factors) share += f.share;
  return share;
}

/// What can be said of the parameter that moves an answer most.
enum class Leader { alone, together, combinations, correlated, unknown };

Leader leader(const StudyEffects& effects, std::size_t series) {
  constexpr double most = 0.5;  // of the variance: what is left could make any parameter the first
  const solvers::MainEffects& e = *effects.of[series];
  if (!e.separable) return Leader::correlated;
  if (!effects.together[series].empty()) return alone(e) < most ? Leader::together : Leader::alone;
  if (e.full_factorial) return alone(e) < most ? Leader::combinations : Leader::alone;
  return e.predicted < most ? Leader::unknown : Leader::alone;
}

/// From the parameter that takes part in most of the variance to the one that takes part in least.
std::vector<std::size_t> by_total(const StudyEffects& effects, std::size_t series) {
  std::vector<std::size_t> order = effects.of[series]->order;
  std::ranges::stable_sort(order, std::greater(),
                           [&](std::size_t f) { return effects.together[series][effects.columns[f]].value; });
  return order;
}

/// Whether no answer of a model changes between points that differ in one column alone; nothing where a point has no
/// such other.
std::optional<bool> changes_nothing(const StudyTable& table, std::size_t column, std::size_t model) {
  std::map<std::vector<std::string>, std::vector<std::size_t>> alike;
  for (std::size_t d = 0; d < table.design.size(); ++d) {
    std::vector<std::string> others = table.design.cells(d);
    others.erase(others.begin() + std::ptrdiff_t(column));
    alike[others].push_back(d);
  }
  if (std::ranges::any_of(alike, [](const auto& a) { return a.second.size() < 2; })) return {};
  for (const auto& [others, points] : alike)
    for (const StudySeries& s : table.series)
      for (const std::size_t d : points)
        if (s.model == model && !same_answer(s.y[d], s.y[points.front()])) return false;
  return true;
}

/// Parameters that a model does not read, or that its outputs do not show.
std::string without_effect(const StudyTable& table, const StudyEffects& effects, std::size_t model) {
  std::vector<std::string> idle;
  for (std::size_t f = 0; f < effects.columns.size(); ++f)
    if (effects.idle[model][f]) idle.push_back(spoken_column(table.design.columns()[effects.columns[f]]));
  return fmt::format("{}", fmt::join(idle, " or "));
}

bool names_a_row(const Design& design, std::size_t column) {
  for (const DesignFactor& f : design.factors()) {
    if (column < f.columns.size()) return f.kind == DesignFactor::Kind::rows && f.columns[column] == "row";
    column -= f.columns.size();
  }
  return false;
}

}  // namespace

bool same_answer(double a, double b) {
  constexpr double round_off = 1e-12;  // relative
  return std::abs(a - b) <= round_off * std::abs(a);
}

void find_idle(StudyEffects& effects, const StudyTable& table,
               const std::function<std::optional<bool>(std::size_t, std::size_t)>& alone) {
  effects.idle.assign(table.models.size(), std::vector<bool>(effects.columns.size()));
  if (effects.columns.size() < 2) return;
  for (std::size_t m = 0; m < table.models.size(); ++m)
    for (std::size_t f = 0; f < effects.columns.size(); ++f) {
      std::optional<bool> idle = changes_nothing(table, effects.columns[f], m);
      const auto surely = [&](const StudySeries& s) {
        const auto& e = effects.of[std::size_t(&s - table.series.data())];
        return s.model == m && e && e->factors[f].low > 0;
      };
      const auto told = [&](const StudySeries& s) {
        return s.model == m && effects.of[std::size_t(&s - table.series.data())].has_value();
      };
      if (!idle && std::ranges::any_of(table.series, told) && std::ranges::none_of(table.series, surely))
        idle = alone(effects.columns[f], m);
      effects.idle[m][f] = idle.value_or(false);
    }
}

StudyEffects effects_of(const StudyTable& table) {
  StudyEffects out;
  std::vector<solvers::EffectFactor> factors;
  const auto columns = table.design.columns();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto levels = table.design.levels(c);
    if (levels.size() < 2 || names_a_row(table.design, c)) continue;  // it stands for its other columns
    out.columns.push_back(c);
    solvers::EffectFactor f{.x = table.design.numbers(c), .ordered = true};
    if (f.x.empty()) {
      f.ordered = false;
      std::map<std::string, double> number;
      for (std::size_t l = 0; l < levels.size(); ++l) number[levels[l]] = double(l);
      for (std::size_t d = 0; d < table.design.size(); ++d) f.x.push_back(number.at(table.design.cells(d)[c]));
    }
    factors.push_back(std::move(f));
  }
  for (std::size_t k = 0; k < table.series.size(); ++k) {
    const StudySeries& s = table.series[k];
    out.of.emplace_back();
    out.emulators.push_back(StudyEmulator::of(table, k));
    out.together.emplace_back();
    if (factors.size() < 2 || s.constant()) continue;  // nothing moves it
    std::vector<solvers::EffectFactor> there = factors;
    std::vector<double> y;
    for (auto& f : there) f.x.clear();
    for (std::size_t d = 0; d < s.y.size(); ++d) {
      if (!std::isfinite(s.y[d])) continue;
      y.push_back(s.y[d]);
      for (std::size_t f = 0; f < factors.size(); ++f) there[f].x.push_back(factors[f].x[d]);
    }
    const auto varies = [](const solvers::EffectFactor& f) {
      return !f.x.empty() && std::ranges::min(f.x) < std::ranges::max(f.x);
    };
    if (std::ranges::all_of(there, varies)) out.of.back() = solvers::main_effects(there, y);
    if (out.of.back() && out.emulators.back()) out.together.back() = emulated(*out.of.back(), out);
  }
  return out;
}

std::string sentence(const StudyTable& table, const StudyEffects& effects, std::size_t series) {
  const std::string& answer = table.series[series].spoken;
  const StudySeries::Spread spread = table.series[series].spread();
  if (effects.columns.size() > 1 && table.series[series].constant())
    return fmt::format("{} is {:.4g} at every point.", capital(answer), spread.low);
  const auto& e = effects.of[series];
  if (!e) return {};
  const auto columns = table.design.columns();
  const Leader told = leader(effects, series);
  const std::vector<std::size_t> order = told == Leader::together ? by_total(effects, series) : e->order;
  const auto name = [&](std::size_t rank) { return spoken_column(columns[effects.columns[order[rank]]]); };
  const auto of_variance = [](const auto& share, double value) {
    return fmt::format("{} % of its variance (95 % interval {} to {} %)", percent(value), percent(share.low),
                       percent(share.high));
  };
  const auto share = [&](std::size_t rank) {
    const solvers::MainEffect& f = e->factors[order[rank]];
    return of_variance(f, f.share);
  };
  switch (told) {
    case Leader::alone: break;
    case Leader::correlated:
      return fmt::format("These points do not tell what moves {} most: {} and others vary together over them.", answer,
                         name(0));
    case Leader::unknown:
      return fmt::format(
          "These points do not tell what moves {} most: one parameter at a time predicts {} % of its variance at "
          "points left out.",
          answer, percent(std::max(0.0, e->predicted)));
    case Leader::combinations:
      return fmt::format("{} goes with combinations of parameters: alone, {} has most with {}.", capital(answer),
                         name(0), share(0));
    case Leader::together: {
      const auto& all = effects.together[series];
      const StudyEmulator::Share &first = all[effects.columns[order[0]]], &second = all[effects.columns[order[1]]];
      return fmt::format(
          "{} goes with combinations of parameters: {} takes part in {}, alone it has {} %. Second is {} with {} %.",
          capital(answer), name(0), of_variance(first, first.value), percent(e->factors[order[0]].share), name(1),
          percent(second.value));
    }
  }
  const solvers::MainEffect& first = e->factors[order[0]];
  const std::string turning = first.between ? fmt::format(" through {:.4g}", *first.between) : "";
  const bool ordered = !table.design.numbers(effects.columns[order[0]]).empty();
  // The ends of a fitted curve that no answer comes near are no answers.
  const double margin = 0.05 * (spread.high - spread.low);
  const auto seen = [&](double x) { return x >= spread.low - margin && x <= spread.high + margin; };
  std::string text = fmt::format("{} goes most with {}: {}", capital(answer), name(0), share(0));
  if (!ordered) text += fmt::format(", means from {:.4g} to {:.4g}", first.at_low, first.at_high);
  else if (seen(first.at_low) && seen(first.at_high))
    text += fmt::format(", from {:.4g}{} to {:.4g} over its range", first.at_low, turning, first.at_high);
  text += '.';
  text += e->first_is_certain
              ? fmt::format(" Second is {} with {} %.", name(1), percent(e->factors[order[1]].share))
              : fmt::format(" Whether {} with {} moves it as much, these points do not decide.", name(1), share(1));
  if (const auto& together = effects.together[series]; !together.empty()) {
    const StudyEmulator::Share& all = together[effects.columns[order[0]]];
    if (all.value > first.share + 0.02)
      text += fmt::format(" With its interactions the first takes part in {} % ({} to {} %).", percent(all.value),
                          percent(all.low), percent(all.high));
  } else if (e->full_factorial) {  // its shares are exact: a point left out says nothing more
    if (alone(*e) < 0.8)
      text += fmt::format(" One parameter at a time makes {} % of it: the rest are interactions.", percent(alone(*e)));
  } else if (e->predicted < 0.8)
    text += fmt::format(
        " One parameter at a time predicts {} % of it at points left out: the rest are interactions and "
        "curvature.",
        percent(std::max(0.0, e->predicted)));
  return text;
}

void tell_effects(Output& out, const StudyTable& table, const StudyEffects& effects, nlohmann::json& summary) {
  const bool several = effects.columns.size() > 1;
  const auto columns = table.design.columns();
  post::TextTable shown{.rows = {{"answer", "lowest", "mean", "highest"}},
                        .first_width = 10,
                        .margin = 1,
                        .least_width = 10,
                        .even = false};
  if (several) shown.rows[0].insert(shown.rows[0].end(), {"goes most with", "share of variance [%]"});
  const bool emulated = std::ranges::any_of(effects.emulators, [](const auto& e) { return e.has_value(); });
  if (emulated) shown.rows[0].push_back("emulator off by");
  post::Table sensitivity{{{"output"}, {"parameter"}}};
  sensitivity.in_files({"share", "share_low", "share_high", "together", "together_low", "together_high"}, "{:.6g}");
  bool begun = false;
  for (std::size_t s = 0; s < table.series.size(); ++s) {
    const StudySeries& series = table.series[s];
    const auto [low, mean, high] = series.spread();
    if (std::isnan(mean)) continue;
    summary["range"][series.name] = {low, high};
    summary["mean"][series.name] = mean;
    auto& row = shown.rows.emplace_back();
    const double scale = std::max(std::abs(low), std::abs(high));
    row = {series.spoken, post::beside(low, scale), post::beside(mean, scale), post::beside(high, scale)};
    const std::string off = effects.emulators[s] ? fmt::format("{:.2g}", effects.emulators[s]->error()) : "-";
    if (const auto& e = effects.emulators[s])
      summary["emulator"][series.name] = {
          {"points", e->points()}, {"rms_error", e->error()}, {"predicted", e->predicted()}};
    if (!several || !effects.of[s]) {
      if (several) row.insert(row.end(), {"-", "-"});
      if (emulated) row.push_back(off);
      continue;
    }
    const solvers::MainEffects& e = *effects.of[s];
    for (std::size_t f = 0; f < e.factors.size(); ++f) {
      const std::string& column = columns[effects.columns[f]];
      const solvers::MainEffect& own = e.factors[f];
      auto& entry = summary["main_effects"][series.name][column];
      entry = {
          {"share", own.share}, {"low", own.low}, {"high", own.high}, {"at_low", own.at_low}, {"at_high", own.at_high}};
      if (own.between) entry["between"] = *own.between;
      sensitivity.add(series.name, column, own.share, own.low, own.high);
      if (effects.together[s].empty()) {
        sensitivity.more(std::nullopt, std::nullopt, std::nullopt);
        continue;
      }
      const StudyEmulator::Share& all = effects.together[s][effects.columns[f]];
      entry["together"] = {{"share", all.value}, {"low", all.low}, {"high", all.high}};
      sensitivity.more(all.value, all.low, all.high);
    }
    if (!e.separable) summary["vary_together"].push_back(series.name);
    const auto led = [&](std::size_t factor, const auto& share, double value, const char* how) {
      row.insert(row.end(),
                 {spoken_column(columns[effects.columns[factor]]),
                  fmt::format("{}{} ({} to {})", how, percent(value), percent(share.low), percent(share.high))});
    };
    const solvers::MainEffect& first = e.factors[e.order[0]];
    switch (leader(effects, s)) {
      case Leader::alone: led(e.order[0], first, first.share, ""); break;
      case Leader::together: {
        const std::size_t factor = by_total(effects, s)[0];
        const StudyEmulator::Share& all = effects.together[s][effects.columns[factor]];
        led(factor, all, all.value, "in combinations ");
        break;
      }
      case Leader::combinations: row.insert(row.end(), {"-", "combinations"}); break;
      case Leader::correlated: row.insert(row.end(), {"-", "they vary together"}); break;
      case Leader::unknown: row.insert(row.end(), {"-", "these points do not tell"}); break;
    }
    if (emulated) row.push_back(off);
    const std::string said = sentence(table, effects, s);
    constexpr std::size_t most = 8;  // a page begins with what somebody reads
    if (s < most) {
      out.say(said);
      if (!begun) out.page().sentence(said);
      begun = true;
    }
  }
  out.show(shown);
  std::set<std::string> said_of_all;
  for (std::size_t m = 0; m < table.models.size(); ++m) said_of_all.insert(without_effect(table, effects, m));
  for (std::size_t m = 0; m < table.models.size(); ++m)
    if (const std::string idle = without_effect(table, effects, m); !idle.empty()) {
      if (said_of_all.size() > 1) out.say(fmt::format("No answer of {} depends on {}.", table.models[m], idle));
      else if (m == 0) out.say(fmt::format("No answer depends on {}.", idle));
    }
  if (!sensitivity.rows.empty()) out.write("sensitivity.csv", sensitivity.csv());
}

post::Figure tornado(const StudyTable& table, const StudyEffects& effects, const std::vector<std::size_t>& which) {
  const auto columns = table.design.columns();
  constexpr std::size_t most = 12;
  const int bars = int(std::min(most, effects.columns.size()));
  const bool means =
      std::ranges::any_of(which, [&](std::size_t s) { return effects.of[s] && effects.of[s]->full_factorial; });
  post::Figure figure{
      .title = means ? "mean of the answers at a parameter's lowest and at its highest value"
                     : "a curve fitted to all points, at a parameter's lowest and highest value: no single answers",
      .columns = 2,
      .panel_width = 760,
      .panel_height = 130 + 26 * bars};
  for (const std::size_t s : which) {
    if (!effects.of[s]) continue;
    const solvers::MainEffects& e = *effects.of[s];
    const double centre = table.series[s].spread().mean;
    post::Panel panel{.x_label = table.series[s].spoken};
    post::Series low{.label = "lowest value", .style = "filledcurves closed"},
        high{.label = "highest value", .style = "filledcurves closed"};
    for (int k = 0; k < bars; ++k) {
      const std::size_t f = e.order[std::size_t(k)];
      const bool idle = effects.idle[table.series[s].model][f];
      panel.y_names.push_back(spoken_column(columns[effects.columns[f]]) + (idle ? ": no effect" : ""));
      if (idle) continue;
      // The bar of the highest value is narrower: both are seen where both ends lie on one side.
      for (const auto& [side, value, half] :
           {std::tuple{&low, e.factors[f].at_low, 0.32}, {&high, e.factors[f].at_high, 0.2}}) {
        side->x.insert(side->x.end(), {centre, value, value, centre, NAN});
        side->y.insert(side->y.end(), {half - k, half - k, -half - k, -half - k, NAN});
      }
    }
    panel.series = {std::move(low), std::move(high)};
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace hosel::app
