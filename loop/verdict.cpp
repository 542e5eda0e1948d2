#include "hosel/loop/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "hosel/loop/alike.hpp"
#include "hosel/loop/experiment.hpp"
#include "hosel/loop/scatter.hpp"

namespace hosel::loop {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Errors errors(const Rows& rows, int channel, const Eigen::MatrixXd& residuals) {
  Errors e;
  double train = 0, hold = 0, bias = 0;
  for (const int i : rows.train)
    if (const double r = residuals(i, channel); std::isfinite(r)) {
      train += r * r;
      ++e.train;
    }
  for (const int i : rows.holdout)
    if (const double r = residuals(i, channel); std::isfinite(r)) {
      hold += r * r;
      bias += r;
      ++e.holdout;
    }
  e.train_rmse = e.train ? std::sqrt(train / e.train) : kNaN;
  e.holdout_rmse = e.holdout ? std::sqrt(hold / e.holdout) : kNaN;
  e.holdout_bias = e.holdout ? bias / e.holdout : kNaN;
  return e;
}

/// Mean log predictive density per value.
double score(const Problem& problem, const std::vector<int>& rows, const Model& model, const Eigen::VectorXd& p,
             const Loss& loss) {
  const Eigen::VectorXd z = whitened(problem, rows, model, p);
  const int m = problem.width();
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto W = problem.whitening(rows[i]);
    for (int c = 0; c < m; ++c)
      if (problem.observed(rows[i], c) && W(c, c) > 0) {
        sum += std::log(W(c, c)) - 0.5 * std::log(2 * kPi);
        ++count;
      }
    sum -= 0.5 * loss(z.segment(std::ptrdiff_t(i) * m, m).squaredNorm());
  }
  return count ? sum / count : kNaN;
}

std::vector<Detectable> detectable(const Problem& problem, const std::vector<int>& rows, const Fit& base,
                                   const std::vector<const Form*>& forms, const Rules& rules) {
  // Found nine times in ten: the threshold and 1.3 standard deviations more.
  const double wanted = std::sqrt(rules.gain) + 1.3;
  std::vector<Detectable> all;
  std::set<std::string> done;
  const Eigen::VectorXd z0 = whitened(problem, rows, base.model, base.p);
  const Eigen::MatrixXd Q = orthonormal(whitened_jacobian(problem, rows, base.model, base.p));
  for (const Form* f : forms) {
    if (done.contains(f->effect)) continue;
    Model m = base.model;
    m.forms.push_back(f);
    Eigen::VectorXd p = Eigen::VectorXd::Zero(m.size());
    p.head(base.p.size()) = base.p;
    const Parameter& par = f->parameters[0];
    const auto signal = [&](double x) {
      p[base.p.size()] = x;
      Eigen::VectorXd d = whitened(problem, rows, m, p) - z0;
      if (Q.cols()) d -= Q * (Q.transpose() * d);
      return d.norm();
    };
    const double most = std::max(par.max, -par.min);
    const double sign = par.max >= -par.min ? 1 : -1;
    if (signal(sign * most) < wanted) {
      if (signal(sign * most) > 1e-3) {
        done.insert(f->effect);
        all.push_back({f->effect, par.name, par.unit, kNaN});
      }
      continue;
    }
    double lo = 0, hi = most;
    for (int k = 0; k < 40; ++k) (signal(sign * (lo + hi) / 2) < wanted ? lo : hi) = (lo + hi) / 2;
    done.insert(f->effect);
    all.push_back({f->effect, par.name, par.unit, hi / par.si});
  }
  return all;
}

/// Deviance of the held-out rows.
double held_out(const Study& study, const Fit& f) {
  return deviance(whitened(*study.problem, study.rows.holdout, f.model, f.p), study.problem->width(), study.loss);
}

std::vector<std::string> names_of(const Study& study, const Fit& f) {
  std::vector<std::string> names;
  for (std::size_t k = study.base_forms.size(); k < f.model.forms.size(); ++k)
    names.push_back(f.model.forms[k]->effect);
  return names;
}

