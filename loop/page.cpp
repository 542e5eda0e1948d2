#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hosel/loop/report.hpp"

namespace hosel::loop {
namespace {

/// Text as it may stand between tags and inside an attribute.
std::string escape(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '\'') out += "&#39;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

struct Point {
  double x, before, after;
  bool holdout;
};

/// Round steps of about a fifth of the range.
double tick(double range) {
  const double raw = range / 4, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double f : {1.0, 2.0, 5.0, 10.0})
    if (raw <= f * power) return f * power;
  return 10 * power;
}

/// Residual before (grey) and after (blue, holdout orange) against a regressor, the noise as a band.
std::string scatter(const std::vector<Point>& points, const std::string& x_label, const std::string& y_label,
                    double noise) {
  constexpr double w = 460, h = 270, left = 62, right = 12, top = 10, bottom = 44;
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y1 = 2.5 * noise;
  std::vector<double> sizes;
  for (const Point& p : points) {
    x0 = std::min(x0, p.x);
    x1 = std::max(x1, p.x);
    sizes.push_back(std::max(std::abs(p.before), std::abs(p.after)));
  }
  if (points.empty()) return "";
  std::ranges::sort(sizes);
  y1 = std::max(y1, 1.08 * sizes[std::size_t(0.99 * double(sizes.size() - 1))]);
  if (!(x1 > x0)) x1 = x0 + 1;
  const double margin = 0.03 * (x1 - x0);
  x0 -= margin;
  x1 += margin;
  const auto X = [&](double x) { return left + (x - x0) / (x1 - x0) * (w - left - right); };
  const auto Y = [&](double y) { return top + (y1 - std::clamp(y, -y1, y1)) / (2 * y1) * (h - top - bottom); };
  std::string s = fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{} against {}'>", w, h, escape(y_label),
                              escape(x_label));
  s += fmt::format("<rect class='band' x='{}' y='{:.1f}' width='{}' height='{:.1f}'/>", left, Y(noise),
                   w - left - right, Y(-noise) - Y(noise));
  const double dy = tick(2 * y1), dx = tick(x1 - x0);
  for (double y = std::ceil(-y1 / dy) * dy; y <= y1; y += dy)
    s += fmt::format(
        "<line class='grid' x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}'/><text x='{}' y='{:.1f}' "
        "text-anchor='end'>{:g}</text>",
        left, w - right, Y(y), Y(y), left - 6, Y(y) + 4, std::abs(y) < 1e-9 * dy ? 0.0 : y);
  for (double x = std::ceil(x0 / dx) * dx; x <= x1; x += dx)
    s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{:g}</text>", X(x), h - bottom + 16,
                     std::abs(x) < 1e-9 * dx ? 0.0 : x);
  const std::size_t step = std::max<std::size_t>(1, points.size() / 1500);
  for (std::size_t i = 0; i < points.size(); i += step)
    if (std::isfinite(points[i].before))
      s += fmt::format("<circle class='before' cx='{:.1f}' cy='{:.1f}' r='2.6'/>", X(points[i].x), Y(points[i].before));
  for (std::size_t i = 0; i < points.size(); i += step)
    if (std::isfinite(points[i].after))
      s += fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='2.6'/>", points[i].holdout ? "holdout" : "after",
                       X(points[i].x), Y(points[i].after));
  s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", (left + w - right) / 2, h - 8,
                   escape(x_label));
  s += fmt::format("<text transform='translate(13 {:.1f}) rotate(-90)' text-anchor='middle'>{}</text></svg>",
                   (top + h - bottom) / 2, escape(y_label));
  return s;
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : "–"; }

/// 95 % interval of a root mean square from n values.
std::string rms(double x, int n) {
  if (!std::isfinite(x)) return "–";
  if (n < 3) return number(x);
  const double half = 1.96 / std::sqrt(2.0 * n);
  return fmt::format("{} <small>({}–{})</small>", number(x), number(x * (1 - half)), number(x * (1 + half)));
}

