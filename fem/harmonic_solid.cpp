#include "fem/harmonic_solid.hpp"

#include <tbb/blocked_range.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "golf/parallel.hpp"
#include "mesh/gauss.hpp"

namespace hosel::fem {
namespace {

int largest_order(const FourierBasis& basis) {
  int order = 0;
  for (const auto& f : basis) order = std::max(order, f.order);
  return order;
}

/// Columns e_s, e_rho, e_theta.
Mat3 cylindrical(double theta) {
  Mat3 frame;
  frame << 1, 0, 0, 0, std::cos(theta), -std::sin(theta), 0, std::sin(theta), std::cos(theta);
  return frame;
}

}  // namespace

HarmonicSolid::HarmonicSolid(DofMap& dof_map, mesh::Meridian mesh, FourierBasis basis, SolidQuadrature quadrature,
                             std::vector<Solid> materials, Placement placement, std::string body)
    : body_(std::move(body)),
      mesh_(std::move(mesh)),
      basis_(std::move(basis)),
      quadrature_(std::move(quadrature)),
      materials_(std::move(materials)),
      placement_(std::move(placement)) {
  if (static_cast<int>(materials_.size()) != mesh_.layers)
    throw std::invalid_argument("harmonic solid: one material for each layer");
  for (const Solid& m : materials_) {
    if (const auto faults = m.faults(); !faults.empty())
      throw std::invalid_argument("harmonic solid: " + faults.front());
    corotated_ = corotated_ || m.elastic.corotated();
  }
  dissipated_.assign(materials_.size(), 0);

  const Index K = unknowns();
  Index count = 0;
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
    for (Index k = 0; k < K; ++k) {
      const bool free = !mesh_.on_axis(static_cast<int>(n)) || basis_[static_cast<std::size_t>(k)].order == 0;
      dof_.push_back(free ? count++ : -1);
    }
  block_ = dof_map.add_vector(count);
  for (Index& e : dof_)
    if (e >= 0) e += block_.v;

  for (const auto& element : mesh_.elements) {
    element_equations_.emplace_back();
    element_dofs_.emplace_back();
    for (int i = 0; i < 8; ++i)
      for (Index k = 0; k < K; ++k)
        if (const Index e = dof(element[static_cast<std::size_t>(i)], k); e >= 0) {
          element_equations_.back().push_back(e);
          element_dofs_.back().push_back(static_cast<int>(i * K + k));
        }
  }

  const AngularRule circle = full_circle(2 * largest_order(basis_) + 3);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(K, K);
  for (double theta : circle.theta)
    for (Index k = 0; k < K; ++k)
      for (Index l = 0; l < K; ++l)
        gram(k, l) += circle.weight *
                      basis_[static_cast<std::size_t>(k)].at(theta).dot(basis_[static_cast<std::size_t>(l)].at(theta));
  norms_ = gram.diagonal();
  gram.diagonal().setZero();
  if (!gram.isZero(1e-12)) throw std::invalid_argument("harmonic solid: the angular functions must be orthogonal");
  const AngularRule& angles = quadrature_.angles;
  const auto n = static_cast<Index>(angles.theta.size());
  padded_ = (n + kLanes - 1) / kLanes * kLanes;
  for (int c = 0; c < 3; ++c) {
    Direction& d = directions_[static_cast<std::size_t>(c)];
    for (Index k = 0; k < K; ++k) {
      const AngularFunction& f = basis_[static_cast<std::size_t>(k)];
      if (f.cosine[c] != 0 || f.sine[c] != 0) d.functions.push_back(k);
    }
    const auto active = static_cast<Index>(d.functions.size());
    d.value.setZero(padded_, active);
    d.derivative.setZero(padded_, active);
    for (Index k = 0; k < active; ++k)
      for (Index j = 0; j < n; ++j) {
        const AngularFunction& f = basis_[static_cast<std::size_t>(d.functions[static_cast<std::size_t>(k)])];
        const double theta = angles.theta[static_cast<std::size_t>(j)];
        d.value(j, k) = f.at(theta)[c];
        d.derivative(j, k) = f.derivative(theta)[c];
      }
  }
  for (std::size_t left = 0; left < 3; ++left)
    for (std::size_t right = left; right < 3; ++right) {
      Coupling& q = couplings_.emplace_back();
      q.left = left;
      q.right = right;
      const Direction &a = directions_[left], &b = directions_[right];
      for (int J = 0; J < 2; ++J)
        for (int L = 0; L < 2; ++L) {
          q.product[J][L].resize(a.value.cols() * b.value.cols(), n);
          for (Index l = 0; l < b.value.cols(); ++l)
            for (Index k = 0; k < a.value.cols(); ++k)
              q.product[J][L].row(k + l * a.value.cols()) =
                  (J ? a.derivative : a.value)
                      .col(k)
                      .head(n)
                      .cwiseProduct((L ? b.derivative : b.value).col(l).head(n))
                      .transpose();
        }
    }
  for (double theta : angles.theta) frames_.push_back(cylindrical(theta));
  frame_components_.resize(padded_, 9);
  for (Index j = 0; j < padded_; ++j)  // beyond the angles an undeformed point
    frame_components_.row(j) = frames_[static_cast<std::size_t>(std::min(j, n - 1))].reshaped().transpose();

  const auto rule = mesh::gauss(quadrature_.points);
  std::size_t start = 0, step_start = 0;
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    const Solid& material = materials_[static_cast<std::size_t>(mesh_.layer[e])];
    for (const auto& [y, wy] : rule)
      for (const auto& [x, wx] : rule) {
        Point p = point(mesh_, e, x, y, wx * wy);
        p.weight *= angles.weight;
        points_.push_back(p);
        history_start_.push_back(start);
        start += static_cast<std::size_t>(material.history_size() * n);
        start_of_point_.push_back(step_start);
        step_start += static_cast<std::size_t>(material.start_size() * padded_);
      }
    element_mass_.push_back(element_mass(mesh_, e, material.density));
  }
  history_.assign(start, 0);
  starts_.assign(step_start + static_cast<std::size_t>(padded_), 0);  // a row also where no material has a history
  starts_of_.assign(mesh_.elements.size(), NAN);
  found_.resize(mesh_.elements.size());
  stiffness_.resize(mesh_.elements.size());
  const std::size_t per = points_per_element();
  gradients_.resize(8, 3 * static_cast<Index>(points_.size()));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto at = static_cast<Index>(3 * per * (i / per)), p = static_cast<Index>(i % per);
    gradients_.col(at + 2 * p) = points_[i].ds;
    gradients_.col(at + 2 * p + 1) = points_[i].drho;
    gradients_.col(at + 2 * static_cast<Index>(per) + p) = points_[i].value / points_[i].rho;
  }
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Solid& material = materials_[static_cast<std::size_t>(mesh_.layer[p / per])];
    const auto size = static_cast<std::size_t>(material.history_size());
    for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j)
      material.start(std::span(history_).subspan(history_start_[p] + j * size, size));
    for (Index j = n; j < padded_ && size > 0; ++j)
      start_step(material, 0, history_at(p, 0), starts_.data() + start_of_point_[p] + j, padded_);
  }

  if (corotated_) {
    // Volume mean of the displacement gradient as a linear function of the unknowns.
    mean_gradient_ = Eigen::MatrixXd::Zero(9, count);
    double total = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const Point& g = points_[p];
      const auto& element = mesh_.elements[p / per];
      total += g.weight * static_cast<double>(n);
      for (int i = 0; i < 8; ++i)
        for (Index k = 0; k < K; ++k) {
          const Index e = dof(element[static_cast<std::size_t>(i)], k);
          if (e < 0) continue;
          Mat3 sum = Mat3::Zero();
          for (Index j = 0; j < n; ++j) {
            const Mat3& f = frames_[static_cast<std::size_t>(j)];
            const AngularFunction& function = basis_[static_cast<std::size_t>(k)];
            const double theta = angles.theta[static_cast<std::size_t>(j)];
            sum += function.at(theta) * (g.ds[i] * f.col(0) + g.drho[i] * f.col(1)).transpose() +
                   function.derivative(theta) * (g.value[i] / g.rho * f.col(2)).transpose();
          }
          mean_gradient_.col(e - block_.v) += g.weight * Eigen::Map<Eigen::Matrix<double, 9, 1>>(sum.data());
        }
    }
    mean_gradient_ /= total;
  }
}

