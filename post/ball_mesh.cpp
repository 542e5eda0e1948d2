#include "post/ball_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "fem/materials/equivalent_stress.hpp"

namespace hosel::post {
namespace {

/// Nodes of the meridian and, behind them, the centre of each element.
struct Swept {
  const fem::HarmonicSolid& ball;
  int nodes, points, angles;
  std::vector<bool> axial;          // one point instead of a ring
  std::vector<std::int64_t> first;  // point number of each meridian point at angle 0

  Swept(const fem::HarmonicSolid& b, int n)
      : ball(b), nodes(int(b.mesh().nodes.size())), points(nodes + int(b.mesh().elements.size())), angles(n) {
    std::int64_t next = 0;
    for (int i = 0; i < points; ++i) {
      axial.push_back(i < nodes && b.mesh().on_axis(i));
      first.push_back(next);
      next += axial.back() ? 1 : n;
    }
  }
  std::int64_t at(int point, int angle) const {
    return first[size_t(point)] + (axial[size_t(point)] ? 0 : angle % angles);
  }
};

}  // namespace

VtkMesh ball_mesh(const fem::HarmonicSolid& ball, const fem::State& state, const SurfaceTraction& traction,
                  int angles) {
  const Swept swept(ball, angles);
  const mesh::Meridian& meridian = ball.mesh();
  std::vector<double> theta;
  for (int i = 0; i < angles; ++i) theta.push_back(2 * M_PI * i / angles);

  const auto displacement = ball.displacement_fields(state), velocity = ball.velocity_fields(state);
  const auto stress = ball.cauchy_at_nodes(state, theta);
  std::unordered_set<int> surface;
  for (const auto& edge : meridian.surface) surface.insert(edge.begin(), edge.end());
  const auto centre = mesh::Q8::at(0, 0).value;

  VtkMesh out;
  std::vector<Vec3> u, v, t;
  VtkField cauchy{"cauchy_stress", "Pa", 6, {}}, mises{"von_mises", "Pa", 1, {}},
      pressure{"contact_pressure", "Pa", 1, {}};
  for (int p = 0; p < swept.points; ++p)
    for (int a = 0; a < (swept.axial[size_t(p)] ? 1 : angles); ++a) {
      Vec3 x = Vec3::Zero(), du = Vec3::Zero(), dv = Vec3::Zero(), force = Vec3::Zero();
      fem::Sym s = fem::Sym::Zero();
      if (p < swept.nodes) {
        x = ball.reference(p, theta[size_t(a)]);
        du = ball.vector_at(displacement, p, theta[size_t(a)]);
        dv = ball.vector_at(velocity, p, theta[size_t(a)]);
        s = stress[size_t(p * angles + a)];
        if (surface.contains(p)) force = traction(p, theta[size_t(a)]);
      } else {
        const auto& element = meridian.elements[size_t(p - swept.nodes)];
        for (int i = 0; i < 8; ++i) {
          x += centre[i] * ball.reference(element[size_t(i)], theta[size_t(a)]);
          du += centre[i] * ball.vector_at(displacement, element[size_t(i)], theta[size_t(a)]);
          dv += centre[i] * ball.vector_at(velocity, element[size_t(i)], theta[size_t(a)]);
          s += centre[i] * stress[size_t(element[size_t(i)] * angles + a)];
        }
      }
      out.points.push_back(x);
      u.push_back(du);
      v.push_back(dv);
      t.push_back(force);
      cauchy.values.insert(cauchy.values.end(), s.data(), s.data() + 6);
      mises.values.push_back(fem::von_mises(s));
      pressure.values.push_back(force.norm());
    }

  VtkField layer{"layer", "", 1, {}};
  for (std::size_t e = 0; e < meridian.elements.size(); ++e) {
    const auto& n = meridian.elements[e];
    const int c = swept.nodes + int(e);
    const std::array<std::array<int, 4>, 4> quads{
        {{n[0], n[4], c, n[7]}, {n[4], n[1], n[5], c}, {c, n[5], n[2], n[6]}, {n[7], c, n[6], n[3]}}};
    for (const auto& quad : quads) {
      std::array<int, 4> q = quad;
      // Turn it so that an edge on the axis comes first: it closes the cell to a wedge.
      int turn = 0;
      while (turn < 4 && !(swept.axial[size_t(q[0])] && swept.axial[size_t(q[1])])) {
        std::rotate(q.begin(), q.begin() + 1, q.end());
        ++turn;
      }
      const bool wedge = turn < 4;
      for (int a = 0; a < angles; ++a) {
        VtkMesh::Cell cell{};
        if (wedge)
          cell = {CellShape::wedge,
                  {swept.at(q[0], 0), swept.at(q[3], a), swept.at(q[3], a + 1), swept.at(q[1], 0), swept.at(q[2], a),
                   swept.at(q[2], a + 1)}};
        else
          cell = {CellShape::hexahedron,
                  {swept.at(q[0], a), swept.at(q[1], a), swept.at(q[2], a), swept.at(q[3], a), swept.at(q[0], a + 1),
                   swept.at(q[1], a + 1), swept.at(q[2], a + 1), swept.at(q[3], a + 1)}};
        out.cells.push_back(cell);
        layer.values.push_back(meridian.layer[e]);
      }
    }
  }
  out.point_fields = {vector_field("displacement", "m", u),
                      vector_field("velocity", "m/s", v),
                      vector_field("contact_traction", "Pa", t),
                      std::move(cauchy),
                      std::move(mises),
                      std::move(pressure)};
  out.cell_fields = {std::move(layer)};
  return out;
}

}  // namespace hosel::post
