#include "loop/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "golf/units.hpp"
#include "loop/rules.hpp"
#include "post/csv.hpp"
#include "post/labels.hpp"

namespace hosel::loop {

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Errors, train_rmse, holdout_rmse, holdout_bias)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DerivedColumn, column, from, formula, residual_sd, recording_resolution, rows, share)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WrongColumn, column, finding, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GroupSpread, along, of, unit, groups, sd, low, high, p)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Detectable, effect, parameter, value, unit)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Location, channel, regressor, detail)

namespace {

/// Numbers that are none (a column without holdout rows) are null. Nine digits: what is beyond them is round-off, and
/// files stay the same on any number of threads.
void nine_digits(json& j) {
  if (j.is_structured())
    for (json& x : j) nine_digits(x);
  if (!j.is_number_float()) return;
  const double x = j.get<double>();
  j = !std::isfinite(x) ? json() : json(std::abs(x) < kTiny ? 0.0 : std::stod(fmt::format("{:.9g}", x)));
}

/// What `of` makes of each.
json each(const auto& all, const auto& of) {
  json out = json::array();
  for (const auto& x : all) out.push_back(of(x));
  return out;
}

/// Of a fit, with the standard deviations (SI) that `sd` gives by their numbers.
json parameters(const Fit& fit, const auto& sd) {
  std::size_t k = 0;
  return each(fit.model.parameters(), [&](const Parameter* q) {
    const double si = q->si, value = fit.p[std::ptrdiff_t(k)] / si;
    return json{{"name", q->name}, {"value", value}, {"sd", sd(k++) / si}, {"unit", q->unit}};
  });
}

json to_json(const Balance& b) {
  return {{"contact", b.contact},
          {"contact_freedom", b.contact_freedom},
          {"inertia", b.inertia},
          {"inertia_freedom", b.inertia_freedom},
          {"inertia_share", b.inertia_share()}};
}

json to_json(const Corrected& corrected, const std::vector<ChannelResult>& channels) {
  std::size_t k = 0;
  const json of_channels = each(channels, [&](const ChannelResult& c) {
    const Errors before = errors(corrected.rows, &UsedRow::before, k),
                 after = errors(corrected.rows, &UsedRow::after, k);
    ++k;
    return json{{"name", c.name},
                {"before_rmse", before.holdout_rmse},
                {"after_rmse", after.holdout_rmse},
                {"rows", before.holdout}};
  });
  const json by_shot = each(corrected.rows, [&](const UsedRow& row) {  // model minus measured
    json shot{{"shot", row.id}};
    for (std::size_t c = 0; c < channels.size(); ++c)
      shot[channels[c].name] = {{"before", row.before[c]}, {"after", row.after[c]}};
    return shot;
  });
  return {{"case", corrected.shots.empty() ? json() : json("corrected/case.toml")},
          {"channels", of_channels},
          {"shots", by_shot},
          {"not_in_the_case", corrected.instrument}};
}

}  // namespace