HarmonicSolid::Point HarmonicSolid::point(const mesh::Meridian& mesh, std::size_t element, double x, double y,
                                          double w) {
  const mesh::Q8 q = mesh::Q8::at(x, y);
  Eigen::Matrix<double, 8, 2> nodes;
  for (int i = 0; i < 8; ++i)
    nodes.row(i) = mesh.nodes[static_cast<std::size_t>(mesh.elements[element][static_cast<std::size_t>(i)])];
  const Eigen::Matrix2d jacobian = q.derivative.transpose() * nodes;  // rows d/dxi, d/deta
  const double det = jacobian.determinant();
  if (!(det > 0)) throw std::invalid_argument("harmonic solid: an element of the mesh is turned inside out");
  const Eigen::Matrix<double, 8, 2> gradient = q.derivative * jacobian.inverse().transpose();
  Point p{q.value, gradient.col(0), gradient.col(1), nodes.col(1).dot(q.value), 0};
  p.weight = det * w * p.rho;
  return p;
}

Eigen::Matrix<double, 8, 8> HarmonicSolid::element_mass(const mesh::Meridian& mesh, std::size_t element,
                                                        double density) {
  const auto rule = mesh::gauss(3);
  Eigen::Matrix<double, 8, 8> m = Eigen::Matrix<double, 8, 8>::Zero();
  for (const auto& [y, wy] : rule)
    for (const auto& [x, wx] : rule) {
      const Point p = point(mesh, element, x, y, wx * wy);
      m += density * p.weight * p.value * p.value.transpose();
    }
  return m;
}

