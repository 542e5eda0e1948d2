#include "hosel/loop/shots/spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hosel/solvers/random.hpp"

namespace hosel::loop {

std::vector<Delivery> spread(const Shots& shots, int points, unsigned long seed) {
  std::vector<Blow> blows(static_cast<std::size_t>(points));
  std::mt19937_64 random(seed);
  for (int k = 0; k < kInputs; ++k) {
    if (Input(k) == Input::head_mass) continue;
    const Column* column = shots.find_stem(stem(Input(k)));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    if (column)
      for (const double x : column->value)
        if (std::isfinite(x)) {
          low = std::min(low, x);
          high = std::max(high, x);
        }
    if (!(low <= high)) {
      if (Input(k) == Input::club_speed || Input(k) == Input::dynamic_loft)
        throw DataError(fmt::format("{}:1: a surrogate needs recorded {}", shots.file, stem(Input(k))));
      continue;
    }
    const double spare = 0.01 * (high - low);
    const std::vector<double> x = solvers::latin_column(low - spare, high + spare, blows.size(), random);
    for (std::size_t i = 0; i < blows.size(); ++i) set(blows[i], Input(k), x[i]);
  }
  std::vector<Delivery> out;
  for (const Blow& b : blows) out.push_back(b.delivery);
  return out;
}

}  // namespace hosel::loop
