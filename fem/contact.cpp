#include "fem/contact.hpp"

#include <tbb/blocked_range.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "golf/parallel.hpp"
#include "mesh/gauss.hpp"

namespace hosel::fem {
Contact::Contact(const HarmonicSolid& solid, std::unique_ptr<const ContactSurface> surface, SurfaceCarrier carrier,
                 ContactLaws laws, const AngularRule& angles, Symmetry symmetry, int edge_points)
    : solid_(solid),
      surface_(std::move(surface)),
      carrier_(std::move(carrier)),
      laws_(std::move(laws)),
      symmetry_(symmetry),
      own_(surface_->unknowns()),
      angles_(angles.theta) {
  if (!laws_.method) throw std::invalid_argument("contact: state a method");
  if (const auto faults = laws_.method->faults(); !faults.empty()) throw std::invalid_argument(faults.front());
  if (laws_.friction)
    if (const auto faults = laws_.friction->faults(); !faults.empty()) throw std::invalid_argument(faults.front());
  if (carrier_.translation.has_value() != carrier_.rotation.has_value())
    throw std::invalid_argument("contact: a moving surface needs a position and a rotation");
  if (own_ && (own_->rotation || own_->size > kSurfaceUnknowns))
    throw std::invalid_argument("contact: a surface has at most 32 unknowns of its own, plain numbers");
  std::vector<Index> carried;
  if (carrier_.translation)
    for (const auto* block : {&*carrier_.translation, &*carrier_.rotation})
      for (Index i = 0; i < 3; ++i) carried.push_back(block->v + i);
  if (own_)
    for (Index i = 0; i < own_->size; ++i) carried.push_back(own_->v + i);
  carried_ = static_cast<Index>(carried.size());

  const Index K = solid.unknowns();
  to_q_ = solid.offset(solid.mesh().surface.front()[2], 0) - solid.dof(solid.mesh().surface.front()[2], 0);
  functions_.resize(3 * static_cast<Index>(angles_.size()), K);
  for (std::size_t a = 0; a < angles_.size(); ++a)
    for (Index k = 0; k < K; ++k)
      functions_.block<3, 1>(3 * static_cast<Index>(a), k) = solid.placement().axes *
                                                             solid.basis()[static_cast<std::size_t>(k)].at(angles_[a]);
  const auto rule = mesh::gauss(edge_points);
  for (const auto& nodes : solid.mesh().surface) {
    Edge edge{nodes, {}, {}, {}};
    for (int i = 0; i < 3; ++i)
      for (Index k = 0; k < K; ++k)
        if (const Index e = solid.dof(nodes[static_cast<std::size_t>(i)], k); e >= 0) {
          edge.dofs.push_back(e);
          edge.places.push_back(static_cast<int>(i * K + k));
        }
    edge.places_and_carried = edge.places;
    for (Index i = 0; i < carried_; ++i) edge.places_and_carried.push_back(static_cast<int>(3 * K + i));
    edge.dofs.insert(edge.dofs.end(), carried.begin(), carried.end());
    edges_.push_back(std::move(edge));
    for (const auto& [x, w] : rule) {
      const Vec3 N(0.5 * x * (x - 1), 0.5 * x * (x + 1), 1 - x * x), dN(x - 0.5, x + 0.5, -2 * x);
      Eigen::Vector2d at = Eigen::Vector2d::Zero(), along = at;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector2d& node = solid.mesh().nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])];
        at += N[i] * node;
        along += dN[i] * node;
      }
      stations_.push_back({edges_.size() - 1, N, at, w * along.norm() * at.y() * angles.weight});
    }
  }
  past_.resize(stations_.size() * angles_.size());
  multipliers_.resize(past_.size());
  reference_.resize(3, static_cast<Index>(past_.size()));
  Index point = 0;
  for (const Station& station : stations_)
    for (double theta : angles_) {
      const double rho = station.reference.y();
      reference_.col(point++) = solid.placement().origin + solid.placement().axes * Vec3(station.reference.x(),
                                                                                         rho * std::cos(theta),
                                                                                         rho * std::sin(theta));
    }
}

