#include "post/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "post/shaft_loads.hpp"

namespace hosel::post {
namespace {

/// Outline of a face in the plane: a super-ellipse, like a face seen from the front.
Vec3 face_point(const Face& face, double u, double v, double width, double height) {
  // Square to disc, then softened corners.
  const double y = 0.5 * width * u * std::sqrt(1 - 0.35 * v * v), z = 0.5 * height * v * std::sqrt(1 - 0.35 * u * u);
  return face.point(y, z);
}

}  // namespace

VtkMesh face_mesh(const Face& face, double width, double height) {
  constexpr int n = 24;
  VtkMesh m;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) m.points.push_back(face_point(face, 2.0 * i / n - 1, 2.0 * j / n - 1, width, height));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int64_t a = j * (n + 1) + i;
      m.cells.push_back({CellShape::quad, {a, a + 1, a + n + 2, a + n + 1}});
    }
  return m;
}

VtkMesh head_mesh(const Head& head, double width, double height) {
  constexpr int around = 48, deep = 10;
  const double depth = std::max(0.008, 2 * std::abs(head.cg.x()));
  VtkMesh m;
  for (int k = 0; k <= deep; ++k) {
    const double s = double(k) / deep, shrink = std::sqrt(1 - 0.98 * s * s);
    for (int i = 0; i < around; ++i) {
      const double t = 2 * M_PI * i / around, c = std::cos(t), d = std::sin(t);
      const double edge = std::max(std::abs(c), std::abs(d));
      Vec3 p = face_point(head.face, c / edge, d / edge, width, height);
      p.y() *= shrink;
      p.z() *= shrink;
      p.x() -= s * depth;
      m.points.push_back(p);
    }
  }
  for (int k = 0; k < deep; ++k)
    for (int i = 0; i < around; ++i) {
      const std::int64_t a = k * around + i, b = k * around + (i + 1) % around;
      m.cells.push_back({CellShape::quad, {a, b, b + around, a + around}});
    }
  return m;
}

VtkMesh placed(VtkMesh mesh, const Pose& start, const Pose& now, const Vec3& velocity, const Vec3& spin,
               const std::vector<double>& travel) {
  std::vector<Vec3> displacement, speed;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    Vec3& p = mesh.points[i];
    const Vec3 moved = travel.empty() ? p : Vec3(p - travel[i] * Vec3::UnitX()), arm = now.rotation * moved,
               here = now.origin + arm;
    p = start.origin + start.rotation * p;
    displacement.push_back(here - p);
    speed.push_back(velocity + spin.cross(arm));
  }
  mesh.point_fields.push_back(vector_field("displacement", "m", displacement));
  mesh.point_fields.push_back(vector_field("velocity", "m/s", speed));
  if (!travel.empty()) mesh.point_fields.push_back({"travel", "m", 1, travel});
  return mesh;
}

VtkMesh shaft_mesh(const fem::Beam& beam, const Shaft& shaft, const fem::State& state) {
  VtkMesh m;
  std::vector<Vec3> displacement, velocity, deflection;
  VtkField radius{"radius", "m", 1, {}};
  const fem::Node& grip = beam.nodes().front();
  const Vec3 held = state.q.segment<3>(grip.translation.q), start = beam.line().front().position;
  const Eigen::Quaterniond turn = fem::rotation(state, grip.rotation);
  const double inside = shaft.length() - beam.line().back().arc_length;  // the line begins below the hands, or a clamp
  for (std::size_t i = 0; i < beam.nodes().size(); ++i) {
    const fem::DofMap::Block& block = beam.nodes()[i].translation;
    m.points.push_back(beam.line()[i].position);
    displacement.push_back(Vec3(state.q.segment<3>(block.q)) - m.points.back());
    velocity.emplace_back(state.v.segment<3>(block.v));
    deflection.push_back(Vec3(state.q.segment<3>(block.q)) - held - turn * (m.points.back() - start));
    radius.values.push_back(shaft.at(inside + beam.line()[i].arc_length).outer_radius);
    if (i > 0) m.cells.push_back({CellShape::line, {std::int64_t(i) - 1, std::int64_t(i)}});
  }
  VtkField axial{"axial_force", "N", 1, {}}, torque{"torque", "N m", 1, {}}, bending{"bending_moment", "N m", 1, {}};
  for (const SectionLoad& load : section_loads(beam, state)) {
    axial.values.push_back(load.axial);
    torque.values.push_back(load.torque);
    bending.values.push_back(load.bending);
  }
  m.point_fields = {vector_field("displacement", "m", displacement),
                    vector_field("velocity", "m/s", velocity),
                    vector_field("deflection", "m", deflection),
                    radius,
                    axial,
                    torque,
                    bending};
  return m;
}

VtkMesh hands_mesh(const Vec3& place, const fem::Wrench& wrench) {
  VtkMesh m;
  m.points = {place};
  m.cells = {{CellShape::vertex, {0}}};
  m.point_fields = {vector_field("force", "N", {wrench.force}), vector_field("moment", "N m", {wrench.moment})};
  return m;
}

}  // namespace hosel::post
