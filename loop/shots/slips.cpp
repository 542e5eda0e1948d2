#include "loop/shots/slips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <map>

#include "loop/result.hpp"

namespace hosel::loop {
namespace {

/// Probability that places drawn evenly between 0 and 1 (rising) stand together as much, anywhere or at both ends.
double by_chance(const std::vector<double>& place) {
  const double n = double(place.size()), root = std::sqrt(n);
  double above = 0, below = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    above = std::max(above, double(i + 1) / n - place[i]);
    below = std::max(below, place[i] - double(i) / n);
  }
  const double x = (root + 0.155 + 0.24 / root) * (above + below);  // [@kuiper], Stephens's form for few
  if (x < 0.4) return 1;
  double p = 0;
  for (int j = 1; j <= 20; ++j) p += 2 * (4 * j * j * x * x - 1) * std::exp(-2 * j * j * x * x);
  return std::min(p, 1.0);
}

}  // namespace

const Line* stand_together(const std::vector<RowFlag>& flagged, const std::vector<Line>& lines, double gate,
                           std::size_t& together) {
  const Line* along = nullptr;
  double least = gate / double(lines.size());
  for (const Line& l : lines) {
    std::vector<int> with;
    for (int i = 0; i < l.x.size(); ++i)
      if (std::isfinite(l.x[i])) with.push_back(i);
    // Equal numbers in the order of their rows.
    std::ranges::stable_sort(with, {}, [&](int i) { return l.x[i]; });
    std::vector<double> place;
    for (std::size_t k = 0; k < with.size(); ++k)
      if (std::ranges::any_of(flagged, [&](const RowFlag& f) { return f.shot == with[k] && f.column != l.name; }))
        place.push_back((double(k) + 0.5) / double(with.size()));
    if (place.size() < 2) continue;
    if (const double p = by_chance(place); p < least) along = &l, least = p, together = place.size();
  }
  return along;
}

std::optional<Location> no_single_slips(const std::vector<RowFlag>& flagged, const std::vector<ColumnUse>& uses,
                                        const std::vector<Line>& lines, double gate) {
  std::map<std::string, int> of_column;
  for (const RowFlag& f : flagged) ++of_column[f.column];
  const std::string* alike = nullptr;
  int most = 0;
  for (const auto& [column, rows] : of_column) {
    const boost::math::binomial chance(double(flagged.size()), 1 / double(uses.size()));
    if (rows > most && double(uses.size()) * cdf(complement(chance, rows - 1)) < gate) alike = &column, most = rows;
  }
  if (alike)
    return Location{"", *alike,
                    fmt::format("{} of {} flagged rows contradict the others in this column, too many for single slips",
                                most, flagged.size())};

  std::size_t together = 0;
  const Line* along = stand_together(flagged, lines, gate, together);
  if (!along) return {};
  return Location{"", along->name,
                  fmt::format("{} flagged rows stand together along it, too closely for single slips", together)};
}

}  // namespace hosel::loop