json to_json(const LoopResult& r) {
  json out = {{"title", r.title},
              {"base", r.base},
              {"rows", {{"read", r.read}, {"used", r.used}, {"train", r.train}, {"holdout", r.holdout}}},
              {"unused_rows", r.unused},
              {"seed", r.seed},
              {"derived_columns", r.derived},
              {"columns", r.columns},
              {"groups", r.groups},
              {"base_holdout_score", r.base_score},
              {"adopted", r.adopted},
              {"ties", r.ties},
              {"verdict", name(r.verdict)},
              {"sentence", sentence(r)},
              {"minimum_detectable", r.minimum_detectable},
              {"unexplained", r.unexplained},
              {"notes", r.notes}};
  out["flagged_rows"] = each(r.flagged, [](const Flag& f) {
    // A shot number is a number, whatever the file calls a shot else is text.
    const bool number = !f.id.empty() && f.id.size() < 10 && f.id.find_first_not_of("0123456789") == std::string::npos;
    json told{{"shot", number ? json(std::stoi(f.id)) : json(f.id)},
              {"column", f.column},
              {"reason", f.reason},
              {"finding", f.finding}};
    if (f.line) told["line"] = *f.line;
    return told;
  });
  out["channels"] = each(r.channels, [](const ChannelResult& c) {
    return json{{"name", c.name},
                {"noise_sd", c.noise},
                {"noise_source", c.noise_source == "declared" ? "declared" : "estimated"},
                {"noise_from_repeats", c.noise_source == "repeats"},
                {"scatter_over_noise", c.scatter},
                {"expected_holdout_rmse", c.expected},
                {"before", c.before},
                {"after", c.after},
                {"with_remainder", c.with_remainder}};
  });
  out["functions"] = each(r.functions, [](const Mechanism& m) {
    return json{{"along", m.along}, {"through", m.acts}, {"step", m.step}, {"is", m.names}, {"ahead", -m.criterion}};
  });
  out["remainder"] = each(r.remainder ? r.remainder->places : std::vector<Remainder::Place>{}, [&](const auto& p) {
    return json{{"channel", r.channel_names[p.channel]},
                {"rms", p.size},
                {"along", p.along},
                {"share", p.share},
                {"largest", p.largest},
                {"at", p.at}};
  });
  out["remainder_fall"] = r.remainder ? json(r.remainder->fall()) : json();
  out["structure"] = json::array();
  const Selection& s = r.selection;
  for (const Finding& f : s.before.findings) {
    if (out["structure"].size() >= 20 || f.channel < 0 || (f.p_adjusted > kTold && std::abs(f.signal) < 4.5)) continue;
    // Neighbours are products: no noise units.
    const bool product = f.kind == "neighbours";
    out["structure"].push_back({{"channel", r.channel_names[f.channel]},
                                {"regressor", f.regressor},
                                {"statistic", fmt::format("{}: {:+.2f}{}", f.what(), product ? f.statistic : f.signal,
                                                          product ? "" : " noise units")},
                                {"p_adjusted", f.p_adjusted}});
  }
  out["remaining"] = {{"p", s.after.p},
                      {"largest", s.after.findings.empty() ? json() : json(s.after.findings.front().signal)}};
  int rank = 0;
  out["candidates"] = each(r.candidates, [&](const ScoredCandidate& c) {
    const Fit& f = c.candidate.fit;
    return json{{"effects", c.candidate.effects},
                {"parameters", parameters(f, [&](std::size_t k) { return c.sd[k]; })},
                {"forms", each(f.model.forms, [](const Parametrisation* q) { return q->effect + ": " + q->what; })},
                {"deviance_fall", s.base.deviance - f.deviance},
                {"at_bound", f.at_bound},
                {"holdout_score", c.holdout_score},
                {"rank", ++rank}};
  });
  if (const Fit& after = s.chosen; !(r.adopted.empty() && r.ties.empty())) {  // of all training rows
    const auto sd = [&](std::size_t k) { return std::sqrt(r.covariance(std::ptrdiff_t(k), std::ptrdiff_t(k))); };
    out["chosen"] = {{"effects", after.model.effects()}, {"parameters", parameters(after, sd)}};
  }
  const json shots = each(r.next.shots, [](const DesignedShot& d) {
    json e;
    for (const auto& [header, x] : d) e[header] = std::stod(fmt::format("{:.4g}", x));
    return e;
  });
  out["next_experiment"] = {
      {"text", r.next.text}, {"shots", shots}, {"sensor", r.next.sensor ? json(*r.next.sensor) : json()}};
  out["without_doubted_inputs"] = each(r.without, [](const auto& w) {
    return json{{"column", w.first}, {"adopted", w.second}};
  });
  out["absorption"] = each(r.likeness.absorption, [](const Absorption& a) {
    return json{{"effect", a.effect},
                {"parameter", a.parameter},
                {"absorbed", a.absorbed},
                {"nearest", a.nearest},
                {"correlation", a.likeness}};
  });
  out["null_vectors"] = each(r.likeness.null_vectors, [](const NullVector& v) {
    json weights = json::object();
    for (const auto& [effect, weight] : v.weights) weights[effect] = weight;
    return json{{"singular_value", v.singular}, {"weights", weights}};
  });
  if (r.balance_before)
    out["balances"] = {{"before", to_json(*r.balance_before)}, {"after", to_json(*r.balance_after)}};
  if (r.corrected) out["corrected"] = to_json(*r.corrected, r.channels);
  nine_digits(out);
  return out;
}

