#include "mesh/plate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "golf/units.hpp"
#include "mesh/gauss.hpp"

namespace hosel::mesh {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool ascending(const std::vector<double>& x) {
  return std::ranges::adjacent_find(x, [](double a, double b) { return !(a < b); }) == x.end();
}

bool thick(double t) { return t > 0 && std::isfinite(t); }

}  // namespace

std::vector<std::string> PlateOutline::faults() const {
  std::vector<std::string> out;
  if (form != Form::polygon) {
    if (!(half_width > 0 && half_height > 0)) out.emplace_back("the outline's half-extents must be positive");
    if (form == Form::superellipse && !(exponent >= 1.5 && exponent <= 20))
      out.emplace_back("the outline's exponent must lie between 1.5 and 20");
    return out;
  }
  if (corners.size() < 3) return {"an outline needs three corners"};
  if (const auto i = turned_back()) {
    std::ostringstream text;
    text << "the outline turns back after corner " << *i + 1 << ": every ray from the face's centre must meet it once";
    return {text.str()};
  }
  double turn = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    turn += std::atan2(cross(a, b), a.dot(b));
  }
  if (std::abs(std::abs(turn) - 2 * kPi) > 1e-6) out.emplace_back("the outline must go round the face's centre once");
  return out;
}

std::optional<std::size_t> PlateOutline::turned_back() const {
  int sense = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double c = cross(a, b), small = 1e-9 * a.norm() * b.norm();
    const int side = c > small ? 1 : c < -small ? -1 : 0;
    if (side == 0 || (sense != 0 && side != sense)) return i;
    sense = side;
  }
  return {};
}

Vector2d PlateOutline::extent() const {
  if (form != Form::polygon) return {half_width, half_height};
  Vector2d out = Vector2d::Zero();
  for (const Vector2d& c : corners) out = out.cwiseMax(c.cwiseAbs());
  return out;
}

double PlateOutline::reach(const Vector2d& d) const {
  const double y = std::abs(d.x()), z = std::abs(d.y());
  if (form == Form::rectangle) return 1 / std::max(y / half_width, z / half_height);
  if (form == Form::superellipse)
    return std::pow(std::pow(y / half_width, exponent) + std::pow(z / half_height, exponent), -1 / exponent);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], side = corners[(i + 1) % corners.size()] - a;
    const double ahead = cross(d, side);
    if (ahead == 0) continue;
    const double along = cross(a, d) / ahead, out = cross(a, side) / ahead;  // a + along side = out d
    if (out > 0 && along >= -1e-12 && along <= 1 + 1e-12) return out;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> PlateThickness::faults() const {
  std::vector<std::string> out;
  const auto all_thick = [&](const std::vector<double>& t) {
    if (!std::ranges::all_of(t, thick)) out.emplace_back("a thickness must be positive");
  };
  if (const auto* c = std::get_if<Constant>(&map)) all_thick({c->value});
  if (const auto* b = std::get_if<Bulge>(&map)) {
    all_thick({b->centre, b->rim});
    if (!(b->half_width > 0 && b->half_height > 0)) out.emplace_back("the bulge's half-extents must be positive");
  }
  if (const auto* r = std::get_if<Rings>(&map)) {
    all_thick(r->value);
    if (r->share.empty() || r->share.size() != r->value.size())
      out.emplace_back("rings need as many thicknesses as stations");
    else if (!ascending(r->share) || r->share.front() < 0 || r->share.back() > 1)
      out.emplace_back("the stations of rings must ascend from 0 at the centre to 1 at the rim");
  }
  if (const auto* g = std::get_if<Grid>(&map)) {
    all_thick(g->value);
    if (g->y.size() < 2 || g->z.size() < 2 || g->value.size() != g->y.size() * g->z.size())
      out.emplace_back("a thickness grid needs two lines each way and a value at every crossing");
    else if (!ascending(g->y) || !ascending(g->z)) out.emplace_back("the lines of a thickness grid must ascend");
  }
  return out;
}

