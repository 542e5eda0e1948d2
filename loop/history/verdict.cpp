#include "hosel/loop/history/verdict.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>

namespace hosel::loop {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The findings in the form that the report knows.
void report_structure(HistoryStudy& study) {
  Selection& s = study.result.selection;
  const auto fill = [&](const std::vector<HistoryFinding>& from, StructureMap& map) {
    for (const HistoryFinding& f : from) {
      s.regressors.push_back({.column = "time_s", .kind = f.kind, .detail = f.detail, .value = {}});
      map.findings.push_back({.channel = f.channel,
                              .regressor = int(s.regressors.size()) - 1,
                              .statistic = f.signal,
                              .signal = f.signal,
                              .p_adjusted = f.p_adjusted});
    }
    map.p = from.empty() ? 1 : from.front().p_adjusted;
  };
  fill(study.before, s.before);
  fill(study.after, s.after);
}

Eigen::MatrixXd covariance(const HistoryStudy& study, const Fit& f) {
  const Eigen::MatrixXd J = study.problem->jacobian(f.model, f.p);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J, Eigen::ComputeThinV);
  const auto n = J.cols();
  const auto parameters = f.model.parameters();
  Eigen::MatrixXd cov = Eigen::MatrixXd::Zero(n, n);
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const double sv = svd.singularValues()[k];
    cov += (sv > 1e-3 ? 1 / (sv * sv) : 1e12) * svd.matrixV().col(k) * svd.matrixV().col(k).transpose();
  }
  for (std::ptrdiff_t a = 0; a < n; ++a)
    for (std::ptrdiff_t b = 0; b < n; ++b)
      cov(a, b) *= parameters[std::size_t(a)]->scale * parameters[std::size_t(b)]->scale;
  return cov;
}

Errors errors(const HistoryProblem& problem, const std::vector<Eigen::MatrixXd>& e, int channel) {
  Errors out;
  double train = 0, held = 0, bias = 0;
  for (std::size_t r = 0; r < e.size(); ++r)
    for (std::ptrdiff_t i = 0; i < e[r].rows(); ++i) {
      const double x = e[r](i, channel);
      if (!std::isfinite(x)) continue;
      if (problem.records()[r].train[std::size_t(i)]) {
        train += x * x;
        ++out.train;
      } else {
        held += x * x;
        bias += x;
        ++out.holdout;
      }
    }
  out.train_rmse = out.train ? std::sqrt(train / out.train) : kNaN;
  out.holdout_rmse = out.holdout ? std::sqrt(held / out.holdout) : kNaN;
  out.holdout_bias = out.holdout ? bias / out.holdout : kNaN;
  return out;
}

/// A fit may move what it cannot explain into a channel that the base leaves clean: the place is where something
/// remains both before and after it, else where it was before.
void locate(HistoryStudy& study) {
  const auto shows = [](const HistoryFinding& f) { return f.p_adjusted <= HistoryStudy::kRemaining; };
  std::set<int> clean_before, both;
  for (int c = 0; c < study.problem->width(); ++c) clean_before.insert(c);
  for (const HistoryFinding& f : study.before)
    if (shows(f)) clean_before.erase(f.channel);
  for (const HistoryFinding& f : study.after)
    if (shows(f) && !clean_before.contains(f.channel)) both.insert(f.channel);
  std::vector<HistoryFinding> told;
  const bool moved = both.empty() && int(clean_before.size()) < study.problem->width();
  for (const HistoryFinding& f : moved ? study.before : study.after)
    if (shows(f) && (moved || both.empty() || both.contains(f.channel))) told.push_back(f);
  // An oscillation says more than the band it lies in.
  std::ranges::stable_partition(told, [](const HistoryFinding& f) { return f.kind == "oscillation"; });
  for (const HistoryFinding& f : told) {
    const std::string& channel = study.result.channel_names[std::size_t(f.channel)];
    if (std::ranges::any_of(study.result.unexplained, [&](const Location& l) { return l.channel == channel; }))
      continue;
    study.result.unexplained.push_back({channel, "time_s", f.kind + (f.detail.empty() ? "" : " " + f.detail)});
  }
}