Index HarmonicSolid::offset(int node, Index k) const {
  const Index e = dof(node, k);
  return e < 0 ? -1 : e - block_.v + block_.q;
}

void HarmonicSolid::pattern(std::vector<std::vector<Index>>& blocks) const {
  blocks.insert(blocks.end(), element_equations_.begin(), element_equations_.end());
}

void HarmonicSolid::weakly_coupled(std::vector<Index>& equations) const {
  for (std::size_t i = 0; i < dof_.size(); ++i)
    if (dof_[i] >= 0 && basis_[i % basis_.size()].odd()) equations.push_back(dof_[i]);
}

void HarmonicSolid::element_fields(const Vector& numbers, Index shift, std::size_t e, Eigen::MatrixXd& out) const {
  const Index K = unknowns();
  out.setZero(8, K);
  const auto& dofs = element_equations_[e];
  const auto& places = element_dofs_[e];
  for (std::size_t i = 0; i < dofs.size(); ++i) out(places[i] / K, places[i] % K) = numbers[dofs[i] + shift];
}

Mat3 HarmonicSolid::mean_rotation(const State& s) const {
  if (!corotated_) return Mat3::Identity();
  Eigen::Matrix<double, 9, 1> g = mean_gradient_ * s.q.segment(block_.q, block_.size);
  const Mat3 F = Mat3::Identity() + Eigen::Map<Mat3>(g.data());
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

struct HarmonicSolid::Scratch {
  explicit Scratch(const HarmonicSolid& solid)
      : angles(static_cast<Index>(solid.frames_.size())), points(static_cast<Index>(solid.points_per_element())) {
    for (std::size_t c = 0; c < 3; ++c) {
      gradient[c].resize(solid.padded_, 3 * points);
      stress[c].setZero(solid.padded_, 3 * points);
    }
  }
  Index angles, points;
  Eigen::MatrixXd fields, stiffness;                // of the element
  Eigen::MatrixXd own, spread;                      // one direction's fields; by the derivatives at the points
  std::array<Eigen::MatrixXd, 3> gradient, stress;  // component by component, angles x as HarmonicSolid::gradients_
  PointResponse response;

  /// Column of a derivative (0 by s, 1 by rho, 2 around) at a point.
  Index column(Index point, Index J) const { return J < 2 ? 2 * point + J : 2 * points + point; }
};

template <class Work>
void HarmonicSolid::over_elements(const Work& work) const {
  for_all_alone(tbb::blocked_range<std::size_t>(0, mesh_.elements.size(), 4),
                [&](const tbb::blocked_range<std::size_t>& range) {
                  Scratch scratch(*this);
                  for (std::size_t e = range.begin(); e < range.end(); ++e) work(e, scratch);
                });
}

std::span<const double> HarmonicSolid::history_at(std::size_t point, Index angle) const {
  const auto size = static_cast<std::size_t>(material(point / points_per_element()).history_size());
  return std::span(history_).subspan(history_start_[point] + static_cast<std::size_t>(angle) * size, size);
}

void HarmonicSolid::find_gradients(const State& s, std::size_t e, Scratch& t) const {
  element_fields(s.q, block_.q - block_.v, e, t.fields);
  const auto B = gradients_.middleCols(3 * t.points * static_cast<Index>(e), 3 * t.points);
  for (std::size_t c = 0; c < 3; ++c) {
    const Direction& d = directions_[c];
    t.own = t.fields(Eigen::all, d.functions);
    t.spread.noalias() = t.own.transpose().lazyProduct(B);
    t.gradient[c].leftCols(2 * t.points).noalias() = d.value.lazyProduct(t.spread.leftCols(2 * t.points));
    t.gradient[c].rightCols(t.points).noalias() = d.derivative.lazyProduct(t.spread.rightCols(t.points));
  }
}

/// Calls visit(point, point of the element, angle, F, frame) with F at every point; F in the placement's axes.
template <class Visit>
void HarmonicSolid::visit_points(const State& s, const Mat3& mean, std::size_t e, Scratch& t, Visit&& visit) const {
  find_gradients(s, e, t);
  const std::size_t first = e * points_per_element();
  Mat3 F;
  for (Index p = 0; p < t.points; ++p)
    for (Index j = 0; j < t.angles; ++j) {
      const Mat3& frame = frames_[static_cast<std::size_t>(j)];
      for (int J = 0; J < 3; ++J)
        for (int c = 0; c < 3; ++c) F(c, J) = t.gradient[static_cast<std::size_t>(c)](j, t.column(p, J)) + frame(c, J);
      visit(first + static_cast<std::size_t>(p), p, j, F, corotated_ ? Mat3(mean * frame) : frame);
    }
}

template <class Visit>
void HarmonicSolid::visit_lanes(const State& s, std::size_t e, Scratch& t, Visit&& visit) const {
  find_gradients(s, e, t);
  const std::size_t first = e * points_per_element();
  const double dt = s.time - time_;
  const bool known = dt == starts_of_[e];
  starts_of_[e] = dt;
  Mat3Lanes F;
  for (Index p = 0; p < t.points; ++p) {
    const std::size_t point = first + static_cast<std::size_t>(p);
    double* starts = starts_.data() + start_of_point_[point];
    for (Index j = 0; j < t.angles && !known; ++j)
      start_step(material(e), dt, history_at(point, j), starts + j, padded_);
    for (Index j = 0; j < t.angles; j += kLanes) {
      for (Index J = 0; J < 3; ++J)
        for (Index c = 0; c < 3; ++c) {
          Lanes gradient, frame;
          load(gradient, &t.gradient[static_cast<std::size_t>(c)](j, t.column(p, J)));
          load(frame, &frame_components_(j, c + 3 * J));
          F[static_cast<std::size_t>(c + 3 * J)] = gradient + frame;
        }
      visit(point, p, j, F, starts + j);
    }
  }
}

void HarmonicSolid::residual(const State& s, Vector& inertia, Vector& force) const {
  const Index K = unknowns();
  const std::size_t elements = mesh_.elements.size();
  const double dt = s.time - time_;
  const Mat3 R = mean_rotation(s);
  over_elements([&](std::size_t e, Scratch& t) {
    const Solid& solid = material(e);
    Found& found = found_[e];
    found.twist.setZero();
    found.energy = 0;
    if (solid.in_lanes()) {
      visit_lanes(s, e, t, [&](std::size_t point, Index p, Index j, const Mat3Lanes& F, const double* starts) {
        Mat3Lanes stress;
        Lanes energy;
        evaluate(solid, F, starts, padded_, stress, energy);
        const double weight = points_[point].weight;
        for (int l = 0; l < std::min<Index>(kLanes, t.angles - j); ++l) found.energy += weight * energy[l];
        for (Index J = 0; J < 3; ++J)
          for (Index c = 0; c < 3; ++c)
            store(&t.stress[static_cast<std::size_t>(c)](j, t.column(p, J)),
                  weight * stress[static_cast<std::size_t>(c + 3 * J)]);
      });
    } else {
      visit_points(s, R, e, t, [&](std::size_t point, Index p, Index j, const Mat3& F, const Mat3& frame) {
        evaluate(solid, F, frame, dt, history_at(point, j), false, t.response);
        const double weight = points_[point].weight;
        found.energy += weight * t.response.energy;
        for (int J = 0; J < 3; ++J)
          for (int c = 0; c < 3; ++c)
            t.stress[static_cast<std::size_t>(c)](j, t.column(p, J)) = weight * t.response.stress(c, J);
        if (corotated_) found.twist += weight * t.response.stress * F.transpose();
      });
    }
    const auto B = gradients_.middleCols(3 * t.points * static_cast<Index>(e), 3 * t.points);
    found.force.setZero(8, K);
    for (std::size_t c = 0; c < 3; ++c) {
      const Direction& d = directions_[c];
      t.spread.resize(d.value.cols(), 3 * t.points);
      t.spread.leftCols(2 * t.points).noalias() = d.value.transpose() * t.stress[c].leftCols(2 * t.points);
      t.spread.rightCols(t.points).noalias() = d.derivative.transpose() * t.stress[c].rightCols(t.points);
      t.own.noalias() = B * t.spread.transpose();
      for (std::size_t k = 0; k < d.functions.size(); ++k)
        found.force.col(d.functions[k]) += t.own.col(static_cast<Index>(k));
    }
    element_fields(s.a, 0, e, t.fields);
    found.inertia.noalias() = element_mass_[e] * t.fields;
    found.inertia *= norms_.asDiagonal();
  });
  found_at_ = s.q.segment(block_.q, block_.size);
  found_time_ = s.time;
  Mat3 twist = Mat3::Zero();
  for (std::size_t e = 0; e < elements; ++e) {
    const auto& dofs = element_equations_[e];
    const auto& places = element_dofs_[e];
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      force[dofs[i]] += found_[e].force(places[i] / K, places[i] % K);
      inertia[dofs[i]] += found_[e].inertia(places[i] / K, places[i] % K);
    }
    twist += found_[e].twist;
  }
  if (!corotated_) return;
  // The mean rotation R follows the unknowns: dR = R [w], (tr U - U) w = axial(R^T dF - dF^T R) of the
  // mean gradient F = R U; the energy changes by -w . axial of the unbalanced moment.
  Eigen::Matrix<double, 9, 1> mean = mean_gradient_ * s.q.segment(block_.q, block_.size);
  const Mat3 U = R.transpose() * (Mat3::Identity() + Eigen::Map<Mat3>(mean.data()));
  const Mat3 Y = R.transpose() * twist * R;
  const auto axial = [](const Mat3& m) { return Vec3(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)); };
  const Vec3 moment = -axial(Y);
  const Vec3 b = (U.trace() * Mat3::Identity() - U).transpose().partialPivLu().solve(moment);
  // b . axial(R^T dF - dF^T R) = [b] : (R^T dF) = (R [b]) : dF, and axial counts each pair once.
  const Mat3 conjugate = R * skew(b);
  force.segment(block_.v, block_.size) += mean_gradient_.transpose() *
                                          Eigen::Map<const Eigen::Matrix<double, 9, 1>>(conjugate.data());
}

