#include "loop/shots/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "loop/deviation.hpp"
#include "loop/shots/separation.hpp"
#include "solvers/random.hpp"

namespace hosel::loop {
namespace {

const Candidate* find(const Selection& s, const std::vector<std::string>& effects) {
  const auto same = [&](const Candidate& c) { return std::ranges::is_permutation(c.effects, effects); };
  const auto it = std::ranges::find_if(s.candidates, same);
  return it == s.candidates.end() ? nullptr : &*it;
}

/// Two sets of effects that differ in one name of a tie that is told.
struct Rivals {
  const Candidate *a = nullptr, *b = nullptr;
  std::string one, two;  ///< the names in which they differ
};

std::vector<Rivals> rivals(const LoopResult& so_far) {
  const Selection& s = so_far.selection;
  const auto told = [&](const std::string& one, const std::string& two) {
    return std::ranges::any_of(so_far.ties, [&](const auto& tie) {
      return std::ranges::count(tie, one) > 0 && std::ranges::count(tie, two) > 0;
    });
  };
  std::vector<Rivals> all;
  for (std::size_t t = 0; t < s.ties.size(); ++t) {
    const auto with = [&](const std::string& name) {
      std::vector<std::string> names = s.adopted;
      for (std::size_t k = 0; k < s.ties.size(); ++k) names.push_back(k == t ? name : s.ties[k].front());
      return find(s, names);
    };
    for (std::size_t i = 0; i < s.ties[t].size(); ++i)
      for (std::size_t j = i + 1; j < s.ties[t].size(); ++j) {
        const Rivals r{with(s.ties[t][i]), with(s.ties[t][j]), s.ties[t][i], s.ties[t][j]};
        if (r.a && r.b && told(r.one, r.two)) all.push_back(r);
      }
  }
  return all;
}

/// What this player can do: what was recorded, a tenth wider on each side; a range that is narrow may be widened by
/// aim. A player swings slower at will, hardly faster.
struct Box {
  std::vector<int> input;
  std::vector<double> low, high;
  std::vector<const Column*> column;

  Box(const Shots& shots, const ShotModel& model, const std::vector<int>& rows) {
    for (int k = 0; k < kInputs; ++k) {
      const Column* col = shots.find_stem(stem(Input(k)));
      if (!col || k == int(Input::head_mass)) continue;
      const auto [lo, hi] = range_of(rows, [&](int i) { return get(model.trial(i).blow, Input(k)); });
      const bool place = k == int(Input::impact_toe) || k == int(Input::impact_high);
      const double aimed = place ? 0.008 : radians(1.5);  // half of a range that aim alone makes
      const double wide = std::max(0.1 * (hi - lo), k == int(Input::club_speed) ? 0.0 : aimed - 0.5 * (hi - lo));
      const double slower = k == int(Input::club_speed) ? std::max(wide, 0.15 * hi) : wide;
      input.push_back(k);
      low.push_back(std::max(lo - slower, quantity(Input(k)).low));
      high.push_back(std::min(hi + wide, quantity(Input(k)).high));
      column.push_back(col);
    }
  }

  /// Corners, edges and a random inside, always the same.
  std::vector<Shot> sites(Shot t) const {
    std::mt19937_64 random(20240607);
    std::vector<Shot> all;
    t.order = 0.5;
    for (int s = 0; s < 384; ++s) {
      for (std::size_t k = 0; k < input.size(); ++k) {
        double u = solvers::uniform(random);
        if (s % 2 == 0) u = u < 0.4 ? 0 : u > 0.6 ? 1 : 0.5;
        set(t.blow, Input(input[k]), low[k] + u * (high[k] - low[k]));
      }
      all.push_back(t);
    }
    return all;
  }
};

/// A set of effects as fitted, and with the widest of the usual forms of one of its names: that name is out only where
/// none of them fits.
std::vector<Fit> family(const Problem& problem, const Fit& as_fitted, const std::string& name,
                        const std::vector<Parametrisation>& forms) {
  std::vector<Fit> all = {as_fitted};
  double usual = kInfinity;
  std::size_t widest = 0;
  for (const Parametrisation& f : forms)
    if (f.effect == name) usual = std::min(usual, f.complexity);
  for (const Parametrisation& f : forms)
    if (f.effect == name && f.complexity <= usual) widest = std::max(widest, f.parameters.size());
  for (const Parametrisation& f : forms) {
    if (f.effect != name || f.complexity > usual || f.parameters.size() < widest ||
        std::ranges::count(as_fitted.model.forms, &f))
      continue;
    Model m;
    std::vector<double> start;
    as_fitted.model.each(as_fitted.p.data(), [&](const Parametrisation& old, Sizes p) {
      m.forms.push_back(old.effect == name ? &f : &old);
      if (old.effect == name) start.resize(start.size() + f.parameters.size());
      else start.insert(start.end(), p.begin(), p.end());
    });
    all.push_back(fit(problem, Part::select, m, {as_vector(start)}, 1));
  }
  return all;
}

/// One set of effects as the truth, another that may follow it.
struct Following {
  const ShotModel& model;
  const Fit &truth, &rival;
  Separation apart{rival.size()};