double PlateThickness::at(const Vector2d& p, double share) const {
  if (const auto* c = std::get_if<Constant>(&map)) return c->value;
  if (const auto* b = std::get_if<Bulge>(&map)) {
    const double u = p.x() / b->half_width, v = p.y() / b->half_height, inside = std::max(0.0, 1 - u * u - v * v);
    return b->rim + (b->centre - b->rim) * inside * inside;
  }
  if (const auto* r = std::get_if<Rings>(&map)) {
    const auto next = std::ranges::upper_bound(r->share, share);
    if (next == r->share.begin()) return r->value.front();
    if (next == r->share.end()) return r->value.back();
    const auto i = static_cast<std::size_t>(next - r->share.begin());
    const double s = (share - r->share[i - 1]) / (r->share[i] - r->share[i - 1]);
    return (1 - s) * r->value[i - 1] + s * r->value[i];
  }
  const Grid& g = std::get<Grid>(map);
  const auto cell = [](const std::vector<double>& x, double at) {
    const double slack = 1e-9 * (x.back() - x.front());
    if (!(at >= x.front() - slack && at <= x.back() + slack)) {
      std::ostringstream text;
      text << "the thickness grid does not cover the face: it ends at " << 1e3 * (at < x.front() ? x.front() : x.back())
           << " mm, the face reaches " << 1e3 * at << " mm";
      throw std::invalid_argument(text.str());
    }
    const auto i = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(x, at) - x.begin(), 1,
                                              static_cast<std::ptrdiff_t>(x.size()) - 1);
    const auto k = static_cast<std::size_t>(i);
    return std::pair(k - 1, (at - x[k - 1]) / (x[k] - x[k - 1]));
  };
  const auto [i, u] = cell(g.y, p.x());
  const auto [j, v] = cell(g.z, p.y());
  const std::size_t n = g.y.size();
  const auto value = [&](std::size_t a, std::size_t b) { return g.value[b * n + a]; };
  return (1 - v) * ((1 - u) * value(i, j) + u * value(i + 1, j)) +
         v * ((1 - u) * value(i, j + 1) + u * value(i + 1, j + 1));
}

PlateThickness PlateThickness::scaled(double factor) const {
  PlateThickness out = *this;
  if (auto* c = std::get_if<Constant>(&out.map)) c->value *= factor;
  if (auto* b = std::get_if<Bulge>(&out.map)) b->centre *= factor, b->rim *= factor;
  if (auto* r = std::get_if<Rings>(&out.map))
    for (double& t : r->value) t *= factor;
  if (auto* g = std::get_if<Grid>(&out.map))
    for (double& t : g->value) t *= factor;
  return out;
}

std::vector<std::string> PlateMeshOptions::faults() const {
  std::vector<std::string> out;
  if (core < 1 || core > 200) out.emplace_back("core must lie between 1 and 200 elements");
  if (rings < 1 || rings > 200) out.emplace_back("rings must lie between 1 and 200 elements");
  return out;
}

Q9 Q9::at(double xi, double eta) {
  const auto line = [](double x) { return std::array{0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)}; };
  const auto slope = [](double x) { return std::array{x - 0.5, -2 * x, x + 0.5}; };
  const auto a = line(xi), b = line(eta), da = slope(xi), db = slope(eta);
  Q9 out;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(3 * j + i);
      out.value[k] = a[i] * b[j];
      out.derivative(k, 0) = da[i] * b[j];
      out.derivative(k, 1) = a[i] * db[j];
    }
  return out;
}

namespace {

Eigen::Matrix2d jacobian(const PlateMesh& m, const std::array<int, 9>& element, const Q9& at) {
  Eigen::Matrix2d j = Eigen::Matrix2d::Zero();  // rows: y, z; columns: xi, eta
  for (std::size_t k = 0; k < 9; ++k)
    j += m.nodes[static_cast<std::size_t>(element[k])] * at.derivative.row(static_cast<Eigen::Index>(k));
  return j;
}

void finish(PlateMesh& m) {
  m.on_rim.assign(m.nodes.size(), 0);
  for (const auto& edge : m.rim)
    for (int n : edge) m.on_rim[static_cast<std::size_t>(n)] = 1;
  for (const auto& e : m.elements)
    for (double xi : {-1.0, 0.0, 1.0})
      for (double eta : {-1.0, 0.0, 1.0})
        if (!(jacobian(m, e, Q9::at(xi, eta)).determinant() > 0))
          throw std::invalid_argument("the outline makes elements that fold: fewer sharp corners, or a finer mesh");
}

}  // namespace