Contact::Moved Contact::moved(const State& s) const {
  Moved m;
  m.node = carrier_.position;
  m.R = carrier_.attitude;
  if (carrier_.translation) {
    m.node = s.q.segment<3>(carrier_.translation->q);
    m.node_velocity = s.v.segment<3>(carrier_.translation->v);
    m.spin = s.v.segment<3>(carrier_.rotation->v);
    m.R = rotation(s, *carrier_.rotation).toRotationMatrix();
  }
  m.to_body = m.R.transpose();
  if (own_) {
    m.own = s.q.segment(own_->q, own_->size);
    m.own_rate = s.v.segment(own_->v, own_->size);
  }
  return m;
}

Vec3 Contact::place(const Moved& m, const Vec3& arm) const {
  Vec3 y = arm - carrier_.centre;
  if (own_) y.x() += surface_->travel(y, m.own);
  return y;
}

Vec3 Contact::in_body(const Kinematics& k, const Vec3& force) {
  return {force.x(), force.y() + force.x() * k.travel.slope.x(), force.z() + force.x() * k.travel.slope.y()};
}

Eigen::Ref<const Contact::Directions, 0, Eigen::OuterStride<>> Contact::functions(std::size_t angle) const {
  return functions_.middleRows<3>(3 * static_cast<Index>(angle));
}

struct Contact::Scratch {
  explicit Scratch(const Contact& contact)
      : U(contact.solid_.unknowns(), 3),
        V(contact.solid_.unknowns(), 3),
        u(contact.solid_.unknowns()),
        v(contact.solid_.unknowns()),
        arms(3, static_cast<Index>(contact.angles_.size())),
        velocities(arms),
        forces(arms) {}
  Eigen::Matrix<double, Eigen::Dynamic, 3> U, V;  // of the edge, one column a node
  Vector u, v;                                    // of the station
  Directions arms, velocities;                    // of its points, global
  Directions forces;                              // on them, global
};

std::vector<std::size_t> Contact::within_reach(const Moved& m, const State& s) const {
  const Index K = solid_.unknowns(), angles = static_cast<Index>(angles_.size());
  const double reach = m.node.dot(m.R.col(0)) + carrier_.centre.x() + surface_->reach(m.own) + beyond();
  Eigen::MatrixXd lift(angles, K);  // along the surface's first axis, by each function
  for (Index a = 0; a < angles; ++a) lift.row(a).noalias() = m.R.col(0).transpose() * functions_.middleRows<3>(3 * a);
  Eigen::Matrix<double, Eigen::Dynamic, 3> U = Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(K, 3);
  Vector u(K), heights(angles);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const Edge& edge = edges_[stations_[i].edge];
    if (i == 0 || stations_[i].edge != stations_[i - 1].edge) {
      U.setZero();
      for (std::size_t k = 0; k < edge.places.size(); ++k) U.data()[edge.places[k]] = s.q[edge.dofs[k] + to_q_];
    }
    u.noalias() = U * stations_[i].shape;
    heights.noalias() = lift * u;
    heights.noalias() += reference_.middleCols(static_cast<Index>(i) * angles, angles).transpose() * m.R.col(0);
    if (!(heights.minCoeff() > reach)) out.push_back(i);
  }
  return out;
}

template <class Work>
void Contact::over_stations(std::size_t count, const Work& work) const {
  constexpr std::size_t kWorthIt = 20000;  // numbers to be multiplied; waking another thread costs as much
  const std::size_t all = std::max<std::size_t>(count, 1), size = static_cast<std::size_t>(functions_.size());
  for_all_alone(tbb::blocked_range<std::size_t>(0, count, all * size < kWorthIt ? all : 2),
                [&](const tbb::blocked_range<std::size_t>& range) {
                  Scratch scratch(*this);
                  for (std::size_t i = range.begin(); i < range.end(); ++i) work(i, scratch);
                });
}

