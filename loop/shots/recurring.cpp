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

constexpr double kLevel = kByChance * kByChance;  // for each of some thousand numbers

/// Rows with the number of the row before, where another result differs.
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

std::vector<int> of_the_row_before(const Shots& shots, const Column& c, double& by_chance) {
  constexpr std::size_t farthest = 6;
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

/// The number that stands out most from those next to it; its rows.
std::vector<int> one_number(const Column& c, double& beside) {
  constexpr std::size_t fewest = 20;            // different numbers
  constexpr std::ptrdiff_t next = 2, near = 5;  // neighbours on either side
  std::map<double, std::vector<int>> rows;
  for (std::size_t i = 0; i < c.value.size(); ++i)
    if (std::isfinite(c.value[i])) rows[c.value[i]].push_back(int(i));
  if (rows.size() < fewest) return {};
  std::vector<const std::vector<int>*> in_order;
  for (const auto& [number, of] : rows) in_order.push_back(&of);
  const auto size = std::ssize(in_order);
  const std::vector<int>* most = nullptr;
  double least = kLevel;
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    double largest = 0, sum = 0, count = 0;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(k - near, 0); j <= std::min(k + near, size - 1); ++j) {
      if (j == k) continue;
      const auto stands = double(in_order[std::size_t(j)]->size());
      sum += stands, ++count;
      if (std::abs(j - k) <= next) largest = std::max(largest, stands);
    }
    const double expected = std::max(largest, sum / count);
    const double p = cdf(complement(boost::math::poisson(expected), double(in_order[std::size_t(k)]->size()) - 1));
    if (p >= least) continue;
    least = p;
    most = in_order[std::size_t(k)];
    beside = largest;
  }
  return most ? *most : std::vector<int>{};
}

}  // namespace

std::vector<Recurring> recurring(const Shots& shots) {
  std::vector<Recurring> all;
  for (const Column& c : shots.columns) {
    if (c.role != Role::output || !c.numeric) continue;
    double known = 0;
    if (std::vector<int> rows = one_number(c, known); !rows.empty()) {
      const double number = c.native(std::size_t(rows.front()));
      all.push_back({c.name, rows,
                     fmt::format("{:g} stands in {} rows, the numbers next to it in {:.0f} at most", number,
                                 rows.size(), known)});
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
