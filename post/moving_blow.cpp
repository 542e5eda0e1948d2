#include "post/moving_blow.hpp"

#include <vtkBase64Utilities.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "post/ball_mesh.hpp"

namespace hosel::post {
namespace {

const VtkField& field(const VtkMesh& mesh, std::string_view name) {
  const auto at = std::ranges::find(mesh.point_fields, name, &VtkField::name);
  if (at == mesh.point_fields.end()) throw std::logic_error("moving blow: no array " + std::string(name));
  return *at;
}

/// The points of a mesh, those of `which` alone where it is given, as they are now.
MovingBlow::Instant instant(const VtkMesh& mesh, const std::vector<std::int64_t>& which = {}) {
  const VtkField& displacement = field(mesh, "displacement");
  MovingBlow::Instant out;
  const std::size_t count = which.empty() ? mesh.points.size() : which.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t p = which.empty() ? i : std::size_t(which[i]);
    for (std::size_t k = 0; k < 3; ++k)
      out.place.push_back(float(mesh.points[p][Eigen::Index(k)] + displacement.values[3 * p + k]));
  }
  return out;
}

std::vector<float> values(const VtkMesh& mesh, std::string_view name, const std::vector<std::int64_t>& which) {
  const VtkField& of = field(mesh, name);
  std::vector<float> out;
  for (const std::int64_t p : which) out.push_back(float(of.values[std::size_t(p)]));
  return out;
}

std::vector<int> triangles(const VtkMesh& mesh) {
  std::vector<int> out;
  for (const VtkMesh::Cell& cell : mesh.cells)
    for (const std::size_t i : {0, 1, 2, 0, 2, 3}) out.push_back(int(cell.points[i]));
  return out;
}

std::string base64(const std::vector<std::uint16_t>& words) {
  std::vector<unsigned char> bytes;  // little-endian
  for (const std::uint16_t w : words) {
    bytes.push_back(static_cast<unsigned char>(w & 0xff));
    bytes.push_back(static_cast<unsigned char>(w >> 8));
  }
  std::string text(4 * (bytes.size() / 3 + 1), '\0');
  text.resize(vtkBase64Utilities::Encode(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(text.data())));
  return text;
}

std::string base64(const std::vector<int>& numbers) {
  std::vector<std::uint16_t> words;
  for (const int n : numbers) words.push_back(std::uint16_t(n));
  return base64(words);
}

double round_to(double x, double unit) { return unit * std::round(x / unit); }

}  // namespace

void MovingBlow::add(const models::ImpactView& view, const VtkMesh& ball, int angles, const VtkMesh& face,
                     const VtkMesh& head, const VtkMesh* shaft) {
  const mesh::Meridian& meridian = view.ball.mesh();
  const RevolvedPoints numbers(meridian, angles);
  // The half that stays lies towards the heel; the section is seen from the toe.
  const int turn = view.ball.placement().axes.col(2).dot(view.face.axes.col(1)) > 0 ? 1 : -1;
  std::vector<std::int64_t> surface, section;
  const auto row = [&](int node) {
    for (int a = 0; a < angles; ++a) surface.push_back(numbers.at(node, (turn * a + angles) % angles));
  };
  row(meridian.surface.front()[0]);
  for (const auto& edge : meridian.surface) {
    row(edge[2]);
    row(edge[1]);
  }
  const int nodes = int(meridian.nodes.size());
  for (const int angle : {0, angles / 2})
    for (int n = 0; n < nodes; ++n) section.push_back(numbers.at(n, angle));

  if (bodies.empty()) {
    radius = meridian.radius;
    face_axes = view.face.axes;
    bodies.push_back({"ball", int(surface.size()), {int(2 * meridian.surface.size() + 1), angles}, {}, {}});
    Body& cut = bodies.emplace_back(Body{"section", 2 * nodes, {}, {}, {}});
    for (int side = 0; side < 2; ++side)
      for (const auto& element : meridian.elements)
        for (const int n : element) cut.cells.push_back(n + side * nodes);
    bodies.push_back({"face", int(face.points.size()), {}, triangles(face), {}});
    bodies.push_back({"head", int(head.points.size()), {}, triangles(head), {}});
    if (shaft) bodies.push_back({"shaft", int(shaft->points.size()), {}, {}, field(*shaft, "radius").values});
  }
  Frame frame{view.state.time, view.report.normal_force, view.ball.centre(view.state), {}};
  frame.bodies.push_back(instant(ball, surface));
  frame.bodies.back().stress = values(ball, "von_mises", surface);
  frame.bodies.back().pressure = values(ball, "contact_pressure", surface);
  frame.bodies.push_back(instant(ball, section));
  frame.bodies.back().stress = values(ball, "von_mises", section);
  frame.bodies.push_back(instant(face));
  frame.bodies.push_back(instant(head));
  if (shaft) frame.bodies.push_back(instant(*shaft));
  frames.push_back(std::move(frame));
  if (frames.size() <= most) return;
  // The steps that stay are multiples of twice the stride: the first frame is step 0.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < frames.size(); i += 2, ++kept)
    if (kept != i) frames[kept] = std::move(frames[i]);  // a vector moved to itself is empty
  frames.resize(kept);
  stride *= 2;
}