void HarmonicSolid::add_stiffness(const State& s, double factor, const Mat3& mean, std::size_t e, Scratch& t,
                                  Eigen::MatrixXd& ke) const {
  const Index K = unknowns(), P = t.points;
  const Solid& solid = material(e);
  const double dt = s.time - time_;
  // dP_cJ / dF_dL of two directions c, d: a column for each point and pair (J, L), grouped by what it multiplies.
  const auto column = [P](Index p, Index J, Index L) {
    return J < 2 ? (L < 2 ? 4 * p + 2 * J + L : 4 * P + 2 * p + J) : (L < 2 ? 6 * P + 2 * p + L : 8 * P + p);
  };
  std::array<Eigen::MatrixXd, 6> slopes;
  for (auto& m : slopes) m.resize(t.angles, 9 * P);
  visit_points(s, mean, e, t, [&](std::size_t point, Index p, Index j, const Mat3& F, const Mat3& frame) {
    evaluate(solid, F, frame, dt, history_at(point, j), true, t.response);
    const double weight = factor * points_[point].weight;
    for (std::size_t q = 0; q < 6; ++q)
      for (Index J = 0; J < 3; ++J)
        for (Index L = 0; L < 3; ++L)
          slopes[q](j, column(p, J, L)) = weight * t.response.tangent(static_cast<Index>(couplings_[q].left) + 3 * J,
                                                                      static_cast<Index>(couplings_[q].right) + 3 * L);
  });
  const auto B = gradients_.middleCols(3 * P * static_cast<Index>(e), 3 * P);
  Eigen::MatrixXd shapes(9 * P, 64);  // of node a times node b, column a + 8 b
  for (Index b = 0; b < 8; ++b)
    for (Index a = 0; a < 8; ++a)
      for (Index p = 0; p < P; ++p)
        for (Index J = 0; J < 3; ++J)
          for (Index L = 0; L < 3; ++L)
            shapes(column(p, J, L), a + 8 * b) = B(a, t.column(p, J)) * B(b, t.column(p, L));
  Eigen::MatrixXd angular, nodal;
  for (std::size_t q = 0; q < 6; ++q) {
    const Coupling& coupling = couplings_[q];
    const auto &left = directions_[coupling.left].functions, &right = directions_[coupling.right].functions;
    angular.resize(coupling.product[0][0].rows(), 9 * P);
    angular.leftCols(4 * P).noalias() = coupling.product[0][0] * slopes[q].leftCols(4 * P);
    angular.middleCols(4 * P, 2 * P).noalias() = coupling.product[0][1] * slopes[q].middleCols(4 * P, 2 * P);
    angular.middleCols(6 * P, 2 * P).noalias() = coupling.product[1][0] * slopes[q].middleCols(6 * P, 2 * P);
    angular.rightCols(P).noalias() = coupling.product[1][1] * slopes[q].rightCols(P);
    nodal.noalias() = angular * shapes;
    const bool same = coupling.left == coupling.right;  // then both orders are among the columns
    for (Index b = 0; b < 8; ++b)
      for (Index a = 0; a < 8; ++a) {
        const double* value = nodal.col(a + 8 * b).data();
        for (Index l : right)
          for (Index k : left) {
            ke(a * K + k, b * K + l) += *value;
            if (!same) ke(b * K + l, a * K + k) += *value;
            ++value;
          }
      }
  }
}

