#include "fem/plate.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mesh/gauss.hpp"

namespace hosel::fem {
namespace {

using Eigen::Vector2d;
using mesh::Q9;

const double kThird = 1 / std::sqrt(3.0), kFifths = std::sqrt(0.6);
const std::vector<std::pair<double, double>> kGauss3 = mesh::gauss(3);
constexpr double kShearFactor = 5.0 / 6;

Eigen::Matrix3d plane_stress(const PlateMaterial& m) {
  const double e = m.young / (1 - m.poisson * m.poisson);
  Eigen::Matrix3d c = Eigen::Matrix3d::Zero();
  c(0, 0) = c(1, 1) = e;
  c(0, 1) = c(1, 0) = e * m.poisson;
  c(2, 2) = 0.5 * e * (1 - m.poisson);
  return c;
}

/// Place of an unknown among an element's 45.
constexpr Index at(int node, int unknown) { return 5 * node + unknown; }

double von_mises(const Eigen::Vector3d& s) {
  return std::sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]);
}

}  // namespace

/// Rows: membrane (yy, zz, 2 yz), bending likewise, shear (y, z).
struct Plate::Strains {
  Eigen::Matrix<double, 3, kMost> membrane = Eigen::Matrix<double, 3, kMost>::Zero(), bending = membrane;
  Eigen::Matrix<double, 2, kMost> shear = Eigen::Matrix<double, 2, kMost>::Zero();
  double jacobian = 0, thickness = 0;
};

std::vector<std::string> PlateMaterial::faults() const {
  std::vector<std::string> out;
  if (!(young > 0) || !std::isfinite(young)) out.emplace_back("the plate's Young's modulus must be positive");
  if (!(poisson > -1 && poisson < 0.5)) out.emplace_back("the plate's Poisson's ratio must lie between -1 and 0.5");
  if (!(density > 0) || !std::isfinite(density)) out.emplace_back("the plate's density must be positive");
  return out;
}

std::vector<std::string> RimSupport::faults() const {
  std::vector<std::string> out;
  if (!(deflection >= 0 && rotation >= 0 && stretch >= 0)) out.emplace_back("a rim's stiffness must not be negative");
  if (!std::isfinite(lean)) out.emplace_back("a rim's lean must be finite");
  if (lean != 0 && std::isinf(rotation)) out.emplace_back("a rim that is held about itself must not lean");
  return out;
}

RimSupport RimSupport::of_shell(const PlateMaterial& m, double thickness, double radius, double length) {
  const double rest = 1 - m.poisson * m.poisson, D = m.young * thickness * thickness * thickness / (12 * rest),
               b = std::pow(3 * rest, 0.25) / std::sqrt(radius * thickness);
  return {.deflection = m.young * thickness / length, .rotation = 2 * D * b, .stretch = 2 * D * b * b * b, .lean = b};
}

double PlateStress::von_mises() const { return std::max(fem::von_mises(inner), fem::von_mises(outer)); }

Plate::Plate(DofMap& dof_map, mesh::PlateMesh mesh, const PlateMaterial& material, std::vector<double> thickness,
             const RimSupport& rim, const Face& curvature)
    : mesh_(std::move(mesh)),
      material_(material),
      thickness_(std::move(thickness)),
      rim_(rim),
      curvature_(curvature),
      curved_(std::isfinite(curvature.bulge) || std::isfinite(curvature.roll)) {
  for (const auto& faults : {material.faults(), rim.faults()})
    if (!faults.empty()) throw std::invalid_argument("plate: " + faults.front());
  if (thickness_.size() != mesh_.nodes.size())
    throw std::invalid_argument("plate: a thickness for every node is needed");
  for (double t : thickness_)
    if (!(t > 0)) throw std::invalid_argument("plate: a thickness must be positive");
  std::vector<std::array<bool, 5>> free;
  Index count = 0;
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) {
    const bool rim_node = mesh_.on_rim[n] != 0;
    const bool w = !rim_node || !std::isinf(rim.deflection), b = !rim_node || !std::isinf(rim.rotation),
               u = curved_ && (!rim_node || !std::isinf(rim.stretch));
    free.push_back({w, b, b, u, u});
    for (bool f : free.back()) count += f;
  }
  if (count == 0) throw std::invalid_argument("plate: every node is held");
  const DofMap::Block block = dof_map.add_vector(count);
  to_q_ = block.q - block.v;
  end_ = block.v;
  for (const auto& f : free) {
    auto& own = dofs_.emplace_back();
    for (std::size_t i = 0; i < 5; ++i) own[i] = f[i] ? end_++ : -1;
  }
  for (const auto& nodes : mesh_.elements) {
    Element e = element(nodes);
    build(e, nodes);
    elements_.push_back(std::move(e));
  }
  add_rim();
  for (Element& e : elements_)
    for (Index d : e.dofs) e.entries.push_back(d + to_q_);
}

