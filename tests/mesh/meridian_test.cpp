#include "mesh/meridian.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>

#include "mesh/gauss.hpp"

namespace hosel::mesh {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Matrix<double, 8, 2> corners(const Meridian& m, std::size_t element) {
  Eigen::Matrix<double, 8, 2> x;
  for (int i = 0; i < 8; ++i) x.row(i) = m.nodes[std::size_t(m.elements[element][std::size_t(i)])];
  return x;
}

double jacobian(const Eigen::Matrix<double, 8, 2>& x, double xi, double eta) {
  return (Q8::at(xi, eta).derivative.transpose() * x).determinant();
}

/// Volume of the body of revolution by layers.
std::map<int, double> volumes(const Meridian& m) {
  std::map<int, double> sum;
  for (std::size_t e = 0; e < m.elements.size(); ++e) {
    const auto x = corners(m, e);
    for (const auto& [xi, wx] : gauss(5))
      for (const auto& [eta, we] : gauss(5))
        sum[m.layer[e]] += 2 * kPi * wx * we * jacobian(x, xi, eta) * x.col(1).dot(Q8::at(xi, eta).value);
  }
  return sum;
}

double total(const Meridian& m) {
  double sum = 0;
  for (const auto& [layer, v] : volumes(m)) sum += v;
  return sum;
}

double sphere(double r) { return 4 * kPi / 3 * r * r * r; }

TEST(Q8, IsOneAtItsNodeAndReproducesWhatASerendipitySquareDoes) {
  constexpr double at[8][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) EXPECT_EQ(Q8::at(at[j][0], at[j][1]).value[i], i == j);
  // 1, x, y, x^2, x y, y^2, x^2 y, x y^2, values and slopes, at places that are no nodes.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr int powers[8][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {2, 1}, {1, 2}};
  for (int k = 0; k < 20; ++k) {
    const double x = unit(random), y = unit(random);
    const Q8 q = Q8::at(x, y);
    for (const auto& [a, b] : powers) {
      Eigen::Matrix<double, 8, 1> f;
      for (int i = 0; i < 8; ++i) f[i] = std::pow(at[i][0], a) * std::pow(at[i][1], b);
      EXPECT_NEAR(q.value.dot(f), std::pow(x, a) * std::pow(y, b), 1e-14);
      EXPECT_NEAR(q.derivative.col(0).dot(f), a ? a * std::pow(x, a - 1) * std::pow(y, b) : 0, 1e-14);
      EXPECT_NEAR(q.derivative.col(1).dot(f), b ? b * std::pow(x, a) * std::pow(y, b - 1) : 0, 1e-14);
    }
  }
}

/// A surface of parabolas through three points of a circle lies off it by less than the fourth power of half an edge's
/// angle, relative to the radius; the volume's error halves four times where the edges halve.
TEST(Meridian, FillsTheSphereTheMoreTheFinerItIs) {
  double before = 0;
  for (const int sector : {2, 4, 8}) {
    const double error = std::abs(total(sphere_meridian({0.02}, {.sector = sector, .pole = 1})) / sphere(0.02) - 1);
    EXPECT_LT(error, std::pow(kPi / (8 * sector), 4));
    EXPECT_GT(error, 1e-12) << "it is a mesh";
    if (before > 0) {
      EXPECT_GT(before / error, 14);
      EXPECT_LT(before / error, 18);
    }
    before = error;
  }
  const double shell = total(shell_meridian(0.01, 0.02, 16, 2));
  EXPECT_NEAR(shell / (sphere(0.02) - sphere(0.01)), 1, std::pow(kPi / 32, 4));
}

TEST(Meridian, LayersHaveTheirVolumes) {
  const std::vector<double> radii = {0.012, 0.019, 0.0205, 0.02135};
  const Meridian m = sphere_meridian(radii, {.sector = 8, .rings = 6, .pole = 0.6, .far = 2.0});
  EXPECT_EQ(m.layers, 4);
  EXPECT_EQ(m.radius, radii.back());
  const auto v = volumes(m);
  ASSERT_EQ(v.size(), radii.size());
  double inside = 0;
  for (std::size_t l = 0; l < radii.size(); ++l) {
    const double whole = sphere(radii[l]);
    // Both of its surfaces are off by the largest edge's share of their sphere: twice as large at the far pole.
    EXPECT_NEAR(v.at(int(l)), whole - inside, 2 * std::pow(kPi / 32, 4) * whole) << "layer " << l;
    inside = whole;
  }
}

/// Whatever the options that are allowed: no element inside out, one closed half-disc whose edges are shared by two.
TEST(Meridian, AnyAllowedMeshIsOne) {
  std::mt19937_64 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 60; ++k) {
    MeridianOptions o{.sector = 1 + int(random() % 8),
                      .rings = 1 + int(random() % 6),
                      .pole = between(0.2, 1),
                      .skin = between(0.2, 1),
                      .core = between(0.2, 0.6)};
    if (k % 3) o.far = between(2 - o.pole, 3);
    o.both_poles = k % 3 == 2;
    std::vector<double> radii = {0.0213};
    if (k % 2) radii.insert(radii.begin(), between(0.012, 0.02));
    ASSERT_TRUE(o.faults().empty()) << o.faults().front();
    const Meridian m = sphere_meridian(radii, o);
    const auto said = [&] {
      return testing::Message() << "sector " << o.sector << " rings " << o.rings << " pole " << o.pole << " far "
                                << o.far.value_or(0) << " skin " << o.skin << " core " << o.core;
    };
    std::map<std::pair<int, int>, int> edges;
    std::set<int> used;
    for (std::size_t e = 0; e < m.elements.size(); ++e) {
      const auto x = corners(m, e);
      for (const auto& [xi, wx] : gauss(5))
        for (const auto& [eta, we] : gauss(5)) ASSERT_GT(jacobian(x, xi, eta), 0) << said();
      const auto& n = m.elements[e];
      for (std::size_t i = 0; i < 4; ++i) ++edges[std::minmax(n[i], n[(i + 1) % 4])];
      used.insert(n.begin(), n.end());
    }
    EXPECT_EQ(used.size(), m.nodes.size()) << said();
    // Sides that one element has alone are the axis and the surface.
    std::size_t alone = 0;
    for (const auto& [edge, count] : edges) {
      ASSERT_LE(count, 2) << said();
      if (count == 1 && !(m.on_axis(edge.first) && m.on_axis(edge.second))) ++alone;
    }
    EXPECT_EQ(alone, m.surface.size()) << said();
    ASSERT_EQ(m.surface.size(), std::size_t(4 * o.sector));
    for (std::size_t i = 0; i < m.surface.size(); ++i) {
      for (const int node : m.surface[i])
        EXPECT_NEAR(m.nodes[std::size_t(node)].norm(), m.radius, 1e-12 * m.radius) << said();
      if (i > 0) { EXPECT_EQ(m.surface[i][0], m.surface[i - 1][1]); }
    }
    EXPECT_EQ(m.nodes[std::size_t(m.surface.front()[0])], Eigen::Vector2d(m.radius, 0));
    EXPECT_EQ(m.nodes[std::size_t(m.surface.back()[1])], Eigen::Vector2d(-m.radius, 0));
    for (const auto& node : m.nodes) EXPECT_GE(node.y(), 0);
  }
}

