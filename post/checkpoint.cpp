#include "post/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "post/file.hpp"
#include "post/parse_json.hpp"

namespace hosel::post {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Raised whenever what follows means something else.
constexpr std::string_view kFormat = "hosel impact checkpoint 8";

template <class Dense>
json numbers(const Dense& x) {
  return std::vector<double>(x.data(), x.data() + x.size());
}

template <class Dense>
void numbers(const json& j, Dense& x) {
  const auto values = j.get<std::vector<double>>();
  if constexpr (Dense::SizeAtCompileTime == Eigen::Dynamic) x.resize(Eigen::Index(values.size()));
  if (Eigen::Index(values.size()) != x.size()) throw std::length_error("checkpoint");
  std::copy(values.begin(), values.end(), x.data());
}

/// Of whole numbers, or lists of them: another number may be none that an integer holds. Throws std::length_error.
const json& whole(const json& j) {
  if (j.is_structured())
    for (const json& each : j) whole(each);
  else if (!j.is_number_integer()) throw std::length_error("checkpoint");
  return j;
}

json to_json(const fem::State& s) {
  return {{"time", s.time}, {"q", numbers(s.q)}, {"v", numbers(s.v)}, {"a", numbers(s.a)}};
}

void from_json(const json& j, fem::State& s) {
  s.time = j.at("time");
  numbers(j.at("q"), s.q);
  numbers(j.at("v"), s.v);
  numbers(j.at("a"), s.a);
}

json to_json(const solvers::Peak& p) { return {p.value, p.time, p.times, p.values, p.steps}; }

void from_json(const json& j, solvers::Peak& p) {
  p = {j.at(0), j.at(1), j.at(2).get<std::array<double, 3>>(), j.at(3).get<std::array<double, 3>>(), whole(j.at(4))};
}

json to_json(const solvers::Ledger& l) {
  return {{"time", l.time},         {"kinetic", l.kinetic}, {"strain", l.strain},       {"contact", l.contact},
          {"friction", l.friction}, {"viscous", l.viscous}, {"numerical", l.numerical}, {"external", l.external},
          {"initial", l.initial},   {"closure", l.closure}};
}

void from_json(const json& j, solvers::Ledger& l) {
  l.time = j.at("time");
  l.kinetic = j.at("kinetic");
  l.strain = j.at("strain").get<std::vector<std::pair<std::string, double>>>();
  l.contact = j.at("contact");
  l.friction = j.at("friction");
  l.viscous = j.at("viscous");
  l.numerical = j.at("numerical");
  l.external = j.at("external");
  l.initial = j.at("initial");
  l.closure = j.at("closure");
}

std::vector<double> flat(const std::vector<BallSection::Point>& points) {
  std::vector<double> out;
  for (const auto& p : points) out.insert(out.end(), p.begin(), p.end());
  return out;
}

std::vector<BallSection::Point> points(const json& j) {
  const auto values = j.get<std::vector<double>>();
  if (values.size() % 2 != 0) throw std::length_error("checkpoint");
  std::vector<BallSection::Point> out;
  for (std::size_t i = 0; i < values.size(); i += 2) out.emplace_back(values[i], values[i + 1]);
  return out;
}

json to_json(const BallSection& s) {
  return {{"time", s.time},   {"force", s.force}, {"points", flat(s.points)}, {"von_mises", s.von_mises},
          {"cells", s.cells}, {"seams", s.seams}, {"face", flat(s.face)}};
}

void from_json(const json& j, BallSection& s) {
  s.time = j.at("time");
  s.force = j.at("force");
  s.points = points(j.at("points"));
  s.von_mises = j.at("von_mises").get<std::vector<double>>();
  s.cells = whole(j.at("cells")).get<std::vector<std::array<int, 4>>>();
  s.seams = whole(j.at("seams")).get<std::vector<std::array<int, 3>>>();
  s.face = points(j.at("face"));
  const auto known = [&](int i) { return i >= 0 && std::size_t(i) < s.points.size(); };
  const auto all_known = [&](const auto& corners) { return std::ranges::all_of(corners, known); };
  if (s.von_mises.size() != s.points.size() || !std::ranges::all_of(s.cells, all_known) ||
      !std::ranges::all_of(s.seams, all_known))
    throw std::length_error("checkpoint");
}

/// Numbers in single precision as they lie in memory.
json packed(const std::vector<float>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());  // none: no place to copy from
  return json::binary(std::move(bytes));
}

