#include "post/shaft_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "golf/dense.hpp"
#include "golf/units.hpp"

namespace hosel::post {
namespace {

using Field = std::vector<double>;

Field field(const FaceMap& map, const std::function<double(const Launch&)>& value) {
  Field out;
  for (const auto& launch : map.launches) {
    if (!launch) throw std::invalid_argument(fmt::format("'{}' has a point without a launch", map.title));
    out.push_back(value(*launch));
  }
  return out;
}

Field minus(Field a, const Field& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

double mean(const Field& f) {
  double sum = 0;
  for (const double x : f) sum += x;
  return sum / double(f.size());
}

/// Bilinear at a point of the face [m].
double at(const FaceGrid& g, const Field& f, double toe, double high) {
  const double x = (toe / g.width + 0.5) * (g.columns - 1), y = (high / g.height + 0.5) * (g.rows - 1);
  const int i = std::clamp(int(x), 0, g.columns - 2), j = std::clamp(int(y), 0, g.rows - 2);
  const double a = x - i, b = y - j;
  const auto v = [&](int column, int row) {
    return f[std::size_t(row) * std::size_t(g.columns) + std::size_t(column)];
  };
  return (1 - b) * ((1 - a) * v(i, j) + a * v(i + 1, j)) + b * ((1 - a) * v(i, j + 1) + a * v(i + 1, j + 1));
}

/// Towards the toe and upwards.
struct OnFace {
  double toe, high;
};

/// [per mm]
OnFace slope(const FaceGrid& g, const Field& f) {
  Eigen::MatrixX3d A(Eigen::Index(g.size()), 3);
  for (std::size_t p = 0; p < g.size(); ++p) A.row(Eigen::Index(p)) << 1, 1e3 * g.toe_at(p), 1e3 * g.high_at(p);
  const Eigen::Vector3d c =
      dense::PivotedQr(A).solve(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(f.data(), Eigen::Index(f.size()))));
  return {c[1], c[2]};
}

/// Place of the least value [mm]: a parabola in each direction through the least grid point and its neighbours.
OnFace least(const FaceGrid& g, const Field& f) {
  const std::size_t best = std::size_t(std::ranges::min_element(f) - f.begin());
  const int i = int(best) % g.columns, j = int(best) / g.columns;
  const auto vertex = [](double below, double here, double above) {
    const double curvature = below - 2 * here + above;
    return curvature > 0 ? 0.5 * (below - above) / curvature : 0.0;  // in steps, within one half
  };
  OnFace p{1e3 * g.toe(i), 1e3 * g.high(j)};
  if (i > 0 && i + 1 < g.columns) p.toe += 1e3 * g.width / (g.columns - 1) * vertex(f[best - 1], f[best], f[best + 1]);
  const std::size_t row = std::size_t(g.columns);
  if (j > 0 && j + 1 < g.rows) p.high += 1e3 * g.height / (g.rows - 1) * vertex(f[best - row], f[best], f[best + row]);
  return p;
}

Field negative(Field f) {
  for (double& x : f) x = -x;
  return f;
}

/// What the club changes of a distance, in its unit; empty unless every ball of both maps flew.
Field flight_gain(const FaceMap& club, const FaceMap& free, double models::Flight::*distance) {
  const auto flew = [](const FaceMap& m) {
    return !m.flights.empty() && std::ranges::all_of(m.flights, [](const auto& f) { return f.has_value(); });
  };
  if (!flew(club) || !flew(free)) return {};
  Field out;
  for (std::size_t p = 0; p < club.flights.size(); ++p)
    out.push_back((club.flights[p]->flight.*distance - free.flights[p]->flight.*distance) / size(club.distances));
  return out;
}

}  // namespace

std::vector<NamedFigure> shaft_effect(const FaceGrid& g, const FaceMap& club, const FaceMap& free) {
  const auto launch = [](const Launch& l) { return degrees(l.launch_angle()); };
  const auto azimuth = [](const Launch& l) { return degrees(l.azimuth()); };
  const auto side = [](const Launch& l) { return rpm(l.sidespin()); };
  const auto back = [](const Launch& l) { return rpm(l.backspin()); };
  const auto turn = [](const Launch& l) { return l.head_spin.norm(); };
  const auto turn2 = [](const Launch& l) { return l.head_spin.squaredNorm(); };

  const Field v_free = field(free, &Launch::ball_speed), v_club = field(club, &Launch::ball_speed),
              gain = minus(v_club, v_free);
  const double toe = 0.5 * g.width, high = 0.5 * g.height;
  const OnFace gain_slope = slope(g, gain);
  const OnFace fastest_club = least(g, negative(v_club)), fastest_free = least(g, negative(v_free));
  const OnFace calm_club = least(g, field(club, turn2)), calm_free = least(g, field(free, turn2));
  const OnFace most = least(g, negative(gain));
  const Field d_side = minus(field(club, side), field(free, side)),
              d_back = minus(field(club, back), field(free, back));
  const OnFace launch_free = slope(g, field(free, launch)), launch_club = slope(g, field(club, launch));
  const OnFace azimuth_free = slope(g, field(free, azimuth)), azimuth_club = slope(g, field(club, azimuth));
  const OnFace side_free = slope(g, field(free, side)), side_slope = slope(g, d_side), back_slope = slope(g, d_back);
  const Field turn_free = field(free, turn), turn_club = field(club, turn);
  const double gain_min = *std::ranges::min_element(gain), gain_max = *std::ranges::max_element(gain);
  const double share = double(std::ranges::count_if(gain, [](double x) { return x > 0; })) / double(gain.size());
  const double gain_centre = at(g, gain, 0, 0), gain_corner = at(g, gain, -toe, high),
               gain_far = at(g, gain, toe, -high);
  const double apart = std::hypot(fastest_club.toe - calm_club.toe, fastest_club.high - calm_club.high);
  const double apart_free = std::hypot(fastest_free.toe - calm_free.toe, fastest_free.high - calm_free.high);
  const double d_side_toe = at(g, d_side, toe, 0), d_side_heel = at(g, d_side, -toe, 0);

  std::vector<NamedFigure> out = {
      {"ball_speed_gain_min_mps", gain_min},
      {"ball_speed_gain_mean_mps", mean(gain)},
      {"ball_speed_gain_max_mps", gain_max},
      {"ball_speed_gain_positive_share", share},
      {"ball_speed_gain_centre_mps", gain_centre},
      {"ball_speed_gain_centre_percent", 100 * gain_centre / at(g, v_free, 0, 0)},
      {"ball_speed_gain_high_heel_mps", gain_corner},
      {"ball_speed_gain_low_toe_mps", gain_far},
      {"ball_speed_gain_high_heel_over_centre_mps", gain_corner - gain_centre},
      {"ball_speed_gain_slope_towards_heel_mps_per_mm", -gain_slope.toe},
      {"ball_speed_gain_slope_upwards_mps_per_mm", gain_slope.high},
      {"largest_gain_toe_mm", most.toe},
      {"largest_gain_high_mm", most.high},
      {"fastest_club_toe_mm", fastest_club.toe},
      {"fastest_club_high_mm", fastest_club.high},
      {"fastest_free_toe_mm", fastest_free.toe},
      {"fastest_free_high_mm", fastest_free.high},
      {"least_rotation_club_toe_mm", calm_club.toe},
      {"least_rotation_club_high_mm", calm_club.high},
      {"least_rotation_free_toe_mm", calm_free.toe},
      {"least_rotation_free_high_mm", calm_free.high},
      {"fastest_to_least_rotation_club_mm", apart},
      {"fastest_to_least_rotation_free_mm", apart_free},
      {"head_rotation_mean_free_rad_per_s", mean(turn_free)},
      {"head_rotation_mean_club_rad_per_s", mean(turn_club)},
      {"sidespin_difference_toe_rpm", d_side_toe},
      {"sidespin_difference_heel_rpm", d_side_heel},
      {"sidespin_slope_free_rpm_per_mm", side_free.toe},
      {"sidespin_difference_slope_rpm_per_mm", side_slope.toe},
      {"backspin_difference_high_rpm", at(g, d_back, 0, high)},
      {"backspin_difference_low_rpm", at(g, d_back, 0, -high)},
      {"backspin_difference_slope_rpm_per_mm", back_slope.high},
      {"launch_angle_slope_free_deg_per_mm", launch_free.high},
      {"launch_angle_slope_club_deg_per_mm", launch_club.high},
      {"launch_angle_slope_difference_deg_per_mm", launch_club.high - launch_free.high},
      {"azimuth_slope_free_deg_per_mm", azimuth_free.toe},
      {"azimuth_slope_club_deg_per_mm", azimuth_club.toe},
      {"azimuth_slope_difference_deg_per_mm", azimuth_club.toe - azimuth_free.toe},
  };
  const Field carry = flight_gain(club, free, &models::Flight::carry),
              aside = flight_gain(club, free, &models::Flight::side);
  if (!carry.empty()) {
    const auto add = [&](std::string_view name, double value) {
      out.push_back({fmt::format("{}_{}", name, suffix(club.distances)), value});
    };
    add("carry_gain_centre", at(g, carry, 0, 0));
    add("carry_gain_mean", mean(carry));
    add("carry_gain_min", *std::ranges::min_element(carry));
    add("carry_gain_max", *std::ranges::max_element(carry));
    add("side_difference_toe", at(g, aside, toe, 0));
    add("side_difference_heel", at(g, aside, -toe, 0));
  }
  return out;
}

std::vector<std::string> shaft_effect_names() {
  const FaceMap flat{"", std::vector<std::optional<Launch>>(9, Launch{.velocity = Vec3::UnitX()})};
  std::vector<std::string> names;
  for (const NamedFigure& f : shaft_effect({.columns = 3, .rows = 3}, flat, flat)) names.push_back(f.name);
  return names;
}

std::vector<double> equivalent_mass(const FaceMap& club, const FaceMap& free, const FaceMap& heavier, double mass,
                                    double extra) {
  const auto inverse = [](const Launch& l) { return 1 / l.ball_speed(); };
  const Field c = field(club, inverse), f = field(free, inverse), h = field(heavier, inverse);
  Field out;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double per_inverse_mass = (h[i] - f[i]) / (1 / (mass + extra) - 1 / mass);
    out.push_back(1 / (1 / mass + (c[i] - f[i]) / per_inverse_mass) - mass);
  }
  return out;
}