  /// `whitening`: of that shot. False where the blow cannot happen.
  bool look(const Shot& t, int shot, const Eigen::MatrixXd& whitening, Separation::Site& out) const {
    const int m = model.width();
    Eigen::VectorXd one(m), two(m);
    out.J.resize(m, rival.size());
    if (!model.predict(t, shot, truth.model, truth.p.data(), one.data()) ||
        !model.differences(t, shot, rival.model, rival.p.data(), true, two.data(), out.J.data()))
      return false;
    out.d = whitening * (one - two);
    out.J = (whitening * out.J).eval();
    return true;
  }
};

/// Either of two rivals may be the truth and the other follow it in any of its forms: the nearest of these counts.
class Contest {
 public:
  Contest(const ShotModel& model, const std::vector<Fit>& one, const std::vector<Fit>& two) {
    for (const Fit& f : two) each_.push_back({model, one.front(), f});
    for (const Fit& f : one) each_.push_back({model, two.front(), f});
  }
  using Site = std::vector<Separation::Site>;
  bool look(const Shot& t, int shot, const Eigen::MatrixXd& whitening, Site& out) const {
    out.resize(each_.size());
    for (std::size_t k = 0; k < each_.size(); ++k)
      if (!each_[k].look(t, shot, whitening, out[k])) return false;
    return true;
  }
  void add(const Site& s) {
    for (std::size_t k = 0; k < each_.size(); ++k) each_[k].apart.add(s[k]);
  }
  double squared() const {
    double least = kInfinity;
    for (const Following& f : each_) least = std::min(least, f.apart.nearest().squared);
    return least;
  }
  /// Each with one of these more.
  std::vector<double> squared_with_each(const std::vector<std::pair<std::size_t, Site>>& sites) const {
    std::vector<double> least(sites.size(), kInfinity);
    for (std::size_t k = 0; k < each_.size(); ++k) {
      const Separation::Nearest so_far = each_[k].apart.nearest();
      for (std::size_t i = 0; i < sites.size(); ++i)
        least[i] = std::min(least[i], squared_with(so_far, sites[i].second[k]));
    }
    return least;
  }

 private:
  std::vector<Following> each_;
};

/// Pairs of rivals and how far apart they will be: one by one, of more than three their names and the range.
struct Pairs {
  std::vector<std::string> all, names;
  double nearest = kInfinity, farthest = 0;