Plate::Element Plate::element(std::span<const int> nodes) const {
  Element e;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int i = 0; i < 5; ++i)
      if (const Index d = dof(nodes[k], static_cast<Unknown>(i)); d >= 0) {
        e.dofs.push_back(d);
        e.places.push_back(static_cast<int>(at(static_cast<int>(k), i)));
      }
  return e;
}

Index Plate::dof(int node, Unknown unknown) const { return dofs_[static_cast<std::size_t>(node)][unknown]; }

double Plate::value(const Vector& values, int node, Unknown unknown) const {
  const Index d = dof(node, unknown);
  return d < 0 ? 0 : values[d];
}

Eigen::Matrix2d Plate::jacobian(const std::array<int, 9>& nodes, const Q9& q) const {
  Eigen::Matrix2d j = Eigen::Matrix2d::Zero();
  for (int k = 0; k < 9; ++k)
    j += mesh_.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])] * q.derivative.row(k);
  return j;
}

Plate::Strains Plate::strains(const std::array<int, 9>& nodes, double xi, double eta) const {
  Strains out;
  const Q9 q = Q9::at(xi, eta);
  const Eigen::Matrix2d J = jacobian(nodes, q), inverse = J.inverse();
  out.jacobian = J.determinant();
  const Eigen::Matrix<double, 9, 2> N = q.derivative * inverse;  // by y, z
  Vector2d place = Vector2d::Zero();
  for (int k = 0; k < 9; ++k) {
    const auto n = static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)]);
    out.thickness += q.value[k] * thickness_[n];
    place += q.value[k] * mesh_.nodes[n];
  }
  const Vector2d h(place.x() / curvature_.bulge, place.y() / curvature_.roll);
  for (int k = 0; k < 9; ++k) {
    out.bending(0, at(k, kRotationY)) = -N(k, 0);
    out.bending(1, at(k, kRotationZ)) = -N(k, 1);
    out.bending(2, at(k, kRotationY)) = -N(k, 1);
    out.bending(2, at(k, kRotationZ)) = -N(k, 0);
    if (!curved_) continue;
    out.membrane(0, at(k, kStretchY)) = N(k, 0);
    out.membrane(1, at(k, kStretchZ)) = N(k, 1);
    out.membrane(2, at(k, kStretchY)) = N(k, 1);
    out.membrane(2, at(k, kStretchZ)) = N(k, 0);
    out.membrane(0, at(k, kDeflection)) = h.x() * N(k, 0);
    out.membrane(1, at(k, kDeflection)) = h.y() * N(k, 1);
    out.membrane(2, at(k, kDeflection)) = h.x() * N(k, 1) + h.y() * N(k, 0);
  }
  // Covariant shear: component c at its six points, linear along its own direction and quadratic across.
  Eigen::Matrix<double, 2, kMost> covariant = Eigen::Matrix<double, 2, kMost>::Zero();
  for (int c = 0; c < 2; ++c) {
    const double own = c == 0 ? xi : eta, across = c == 0 ? eta : xi;
    for (int i = 0; i < 2; ++i)
      for (int j = -1; j <= 1; ++j) {
        const double a = i == 0 ? -kThird : kThird, b = j * kFifths, r = across / kFifths;
        const double weight = 0.5 * (1 + (i == 0 ? -1 : 1) * own / kThird) * (j == 0 ? 1 - r * r : 0.5 * r * (r + j));
        const Q9 tied = c == 0 ? Q9::at(a, b) : Q9::at(b, a);
        const Vector2d along = jacobian(nodes, tied).col(c);
        for (int k = 0; k < 9; ++k) {
          covariant(c, at(k, kDeflection)) += weight * tied.derivative(k, c);
          covariant(c, at(k, kRotationY)) -= weight * tied.value[k] * along.x();
          covariant(c, at(k, kRotationZ)) -= weight * tied.value[k] * along.y();
        }
      }
  }
  out.shear = inverse.transpose() * covariant;
  return out;
}