template <class Visit>
void Contact::visit_station(const Moved& m, const State& s, std::size_t number, Scratch& t, Visit&& visit) const {
  const Station& station = stations_[number];
  const Edge& edge = edges_[station.edge];
  const Index angles = static_cast<Index>(angles_.size());
  const bool rates = laws_.friction && laws_.friction->rate_dependent();  // else no law asks for velocities
  t.U.setZero();
  for (std::size_t i = 0; i < edge.places.size(); ++i) t.U.data()[edge.places[i]] = s.q[edge.dofs[i] + to_q_];
  t.u.noalias() = t.U * station.shape;
  t.arms.colwise() = -m.node;
  t.arms += reference_.middleCols(static_cast<Index>(number) * angles, angles);
  t.arms.reshaped().noalias() += functions_ * t.u;
  if (rates) {
    t.V.setZero();
    for (std::size_t i = 0; i < edge.places.size(); ++i) t.V.data()[edge.places[i]] = s.v[edge.dofs[i]];
    t.v.noalias() = t.V * station.shape;
    t.velocities.reshaped().noalias() = functions_ * t.v;
  }
  Kinematics k;
  k.station = &station;
  k.number = number * angles_.size();
  for (k.angle = 0; k.angle < angles_.size(); ++k.angle, ++k.number) {
    k.arm.noalias() = m.to_body * t.arms.col(static_cast<Index>(k.angle));
    k.place = place(m, k.arm);
    k.gap = surface_->gap(k.place);
    k.pressed = normal(k.number, k.gap).depth > 0;
    if (k.pressed) {  // elsewhere nothing acts
      if (own_) k.travel = surface_->travel_at(k.arm - carrier_.centre, m.own);
      if (rates) {
        k.relative.noalias() = m.to_body * (t.velocities.col(static_cast<Index>(k.angle)) - m.node_velocity);
        k.velocity = k.rate = k.relative - m.spin.cross(k.arm);
        if (own_) k.velocity.x() += k.travel.slope.dot(k.rate.tail<2>()) + k.travel.shape.dot(m.own_rate);
      }
    }
    visit(std::as_const(k));
  }
}

template <class Visit>
void Contact::visit(const State& s, Visit&& visit) const {
  const Moved m = moved(s);
  Scratch scratch(*this);
  for (std::size_t i = 0; i < stations_.size(); ++i)
    visit_station(m, s, i, scratch, [&](const Kinematics& k) { visit(m, k); });
}

Contact::Local Contact::evaluate(const Kinematics& k, bool derivatives, double slid) const {
  Local out;
  const SurfacePoint at = surface_->at(k.place);
  const Past& past = past_[k.number];
  const NormalSpring spring = normal(k.number, at.gap);
  out.pressure = spring.pressure();
  out.force = out.pressure * at.slope;
  if (derivatives) out.stiffness = spring.stiffness * (at.slope * at.slope.transpose() - spring.depth * at.curvature);
  if (!laws_.friction) return out;

  Slip slip{.pressure = out.pressure, .path = slid};
  slip.tangent = Mat3::Identity() - at.normal * at.normal.transpose();
  slip.velocity = slip.tangent * k.velocity;
  // A point that touches first within this step slides from where its straight path met the surface.
  const bool fresh = !past.touching && past.gap > 0;
  const double inside = std::min(at.gap, 0.0);  // a multiplier may press where the path has not met it
  const double share = fresh ? -inside / (past.gap - inside) : 1;
  const Vec3 path = slip.tangent * (k.place - (fresh ? past.place : past.anchor));
  slip.stretch = share * path;
  slip.step = fresh ? slip.stretch : slip.tangent * (k.place - past.place);
  out.friction = laws_.friction->at(slip, derivatives);
  out.force -= out.friction.traction;
  if (!derivatives) return out;
  Mat3 stretching = share * slip.tangent;  // d stretch / d place
  if (fresh && at.gap < 0)
    stretching -= past.gap / ((past.gap - at.gap) * (past.gap - at.gap)) * path * at.slope.transpose();
  out.stiffness += out.friction.by_stretch * stretching -
                   spring.stiffness * out.friction.by_pressure * at.slope.transpose();
  out.damping = out.friction.by_velocity;
  return out;
}

