#include "mesh/meridian.hpp"

#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "golf/units.hpp"

namespace hosel::mesh {
namespace {

using Point = Eigen::Vector2d;

/// Adds structured blocks of elements; nodes that coincide with earlier ones are shared.
class Builder {
 public:
  Builder(Meridian& mesh, double size) : mesh_(mesh), tolerance_(1e-9 * size) {}

  template <class Map, class Layer>
  void block(int nx, int ny, const Map& map, const Layer& layer) {
    // Half-steps: even-even corners, odd-even and even-odd mid-sides.
    std::vector<int> id(static_cast<std::size_t>((2 * nx + 1) * (2 * ny + 1)), -1);
    const auto at = [&](int i, int j) -> int& { return id[static_cast<std::size_t>(j * (2 * nx + 1) + i)]; };
    for (int j = 0; j <= 2 * ny; ++j)
      for (int i = 0; i <= 2 * nx; ++i)
        if (i % 2 == 0 || j % 2 == 0) at(i, j) = node(map(0.5 * i, 0.5 * j));
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int a = 2 * i, b = 2 * j;
        mesh_.elements.push_back({at(a, b), at(a + 2, b), at(a + 2, b + 2), at(a, b + 2), at(a + 1, b),
                                  at(a + 2, b + 1), at(a + 1, b + 2), at(a, b + 1)});
        mesh_.layer.push_back(layer(i));
      }
  }

  int node(Point p) {
    if (std::abs(p.y()) < tolerance_) p.y() = 0;
    const double cell = 1e3 * tolerance_;
    const std::pair<long, long> key{std::lround(p.x() / cell), std::lround(p.y() / cell)};
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        if (const auto it = known_.find({key.first + dx, key.second + dy});
            it != known_.end() && (mesh_.nodes[static_cast<std::size_t>(it->second)] - p).norm() < tolerance_)
          return it->second;
    mesh_.nodes.push_back(p);
    const int id = static_cast<int>(mesh_.nodes.size()) - 1;
    known_[key] = id;
    return id;
  }

 private:
  Meridian& mesh_;
  double tolerance_;
  std::map<std::pair<long, long>, int> known_;
};

/// Ring boundaries from `start` to the surface, geometric, then moved so that every interface is met;
/// an interface far from all of them gets a boundary of its own.
std::vector<double> ring_radii(double start, const std::vector<double>& interfaces, const MeridianOptions& o) {
  const double R = interfaces.back();
  const double ratio = o.rings > 1 ? std::pow(o.skin, 1.0 / (o.rings - 1)) : 1.0;
  double sum = 0, h = 1;
  for (int i = 0; i < o.rings; ++i, h *= ratio) sum += h;
  std::vector<double> radii;
  double r = start;
  h = (R - start) / sum;
  for (int i = 0; i < o.rings; ++i, h *= ratio) radii.push_back(r += h);
  radii.back() = R;
  for (std::size_t l = 0; l + 1 < interfaces.size(); ++l) {
    const double x = interfaces[l];
    std::size_t best = radii.size();
    for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
      const bool taken = l > 0 && radii[i] <= interfaces[l - 1];
      if (!taken && (best == radii.size() || std::abs(radii[i] - x) < std::abs(radii[best] - x))) best = i;
    }
    if (best < radii.size() && std::abs(radii[best] - x) < R / (4.0 * o.rings)) {
      radii[best] = x;
    } else {
      std::size_t i = 0;
      while (radii[i] < x) ++i;
      radii.insert(radii.begin() + static_cast<std::ptrdiff_t>(i), x);
    }
  }
  return radii;
}

}  // namespace

std::vector<std::string> MeridianOptions::faults() const {
  std::vector<std::string> out;
  if (sector < 1) out.push_back("mesh: sector must be at least 1");
  if (rings < 1) out.push_back("mesh: rings must be at least 1");
  if (!(pole > 0 && pole <= 1)) out.push_back("mesh: pole must lie in (0, 1]");
  if (far && !(*far >= 1 && std::isfinite(*far))) out.push_back("mesh: far must be at least 1 and finite");
  if (both_poles && !far) out.push_back("mesh: both_poles needs far, the size at the equator");
  if (far && pole == 1 && *far != 1) out.push_back("mesh: far is 1 where pole is");
  // The growth's exponent, (far - 1) / (1 - pole), is below 1 there: elements next to the pole are no finer for it.
  if (far && pole > 0 && pole < 1 && *far < 2 - pole) out.push_back("mesh: far must be at least 2 - pole");
  if (!(skin > 0 && skin <= 1)) out.push_back("mesh: skin must lie in (0, 1]");
  if (!(core > 0.05 && core < 0.8)) out.push_back("mesh: core must lie in (0.05, 0.8)");
  return out;
}