std::string residuals_csv(const LoopResult& r, const Shots& table) {
  const Column *time = table.find("time_s"), *record = table.find("record");
  const bool records = time && record;
  std::string out = records ? "record,time_s,set" : "shot,set";
  for (const ChannelResult& c : r.channels)
    out += fmt::format(",{0}__measured,{0}__before,{0}__after{1}", c.name,
                       r.remainder ? fmt::format(",{}__with_remainder", c.name) : "");
  out += '\n';
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format(",{:.9g}", x) : std::string(","); };
  for (const UsedRow& u : r.rows) {
    const auto row = std::size_t(u.row);
    out += records ? post::csv_cell(record->text[row]) + cell(time->value[row]) : post::csv_cell(u.id);
    out += u.holdout ? ",holdout" : ",train";
    for (std::size_t c = 0; c < r.channels.size(); ++c) {
      out += cell(u.measured[c]) + cell(u.measured[c] + u.before[c]) + cell(u.measured[c] + u.after[c]);
      if (r.remainder) out += cell(u.measured[c] + u.with_remainder[c]);
    }
    out += '\n';
  }
  return out;
}

namespace {

/// The held-out error of the channel that is farthest above what instrument and inputs make of it, as numbers; in words
/// only where none is farther than the data's own scatter may be from a declared noise. After a space.
std::string beside_noise(const LoopResult& r) {
  const ChannelResult* worst = nullptr;
  const auto ratio = [](const ChannelResult& c) { return c.after.holdout_rmse / c.expected; };
  for (const ChannelResult& c : r.channels)
    if (c.expected > 0 && std::isfinite(c.after.holdout_rmse) && (!worst || ratio(c) > ratio(*worst))) worst = &c;
  if (!worst) return "";
  // The root mean square of few values is beyond that by chance, the worst of many channels sooner.
  const double p = kTold / (2 * double(r.channels.size()));
  const double chance =
      std::sqrt(quantile(boost::math::chi_squared(worst->after.holdout), 1 - p) / worst->after.holdout);
  if (ratio(*worst) <= std::max(Rules{}.scatter_ratio, chance)) return " The held-out error is within the noise.";
  const SplitName name = split_unit(worst->name);
  const std::string unit = name.unit ? " " + post::symbol(name.unit->suffix) : "";
  return fmt::format(
      " Held out, {} is off by {:.3g}{} (RMS), the noise of readings and inputs makes {:.3g}{}: {:.1f} times.",
      post::spoken(name.stem), worst->after.holdout_rmse, unit, worst->expected, unit, ratio(*worst));
}

/// What stands in the way of a name, in a sentence.
std::string remains(const Location& l, const LoopResult& r) {
  if (l.rival) return fmt::format("No effect is named: {}.", l.detail);
  if (l.regressor.empty()) return fmt::format("Something remains that no candidate explains: {}.", l.detail);
  std::string what = fmt::format("{} against {} ({})", l.channel, l.regressor, l.detail);
  if (l.channel.empty()) what = fmt::format("{}: {}", l.regressor, l.detail);
  else if (l.regressor == "constant") what = off_in_the_mean(l, r);
  return fmt::format("Structure remains that no candidate explains: {}.", what);
}

}  // namespace