void Contact::start(const State& s) {
  visit(s, [&](const Moved&, const Kinematics& k) {
    Past& past = past_[k.number];
    past = {};
    past.place = past.anchor = k.place;
    past.gap = k.gap;
    past.touching = !(past.gap > 0);
    multipliers_[k.number] = 0;
  });
  started_ = true;
}

double Contact::beyond() const {
  if (!laws_.method->multipliers()) return 0;
  // The depth at a gap of zero is the gap up to which a point is pressed. Gaps are measured along the surface's normal,
  // within 60 degrees of its first axis.
  double most = 0;
  for (std::size_t i = 0; i < multipliers_.size(); ++i) most = std::max(most, 2 * normal(i, 0).depth);
  return most;
}

void Contact::begin_step() {
  if (!laws_.method->multipliers()) return;
  for (std::size_t i = 0; i < past_.size(); ++i)
    multipliers_[i] = laws_.method->next(past_[i].gap, past_[i].multiplier);
}

bool Contact::augment(const State& trial) {
  if (!laws_.method->multipliers()) return false;
  std::vector<double> next = multipliers_;
  bool again = false;
  visit(trial, [&](const Moved&, const Kinematics& k) {
    next[k.number] = laws_.method->next(k.gap, multipliers_[k.number]);
    again = again || laws_.method->repeats(k.gap, multipliers_[k.number]);
  });
  // An accepted step keeps the multipliers that it was solved with.
  if (again) multipliers_ = std::move(next);
  return again;
}

void Contact::pattern(std::vector<std::vector<Index>>& blocks) const {
  for (const Edge& e : edges_) blocks.push_back(e.dofs);
}

void Contact::residual(const State& s, Vector&, Vector& force) const {
  if (!started_) throw std::logic_error("contact: start() has not been called");
  const Moved m = moved(s);
  const std::vector<std::size_t> near = within_reach(m, s);
  struct Push {
    bool any = false;
    Eigen::Matrix<double, Eigen::Dynamic, 3> spread;  // over the nodes of the edge
    Vec3 total = Vec3::Zero(), moment = Vec3::Zero();
    SurfaceUnknowns own;
  };
  const Index own_size = own_ ? own_->size : 0;
  std::vector<Push> pushes(near.size());
  over_stations(near.size(), [&](std::size_t i, Scratch& t) {
    Push& push = pushes[i];
    push.own.setZero(own_size);
    const Station& station = stations_[near[i]];
    t.forces.setZero();
    visit_station(m, s, near[i], t, [&](const Kinematics& k) {
      if (!k.pressed) return;
      push.any = true;
      const Vec3 local = station.area * evaluate(k, false).force, f = in_body(k, local);
      t.forces.col(static_cast<Index>(k.angle)).noalias() = m.R * f;
      push.total += f;
      push.moment += k.arm.cross(f);
      if (own_) push.own -= local.x() * k.travel.shape;
    });
    if (push.any) push.spread.noalias() = (functions_.transpose() * t.forces.reshaped()) * station.shape.transpose();
  });
  Push sum;
  sum.own.setZero(own_size);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Push& push = pushes[i];
    if (!push.any) continue;
    const Edge& edge = edges_[stations_[near[i]].edge];
    for (std::size_t j = 0; j < edge.places.size(); ++j) force[edge.dofs[j]] -= push.spread.data()[edge.places[j]];
    sum.total += push.total;
    sum.moment += push.moment;
    sum.own += push.own;
  }
  if (carrier_.translation) {
    force.segment<3>(carrier_.translation->v) += free_translation() * m.R * sum.total;
    force.segment<3>(carrier_.rotation->v) += free_rotation(m.R) * sum.moment;
  }
  if (own_) force.segment(own_->v, own_size) += sum.own;
}

