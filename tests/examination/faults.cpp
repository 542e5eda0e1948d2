#include "faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "units.hpp"

namespace examination {
namespace {

using Json = nlohmann::ordered_json;

/// A column wherever it stands: inputs first, then channels.
struct Place {
  bool input;
  int k;
  std::string header;
  double unit, resolution;
};

std::vector<Place> places(const Session& s) {
  std::vector<Place> all;
  for (std::size_t k = 0; k < s.inputs.size(); ++k)
    all.push_back({true, static_cast<int>(k), s.inputs[k].header, s.inputs[k].unit, s.inputs[k].resolution});
  for (std::size_t k = 0; k < s.channels.size(); ++k)
    all.push_back({false, static_cast<int>(k), s.channels[k].header, s.channels[k].unit, s.channels[k].resolution});
  return all;
}

/// One of the columns whose headers begin so, at random.
std::optional<Place> pick(const Session& s, const std::vector<std::string>& starts, Random& random) {
  std::vector<Place> some;
  for (const Place& p : places(s))
    for (const auto& start : starts)
      if (p.header.starts_with(start)) some.push_back(p);
  if (some.empty()) return std::nullopt;
  return some[static_cast<std::size_t>(random.below(static_cast<int>(some.size())))];
}

using Change = std::function<double(double value, int row)>;

ColumnSlip slip_of(const std::string& kind, const Place& p, Change change) {
  return {kind, {p.header}, [p, change](Eigen::MatrixXd& in, Eigen::MatrixXd& out) {
            auto column = p.input ? in.col(p.k) : out.col(p.k);
            for (int i = 0; i < column.size(); ++i) column[i] = change(column[i], i);
          }};
}

/// What may stand under a header of this unit: another unit and the last digit it is written with.
struct Other {
  double unit, resolution;
};
std::vector<Other> others(const Place& p) {
  const std::string& h = p.header;
  if (h.ends_with("_mps")) return {{mph, 0.1}, {kmh, 0.1}};
  if (h.ends_with("_mph")) return {{1, 0.1}, {kmh, 0.1}};
  if (h.ends_with("_kmh")) return {{1, 0.1}, {mph, 0.1}};
  if (h.ends_with("_deg")) return {{1, 0.001}};
  if (h.ends_with("_rpm")) return {{1, 0.1}};
  if (h.ends_with("_mm")) return {{0.0254, 0.01}};
  return {};
}

/// A size that a person would call a fault of this column, in recorded units.
double size(const Place& p, Random& random) {
  const std::string& h = p.header;
  double si;
  if (h.ends_with("_mm")) si = random.uniform(8, 20) * 1e-3;
  else if (h.ends_with("_rpm")) si = random.uniform(400, 1500) * M_PI / 30;
  else if (h.starts_with("spin_axis")) si = random.uniform(5, 15) * deg;
  else if (h.ends_with("_deg")) si = random.uniform(2, 7) * deg;
  else si = random.uniform(2, 6);
  return random.sign() * si / p.unit;
}

Vector3d direction(double up, double right) {
  return {std::cos(up) * std::cos(right), -std::cos(up) * std::sin(right), std::sin(up)};
}

}  // namespace

std::optional<ColumnSlip> draw_slip(Session& s, int which, Random& random) {
  const int n = s.shots();
  switch (which % 6) {
    case 0: {
      const auto p = pick(s,
                          {"club_speed", "ball_speed", "launch", "dynamic_loft", "backspin", "spin_rate", "impact_toe",
                           "impact_high", "club_path", "face_angle", "azimuth", "sidespin", "attack"},
                          random);
      const auto list = others(*p);
      const Other o = list[static_cast<std::size_t>(random.below(static_cast<int>(list.size())))];
      return slip_of("unit", *p, [p = *p, o](double v, int) { return round_to(v * p.unit / o.unit, o.resolution); });
    }
    case 1: {
      const auto p = pick(s,
                          {"attack", "club_path", "face_angle", "impact_toe", "impact_high", "azimuth", "sidespin",
                           "spin_axis", "launch"},
                          random);
      return slip_of("sign", *p, [](double v, int) { return 0.0 - v; });
    }
    case 2: {
      const std::vector<std::pair<std::string, std::string>> pairs{
          {"club_speed", "ball_speed"}, {"launch", "dynamic_loft"},    {"attack", "dynamic_loft"},
          {"club_path", "face_angle"},  {"impact_toe", "impact_high"}, {"launch", "azimuth"},
          {"backspin", "sidespin"}};
      const auto& [a, b] = pairs[static_cast<std::size_t>(random.below(static_cast<int>(pairs.size())))];
      const auto p = pick(s, {a}, random), q = pick(s, {b}, random);
      if (!p || !q) return std::nullopt;
      return ColumnSlip{"swapped", {p->header, q->header}, [p = *p, q = *q](Eigen::MatrixXd& in, Eigen::MatrixXd& out) {
                          auto x = p.input ? in.col(p.k) : out.col(p.k);
                          auto y = q.input ? in.col(q.k) : out.col(q.k);
                          x.swap(y);
                        }};
    }
    case 3: {  // not of the loft: that has a name, loft-bias
      const auto p = pick(s,
                          {"attack", "club_path", "face_angle", "impact_toe", "impact_high", "launch", "azimuth",
                           "ball_speed", "club_speed", "backspin", "sidespin", "spin_rate", "spin_axis"},
                          random);
      return slip_of("offset", *p,
                     [p = *p, by = size(*p, random)](double v, int) { return round_to(v + by, p.resolution); });
    }
    case 4: {
      const auto p = pick(s,
                          {"club_speed", "ball_speed", "backspin", "sidespin", "spin_rate", "launch", "impact_toe",
                           "azimuth", "attack"},
                          random);
      const double by = random.chance(0.5) ? random.uniform(0.7, 0.92) : random.uniform(1.08, 1.4);
      return slip_of("scale", *p, [p = *p, by](double v, int) { return round_to(v * by, p.resolution); });
    }
    default: {
      const auto p = pick(s,
                          {"attack", "club_path", "face_angle", "dynamic_loft", "impact_toe", "impact_high", "launch",
                           "azimuth", "ball_speed", "club_speed", "backspin", "sidespin", "spin_rate", "spin_axis"},
                          random);
      const int from = static_cast<int>(random.uniform(0.25, 0.75) * n);
      if (random.chance(0.5)) {
        Extra e{"equipment", {}};
        for (int i = 0; i < n; ++i) e.cells.push_back(i < from ? "first" : "second");
        s.extras.push_back(e);
      }
      return slip_of("level-shift", *p, [p = *p, by = size(*p, random), from](double v, int i) {
        return i < from ? v : round_to(v + by, p.resolution);
      });
    }
  }
}

SlipDistance distance(const Session& s, const std::vector<Swing>& misread, const Eigen::MatrixXd& outputs,
                      const std::vector<Eigen::MatrixXd>& w, const ColumnSlip& slip) {
  const int n = s.shots(), m = static_cast<int>(s.channels.size());
  const Truth base = base_truth(s);
  const Eigen::MatrixXd at = predict(s, misread, base);
  const auto whiten = [&](const Eigen::MatrixXd& d) {
    Eigen::VectorXd r(n * m);
    for (int i = 0; i < n; ++i) r.segment(i * m, m) = w[static_cast<std::size_t>(i)] * d.row(i).transpose();
    return r;
  };
  const Eigen::VectorXd d = whiten(outputs - at);
  const double share = std::sqrt(2.0 / 3.0);
  SlipDistance out{share * d.norm(), std::numeric_limits<double>::infinity()};
  for (const Place& p : places(s))
    for (const std::string kind : {"offset", "scale"}) {
      if (kind == slip.slip && p.header == slip.columns[0]) continue;
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n, m);
      if (p.input) {
        auto moved = misread;
        auto member = s.inputs[static_cast<std::size_t>(p.k)].member;
        for (Swing& x : moved) x.*member += 1e-4 * (kind == "offset" ? p.unit : x.*member);
        change = (predict(s, moved, base) - at) / 1e-4;
      } else if (kind == "offset") {
        change.col(p.k).setOnes();
      } else {
        change.col(p.k) = outputs.col(p.k);
      }
      const Eigen::VectorXd c = whiten(change);
      if (c.norm() > 0) out.other = std::min(out.other, share * (d - c * (c.dot(d) / c.squaredNorm())).norm());
    }
  return out;
}