/// Measured (dots), before (grey line) and after (blue line) over time: what a record looks like.
std::string history(const std::vector<double>& time, const std::vector<double>& measured,
                    const std::vector<double>& before, const std::vector<double>& after,
                    const std::vector<char>& holdout, const std::string& name) {
  constexpr double w = 960, h = 240, left = 62, right = 12, top = 10, bottom = 44;
  double y0 = std::numeric_limits<double>::infinity(), y1 = -y0;
  for (const double y : measured)
    if (std::isfinite(y)) {
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  if (!(y1 > y0) || time.size() < 2) return "";
  const double pad = 0.08 * (y1 - y0), x0 = time.front(), x1 = time.back();
  y0 -= pad;
  y1 += pad;
  const auto X = [&](double x) { return left + (x - x0) / (x1 - x0) * (w - left - right); };
  const auto Y = [&](double y) { return top + (y1 - std::clamp(y, y0, y1)) / (y1 - y0) * (h - top - bottom); };
  std::string s = fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{} over time'>", w, h, escape(name));
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!holdout[i]) continue;
    std::size_t j = i;
    while (j + 1 < time.size() && holdout[j + 1]) ++j;
    s += fmt::format("<rect class='band' x='{:.1f}' y='{}' width='{:.1f}' height='{:.1f}'/>", X(time[i]), top,
                     X(time[j]) - X(time[i]), h - top - bottom);
    i = j;
  }
  const double dy = tick(y1 - y0), dx = tick((x1 - x0) / 2);
  for (double y = std::ceil(y0 / dy) * dy; y <= y1; y += dy)
    s += fmt::format(
        "<line class='grid' x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}'/><text x='{}' y='{:.1f}' "
        "text-anchor='end'>{:g}</text>",
        left, w - right, Y(y), Y(y), left - 6, Y(y) + 4, std::abs(y) < 1e-9 * dy ? 0.0 : y);
  for (double x = std::ceil(x0 / dx) * dx; x <= x1; x += dx)
    s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{:g}</text>", X(x), h - bottom + 16,
                     std::abs(x) < 1e-9 * dx ? 0.0 : x);
  const std::size_t step = std::max<std::size_t>(1, time.size() / 1200);
  const auto line = [&](const std::vector<double>& y, const char* style) {
    std::string points;
    for (std::size_t i = 0; i < time.size(); i += step)
      if (std::isfinite(y[i])) points += fmt::format("{:.1f},{:.1f} ", X(time[i]), Y(y[i]));
    s += fmt::format("<polyline class='{}' points='{}'/>", style, points);
  };
  line(before, "line-before");
  for (std::size_t i = 0; i < time.size(); i += step)
    if (std::isfinite(measured[i]))
      s += fmt::format("<circle class='measured' cx='{:.1f}' cy='{:.1f}' r='1.7'/>", X(time[i]), Y(measured[i]));
  line(after, "line-after");
  s += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>time_s</text>", (left + w - right) / 2, h - 8);
  s += fmt::format("<text transform='translate(13 {:.1f}) rotate(-90)' text-anchor='middle'>{}</text></svg>",
                   (top + h - bottom) / 2, escape(name));
  return s;
}