void Contact::linearise(const Moved& m, const Kinematics& k, const Weights& weights, Linearised& out) const {
  const Index K = solid_.unknowns(), size = K + carried_, own = own_ ? own_->size : 0;
  const bool moving = carrier_.translation.has_value();
  const Local local = evaluate(k, true);
  const double area = k.station->area;
  const Mat3 turn = free_rotation(m.R);
  const Vec3 force = in_body(k, local.force);

  // Change of the arm by each unknown but the surface's own: these change nothing but the place.
  const Index others = size - own;
  Directions& arm = out.arm;
  arm.leftCols(K).noalias() = m.to_body * functions(k.angle);
  if (moving) {
    arm.middleCols<3>(K) = -m.to_body * free_translation();
    arm.middleCols<3>(K + 3) = skew(k.arm) * turn;
  }
  auto place = out.changes.middleRows<3>(out.rows);
  auto forces = out.forces.middleRows<3>(out.rows);
  place.leftCols(others) = arm;
  const Mat3 by = area * (weights.stiffness * local.stiffness + weights.damping * local.damping);
  if (own > 0) {
    place.row(0).head(others) += k.travel.slope.transpose() * arm.bottomRows<2>();
    place.row(0).tail(own) = k.travel.shape.transpose();
    place.bottomRightCorner(2, own).setZero();
  }
  forces.noalias() = by * place;
  if (own > 0) {
    // The force across the surface follows its slope, which changes with the place and with the unknowns.
    const double across = -area * weights.stiffness * local.force.x();
    forces.bottomLeftCorner(2, others).noalias() += (across * k.travel.second) * arm.bottomRows<2>();
    forces.bottomRightCorner(2, own) += across * k.travel.shape_slope;
    out.changes.block(out.rows + 3, 0, 2, others).setZero();
    out.changes.block(out.rows + 3, others, 2, own) = k.travel.shape_slope;
    out.forces.block(out.rows + 3, 0, 2, others) = across * arm.bottomRows<2>();
    out.forces.block(out.rows + 3, others, 2, own).setZero();
  }
  if (laws_.friction && laws_.friction->rate_dependent()) {
    Directions rate = Directions::Zero(3, size);  // of the velocity by each unknown
    if (moving) {
      rate.leftCols(others) = -skew(m.spin) * arm;
      rate.middleCols<3>(K + 3) += skew(k.relative) * turn;
    }
    if (own > 0) {
      rate.row(0).head(others) += k.travel.slope.transpose() * rate.bottomLeftCorner(2, others);
      const Eigen::Vector2d tilting = k.travel.second * k.rate.tail<2>() + k.travel.shape_slope * m.own_rate;
      rate.row(0).head(others) += tilting.transpose() * arm.bottomRows<2>();
      rate.row(0).tail(own) += k.rate.tail<2>().transpose() * k.travel.shape_slope;
    }
    forces += area * weights.stiffness * local.damping * rate;
  }
  out.rows += own > 0 ? 5 : 3;
  if (!moving) return;
  // The force turns with the body, the carrier's own moment excepted; and its arm moves, d(arm x f) = -f x d(arm).
  const Mat3 turning = area * weights.stiffness * skew(force) * turn;
  out.turned.topRows(K + 3).noalias() += arm.leftCols(K + 3).transpose() * turning;
  out.moment.leftCols(others).noalias() += turning.transpose() * arm;
}

