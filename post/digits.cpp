#include "post/digits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hosel::post {

Digits digits(double value, double sd) {
  if (!(sd > 0) || !std::isfinite(sd) || !std::isfinite(value))
    return {std::isfinite(value) ? fmt::format("{:.4g}", value) : "–", "–"};
  const auto place = [](double x) { return int(std::floor(std::log10(std::abs(x)))); };
  const int last = place(sd) - 1, first = value == 0 ? last : place(value);
  // As a plain number where it is short.
  if (first < 6 && last > -7) {
    const int decimals = std::max(0, -last);
    // What rounds to zero has no sign.
    const double rounded = std::abs(value) < 0.5 * std::pow(10, -decimals) ? 0 : value;
    return {fmt::format("{:.{}f}", rounded, decimals), fmt::format("{:.{}f}", sd, decimals)};
  }
  return {fmt::format("{:.{}e}", value, std::max(0, first - last)), fmt::format("{:.1e}", sd)};
}

std::string with_deviation(double value, double sd) {
  const Digits d = digits(value, sd);
  return d.value + " ± " + d.deviation;
}

std::string beside(double value, double scale, bool sign) {
  constexpr double round_off = 1e-9, of_zero = 1e-12;
  if (std::abs(value) <= std::max(round_off * std::abs(scale), of_zero)) return "0";
  return sign ? fmt::format("{:+.4g}", value) : fmt::format("{:.4g}", value);
}

}  // namespace hosel::post