/// Root mean square over the noise, before and after, with 95 % intervals; the noise itself is the dashed line at 1.
std::string bars(const std::vector<ChannelResult>& channels) {
  constexpr double w = 960, left = 170, right = 120, row = 46, top = 22;
  double most = 2;
  for (const ChannelResult& c : channels)
    for (const Errors* e : {&c.before, &c.after})
      if (std::isfinite(e->holdout_rmse) && c.noise > 0)  // room for the whisker
        most =
            std::max(most, (1 + (e->holdout > 2 ? 1.96 / std::sqrt(2.0 * e->holdout) : 0)) * e->holdout_rmse / c.noise);
  const bool wide = most > 12;  // then by powers of ten
  const auto X = [&](double x) {
    const double share = wide ? std::log10(std::max(x, 0.3) / 0.3) / std::log10(most / 0.3) : x / most;
    return left + share * (w - left - right);
  };
  const double h = top + row * double(channels.size()) + 26;
  std::string s = fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='errors before and after'>", w, h);
  s += fmt::format(
      "<line class='one' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2:.1f}'/><text x='{0:.1f}' y='{3}' "
      "text-anchor='middle'>the noise</text>",
      X(1), top - 4, h - 24, top - 8);
  double y = top;
  for (const ChannelResult& c : channels) {
    s += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>{}</text>", left - 10, y + 24, escape(c.name));
    const auto bar = [&](const Errors& e, const char* style, double at) {
      if (!std::isfinite(e.holdout_rmse) || !(c.noise > 0)) return;
      const double x = e.holdout_rmse / c.noise, half = e.holdout > 2 ? 1.96 / std::sqrt(2.0 * e.holdout) : 0;
      s += fmt::format("<rect class='{}' x='{}' y='{:.1f}' width='{:.1f}' height='14' rx='2'/>", style, left, at,
                       std::max(1.0, X(x) - left));
      s += fmt::format("<line class='whisker' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>",
                       X(x * std::max(0.0, 1 - half)), X(x * (1 + half)), at + 7, at + 7);
      s += fmt::format("<text x='{:.1f}' y='{:.1f}'>{:.3g}</text>", X(x * (1 + half)) + 6, at + 11.5, e.holdout_rmse);
    };
    bar(c.before, "before", y + 4);
    bar(c.after, "after", y + 22);
    y += row;
  }
  return s + fmt::format(
                 "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>held-out RMS in units of the noise{}</text></svg>",
                 (left + w - right) / 2, h - 6, wide ? " (logarithmic)" : "");
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

constexpr const char* kStyle =
    ":root{--ink:#1d2733;--soft:#5d6b7a;--rule:#e3e8ee;--blue:#1f5f99;--orange:#d9731a;--grey:#9aa5b1}"
    "body{font:15px/1.55 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;max-width:64rem;margin:0 "
    "auto;padding:2rem 1.25rem 4rem;color:var(--ink);background:#fff}"
    "h1{font-size:1.55rem;line-height:1.25;margin:0 0 .3rem}h2{font-size:1.12rem;margin:2.4rem 0 "
    ".5rem;padding-bottom:.25rem;border-bottom:1px solid var(--rule)}"
    ".lead{color:var(--soft);margin:.2rem 0 1.2rem}small,.soft{color:var(--soft)}p{margin:.5rem 0}"
    ".verdict{display:flex;gap:1rem;align-items:baseline;border-left:5px solid;padding:.8rem "
    "1.1rem;font-size:1.12rem;border-radius:0 6px 6px 0}"
    ".verdict b{white-space:nowrap;font-size:.95rem;text-transform:uppercase;letter-spacing:.04em}"
    ".good{background:#eaf6ee;border-color:#2e8b57}.good "
    "b{color:#21693f}.open{background:#fdf5e4;border-color:#c98a12}.open "
    "b{color:#8a5d07}.bad{background:#fbecea;border-color:#c0392b}.bad b{color:#96281b}"
    "table{border-collapse:collapse;margin:.6rem 0;font-variant-numeric:tabular-nums}td,th{padding:.28rem .8rem .28rem "
    "0;text-align:right;border-bottom:1px solid var(--rule);vertical-align:top}"
    "th{font-weight:600;color:var(--soft);font-size:.87rem}td:first-child,th:first-child,.l{text-align:left!important}"
    "tr.chosen td{background:#eef5fb;font-weight:600}.scroll{overflow-x:auto}"
    ".figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(26rem,1fr));gap:1rem}figure{margin:0}"
    "figcaption{font-size:.85rem;color:var(--soft)}"
    "svg{width:100%;height:auto;display:block}svg "
    "text{font-size:12px;fill:#3b4754}.grid{stroke:#e8ecf0}.band{fill:#f4efe1}.before{fill:var(--grey);opacity:.65}."
    "after{fill:var(--blue);opacity:.85}"
    ".holdout{fill:var(--orange);opacity:.9}.one{stroke:#a07c1c;stroke-dasharray:4 "
    "3}.whisker{stroke:#1d2733;stroke-width:1.4}.line-before{fill:none;stroke:var(--grey);stroke-width:1.4}"
    ".line-after{fill:none;stroke:var(--blue);stroke-width:1.4}.measured{fill:#222;opacity:.45}"
    ".key i{display:inline-block;width:.75em;height:.75em;border-radius:50%;margin:0 .3em 0 "
    ".9em;vertical-align:baseline}"
    "@media print{body{padding:0}h2{break-after:avoid}figure,table{break-inside:avoid}}";

}  // namespace