/// Findings numbered 1, 2, ... in order of rows.
void report_flags(Study& study) {
  if (study.flags.empty()) study.flags = study.early;
  int own = 0;
  for (const RowFlag& f : study.flags) own = std::max(own, f.finding);
  for (const RowFlag& f : study.flags)
    study.result.flagged.push_back(
        {f.row, study.loop_case.shots.id[std::size_t(f.row)], f.column, f.reason, f.finding ? f.finding : ++own});
  std::ranges::stable_sort(study.result.flagged, {}, &LoopResult::Flag::row);
  std::map<int, int> number;
  for (auto& f : study.result.flagged) {
    const auto [it, fresh] = number.emplace(f.finding, int(number.size()) + 1);
    f.finding = it->second;
  }
}

Location place(const Study& study, const Finding& f) {
  Location l;
  l.channel = f.channel >= 0 ? study.result.channel_names[std::size_t(f.channel)] : "";
  if (f.regressor < 0) {
    l.regressor = "shot";
    l.detail = "neighbours alike";
  } else if (std::size_t(f.regressor) < study.result.selection.regressors.size()) {
    const Regressor& r = study.result.selection.regressors[std::size_t(f.regressor)];
    l.regressor = r.column;
    l.detail = r.kind + (r.detail.empty() ? "" : " " + r.detail);
  }
  return l;
}

/// Kurtosis of n values in its standard deviations from that of a normal sample (Anscombe & Glynn 1983).
double kurtosis_deviation(double kurtosis, double n) {
  const double mean = 3 * (n - 1) / (n + 1),
               variance = 24 * n * (n - 2) * (n - 3) / ((n + 1) * (n + 1) * (n + 3) * (n + 5));
  const double skewness = 6 * (n * n - 5 * n + 2) / ((n + 7) * (n + 9)) *
                          std::sqrt(6 * (n + 3) * (n + 5) / (n * (n - 2) * (n - 3)));
  const double a = 6 + 8 / skewness * (2 / skewness + std::sqrt(1 + 4 / (skewness * skewness)));
  const double stretch = 1 + (kurtosis - mean) / std::sqrt(variance) * std::sqrt(2 / (a - 4));
  if (stretch <= 0) return -std::numeric_limits<double>::infinity();
  return (1 - 2 / (9 * a) - std::cbrt((1 - 2 / a) / stretch)) / std::sqrt(2 / (9 * a));
}

/// What scatter alone does not do, where a channel's scatter contradicts its declared noise or many shots are far
/// off: it follows a regressor at a level that would not count alone, it has two heads, or it strikes a share of
/// the shots that is no exception.
bool shape_remains(Study& study) {
  const Selection& s = study.result.selection;
  const Eigen::MatrixXd r = study.problem->residuals(s.chosen.model, s.chosen.p.data());
  for (int c = 0; c < study.problem->width(); ++c) {
    const std::string& name = study.result.channel_names[std::size_t(c)];
    const bool refuted = std::ranges::count(study.contradicted, name) > 0;
    if (!refuted && name != study.widespread) continue;
    for (const Finding& f : s.after.findings)
      if (f.channel == c && f.p_adjusted < 0.05) {
        study.result.unexplained.push_back(place(study, f));
        return true;
      }
    double n = 0, mean = 0, second = 0, fourth = 0;
    for (const int i : study.rows.train)
      if (std::isfinite(r(i, c))) mean += r(i, c), ++n;
    mean /= std::max(1.0, n);
    for (const int i : study.rows.train)
      if (std::isfinite(r(i, c))) {
        const double d = r(i, c) - mean;
        second += d * d / n;
        fourth += d * d * d * d / n;
      }
    // Two heads: kurtosis below that of a normal sample by 2.5 of its own standard deviations.
    if (n > 12 && kurtosis_deviation(fourth / (second * second), n) < -2.5) {
      study.result.unexplained.push_back({name, "", "two heads in the distribution: a mixture"});
      return true;
    }
    if (name == study.widespread) {
      Location l{name, "", "many shots far off, the others within the noise: a mixture or a threshold"};
      for (const StructureMap* map : {&s.after, &s.before})
        for (const Finding& f : map->findings)
          if (f.channel == c && l.regressor.empty()) l.regressor = place(study, f).regressor;
      study.result.unexplained.push_back(l);
      return true;
    }
  }
  return false;
}

