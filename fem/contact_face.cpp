#include "hosel/fem/contact_face.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hosel::fem {
namespace {

std::vector<std::pair<double, double>> gauss(int n) {
  switch (n) {
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
    default: throw std::invalid_argument("contact: 1 to 5 Gauss points along an edge");
  }
}

}  // namespace

std::vector<std::string> ContactLawAtPoint::faults() const {
  std::vector<std::string> out;
  if (!(normal_stiffness > 0)) out.emplace_back("contact: state a positive normal stiffness");
  if (!(friction >= 0) || !std::isfinite(friction))
    out.emplace_back("contact: friction must be at least zero and finite");
  if (friction > 0 && !transition_speed && !(tangential_stiffness > 0))
    out.emplace_back("contact: Coulomb friction needs a positive tangential stiffness");
  if (transition_speed && !(*transition_speed > 0)) out.emplace_back("contact: the transition speed must be positive");
  return out;
}

ContactFace::ContactFace(const HarmonicSolid& solid, const Face& face, FaceCarrier carrier, ContactLawAtPoint law,
                         const AngularRule& angles, Symmetry symmetry, int edge_points)
    : solid_(solid), face_(face), carrier_(std::move(carrier)), law_(law), symmetry_(symmetry) {
  if (const auto faults = law.faults(); !faults.empty()) throw std::invalid_argument(faults.front());
  if (carrier_.translation.has_value() != carrier_.rotation.has_value())
    throw std::invalid_argument("contact: a moving face needs a position and a rotation");
  const Index K = solid.unknowns();
  const Placement& placement = solid.placement();
  for (double theta : angles.theta) {
    Eigen::MatrixXd f(3, K);
    for (Index k = 0; k < K; ++k) f.col(k) = placement.axes * solid.family()[static_cast<std::size_t>(k)].at(theta);
    functions_.push_back(f);
  }
  const auto rule = gauss(edge_points);
  for (const auto& nodes : solid.mesh().surface) {
    Edge edge{nodes, {}, {}};
    for (int i = 0; i < 3; ++i)
      for (Index k = 0; k < K; ++k)
        if (const Index e = solid.equation(nodes[static_cast<std::size_t>(i)], k); e >= 0) {
          edge.equations.push_back(e);
          edge.places.push_back(static_cast<int>(i * K + k));
        }
    if (carrier_.translation)
      for (const auto* block : {&*carrier_.translation, &*carrier_.rotation})
        for (Index i = 0; i < 3; ++i) edge.equations.push_back(block->v + i);
    edges_.push_back(std::move(edge));
    for (const auto& [x, w] : rule) {
      Eigen::Vector3d N(0.5 * x * (x - 1), 0.5 * x * (x + 1), 1 - x * x), dN(x - 0.5, x + 0.5, -2 * x);
      Eigen::Vector2d at = Eigen::Vector2d::Zero(), along = at;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector2d& node = solid.mesh().nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])];
        at += N[i] * node;
        along += dN[i] * node;
      }
      for (std::size_t j = 0; j < angles.theta.size(); ++j) {
        const double theta = angles.theta[j];
        points_.push_back({edges_.size() - 1, N, j, Vec3(at.x(), at.y() * std::cos(theta), at.y() * std::sin(theta)),
                           w * along.norm() * at.y() * angles.weight});
      }
    }
  }
  past_.resize(points_.size());
}

ContactFace::Pose ContactFace::pose(const State& s) const {
  if (!carrier_.translation) return {carrier_.position, Vec3::Zero(), Vec3::Zero(), carrier_.attitude};
  return {s.q.segment<3>(carrier_.translation->q), s.v.segment<3>(carrier_.translation->v),
          s.v.segment<3>(carrier_.rotation->v), rotation(s, *carrier_.rotation).toRotationMatrix()};
}

double ContactFace::gap_at(const Vec3& y) const {
  const Vec3 gradient(1, y.y() / face_.bulge, y.z() / face_.roll);
  return (y.x() - face_.height(y.y(), y.z())) / gradient.norm();
}