void HarmonicSolid::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  const Index K = unknowns();
  const Mat3 R = mean_rotation(s);
  over_elements([&](std::size_t e, Scratch& t) {
    const auto& places = element_dofs_[e];
    const bool whole = static_cast<Index>(places.size()) == 8 * K;
    Eigen::MatrixXd& ke = whole ? stiffness_[e] : t.stiffness;
    ke.setZero(8 * K, 8 * K);
    if (weights.stiffness != 0) add_stiffness(s, weights.stiffness, R, e, t, ke);
    if (weights.mass != 0)
      for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
          ke.block(i * K, j * K, K, K).diagonal() += weights.mass * element_mass_[e](i, j) * norms_;
    if (!whole) stiffness_[e] = ke(places, places);
  });
  sink.add_all(element_equations_, stiffness_);
}

Energies HarmonicSolid::energies(const State& s) const {
  Energies out;
  Eigen::MatrixXd V;
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    element_fields(s.v, 0, e, V);
    out.kinetic += 0.5 * (V.cwiseProduct(element_mass_[e] * V) * norms_).sum();
  }
  for (double w : strain_by_layer(s)) out.strain += w;
  for (double d : dissipated_) out.viscous += d;
  return out;
}

bool HarmonicSolid::is_found(const State& s) const {
  return s.time == found_time_ && found_at_ == s.q.segment(block_.q, block_.size);
}

