#include "app/import/statistics.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace hosel::app {

bool Statistics::take(const Row& row) {
  Cells cells;
  for (const std::size_t c : columns_) cells.push_back(number(row[c], comma_, Sides::any));
  if (of(all_, cells, row) || of(run_, cells, row)) return true;
  add(all_, cells, row);
  add(run_, cells, row);
  return false;
}

/// One in the last digit of a cell.
double Statistics::step(const std::string& cell) const {
  const auto point = cell.find_last_of(comma_ ? "," : ".");
  if (point == std::string::npos) return 1;
  std::size_t digits = 0;
  while (point + digits + 1 < cell.size() && std::isdigit(static_cast<unsigned char>(cell[point + digits + 1])))
    ++digits;
  return std::pow(10.0, -double(digits));
}

void Statistics::add(Columns& to, const Cells& cells, const Row& row) const {
  to.resize(columns_.size());
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (!cells[k]) continue;
    Column& c = to[k];
    const double x = cells[k]->value;
    if (c.n == 0) c.first = c.low = c.high = x;
    c.n += 1;
    c.sum += x - c.first;
    c.squares += (x - c.first) * (x - c.first);
    c.low = std::min(c.low, x), c.high = std::max(c.high, x);
    c.step = std::min(c.step, step(row[columns_[k]]));
  }
}

/// The same statistic in every column, four of which vary: no shot is so near to the mean in each.
bool Statistics::of(const Columns& above, const Cells& cells, const Row& row) const {
  std::array<bool, 5> fits;
  fits.fill(true);
  std::size_t varying = 0;
  for (std::size_t k = 0; k < above.size(); ++k) {
    const Column& c = above[k];
    if (!cells[k] || c.n < 5) continue;
    const double x = cells[k]->value, last = step(row[columns_[k]]), mean = c.sum / c.n;
    const double squares = std::max(0.0, c.squares - c.n * mean * mean);
    const double rounding = 0.6 * last + c.step / std::sqrt(c.n);
    varying += c.high - c.low > 4 * rounding;
    const auto near = [&](double is, double within) { return std::abs(x - is) < within; };
    const std::array now = {near(c.first + mean, rounding), near(std::sqrt(squares / c.n), rounding),
                            near(std::sqrt(squares / (c.n - 1)), rounding), near(c.low, 0.6 * last),
                            near(c.high, 0.6 * last)};
    for (std::size_t f = 0; f < fits.size(); ++f) fits[f] = fits[f] && now[f];
  }
  return varying >= 4 && std::ranges::count(fits, true) > 0;
}

}  // namespace hosel::app