void Contact::tangent(const State& s, const Weights& weights, TangentSink& sink) const {
  if (weights.stiffness == 0 && weights.damping == 0) return;
  const Index K = solid_.unknowns(), size = K + carried_, own = own_ ? own_->size : 0;
  const Moved m = moved(s);
  const std::vector<std::size_t> near = within_reach(m, s);
  std::vector<Eigen::MatrixXd> sums(near.size());  // of what touches
  over_stations(near.size(), [&](std::size_t i, Scratch& t) {
    // The angles of a station share its shape functions: they are added up before these spread them over the nodes.
    Linearised at(static_cast<Index>(angles_.size()) * (own > 0 ? 5 : 3), size, size - own);
    visit_station(m, s, near[i], t, [&](const Kinematics& k) {
      if (k.pressed) linearise(m, k, weights, at);
    });
    if (at.rows == 0) return;
    sums[i].noalias() = at.changes.topRows(at.rows).transpose() * at.forces.topRows(at.rows);
    if (carrier_.translation) {
      sums[i].middleCols<3>(K + 3) += at.turned;
      sums[i].middleRows<3>(K + 3) += at.moment;
    }
  });
  Eigen::MatrixXd wide(3 * K + carried_, 3 * K + carried_);  // of an edge
  bool touched = false;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Station& station = stations_[near[i]];
    if (const Eigen::MatrixXd& sum = sums[i]; sum.size() > 0) {
      if (!touched) wide.setZero();
      touched = true;
      for (Index j = 0; j < 3; ++j) {
        for (Index l = 0; l < 3; ++l)
          wide.block(l * K, j * K, K, K) += station.shape[l] * station.shape[j] * sum.topLeftCorner(K, K);
        wide.block(j * K, 3 * K, K, carried_) += station.shape[j] * sum.topRightCorner(K, carried_);
        wide.block(3 * K, j * K, carried_, K) += station.shape[j] * sum.bottomLeftCorner(carried_, K);
      }
      wide.bottomRightCorner(carried_, carried_) += sum.bottomRightCorner(carried_, carried_);
    }
    if (!touched || (i + 1 < near.size() && stations_[near[i + 1]].edge == station.edge)) continue;
    const Edge& edge = edges_[station.edge];
    sink.add(edge.dofs, edge.dofs, wide(edge.places_and_carried, edge.places_and_carried));
    touched = false;
  }
}

Energies Contact::energies(const State& s) const {
  Energies out;
  const Moved m = moved(s);
  Scratch scratch(*this);
  for (const std::size_t i : within_reach(m, s))
    visit_station(m, s, i, scratch, [&](const Kinematics& k) {
      if (!k.pressed) return;
      const NormalSpring spring = normal(k.number, k.gap);
      out.contact += k.station->area * (0.5 * spring.stiffness * spring.depth * spring.depth +
                                        (past_[k.number].offset + accepted(k).friction.stored));
    });
  out.friction = friction_work_;
  return out;
}

void Contact::commit(const State& s) {
  visit(s, [&](const Moved&, const Kinematics& k) {
    Past& past = past_[k.number];
    const double area = k.station->area;
    if (!k.pressed) {
      // What the tangential spring still held is lost where a point lets go.
      friction_work_ += area * past.stored;
      past = {.place = k.place, .anchor = k.place, .gap = k.gap, .slip = past.slip, .slip_before = past.slip};
      multipliers_[k.number] = 0;
      return;
    }
    const Friction friction = evaluate(k, false).friction;
    const double traction = friction.traction.norm();
    friction_work_ += area * 0.5 * (past.traction + traction) * friction.slip;
    if (!friction.sliding) elastic_slip_ = std::max(elastic_slip_, friction.elastic.norm());
    const double multiplier = multipliers_[k.number];
    past = {.place = k.place,
            .anchor = k.place - friction.elastic,
            .gap = k.gap,
            .traction = traction,
            .stored = friction.stored,
            .slip = past.slip + friction.slip,
            .slip_before = past.slip,
            .touching = true,
            .sliding = friction.sliding,
            .multiplier = multiplier,
            .offset = laws_.method->offset(past.normal(), {.gap = k.gap, .multiplier = multiplier})};
    penetration_ = std::max(penetration_, -k.gap);
  });
}