Meridian sphere_meridian(const std::vector<double>& interfaces, const MeridianOptions& options) {
  if (const auto faults = options.faults(); !faults.empty()) throw std::invalid_argument(faults.front());
  if (interfaces.empty() || !(interfaces.front() > 0))
    throw std::invalid_argument("mesh: a ball needs at least one layer of positive radius");
  for (std::size_t i = 1; i < interfaces.size(); ++i)
    if (!(interfaces[i] > interfaces[i - 1])) throw std::invalid_argument("mesh: layer radii must increase");

  Meridian mesh;
  mesh.radius = interfaces.back();
  mesh.layers = static_cast<int>(interfaces.size());
  const double R = mesh.radius;
  const double c = options.core * interfaces.front();
  const std::vector<double> radii = ring_radii(1.15 * c, interfaces, options);

  // Angular grading grows with the radius, so that the centre stays undistorted: tan(phi'/2) =
  // kappa(r) tan(phi/2) crowds the elements about the pole by the factor kappa; with `far`,
  // phi' = phi (kappa + (1 - kappa) (phi/pi)^q), whose slope is kappa at the one pole and far at the other.
  const auto graded = [&](const Point& p) {
    const double r = p.norm();
    if (r == 0 || p.y() == 0) return p;
    const double kappa = 1 + (options.pole - 1) * (r / R) * (r / R);
    const double angle = std::atan2(p.y(), p.x());
    const auto power = [&](double from_pole, double end) {
      return from_pole * (kappa + (1 - kappa) * std::pow(from_pole / end, (*options.far - 1) / (1 - options.pole)));
    };
    double phi = 0;
    if (!options.far || kappa == 1) phi = 2 * std::atan(kappa * std::tan(angle / 2));
    else if (!options.both_poles) phi = power(angle, kPi);
    else phi = angle <= kPi / 2 ? power(angle, kPi / 2) : kPi - power(kPi - angle, kPi / 2);
    return Point(r * std::cos(phi), r * std::sin(phi));
  };
  // The core block lies between a square and a disc, corners at 45 degrees.
  const auto core = [&](double x, double y) {
    const Point disc(x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2));
    return Point(c * (0.425 * Point(x, y) + 0.5 * disc));
  };
  const int n = options.sector;
  Builder builder(mesh, R);
  builder.block(
      2 * n, n, [&](double i, double j) { return graded(core(i / n - 1, j / n)); }, [](int) { return 0; });

  // Rings; t runs from the contact pole (0) over the block's corners (1, 3) to the other pole (4).
  const auto rim = [&](double t) {
    if (t <= 1) return core(1, t);
    if (t <= 3) return core(2 - t, 1);
    return core(-1, 4 - t);
  };
  const auto radius_at = [&](double i) {
    const auto k = static_cast<std::size_t>(i);
    const double f = i - std::floor(i);
    return f == 0 ? radii[k - 1] : (1 - f) * radii[k - 1] + f * radii[k];
  };
  const auto ring = [&](double i, double t) {
    const double phi = kPi * t / 4;
    const Point direction(std::cos(phi), t >= 4 ? 0.0 : std::sin(phi));
    if (i < 1) return graded((1 - i) * rim(t) + i * radii.front() * direction);
    return graded(radius_at(i) * direction);
  };
  const int all = static_cast<int>(radii.size());
  builder.block(
      all, 4 * n, [&](double i, double j) { return ring(i, j / n); },
      [&](int i) {
        int l = 0;
        while (radii[static_cast<std::size_t>(i)] > interfaces[static_cast<std::size_t>(l)] * (1 + 1e-12)) ++l;
        return l;
      });
  for (int j = 0; j < 4 * n; ++j)
    mesh.surface.push_back({builder.node(ring(all, static_cast<double>(j) / n)),
                            builder.node(ring(all, static_cast<double>(j + 1) / n)),
                            builder.node(ring(all, (j + 0.5) / n))});
  return mesh;
}

Meridian shell_meridian(double inner, double outer, int polar, int radial) {
  if (!(inner > 0 && outer > inner) || polar < 1 || radial < 1)
    throw std::invalid_argument("mesh: a shell needs 0 < inner < outer and at least one element each way");
  Meridian mesh;
  mesh.radius = outer;
  Builder builder(mesh, outer);
  const auto map = [&](double i, double j) {
    const double r = inner + (outer - inner) * i / radial, phi = kPi * j / polar;
    return Point(r * std::cos(phi), j >= polar ? 0.0 : r * std::sin(phi));
  };
  builder.block(radial, polar, map, [](int) { return 0; });
  for (int j = 0; j < polar; ++j)
    mesh.surface.push_back(
        {builder.node(map(radial, j)), builder.node(map(radial, j + 1)), builder.node(map(radial, j + 0.5))});
  return mesh;
}

Q8 Q8::at(double x, double y) {
  constexpr double cx[4] = {-1, 1, 1, -1}, cy[4] = {-1, -1, 1, 1};
  Q8 q;
  for (int i = 0; i < 4; ++i) {
    const double a = 1 + x * cx[i], b = 1 + y * cy[i];
    q.value[i] = 0.25 * a * b * (x * cx[i] + y * cy[i] - 1);
    q.derivative(i, 0) = 0.25 * cx[i] * b * (2 * x * cx[i] + y * cy[i]);
    q.derivative(i, 1) = 0.25 * cy[i] * a * (x * cx[i] + 2 * y * cy[i]);
  }
  const auto along_x = [&](int i, double sy) {
    q.value[i] = 0.5 * (1 - x * x) * (1 + sy * y);
    q.derivative(i, 0) = -x * (1 + sy * y);
    q.derivative(i, 1) = 0.5 * sy * (1 - x * x);
  };
  const auto along_y = [&](int i, double sx) {
    q.value[i] = 0.5 * (1 - y * y) * (1 + sx * x);
    q.derivative(i, 0) = 0.5 * sx * (1 - y * y);
    q.derivative(i, 1) = -y * (1 + sx * x);
  };
  along_x(4, -1);
  along_y(5, 1);
  along_x(6, 1);
  along_y(7, -1);
  return q;
}

}  // namespace hosel::mesh