std::string off_in_the_mean(const Location& l, const LoopResult& r) {
  const auto c = std::ranges::find(r.channels, l.channel, &ChannelResult::name);
  const double bias = c == r.channels.end() ? kNaN : c->after.holdout_bias;
  return std::isfinite(bias) ? fmt::format("{} is off in the mean (held out by {:.3g})", l.channel, std::abs(bias))
                             : l.channel + " is off in the mean";
}

std::vector<AdoptedSize> adopted_sizes(const LoopResult& r) {
  std::vector<AdoptedSize> out;
  Eigen::Index k = 0;
  for (const Parametrisation* form : r.selection.chosen.model.forms)
    for (const Parameter& p : form->parameters) {
      if (std::ranges::count(r.adopted, form->effect))
        out.push_back({form->effect, p.name, p.unit, r.selection.chosen.p[k] / p.si,
                       std::sqrt(r.covariance(k, k)) / p.si, p.at_edge(r.selection.chosen.p[k])});
      ++k;
    }
  return out;
}

std::vector<std::string> tied_in_after(const LoopResult& r) {
  if (r.ties.empty()) return {};
  std::vector<std::string> names = r.selection.chosen.model.effects(r.selection.base.model.forms.size());
  std::erase_if(names, [&](const std::string& e) { return std::ranges::count(r.adopted, e) > 0; });
  return names;
}

std::string sentence(const LoopResult& r) {
  const auto list = [](const std::vector<std::string>& v) { return fmt::format("{}", fmt::join(v, ", ")); };
  std::vector<std::string> alternatives;
  for (const auto& tie : r.ties) alternatives.push_back(fmt::format("{}", fmt::join(tie, " or ")));
  const std::string ties = fmt::format("{}", fmt::join(alternatives, "; and "));
  const std::string tied =
      r.ties.empty() ? ""
                     : fmt::format(" It {}lacked one of {}these, which the data cannot separate: {}.",
                                   r.adopted.empty() ? "" : "also ", r.ties.size() > 1 ? "each of " : "", ties);
  switch (r.verdict) {
    case Verdict::no_residual:
      return "No structure beyond the noise: the base model explains these shots." + beside_noise(r);
    case Verdict::explained: return fmt::format("The model lacked: {}.{}", list(r.adopted), beside_noise(r));
    case Verdict::ambiguous:
      if (!r.adopted.empty()) return fmt::format("The model lacked: {}.{}{}", list(r.adopted), tied, beside_noise(r));
      return fmt::format("The model lacked one of {}these, which the data cannot separate: {}.{}",
                         r.ties.size() > 1 ? "each of " : "", ties, beside_noise(r));
    case Verdict::unexplained: {
      if (!r.columns.empty())
        return fmt::format("A whole column contradicts its header: {}. Mend the file or its header, then run again.",
                           r.columns.front().text);
      std::string s = r.unexplained.empty() ? "Structure remains that no candidate explains."
                                            : remains(r.unexplained.front(), r);
      if (!r.adopted.empty()) s += fmt::format(" Beyond doubt the model lacked: {}.", list(r.adopted));
      return s + tied;
    }
    case Verdict::insufficient: {
      std::string s = "Too little to name anything" + (r.faint.empty() ? "" : ": " + r.faint) + ".";
      if (!r.minimum_detectable.empty()) s += " The smallest effects that these data would have shown are listed.";
      return s;
    }
    case Verdict::noise_contradicted: {
      std::string which = r.tails;
      for (const ChannelResult& c : r.channels)
        if (c.refuted) which += (which.empty() ? "" : "; ") + c.refutation();
      std::string s = "The declared noise is contradicted by the data's own scatter: " + which + ".";
      if (!r.adopted.empty()) s += fmt::format(" The model lacked all the same: {}.", list(r.adopted));
      return s + tied;
    }
  }
  return "";
}

}  // namespace hosel::loop