template <class Visit>
void ContactFace::visit(const State& s, Visit&& visit) const {
  const Pose pose = this->pose(s);
  const Placement& placement = solid_.placement();
  const Index K = solid_.unknowns();
  Eigen::MatrixXd U(3, K), V(3, K);
  Vector u(K), v(K);
  std::size_t edge = edges_.size();
  Eigen::Vector3d shape = Eigen::Vector3d::Zero();
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Point& point = points_[p];
    if (point.edge != edge) {
      edge = point.edge;
      U.setZero();
      V.setZero();
      for (int i = 0; i < 3; ++i)
        for (Index k = 0; k < K; ++k) {
          const int node = edges_[edge].nodes[static_cast<std::size_t>(i)];
          if (const Index e = solid_.equation(node, k); e >= 0) {
            U(i, k) = s.q[solid_.offset(node, k)];
            V(i, k) = s.v[e];
          }
        }
      shape.setZero();
    }
    if (point.shape != shape) {
      shape = point.shape;
      u.noalias() = U.transpose() * shape;
      v.noalias() = V.transpose() * shape;
    }
    const Eigen::MatrixXd& f = functions_[point.angle];
    const Vec3 x = placement.origin + placement.axes * point.reference + f * u;
    Kinematics k;
    k.arm = pose.R.transpose() * (x - pose.node);
    k.place = k.arm - carrier_.face_centre;
    k.relative = pose.R.transpose() * (f * v - pose.node_velocity);
    k.velocity = k.relative - pose.spin.cross(k.arm);
    visit(p, pose, k);
  }
}

ContactFace::Local ContactFace::law(const Past& past, const Kinematics& k, bool derivatives) const {
  Local out;
  const Vec3& y = k.place;
  const Mat3 curvature = Vec3(0, 1 / face_.bulge, 1 / face_.roll).asDiagonal();
  const Vec3 gradient(1, y.y() / face_.bulge, y.z() / face_.roll);
  const double length = gradient.norm();
  const Vec3 n = gradient / length;
  out.gap = (y.x() - face_.height(y.y(), y.z())) / length;
  if (!(out.gap < 0)) return out;

  const double en = law_.normal_stiffness;
  const Vec3 slope = n - out.gap / length * (curvature * n);  // d gap / d place
  out.pressure = -en * out.gap;
  out.force = out.pressure * slope;
  const Mat3 T = Mat3::Identity() - n * n.transpose();
  if (derivatives) { out.stiffness = en * slope * slope.transpose() + en * out.gap / length * T * curvature * T; }
  if (law_.friction == 0) return out;
  const double limit = law_.friction * out.pressure;

  if (law_.transition_speed) {
    const Vec3 vt = T * k.velocity;
    const double speed = vt.norm(), x = 4 * speed / *law_.transition_speed, h = std::tanh(x);
    out.slip_speed = speed;
    out.sliding = true;
    const Vec3 d = speed > 0 ? Vec3(vt / speed) : Vec3::Zero();
    out.traction = limit * h;
    out.force -= out.traction * d;
    if (derivatives) {
      out.stiffness -= law_.friction * en * h * d * slope.transpose();
      const double secant = x > 1e-8 ? h / speed : 4 / *law_.transition_speed;
      out.damping = limit *
                    (secant * (T - d * d.transpose()) + 4 / *law_.transition_speed * (1 - h * h) * d * d.transpose());
    }
    return out;
  }

  const double et = law_.tangential_stiffness;
  // A point that touches first within this step slides from where its straight path met the face.
  const bool fresh = !past.touching && past.gap > 0;
  const double f = fresh ? -out.gap / (past.gap - out.gap) : 1;
  const Vec3 path = y - (fresh ? past.place : past.anchor);
  const Vec3 stretch = f * (T * path);
  Mat3 change = f * T;
  if (fresh && derivatives)
    change -= past.gap / ((past.gap - out.gap) * (past.gap - out.gap)) * (T * path) * slope.transpose();
  const double size = stretch.norm();
  if (et * size <= limit) {
    out.traction = et * size;
    out.force -= et * stretch;
    out.anchor = y - stretch;
    if (derivatives) out.stiffness += et * change;
    return out;
  }
  const Vec3 d = stretch / size;
  out.sliding = true;
  out.traction = limit;
  out.force -= limit * d;
  out.anchor = y - limit / et * d;
  out.slip = size - limit / et;
  if (derivatives) {
    out.stiffness -= law_.friction * en * d * slope.transpose();
    out.stiffness += limit / size * (change - d * (d.transpose() * change));
  }
  return out;
}

void ContactFace::start(const State& s) {
  visit(s, [&](std::size_t p, const Pose&, const Kinematics& k) {
    Past& past = past_[p];
    past = {};
    past.place = past.anchor = k.place;
    past.gap = gap_at(k.place);
    past.touching = !(past.gap > 0);
  });
  started_ = true;
}

void ContactFace::pattern(std::vector<std::vector<Index>>& blocks) const {
  for (const Edge& e : edges_) blocks.push_back(e.equations);
}

