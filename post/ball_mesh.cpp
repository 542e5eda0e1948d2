#include "post/ball_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_set>

#include "fem/materials/equivalent_stress.hpp"
#include "golf/units.hpp"

namespace hosel::post {

RevolvedPoints::RevolvedPoints(const mesh::Meridian& meridian, int angles) : angles_(angles) {
  for (int i = 0; i < int(meridian.nodes.size()); ++i) {
    axial_.push_back(meridian.on_axis(i));
    first_.push_back(count_);
    count_ += axial_.back() ? 1 : angles;
  }
}

VtkMesh ball_mesh(const fem::HarmonicSolid& ball, const fem::State& state, const fem::TractionField& acting,
                  int angles) {
  if (angles < 4 || angles % 2 != 0) throw std::invalid_argument("ball mesh: an even number of angles, four at least");
  const mesh::Meridian& meridian = ball.mesh();
  const RevolvedPoints numbers(meridian, angles);
  const int nodes = int(meridian.nodes.size());
  std::vector<double> theta;
  std::vector<Eigen::Matrix3Xd> functions;
  for (int i = 0; i < angles; ++i) {
    theta.push_back(2 * kPi * i / angles);
    functions.push_back(ball.functions_at(theta.back()));
  }

  const auto displacement = ball.displacement_fields(state), velocity = ball.velocity_fields(state);
  const auto vector_at = [&](const Eigen::MatrixXd& fields, int node, int angle) -> Vec3 {
    return functions[size_t(angle)] * fields.row(node).transpose();
  };
  const auto stress = ball.cauchy_at_nodes(state, theta);
  std::unordered_set<int> surface;
  for (const auto& edge : meridian.surface) surface.insert(edge.begin(), edge.end());

  VtkMesh out;
  std::vector<Vec3> u, v, t;
  VtkField cauchy{"cauchy_stress", "Pa", 6, {}}, mises{"von_mises", "Pa", 1, {}},
      pressure{"contact_pressure", "Pa", 1, {}};
  const auto add = [&](const Vec3& x, const Vec3& du, const Vec3& dv, const fem::Sym& s,
                       const fem::TractionField::Value& on) {
    out.points.push_back(x);
    u.push_back(du);
    v.push_back(dv);
    t.push_back(on.traction);
    cauchy.values.insert(cauchy.values.end(), s.data(), s.data() + 6);
    mises.values.push_back(fem::von_mises(s));
    pressure.values.push_back(on.pressure);
  };
  for (int p = 0; p < nodes; ++p)
    for (int a = 0; a < (numbers.axial(p) ? 1 : angles); ++a)
      add(ball.reference(p, theta[size_t(a)]), vector_at(displacement, p, a), vector_at(velocity, p, a),
          stress[size_t(p * angles + a)],
          surface.contains(p) ? acting.at(ball.reference(p, theta[size_t(a)])) : fem::TractionField::Value{});

  VtkField layer{"layer", "", 1, {}}, around{"angle", "rad", 1, {}};
  const auto centre = mesh::Q8::at(0, 0).value;
  for (std::size_t e = 0; e < meridian.elements.size(); ++e) {
    // Turned so that a side on the axis comes first: it closes the cells to wedges.
    std::array<int, 8> n = meridian.elements[e];
    int turn = 0;
    for (; turn < 4 && !(numbers.axial(n[0]) && numbers.axial(n[1])); ++turn) {
      std::rotate(n.begin(), n.begin() + 1, n.begin() + 4);
      std::rotate(n.begin() + 4, n.begin() + 5, n.end());
    }
    const bool wedge = turn < 4;
    const auto middle = std::int64_t(out.points.size());  // of the element at every second angle: a wedge's alone
    for (int a = 0; wedge && a < angles; a += 2) {
      Vec3 x = Vec3::Zero(), du = Vec3::Zero(), dv = Vec3::Zero();
      fem::Sym s = fem::Sym::Zero();
      for (std::size_t i = 0; i < 8; ++i) {
        const int node = meridian.elements[e][i];
        const double share = centre[Eigen::Index(i)];
        x += share * ball.reference(node, theta[size_t(a)]);
        du += share * vector_at(displacement, node, a);
        dv += share * vector_at(velocity, node, a);
        s += share * stress[size_t(node * angles + a)];
      }
      add(x, du, dv, s, {});
    }
    for (int a = 0; a < angles; a += 2) {
      const auto low = [&](int i) { return numbers.at(n[size_t(i)], a); };
      const auto mid = [&](int i) { return numbers.at(n[size_t(i)], a + 1); };
      const auto high = [&](int i) { return numbers.at(n[size_t(i)], a + 2); };
      if (wedge)
        out.cells.push_back(
            {CellShape::quadratic_wedge,
             {low(0), low(3), high(3), low(1), low(2), high(2), low(7), mid(3), high(7), low(5), mid(2), high(5),
              low(4), low(6), high(6), middle + a / 2, mid(6), middle + (a + 2) % angles / 2}});
      else
        out.cells.push_back(
            {CellShape::quadratic_hexahedron,
             {low(0),  low(1),  low(2),  low(3),  high(0), high(1), high(2), high(3), low(4), low(5), low(6), low(7),
              high(4), high(5), high(6), high(7), mid(0),  mid(1),  mid(2),  mid(3),  mid(7), mid(5), mid(4), mid(6)}});
      layer.values.push_back(meridian.layer[e]);
      around.values.push_back(2 * kPi * (a + 1) / angles);
    }
  }
  out.point_fields = {vector_field("displacement", "m", u),
                      vector_field("velocity", "m/s", v),
                      vector_field("contact_traction", "Pa", t),
                      std::move(cauchy),
                      std::move(mises),
                      std::move(pressure)};
  out.cell_fields = {std::move(layer), std::move(around)};
  return out;
}

}  // namespace hosel::post