/// Where the structure sits: what remains after the best model if a foreign column drives it, else the map of
/// the base, before anything was fitted to it.
void locate(Study& study) {
  const Selection& s = study.result.selection;
  const auto foreign = [&](const Finding& f) {
    return f.regressor < 0 ||
           (std::size_t(f.regressor) < s.regressors.size() && s.regressors[std::size_t(f.regressor)].foreign);
  };
  const auto first = [&](const StructureMap& map, auto&& good) -> const Finding* {
    for (const Finding& f : map.findings)
      if (f.channel >= 0 && good(f)) return &f;
    return nullptr;
  };
  const auto add = [&](const Finding* f) {
    if (!f) return;
    const Location l = place(study, *f);
    for (const Location& known : study.result.unexplained)
      if (known.channel == l.channel && known.regressor == l.regressor) return;
    study.result.unexplained.push_back(l);
  };
  const Finding* left = first(s.after, [](const Finding&) { return true; });
  const Finding* base = first(s.before, [](const Finding&) { return true; });
  if (left && foreign(*left)) {
    add(left);
  } else {
    add(base);
    add(left);
  }
  // What the map shows nearly as plainly may be the driver: few shots do not part correlated columns.
  for (const StructureMap* map : {&s.after, &s.before})
    for (const Finding& f : map->findings)
      if (f.channel >= 0 && study.result.unexplained.size() < 4 &&
          std::abs(f.signal) > 0.85 * std::abs(map->findings.front().signal) && f.p_adjusted < 0.05)
        add(&f);
}

}  // namespace

