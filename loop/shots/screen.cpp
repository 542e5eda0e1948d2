#include "loop/shots/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

constexpr double kPerhaps = 2e-4;   // share of the rows beyond which one slip may be sought
constexpr double kAccidents = 0.3;  // slips that would bring a row back by accident: with more, none is the reason

struct Factor {
  double value;
  const char* what;
  double cost = 0;
};

std::vector<Factor> factors(const Column& c) {
  const auto split = split_unit(c.name);
  std::vector<Factor> all;
  if (split.unit) switch (split.unit->dimension) {
      case Dimension::speed:
        all = {{1 / kMpsPerMph, "m/s and mph"}, {3.6, "m/s and km/h"}, {1.609344, "mph and km/h"}};
        break;
      case Dimension::angle: all = {{180 / kPi, "degrees and radians"}}; break;
      case Dimension::angular_velocity:
        all = {{30 / kPi, "rpm and rad/s"}, {60, "rpm and revolutions per second"}};
        break;
      case Dimension::length:
        all = {{25.4, "mm and inches"}, {100, "metres and centimetres"}, {1000, "metres and millimetres"}};
        break;
      case Dimension::mass: all = {{1000, "kg and g"}, {2.20462262, "kg and pounds"}}; break;
      default: break;
    }
  all.push_back({10, "a decimal place", 3});
  all.push_back({100, "two decimal places", 3});
  return all;
}

/// The value as recorded, with each pair of neighbouring digits swapped.
std::vector<double> transpositions(double native, double step) {
  const int digits = std::clamp(int(std::lround(-std::log10(step > 0 ? step : 1))), 0, 9);
  const std::string text = fmt::format("{:.{}f}", native, digits);
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    std::size_t j = i + 1;
    if (text[j] == '.') ++j;
    if (j >= text.size() || !std::isdigit(text[i]) || !std::isdigit(text[j]) || text[i] == text[j]) continue;
    std::string other = text;
    std::swap(other[i], other[j]);
    all.push_back(std::stod(other));
  }
  return all;
}

class Row {
 public:
  Row(const ShotModel& model, const Fit& fit, int shot) : model_(model), fit_(fit), shot_(shot) {
    measured_ = model.measured().row(shot).transpose();
    prediction_.resize(model.width());
    trial_ = model.trial(shot);
    predicted_ = model.predict(trial_, shot, fit.model, fit.p.data(), prediction_.data());
  }
  /// Squared distance with some columns' values [SI] replaced.
  struct Replaced {
    const ColumnUse* use;
    double si;
  };
  double distance(const std::vector<Replaced>& by = {}) const {
    Eigen::VectorXd r = prediction_, y = measured_;
    Shot t = trial_;
    bool other = false;
    for (const auto& [use, si] : by) {
      if (use->input >= 0) set(t.blow, Input(use->input), si);
      else y[use->channel] = si / use->column->si;
      other = other || use->input >= 0;
    }
    if (!(other ? model_.predict(t, shot_, fit_.model, fit_.p.data(), r.data()) : predicted_))
      return kImpossible * kImpossible * model_.width();
    for (int c = 0; c < model_.width(); ++c) r[c] = model_.observed(shot_, c) ? r[c] - y[c] : 0.0;
    return (model_.whitening(shot_) * r).squaredNorm();
  }

 private:
  const ShotModel& model_;
  const Fit& fit_;
  int shot_;
  Eigen::VectorXd measured_, prediction_;
  Shot trial_;
  bool predicted_ = false;
};

struct Slip {
  std::string column, reason;
  std::vector<Row::Replaced> by;
  double distance = 0;
  double cost = 0;  ///< rarer slips need a better fit
};

