#include "fem/traction_field.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "golf/units.hpp"
#include "mesh/gauss.hpp"

namespace hosel::fem {

struct TractionField::Station {
  Vec2 x;                 // in the plane
  double area = 0, pressure = 0;
  Vec3 push, friction;    // parts of the traction, global
  bool sliding = false;
};

namespace {

constexpr double kShareThatSlides = 0.01;  // of the force; below it there is no slip to speak of
constexpr double kRidge = 0.03;              // of the ratio's slope and curvature
constexpr int kBoundRounds = 6, kFine = 4;   // of friction within its bound; panels of the quadrature
constexpr double kSmallestStick = 0.2;       // of the patch's radius: less cannot be told

/// All that touches, mirror images and turns about the axis included.
struct Touching {
  Vec3 x, push, friction;  // x from the solid's centre
  double area, pressure;
  bool sliding;
};

std::vector<Touching> all_around(const std::vector<ContactPoint>& points, const Placement& placement) {
  constexpr int kTurns = 16;
  std::vector<Mat3> images{Mat3::Identity()};
  const auto [first, last] = std::ranges::minmax(points, {}, &ContactPoint::angle);
  if (first.angle < last.angle && last.angle < kPi) {  // a half circle
    const Vec3 across = placement.axes.col(2);
    images.push_back(Mat3::Identity() - 2 * across * across.transpose());
  } else if (first.angle == last.angle) {
    for (int i = 1; i < kTurns; ++i)
      images.push_back(Eigen::AngleAxisd(2 * kPi * i / kTurns, placement.axes.col(0)).toRotationMatrix());
  }
  std::vector<Touching> out;
  for (const ContactPoint& p : points)
    if (p.pressure > 0)
      for (const Mat3& image : images)
        out.push_back({image * (p.reference - placement.origin), image * p.push, image * (p.traction - p.push),
                       p.area / double(images.size()), p.pressure, p.sliding});
  return out;
}

}  // namespace

TractionField::Quadratic TractionField::monomials(const Vec2& xi) {
  return (Quadratic() << 1, xi.x(), xi.y(), xi.x() * xi.x(), xi.x() * xi.y(), xi.y() * xi.y()).finished();
}

TractionField::Ellipse TractionField::ellipse(const Vec2& centre, const Mat2& shape) {
  const Eigen::SelfAdjointEigenSolver<Mat2> eigen(shape);
  Ellipse e;
  e.centre = centre;
  e.axes = eigen.operatorSqrt();
  e.inverse = eigen.operatorInverseSqrt();
  return e;
}

template <class Visit>
void TractionField::over(const Ellipse& e, int panels, Visit&& visit) const {
  // With u = sqrt(1 - r^2), sqrt(1 - r^2) r dr = -u^2 du: one panel integrates polynomials exactly.
  const int around = 16 * panels;
  const double jacobian = std::abs(e.axes.determinant());
  for (int k = 0; k < panels; ++k)
    for (const auto& [x, w] : mesh::gauss(5)) {
      const double u = (k + 0.5 * (1 + x)) / panels, r = std::sqrt(1 - u * u);
      for (int i = 0; i < around; ++i) {
        const double phi = 2 * kPi * (i + 0.5) / around;
        const Vec2 at = e.centre + e.axes * Vec2(r * std::cos(phi), r * std::sin(phi));
        // Of the surface against the plane; a patch does not reach round the ball.
        const double tilt = std::sqrt(std::max(0.01, 1 - at.squaredNorm() / (radius_ * radius_)));
        visit(at, 0.5 * w / panels * u * u * jacobian * 2 * kPi / around / tilt);
      }
    }
}

TractionField::Ellipse TractionField::with_moments(const Vec2& mean, const Mat2& variance) const {
  // On a plane the variance of sqrt(1 - r^2) is a fifth of the squared axes; the sphere's curvature is a correction.
  Vec2 centre = mean;
  Mat2 shape = 5 * variance;
  Ellipse e = ellipse(centre, shape);
  for (int i = 0; i < 8; ++i) {
    double sum = 0;
    Vec2 first = Vec2::Zero();
    Mat2 second = Mat2::Zero();
    over(e, 1, [&](const Vec2& x, double w) {
      sum += w;
      first += w * (x - mean);
      second += w * (x - mean) * (x - mean).transpose();
    });
    centre -= first / sum;
    shape += 5 * (variance - second / sum);
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
    stations.push_back({plane_.transpose() * t.x, t.area, t.pressure, t.push, t.friction, t.sliding});
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
  Eigen::SelfAdjointEigenSolver<Mat2> eigen(variance);
  const Vec2 spread = eigen.eigenvalues().cwiseMax(footprint / (5 * kPi));
  variance = eigen.eigenvectors() * spread.asDiagonal() * eigen.eigenvectors().transpose();
  patch_ = with_moments(mean, variance);
  double unit = 0;
  over(patch_, 1, [&](const Vec2&, double w) { unit += w; });
  peak_ = force / unit;

  Mat3 normal = Mat3::Zero(), right = Mat3::Zero();
  for (const Station& s : stations) {
    const Vec2 xi = patch_.unit(s.x);
    const Vec3 basis(1, xi.x(), xi.y());
    normal += s.area * s.pressure * basis * basis.transpose();
    right += s.area * s.push * basis.transpose();
  }
  push_ = Mat3(normal).completeOrthogonalDecomposition().solve(Mat3(right.transpose())).transpose();
}

TractionField::Vec2 TractionField::sliding_ratio(const Vec2& x) const {
  // As long as the law has it where the direction is clear; the directions' mean passes through zero where they oppose.
  const Vec2 r = ratio_ * monomials(patch_.unit(x));
  return limit_ / std::max(r.norm(), 0.5 * limit_) * r;
}

void TractionField::fit_friction(const std::vector<Station>& stations) {
  Vec3 inwards = Vec3::Zero();
  double force = 0;
  for (const Station& s : stations) {
    inwards += s.area * s.push;
    force += s.area * s.pressure;
    if (s.friction.norm() > 0) rubbing_ = true;
  }
  if (!rubbing_) return;
  inwards.normalize();
  along_.col(0) = (plane_.col(0) - plane_.col(0).dot(inwards) * inwards).normalized();
  along_.col(1) = inwards.cross(along_.col(0));
  stick_ = patch_;
  // Stations within what sticks may slide by what they alternate: they have no say in the next round.
  bool bounded = false;
  for (int round = 0; round < 3; ++round) {
    fit_ratio(stations, force, bounded);
    bounded = fit_stick(stations, force);
  }

  // Force and first moments are those of the stations, of the friction within its bound as well.
  Mat3 shapes = Mat3::Zero();
  Eigen::Matrix<double, 3, 2> target = Eigen::Matrix<double, 3, 2>::Zero();
  const auto linear = [&](const Vec2& x) {
    const Vec2 xi = stick_.unit(x);
    return Vec3(1, xi.x(), xi.y());
  };
  for (const Station& s : stations) {
    bound_ = std::max(bound_, s.friction.norm() / s.pressure);
    target += s.area * linear(s.x) * (along_.transpose() * s.friction).transpose();
  }
  over(stick_, 1, [&](const Vec2& x, double w) { shapes += w * linear(x) * linear(x).transpose(); });
  const Eigen::LDLT<Mat3> solver(shapes);
  for (int i = 0; i < kBoundRounds; ++i) {
    Eigen::Matrix<double, 3, 2> off = -target;
    over(patch_, kFine, [&](const Vec2& x, double w) {
      const double pressure = peak_ * std::sqrt(1 - patch_.unit(x).squaredNorm());
      off += w * peak_ * linear(x) * friction(x, pressure).transpose() / pressure;
    });
    held_ += solver.solve(off).transpose();
  }
}

TractionField::Vec2 TractionField::friction(const Vec2& x, double pressure) const {
  Vec2 out = pressure * sliding_ratio(x);
  const Vec2 xi = stick_.unit(x);
  if (const double left = 1 - xi.squaredNorm(); left > 0) out -= std::sqrt(left) * (held_ * Vec3(1, xi.x(), xi.y()));
  const double size = out.norm(), most = bound_ * pressure;
  return size > most ? Vec2(most / size * out) : out;
}

void TractionField::fit_ratio(const std::vector<Station>& stations, double force, bool outside) {
  using Six = Eigen::Matrix<double, 6, 6>;
  Six normal = Six::Zero();
  Eigen::Matrix<double, 6, 2> right = Eigen::Matrix<double, 6, 2>::Zero();
  double slid = 0, size = 0;
  for (const Station& s : stations) {
    if (!s.sliding || (outside && stick_.unit(s.x).squaredNorm() < 1)) continue;
    const Quadratic m = monomials(patch_.unit(s.x));
    const double f = s.area * s.pressure;
    slid += f;
    size += s.area * s.friction.norm();
    normal += f * m * m.transpose();
    right += s.area * m * (along_.transpose() * s.friction).transpose();
  }
  ratio_.setZero();
  limit_ = 1;
  if (!(slid > kShareThatSlides * force)) return;
  limit_ = size / slid;
  normal.diagonal().tail<5>().array() += kRidge * slid;  // few stations do not tell a ratio that varies
  ratio_ = normal.ldlt().solve(right).transpose();
}

bool TractionField::fit_stick(const std::vector<Station>& stations, double force) {
  // What friction is short of sliding, and where: moments about the patch's centre.
  const auto lacking = [&](const Station& s) -> Vec2 {
    return s.pressure * sliding_ratio(s.x) - along_.transpose() * s.friction;
  };
  Vec2 sum = Vec2::Zero();
  for (const Station& s : stations) sum += s.area * lacking(s);
  const Vec2 direction = sum.normalized();
  double total = 0;
  Vec2 mean = Vec2::Zero();
  Mat2 variance = Mat2::Zero();
  for (const Station& s : stations) {
    const double f = s.area * direction.dot(lacking(s));
    const Vec2 xi = patch_.unit(s.x);
    total += f;
    mean += f * xi;
    variance += f * xi * xi.transpose();
  }
  stick_ = patch_;
  if (!(total > kShareThatSlides * limit_ * force) || ratio_.isZero()) return false;
  mean /= total;
  variance = variance / total - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat2> eigen(variance);
  const double room = 1 - mean.norm();  // within the patch
  if (!(room > kSmallestStick && eigen.eigenvalues().minCoeff() > 0)) return false;
  const Vec2 axes = (5 * eigen.eigenvalues()).cwiseSqrt().cwiseMin(room).cwiseMax(kSmallestStick);
  stick_.centre = patch_.centre + patch_.axes * mean;
  stick_.axes = patch_.axes * eigen.eigenvectors() * axes.asDiagonal();
  stick_.inverse = stick_.axes.inverse();
  return true;
}

TractionField::Value TractionField::at(const Vec3& reference) const {
  Value out;
  if (!touching_) return out;
  const Vec3 from = reference - origin_;
  if (from.dot(outwards_) <= 0) return out;
  const Vec2 x = plane_.transpose() * from, xi = patch_.unit(x);
  const double rest = 1 - xi.squaredNorm();
  if (rest <= 0) return out;
  out.pressure = peak_ * std::sqrt(rest);
  if (rubbing_) out.tangential = along_ * friction(x, out.pressure);
  out.traction = out.pressure * (push_ * Vec3(1, xi.x(), xi.y())) + out.tangential;
  return out;
}

Eigen::Vector2d TractionField::semi_axes() const {
  if (!touching_) return Vec2::Zero();
  return Eigen::SelfAdjointEigenSolver<Mat2>(patch_.axes).eigenvalues().reverse();
}

}  // namespace hosel::fem