void conclude(Study& study) {
  const Selection& s = study.result.selection;
  report_flags(study);
  if (!study.problem) return;
  study.result.train = int(study.rows.train.size());
  study.result.holdout = int(study.rows.holdout.size());
  study.result.used = study.result.train + study.result.holdout;
  study.result.adopted = s.adopted;
  study.result.ties = s.ties;

  if (study.rows.train.size() < 4) {
    study.result.verdict = Verdict::insufficient;
    study.result.adopted.clear();
    study.result.ties.clear();
    study.result.notes.push_back(fmt::format("{} training rows: too few to test anything", study.rows.train.size()));
  } else if (!s.clean || (s.structured && s.level == 0)) {
    study.result.verdict = s.clean ? Verdict::insufficient : Verdict::unexplained;
    study.result.adopted.clear();
    study.result.ties.clear();
    if (study.result.verdict == Verdict::unexplained) locate(study);
  } else if (shape_remains(study)) {
    study.result.verdict = Verdict::unexplained;
    study.result.adopted.clear();
    study.result.ties.clear();
  } else if (!study.contradicted.empty()) {
    study.result.verdict = Verdict::noise_contradicted;
  } else if (s.nameless) {
    study.result.verdict = Verdict::insufficient;
    study.result.ties.clear();
  } else if (!s.ties.empty()) {
    study.result.verdict = Verdict::ambiguous;
  } else {
    study.result.verdict = s.adopted.empty() ? Verdict::no_residual : Verdict::explained;
  }

  if (study.rows.train.size() > thinned(study.rows.train).size()) {
    study.result.notes.push_back(fmt::format("effects selected on {} of {} training rows, then fitted to all",
                                             thinned(study.rows.train).size(), study.rows.train.size()));
    Fit& chosen = study.result.selection.chosen;
    if (chosen.size() > 0) chosen = fit(*study.problem, study.rows.train, chosen.model, {chosen.p}, study.loss);
  }
  // The holdout is read here, once: what was chosen must not fail there.
  const Fit& base = s.base;
  const bool offered = study.result.verdict != Verdict::unexplained && study.result.verdict != Verdict::insufficient &&
                       s.level > 0;
  const bool refuted = offered &&
                       held_out(study, s.chosen) > held_out(study, base) + study.loop_case.rules.holdout_loss;
  if (refuted) {
    study.result.notes.push_back(fmt::format("{} explained the training shots and not those held out: not adopted",
                                             fmt::join(names_of(study, s.chosen), " and ")));
    if (study.result.verdict != Verdict::noise_contradicted) study.result.verdict = Verdict::insufficient;
    study.result.adopted.clear();
    study.result.ties.clear();
  }
  const bool shown = offered && !refuted;
  const Fit& after = shown ? s.chosen : base;
  if (study.rows.train.size() >= 4) {
    const Eigen::MatrixXd rb = study.problem->residuals(base.model, base.p.data()),
                          ra = study.problem->residuals(after.model, after.p.data());
    for (int c = 0; c < study.problem->width(); ++c) {
      const Channel& ch = study.problem->channels()[std::size_t(c)];
      ChannelResult out{
          .name = ch.name,
          .noise = ch.noise,
          .noise_source = ch.declared && !std::ranges::count(study.contradicted, ch.name) ? "declared" : "estimated"};
      out.scatter = scatter(*study.problem, study.rows.train, c, ra, after.size()).ratio;
      out.before = errors(study.rows, c, rb);
      out.after = errors(study.rows, c, ra);
      study.result.channels.push_back(out);
      if (std::ranges::count(study.contradicted, ch.name))
        study.result.notes.push_back(fmt::format("{}: declared noise {:.4g}, the data's own scatter shows {:.4g}",
                                                 ch.name, study.declared_noise[std::size_t(c)], ch.noise));
    }
    study.result.base_score = score(*study.problem, study.rows.holdout, base.model, base.p, study.loss);
    for (std::size_t k = 0; k < std::min<std::size_t>(s.candidates.size(), 25); ++k) {
      ScoredCandidate sc{.candidate = s.candidates[k]};
      const Eigen::MatrixXd cov = covariance(*study.problem, thinned(study.rows.train), sc.candidate.fit, study.loss,
                                             !std::ranges::all_of(study.declared(), std::identity{}));
      for (Eigen::Index j = 0; j < cov.rows(); ++j) sc.sd.push_back(std::sqrt(cov(j, j)));
      sc.holdout_score =
          score(*study.problem, study.rows.holdout, sc.candidate.fit.model, sc.candidate.fit.p, study.loss);
      study.result.candidates.push_back(std::move(sc));
    }
    study.result.minimum_detectable =
        detectable(*study.problem, thinned(study.rows.train), base, study.candidate_forms, study.loop_case.rules);
    study.result.likeness = alike(*study.problem, thinned(study.rows.train), after, study.candidate_forms);
    study.result.balance_before = balance(*study.problem, study.rows.train, base.model, base.p.data());
    study.result.balance_after = balance(*study.problem, study.rows.train, after.model, after.p.data());
    study.result.next = design(study.loop_case, *study.problem, thinned(study.rows.train), s, study.candidate_forms,
                               study.loss, study.result.unexplained, study.result.verdict);
    std::vector<int> all = study.rows.train;
    all.insert(all.end(), study.rows.holdout.begin(), study.rows.holdout.end());
    std::ranges::sort(all);
    const std::set<int> held(study.rows.holdout.begin(), study.rows.holdout.end());
    for (const int i : all) {
      UsedShot u{.row = study.inputs.row_of[std::size_t(i)],
                 .id = study.loop_case.shots.id[std::size_t(study.inputs.row_of[std::size_t(i)])],
                 .holdout = held.contains(i)};
      for (int c = 0; c < study.problem->width(); ++c) {
        u.measured.push_back(study.problem->measured()(i, c));
        u.before.push_back(rb(i, c));
        u.after.push_back(ra(i, c));
      }
      study.result.shots.push_back(std::move(u));
    }
  } else {
    study.result.next.text = "more shots";
  }
}

}  // namespace hosel::loop
