#include "models/club/hosel_load.hpp"

namespace hosel::models {

namespace {

/// What the shaft's own inertia and stresses leave for others to balance.
fem::Vector residual(const fem::Beam& shaft, const fem::State& s) {
  fem::Vector inertia = fem::Vector::Zero(s.v.size()), force = inertia;
  shaft.residual(s, inertia, force);
  return inertia + force;
}

}  // namespace

fem::Wrench grip_load(const fem::Beam& shaft, const fem::State& s) {
  const fem::Node& butt = shaft.nodes().front();
  const fem::Vector r = residual(shaft, s);
  return {r.segment<3>(butt.translation.v), fem::rotation(s, butt.rotation) * Vec3(r.segment<3>(butt.rotation.v))};
}

fem::Wrench hosel_load(const fem::Beam& shaft, const fem::State& s) {
  const fem::Node& tip = shaft.nodes().back();
  const fem::Vector r = residual(shaft, s);
  return {-(fem::rotation(s, tip.rotation).conjugate() * Vec3(r.segment<3>(tip.translation.v))),
          -r.segment<3>(tip.rotation.v)};
}

void HoselHistory::add(const fem::Beam& shaft, const fem::State& s) {
  times.push_back(s.time);
  loads.push_back(hosel_load(shaft, s));
}

fem::Wrench HoselHistory::impulse() const {
  fem::Wrench out;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double w = 0.5 * (times[i] - times[i - 1]);
    out.force += w * (loads[i - 1].force + loads[i].force);
    out.moment += w * (loads[i - 1].moment + loads[i].moment);
  }
  return out;
}

}  // namespace hosel::models
