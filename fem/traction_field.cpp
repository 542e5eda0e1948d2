#include "fem/traction_field.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "golf/dense.hpp"
#include "golf/units.hpp"
#include "mesh/gauss.hpp"

namespace hosel::fem {

struct TractionField::Station {
  Vec2 x;  // in the plane
  double area = 0, pressure = 0;
  Vec3 push, friction;  // parts of the traction, global
};

namespace {

constexpr int kBoundRounds = 20;          // of friction within its bound
constexpr int kAround = 32, kAcross = 5;  // points of the quadrature, the latter within the inner ellipse and outside
constexpr double kLargestInner = 0.99;    // of a patch that sticks to its rim

/// All that touches, mirror images and turns about the axis included.
struct Touching {
  Vec3 x, push, friction;  // x from the solid's centre
  double area, pressure;
};

std::vector<Touching> all_around(const std::vector<ContactPoint>& points, const Placement& placement) {
  constexpr int kTurns = 16;
  if (points.empty()) return {};
  std::vector<Mat3> images{Mat3::Identity()};
  const auto [first, last] = std::ranges::minmax(points | std::views::transform(&ContactPoint::angle));
  if (first < last && last < kPi) {  // a half circle
    const Vec3 across = placement.axes.col(2);
    images.push_back(Mat3::Identity() - 2 * across * across.transpose());
  } else if (first == last) {
    for (int i = 1; i < kTurns; ++i)
      images.push_back(Eigen::AngleAxisd(2 * kPi * i / kTurns, placement.axes.col(0)).toRotationMatrix());
  }
  std::vector<Touching> out;
  for (const ContactPoint& p : points)
    if (p.pressure > 0)
      for (const Mat3& image : images)
        out.push_back({image * (p.reference - placement.origin), image * p.push, image * (p.traction - p.push),
                       p.area / double(images.size()), p.pressure});
  return out;
}

/// Of a symmetric matrix in the plane: what it is along its principal axes.
struct Principal {
  Eigen::Vector2d values;
  Eigen::Matrix2d axes;
  explicit Principal(const Eigen::Matrix2d& m) {
    const dense::Eigenpairs of = dense::eigenpairs(m);
    values = of.values;
    axes = of.vectors;
  }
  /// The symmetric matrix of the same axes with other values.
  Eigen::Matrix2d with(const Eigen::Vector2d& other) const { return axes * other.asDiagonal() * axes.transpose(); }
};

/// r at the rim of the inner ellipse: the largest c with |a| <= bound, where a at the rim follows from the mean ratio
/// of friction and pressure, f = a + b c^3, and from the mean weighed by r^2, m = a + b c^5.
double stuck(const Eigen::Vector2d& f, const Eigen::Vector2d& m, double bound) {
  const auto within = [&](double c) { return (m - f * c * c).norm() <= bound * (1 - c * c); };
  double least = 0, most = kLargestInner;
  if (within(most)) return most;
  for (int i = 0; i < 40; ++i) {
    const double c = 0.5 * (least + most);
    (within(c) ? least : most) = c;
  }
  return least;
}

}  // namespace

TractionField::Four TractionField::shapes(const Vec2& xi) const {
  // Of both ellipses over the pressure: sqrt(c^2 - r^2) / sqrt(1 - r^2) within the inner one.
  const double r2 = xi.squaredNorm(), within = inner_ * inner_ - r2;
  return {1, within > 0 ? std::sqrt(within / (1 - r2)) : 0, xi.x(), xi.y()};
}

TractionField::Ellipse TractionField::ellipse(const Vec2& centre, const Mat2& shape) {
  const Principal of(shape);
  Ellipse e;
  e.centre = centre;
  e.axes = of.with(of.values.cwiseSqrt());
  e.inverse = of.with(of.values.cwiseSqrt().cwiseInverse());
  return e;
}

template <class Visit>
void TractionField::over(const Ellipse& e, double inner, Visit&& visit) const {
  // With u = sqrt(1 - r^2), sqrt(1 - r^2) r dr = -u^2 du: outside, polynomials are exact. Within, u^2 = b^2 + (c s)^2,
  // b = sqrt(1 - c^2): there c s is sqrt(c^2 - r^2).
  const double jacobian = std::abs(e.axes.determinant()), b = std::sqrt(1 - inner * inner);
  const auto ring = [&](double u, double weight) {
    const double r = std::sqrt(std::max(0.0, 1 - u * u));
    for (int i = 0; i < kAround; ++i) {
      const double phi = 2 * kPi * (i + 0.5) / kAround;
      const Vec2 at = e.centre + e.axes * Vec2(r * std::cos(phi), r * std::sin(phi));
      // Of the surface against the plane; a patch does not reach round the ball.
      const double tilt = std::sqrt(std::max(0.01, 1 - at.squaredNorm() / (radius_ * radius_)));
      visit(at, weight * jacobian * 2 * kPi / kAround / tilt);
    }
  };
  for (const auto& [x, w] : mesh::gauss(kAcross)) {
    const double t = 0.5 * (1 + x);
    ring(b * t, 0.5 * w * b * (b * t) * (b * t));
    if (inner == 0) continue;
    const double u = std::hypot(b, inner * t);
    ring(u, 0.5 * w * inner * inner * t * u);
  }
}

TractionField::Ellipse TractionField::with_moments(const Vec2& mean, const Mat2& variance) const {
  // On a plane the variance of sqrt(1 - r^2) is a fifth of the squared axes; the sphere's curvature is a correction.
  Vec2 centre = mean;
  Mat2 shape = 5 * variance;
  Ellipse e = ellipse(centre, shape);
  const double most = 1.2 * radius_;  // of a semi-axis: the patch does not reach round the ball
  for (int i = 0; i < 24; ++i) {
    double sum = 0;
    Vec2 first = Vec2::Zero();
    Mat2 second = Mat2::Zero();
    over(e, 0, [&](const Vec2& x, double w) {
      sum += w;
      first += w * (x - mean);
      second += w * (x - mean) * (x - mean).transpose();
    });
    centre -= first / sum;
    // Half of what is asked for: a patch whose pressure is large at the rim asks for more than the next step gives.
    const Principal next(shape + 2.5 * (variance - second / sum));
    const double least = std::pow(Principal(e.axes).values[0], 2);
    shape = next.with(next.values.cwiseMax(0.25 * least).cwiseMin(most * most));
    e = ellipse(centre, shape);
  }
  return e;
}

TractionField::TractionField(const HarmonicSolid& solid, const std::vector<ContactPoint>& points)
    : origin_(solid.placement().origin), radius_(solid.mesh().radius) {
  const Placement& placement = solid.placement();
  const std::vector<Touching> touching = all_around(points, placement);
  Vec3 middle = Vec3::Zero();
  for (const Touching& t : touching) middle += t.area * t.pressure * t.x;
  if (!(middle.norm() > 0)) return;
  touching_ = true;
  outwards_ = middle.normalized();
  plane_.col(0) = (placement.axes.col(1) - placement.axes.col(1).dot(outwards_) * outwards_).normalized();
  plane_.col(1) = outwards_.cross(plane_.col(0));
  std::vector<Station> stations;
  for (const Touching& t : touching)
    stations.push_back({plane_.transpose() * t.x, t.area, t.pressure, t.push, t.friction});
  fit_pressure(stations);
  fit_friction(stations);
}

void TractionField::fit_pressure(const std::vector<Station>& stations) {
  double force = 0, footprint = 0;
  Vec2 mean = Vec2::Zero();
  for (const Station& s : stations) {
    const double f = s.area * s.pressure;
    force += f;
    footprint += f * s.area;
    mean += f * s.x;
  }
  mean /= force;
  footprint /= force;
  Mat2 variance = Mat2::Zero();
  for (const Station& s : stations) variance += s.area * s.pressure / force * (s.x - mean) * (s.x - mean).transpose();
  // A patch of one or two stations is as large as they are.
  const Principal own(variance);
  variance = own.with(own.values.cwiseMax(footprint / (5 * kPi)));
  patch_ = with_moments(mean, variance);
  double unit = 0;
  over(patch_, 0, [&](const Vec2&, double w) { unit += w; });
  peak_ = force / unit;

  Mat3 normal = Mat3::Zero(), right = Mat3::Zero();
  for (const Station& s : stations) {
    const Vec2 xi = patch_.unit(s.x);
    const Vec3 basis(1, xi.x(), xi.y());
    normal += s.area * s.pressure * basis * basis.transpose();
    right += s.area * s.push * basis.transpose();
  }
  push_ = dense::minimum_norm(normal, Eigen::MatrixXd(right.transpose())).transpose();
}

void TractionField::fit_friction(const std::vector<Station>& stations) {
  Vec3 inwards = Vec3::Zero();
  for (const Station& s : stations) {
    inwards += s.area * s.push;
    bound_ = std::max(bound_, s.friction.norm() / s.pressure);
  }
  if (bound_ == 0) return;
  inwards.normalize();
  along_.col(0) = (plane_.col(0) - plane_.col(0).dot(inwards) * inwards).normalized();
  along_.col(1) = inwards.cross(along_.col(0));

  // Moments of 1, r^2 and xi.
  const auto tested = [](const Vec2& xi) { return Four(1, xi.squaredNorm(), xi.x(), xi.y()); };
  using Moments = Eigen::Matrix<double, 4, 2>;
  Moments target = Moments::Zero();
  for (const Station& s : stations)
    target += s.area * tested(patch_.unit(s.x)) * (along_.transpose() * s.friction).transpose();
  Four pressure = Four::Zero();
  over(patch_, 0, [&](const Vec2& x, double w) { pressure += w * peak_ * tested(patch_.unit(x)); });
  inner_ = stuck(target.row(0).transpose() / pressure[0], target.row(1).transpose() / pressure[1], bound_);

  struct Point {
    double pressure;
    Four shapes, tested;
  };
  std::vector<Point> points;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  over(patch_, inner_, [&](const Vec2& x, double w) {
    const Vec2 xi = patch_.unit(x);
    points.push_back({w * peak_, shapes(xi), tested(xi)});
    matrix += points.back().pressure * points.back().tested * points.back().shapes.transpose();
  });
  // Where the bound cuts the ratio, the rest of the patch takes over its share.
  for (int i = 0; i < kBoundRounds; ++i) {
    Moments off = target;
    for (const Point& p : points) off -= p.pressure * p.tested * ratio(p.shapes).transpose();
    ratio_ += dense::minimum_norm(matrix, Eigen::MatrixXd(off)).transpose();
  }
}

TractionField::Vec2 TractionField::ratio(const Four& of_shapes) const {
  const Vec2 r = ratio_ * of_shapes;
  const double size = r.norm();
  return size > bound_ ? Vec2(bound_ / size * r) : r;
}

TractionField::Value TractionField::at(const Vec3& reference) const {
  Value out;
  if (!touching_) return out;
  const Vec3 from = reference - origin_;
  if (from.dot(outwards_) <= 0) return out;
  const Vec2 x = plane_.transpose() * from, xi = patch_.unit(x);
  const double rest = 1 - xi.squaredNorm();
  if (!(rest > 0)) return out;
  out.pressure = peak_ * std::sqrt(rest);
  if (bound_ > 0) out.tangential = along_ * (out.pressure * ratio(shapes(xi)));
  out.traction = out.pressure * (push_ * Vec3(1, xi.x(), xi.y())) + out.tangential;
  return out;
}

}  // namespace hosel::fem