/// The size at which the deviance would fall by what a first effect needs.
void detectable(HistoryStudy& study, const Fit& base) {
  std::set<std::string> seen;
  for (const Form* f : study.candidates) {
    if (f->parameters.size() != 1 || !seen.insert(f->effect).second) continue;
    Fit probe = base;
    probe.model.forms.push_back(f);
    probe.p.conservativeResize(probe.model.size());
    probe.p.tail(1).setZero();
    Eigen::MatrixXd J = study.problem->jacobian(probe.model, probe.p);
    Eigen::VectorXd column = J.rightCols(1);
    if (J.cols() > 1) {
      const Eigen::MatrixXd Q = orthonormal(J.leftCols(J.cols() - 1));
      column -= Q * (Q.transpose() * column);
    }
    const Parameter& q = f->parameters.front();
    const double value = std::sqrt(study.history_case.rules.gain) / column.norm() * q.scale;
    study.result.minimum_detectable.push_back(
        {f->effect, q.name, q.unit,
         value < std::max(q.max, -q.min) ? value / q.si : std::numeric_limits<double>::infinity()});
  }
}

/// One column per effect beside a fit.
Likeness alike(const HistoryStudy& study, const Fit& at) {
  std::vector<EffectColumn> columns;
  std::set<std::string> seen;
  for (const Form* f : at.model.forms) seen.insert(f->effect);
  for (const Form* f : study.candidates) {
    if (f->parameters.size() != 1 || !seen.insert(f->effect).second) continue;
    Model more = at.model;
    more.forms.push_back(f);
    Eigen::VectorXd p(more.size());
    p << at.p, 0.0;
    columns.push_back({f->effect, f->parameters.front().name, study.problem->jacobian(more, p).rightCols(1)});
  }
  return likeness(columns, study.problem->jacobian(at.model, at.p));
}

void next_experiment(HistoryStudy& study) {
  NextExperiment& next = study.result.next;
  if (study.result.verdict == Verdict::unexplained && !study.result.unexplained.empty()) {
    next.text = fmt::format(
        "repeat the record with one thing changed at a time (free length, tip mass, amplitude): {} holds {} that no "
        "candidate explains",
        study.result.unexplained.front().channel, study.result.unexplained.front().detail);
  } else if (study.result.verdict == Verdict::ambiguous) {
    std::vector<std::string> sensors;
    std::string names;
    for (const auto& tie : study.result.ties)
      for (const std::string& e : tie) {
        names += (names.empty() ? "" : ", ") + e;
        if (const HistoryEffect* h = find_history_effect(e)) sensors.emplace_back(h->sensor);
      }
    next.sensor = fmt::format("{}", fmt::join(sensors, "; or "));
    next.text = fmt::format(
        "this record cannot separate {}: measure {}; or record the same club with a known mass at the tip and with a "
        "shorter free length",
        names, *next.sensor);
  } else if (study.result.verdict == Verdict::insufficient) {
    next.text = "a longer or stronger record: minimum_detectable says how large an effect this one could have shown";
  } else if (study.result.verdict == Verdict::noise_contradicted) {
    next.text = "a record at rest, to find the instrument's own scatter";
  } else {
    next.text = "nothing is tied; a longer record would narrow the parameters most";
  }
}

}  // namespace

