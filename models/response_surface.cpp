#include "hosel/models/response_surface.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <cmath>
#include <stdexcept>

#include "hosel/models/rigid_eccentric.hpp"

namespace hosel::models {
namespace {

using Vec12 = Eigen::Matrix<double, 12, 1>;

/// Speed, direction of the head's velocity in the face frame, point of impact.
Eigen::Matrix<double, 5, 1> coordinates(const Delivery& d) {
  const Vec3 v = d.face_to_global().transpose() * d.velocity();
  return {d.club_speed, std::atan2(v.y(), v.x()), std::atan2(v.z(), v.x()), d.impact_toe, d.impact_high};
}

Vec12 in_face(const Launch& l, const Delivery& d) {
  const Mat3 R = d.face_to_global().transpose();
  Vec12 out;
  out << R * l.velocity, R * l.spin, R * l.head_velocity, R * l.head_spin;
  return out;
}

Launch plus(Launch l, const Vec12& more, const Delivery& d) {
  const Mat3 R = d.face_to_global();
  l.velocity += R * more.segment<3>(0);
  l.spin += R * more.segment<3>(3);
  l.head_velocity += R * more.segment<3>(6);
  l.head_spin += R * more.segment<3>(9);
  return l;
}

const RigidEccentric& closed_form() {
  static const RigidEccentric model;
  return model;
}

}  // namespace

Eigen::RowVectorXd ResponseSurface::terms(const Delivery& d, int degree) const {
  const Vec5 x = (coordinates(d) - middle_).cwiseQuotient(half_);
  std::vector<double> t{1};
  for (int i = 0; i < 5; ++i) {
    t.push_back(x[i]);
    for (int j = i; j < 5 && degree >= 2; ++j) {
      t.push_back(x[i] * x[j]);
      for (int k = j; k < 5 && degree >= 3; ++k) t.push_back(x[i] * x[j] * x[k]);
    }
  }
  return Eigen::Map<Eigen::RowVectorXd>(t.data(), std::ptrdiff_t(t.size()));
}

ResponseSurface::ResponseSurface(const ImpactModel& slow, const Blow& blow, const std::vector<Delivery>& deliveries) {
  const auto n = std::ptrdiff_t(deliveries.size());
  if (n < 8) throw std::invalid_argument("a response surface needs at least eight deliveries");
  answers_.resize(deliveries.size());
  std::vector<Launch> rigid(deliveries.size());
  tbb::parallel_for(std::size_t(0), deliveries.size(), [&](std::size_t i) {
    Blow b = blow;
    b.delivery = deliveries[i];
    answers_[i] = slow.launch(b);
    rigid[i] = closed_form().launch(b);
  });
  Vec5 low = coordinates(deliveries.front()), high = low;
  for (const Delivery& d : deliveries) {
    low = low.cwiseMin(coordinates(d));
    high = high.cwiseMax(coordinates(d));
  }
  middle_ = 0.5 * (low + high);
  half_ = (0.5 * (high - low)).cwiseMax(Vec5::Constant(1e-9));  // an input that does not vary has no slope

  Eigen::MatrixXd y(n, 12);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const Delivery& d = deliveries[std::size_t(i)];
    y.row(i) = ((in_face(answers_[std::size_t(i)], d) - in_face(rigid[std::size_t(i)], d)) / d.club_speed).transpose();
  }
  double least = std::numeric_limits<double>::infinity();
  for (int degree = 1; degree <= 3; ++degree) {
    Eigen::MatrixXd A(n, terms(deliveries.front(), degree).size());
    if (3 * A.cols() > 2 * n) break;
    for (std::ptrdiff_t i = 0; i < n; ++i) A.row(i) = terms(deliveries[std::size_t(i)], degree);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
    const Eigen::MatrixXd c = qr.solve(y);
    // Each answer from the others: residual over one minus leverage.
    const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(n, qr.rank());
    const Eigen::VectorXd left = (1 - Q.rowwise().squaredNorm().array()).max(1e-9);
    const Eigen::MatrixXd e = left.cwiseInverse().asDiagonal() * (y - A * c);
    const double sum = (e.colwise().squaredNorm().array() /
                        (y.rowwise() - y.colwise().mean()).colwise().squaredNorm().array().max(1e-30))
                           .head(6)
                           .sum();
    if (sum >= least) continue;
    least = sum;
    degree_ = degree;
    coefficients_ = c;
    Vec12 square = Vec12::Zero();
    predicted_.clear();
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const Delivery& d = deliveries[std::size_t(i)];
      const Vec12 miss = d.club_speed * e.row(i).transpose();
      square += miss.cwiseAbs2() / double(n);
      predicted_.push_back(plus(answers_[std::size_t(i)], -miss, d));
    }
    error_ = square.cwiseSqrt();
  }
}

Launch ResponseSurface::launch(const Blow& blow) const {
  const Vec12 more = blow.delivery.club_speed * (terms(blow.delivery, degree_) * coefficients_).transpose();
  return plus(closed_form().launch(blow), more, blow.delivery);
}

}  // namespace hosel::models