double PlateMesh::area() const {
  const auto rule = gauss(3);
  double sum = 0;
  for (const auto& e : elements)
    for (const auto& [x, wx] : rule)
      for (const auto& [y, wy] : rule) sum += wx * wy * jacobian(*this, e, Q9::at(x, y)).determinant();
  return sum;
}

PlateMesh rectangle_mesh(double half_width, double half_height, int across, int up) {
  PlateMesh m;
  const int columns = 2 * across + 1;
  for (int j = 0; j <= 2 * up; ++j)
    for (int i = 0; i < columns; ++i)
      m.nodes.emplace_back(half_width * (i / double(across) - 1), half_height * (j / double(up) - 1));
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < across; ++i) {
      std::array<int, 9> e{};
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) e[static_cast<std::size_t>(3 * b + a)] = (2 * j + b) * columns + 2 * i + a;
      m.elements.push_back(e);
      if (j == 0) m.rim.push_back({e[0], e[1], e[2]});
      if (j + 1 == up) m.rim.push_back({e[6], e[7], e[8]});
      if (i == 0) m.rim.push_back({e[0], e[3], e[6]});
      if (i + 1 == across) m.rim.push_back({e[2], e[5], e[8]});
    }
  finish(m);
  return m;
}

PlateMesh plate_mesh(const PlateOutline& outline, const PlateMeshOptions& options) {
  for (const auto& faults : {outline.faults(), options.faults()})
    if (!faults.empty()) throw std::invalid_argument(faults.front());
  if (outline.form == PlateOutline::Form::rectangle) {
    const int across = std::max(1, int(std::lround(options.core * outline.half_width / outline.half_height)));
    return rectangle_mesh(outline.half_width, outline.half_height, across, options.core);
  }
  // An O-grid in the plane where the outline's extents are one: nodes of the rim at equal angles, sharp corners of a
  // polygon taken by the nearest one.
  const int n = options.core, around = 8 * n, layers = 2 * options.rings;
  const Vector2d extent = outline.extent();
  std::vector<double> angle(static_cast<std::size_t>(around));
  for (int k = 0; k < around; ++k) angle[static_cast<std::size_t>(k)] = -kPi / 4 + 2 * kPi * k / around;
  if (outline.form == PlateOutline::Form::polygon) {
    constexpr double kSharp = 20 * kPi / 180;
    const std::size_t corners = outline.corners.size();
    const double step = 4 * kPi / around;
    std::vector<char> taken(static_cast<std::size_t>(around), 0);
    for (std::size_t i = 0; i < corners; ++i) {
      const Vector2d &at = outline.corners[i], before = at - outline.corners[(i + corners - 1) % corners],
                     after = outline.corners[(i + 1) % corners] - at;
      if (std::abs(std::atan2(cross(before, after), before.dot(after))) < kSharp) continue;
      const double phi = std::atan2(at.y() / extent.y(), at.x() / extent.x());
      double turns = std::fmod(phi + kPi / 4 + 4 * kPi, 2 * kPi) / step;
      const auto vertex = static_cast<std::size_t>(std::lround(turns)) % static_cast<std::size_t>(4 * n);
      if (taken[2 * vertex]) continue;
      taken[2 * vertex] = 1;
      double& own = angle[2 * vertex];
      own += std::remainder(phi - own, 2 * kPi);
    }
    for (int k = 1; k < around; k += 2) {
      const double last = angle[static_cast<std::size_t>(k - 1)],
                   next = angle[static_cast<std::size_t>((k + 1) % around)];
      angle[static_cast<std::size_t>(k)] = last + 0.5 * std::remainder(next - last, 2 * kPi);
    }
  }
  const auto direction = [&](int k) {
    const double a = angle[static_cast<std::size_t>(k % around)];
    return Vector2d(extent.x() * std::cos(a), extent.y() * std::sin(a));
  };
  const auto rim = [&](int k) -> Vector2d { return outline.reach(direction(k)) * direction(k); };
  const auto core = [&](int k) -> Vector2d {
    constexpr double kSize = 0.6, kSquare = 0.6;  // of the rim's distance; how square it is
    const double a = -kPi / 4 + 2 * kPi * (k % around) / around;
    const double square = std::sqrt(0.5) / std::max(std::abs(std::cos(a)), std::abs(std::sin(a)));
    return kSize * ((1 - kSquare) + kSquare * square) * rim(k);
  };
  PlateMesh m;
  const int columns = 2 * n + 1;
  const auto on_core = [&](int k) {  // number of the core's node at a place of its edge
    k %= around;
    const int side = k / (2 * n), t = k % (2 * n);
    const int i = side == 0 ? 2 * n : side == 1 ? 2 * n - t : side == 2 ? 0 : t;
    const int j = side == 0 ? t : side == 1 ? 2 * n : side == 2 ? 2 * n - t : 0;
    return j * columns + i;
  };
  const Vector2d corner[4] = {core(6 * n), core(0), core(2 * n), core(4 * n)};  // (0,0), (1,0), (1,1), (0,1)
  for (int j = 0; j <= 2 * n; ++j)
    for (int i = 0; i <= 2 * n; ++i) {
      const double u = i / (2.0 * n), v = j / (2.0 * n);
      const Vector2d right = core(j), left = core(4 * n + 2 * n - j), top = core(2 * n + 2 * n - i),
                     bottom = core(6 * n + i);
      m.nodes.push_back(
          (1 - u) * left + u * right + (1 - v) * bottom + v * top -
          ((1 - u) * (1 - v) * corner[0] + u * (1 - v) * corner[1] + u * v * corner[2] + (1 - u) * v * corner[3]));
    }
  const int block = columns * columns;
  for (int l = 1; l <= layers; ++l)
    for (int k = 0; k < around; ++k) {
      const double s = l / double(layers);
      m.nodes.push_back((1 - s) * core(k) + s * rim(k));
    }
  const auto number = [&](int l, int k) { return l == 0 ? on_core(k) : block + (l - 1) * around + k % around; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      std::array<int, 9> e{};
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) e[static_cast<std::size_t>(3 * b + a)] = (2 * j + b) * columns + 2 * i + a;
      m.elements.push_back(e);
    }
  for (int l = 0; l < options.rings; ++l)
    for (int k = 0; k < around; k += 2) {
      std::array<int, 9> e{};
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) e[static_cast<std::size_t>(3 * b + a)] = number(2 * l + a, k + b);
      m.elements.push_back(e);
      if (l + 1 == options.rings) m.rim.push_back({e[2], e[5], e[8]});
    }
  finish(m);
  return m;
}