/// How many of `tried` slips bring a row back by accident as well as this one, whose value lies as far from the
/// recorded one: by the width of the values that the row allows there.
double accidents(const Row& row, const Slip& slip, std::size_t file_row, std::size_t tried) {
  double expected = double(tried);
  for (std::size_t k = 0; k < slip.by.size(); ++k) {
    const Row::Replaced& r = slip.by[k];
    const double far = std::abs(r.si - r.use->column->native(file_row) * r.use->column->si), step = 0.05 * far;
    const auto at = [&](double d) {
      std::vector<Row::Replaced> by = slip.by;
      by[k].si += d;
      return row.distance(by);
    };
    const double curve = (at(step) + at(-step) - 2 * slip.distance) / (step * step);
    if (!(curve > 0)) return kInfinity;
    expected *= std::min(1.0, std::sqrt(2 * kPi) * std::sqrt(2 / curve) / far);
  }
  return expected;
}

/// Every slip of the record that could be: units and decimal places, signs, digits, two columns swapped.
std::vector<Slip> slips_of(const Row& row, const std::vector<const ColumnUse*>& present, std::size_t file_row) {
  std::vector<Slip> slips;
  for (const ColumnUse* u : present) {
    const double si = u->column->si, native = u->column->native(file_row);
    const auto attempt = [&](double x, std::string reason, double cost) {
      const std::vector<Row::Replaced> by = {{u, x * si}};
      slips.push_back({u->column->name, std::move(reason), by, row.distance(by), cost});
    };
    for (const Factor& f : factors(*u->column))
      for (const double x : {native * f.value, native / f.value})
        // Below the column's resolution it would be nothing: any value fits so whose row wants none.
        if (std::abs(x) >= u->column->resolution / si)
          attempt(x, fmt::format("{:g} fits as {:.5g}: {} confused", native, x, f.what), f.cost);
    if (native != 0) attempt(-native, fmt::format("{:g} fits with the other sign", native), 3);
    for (const double x : transpositions(native, u->column->resolution / si))
      attempt(x, fmt::format("{:g} fits as {:g}: digits transposed", native, x), 3);
  }
  for (std::size_t a = 0; a < present.size(); ++a)
    for (std::size_t b = a + 1; b < present.size(); ++b) {
      const ColumnUse &u = *present[a], &v = *present[b];
      const std::vector<Row::Replaced> by = {{&u, v.column->native(file_row) * u.column->si},
                                             {&v, u.column->native(file_row) * v.column->si}};
      slips.push_back({u.column->name, fmt::format("fits with {} and {} swapped", u.column->name, v.column->name), by,
                       row.distance(by), 2});
    }
  return slips;
}

/// The column that, left out, helps most; "" where none does.
std::string likeliest_column(const ShotModel& model, const Row& row, int shot,
                             const std::vector<const ColumnUse*>& present) {
  std::string column;
  double least = row.distance();
  for (const ColumnUse* u : present) {
    double d = row.distance();
    if (u->channel >= 0) {
      // The best value of this channel: minimise over it by a parabola through three points.
      const double si = u->column->si, y = model.measured()(shot, u->channel), h = model.sigma(shot, u->channel);
      const double up = row.distance({{u, (y + h) * si}}), down = row.distance({{u, (y - h) * si}});
      const double curve = up + down - 2 * d, slope = (up - down) / 2;
      if (curve > 0) d -= slope * slope / (2 * curve);
    } else {
      const auto [lo, hi] = range_of(u->column->value, std::identity());
      for (int k = 0; k <= 40; ++k) d = std::min(d, row.distance({{u, lo + (hi - lo) * k / 40.0}}));
    }
    if (d < least) {
      least = d;
      column = u->column->name;
    }
  }
  return column;
}

/// The column whose values stand in column `u` over these rows, and not over the others: "" where none.
std::string copied_from(const Shots& shots, const Column& u, const std::vector<int>& rows) {
  const auto typical = [&](const Column& c, bool inside) {
    std::vector<double> x;
    for (std::size_t i = 0; i < c.value.size(); ++i)
      if (std::isfinite(c.value[i]) && (std::ranges::binary_search(rows, int(i)) == inside)) x.push_back(c.native(i));
    return x.empty() ? kNaN : median(x);
  };
  const double here = typical(u, true), elsewhere = typical(u, false);
  std::string best;
  double least = 0.03;
  for (const Column& v : shots.columns) {
    if (!v.numeric || &v == &u || v.role == Role::bookkeeping) continue;
    const double there = typical(v, true);
    const double gap = std::abs(here / there - 1);
    if (gap < least && std::abs(elsewhere / there - 1) > 0.2) {
      least = gap;
      best = v.name;
    }
  }
  return best;
}