void Plate::build(Element& e, const std::array<int, 9>& nodes) const {
  const Eigen::Matrix3d C = plane_stress(material_);
  const double G = material_.young / (2 * (1 + material_.poisson));
  Eigen::Matrix<double, kMost, kMost> K = Eigen::Matrix<double, kMost, kMost>::Zero(), M = K;
  for (const auto& [xi, wx] : kGauss3)
    for (const auto& [eta, wy] : kGauss3) {
      const Strains s = strains(nodes, xi, eta);
      const double area = wx * wy * s.jacobian, t = s.thickness, t3 = t * t * t / 12;
      K += area * (t3 * s.bending.transpose() * C * s.bending + kShearFactor * G * t * s.shear.transpose() * s.shear);
      if (curved_) K += area * t * s.membrane.transpose() * C * s.membrane;
      const Q9 q = Q9::at(xi, eta);
      const Eigen::Matrix<double, 9, 9> NN = area * material_.density * q.value * q.value.transpose();
      for (int k = 0; k < 9; ++k)
        for (int l = 0; l < 9; ++l)
          for (int i = 0; i < 5; ++i) M(at(k, i), at(l, i)) += NN(k, l) * (i == kRotationY || i == kRotationZ ? t3 : t);
    }
  e.stiffness = K(e.places, e.places);
  e.mass = M(e.places, e.places);
}

void Plate::add_rim() {
  for (const auto& edge : mesh_.rim) {
    Eigen::Matrix<double, 15, 15> K = Eigen::Matrix<double, 15, 15>::Zero();
    for (const auto& [x, weight] : kGauss3) {
      const Vec3 N(0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)), dN(x - 0.5, -2 * x, x + 0.5);
      Vector2d along = Vector2d::Zero();
      for (int k = 0; k < 3; ++k)
        along += dN[k] * mesh_.nodes[static_cast<std::size_t>(edge[static_cast<std::size_t>(k)])];
      const double length = weight * along.norm();
      const Vector2d normal = Vector2d(along.y(), -along.x()).normalized();
      const auto spring = [&](double k, const std::array<double, 5>& row) {
        if (!std::isfinite(k)) return;
        Eigen::Matrix<double, 15, 1> r;
        for (int n = 0; n < 3; ++n)
          for (int i = 0; i < 5; ++i) r[at(n, i)] = N[n] * row[static_cast<std::size_t>(i)];
        K += k * length * r * r.transpose();
      };
      spring(rim_.deflection, {1, 0, 0, 0, 0});
      spring(rim_.rotation, {0, normal.x(), normal.y(), -rim_.lean * normal.x(), -rim_.lean * normal.y()});
      if (!curved_) continue;
      spring(rim_.stretch, {0, 0, 0, 1, 0});
      spring(rim_.stretch, {0, 0, 0, 0, 1});
    }
    Element e = element(edge);
    if (e.dofs.empty()) continue;
    e.stiffness = K(e.places, e.places);
    e.mass = Eigen::MatrixXd::Zero(e.stiffness.rows(), e.stiffness.rows());
    elements_.push_back(std::move(e));
  }
}

void Plate::pattern(std::vector<std::vector<Index>>& blocks) const {
  for (const Element& e : elements_) blocks.push_back(e.dofs);
}

