/// Gauss-Legendre quadrature on [-1, 1].
#pragma once

#include <utility>
#include <vector>

namespace hosel::mesh {

/// Places and weights of the rule of `points` points, 1 to 5, from -1 to 1: exact for polynomials of degree 2 points -
/// 1 (Abramowitz and Stegun, 25.4.30). Throws std::invalid_argument for another number.
std::vector<std::pair<double, double>> gauss(int points);

}  // namespace hosel::mesh