/// One cause, one finding: a cluster most of whose rows are flagged. Its other shots are flagged too.
void gather_clusters(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of, const Fit& fit,
                     std::vector<RowFlag>& flags) {
  int finding = 0;
  std::map<int, int> shot_of;
  for (int i = 0; i < model.shots(); ++i) shot_of[row_of[i]] = i;
  std::map<int, std::size_t> flag_of;
  for (std::size_t k = 0; k < flags.size(); ++k) flag_of[flags[k].row] = k;
  for (const Column& c : shots.columns) {
    if (c.numeric) continue;
    const Groups g = groups(c);
    if (g.name.size() < 2) continue;
    std::vector<std::vector<int>> of_group(g.name.size());
    for (std::size_t row = 0; row < g.of_row.size(); ++row)
      if (g.of_row[row] >= 0 && (shot_of.contains(int(row)) || flag_of.contains(int(row))))
        of_group[g.of_row[row]].push_back(int(row));
    for (std::size_t k = 0; k < g.name.size(); ++k) {
      const std::vector<int>& members = of_group[k];
      std::vector<std::size_t> bad;
      for (const int row : members)
        if (const auto it = flag_of.find(row); it != flag_of.end() && flags[it->second].finding == 0)
          bad.push_back(it->second);
      if (members.size() < 3 || bad.size() * 2 <= members.size()) continue;
      std::map<std::string, int> votes;
      for (const std::size_t b : bad) ++votes[flags[b].column];
      const bool one_slip = std::ranges::count_if(bad, [&](std::size_t b) { return flags[b].slip; }) * 2 >
                            std::ptrdiff_t(members.size());
      const std::string column = std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; })->first;
      // The most telling reason: a slip before a value that cannot be.
      std::string reason;
      for (const bool slip : {true, false})
        for (const std::size_t b : bad)
          if (reason.empty() && flags[b].column == column && flags[b].slip == slip) reason = flags[b].reason;
      const Column* u = shots.find(column);
      if (const std::string other = u && u->numeric ? copied_from(shots, *u, members) : ""; !other.empty())
        reason = fmt::format("the values of {} stand in {}", other, column);
      ++finding;
      const std::string said =
          fmt::format("all of {} '{}' recorded wrongly in {}: {}", c.name, g.name[k], column, reason);
      for (const int row : members) {
        if (const auto it = flag_of.find(row); it != flag_of.end()) {
          RowFlag& f = flags[it->second];
          f.finding = finding;
          f.column = column;
          f.reason = said;
          f.slip = true;
          f.cluster = one_slip;
        } else {
          const int shot = shot_of.at(row);
          flags.push_back({shot, row, column, said, "", finding, Row(model, fit, shot).distance(), true, one_slip});
          flag_of[row] = flags.size() - 1;
        }
      }
    }
  }
  // The same slip in the same column is the same cause only where most of a cluster shows it; else each row is its own.
  for (RowFlag& f : flags)
    if (f.finding == 0) f.finding = ++finding;
}

}  // namespace

