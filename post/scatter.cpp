#include "post/scatter.hpp"

#include <cmath>
#include <numbers>

#include "golf/dense.hpp"

namespace hosel::post {
namespace {

using Eigen::Vector2d;

/// Squared radius, in standard deviations, of the circle that holds a share of a normal distribution in the plane.
double squared_radius(double share) { return -2 * std::log(1 - share); }

}  // namespace

Scatter::Scatter(std::vector<Vector2d> points) : at(std::move(points)) {
  for (const Vector2d& p : at) mean += p / double(at.size());
  for (const Vector2d& p : at)
    if (at.size() > 1) covariance += (p - mean) * (p - mean).transpose() / double(at.size() - 1);
}

Series Scatter::ellipse(double share, std::string label) const {
  const dense::Eigenpairs axes = dense::eigenpairs(covariance);
  const Eigen::Matrix2d along = axes.vectors;
  const Vector2d spread = axes.values.cwiseMax(0).cwiseSqrt();
  const Eigen::Matrix2d root = along * spread.asDiagonal() * along.transpose() * std::sqrt(squared_radius(share));
  Series out{.label = std::move(label), .style = "lines"};
  constexpr int corners = 90;
  for (int k = 0; k <= corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    const Vector2d p = mean + root * Vector2d(std::cos(angle), std::sin(angle));
    out.x.push_back(p.x());
    out.y.push_back(p.y());
  }
  return out;
}

Vector2d Scatter::extent(double share) const {
  const Vector2d v = dense::eigenpairs(covariance).values;
  return 2 * (v.reverse() * squared_radius(share)).cwiseMax(0).cwiseSqrt();
}

Vector2d Scatter::longer() const { return dense::eigenpairs(covariance).vectors.col(1); }

}  // namespace hosel::post