void Contact::save(std::vector<double>& out) const {
  put(out, friction_work_, penetration_, elastic_slip_, started_);
  for (const Past& p : past_) {
    put(out, p.place, p.anchor, p.gap, p.traction, p.stored, p.slip, p.slip_before, p.touching, p.sliding);
    if (laws_.method->multipliers()) put(out, p.multiplier, p.offset);
  }
}

void Contact::restore(std::span<const double>& in) {
  constexpr char fault[] = "contact: the history is too short";
  take(in, fault, friction_work_, penetration_, elastic_slip_, started_);
  for (Past& p : past_) {
    take(in, fault, p.place, p.anchor, p.gap, p.traction, p.stored, p.slip, p.slip_before, p.touching, p.sliding);
    if (laws_.method->multipliers()) take(in, fault, p.multiplier, p.offset);
  }
  for (std::size_t i = 0; i < past_.size(); ++i) multipliers_[i] = past_[i].multiplier;
}

ContactReport Contact::report(const State& s) const {
  ContactReport out;
  double weight = 0;
  Vec3 centre = Vec3::Zero();
  visit(s, [&](const Moved& m, const Kinematics& k) {
    out.nearest = std::min(out.nearest, k.gap);
    if (!k.pressed) return;
    const Local local = accepted(k);
    const double area = k.station->area;
    out.force += area * (m.R * in_body(k, local.force));
    out.normal_force += area * local.pressure;
    out.pressure = std::max(out.pressure, local.pressure);
    out.area += area;
    centre += area * local.pressure * (m.node + m.R * k.arm);
    weight += area * local.pressure;
    ++out.points;
  });
  out.force = (free_translation() * out.force).eval();
  const Vec3& origin = solid_.placement().origin;
  if (weight > 0) out.point = origin + free_translation() * (centre / weight - origin);
  out.penetration = penetration_;
  out.elastic_slip = elastic_slip_;
  return out;
}

std::vector<ContactPoint> Contact::points(const State& s) const {
  std::vector<ContactPoint> out;
  visit(s, [&](const Moved& m, const Kinematics& k) {
    const Local local = k.pressed ? accepted(k) : Local{};
    const Past& past = past_[k.number];
    const Vec3 push = local.force + local.friction.traction;
    out.push_back({reference_.col(static_cast<Index>(k.number)), m.node + m.R * k.arm, m.R * in_body(k, local.force),
                   m.R * in_body(k, push), local.pressure, k.gap, past.slip, k.station->area, past.sliding,
                   angles_[k.angle]});
  });
  return out;
}

double Contact::surface_travel(const State& s, const Vec3& place) const {
  return own_ ? surface_->travel(place, moved(s).own) : 0;
}

double Contact::centre_gap(const State& s) const {
  const Moved m = moved(s);
  return surface_->gap(place(m, m.to_body * (solid_.centre(s) - m.node)));
}

Mat3 Contact::free_translation() const {
  const Mat3& axes = solid_.placement().axes;
  switch (symmetry_) {
    case Symmetry::plane: return Mat3::Identity() - axes.col(2) * axes.col(2).transpose();
    case Symmetry::axis: return axes.col(0) * axes.col(0).transpose();
    default: return Mat3::Identity();
  }
}

Mat3 Contact::free_rotation(const Mat3& R) const {
  if (symmetry_ == Symmetry::none) return Mat3::Identity();
  if (symmetry_ == Symmetry::axis) return Mat3::Zero();
  const Vec3 b = R.transpose() * solid_.placement().axes.col(2);
  return b * b.transpose();
}

}  // namespace hosel::fem