void ContactFace::residual(const State& s, Vector&, Vector& force) const {
  if (!started_) throw std::logic_error("contact: start() has not been called");
  const Index K = solid_.unknowns();
  Vec3 total = Vec3::Zero(), moment = Vec3::Zero();
  Vector r(K);
  Mat3 R = Mat3::Identity();
  visit(s, [&](std::size_t p, const Pose& pose, const Kinematics& k) {
    R = pose.R;
    if (gap_at(k.place) >= 0) return;
    const Local local = law(past_[p], k, false);
    const Point& point = points_[p];
    const Vec3 f = point.area * local.force;
    r.noalias() = functions_[point.angle].transpose() * (pose.R * f);
    const Edge& edge = edges_[point.edge];
    for (std::size_t i = 0; i < edge.places.size(); ++i)
      force[edge.equations[i]] -= point.shape[edge.places[i] / K] * r[edge.places[i] % K];
    total += f;
    moment += k.arm.cross(f);
  });
  if (!carrier_.translation) return;
  force.segment<3>(carrier_.translation->v) += free_translation() * R * total;
  force.segment<3>(carrier_.rotation->v) += free_rotation(R) * moment;
}

void ContactFace::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  const Index K = solid_.unknowns();
  std::vector<Eigen::MatrixXd> blocks(edges_.size());
  const bool moving = carrier_.translation.has_value();
  if (weights.stiffness != 0 || weights.damping != 0)
    visit(s, [&](std::size_t p, const Pose& pose, const Kinematics& k) {
      if (gap_at(k.place) >= 0) return;
      const Local local = law(past_[p], k, true);
      const Point& point = points_[p];
      const Edge& edge = edges_[point.edge];
      const auto own = static_cast<Index>(edge.places.size()), size = static_cast<Index>(edge.equations.size());
      Eigen::MatrixXd& block = blocks[point.edge];
      if (block.size() == 0) block = Eigen::MatrixXd::Zero(size, size);
      // B: change of the place in the face frame by each equation.
      Eigen::MatrixXd B(3, size);
      const Eigen::MatrixXd local_functions = pose.R.transpose() * functions_[point.angle];
      for (Index i = 0; i < own; ++i) {
        const int at = edge.places[static_cast<std::size_t>(i)];
        B.col(i) = point.shape[at / K] * local_functions.col(at % K);
      }
      const Mat3 turn = free_rotation(pose.R);
      if (moving) {
        B.middleCols<3>(own) = -pose.R.transpose() * free_translation();
        B.rightCols<3>() = skew(k.arm) * turn;
      }
      Mat3 D = weights.stiffness * local.stiffness + weights.damping * local.damping;
      Eigen::MatrixXd right = D * B;
      if (law_.transition_speed && moving) {
        Eigen::MatrixXd extra = -skew(pose.spin) * B;
        extra.rightCols<3>() += skew(k.relative) * turn;
        right += weights.stiffness * local.damping * extra;
      }
      if (moving) right.rightCols<3>() += weights.stiffness * skew(local.force) * turn;
      block.noalias() += point.area * B.transpose() * right;
      if (moving) {
        // The arm of the force moves: d(arm x f) = -f x d(arm); its share from f's turning stands above.
        block.bottomRows<3>().noalias() -= point.area * weights.stiffness * turn.transpose() * skew(local.force) * B;
        // B^T (skew(f) turn) above counted -arm-side terms of the rotation row: R is fixed there.
        block.bottomRightCorner<3, 3>().noalias() -= point.area * weights.stiffness * (skew(k.arm) * turn).transpose() *
                                                     skew(local.force) * turn;
      }
    });
  for (std::size_t e = 0; e < edges_.size(); ++e)
    if (blocks[e].size() > 0) sink.add(edges_[e].equations, edges_[e].equations, blocks[e]);
}

Energies ContactFace::energies(const State& s) const {
  Energies out;
  visit(s, [&](std::size_t p, const Pose&, const Kinematics& k) {
    const double gap = gap_at(k.place);
    if (gap >= 0) return;
    const Local local = law(past_[p], k, false);
    double stored = 0.5 * law_.normal_stiffness * gap * gap;
    if (law_.friction > 0 && !law_.transition_speed)
      stored += 0.5 * local.traction * local.traction / law_.tangential_stiffness;
    out.contact += points_[p].area * stored;
  });
  out.friction = friction_work_;
  return out;
}

