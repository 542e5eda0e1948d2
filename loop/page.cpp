#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <utility>

#include "loop/report.hpp"
#include "loop/rules.hpp"
#include "post/digits.hpp"
#include "post/html.hpp"
#include "post/labels.hpp"
#include "post/svg.hpp"

namespace hosel::loop {
namespace {

using post::escape_html;

/// Residual before (grey) and after (blue, holdout orange) against a column, the noise as a band.
std::string scatter(const LoopResult& r, std::size_t channel, const Column& column) {
  post::SvgSeries before{"before", {}, {}, 2.6}, after{"after", {}, {}, 2.6}, holdout{"holdout", {}, {}, 2.6};
  double x0 = kInfinity, x1 = -x0;
  std::vector<double> sizes;
  for (const UsedRow& u : r.rows) {
    const double x = column.native(std::size_t(u.row));
    if (!std::isfinite(x) || !std::isfinite(u.before[channel]) || !std::isfinite(u.after[channel])) continue;
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    sizes.push_back(std::max(std::abs(u.before[channel]), std::abs(u.after[channel])));
    before.x.push_back(x);
    before.y.push_back(u.before[channel]);
    post::SvgSeries& set = u.holdout ? holdout : after;
    set.x.push_back(x);
    set.y.push_back(u.after[channel]);
  }
  if (sizes.empty()) return "";
  std::ranges::sort(sizes);
  const double noise = r.channels[channel].noise, y1 = std::max(2.5 * noise, 1.08 * at_share(sizes, 0.99));
  if (!(x1 > x0)) x1 = x0 + 1;
  const double margin = 0.03 * (x1 - x0);
  x0 -= margin;
  x1 += margin;
  const std::string label = "model − measured " + post::label(r.channels[channel].name);
  post::SvgPlot plot{460, 270, x0, x1, -y1, y1, post::label(column.name), label};
  plot.told = label + " against " + post::label(column.name);
  plot.bands = {{x0, x1, -noise, noise}};
  plot.series = {before, after, holdout};
  return svg(plot);
}

/// What the words above it mean.
std::string gloss(std::string_view text) { return fmt::format("<p><small>{}</small></p>", text); }

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : "–"; }

/// 95 % interval of a root mean square from n independent normal values; the value itself of fewer than three.
std::pair<double, double> interval(double x, int n) {
  if (n < 3) return {x, x};
  const boost::math::chi_squared law(n);
  return {x * std::sqrt(n / quantile(law, 1 - kTold / 2)), x * std::sqrt(n / quantile(law, kTold / 2))};
}

std::string rms(double x, int n) {
  if (!std::isfinite(x)) return "–";
  if (n < 3) return number(x);
  const auto [low, high] = interval(x, n);
  return fmt::format("{} <small>({}–{})</small>", number(x), number(low), number(high));
}

/// Measured (dots), before (grey line) and after (blue line) over time, held-out stretches shaded: what a record looks
/// like.
std::string history(const LoopResult& r, std::size_t channel, const Shots& table, const std::string& name) {
  const Column *time = table.find("time_s"), *record = table.find("record");
  post::SvgSeries measured{"measured", {}, {}, 1.7}, before{"line-before", {}, {}}, after{"line-after", {}, {}};
  std::vector<std::pair<double, double>> held;
  double y0 = kInfinity, y1 = -y0;
  bool open = false;
  for (const UsedRow& u : r.rows) {
    if (record->text[u.row] != name) continue;
    const double t = time->native(std::size_t(u.row)), y = u.measured[channel];
    if (u.holdout && !open) held.emplace_back(t, t);
    if (u.holdout) held.back().second = t;
    open = u.holdout;
    if (std::isfinite(y)) {
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
    for (post::SvgSeries* s : {&measured, &before, &after}) s->x.push_back(t);
    measured.y.push_back(y);
    before.y.push_back(y + u.before[channel]);
    after.y.push_back(y + u.after[channel]);
  }
  if (!(y1 > y0) || measured.x.size() < 2) return "";
  const double pad = 0.08 * (y1 - y0);
  y0 -= pad;
  y1 += pad;
  const std::string label = post::label(r.channels[channel].name);
  post::SvgPlot plot{960, 240, measured.x.front(), measured.x.back(), y0, y1, "time [s]", label, label + " over time"};
  plot.series = {before, measured, after};
  for (const auto& [from, to] : held) plot.bands.push_back({from, to, y0, y1});
  return svg(plot);
}

/// Held-out root mean square over the noise of readings and inputs, before, after and with the remainder where it is
/// `smooth`, with 95 % intervals; the noise itself is the line at 1.
std::string bars(const std::vector<ChannelResult>& channels, bool smooth) {
  post::SvgBars picture{
      "errors before and after", "the noise", "held-out RMS in units of the noise of readings and inputs", {}};
  std::vector<std::pair<Errors ChannelResult::*, const char*>> stages{{&ChannelResult::before, "before"},
                                                                      {&ChannelResult::after, "after"}};
  if (smooth) stages.emplace_back(&ChannelResult::with_remainder, "remainder");
  for (const ChannelResult& c : channels) {
    picture.rows.push_back({post::label(c.name), {}});
    const double noise = c.expected > 0 ? c.expected : c.noise;
    for (const auto& [stage, style] : stages)
      if (const Errors& e = c.*stage; std::isfinite(e.holdout_rmse) && noise > 0) {
        const double ratio = e.holdout_rmse / noise;
        const auto [low, high] = interval(ratio, e.holdout);
        picture.rows.back().bars.push_back({style, ratio, low, high, fmt::format("{:.4g}", e.holdout_rmse)});
      }
    if (picture.rows.back().bars.empty()) picture.rows.pop_back();  // nothing of it is held out
  }
  return svg(picture);
}

/// The remainder: where, how large, along which column.
std::string without_name(const LoopResult& r) {
  std::string s =
      "<h2>What has no name</h2><div class='scroll'><table><tr><th>channel<th>RMS<th class='l'>along<th>share of it "
      "that goes with that column<th>largest<th>there</tr>";
  for (const Remainder::Place& p : r.remainder->places)
    s += fmt::format("<tr><td>{}<td>{}<td class='l'>{}<td>{:.0f} %<td>{}<td>{}</tr>",
                     escape_html(post::label(r.channel_names[p.channel])), number(p.size),
                     p.share < 0.005 ? "no column: nearly a constant" : escape_html(post::label(p.along)),
                     100 * p.share, number(p.largest), number(p.at));
  return s + "</table></div>" +
         gloss(
             "What is left of the residual follows the inputs as a smooth function (a Gaussian process) that no effect "
             "of the library is: learnt from the rows to learn from, it corrects the prediction of the others.");
}

/// How far groups differ.
std::string between_groups(const LoopResult& r) {
  std::string s =
      "<h2>How groups differ</h2><div class='scroll'><table><tr><th>groups<th class='l'>of<th class='l'>what "
      "differs<th>standard deviation between groups<th>95 %<th>p</tr>";
  for (const GroupSpread& g : r.groups)
    s += fmt::format("<tr><td>{}<td class='l'>{}<td class='l'>{}<td>{}<td>{} to {}<td>{}</tr>", g.groups,
                     escape_html(g.along == "shot" ? "stretches of the session" : g.along),
                     escape_html(g.unit == "1" ? post::spoken(g.of) : "reading of " + post::label(g.of)), number(g.sd),
                     number(g.low), number(g.high),
                     g.p < kByChance ? fmt::format("&lt; {}", kByChance) : fmt::format("{:.3f}", g.p));
  return s + "</table></div>" +
         gloss(
             "What the corrected model leaves, put down to one quantity at a time, whose value differs from group to "
             "group of five shots or more: heads, balls and players that the data do not tell apart otherwise. Several "
             "rows may show one "
             "cause: a restitution that differs moves the reading of ball speed too. p: chance of as large a "
             "difference "
             "between groups that are alike.");
}

const char* mood(Verdict v) {
  switch (v) {
    case Verdict::no_residual:
    case Verdict::explained: return "good";
    case Verdict::ambiguous:
    case Verdict::insufficient: return "open";
    case Verdict::unexplained:
    case Verdict::noise_contradicted: return "bad";
  }
  return "";
}

}  // namespace

std::string page(const LoopResult& r, const Shots& table) {
  const Column* time = table.find("time_s");
  const bool records = time && table.find("record");
  const char* thing = records ? "samples" : "shots";
  const Selection& sel = r.selection;
  const bool folds = r.train + r.holdout > r.used;
  std::string s =
      fmt::format("<p class='lead'>Base model <b>{}</b>. {} {} read, {} used, {} (seed {}). {} flagged.</p>",
                  escape_html(r.base), r.read, thing, r.used,
                  folds ? "each held out once" : fmt::format("{} to learn from and {} held out", r.train, r.holdout),
                  r.seed, r.flagged.size());
  s += fmt::format("<p class='verdict {}'><b>{}</b><span>{}</span></p>", mood(r.verdict), name(r.verdict),
                   escape_html(sentence(r)));

  const bool smooth = r.remainder && !r.remainder->places.empty();
  s += "<h2>Before and after</h2>";
  if (!r.channels.empty())
    s += fmt::format(
        "<p class='key'><small><i style='background:var(--grey)'></i>before<i "
        "style='background:var(--blue)'></i>after{}</small></p>"
        "<figure class='wide'>{}</figure>",
        smooth ? "<i style='background:var(--green)'></i>after, remainder taken away" : "", bars(r.channels, smooth));
  if (const std::vector<std::string> tied = tied_in_after(r); !tied.empty())
    s += gloss(fmt::format("After: with {}{}, which {} tied.", r.adopted.empty() ? "" : "what was adopted and ",
                           fmt::join(tied, " and "), tied.size() > 1 ? "are" : "is"));
  s += "<div class='scroll'><table><tr><th>channel<th>noise<th>scatter / noise";
  s += "<th>held out: RMS by noise<th>RMS before<th>RMS after";
  s += smooth ? "<th>RMS after, remainder taken away" : "";
  s += "<th>bias before<th>bias after</tr>";
  for (const ChannelResult& c : r.channels)
    s += fmt::format("<tr><td>{}<td>{} <small>{}</small><td>{}<td>{}<td>{}<td>{}{}<td>{}<td>{}</tr>",
                     escape_html(post::label(c.name)), number(c.noise), c.noise_source, number(c.scatter),
                     number(c.expected), rms(c.before.holdout_rmse, c.before.holdout),
                     rms(c.after.holdout_rmse, c.after.holdout),
                     smooth ? "<td>" + rms(c.with_remainder.holdout_rmse, c.with_remainder.holdout) : "",
                     number(c.before.holdout_bias), number(c.after.holdout_bias));
  s += "</table></div>";
  s += gloss(
      "Residual: model minus measured. Noise: standard deviation of one reading: as declared, measured from the "
      "readings' own spread, or (repeats) from the rows whose mean a reading is. Scatter / noise: the scatter about "
      "the fit, divided by that noise; it is 1 where both are right. Held out: rows that no fit saw. RMS: root mean "
      "square of the residuals, its 95 % interval in brackets and as whiskers; by noise: what the noise of readings "
      "and of inputs makes of it about the right model. Bias: their mean.");
  if (smooth) s += without_name(r);
  if (!r.groups.empty()) s += between_groups(r);
  if (r.corrected && !r.corrected->rows.empty()) {
    const auto& rows = r.corrected->rows;
    s += fmt::format(
        "<h2>By the base model itself</h2><p>{}, no surrogate between, asked about {} of the held-out shots as it was "
        "declared and with the adopted effects in it:</p><div class='scroll'><table><tr><th>channel<th>RMS "
        "before<th>RMS after<th>shots with both answers</tr>",
        escape_html(r.base), rows.size());
    for (std::size_t c = 0; c < r.channels.size(); ++c) {
      const Errors before = errors(rows, &UsedRow::before, c), after = errors(rows, &UsedRow::after, c);
      s += fmt::format("<tr><td>{}<td>{}<td>{}<td>{}</tr>", escape_html(post::label(r.channels[c].name)),
                       number(before.holdout_rmse), number(after.holdout_rmse), before.holdout);
    }
    s += "</table></div><p><small>corrected/ beside this page is a case: those shots, the corrected model, what was "
         "measured.</small></p>";
  }
  if (r.balance_before) {
    const Balance &b = *r.balance_before, &a = *r.balance_after;
    s += "<h2>Contact, or kinematics and inertia?</h2><p>Whatever the contact, one impulse gives the ball both its "
         "velocity and its spin. An error that another impulse would remove comes from the contact law. An error that "
         "no impulse removes comes from the recorded motion of the head or from the ball's inertia.</p><div "
         "class='scroll'><table><tr><th>mean square of the errors, in noise units<th>before<th>after</tr>";
    const auto ratio = [](double x, int n) {
      return n ? fmt::format("{:.2f} <small>({} values)</small>", x / n, n) : std::string("–");
    };
    s += fmt::format(
        "<tr><td>contact: an impulse removes it<td>{}<td>{}</tr><tr><td>motion of the head, inertia: none removes "
        "it<td>{}<td>{}</tr></table></div>",
        ratio(b.contact, b.contact_freedom), ratio(a.contact, a.contact_freedom), ratio(b.inertia, b.inertia_freedom),
        ratio(a.inertia, a.inertia_freedom));
    if (const int freedom = b.contact_freedom + b.inertia_freedom;
        r.verdict != Verdict::no_residual && freedom > 0 &&
        cdf(complement(boost::math::chi_squared(freedom), b.contact + b.inertia)) < kTold)
      s += fmt::format(
          "<p>The base model's error is larger than the noise. Of that excess {:.0f} % is motion of the head or "
          "inertia, whatever the contact law.</p>",
          100 * b.inertia_share());
  }

  if (records && !r.rows.empty()) {
    s += "<h2>Records</h2><p class='key'><small><i style='background:var(--ink)'></i>measured<i "
         "style='background:var(--grey)'></i>before<i style='background:var(--blue)'></i>after<i "
         "style='background:var(--band)'></i>held out</small></p>";
    std::vector<std::string> names;
    for (const std::string& n : table.find("record")->text)
      if (std::ranges::find(names, n) == names.end() && names.size() < kMostTold) names.push_back(n);
    for (const std::string& n : names)
      for (std::size_t c = 0; c < r.channels.size(); ++c)
        s += "<figure>" + history(r, c, table, n) +
             (names.size() > 1 ? "<figcaption>" + escape_html(n) + "</figcaption>" : "") + "</figure>";
  }

  s += "<h2>Residuals</h2><p class='key'><small><i style='background:var(--grey)'></i>before<i "
       "style='background:var(--blue)'></i>after, learnt from<i style='background:var(--orange)'></i>after, held out<i "
       "style='background:var(--band)'></i>one standard deviation of the noise</small></p><div class='figures'>";
  for (std::size_t c = 0; c < r.channels.size(); ++c) {
    // Against the columns that the structure follows most.
    std::vector<std::string> columns;
    for (const Finding& f : sel.before.findings) {
      if (f.channel != int(c)) continue;
      const Column* k = table.find(f.regressor);
      if (k && k->numeric && std::ranges::find(columns, k->name) == columns.end()) columns.push_back(k->name);
      if (columns.size() == 2) break;
    }
    if (columns.empty())
      if (const Column* loft = table.find_stem("dynamic_loft")) columns.push_back(loft->name);
    for (const std::string& column : columns) s += "<figure>" + scatter(r, c, *table.find(column)) + "</figure>";
  }
  s += "</div>";

  s += "<h2>Candidates</h2><div class='scroll'><table><tr><th>effects<th class='l'>parameters<th>deviance falls "
       "by<th>held-out score</tr>";
  s += fmt::format("<tr><td>base alone<td class='l'>–<td>0<td>{}</tr>", number(r.base_score));
  for (std::size_t i = 0; i < std::min<std::size_t>(12, r.candidates.size()); ++i) {
    const ScoredCandidate& c = r.candidates[i];
    std::string parameters;
    const auto list = c.candidate.fit.model.parameters();
    for (std::size_t k = 0; k < list.size(); ++k) {
      const double at = c.candidate.fit.p[std::ptrdiff_t(k)], si = list[k]->si;
      parameters += fmt::format(
          "{}{} = {} {}{}", k ? "; " : "", post::spoken(list[k]->name), post::with_deviation(at / si, c.sd[k] / si),
          list[k]->unit == "1" ? "" : post::symbol(list[k]->unit), list[k]->at_edge(at) ? " (at its bound)" : "");
    }
    const bool chosen = !r.adopted.empty() && c.candidate.effects == r.adopted;
    s += fmt::format("<tr{}><td>{}<td class='l'>{}<td>{}<td>{}</tr>", chosen ? " class='chosen'" : "",
                     escape_html(fmt::format("{}", fmt::join(c.candidate.effects, " + "))), escape_html(parameters),
                     number(sel.base.deviance - c.candidate.fit.deviance), number(c.holdout_score));
  }
  s += "</table></div>";
  s += gloss(
      "Each at its own optimum on the rows to learn from. Deviance: twice the negative logarithm of the likelihood; a "
      "fall of 1 is one squared noise unit explained. Score: mean log predictive density per held-out value, higher is "
      "better. ±: one standard deviation.");
  if (!r.ties.empty()) {
    s += "<p><b>Tied:</b> ";
    for (const auto& t : r.ties) s += escape_html(fmt::format("{}. ", fmt::join(t, " or ")));
    s += "</p>" +
         gloss("Tied: these data cannot tell which of them acts. Under What to measure next stands what would tell.");
  }
  if (!r.likeness.absorption.empty()) {
    s += "<h2>What looks alike</h2><div class='scroll'><table><tr><th>effect<th class='l'>parameter<th>share that the "
         "fitted effects imitate<th class='l'>most like<th>correlation</tr>";
    for (const Absorption& a : r.likeness.absorption)
      s += fmt::format("<tr><td>{}<td class='l'>{}<td>{:.1f} %<td class='l'>{}<td>{}</tr>", escape_html(a.effect),
                       escape_html(post::spoken(a.parameter)), 100 * a.absorbed, escape_html(a.nearest),
                       a.nearest.empty() ? std::string("–") : fmt::format("{:+.3f}", a.likeness));
    s += "</table></div>" + gloss(
                                "An effect changes the predictions in a pattern. The share is how much of that pattern "
                                "the fitted effects can make as well. What they leave of it is compared with what they "
                                "leave of the others: the most alike, and their correlation.");
    if (!r.likeness.null_vectors.empty()) {
      s += "<p>These sums of effects change the predictions by almost nothing. In brackets: the singular value of the "
           "Jacobian, in noise units, its columns of unit length.</p><ul>";
      for (const NullVector& v : r.likeness.null_vectors) {
        std::string sum;
        for (const auto& [effect, weight] : v.weights)
          sum += fmt::format("{}{:.2f} {}", sum.empty() ? "" : weight < 0 ? " − " : " + ", std::abs(weight), effect);
        s += fmt::format("<li>{} <small>({:.1e})</small>", escape_html(sum), v.singular);
      }
      s += "</ul>";
    }
  }
  if (!r.unexplained.empty()) {
    s += "<h2>Unexplained</h2><ul>";
    for (const Location& l : r.unexplained)
      if (l.channel.empty() || l.regressor.empty())
        s += fmt::format("<li>{}{}", escape_html(l.channel.empty() ? "" : l.channel + ": "), escape_html(l.detail));
      else if (l.regressor == "constant") s += "<li>" + escape_html(off_in_the_mean(l, r));
      else
        s += fmt::format("<li>{} against {} <small>({})</small>", escape_html(l.channel), escape_html(l.regressor),
                         escape_html(l.detail));
    s += "</ul>";
  }
  if (!r.derived.empty()) {
    s += "<h2>Columns that are not measurements</h2>" +
         gloss("Computed from other columns, by the instrument or afterwards: no independent evidence.") + "<ul>";
    for (const DerivedColumn& d : r.derived)
      s += fmt::format("<li><b>{}</b> = {} <small>(residual {}, recording step {}, {} rows)</small>",
                       escape_html(d.column), escape_html(d.formula), number(d.residual_sd),
                       number(d.recording_resolution), d.rows);
    s += "</ul>";
  }
  if (!r.flagged.empty()) {
    s += fmt::format(
        "<h2>Flagged {}</h2><div class='scroll'><table><tr><th>{}<th class='l'>column<th "
        "class='l'>reason<th>finding</tr>",
        thing, records ? "sample" : "shot");
    constexpr std::size_t most = 200;
    for (std::size_t i = 0; i < std::min(r.flagged.size(), most); ++i)
      s += fmt::format("<tr><td>{}<td class='l'>{}<td class='l'>{}<td>{}</tr>", escape_html(r.flagged[i].id),
                       escape_html(r.flagged[i].column), escape_html(r.flagged[i].reason), r.flagged[i].finding);
    s += "</table></div>" + gloss(
                                "Flagged: contradicts the other rows and is left out of every fit. Finding: rows with "
                                "one cause have one number.");
    if (r.flagged.size() > most)
      s += fmt::format("<p><small>and {} more, in report.json</small></p>", r.flagged.size() - most);
  }
  s += "<h2>What to measure next</h2><p>" + escape_html(r.next.text) + ".</p>";
  if (!r.next.shots.empty()) {
    s += "<div class='scroll'><table><tr><th>shots";
    for (const auto& [header, x] : r.next.shots[0]) s += "<th>" + escape_html(post::label(header));
    s += "</tr>";
    std::vector<std::pair<std::string, int>> kinds;  // a kind of shot as its row, how many
    for (const DesignedShot& d : r.next.shots) {
      std::string row;
      for (const auto& [header, x] : d) row += "<td>" + number(x);
      const auto at = std::ranges::find(kinds, row, &std::pair<std::string, int>::first);
      if (at == kinds.end()) kinds.emplace_back(row, 1);
      else ++at->second;
    }
    for (const auto& [row, times] : kinds) s += fmt::format("<tr><td>{} x{}</tr>", times, row);
    s += "</table></div>";
  }
  s += fmt::format(
      "<h2>Smallest effect that these {} would show</h2><div class='scroll'><table><tr><th>effect<th "
      "class='l'>parameter<th>value</tr>",
      thing);
  for (const Detectable& d : r.minimum_detectable)
    s += fmt::format("<tr><td>{}<td class='l'>{}<td>{} {}</tr>", escape_html(d.effect),
                     escape_html(post::spoken(d.parameter)),
                     std::isfinite(d.value) ? number(d.value) : std::string("beyond its plausible range"),
                     std::isfinite(d.value) && d.unit != "1" ? post::symbol(d.unit) : "");
  s += "</table></div>" + gloss(
                              "An effect of this size would be seen in nine of ten such data sets: adopted, or in a "
                              "tie with what acts alike.");
  if (!r.notes.empty() || !r.unused.empty()) {
    s += "<h2>Notes</h2><ul>";
    for (const auto& [reason, n] : r.unused) s += fmt::format("<li>{} rows not used: {}", n, escape_html(reason));
    for (const std::string& n : r.notes) s += "<li>" + escape_html(n);
    s += "</ul>";
  }
  return s;
}

}  // namespace hosel::loop