std::string page(const LoopResult& r, const Shots& shots) {
  const Column* time = shots.find("time_s");
  const bool records = time && shots.find("record");
  const char* thing = records ? "samples" : "shots";
  const Selection& sel = r.selection;
  std::string s =
      "<!doctype html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
      "content='width=device-width'><title>" +
      escape(r.title) + "</title><style>" + kStyle + "</style></head><body>";
  s += fmt::format(
      "<h1>{}</h1><p class='lead'>Base model <b>{}</b>. {} {} read, {} used: {} to learn from, {} held out (seed {}). "
      "{} flagged.</p>",
      escape(r.title.empty() ? "Measurement against a model" : r.title), escape(r.base), r.read, thing, r.used, r.train,
      r.holdout, r.seed, r.flagged.size());
  s += fmt::format("<p class='verdict {}'><b>{}</b><span>{}</span></p>", mood(r.verdict), name(r.verdict),
                   escape(sentence(r)));

  s += "<h2>Before and after</h2>";
  if (!r.channels.empty()) s += "<figure>" + bars(r.channels) + "</figure>";
  s += "<div class='scroll'><table><tr><th>channel<th>noise<th>scatter / noise<th>held out: RMS before<th>RMS "
       "after<th>bias before<th>bias after</tr>";
  for (const ChannelResult& c : r.channels)
    s += fmt::format("<tr><td>{}<td>{} <small>{}</small><td>{}<td>{}<td>{}<td>{}<td>{}</tr>", escape(c.name),
                     number(c.noise), c.noise_source, number(c.scatter), rms(c.before.holdout_rmse, c.before.holdout),
                     rms(c.after.holdout_rmse, c.after.holdout), number(c.before.holdout_bias),
                     number(c.after.holdout_bias));
  s += "</table></div><p><small>Residual is model minus measured; 95 % intervals in brackets and as "
       "whiskers.</small></p>";
  if (r.balance_before) {
    const Balance &b = *r.balance_before, &a = *r.balance_after;
    s += "<h2>Contact, or kinematics and inertia?</h2><p>Whatever the contact, one impulse must give the ball both its "
         "velocity and its spin. What some impulse mends is a matter of the "
         "contact; what none mends contradicts the recorded kinematics or the ball's inertia.</p><table><tr><th>sum of "
         "squares over what noise alone gives<th>before<th>after</tr>";
    const auto ratio = [](double x, int n) {
      return n ? fmt::format("{:.2f} <small>({} values)</small>", x / n, n) : std::string("–");
    };
    s += fmt::format(
        "<tr><td>mended by an impulse: contact<td>{}<td>{}</tr><tr><td>mended by none: kinematics, "
        "inertia<td>{}<td>{}</tr></table>",
        ratio(b.contact, b.contact_freedom), ratio(a.contact, a.contact_freedom), ratio(b.inertia, b.inertia_freedom),
        ratio(a.inertia, a.inertia_freedom));
    s += fmt::format("<p>Of the base's excess over the noise, {:.0f} % no contact law can mend.</p>",
                     100 * b.inertia_share());
  }

  if (records && !r.shots.empty()) {
    s += "<h2>Records</h2><p class='key'><small><i style='background:#222'></i>measured<i "
         "style='background:var(--grey)'></i>before<i style='background:var(--blue)'></i>after"
         "<i style='background:#f4efe1'></i>held out</small></p>";
    const Column* record = shots.find("record");
    std::vector<std::string> names;
    for (const std::string& n : record->text)
      if (std::ranges::find(names, n) == names.end() && names.size() < 4) names.push_back(n);
    for (const std::string& n : names)
      for (std::size_t c = 0; c < r.channels.size(); ++c) {
        std::vector<double> t, y, b, a;
        std::vector<char> held;
        for (const UsedShot& u : r.shots) {
          if (record->text[std::size_t(u.row)] != n) continue;
          t.push_back(time->native(std::size_t(u.row)));
          y.push_back(u.measured[c]);
          b.push_back(u.measured[c] + u.before[c]);
          a.push_back(u.measured[c] + u.after[c]);
          held.push_back(u.holdout);
        }
        s += "<figure>" + history(t, y, b, a, held, r.channels[c].name) +
             (names.size() > 1 ? "<figcaption>" + escape(n) + "</figcaption>" : "") + "</figure>";
      }
  }

  s += "<h2>Residuals</h2><p class='key'><small><i style='background:var(--grey)'></i>before<i "
       "style='background:var(--blue)'></i>after, learnt from"
       "<i style='background:var(--orange)'></i>after, held out<i style='background:#f4efe1'></i>one standard "
       "deviation of the noise</small></p><div class='figures'>";
  for (std::size_t c = 0; c < r.channels.size(); ++c) {
    // Against the columns that the structure follows most.
    std::vector<std::string> columns;
    for (const Finding& f : sel.before.findings) {
      if (f.channel != int(c) || f.regressor < 0 || std::size_t(f.regressor) >= sel.regressors.size()) continue;
      const Column* k = shots.find(sel.regressors[std::size_t(f.regressor)].column);
      if (k && k->numeric && std::ranges::find(columns, k->name) == columns.end()) columns.push_back(k->name);
      if (columns.size() == 2) break;
    }
    if (columns.empty())
      if (const Column* loft = shots.find_stem("dynamic_loft")) columns.push_back(loft->name);
    for (const std::string& column : columns) {
      const Column* k = shots.find(column);
      std::vector<Point> points;
      for (const UsedShot& u : r.shots)
        if (const double x = k->native(std::size_t(u.row)); std::isfinite(x))
          points.push_back({x, u.before[c], u.after[c], u.holdout});
      s += "<figure>" + scatter(points, column, r.channels[c].name + ": model − measured", r.channels[c].noise) +
           "</figure>";
    }
  }
  s += "</div>";

  s += "<h2>Candidates</h2><div class='scroll'><table><tr><th>effects<th class='l'>parameters<th>deviance falls "
       "by<th>held-out score</tr>";
  s += fmt::format("<tr><td>base alone<td class='l'>–<td>0<td>{}</tr>", number(r.base_score));
  for (std::size_t i = 0; i < std::min<std::size_t>(12, r.candidates.size()); ++i) {
    const ScoredCandidate& c = r.candidates[i];
    std::string parameters;
    const auto list = c.candidate.fit.model.parameters();
    for (std::size_t k = 0; k < list.size(); ++k)
      parameters += fmt::format("{}{} = {} ± {} {}", k ? "; " : "", list[k]->name,
                                number(c.candidate.fit.p[std::ptrdiff_t(k)] / list[k]->si),
                                number(c.sd[k] / list[k]->si), list[k]->unit == "1" ? "" : list[k]->unit);
    const bool chosen = !r.adopted.empty() && c.candidate.effects == r.adopted;
    s += fmt::format("<tr{}><td>{}<td class='l'>{}<td>{}<td>{}</tr>", chosen ? " class='chosen'" : "",
                     escape(fmt::format("{}", fmt::join(c.candidate.effects, " + "))), escape(parameters),
                     number(sel.base.deviance - c.candidate.fit.deviance), number(c.holdout_score));
  }
  s += "</table></div><p><small>Each at its own optimum on the training part; the score is the mean log predictive "
       "density per held-out value.</small></p>";
  if (!r.ties.empty()) {
    s += "<p><b>Tied:</b> ";
    for (const auto& t : r.ties) s += escape(fmt::format("{}. ", fmt::join(t, " or ")));
    s += "</p>";
  }
  if (!r.likeness.absorption.empty()) {
    s += "<h2>What looks alike</h2><div class='scroll'><table><tr><th>effect<th class='l'>parameter<th>absorbed by "
         "what is fitted<th class='l'>most like<th>correlation</tr>";
    for (const Absorption& a : r.likeness.absorption)
      s += fmt::format("<tr><td>{}<td class='l'>{}<td>{:.1f} %<td class='l'>{}<td>{}</tr>", escape(a.effect),
                       escape(a.parameter), 100 * a.absorbed, escape(a.nearest),
                       a.nearest.empty() ? std::string("–") : fmt::format("{:+.3f}", a.likeness));
    s += "</table></div>";
    if (!r.likeness.null_vectors.empty()) {
      s += "<p>Together these effects leave almost no trace (singular value of the whitened Jacobian, columns of unit "
           "length):</p><ul>";
      for (const NullVector& v : r.likeness.null_vectors) {
        std::string sum;
        for (const auto& [effect, weight] : v.weights)
          sum += fmt::format("{}{:.2f} {}", sum.empty() ? "" : weight < 0 ? " − " : " + ", std::abs(weight), effect);
        s += fmt::format("<li>{} <small>({:.1e})</small>", escape(sum), v.singular);
      }
      s += "</ul>";
    }
  }
  if (!r.unexplained.empty()) {
    s += "<h2>Unexplained</h2><ul>";
    for (const Location& l : r.unexplained)
      s += fmt::format("<li>{} against {} <small>({})</small>", escape(l.channel), escape(l.regressor),
                       escape(l.detail));
    s += "</ul>";
  }
  if (!r.derived.empty()) {
    s += "<h2>Columns that are not measurements</h2><ul>";
    for (const DerivedColumn& d : r.derived)
      s += fmt::format("<li><b>{}</b> = {} <small>(residual {}, recording step {}, {} rows)</small>", escape(d.column),
                       escape(d.formula), number(d.residual_sd), number(d.recording_resolution), d.rows);
    s += "</ul>";
  }
  if (!r.flagged.empty()) {
    s += fmt::format(
        "<h2>Flagged {}</h2><div class='scroll'><table><tr><th>{}<th class='l'>column<th "
        "class='l'>reason<th>finding</tr>",
        thing, records ? "sample" : "shot");
    for (std::size_t i = 0; i < std::min<std::size_t>(r.flagged.size(), 200); ++i)
      s += fmt::format("<tr><td>{}<td class='l'>{}<td class='l'>{}<td>{}</tr>", escape(r.flagged[i].shot),
                       escape(r.flagged[i].column), escape(r.flagged[i].reason), r.flagged[i].finding);
    s += "</table></div>";
    if (r.flagged.size() > 200)
      s += fmt::format("<p><small>and {} more, in report.json</small></p>", r.flagged.size() - 200);
  }
  s += "<h2>What to measure next</h2><p>" + escape(r.next.text) + ".</p>";
  if (!r.next.shots.empty()) {
    s += "<div class='scroll'><table><tr>";
    for (const auto& [header, x] : r.next.shots[0].inputs) s += "<th>" + escape(header);
    s += "</tr>";
    for (const DesignedShot& d : r.next.shots) {
      s += "<tr>";
      for (const auto& [header, x] : d.inputs) s += "<td>" + number(x);
      s += "</tr>";
    }
    s += "</table></div>";
  }
  s += fmt::format(
      "<h2>Smallest effect that these {} would show</h2><table><tr><th>effect<th class='l'>parameter<th>value</tr>",
      thing);
  for (const Detectable& d : r.minimum_detectable)
    s += fmt::format("<tr><td>{}<td class='l'>{}<td>{} {}</tr>", escape(d.effect), escape(d.parameter),
                     std::isfinite(d.value) ? number(d.value) : std::string("beyond its plausible range"),
                     std::isfinite(d.value) && d.unit != "1" ? d.unit : "");
  s += "</table>";
  if (!r.notes.empty() || !r.unused.empty()) {
    s += "<h2>Notes</h2><ul>";
    for (const auto& [reason, n] : r.unused) s += fmt::format("<li>{} rows not used: {}", n, escape(reason));
    for (const std::string& n : r.notes) s += "<li>" + escape(n);
    s += "</ul>";
  }
  return s + "</body></html>\n";
}

}  // namespace hosel::loop