  void add(const Rivals& r, double after, const std::string& how) {
    all.push_back(fmt::format("{} from {} ({})", r.one, r.two, how));
    for (const std::string& name : {r.one, r.two})
      if (!std::ranges::count(names, name)) names.push_back(name);
    nearest = std::min(nearest, after), farthest = std::max(farthest, after);
  }
  std::string told() const {
    if (all.size() <= 3) return fmt::format("{}", fmt::join(all, "; "));
    return fmt::format("{} pairs of {} ({:.1f} to {:.1f} then)", all.size(), fmt::join(names, ", "), nearest, farthest);
  }
};

/// Inputs that count as exact, whose last digit makes most of what a channel scatters beyond its declared noise.
std::string coarse_inputs(const ShotCase& c, const ShotModel& model, const std::vector<int>& rows, const Fit& fit) {
  std::vector<std::string> told;
  std::vector<double> as_recorded(std::size_t(model.width())), moved(as_recorded);
  for (int k = 0; k < kInputs; ++k) {
    const Column* input = c.shots.find_stem(stem(Input(k)));
    if (!input || input->role != Role::input || c.input_noise.contains(input->name)) continue;
    if (c.loft_unknown && Input(k) == Input::dynamic_loft) continue;
    const double error = rounding_deviation(input->resolution);
    std::vector<std::vector<double>> by(as_recorded.size());
    for (const int i : rows) {
      Shot t = model.trial(i);
      set(t.blow, Input(k), get(t.blow, Input(k)) + error);
      if (!model.predict(i, fit.model, fit.p.data(), as_recorded.data()) ||
          !model.predict(t, i, fit.model, fit.p.data(), moved.data()))
        continue;
      for (std::size_t ch = 0; ch < by.size(); ++ch) by[ch].push_back(std::abs(moved[ch] - as_recorded[ch]));
    }
    std::vector<std::string> channels;
    for (int ch = 0; ch < model.width(); ++ch) {
      const ShotChannel& channel = model.channel(ch);
      const std::vector<double>& each = by[std::size_t(ch)];
      if (!channel.refuted || each.empty()) continue;
      const double beyond = std::pow(channel.noise, 2) - std::pow(*channel.declared, 2), part = median(each);
      if (2 * part * part > beyond) channels.push_back(fmt::format("{} by {:.2g}", channel.name, part));
    }
    if (!channels.empty())
      told.push_back(fmt::format("[data.input_noise] {} = {:.2g}: its steps of {:.3g} move {}", input->name,
                                 error / input->si, input->resolution / input->si, fmt::join(channels, ", ")));
  }
  return told.empty() ? ""
                      : fmt::format("Declare what rounding does, then run the loop again: {}", fmt::join(told, "; "));
}

}  // namespace

NextExperiment design(const ShotCase& c, const Problem& problem, const ShotModel& model, const std::vector<int>& rows,
                      const LoopResult& so_far) {
  switch (so_far.verdict) {
    case Verdict::unexplained: {
      if (!so_far.columns.empty())
        return {.text = fmt::format("First mend the file or the instrument, then run the loop again: {}",
                                    so_far.columns.front().text)};
      if (so_far.unexplained.empty()) break;
      const auto l = std::ranges::find_if(so_far.unexplained, [](const Location& x) { return !x.regressor.empty(); });
      if (l == so_far.unexplained.end())
        return {
            .text = fmt::format("Repeat one setting ten times, ball, player and instrument noted for every shot: {}",
                                so_far.unexplained.front().detail)};
      const auto said = [&](const char* of_channel) {
        return l->channel.empty() ? l->detail : l->channel + of_channel;
      };
      if (l->regressor == "constant") {
        // What follows something else as well is no zero.
        for (const StructureMap* map : {&so_far.selection.after, &so_far.selection.before})
          for (const Finding& f : map->findings)
            if (!l->rival && f.channel >= 0 && problem.channel(f.channel).name == l->channel &&
                f.regressor != "constant" && f.p_adjusted < kTold)
              return {.text = fmt::format("Change {} on purpose, keep everything else as it is, and repeat each "
                                          "setting: {} is off in the mean, and by how much follows it",
                                          f.regressor, l->channel)};
        return {.text = fmt::format("Check the zero of {} against another instrument: it is off in the mean",
                                    l->channel.empty() ? "every channel" : l->channel)};
      }
      if (l->regressor == "shot")
        return {.text = fmt::format("Repeat the first shots of the session at its end, in the same order: {}",
                                    said(" follows the order of the shots"))};
      if (const Column* reading = c.shots.find(l->regressor); reading && reading->role == Role::output)
        return {.text = fmt::format("Compare {} with another instrument, shot by shot: {}", l->regressor,
                                    said(" follows it in a way that no candidate explains"))};
      return {.text = fmt::format("Change {} on purpose, keep everything else as it is, and repeat each setting: {}",
                                  l->regressor, said(" follows it in a way that no candidate explains"))};
    }
    case Verdict::insufficient:
      return {.text = "More shots of the same kind: the list of smallest effects says what these could have shown"};
    case Verdict::noise_contradicted: {
      const std::string rounding = coarse_inputs(c, model, rows, so_far.selection.chosen);
      return {.text = rounding.empty() ? "Ten shots at one setting, to find the instrument's own scatter" : rounding};
    }
    case Verdict::explained:
    case Verdict::no_residual:
      return {.text = "Nothing is tied. Shots at the edges of the recorded range would narrow the parameters most"};
    case Verdict::ambiguous: break;
  }

  NextExperiment next;
  const Box box(c.shots, model, rows);
  const std::vector<Shot> sites = box.sites(model.trial(rows[rows.size() / 2]));
  // The same share of the shots to come is held out.
  const Eigen::MatrixXd of_one = std::sqrt(1 - c.split.holdout_fraction) * whitening_of_one(model, rows);
  // Aimed a little higher on training rows to come than is needed, since the plan itself rests on fits.
  constexpr double needed = 4.8, wanted = 5.5 * 5.5;
  std::size_t single = 0;
  for (const int i : rows) single += std::size_t(model.count(i));
  const std::size_t most = std::max<std::size_t>(12, single * 3 / 2);
  std::vector<std::size_t> chosen;   // for all pairs together
  std::vector<std::size_t> partial;  // the most that shots can do for a pair that they do not part
  Pairs by_first, open;
  std::vector<std::string> by_more, sensors, sentences;
  for (const Rivals& r : rivals(so_far)) {
    const std::vector<Fit> one = family(problem, r.a->fit, r.one, so_far.forms),
                           two = family(problem, r.b->fit, r.two, so_far.forms);
    Contest apart(model, one, two);
    Contest::Site site;
    for (const int i : rows)
      if (apart.look(model.trial(i), i, model.whitening(i), site)) apart.add(site);
    const double before = std::sqrt(apart.squared());
    std::vector<std::pair<std::size_t, Contest::Site>> possible;
    for (std::size_t k = 0; k < sites.size(); ++k)
      if (apart.look(sites[k], -1, of_one, site)) {
        for (const std::size_t known : chosen)
          if (known == k) apart.add(site);
        possible.emplace_back(k, site);
      }
    std::vector<std::size_t> more;
    while (apart.squared() < wanted && more.size() < most && !possible.empty()) {
      const std::vector<double> then = apart.squared_with_each(possible);
      const auto& [best, of_best] = possible[std::size_t(std::ranges::max_element(then) - then.begin())];
      apart.add(of_best);
      more.push_back(best);
    }
    const double after = std::sqrt(apart.squared());
    if (after < needed) {
      const std::vector<std::string> of_pair = sensors_of({{r.one, r.two}}, c.own);
      for (const std::string& s : of_pair)
        if (!std::ranges::count(sensors, s)) sensors.push_back(s);
      if (after > before + 1 && partial.empty()) partial = more;
      open.add(r, after, fmt::format("{:.1f} now, {:.1f} after {} more shots", before, after, more.size()));
    } else {
      chosen.insert(chosen.end(), more.begin(), more.end());
      if (chosen.empty()) by_more.push_back(fmt::format("{} from {}", r.one, r.two));
      else
        by_first.add(r, after, fmt::format("by the first {}, {:.1f} now, {:.1f} then", chosen.size(), before, after));
    }
  }
  if (!by_first.all.empty())
    sentences.push_back(fmt::format("{} shots at the inputs below separate {}, in noise units; {} are needed",
                                    chosen.size(), by_first.told(), needed));
  if (!by_more.empty())
    sentences.push_back(fmt::format("More shots of the same kind separate {}", fmt::join(by_more, "; ")));
  if (!open.all.empty())
    sentences.push_back(
        fmt::format("Shots within this range do not separate {}, in noise units; {} are needed. Measure {}",
                    open.told(), needed, fmt::join(sensors, "; or ")));
  if (chosen.empty()) chosen = partial;
  for (const std::size_t k : chosen) {
    DesignedShot shot;
    for (std::size_t j = 0; j < box.input.size(); ++j)
      shot.emplace_back(box.column[j]->name, get(sites[k].blow, Input(box.input[j])) / box.column[j]->si);
    next.shots.push_back(shot);
  }
  if (sentences.empty()) {  // no set of candidates stands for the other name
    sensors = sensors_of(so_far.ties, c.own);
    if (!sensors.empty()) sentences.push_back(fmt::format("Measure {}", fmt::join(sensors, "; or ")));
  }
  if (!sensors.empty()) next.sensor = fmt::format("{}", fmt::join(sensors, "; or "));
  next.text = sentences.empty() ? "No design found" : fmt::format("{}", fmt::join(sentences, ". "));
  return next;
}

}  // namespace hosel::loop