PlatePlace locate(const PlateMesh& m, const Vector2d& place) {
  constexpr double kSlack = 1e-6;
  for (std::size_t i = 0; i < m.elements.size(); ++i) {
    const auto& e = m.elements[i];
    Vector2d low = m.nodes[static_cast<std::size_t>(e[0])], high = low;
    for (int n : e) {
      low = low.cwiseMin(m.nodes[static_cast<std::size_t>(n)]);
      high = high.cwiseMax(m.nodes[static_cast<std::size_t>(n)]);
    }
    const double room = 0.05 * (high - low).norm();
    if ((place - low).minCoeff() < -room || (high - place).minCoeff() < -room) continue;
    Vector2d at = Vector2d::Zero();
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Q9 q = Q9::at(at.x(), at.y());
      Vector2d off = place;
      for (std::size_t k = 0; k < 9; ++k)
        off -= q.value[static_cast<Eigen::Index>(k)] * m.nodes[static_cast<std::size_t>(e[k])];
      const Vector2d step = jacobian(m, e, q).inverse() * off;
      at += step;
      if (!(at.cwiseAbs().maxCoeff() < 3) || step.norm() < 1e-12) break;
    }
    if (at.cwiseAbs().maxCoeff() <= 1 + kSlack)
      return {static_cast<int>(i), std::clamp(at.x(), -1.0, 1.0), std::clamp(at.y(), -1.0, 1.0)};
  }
  return {};
}

}  // namespace hosel::mesh
