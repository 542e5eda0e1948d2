#include "hosel/loop/spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

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
    std::vector<std::size_t> order(blows.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    for (std::size_t i = 0; i < blows.size(); ++i) {
      const double within = double(random() >> 11) * 0x1p-53;
      set(blows[i], Input(k), low - spare + (high - low + 2 * spare) * (double(order[i]) + within) / double(points));
    }
  }
  std::vector<Delivery> out;
  for (const Blow& b : blows) out.push_back(b.delivery);
  return out;
}

}  // namespace hosel::loop