void conclude(HistoryStudy& study) {
  for (const HistoryRecord& r : study.problem->records())
    for (std::size_t i = 0; i < r.times.size(); ++i) ++(r.train[i] ? study.result.train : study.result.holdout);
  study.result.used = study.result.train + study.result.holdout;
  if (study.too_few) {
    study.result.verdict = Verdict::insufficient;
    study.result.notes.push_back("fewer than 24 readings to learn from: too few to test anything");
    study.result.next.text = "a longer record";
    return;
  }
  const Selection& s = study.result.selection;
  study.result.adopted = s.adopted;
  study.result.ties = s.ties;
  if (!s.clean) {
    study.result.verdict = Verdict::unexplained;
    study.result.adopted.clear();
    study.result.ties.clear();
    locate(study);
  } else if (!study.contradicted.empty()) {
    study.result.verdict = Verdict::noise_contradicted;
  } else if (!s.ties.empty()) {
    study.result.verdict = Verdict::ambiguous;
  } else {
    study.result.verdict = s.adopted.empty() ? Verdict::no_residual : Verdict::explained;
  }
  report_structure(study);

  // The holdout is read here, once, after the verdict.
  const Fit& base = s.base;
  const Fit& after = study.result.verdict != Verdict::unexplained ? s.chosen : base;
  const auto mean_score = [&](const Fit& f) {
    const auto [sum, n] = study.problem->holdout_score(f.model, f.p.data());
    return n ? sum / n : kNaN;
  };
  study.result.base_score = mean_score(base);
  if (s.level > 0 && study.result.verdict != Verdict::unexplained && mean_score(after) < study.result.base_score) {
    study.result.verdict = Verdict::insufficient;
    study.result.notes.push_back(fmt::format("{} explained the training part and not what was held out: not adopted",
                                             fmt::join(study.result.adopted, ", ")));
    study.result.adopted.clear();
    study.result.ties.clear();
  }
  std::vector<Eigen::MatrixXd> eb, ea;
  study.problem->residuals(base.model, base.p.data(), eb);
  study.problem->residuals(after.model, after.p.data(), ea);
  for (int c = 0; c < study.problem->width(); ++c) {
    const HistoryChannel& ch = study.problem->channels()[std::size_t(c)];
    const bool trusted = ch.declared && !std::ranges::count(study.contradicted, ch.name);
    ChannelResult out{.name = ch.name, .noise = ch.noise, .noise_source = trusted ? "declared" : "estimated"};
    out.before = errors(*study.problem, eb, c);
    out.after = errors(*study.problem, ea, c);
    out.scatter = out.after.train_rmse / ch.noise;
    study.result.channels.push_back(out);
    if (ch.colour > 0)
      study.result.notes.push_back(fmt::format(
          "{}: neighbouring readings are correlated by {:.2f}; every test counts with that", ch.name, ch.colour));
    if (std::ranges::count(study.contradicted, ch.name))
      study.result.notes.push_back(fmt::format("{}: declared noise {:.4g}, the data's own scatter shows {:.4g}",
                                               ch.name, study.declared_noise[std::size_t(c)], ch.noise));
  }
  for (std::size_t k = 0; k < std::min<std::size_t>(s.candidates.size(), study.problem->slow() ? 12 : 25); ++k) {
    ScoredCandidate sc{.candidate = s.candidates[k]};
    const Eigen::MatrixXd cov = covariance(study, sc.candidate.fit);
    for (Eigen::Index j = 0; j < cov.rows(); ++j) sc.sd.push_back(std::sqrt(cov(j, j)));
    sc.holdout_score = mean_score(sc.candidate.fit);
    study.result.candidates.push_back(std::move(sc));
  }
  for (const std::string& e : s.silent)
    study.result.notes.push_back(fmt::format("{}: these channels would not show it", e));
  detectable(study, base);
  study.result.likeness = alike(study, after);
  next_experiment(study);
  int row = 0;
  for (std::size_t r = 0; r < study.problem->records().size(); ++r) {
    const HistoryRecord& record = study.problem->records()[r];
    for (std::size_t i = 0; i < record.times.size(); ++i, ++row) {
      UsedShot u{.row = row, .id = fmt::format("{}", row + 1), .holdout = !record.train[i]};
      for (int c = 0; c < study.problem->width(); ++c) {
        u.measured.push_back(record.measured(std::ptrdiff_t(i), c));
        u.before.push_back(eb[r](std::ptrdiff_t(i), c));
        u.after.push_back(ea[r](std::ptrdiff_t(i), c));
      }
      study.result.shots.push_back(std::move(u));
    }
  }
}

}  // namespace hosel::loop
