#include "post/ball_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fem/materials/equivalent_stress.hpp"
#include "golf/units.hpp"

namespace hosel::post {
namespace {

/// From nothing to the largest: light to dark, in one order for every kind of eye.
std::string colour(double share) {
  static constexpr std::array<std::array<int, 3>, 5> kStops = {
      {{255, 255, 217}, {199, 233, 180}, {65, 182, 196}, {34, 94, 168}, {8, 29, 88}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t low = std::min(std::size_t(at), kStops.size() - 2);
  std::string out = "#";
  for (std::size_t i = 0; i < 3; ++i)
    out += fmt::format(
        "{:02x}", int(std::lround(std::lerp(double(kStops[low][i]), double(kStops[low + 1][i]), at - double(low)))));
  return out;
}

}  // namespace

BallSection ball_section(const models::ImpactView& view, const Face& face) {
  const fem::HarmonicSolid& ball = view.ball;
  const mesh::Meridian& meridian = ball.mesh();
  // The cut holds the mesh's axis and the direction of slip; its picture lies as the target line does.
  const Vec3 across = ball.placement().axes.col(2), X = Vec3::UnitX(), Z = Vec3::UnitZ();
  const Vec3 right = (X - X.dot(across) * across).normalized();
  Vec3 up = across.cross(right);
  if (up.dot(Z) < 0) up = -up;

  BallSection s;
  s.time = view.state.time;
  s.force = view.report.normal_force;
  const std::vector<double> theta = {0, kPi};
  const auto displacement = ball.displacement_fields(view.state);
  const auto stress = ball.cauchy_at_nodes(view.state, theta);
  const int nodes = int(meridian.nodes.size());
  std::vector<Vec3> place;
  Vec3 sum = Vec3::Zero();
  for (int side = 0; side < 2; ++side) {
    const double angle = theta[std::size_t(side)];
    const Eigen::Matrix3Xd functions = ball.functions_at(angle);
    for (int n = 0; n < nodes; ++n) {
      place.push_back(ball.reference(n, angle) + functions * displacement.row(n).transpose());
      s.von_mises.push_back(fem::von_mises(stress[std::size_t(2 * n + side)]));
      sum += place.back();
    }
  }
  const Vec3 middle = sum / double(place.size());
  for (const Vec3& x : place) s.points.emplace_back((x - middle).dot(right), (x - middle).dot(up));

  std::map<std::pair<int, int>, int> seen;  // corners of an edge, layer on its one side
  constexpr int kParts = 4;                 // of an element's side, so that its curves and its stress show
  for (int side = 0; side < 2; ++side)
    for (std::size_t e = 0; e < meridian.elements.size(); ++e) {
      std::array<int, 8> n{};
      for (std::size_t i = 0; i < 8; ++i) n[i] = meridian.elements[e][i] + side * nodes;
      const int first = int(s.points.size());
      for (int k = 0; k <= kParts; ++k)
        for (int l = 0; l <= kParts; ++l) {
          const auto shape = mesh::Q8::at(2.0 * l / kParts - 1, 2.0 * k / kParts - 1).value;
          BallSection::Point x = BallSection::Point::Zero();
          double mises = 0;
          for (int i = 0; i < 8; ++i) {
            x += shape[i] * s.points[std::size_t(n[std::size_t(i)])];
            mises += shape[i] * s.von_mises[std::size_t(n[std::size_t(i)])];
          }
          s.points.push_back(x);
          s.von_mises.push_back(std::max(0.0, mises));
          if (k == kParts || l == kParts) continue;
          const int c = first + k * (kParts + 1) + l;
          s.cells.push_back({c, c + 1, c + kParts + 2, c + kParts + 1});
        }
      for (const auto& edge :
           {std::array{n[0], n[4], n[1]}, {n[1], n[5], n[2]}, {n[2], n[6], n[3]}, {n[3], n[7], n[0]}})
        if (const auto [it, fresh] = seen.try_emplace(std::minmax(edge[0], edge[2]), meridian.layer[e]);
            !fresh && it->second != meridian.layer[e])
          s.seams.push_back(edge);
    }
  for (const auto& edge : meridian.surface)
    for (int side = 0; side < 2; ++side)
      s.seams.push_back({edge[0] + side * nodes, edge[2] + side * nodes, edge[1] + side * nodes});

  // The face where it cuts the same plane: right of a place up the picture until the surface's equation holds.
  const Mat3 to_face = view.face.axes.transpose();
  double radius = 0;
  for (const auto& x : s.points) radius = std::max(radius, x.norm());
  for (double v = -1.25 * radius; v <= 1.251 * radius; v += 0.05 * radius) {
    double u = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 x = to_face * (middle + u * right + v * up - view.face.centre), along = to_face * right;
      const double miss = x.x() - face.height(x.y(), x.z()) + view.contact.surface_travel(view.state, x);
      u -= miss / (along.x() + along.y() * x.y() / face.bulge + along.z() * x.z() / face.roll);
    }
    if (std::abs(u) < 3 * radius) s.face.emplace_back(u, v);
  }
  return s;
}

std::string svg(const BallSection& s) {
  constexpr double size = 380, left = 24, bar = 14, kShades = 40;
  double radius = 0;
  for (const auto& x : s.points) radius = std::max(radius, x.norm());
  const double scale = 0.5 * size / (1.28 * radius);
  const auto X = [&](const BallSection::Point& p) { return left + 0.5 * size + scale * p.x(); };
  const auto Y = [&](const BallSection::Point& p) { return 0.5 * size - scale * p.y(); };
  const double most = std::ranges::max(s.von_mises);
  std::string out = fmt::format(
      "<svg viewBox='0 0 {} {}' role='img' aria-label='the ball cut open at the largest force, coloured by stress'>",
      left + size + 110, size);
  std::map<int, std::string> painted;  // outlines by shade
  for (const auto& cell : s.cells) {
    double mean = 0;
    for (const int i : cell) mean += 0.25 * s.von_mises[std::size_t(i)];
    std::string& d = painted[int(std::lround(kShades * mean / most))];
    for (const int i : cell) {
      const auto& p = s.points[std::size_t(i)];
      d += fmt::format("{}{:.1f} {:.1f}", i == cell[0] ? "M" : "L", X(p), Y(p));
    }
    d += 'Z';
  }
  for (const auto& [shade, d] : painted)
    out += fmt::format("<path d='{0}' fill='{1}' stroke='{1}' stroke-width='.6'/>", d, colour(double(shade) / kShades));
  std::string seams, face;
  for (const auto& e : s.seams) {
    const auto &a = s.points[std::size_t(e[0])], &m = s.points[std::size_t(e[1])], &b = s.points[std::size_t(e[2])];
    // The quadratic edge, whose middle lies on it.
    const BallSection::Point q = 2 * m - 0.5 * (a + b);
    seams += fmt::format("M{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}", X(a), Y(a), X(q), Y(q), X(b), Y(b));
  }
  for (const auto& p : s.face) face += fmt::format("{:.1f},{:.1f} ", X(p), Y(p));
  out += fmt::format("<path class='mark' d='{}'/><polyline class='face' points='{}'/>", seams, face);
  const double x = left + size + 8, top = 60, height = size - 120;
  for (int i = 0; i < 50; ++i)
    out += fmt::format("<rect x='{}' y='{:.1f}' width='{}' height='{:.1f}' fill='{}'/>", x, top + height * i / 50, bar,
                       height / 50 + 0.5, colour(1 - (i + 0.5) / 50));
  out += fmt::format(
      "<text x='{0}' y='{1}'>{2:.0f}</text><text x='{0}' y='{3}'>0</text><text x='{4}' y='{5}'>von Mises</text><text "
      "x='{4}' y='{6}'>stress [MPa]</text>",
      x + bar + 5, top + 9, 1e-6 * most, top + height, x, top + height + 20, top + height + 35);
  return out + "</svg>";
}

}  // namespace hosel::post