std::vector<NamedFigure> mass_figures(const FaceGrid& g, const std::vector<double>& mass) {
  return {{"equivalent_head_mass_centre_g", 1e3 * at(g, mass, 0, 0)},
          {"equivalent_head_mass_mean_g", 1e3 * mean(mass)},
          {"equivalent_head_mass_min_g", 1e3 * std::ranges::min(mass)},
          {"equivalent_head_mass_max_g", 1e3 * std::ranges::max(mass)}};
}

double mirror_error(const FaceGrid& g, const FaceMap& map) {
  struct Kept {
    double (Launch::*value)() const;
    double sign;
  };
  double worst = 0;
  const auto compare = [&](const std::vector<Kept>& kind) {
    double scale = 0, error = 0;
    for (const Kept& k : kind) {
      const Field f = field(map, k.value);
      for (const double x : f) scale = std::max(scale, std::abs(x));
      for (int j = 0; j < g.rows; ++j)
        for (int i = 0; i < g.columns; ++i) {
          const std::size_t row = std::size_t(j) * std::size_t(g.columns);
          error = std::max(error, std::abs(f[row + std::size_t(i)] - k.sign * f[row + std::size_t(g.columns - 1 - i)]));
        }
    }
    if (scale > 0) worst = std::max(worst, error / scale);
  };
  compare({{&Launch::ball_speed, 1}});
  compare({{&Launch::launch_angle, 1}, {&Launch::azimuth, -1}});
  compare({{&Launch::backspin, 1}, {&Launch::sidespin, -1}});
  return worst;
}

}  // namespace hosel::post
