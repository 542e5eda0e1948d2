#include "models/club/swing.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/modal_damping.hpp"
#include "golf/shaft_library.hpp"
#include "solvers/ida.hpp"
#include "solvers/modes.hpp"
#include "solvers/statics.hpp"

namespace hosel::models {
namespace {

/// Sets a value until the end of a scope, also where that is left by an exception.
class Held {
 public:
  Held(std::optional<double>& place, double time) : place_(place) { place_ = time; }
  ~Held() { place_.reset(); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

 private:
  std::optional<double>& place_;
};

}  // namespace

std::vector<std::string> SwingOptions::faults() const {
  std::vector<std::string> out;
  if (elements < 1) out.emplace_back("a shaft needs at least one element");
  if (!(growth > 0)) out.emplace_back("the growth of the elements is above zero");
  if (!(step > 0)) out.emplace_back("the step is above zero");
  if (!(rho_inf >= 0 && rho_inf <= 1)) out.emplace_back("rho_inf lies in [0, 1]");
  if (!(tolerance > 0)) out.emplace_back("the tolerance is above zero");
  for (const double ratio : modal_damping)
    if (!(ratio >= 0 && ratio < 1)) out.emplace_back("a modal damping ratio lies in [0, 1)");
  if (!(grip_point >= 0)) out.emplace_back("the grip point lies on the shaft");
  return out;
}

Mat3 face_to_grip(const ClubGeometry& geometry) {
  Mat3 grip;  // grip axes in the face frame
  grip.col(2) = geometry.shaft_axis.normalized();
  grip.col(1) = grip.col(2).cross(Vec3::UnitX()).normalized();
  grip.col(0) = grip.col(1).cross(grip.col(2));
  return grip.transpose();
}

Delivery delivery_of(const fem::Pose& head) {
  const Vec3& v = head.velocity;
  const Vec3 n = head.rotation * Vec3::UnitX();
  Delivery d;
  d.club_speed = v.norm();
  d.attack_angle = std::asin(v.z() / v.norm());
  d.club_path = std::atan2(-v.y(), v.x());
  d.dynamic_loft = std::asin(n.z());
  d.face_angle = std::atan2(-n.y(), n.x());
  d.head_angular_velocity = head.rotation * head.angular_velocity;
  return d;
}

double dynamic_lie(const fem::Pose& head) {
  const Vec3 heel = delivery_of(head).face_to_global().transpose() * (head.rotation * Vec3::UnitY());
  return std::atan2(-heel.z(), heel.y());
}

Club turned_about_normal(Club club, double angle) {
  if (angle != 0 && club.head.face.bulge != club.head.face.roll)
    throw std::invalid_argument("a face of unlike bulge and roll cannot be described in a turned frame");
  const Mat3 turn = Eigen::AngleAxisd(-angle, Vec3::UnitX()).toRotationMatrix();
  club.head.cg = turn * club.head.cg;
  club.head.inertia = (turn * club.head.inertia * turn.transpose()).eval();
  club.geometry.hosel = turn * club.geometry.hosel;
  club.geometry.shaft_axis = turn * club.geometry.shaft_axis;
  if (club.head.compliance) club.head.compliance->turn -= angle;
  return club;
}

Swing::Swing(const Club& club, const SwingOptions& options, GripDrive drive)
    : club_(club), options_(options), drive_(std::move(drive)), face_to_grip_(models::face_to_grip(club.geometry)) {
  if (!club.shaft) throw std::invalid_argument("a swing needs a shaft");
  if (const auto wrong = faults(*club.shaft); !wrong.empty()) throw std::invalid_argument(wrong.front());
  if (const auto wrong = options.faults(); !wrong.empty()) throw std::invalid_argument("swing: " + wrong.front());
  const Shaft& shaft = *club.shaft;
  length_ = shaft.length() - options.grip_point;
  if (!(length_ > 0)) throw std::invalid_argument("swing: the grip point lies beyond the shaft's tip");

  const auto line = mesh::straight(mesh::graded(length_, options.elements, options.growth), Vec3::Zero(),
                                   mesh::frame_along(-Vec3::UnitZ(), Vec3::UnitX()));
  auto beam =
      std::make_unique<fem::Beam>(system_.dof_map, line, fem::shaft_sections(shaft, options.shear, options.grip_point),
                                  fem::BeamOptions{.gravity = options.gravity, .damping_time = shaft.damping_time});
  shaft_ = beam.get();
  system_.terms.push_back(std::move(beam));
  head_node_ = shaft_->nodes().back();

  if (options.joint.kind != HeadJoint::Kind::none) {
    if (options.joint.gives()) {
      head_node_ = {system_.dof_map.add_vector(3), system_.dof_map.add_rotation()};
      system_.terms.push_back(std::make_unique<fem::SpringJoint>("joint", shaft_->nodes().back(), head_node_,
                                                                 stiffness_of(options.joint, shaft, Mat3::Identity())));
    }
    const Head& head = club.head;
    auto body = std::make_unique<fem::RigidBody>(
        "head", head_node_.translation, head_node_.rotation,
        fem::RigidBodyProperties{head.mass, face_to_grip_ * head.inertia * face_to_grip_.transpose(),
                                 face_to_grip_ * (head.cg - club.geometry.hosel)},
        options.gravity);
    head_ = body.get();
    system_.terms.push_back(std::move(body));
  }

  if (!options.modal_damping.empty()) system_.terms.push_back(modal_damping());

  const fem::Node& grip = shaft_->nodes().front();
  const fem::Motion motion = [this](double t) {
    if (!held_) return drive_.motion(t);
    const fem::Pose p = drive_.motion(*held_);
    return fem::Pose{.position = p.position, .rotation = p.rotation};
  };
  using Kind = GripDrive::Kind;
  if (drive_.kind == Kind::prescribed) system_.prescribed.push_back(std::make_unique<fem::ImposedMotion>(grip, motion));
  else if (drive_.kind == Kind::hands) {
    auto hands = std::make_unique<fem::SpringJoint>("hands", motion, grip, drive_.hands);
    hands_ = hands.get();
    system_.terms.push_back(std::move(hands));
  } else if (drive_.kind == Kind::forced)
    system_.terms.push_back(std::make_unique<fem::NodeLoad>("hands", grip, drive_.wrench, fem::NodeLoad::Moment::body));
}

std::unique_ptr<fem::Term> Swing::modal_damping() {
  // The club at rest, held at the grip: its modes, and M phi gathered from the terms' blocks.
  fem::State rest = system_.dof_map.rest();
  shaft_->place(rest);
  if (head_node_.translation.v != shaft_->nodes().back().translation.v)
    rest.q.segment<3>(head_node_.translation.q) = shaft_->line().back().position;
  const auto count = static_cast<Eigen::Index>(options_.modal_damping.size());
  system_.prescribed.push_back(
      std::make_unique<fem::ImposedMotion>(shaft_->nodes().front(), fem::at_rest(Vec3::Zero())));
  const solvers::Modes modes = solvers::modes(system_, rest, static_cast<int>(count));
  system_.prescribed.pop_back();
  if (static_cast<Eigen::Index>(modes.omega.size()) < count)
    throw std::invalid_argument("swing: the club has fewer modes than damping ratios");
  struct Product final : fem::TangentSink {  // mass matrix times the modes
    const Eigen::MatrixXd& of;
    Eigen::MatrixXd sum;
    explicit Product(const Eigen::MatrixXd& m) : of(m), sum(Eigen::MatrixXd::Zero(m.rows(), m.cols())) {}
    void add(const std::vector<fem::Index>& rows, const std::vector<fem::Index>& columns,
             const Eigen::Ref<const Eigen::MatrixXd>& block) override {
      sum(rows, Eigen::all) += block * of(columns, Eigen::all);
    }
  } product(modes.shapes);
  for (const auto& term : system_.terms) term->tangent(rest, {0, 0, 1}, product);
  std::vector<fem::Node> nodes = shaft_->nodes();
  if (head_node_.translation.v != nodes.back().translation.v) nodes.push_back(head_node_);
  Eigen::MatrixXd weights(6 * static_cast<Eigen::Index>(nodes.size()), count);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    weights.middleRows<3>(at) = product.sum.middleRows<3>(nodes[i].translation.v);
    weights.middleRows<3>(at + 3) = product.sum.middleRows<3>(nodes[i].rotation.v);
  }
  fem::Vector rates(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    rates[k] = 2 * options_.modal_damping[i] * modes.omega[i];
  }
  return std::make_unique<fem::ModalDamping>("shaft", shaft_->nodes().front(), nodes, weights, rates);
}

double Swing::mass() const { return shaft_->mass() + (head_ ? head_->properties().mass : 0); }

solvers::NewtonOptions Swing::newton() const {
  const double t = options_.tolerance;
  return {.residual_relative = t, .residual_absolute = t, .increment_vector = 0.1 * t, .increment_rotation = 0.1 * t};
}

void Swing::check_held() const {
  if (drive_.kind != GripDrive::Kind::prescribed && drive_.kind != GripDrive::Kind::hands)
    throw std::invalid_argument("a club that nothing holds has no equilibrium");
}

fem::State Swing::equilibrium(double time) {
  check_held();
  const Held held(held_, time);
  fem::State s = straight(time);
  s.v.setZero();
  s = options_.kinsol ? solvers::solve_static_kinsol(system_, s, 1e-6)
                      : solvers::solve_static(system_, s, {.newton = newton(), .load_steps = 1});
  s.time = time;
  return s;
}

fem::State Swing::start(double time, const fem::State& deflected) const {
  return carried(deflected, drive_.motion(deflected.time), drive_.motion(time), time);
}

/// The straight shaft along the axis of the grip as it is held.
fem::State Swing::straight(double time) const {
  fem::State s = system_.dof_map.rest();
  shaft_->place(s);
  if (head_node_.translation.v != shaft_->nodes().back().translation.v)
    s.q.segment<3>(head_node_.translation.q) = shaft_->line().back().position;
  const fem::Node& root = shaft_->nodes().front();
  const fem::Pose rest{.position = s.q.segment<3>(root.translation.q), .rotation = fem::rotation(s, root.rotation)},
      grip = drive_.motion(time);
  return carried(s, rest, {.position = grip.position, .rotation = grip.rotation}, time);
}

/// The shape is turned and moved with the grip from one pose to the other, and has the latter's velocity.
fem::State Swing::carried(const fem::State& shape, const fem::Pose& from, const fem::Pose& grip, double time) const {
  const Eigen::Quaterniond turn = grip.rotation * from.rotation.conjugate();
  const Vec3 w = grip.rotation * grip.angular_velocity;
  fem::State s = shape;
  s.time = time;
  const auto move = [&](const fem::Node& n) {
    const Vec3 arm = turn * (Vec3(shape.q.segment<3>(n.translation.q)) - from.position);
    const Eigen::Quaterniond R = turn * fem::rotation(shape, n.rotation);
    s.q.segment<3>(n.translation.q) = grip.position + arm;
    fem::set_rotation(s, n.rotation, R);
    s.v.segment<3>(n.translation.v) = grip.velocity + w.cross(arm);
    s.v.segment<3>(n.rotation.v) = R.conjugate() * w;
  };
  for (const fem::Node& n : shaft_->nodes()) move(n);
  if (head_node_.translation.v != shaft_->nodes().back().translation.v) move(head_node_);
  s.a.setZero();
  return s;
}

fem::State Swing::hold(double time, double seconds) {
  check_held();
  const Held held(held_, time);
  fem::State s = straight(time);
  s.time = time - seconds;
  solvers::GeneralizedAlpha run = scheme(s);
  while (run.time() < time - 1e-9 * seconds) run.advance(time);
  s = run.state();
  s.time = time;
  return s;
}

SwingSample Swing::sample(const fem::State& s, const fem::Vector& reactions) const {
  SwingSample out;
  out.time = s.time;
  const fem::Node &root = shaft_->nodes().front(), &tip = shaft_->nodes().back();
  const auto pose = [&](const fem::Node& n) {
    return fem::Pose{.position = s.q.segment<3>(n.translation.q),
                     .rotation = fem::rotation(s, n.rotation),
                     .velocity = s.v.segment<3>(n.translation.v),
                     .acceleration = s.a.segment<3>(n.translation.v),
                     .angular_velocity = s.v.segment<3>(n.rotation.v),
                     .angular_acceleration = s.a.segment<3>(n.rotation.v)};
  };
  out.grip = pose(root);
  const fem::Pose hosel = pose(tip);
  const Vec3 d = out.grip.rotation.conjugate() * (hosel.position - out.grip.position) + Vec3(0, 0, length_);
  out.lead = d.x();
  out.droop = d.y();
  out.shortening = d.z();
  out.twist = fem::rotation_log(out.grip.rotation.conjugate() * hosel.rotation);
  if (head_) {
    const Eigen::Quaterniond to_face(face_to_grip_);
    const fem::Pose body = pose(head_node_);
    out.head.position = head_->position(s);
    out.head.velocity = head_->velocity(s);
    out.head.rotation = body.rotation * to_face;
    out.head.angular_velocity = to_face.conjugate() * body.angular_velocity;
  } else {
    out.head = hosel;
  }
  if (drive_.kind == GripDrive::Kind::prescribed) {
    out.force = reactions.segment<3>(root.translation.v);
    out.moment = reactions.segment<3>(root.rotation.v);
  } else if (drive_.kind == GripDrive::Kind::forced) {
    const fem::Wrench w = drive_.wrench(s.time);
    out.force = w.force;
    out.moment = w.moment;
  } else if (hands_) {
    fem::Vector inertia = fem::Vector::Zero(system_.dof_map.size()), force = inertia;
    hands_->residual(s, inertia, force);
    out.force = -force.segment<3>(root.translation.v);
    out.moment = -force.segment<3>(root.rotation.v);
  }
  return out;
}

solvers::GeneralizedAlpha Swing::scheme(const fem::State& from) {
  return {
      system_,
      {.rho_inf = options_.rho_inf, .newton = newton(), .step_max = options_.step, .step_min = options_.step / 1024},
      from};
}

fem::State Swing::run(const fem::State& from, double end, const Observer& observer) {
  return watch(from, end, [&](const SwingSample& sample, const fem::State&) {
    if (observer) observer(sample);
  });
}

fem::State Swing::watch(const fem::State& from, double end, const StateObserver& observer) {
  solvers::GeneralizedAlpha run = scheme(from);
  observer(sample(run.state(), run.reactions()), run.state());
  if (options_.integrator == SwingIntegrator::ida) return by_ida(run.state(), end, observer);
  while (run.time() < end - 1e-9 * options_.step) {
    run.advance(end);
    observer(sample(run.state(), run.reactions()), run.state());
  }
  ledger_ = run.ledger();
  counts_ = run.counts();
  return run.state();
}

fem::State Swing::by_ida(const fem::State& consistent, double end, const StateObserver& observer) {
  std::vector<double> times;
  const auto count = static_cast<long>(std::ceil((end - consistent.time) / options_.step - 1e-9));
  for (long i = 1; i <= count; ++i)
    times.push_back(consistent.time + (end - consistent.time) * static_cast<double>(i) / static_cast<double>(count));
  fem::State last = consistent;
  ledger_ = {};
  counts_ = {};
  solvers::integrate_ida(system_, consistent, times, [&](const fem::State& s) {
    observer(sample(s, fem::unbalanced(system_, s)), s);
    last = s;
    ++counts_.steps;
  });
  return last;
}

}  // namespace hosel::models