Screening screen(const ShotModel& model, const Shots& shots, const std::vector<int>& row_of,
                 const std::vector<ColumnUse>& uses, const Fit& fit, bool clean, const std::vector<RowFlag>& before) {
  const int n = model.shots();
  Screening screening;
  std::vector<RowFlag>& flags = screening.flags;
  flags = before;
  std::map<int, std::size_t> known;
  for (std::size_t k = 0; k < flags.size(); ++k)
    if (flags[k].shot >= 0) known[flags[k].shot] = k;
  // Against the bulk: where the fit misses everything by some factor, that is the fit's fault, not the rows'.
  std::vector<double> relative;
  for (int i = 0; i < n; ++i)
    if (const int seen = model.observed(i))
      relative.push_back(Row(model, fit, i).distance() / quantile(boost::math::chi_squared(seen), 0.5));
  if (relative.empty()) return screening;
  std::ranges::sort(relative);
  double bulk = std::max(1.0, relative[relative.size() / 2]);
  // 0.65: median over upper quartile of chi-squared, 5 channels.
  if (!clean) bulk = 2 * std::max(bulk, 0.65 * relative[relative.size() * 3 / 4]);
  for (int i = 0; i < n; ++i) {
    const int seen = model.observed(i);
    if (!seen) continue;
    const Row row(model, fit, i);
    const boost::math::chi_squared law(seen);
    const double distance = row.distance();
    const double surely = bulk * quantile(complement(law, 2 * kByChance / std::max(20, n))),
                 perhaps = bulk * quantile(complement(law, kPerhaps));
    if (distance < perhaps) continue;

    const std::size_t file_row = std::size_t(row_of[i]);
    std::vector<const ColumnUse*> present;
    for (const ColumnUse& u : uses)
      if (std::isfinite(u.column->value[file_row])) present.push_back(&u);
    const std::vector<Slip> slips = slips_of(row, present, file_row);
    const double fits = bulk * (quantile(law, 1 - kTold) + 2), half = 0.25 * distance;
    const Slip* best = nullptr;
    for (const Slip& s : slips)
      if (s.distance < fits && s.distance < half && (!best || s.distance + s.cost < best->distance + best->cost))
        best = &s;
    if (best) {
      RowFlag flag{
          .shot = i, .row = int(file_row), .column = best->column, .reason = best->reason, .distance = distance};
      if (accidents(row, *best, file_row, slips.size()) > kAccidents)
        flag.doubtful = fmt::format("{:.1f} noise units from the model: mis-tracked or mistyped ({})",
                                    std::sqrt(distance), best->reason);
      if (const auto it = known.find(i); it != known.end()) flags[it->second] = flag;
      else flags.push_back(flag);
      continue;
    }
    if (distance < surely || known.contains(i)) continue;
    flags.push_back({i, int(file_row), likeliest_column(model, row, i, present),
                     fmt::format("no model of the family explains this shot ({:.1f} noise units away): mis-tracked",
                                 std::sqrt(distance)),
                     "", 0, distance, false});
  }
  gather_clusters(model, shots, row_of, fit, flags);

  std::map<int, int> of_finding;
  for (const RowFlag& f : flags) ++of_finding[f.finding];
  const auto single = [&](const RowFlag& f) { return f.slip && f.shot >= 0 && of_finding[f.finding] == 1; };
  // Of flags that are more than exceptions only the farthest stay; the column that most of them are in is told.
  const auto thin = [&](double exceptions, double nearer, const auto& of) {
    std::map<std::string, int> of_column;
    for (const RowFlag& f : flags)
      if (of(f)) ++of_column[f.column];
    if (double(std::ranges::count_if(flags, of)) <= std::max(exceptions, kMany * n)) return;
    const auto& [column, count] = *std::ranges::max_element(of_column, {}, [](const auto& v) { return v.second; });
    if (count > screening.many) screening.widespread = column, screening.many = count;
    std::erase_if(flags, [&](const RowFlag& f) { return of(f) && f.distance < nearer; });
  };
  // Few rows of a set slip. Where more seem to, any row far off finds some slip that fits: only the plainest stay.
  thin(3, 10 * bulk * quantile(complement(boost::math::chi_squared(model.width()), kPerhaps)), single);
  // Exceptions are few: where many shots are far off for no reason, the rule is wrong, not the rows.
  thin(2, kInfinity, [&](const RowFlag& f) { return !f.slip && f.shot >= 0 && !known.contains(f.shot); });
  for (RowFlag& f : flags)
    if (single(f) && !f.doubtful.empty()) f.reason = f.doubtful;
  std::ranges::stable_sort(flags, {}, &RowFlag::row);
  return screening;
}

}  // namespace hosel::loop
