/// Where shots scatter in a plane: mean, covariance, ellipses.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "post/figure.hpp"

namespace hosel::post {

struct Scatter {
  std::vector<Eigen::Vector2d> at;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< zero of a single point

  explicit Scatter(std::vector<Eigen::Vector2d> points);
  /// The ellipse that holds a share of a normal distribution of this mean and covariance.
  Series ellipse(double share, std::string label) const;
  /// The longer and the shorter axis of that ellipse, wherever they lie.
  Eigen::Vector2d extent(double share) const;
  /// A unit vector along the longer axis.
  Eigen::Vector2d longer() const;
};

}  // namespace hosel::post
