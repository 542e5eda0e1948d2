#include "loop/shots/features.hpp"

#include <array>
#include <cmath>

namespace hosel::loop {
namespace {

/// Velocity of the head's centre of gravity in the face frame.
Vec3 arrival(const Shot& s) { return s.blow.delivery.face_to_global().transpose() * s.blow.delivery.velocity(); }

template <int k>
double rate(const Shot& s) {
  return s.blow.delivery.face_to_global().col(k).dot(s.blow.delivery.head_angular_velocity);
}
template <int k>
void set_rate(Shot& s, double x) {
  s.blow.delivery.head_angular_velocity += (x - rate<k>(s)) * s.blow.delivery.face_to_global().col(k);
}

template <int k>
double place(const Shot& s) {
  return s.blow.club.head.cg[k];
}
template <int k>
void set_place(Shot& s, double x) {
  s.blow.club.head.cg[k] = x;
}

template <int k>
double moment(const Shot& s) {
  return std::log(s.blow.club.head.inertia(k, k));
}
/// The products of inertia go along, so that the axes' correlation stays.
template <int k>
void set_moment(Shot& s, double x) {
  Mat3& inertia = s.blow.club.head.inertia;
  const double root = std::exp((x - moment<k>(s)) / 2);
  inertia.row(k) *= root;
  inertia.col(k) *= root;
}

template <int k>
double hosel(const Shot& s) {
  return s.blow.club.geometry.hosel[k];
}
template <int k>
void set_hosel(Shot& s, double x) {
  s.blow.club.geometry.hosel[k] = x;
}

template <double models::FeChange::*value>
Feature change(std::string_view name) {
  return {name, [](const Shot& s) { return s.change.*value; }, [](Shot& s, double x) { s.change.*value = x; }};
}

const std::array kFeatures = {
    Feature{"club speed", [](const Shot& s) { return s.blow.delivery.club_speed; }},
    Feature{"arrival across",
            [](const Shot& s) {
              const Vec3 v = arrival(s);
              return std::atan2(v.y(), v.x());
            }},
    Feature{"arrival along",
            [](const Shot& s) {
              const Vec3 v = arrival(s);
              return std::atan2(v.z(), v.x());
            }},
    Feature{"impact toe", [](const Shot& s) { return s.blow.delivery.impact_toe; }},
    Feature{"impact high", [](const Shot& s) { return s.blow.delivery.impact_high; }},
    Feature{"head mass", [](const Shot& s) { return std::log(s.blow.club.head.mass); },
            [](Shot& s, double x) { s.blow.club.head.mass = std::exp(x); }},
    Feature{"centre of gravity, out", place<0>, set_place<0>},
    Feature{"centre of gravity, heel", place<1>, set_place<1>},
    Feature{"centre of gravity, up", place<2>, set_place<2>},
    Feature{"inertia about the normal", moment<0>, set_moment<0>},
    Feature{"inertia about the horizontal", moment<1>, set_moment<1>},
    Feature{"inertia about the vertical", moment<2>, set_moment<2>},
    Feature{"rate about the normal", rate<0>, set_rate<0>},
    Feature{"rate about the horizontal", rate<1>, set_rate<1>},
    Feature{"rate about the vertical", rate<2>, set_rate<2>},
    Feature{"friction", [](const Shot& s) { return std::log(s.blow.contact.friction); },
            [](Shot& s, double x) { s.blow.contact.friction = std::exp(x); }},
    Feature{"hosel, out", hosel<0>, set_hosel<0>},
    Feature{"hosel, heel", hosel<1>, set_hosel<1>},
    Feature{"hosel, up", hosel<2>, set_hosel<2>},
    change<&models::FeChange::cover_stiffness>("cover stiffness"),
    change<&models::FeChange::cover_thickness>("cover thickness"),
    change<&models::FeChange::losses>("losses"),
    change<&models::FeChange::relaxation>("relaxation"),
    change<&models::FeChange::face_compliance>("face compliance"),
    change<&models::FeChange::shaft>("shaft"),
    change<&models::FeChange::shaft_stiffness>("shaft stiffness"),
};

}  // namespace

std::span<const Feature> features() { return kFeatures; }

}  // namespace hosel::loop