void Plate::residual(const State& s, Vector& inertia, Vector& force) const {
  for (const Element& e : elements_) {
    force(e.dofs) += e.stiffness * s.q(e.entries);
    inertia(e.dofs) += e.mass * s.a(e.dofs);
  }
}

void Plate::tangent(const State&, const Weights& weights, TangentSink& sink) const {
  for (const Element& e : elements_) sink.add(e.dofs, e.dofs, weights.stiffness * e.stiffness + weights.mass * e.mass);
}

Energies Plate::energies(const State& s) const {
  Energies out;
  for (const Element& e : elements_) {
    const Vector q = s.q(e.entries), v = s.v(e.dofs);
    out.strain += 0.5 * q.dot(e.stiffness * q);
    out.kinetic += 0.5 * v.dot(e.mass * v);
  }
  return out;
}

std::vector<Plate::Sample> Plate::samples() const {
  std::vector<Sample> out;
  for (std::size_t i = 0; i < mesh_.elements.size(); ++i)
    for (const auto& [xi, wx] : kGauss3)
      for (const auto& [eta, wy] : kGauss3) {
        const auto& nodes = mesh_.elements[i];
        const Q9 q = Q9::at(xi, eta);
        Sample s{static_cast<int>(i), Vector2d::Zero(), q.value, wx * wy * jacobian(nodes, q).determinant(), 0};
        double t = 0;
        for (int k = 0; k < 9; ++k) {
          const auto n = static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)]);
          s.place += q.value[k] * mesh_.nodes[n];
          t += q.value[k] * thickness_[n];
        }
        s.mass = material_.density * t * s.area;
        out.push_back(s);
      }
  return out;
}

double Plate::mass() const {
  double sum = 0;
  for (const Sample& s : samples()) sum += s.mass;
  return sum;
}

double Plate::deflection(const Vector& values, const Vector2d& place) const {
  const mesh::PlatePlace p = mesh::locate(mesh_, place);
  if (p.element < 0) return 0;
  const Q9 q = Q9::at(p.xi, p.eta);
  double w = 0;
  for (int k = 0; k < 9; ++k)
    w += q.value[k] *
         value(values, mesh_.elements[static_cast<std::size_t>(p.element)][static_cast<std::size_t>(k)], kDeflection);
  return w;
}

Vector Plate::load(const std::function<double(const Vector2d&)>& pressure) const {
  Vector out = Vector::Zero(end_);
  for (const Sample& s : samples())
    if (const double f = s.area * pressure(s.place); f != 0)
      deflections(s.element, [&](int k, Index d) { out[d] += f * s.shape[k]; });
  return out;
}

Vector Plate::point_load(const Vector2d& place) const {
  Vector out = Vector::Zero(end_);
  const mesh::PlatePlace p = mesh::locate(mesh_, place);
  if (p.element < 0) return out;
  const Q9 q = Q9::at(p.xi, p.eta);
  deflections(p.element, [&](int k, Index d) { out[d] += q.value[k]; });
  return out;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Plate::stresses(const Eigen::MatrixXd& fields, int element, double xi,
                                                         double eta) const {
  const auto& nodes = mesh_.elements[static_cast<std::size_t>(element)];
  const Element& e = elements_[static_cast<std::size_t>(element)];
  const Strains s = strains(nodes, xi, eta);
  const Eigen::Matrix3d C = plane_stress(material_);
  const Eigen::MatrixXd own = fields(e.dofs, Eigen::all);
  const Eigen::MatrixXd membrane = C * (s.membrane(Eigen::all, e.places) * own),
                        bending = 0.5 * s.thickness * C * (s.bending(Eigen::all, e.places) * own);
  Eigen::Matrix<double, 6, Eigen::Dynamic> out(6, fields.cols());
  out << membrane + bending, membrane - bending;
  return out;
}

PlateStress Plate::stress(const Vector& values, int element, double xi, double eta) const {
  const auto s = stresses(values, element, xi, eta);
  return {s.topRows<3>(), s.bottomRows<3>()};
}

}  // namespace hosel::fem