std::vector<double> HarmonicSolid::strain_by_layer(const State& s) const {
  std::vector<double> out(materials_.size(), 0), found(mesh_.elements.size(), 0);
  if (is_found(s)) {
    for (std::size_t e = 0; e < found.size(); ++e) out[static_cast<std::size_t>(mesh_.layer[e])] += found_[e].energy;
    return out;
  }
  const double dt = s.time - time_;
  const Mat3 R = mean_rotation(s);
  over_elements([&](std::size_t e, Scratch& t) {
    const Solid& solid = material(e);
    if (solid.in_lanes()) {
      visit_lanes(s, e, t, [&](std::size_t point, Index, Index j, const Mat3Lanes& F, const double* starts) {
        Mat3Lanes stress;
        Lanes energy;
        evaluate(solid, F, starts, padded_, stress, energy);
        for (int l = 0; l < std::min<Index>(kLanes, t.angles - j); ++l) found[e] += points_[point].weight * energy[l];
      });
      return;
    }
    visit_points(s, R, e, t, [&](std::size_t point, Index, Index j, const Mat3& F, const Mat3& frame) {
      evaluate(solid, F, frame, dt, history_at(point, j), false, t.response);
      found[e] += points_[point].weight * t.response.energy;
    });
  });
  for (std::size_t e = 0; e < found.size(); ++e) out[static_cast<std::size_t>(mesh_.layer[e])] += found[e];
  return out;
}

void HarmonicSolid::commit(const State& s) {
  if (!is_found(s)) found_time_ = NAN;
  const double dt = s.time - time_;
  if (!history_.empty()) {
    std::vector<double> found(mesh_.elements.size(), 0);
    const Mat3 R = mean_rotation(s);
    over_elements([&](std::size_t e, Scratch& t) {
      const Solid& solid = material(e);
      const auto size = static_cast<std::size_t>(solid.history_size());
      const auto history = [&](std::size_t point, Index j) {
        return std::span(history_).subspan(history_start_[point] + static_cast<std::size_t>(j) * size);
      };
      if (solid.in_lanes()) {
        visit_lanes(s, e, t, [&](std::size_t point, Index, Index j, const Mat3Lanes& F, const double* starts) {
          const int count = static_cast<int>(std::min<Index>(kLanes, t.angles - j));
          found[e] += points_[point].weight *
                      update_internal_variables(solid, F, starts, padded_, dt, count, history(point, j));
        });
        return;
      }
      visit_points(s, R, e, t, [&](std::size_t point, Index, Index j, const Mat3& F, const Mat3&) {
        found[e] += points_[point].weight * update_internal_variables(solid, F, dt, history(point, j).first(size));
      });
    });
    std::ranges::fill(starts_of_, NAN);
    for (std::size_t e = 0; e < found.size(); ++e) dissipated_[static_cast<std::size_t>(mesh_.layer[e])] += found[e];
  }
  time_ = s.time;
}

void HarmonicSolid::save(std::vector<double>& out) const { put(out, time_, dissipated_, history_); }

void HarmonicSolid::restore(std::span<const double>& in) {
  take(in, "harmonic solid: the history is too short", time_, dissipated_, history_);
  found_time_ = NAN;
  std::ranges::fill(starts_of_, NAN);
}