bool MovingBlow::whole() const {
  for (const Body& b : bodies) {
    const bool gridded = b.grid == std::array{0, 0} || (b.grid[0] > 0 && b.grid[1] > 0 &&
                                                        b.points / b.grid[0] == b.grid[1] && b.points % b.grid[0] == 0);
    if (b.points < 1 || !gridded || !std::ranges::all_of(b.cells, [&](int i) { return i >= 0 && i < b.points; }) ||
        (!b.radius.empty() && b.radius.size() != std::size_t(b.points)))
      return false;
  }
  return std::ranges::all_of(frames, [&](const Frame& f) {
    if (f.bodies.size() != bodies.size()) return false;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto points = std::size_t(bodies[i].points);
      const Instant& now = f.bodies[i];
      if (now.place.size() != 3 * points || (!now.stress.empty() && now.stress.size() != points) ||
          (!now.pressure.empty() && now.pressure.size() != points))
        return false;
    }
    return true;
  });
}

std::string json_for_viewer(const MovingBlow& blow) {
  using nlohmann::json;
  if (blow.frames.empty()) return {};
  for (const MovingBlow::Body& body : blow.bodies)
    if (std::ranges::any_of(body.cells, [](int point) { return point > 65535; })) return {};
  constexpr std::size_t kMost = 4'000'000;  // characters
  std::size_t words = 0;                    // of a frame
  for (const MovingBlow::Instant& i : blow.frames.front().bodies)
    words += i.place.size() + i.stress.size() + i.pressure.size();
  std::size_t every = 1;
  const auto kept = [&] { return (blow.frames.size() + every - 1) / every; };
  while (kept() * words * 2 * 4 / 3 > kMost && kept() > 1) every *= 2;
  std::vector<const MovingBlow::Frame*> frames;
  for (std::size_t i = 0; i < blow.frames.size(); i += every) frames.push_back(&blow.frames[i]);

  json out = {{"radius", blow.radius}, {"start", 0}};
  double largest = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    out["time_ms"].push_back(round_to(1e3 * frames[i]->time, 1e-6));
    out["force_kN"].push_back(round_to(1e-3 * frames[i]->force, 1e-6));
    const Vec3& c = frames[i]->centre;
    out["centre"].push_back({round_to(c.x(), 1e-7), round_to(c.y(), 1e-7), round_to(c.z(), 1e-7)});
    if (frames[i]->force > largest) largest = frames[i]->force, out["start"] = i;
  }
  for (int k = 0; k < 3; ++k)
    out["face_axes"].push_back({blow.face_axes(0, k), blow.face_axes(1, k), blow.face_axes(2, k)});

  using Values = std::vector<float> MovingBlow::Instant::*;
  // One scale for all bodies; at first touch few points carry what there is, and their pressure is no peak of the blow.
  constexpr double first_touch = 0.1;  // of the largest force
  const auto most = [&](Values of) {
    float x = 0;
    for (const MovingBlow::Frame* f : frames) {
      if (f->force < first_touch * largest) continue;
      for (const MovingBlow::Instant& i : f->bodies)
        for (const float v : i.*of) x = std::max(x, v);
    }
    return x > 0 ? double(x) : 1.0;
  };
  const double stress = most(&MovingBlow::Instant::stress), pressure = most(&MovingBlow::Instant::pressure);
  const auto rounded = [&](Values of, std::size_t body, double scale) {
    std::vector<std::uint16_t> q;
    for (const MovingBlow::Frame* f : frames)
      for (const float v : f->bodies[body].*of)
        q.push_back(std::uint16_t(std::lround(65535 * std::clamp(double(v) / scale, 0.0, 1.0))));
    return base64(q);
  };
  for (std::size_t b = 0; b < blow.bodies.size(); ++b) {
    const MovingBlow::Body& body = blow.bodies[b];
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (const MovingBlow::Frame* f : frames)
      for (std::size_t i = 0; i < f->bodies[b].place.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], f->bodies[b].place[i]);
        high[i % 3] = std::max(high[i % 3], f->bodies[b].place[i]);
      }
    double range = 0;
    for (std::size_t k = 0; k < 3; ++k) range = std::max(range, double(high[k]) - double(low[k]));
    const double step = range > 0 ? range / 65535 : 1;
    std::vector<std::uint16_t> q;
    for (const MovingBlow::Frame* f : frames)
      for (std::size_t i = 0; i < f->bodies[b].place.size(); ++i)
        q.push_back(std::uint16_t(std::lround((double(f->bodies[b].place[i]) - double(low[i % 3])) / step)));
    json j = {{"name", body.name}, {"points", body.points}, {"low", low}, {"step", step}, {"place", base64(q)}};
    if (body.grid[0] > 0) j["grid"] = body.grid;
    if (!body.cells.empty()) j[body.name == "section" ? "elements" : "triangles"] = base64(body.cells);
    if (!body.radius.empty()) j["radius"] = body.radius;
    const auto tell = [&](const char* name, const char* title, Values of, double scale) {
      if (!(frames.front()->bodies[b].*of).empty())
        j["fields"][name] = {{"title", title}, {"most", 1e-6 * scale}, {"values", rounded(of, b, scale)}};
    };
    tell("stress", "von Mises stress [MPa]", &MovingBlow::Instant::stress, stress);
    tell("pressure", "contact pressure [MPa]", &MovingBlow::Instant::pressure, pressure);
    out["bodies"].push_back(std::move(j));
  }
  std::string text = out.dump();
  // Nothing in it may end the element that it stands in.
  for (std::size_t at = 0; (at = text.find('<', at)) != text.npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace hosel::post
