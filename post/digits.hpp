/// Digits of a number beside its standard deviation.
#pragma once

#include <string>

namespace hosel::post {

/// Both end at the same decimal place: the second digit of the deviation.
struct Digits {
  std::string value, deviation;
};
/// `sd` not positive or not finite: four digits of the value, and "–".
Digits digits(double value, double sd);
/// "1.234 ± 0.056"
std::string with_deviation(double value, double sd);

/// With so many decimals, with the sign where `sign`; what prints as zero has none.
std::string fixed(double value, int decimals, bool sign = false);
/// A numerical error, which is an upper bound: its last digit is rounded up, and none is zero.
std::string error_bound(double error, int decimals);

/// So many digits, with the sign where `sign`; zero where it is round-off of numbers of that `scale`, or of zeros.
std::string beside(double value, double scale, bool sign = false, int digits = 4);

}  // namespace hosel::post