Eigen::MatrixXd HarmonicSolid::fields(const Vector& numbers, Index shift) const {
  const Index K = unknowns();
  const auto nodes = static_cast<Index>(mesh_.nodes.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(nodes, K);
  for (Index i = 0; i < nodes; ++i)
    for (Index k = 0; k < K; ++k)
      if (const Index e = dof(static_cast<int>(i), k); e >= 0) out(i, k) = numbers[e + shift];
  return out;
}

Vec3 HarmonicSolid::reference(int node, double theta) const {
  const Eigen::Vector2d& x = mesh_.nodes[static_cast<std::size_t>(node)];
  return placement_.origin + placement_.axes * Vec3(x.x(), x.y() * std::cos(theta), x.y() * std::sin(theta));
}

Eigen::Matrix3Xd HarmonicSolid::functions_at(double theta) const {
  Eigen::Matrix3Xd out(3, unknowns());
  for (Index k = 0; k < unknowns(); ++k) out.col(k) = placement_.axes * basis_[static_cast<std::size_t>(k)].at(theta);
  return out;
}

std::vector<Sym> HarmonicSolid::cauchy_at_nodes(const State& s, const std::vector<double>& theta) const {
  if (quadrature_.points != 2) throw std::invalid_argument("harmonic solid: stress recovery needs the 2 x 2 rule");
  const auto n = static_cast<Index>(frames_.size());
  const std::size_t per = points_per_element();
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> at_points(points_.size(),
                                                                  Eigen::Matrix<double, 6, Eigen::Dynamic>(6, n));
  const double dt = s.time - time_;
  const Mat3 R = mean_rotation(s);
  over_elements([&](std::size_t e, Scratch& t) {
    visit_points(s, R, e, t, [&](std::size_t point, Index, Index j, const Mat3& F, const Mat3& frame) {
      evaluate(material(e), F, frame, dt, history_at(point, j), false, t.response);
      // In the cylindrical frame, so that an axisymmetric state is constant over theta.
      const Mat3& Q = frames_[static_cast<std::size_t>(j)];
      const Mat3 sigma = t.response.stress * F.transpose() / F.determinant();
      at_points[point].col(j) = to_sym(Q.transpose() * sigma * Q);
    });
  });
  const std::size_t angles = theta.size(), nodes = mesh_.nodes.size();
  // Between the angles of the rule, which carry the history: by their trigonometric polynomial. Where they cover half
  // the circle, theirs are mirrored: shears across the plane of symmetry (4, 5) change their sign.
  const bool half = quadrature_.angles.theta.front() > 0;
  const int circle = int(half ? 2 * n : n);
  Eigen::MatrixXd even(n, Index(angles)), odd = even;
  for (std::size_t t = 0; t < angles; ++t)
    for (Index j = 0; j < n; ++j) {
      const double a = quadrature_.angles.theta[static_cast<std::size_t>(j)];
      const double own = cardinal(theta[t] - a, circle), image = half ? cardinal(theta[t] + a, circle) : 0;
      even(j, Index(t)) = own + image;
      odd(j, Index(t)) = own - image;
    }
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> at_angles;
  for (const auto& points : at_points) {
    auto& here = at_angles.emplace_back(6, Index(angles));
    here.topRows<4>() = points.topRows<4>() * even;
    here.bottomRows<2>() = points.bottomRows<2>() * odd;
  }
  std::vector<Sym> out(nodes * angles, Sym::Zero());
  std::vector<int> count(nodes, 0);
  constexpr double xi[8] = {-1, 1, 1, -1, 0, 1, 0, -1}, eta[8] = {-1, -1, 1, 1, -1, 0, 1, 0};
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
    for (int i = 0; i < 8; ++i) {
      const auto node = static_cast<std::size_t>(mesh_.elements[e][static_cast<std::size_t>(i)]);
      ++count[node];
      const double x = std::sqrt(3.0) * xi[i], y = std::sqrt(3.0) * eta[i];
      const double w[4] = {0.25 * (1 - x) * (1 - y), 0.25 * (1 + x) * (1 - y), 0.25 * (1 - x) * (1 + y),
                           0.25 * (1 + x) * (1 + y)};
      for (std::size_t t = 0; t < angles; ++t)
        for (std::size_t p = 0; p < 4; ++p) out[node * angles + t] += w[p] * at_angles[e * per + p].col(Index(t));
    }
  std::vector<Mat3> turns;  // from the cylindrical frame
  for (double t : theta) turns.emplace_back(placement_.axes * cylindrical(t));
  for (std::size_t node = 0; node < nodes; ++node)
    for (std::size_t t = 0; t < angles; ++t) {
      const Mat3& Q = turns[t];
      Sym& sym = out[node * angles + t];
      sym = to_sym(Q * to_matrix(sym / count[node]) * Q.transpose());
    }
  return out;
}

void HarmonicSolid::set_velocity(State& s, const Vec3& linear, const Vec3& angular) const {
  const Vec3 v = placement_.axes.transpose() * linear, w = placement_.axes.transpose() * angular;
  const AngularRule circle = full_circle(2 * largest_order(basis_) + 5);
  // Projections of the parts of v + w x (s e1 + rho e_rho): constant, times s, times rho.
  const Index K = unknowns();
  Eigen::Matrix<double, 3, Eigen::Dynamic> part = Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, K);
  for (double theta : circle.theta) {
    const Vec3 radial(0, std::cos(theta), std::sin(theta));
    for (Index k = 0; k < K; ++k) {
      const Vec3 f = circle.weight / norms_[k] * basis_[static_cast<std::size_t>(k)].at(theta);
      part(0, k) += f.dot(v);
      part(1, k) += f.dot(w.cross(Vec3::UnitX()));
      part(2, k) += f.dot(w.cross(radial));
    }
  }
  for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
    for (Index k = 0; k < K; ++k)
      if (const Index e = dof(static_cast<int>(i), k); e >= 0)
        s.v[e] = part(0, k) + mesh_.nodes[i].x() * part(1, k) + mesh_.nodes[i].y() * part(2, k);
}