std::vector<float> unpacked(const json& j) {
  const auto& bytes = j.get_binary();
  if (bytes.size() % sizeof(float) != 0) throw std::length_error("checkpoint");
  std::vector<float> values(bytes.size() / sizeof(float));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

json to_json(const MovingBlow& m) {
  json out = {{"stride", m.stride}, {"radius", m.radius}, {"face_axes", numbers(m.face_axes)}};
  out["bodies"] = json::array();
  for (const MovingBlow::Body& b : m.bodies) out["bodies"].push_back({b.name, b.points, b.grid, b.cells, b.radius});
  out["frames"] = json::array();
  for (const MovingBlow::Frame& f : m.frames) {
    json bodies = json::array();
    for (const MovingBlow::Instant& i : f.bodies)
      bodies.push_back({packed(i.place), packed(i.stress), packed(i.pressure)});
    out["frames"].push_back({f.time, f.force, numbers(f.centre), std::move(bodies)});
  }
  return out;
}

void from_json(const json& j, MovingBlow& m) {
  m.stride = whole(j.at("stride"));
  m.radius = j.at("radius");
  numbers(j.at("face_axes"), m.face_axes);
  for (const json& b : j.at("bodies"))
    m.bodies.push_back({b.at(0), b.at(1), whole(b.at(2)).get<std::array<int, 2>>(),
                        whole(b.at(3)).get<std::vector<int>>(), b.at(4).get<std::vector<double>>()});
  for (const json& f : j.at("frames")) {
    MovingBlow::Frame& frame = m.frames.emplace_back();
    frame.time = f.at(0);
    frame.force = f.at(1);
    numbers(f.at(2), frame.centre);
    for (const json& i : f.at(3)) frame.bodies.push_back({unpacked(i.at(0)), unpacked(i.at(1)), unpacked(i.at(2))});
  }
  if (m.stride < 1 || !m.whole()) throw std::length_error("checkpoint");
}

SavedImpact saved_impact(const json& j) {
  SavedImpact out;
  models::ImpactCheckpoint& i = out.impact;
  const json &s = j.at("solver"), &r = j.at("so_far");
  from_json(s.at("state"), i.solver.state);
  numbers(s.at("auxiliary"), i.solver.auxiliary);
  i.solver.step = s.at("step");
  i.solver.last_step = s.at("last_step");
  from_json(s.at("ledger"), i.solver.ledger);
  i.solver.friction_before = s.at("friction_before");
  i.solver.viscous_before = s.at("viscous_before");
  i.solver.external_before = s.at("external_before");
  i.solver.history = s.at("history").get<std::vector<double>>();
  i.so_far.penetration = r.at("penetration");
  i.so_far.creep = r.at("creep");
  const auto counts = whole(r.at("counts")).get<std::array<long, 5>>();
  i.so_far.counts = {counts[0], counts[1], counts[2], counts[3], counts[4], r.at("worst_residual")};
  from_json(j.at("force"), i.force);
  from_json(j.at("compression"), i.compression);
  from_json(j.at("face_travel"), i.face_travel);
  i.touched = j.at("touched");
  i.over = j.at("over");
  i.last_touch = j.at("last_touch");
  i.last_nearest = j.at("last_nearest");
  i.release.time = j.at("release_time");
  i.release.force = j.at("release_force");
  i.release.known = whole(j.at("release_known"));
  if (i.release.known > models::Release::kSteps) throw std::length_error("checkpoint");
  i.release.apart = j.at("release_apart");
  i.last_gap = j.at("last_gap");
  numbers(j.at("face_centre"), out.face_centre);
  numbers(j.at("face_axes"), out.face_axes);
  out.history = {whole(j.at("history").at(0)), j.at("history").at(1)};
  from_json(j.at("moving"), out.moving);
  if (j.contains("section")) from_json(j.at("section"), out.section.emplace());
  if (j.contains("series"))
    for (const auto& [body, mark] : j.at("series").items())
      out.series[body] = {mark.at(0).get<std::vector<double>>(), mark.at(1)};
  return out;
}

}  // namespace

void save_checkpoint(const fs::path& file, const std::string& run, const SavedImpact& saved) {
  const models::ImpactCheckpoint& i = saved.impact;
  const solvers::Checkpoint& s = i.solver;
  const models::FeImpactResult& r = i.so_far;
  json j = {{"run", run},
            {"solver",
             {{"state", to_json(s.state)},
              {"auxiliary", numbers(s.auxiliary)},
              {"step", s.step},
              {"last_step", s.last_step},
              {"ledger", to_json(s.ledger)},
              {"friction_before", s.friction_before},
              {"viscous_before", s.viscous_before},
              {"external_before", s.external_before},
              {"history", s.history}}},
            {"so_far",
             {{"penetration", r.penetration},
              {"creep", r.creep},
              {"counts",
               {r.counts.steps, r.counts.rejected, r.counts.iterations, r.counts.factorisations,
                r.counts.dense_factorisations}},
              {"worst_residual", r.counts.worst_residual}}},
            {"force", to_json(i.force)},
            {"compression", to_json(i.compression)},
            {"face_travel", to_json(i.face_travel)},
            {"touched", i.touched},
            {"over", i.over},
            {"last_touch", i.last_touch},
            {"last_nearest", i.last_nearest},
            {"release_time", i.release.time},
            {"release_force", i.release.force},
            {"release_known", i.release.known},
            {"release_apart", i.release.apart},
            {"last_gap", i.last_gap},
            {"face_centre", numbers(saved.face_centre)},
            {"face_axes", numbers(saved.face_axes)},
            {"history", {saved.history.rows, saved.history.digest}}};
  j["moving"] = to_json(saved.moving);
  if (saved.section) j["section"] = to_json(*saved.section);
  for (const auto& [body, mark] : saved.series) j["series"][body] = {mark.times, mark.digest};
  std::string bytes;
  json::to_cbor(j, bytes);
  write_file(file, fmt::format("{} {}\n{}", kFormat, digest(bytes), bytes));
}

std::optional<SavedImpact> load_checkpoint(const fs::path& file, const std::string& run) {
  if (!fs::is_regular_file(file)) return std::nullopt;
  const std::string text = read_file(file);
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return std::nullopt;
  const std::string_view bytes = std::string_view(text).substr(end + 1);
  if (text.substr(0, end) != fmt::format("{} {}", kFormat, digest(bytes))) return std::nullopt;
  try {
    const json j = parse_cbor(bytes);
    if (j.value("run", "") == run) return saved_impact(j);
  } catch (const std::exception&) {}  // with the right digest: made by hand
  return std::nullopt;
}

}  // namespace hosel::post