TEST(Meridian, ThePoleIsAsFineAsAsked) {
  const auto first_edge = [](const MeridianOptions& o) {
    const Meridian m = sphere_meridian({1}, o);
    const Eigen::Vector2d& end = m.nodes[std::size_t(m.surface.front()[1])];
    return std::atan2(end.y(), end.x());
  };
  const double even = first_edge({.sector = 8, .pole = 1});
  EXPECT_NEAR(even, kPi / 32, 1e-12);
  // The mapping's slope at the pole; half an edge away it has changed by the edge's share of the quarter circle.
  EXPECT_NEAR(first_edge({.sector = 8, .pole = 0.5}) / even, 0.5, 0.01);
  EXPECT_NEAR(first_edge({.sector = 8, .pole = 0.25, .far = 2.0}) / even, 0.25, 0.04);
  // The least that is allowed: sizes grow linearly with the angle, in the first edge by 0.75 / 32.
  EXPECT_NEAR(first_edge({.sector = 8, .pole = 0.25, .far = 1.75}) / even, 0.25, 0.04);
}

TEST(Meridian, WhatMakesNoMeshIsRefused) {
  const MeridianOptions good;
  EXPECT_THROW(sphere_meridian({}, good), std::invalid_argument);
  EXPECT_THROW(sphere_meridian({-1}, good), std::invalid_argument);
  EXPECT_THROW(sphere_meridian({0.02, 0.01}, good), std::invalid_argument);
  for (const MeridianOptions& o : {MeridianOptions{.sector = 0},
                                   {.rings = 0},
                                   {.pole = 0},
                                   {.pole = 1.5},
                                   {.far = 0.5},
                                   {.far = NAN},
                                   {.pole = 0.5, .far = 1.0},
                                   {.pole = 0.5, .far = 1.49},
                                   {.both_poles = true},
                                   {.pole = 1, .far = 2.0},
                                   {.skin = 0},
                                   {.core = 0.9}})
    EXPECT_THROW(sphere_meridian({0.02}, o), std::invalid_argument);
  EXPECT_THROW(shell_meridian(0.02, 0.01, 4, 1), std::invalid_argument);
}

}  // namespace
}  // namespace hosel::mesh