MeanMotion HarmonicSolid::motion(const State& s) const {
  const Index K = unknowns();
  // The reference position is two more fields: s along e1, rho along e_rho.
  FourierBasis basis = basis_;
  basis.push_back({0, Vec3::UnitX(), Vec3::Zero()});
  basis.push_back({1, Vec3::UnitY(), Vec3::UnitZ()});
  const AngularRule circle = full_circle(2 * largest_order(basis) + 3);
  const auto at = [&](Index k, double theta) { return basis[static_cast<std::size_t>(k)].at(theta); };

  double mass = 0;
  Vec3 first = Vec3::Zero(), momentum = Vec3::Zero();
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(K + 2, K + 2), cross = Eigen::MatrixXd::Zero(K + 2, K);
  Eigen::VectorXd sum_x = Eigen::VectorXd::Zero(K + 2), sum_v = Eigen::VectorXd::Zero(K);
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    Eigen::MatrixXd X(8, K + 2), U, V;
    element_fields(s.q, block_.q - block_.v, e, U);
    X.leftCols(K) = U;
    for (int i = 0; i < 8; ++i)
      X.row(i).tail<2>() =
          mesh_.nodes[static_cast<std::size_t>(mesh_.elements[e][static_cast<std::size_t>(i)])].transpose();
    element_fields(s.v, 0, e, V);
    const auto& m = element_mass_[e];
    mass += 2 * M_PI * m.sum();
    sum_x += X.transpose() * m.rowwise().sum();
    sum_v += V.transpose() * m.rowwise().sum();
    second += X.transpose() * m * X;
    cross += X.transpose() * m * V;
  }
  Mat3 moments = Mat3::Zero();
  Vec3 spin = Vec3::Zero();
  for (double theta : circle.theta) {
    for (Index k = 0; k < K + 2; ++k) {
      const Vec3 f = circle.weight * at(k, theta);
      first += sum_x[k] * f;
      if (k < K) momentum += sum_v[k] * f;
      for (Index l = 0; l < K + 2; ++l) {
        moments += second(k, l) * f * at(l, theta).transpose();
        if (l < K) spin += cross(k, l) * f.cross(at(l, theta));
      }
    }
  }
  MeanMotion out;
  out.mass = mass;
  const Vec3 centre = first / mass;
  const Mat3 about = moments - mass * centre * centre.transpose();
  out.centre = placement_.origin + placement_.axes * centre;
  out.momentum = placement_.axes * momentum;
  out.velocity = out.momentum / mass;
  out.angular_momentum = placement_.axes * (spin - centre.cross(momentum));
  out.inertia = placement_.axes * (about.trace() * Mat3::Identity() - about) * placement_.axes.transpose();
  return out;
}

Vec3 HarmonicSolid::centre(const State& s) const {
  double mass = 0;
  Vec3 first = Vec3::Zero();
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e)
    for (int i = 0; i < 8; ++i) {
      const int node = mesh_.elements[e][static_cast<std::size_t>(i)];
      const double m = element_mass_[e].row(i).sum();
      mass += m;
      first.x() += m * mesh_.nodes[static_cast<std::size_t>(node)].x();
      for (Index k = 0; k < unknowns(); ++k)  // no other function has a mean over the angles
        if (const AngularFunction& f = basis_[static_cast<std::size_t>(k)]; f.order == 0)
          first += m * s.q[offset(node, k)] * f.cosine;
    }
  return placement_.origin + placement_.axes * (first / mass);
}

double HarmonicSolid::mass() const {
  double m = 0;
  for (const auto& e : element_mass_) m += 2 * M_PI * e.sum();
  return m;
}

double HarmonicSolid::mass(const mesh::Meridian& mesh, const std::vector<Solid>& materials) {
  double m = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    m += 2 * M_PI * element_mass(mesh, e, materials.at(static_cast<std::size_t>(mesh.layer[e])).density).sum();
  return m;
}

}  // namespace hosel::fem
