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
    return {fixed(value, decimals), fmt::format("{:.{}f}", sd, decimals)};
  }
  return {fmt::format("{:.{}e}", value, std::max(0, first - last)), fmt::format("{:.1e}", sd)};
}

std::string with_deviation(double value, double sd) {
  const Digits d = digits(value, sd);
  return d.value + " ± " + d.deviation;
}

std::string fixed(double value, int decimals, bool sign) {
  std::string text = sign ? fmt::format("{:+.{}f}", value, decimals) : fmt::format("{:.{}f}", value, decimals);
  const bool zero = std::isfinite(value) && text.find_first_of("123456789") == text.npos;
  if (zero && (text.front() == '-' || text.front() == '+')) text.erase(0, 1);
  return text;
}

std::string error_bound(double error, int decimals) {
  const double digit = std::pow(10, -decimals), digits = error / digit;
  // An error that ends at the last digit but for its round-off is no larger.
  return fmt::format("{:.{}f}", std::max(std::ceil(digits * (1 - 1e-9)), 1.0) * digit, decimals);
}

std::string beside(double value, double scale, bool sign, int digits) {
  constexpr double round_off = 1e-9, of_zero = 1e-12;
  if (std::abs(value) <= std::max(round_off * std::abs(scale), of_zero)) return "0";
  return sign ? fmt::format("{:+.{}g}", value, digits) : fmt::format("{:.{}g}", value, digits);
}

}  // namespace hosel::post
