#include "loop/shots/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "golf/first_contact.hpp"
#include "loop/deviation.hpp"
#include "solvers/random.hpp"

namespace hosel::loop {
namespace {

/// The fewest rows, at most 20, of which this fraction is a whole number of rows; of a small one those with one row.
std::size_t whole_share(double fraction) {
  constexpr std::size_t most = 20;
  if (fraction < 1.0 / most) return std::size_t(std::lround(1 / fraction));
  std::size_t rows = 2;
  const auto off = [&] { return std::abs(fraction - std::round(fraction * double(rows)) / double(rows)); };
  while (rows < most && off() > 2e-3) ++rows;
  return rows;
}

}  // namespace

std::vector<int> Rows::all() const {
  std::vector<int> both = train;
  both.insert(both.end(), holdout.begin(), holdout.end());
  return both;
}

std::vector<char> hold_out(const std::vector<std::vector<std::size_t>>& clusters, std::size_t all, double fraction,
                           std::mt19937_64& random) {
  std::vector<char> held(all, 0);
  const double wanted = fraction * double(all);
  double have = 0;
  for (const std::size_t k : solvers::shuffled(clusters.size(), random)) {
    const double more = double(clusters[k].size());
    if (have + more > wanted + 0.5 * more) continue;
    for (const std::size_t i : clusters[k]) held[i] = 1;
    have += more;
  }
  return held;
}

Rows split_rows(const ShotCase& c, const ShotModel& model, const std::vector<int>& row_of,
                const std::vector<int>& usable) {
  // Thresholds show at the most oblique shots only, so these are never held out: beyond them nothing would be learnt.
  std::vector<double> oblique;
  for (const int i : usable) {
    Blow blow = model.trial(i).blow;
    if (!c.head_turns)
      blow.delivery.impact_toe = blow.delivery.impact_high = 0;  // such a base knows the face's centre only
    const FirstContact g = first_contact(blow);
    oblique.push_back(g.slip().norm() / g.approach.dot(g.normal));
  }
  std::mt19937_64 random(c.split.seed);
  const double fraction = c.split.holdout_fraction;
  std::vector<char> held(usable.size(), 0);
  if (!c.split.by.empty()) {
    const Column* by = c.shots.find(c.split.by);
    if (!by) throw DataError(fmt::format("{}:1: no column '{}' to split by", c.shots.file, c.split.by));
    const Groups g = groups(*by);
    int count = int(g.name.size());
    std::map<int, std::vector<std::size_t>> members;  // a shot without a name is a cluster of its own
    for (std::size_t i = 0; i < usable.size(); ++i) {
      const int name = g.of_row[row_of[usable[i]]];
      members[name < 0 ? count++ : name].push_back(i);
    }
    const auto most = std::ranges::max_element(oblique) - oblique.begin();
    std::erase_if(members, [&](const auto& m) { return std::ranges::count(m.second, std::size_t(most)) > 0; });
    std::vector<std::vector<std::size_t>> clusters;
    for (auto& [name, list] : members) clusters.push_back(std::move(list));
    held = hold_out(clusters, usable.size(), fraction, random);
  } else {
    // Single rows: of every three (at one third) neighbours in obliquity one is held out, so that both sets reach
    // over the whole range.
    const auto order = rising_order<std::size_t>(usable.size(), [&](std::size_t i) { return -oblique[i]; });
    const std::size_t outermost = order.size() < 60 ? 1 : 2;
    const std::size_t block = fraction > 0 ? whole_share(fraction) : 0;
    for (std::size_t k = 0; block && k < order.size(); k += block) {
      const std::size_t size = std::min(block, order.size() - k);
      if (size < block && solvers::uniform(random) > double(size) * fraction) continue;
      const auto take = std::max<std::size_t>(1, std::size_t(std::lround(fraction * double(size))));
      std::vector<std::size_t> others;  // that may be held out
      for (std::size_t j = std::max(k, outermost); j < k + size; ++j) others.push_back(order[j]);
      if (others.empty()) continue;
      for (std::size_t t = 0; t < take && t < others.size(); ++t) {
        const std::size_t skipped = size - others.size(), drawn = t + random() % (size - t);
        std::swap(others[t], others[std::max(drawn, skipped + t) - skipped]);
        held[others[t]] = 1;
      }
    }
  }
  Rows rows;
  for (std::size_t i = 0; i < usable.size(); ++i) (held[i] ? rows.holdout : rows.train).push_back(usable[i]);
  return rows;
}

}  // namespace hosel::loop
