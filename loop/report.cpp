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
namespace {

using nlohmann::json;

/// Numbers that are none (a column without holdout rows) are null in JSON. Nine digits: what is beyond them is
/// round-off, and files stay the same on any number of threads.
json value(double x) {
  if (!std::isfinite(x)) return nullptr;
  if (std::abs(x) < kTiny) return 0.0;
  return std::stod(fmt::format("{:.9g}", x));
}

json errors(const Errors& e) {
  return {{"train_rmse", value(e.train_rmse)},
          {"holdout_rmse", value(e.holdout_rmse)},
          {"holdout_bias", value(e.holdout_bias)}};
}

/// Of a fit, with the standard deviations (SI) that `sd` gives by their numbers.
json parameters(const Fit& fit, const auto& sd) {
  json out = json::array();
  const auto of = fit.model.parameters();
  for (std::size_t k = 0; k < of.size(); ++k)
    out.push_back({{"name", of[k]->name},
                   {"value", value(fit.p[std::ptrdiff_t(k)] / of[k]->si)},
                   {"sd", value(sd(k) / of[k]->si)},
                   {"unit", of[k]->unit}});
  return out;
}

}  // namespace

json to_json(const LoopResult& r) {
  json out;
  out["title"] = r.title;
  out["base"] = r.base;
  out["rows"] = {{"read", r.read}, {"used", r.used}, {"train", r.train}, {"holdout", r.holdout}};
  out["unused_rows"] = r.unused;
  out["seed"] = r.seed;
  out["flagged_rows"] = json::array();
  for (const auto& f : r.flagged) {
    json id = f.id;
    // A shot number is a number, whatever the file calls a shot else is text.
    if (!f.id.empty() && f.id.size() < 10 && f.id.find_first_not_of("0123456789") == std::string::npos)
      id = std::stoi(f.id);
    out["flagged_rows"].push_back({{"shot", id}, {"column", f.column}, {"reason", f.reason}, {"finding", f.finding}});
  }
  out["derived_columns"] = json::array();
  for (const DerivedColumn& d : r.derived)
    out["derived_columns"].push_back({{"column", d.column},
                                      {"from", d.from},
                                      {"formula", d.formula},
                                      {"residual_sd", value(d.residual_sd)},
                                      {"recording_resolution", value(d.recording_resolution)},
                                      {"rows", d.rows},
                                      {"share", value(d.share)}});
  out["columns"] = json::array();
  for (const WrongColumn& c : r.columns)
    out["columns"].push_back({{"column", c.column}, {"finding", c.finding}, {"text", c.text}});
  out["channels"] = json::array();
  for (const ChannelResult& c : r.channels)
    out["channels"].push_back({{"name", c.name},
                               {"noise_sd", value(c.noise)},
                               {"noise_source", c.noise_source == "declared" ? "declared" : "estimated"},
                               {"noise_from_repeats", c.noise_source == "repeats"},
                               {"scatter_over_noise", value(c.scatter)},
                               {"expected_holdout_rmse", value(c.expected)},
                               {"before", errors(c.before)},
                               {"after", errors(c.after)},
                               {"with_remainder", errors(c.with_remainder)}});
  out["functions"] = json::array();
  for (const Mechanism& m : r.functions)
    out["functions"].push_back(
        {{"along", m.along}, {"through", m.acts}, {"step", m.step}, {"is", m.names}, {"ahead", value(-m.criterion)}});
  out["remainder"] = json::array();
  if (r.remainder)
    for (const Remainder::Place& p : r.remainder->places)
      out["remainder"].push_back({{"channel", r.channel_names[std::size_t(p.channel)]},
                                  {"rms", value(p.size)},
                                  {"along", p.along},
                                  {"share", value(p.share)},
                                  {"largest", value(p.largest)},
                                  {"at", value(p.at)}});
  out["remainder_fall"] = r.remainder ? value(r.remainder->fall()) : json(nullptr);
  out["groups"] = json::array();
  for (const GroupSpread& g : r.groups)
    out["groups"].push_back({{"along", g.along},
                             {"of", g.of},
                             {"unit", g.unit},
                             {"groups", g.groups},
                             {"sd", value(g.sd)},
                             {"low", value(g.low)},
                             {"high", value(g.high)},
                             {"p", value(g.p)}});
  out["structure"] = json::array();
  const Selection& s = r.selection;
  int shown = 0;
  for (const Finding& f : s.before.findings) {
    if (shown >= 20 || f.channel < 0) continue;
    if (f.p_adjusted > kTold && std::abs(f.signal) < 4.5) continue;
    json e;
    e["channel"] = r.channel_names[std::size_t(f.channel)];
    e["regressor"] = f.regressor;
    // Neighbours are products: no noise units.
    e["statistic"] = f.kind == "neighbours" ? fmt::format("{}: {:+.2f}", f.what(), f.statistic)
                                            : fmt::format("{}: {:+.2f} noise units", f.what(), f.signal);
    e["p_adjusted"] = value(f.p_adjusted);
    out["structure"].push_back(e);
    ++shown;
  }
  out["remaining"] = {{"p", value(s.after.p)},
                      {"largest", s.after.findings.empty() ? json(nullptr) : value(s.after.findings.front().signal)}};
  out["base_holdout_score"] = value(r.base_score);
  out["candidates"] = json::array();
  int rank = 0;
  for (const ScoredCandidate& c : r.candidates) {
    json e;
    e["effects"] = c.candidate.effects;
    e["parameters"] = parameters(c.candidate.fit, [&](std::size_t k) { return c.sd[k]; });
    std::vector<std::string> forms;
    for (const Parametrisation* f : c.candidate.fit.model.forms) forms.push_back(f->effect + ": " + f->what);
    e["forms"] = forms;
    e["deviance_fall"] = value(s.base.deviance - c.candidate.fit.deviance);
    e["at_bound"] = c.candidate.fit.at_bound;
    e["holdout_score"] = value(c.holdout_score);
    e["rank"] = ++rank;
    out["candidates"].push_back(e);
  }
  if (const Fit& after = s.chosen; !(r.adopted.empty() && r.ties.empty())) {  // of all training rows
    const auto sd = [&](std::size_t k) { return std::sqrt(r.covariance(std::ptrdiff_t(k), std::ptrdiff_t(k))); };
    out["chosen"] = {{"effects", after.model.effects()}, {"parameters", parameters(after, sd)}};
  }
  out["adopted"] = r.adopted;
  out["ties"] = r.ties;
  out["verdict"] = std::string(name(r.verdict));
  out["sentence"] = sentence(r);
  out["minimum_detectable"] = json::array();
  for (const Detectable& d : r.minimum_detectable)
    out["minimum_detectable"].push_back(
        {{"effect", d.effect}, {"parameter", d.parameter}, {"value", value(d.value)}, {"unit", d.unit}});
  out["unexplained"] = json::array();
  for (const Location& l : r.unexplained)
    out["unexplained"].push_back({{"channel", l.channel}, {"regressor", l.regressor}, {"detail", l.detail}});
  json shots = json::array();
  for (const DesignedShot& d : r.next.shots) {
    json e;
    for (const auto& [header, x] : d) e[header] = value(std::stod(fmt::format("{:.4g}", x)));
    shots.push_back(e);
  }
  out["next_experiment"] = {
      {"text", r.next.text}, {"shots", shots}, {"sensor", r.next.sensor ? json(*r.next.sensor) : json(nullptr)}};
  out["without_doubted_inputs"] = json::array();
  for (const auto& [column, adopted] : r.without)
    out["without_doubted_inputs"].push_back({{"column", column}, {"adopted", adopted}});
  out["absorption"] = json::array();
  for (const Absorption& a : r.likeness.absorption)
    out["absorption"].push_back({{"effect", a.effect},
                                 {"parameter", a.parameter},
                                 {"absorbed", value(a.absorbed)},
                                 {"nearest", a.nearest},
                                 {"correlation", value(a.likeness)}});
  out["null_vectors"] = json::array();
  for (const NullVector& v : r.likeness.null_vectors) {
    json weights = json::object();
    for (const auto& [effect, weight] : v.weights) weights[effect] = value(weight);
    out["null_vectors"].push_back({{"singular_value", value(v.singular)}, {"weights", weights}});
  }
  if (r.balance_before) {
    const auto one = [](const Balance& b) {
      return json{{"contact", value(b.contact)},
                  {"contact_freedom", b.contact_freedom},
                  {"inertia", value(b.inertia)},
                  {"inertia_freedom", b.inertia_freedom},
                  {"inertia_share", value(b.inertia_share())}};
    };
    out["balances"] = {{"before", one(*r.balance_before)}, {"after", one(*r.balance_after)}};
  }
  if (r.corrected) {
    json channels = json::array();
    for (std::size_t k = 0; k < r.channels.size(); ++k) {
      const Errors before = errors(r.corrected->rows, &UsedRow::before, k);
      channels.push_back({{"name", r.channels[k].name},
                          {"before_rmse", value(before.holdout_rmse)},
                          {"after_rmse", value(errors(r.corrected->rows, &UsedRow::after, k).holdout_rmse)},
                          {"rows", before.holdout}});
    }
    json by_shot = json::array();  // model minus measured
    for (const UsedRow& row : r.corrected->rows) {
      json shot{{"shot", row.id}};
      for (std::size_t k = 0; k < r.channels.size(); ++k)
        shot[r.channels[k].name] = {{"before", value(row.before[k])}, {"after", value(row.after[k])}};
      by_shot.push_back(std::move(shot));
    }
    out["corrected"] = {{"case", r.corrected->shots.empty() ? json(nullptr) : json("corrected/case.toml")},
                        {"channels", channels},
                        {"shots", by_shot},
                        {"not_in_the_case", r.corrected->instrument}};
  }
  out["notes"] = r.notes;
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
  // The root mean square of few values is beyond that by chance.
  const double chance =
      std::sqrt(quantile(boost::math::chi_squared(worst->after.holdout), 1 - kTold / 2) / worst->after.holdout);
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
