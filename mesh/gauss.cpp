#include "mesh/gauss.hpp"

#include <cmath>
#include <stdexcept>

namespace hosel::mesh {

std::vector<std::pair<double, double>> gauss(int points) {
  switch (points) {
    case 1: return {{0, 2}};
    case 2: return {{-1 / std::sqrt(3.0), 1}, {1 / std::sqrt(3.0), 1}};
    case 3: return {{-std::sqrt(0.6), 5.0 / 9}, {0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}};
    case 4: {
      const double a = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2)), b = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
      const double wa = (18 + std::sqrt(30.0)) / 36, wb = (18 - std::sqrt(30.0)) / 36;
      return {{-b, wb}, {-a, wa}, {a, wa}, {b, wb}};
    }
    case 5: {
      const double a = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3, b = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
      const double wa = (322 + 13 * std::sqrt(70.0)) / 900, wb = (322 - 13 * std::sqrt(70.0)) / 900;
      return {{-b, wb}, {-a, wa}, {0, 128.0 / 225}, {a, wa}, {b, wb}};
    }
    default: throw std::invalid_argument("a Gauss rule has 1 to 5 points");
  }
}

}  // namespace hosel::mesh
