#include "loop/shots/recurring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/poisson.hpp>
#include <cmath>
#include <map>

#include "loop/rules.hpp"

namespace hosel::loop {
namespace {

constexpr double kLevel = kByChance / 10;  // for each column

/// Rows with the number of the row `lag` before, if another result differs.
std::vector<int> repeats(const Shots& shots, const Column& c, std::size_t lag, double& pairs) {
  std::vector<int> same;
  for (std::size_t i = lag; i < shots.rows(); ++i) {
    const auto both = [&](const Column& d) { return std::isfinite(d.value[i]) && std::isfinite(d.value[i - lag]); };
    if (!both(c)) continue;
    const bool another = std::ranges::any_of(shots.columns, [&](const Column& d) {
      return d.role == Role::output && &d != &c && both(d) && d.value[i] != d.value[i - lag];
    });
    if (!another) continue;
    ++pairs;
    if (c.value[i] == c.value[i - lag]) same.push_back(int(i));
  }
  return same;
}

/// Whether rows stand sorted by this column, so that equal values are neighbours.
bool sorts(const Column& c) {
  std::vector<double> seen;
  std::ranges::copy_if(c.value, std::back_inserter(seen), [](double x) { return std::isfinite(x); });
  return std::ranges::is_sorted(seen) || std::ranges::is_sorted(seen, std::ranges::greater{});
}

std::vector<int> of_the_row_before(const Shots& shots, const Column& c, double& by_chance) {
  constexpr std::size_t farthest = 6;
  if (sorts(c)) return {};
  double pairs = 0, others = 0, alike = 0;
  std::vector<int> same = repeats(shots, c, 1, pairs);
  for (std::size_t lag = 2; lag <= farthest; ++lag) alike += double(repeats(shots, c, lag, others).size());
  if (same.empty() || !(others > 0)) return {};
  // One more of either kind, so that none in few pairs is no certainty.
  const double share = std::min(1.0, (alike + 1) / (others + 1));
  by_chance = share * pairs;
  const boost::math::binomial law(pairs, share);
  if (cdf(complement(law, double(same.size()) - 1)) < kLevel) return same;
  return {};
}

/// The rows of the most frequent number, where that many are no coincidence: how many rows a row shares its number with
/// is told by the other numbers. It must have twice the rows of the next, since rounded numbers may stand among others
/// that are not.
std::vector<int> one_number(const Column& c, double& next) {
  constexpr double peaked = 2.5;  // densest over mean density: 1.4 where the numbers are normal, 2 where exponential
  std::map<double, std::vector<int>> rows;
  for (std::size_t i = 0; i < c.value.size(); ++i)
    if (std::isfinite(c.value[i])) rows[c.value[i]].push_back(int(i));
  if (rows.size() < kFewestToLearn) return {};
  std::vector<const std::vector<int>*> by_size;
  for (const auto& [number, of] : rows) by_size.push_back(&of);
  std::ranges::stable_sort(by_size, std::ranges::greater{}, [](const auto* of) { return of->size(); });
  const double stands = double(by_size[0]->size());
  next = double(by_size[1]->size());
  double shared = 1, others = 1;  // one more, so that none in few rows is no certainty
  for (std::size_t k = 1; k < by_size.size(); ++k) {
    const double of = double(by_size[k]->size());
    shared += of * (of - 1);
    others += of;
  }
  const double p = cdf(complement(boost::math::poisson(peaked * shared / others), stands - 1));
  return stands >= 2 * next && p * double(rows.size()) < kLevel ? *by_size[0] : std::vector<int>{};
}

}  // namespace

std::vector<Recurring> recurring(const Shots& shots) {
  std::vector<Recurring> all;
  for (const Column& c : shots.columns) {
    if (c.role != Role::output || !c.numeric) continue;
    double known = 0;
    if (std::vector<int> rows = one_number(c, known); !rows.empty()) {
      const double number = c.native(std::size_t(rows.front()));
      all.push_back(
          {c.name, rows,
           fmt::format("{:g} stands in {} rows, every other number in {:.0f} at most", number, rows.size(), known)});
    } else if (rows = of_the_row_before(shots, c, known); !rows.empty()) {
      all.push_back(
          {c.name, rows,
           fmt::format("the reading of the row before once more, as in {} rows, where {:.0f} would be by chance",
                       rows.size(), known)});
    }
  }
  return all;
}

}  // namespace hosel::loop