void ContactFace::accept(const State& s) {
  visit(s, [&](std::size_t p, const Pose&, const Kinematics& k) {
    Past& past = past_[p];
    const double area = points_[p].area;
    const double gap = gap_at(k.place);
    if (gap >= 0) {
      // What the tangential spring still held is lost where a point lets go.
      if (past.touching && law_.friction > 0 && !law_.transition_speed)
        friction_work_ += area * 0.5 * past.traction * past.traction / law_.tangential_stiffness;
      const double slip = past.slip;
      past = {};
      past.place = past.anchor = k.place;
      past.gap = gap;
      past.slip = slip;
      return;
    }
    const Local local = law(past, k, false);
    if (law_.transition_speed) {
      const Vec3 path = k.place - past.place;
      const double slid = path.norm();
      friction_work_ += area * 0.5 * (past.traction + local.traction) * slid;
      past.slip += slid;
    } else {
      friction_work_ += area * 0.5 * (past.traction + local.traction) * local.slip;
      past.slip += local.slip;
      if (!local.sliding && law_.friction > 0) creep_ = std::max(creep_, local.traction / law_.tangential_stiffness);
    }
    past.place = k.place;
    past.anchor = local.anchor;
    past.gap = gap;
    past.traction = local.traction;
    past.slip_speed = local.slip_speed;
    past.sliding = local.sliding;
    past.touching = true;
    penetration_ = std::max(penetration_, -gap);
  });
}

void ContactFace::save(std::vector<double>& out) const {
  out.insert(out.end(), {friction_work_, penetration_, creep_, started_ ? 1.0 : 0.0});
  for (const Past& p : past_) {
    out.insert(out.end(), p.place.begin(), p.place.end());
    out.insert(out.end(), p.anchor.begin(), p.anchor.end());
    out.insert(out.end(), {p.gap, p.traction, p.slip_speed, p.slip, p.touching ? 1.0 : 0.0, p.sliding ? 1.0 : 0.0});
  }
}

void ContactFace::restore(std::span<const double>& in) {
  const auto next = [&] {
    if (in.empty()) throw std::invalid_argument("contact: the history is too short");
    const double x = in.front();
    in = in.subspan(1);
    return x;
  };
  friction_work_ = next();
  penetration_ = next();
  creep_ = next();
  started_ = next() != 0;
  for (Past& p : past_) {
    for (double& x : p.place) x = next();
    for (double& x : p.anchor) x = next();
    p.gap = next();
    p.traction = next();
    p.slip_speed = next();
    p.slip = next();
    p.touching = next() != 0;
    p.sliding = next() != 0;
  }
}

ContactReport ContactFace::report(const State& s) const {
  ContactReport out;
  double weight = 0;
  Vec3 centre = Vec3::Zero();
  Mat3 R = Mat3::Identity();
  visit(s, [&](std::size_t p, const Pose& pose, const Kinematics& k) {
    R = pose.R;
    if (gap_at(k.place) >= 0) return;
    const Local local = law(past_[p], k, false);
    const double area = points_[p].area;
    out.force += area * (pose.R * local.force);
    out.normal_force += area * local.pressure;
    out.pressure = std::max(out.pressure, local.pressure);
    out.area += area;
    centre += area * local.pressure * (pose.node + pose.R * k.arm);
    weight += area * local.pressure;
    ++out.points;
  });
  out.force = (free_translation() * out.force).eval();
  const Vec3& origin = solid_.placement().origin;
  if (weight > 0) out.point = origin + free_translation() * (centre / weight - origin);
  out.penetration = penetration_;
  out.stick_slip_error = creep_;
  return out;
}

std::vector<ContactPoint> ContactFace::points(const State& s) const {
  std::vector<ContactPoint> out;
  const Placement& placement = solid_.placement();
  visit(s, [&](std::size_t p, const Pose& pose, const Kinematics& k) {
    const Local local = law(past_[p], k, false);
    out.push_back({placement.origin + placement.axes * points_[p].reference, pose.node + pose.R * k.arm,
                   pose.R * local.force, local.pressure, gap_at(k.place), past_[p].slip, points_[p].area,
                   past_[p].sliding});
  });
  return out;
}

double ContactFace::centre_gap(const State& s) const {
  const Pose pose = this->pose(s);
  return gap_at(pose.R.transpose() * (solid_.motion(s).centre - pose.node) - carrier_.face_centre);
}

Mat3 ContactFace::free_translation() const {
  const Mat3& axes = solid_.placement().axes;
  switch (symmetry_) {
    case Symmetry::plane: return Mat3::Identity() - axes.col(2) * axes.col(2).transpose();
    case Symmetry::axis: return axes.col(0) * axes.col(0).transpose();
    default: return Mat3::Identity();
  }
}

Mat3 ContactFace::free_rotation(const Mat3& R) const {
  if (symmetry_ == Symmetry::none) return Mat3::Identity();
  if (symmetry_ == Symmetry::axis) return Mat3::Zero();
  const Vec3 b = R.transpose() * solid_.placement().axes.col(2);
  return b * b.transpose();
}

}  // namespace hosel::fem