std::optional<Json> compute_mostly(Session& s, int which, Random& random) {
  const int n = s.shots();
  const bool planar = s.base == "rigid-planar";
  const auto input = [&](const std::string& start) {
    for (std::size_t k = 0; k < s.inputs.size(); ++k)
      if (s.inputs[k].header.starts_with(start)) return static_cast<int>(k);
    return -1;
  };
  const auto channel = [&](const std::string& start) {
    for (std::size_t k = 0; k < s.channels.size(); ++k)
      if (s.channels[k].header.starts_with(start)) return static_cast<int>(k);
    return -1;
  };
  const auto step = [&](int k) { return s.inputs[static_cast<std::size_t>(k)].resolution; };
  const auto in = [&](int k) { return s.inputs[static_cast<std::size_t>(k)].header; };
  const auto out = [&](int k) { return s.channels[static_cast<std::size_t>(k)].header; };
  const int loft = input("dynamic_loft"), speed = input("club_speed"), attack = input("attack"),
            path = input("club_path"), face = input("face_angle"), ball = channel("ball_speed"),
            launch = channel("launch"), azimuth = channel("azimuth"), axis = channel("spin_axis"),
            side = channel("sidespin");
  int spin = channel("backspin");
  if (spin < 0) spin = channel("spin_rate");
  const double share = random.uniform(0.5, 0.9);
  std::vector<char> computed(static_cast<std::size_t>(n));
  for (auto& c : computed) c = random.chance(share);
  Eigen::MatrixXd &x = s.recorded_inputs, &y = s.recorded_outputs;
  const auto angle = [&](int i, int k) { return x(i, k) * deg; };
  const auto reading = [&](int i, int k) { return y(i, k) * deg; };
  const auto every = [&](auto&& write) {
    for (int i = 0; i < n; ++i)
      if (computed[static_cast<std::size_t>(i)]) write(i);
  };
  /// A further column: computed, or read by an instrument of its own.
  const auto further = [&](const std::string& header, int digits, double noise, auto&& value, auto&& truth) {
    Extra e{header, {}};
    for (int i = 0; i < n; ++i)
      e.cells.push_back(fmt::format(
          "{:.{}f}", computed[static_cast<std::size_t>(i)] ? value(i) : truth(i) + noise * random.normal(), digits));
    s.extras.push_back(e);
  };
  const auto normal = [&](int i) { return direction(angle(i, loft), planar ? 0 : angle(i, face)); };
  const auto club = [&](int i) { return direction(angle(i, attack), planar ? 0 : angle(i, path)); };
  Json key;
  switch (which % (planar ? 6 : 10)) {
    case 0: {
      const double k = random.uniform(0.045, 0.057) / s.channels[static_cast<std::size_t>(ball)].unit;
      every([&](int i) { x(i, loft) = round_to(y(i, launch) + k * y(i, spin) / y(i, ball), step(loft)); });
      key = {{"column", in(loft)}, {"from", {out(launch), out(spin), out(ball)}}};
      break;
    }
    case 1: {
      const double smash = random.uniform(1.36, 1.48);
      every([&](int i) { x(i, speed) = round_to(y(i, ball) / smash, step(speed)); });
      key = {{"column", in(speed)}, {"from", {out(ball)}}};
      break;
    }
    case 2:
      further(
          "spin_loft_deg", 1, 0.5, [&](int i) { return x(i, loft) - x(i, attack); },
          [&](int i) {
            return (s.swings[static_cast<std::size_t>(i)].loft - s.swings[static_cast<std::size_t>(i)].attack) / deg;
          });
      key = {{"column", "spin_loft_deg"}, {"from", {in(loft), in(attack)}}};
      break;
    case 3:
      further(
          "smash_factor", 2, 0.03, [&](int i) { return y(i, ball) / x(i, speed); },
          [&](int i) { return y(i, ball) / x(i, speed); });
      key = {{"column", "smash_factor"}, {"from", {out(ball), in(speed)}}};
      break;
    case 4: {
      const double k = random.uniform(0.78, 0.88);
      if (planar) {
        every([&](int i) {
          y(i, launch) = round_to(k * x(i, loft) + (1 - k) * x(i, attack),
                                  s.channels[static_cast<std::size_t>(launch)].resolution);
        });
        key = {{"column", out(launch)}, {"from", {in(loft), in(attack)}}};
      } else {
        every([&](int i) { x(i, face) = round_to((y(i, azimuth) - (1 - k) * x(i, path)) / k, step(face)); });
        key = {{"column", in(face)}, {"from", {out(azimuth), in(path)}}};
      }
      break;
    }
    case 5: {  // in the vertical plane the loft from the ball's direction and the club's
      const double k = random.uniform(0.78, 0.88);
      if (planar) {
        every([&](int i) { x(i, loft) = round_to((y(i, launch) - (1 - k) * x(i, attack)) / k, step(loft)); });
        key = {{"column", in(loft)}, {"from", {out(launch), in(attack)}}};
        break;
      }
      [[fallthrough]];
    }
    case 6: {  // the face's normal from the ball's direction and the club's
      const double k = random.uniform(0.78, 0.88);
      every([&](int i) {
        const Vector3d normal = direction(reading(i, launch), reading(i, azimuth)) - (1 - k) * club(i);
        x(i, loft) = round_to(std::asin(normal.z() / normal.norm()) / deg, step(loft));
        x(i, face) = round_to(std::atan2(-normal.y(), normal.x()) / deg, step(face));
      });
      key = {{"column", in(loft)}, {"from", {in(face), out(launch), out(azimuth), in(attack), in(path)}}};
      break;
    }
    case 7: {  // the ball's direction from the face's normal and the club's direction
      const double k = random.uniform(0.78, 0.88);
      every([&](int i) {
        const Vector3d b = k * normal(i) + (1 - k) * club(i);
        y(i, launch) =
            round_to(std::asin(b.z() / b.norm()) / deg, s.channels[static_cast<std::size_t>(launch)].resolution);
        y(i, azimuth) =
            round_to(std::atan2(-b.y(), b.x()) / deg, s.channels[static_cast<std::size_t>(azimuth)].resolution);
      });
      key = {{"column", out(launch)}, {"from", {out(azimuth), in(loft), in(face), in(attack), in(path)}}};
      break;
    }
    case 8: {  // the spin's axis square to the face's normal and the club's direction
      every([&](int i) {
        const Vector3d w = club(i).cross(normal(i));
        if (axis >= 0) y(i, axis) = round_to(std::atan2(-w.z(), -w.y()) / deg, 0.1);
        else y(i, side) = round_to(y(i, spin) * w.z() / w.y(), 1);
      });
      key = {{"column", axis >= 0 ? out(axis) : out(side)}, {"from", {in(loft), in(face), in(attack), in(path)}}};
      if (axis < 0) key["from"].push_back(out(spin));
      break;
    }
    default:
      further(
          "spin_loft_deg", 1, 0.5, [&](int i) { return std::acos(normal(i).dot(club(i))) / deg; },
          [&](int i) {
            const Swing& t = s.swings[static_cast<std::size_t>(i)];
            return std::acos(direction(t.loft, t.face).dot(direction(t.attack, t.path))) / deg;
          });
      key = {{"column", "spin_loft_deg"}, {"from", {in(loft), in(face), in(attack), in(path)}}};
  }
  key["share"] = static_cast<double>(std::count(computed.begin(), computed.end(), 1)) / n;
  return key;
}

}  // namespace examination
