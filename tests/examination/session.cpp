#include "session.hpp"

#include <algorithm>
#include <cmath>

#include "units.hpp"

namespace examination {
namespace {

using Quantity = Channel::Quantity;

double observe(const Flight& f, Quantity q) {
  switch (q) {
    case Quantity::ball_speed: return f.speed;
    case Quantity::launch: return f.launch;
    case Quantity::azimuth: return f.azimuth;
    case Quantity::backspin: return f.backspin;
    case Quantity::sidespin: return f.sidespin;
    // Riflespin is unmeasured: the rate reported is that of the other two, as radars do.
    case Quantity::spin_rate: return std::hypot(f.backspin, f.sidespin);
    case Quantity::spin_axis: return std::atan2(f.sidespin, f.backspin);
  }
  return 0;
}

}  // namespace

double round_to(double value, double resolution) {
  return std::round(value / resolution) * resolution + 0.0;  // never minus zero
}

Session draw_session(const SessionOptions& options, Random& random) {
  Session s;
  s.base = options.base;
  const bool planar = s.base == "rigid-planar";
  const bool iron = planar || options.wedge || random.chance(0.25);
  const bool wedge = options.wedge || (iron && random.chance(0.15));
  const int n = options.shots;

  // Drawn until it is a body's: no principal moment beyond the sum of the others.
  Matrix3d inertia;
  for (bool body = false; !body;) {
    if (iron) {
      s.head.mass_kg = wedge ? random.uniform(0.28, 0.30) : random.uniform(0.24, 0.275);
      s.head.cg_m =
          Vector3d(random.uniform(-0.006, -0.001), random.uniform(-0.002, 0.004), random.uniform(-0.005, 0.003));
      inertia = Vector3d(2.75e-4, 0.58e-4, 2.9e-4).asDiagonal();
      s.head.bulge_m = s.head.roll_m = std::numeric_limits<double>::infinity();
    } else {
      s.head.mass_kg = random.uniform(0.19, 0.21);
      s.head.cg_m =
          Vector3d(random.uniform(-0.043, -0.028), random.uniform(-0.003, 0.003), random.uniform(-0.002, 0.005));
      inertia = Vector3d(random.uniform(2.1e-4, 3.6e-4), random.uniform(2.8e-4, 4.2e-4), random.uniform(4.3e-4, 5.8e-4))
                    .asDiagonal();
      s.head.bulge_m = random.uniform(0.25, 0.4);
      s.head.roll_m = random.uniform(0.25, 0.4);
    }
    inertia *= random.uniform(0.92, 1.08);
    if (random.chance(0.5)) {
      const double p = 0.08 * std::sqrt(inertia(0, 0) * inertia(1, 1));
      for (const auto& [i, j] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}})
        inertia(i, j) = inertia(j, i) = p * random.uniform(-1, 1);
    }
    const Vector3d principal = Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia).eigenvalues();
    body = principal[0] > 0 && principal[2] < 0.98 * (principal[0] + principal[1]);
  }
  // The case is written with five significant digits; what it says is what is.
  const auto tidy = [](double v) {
    return v == 0 || !std::isfinite(v) ? v : std::stod([&] {
      char b[32];
      std::snprintf(b, sizeof b, "%.4e", v);
      return std::string(b);
    }());
  };
  s.head.mass_kg = tidy(s.head.mass_kg);
  s.head.bulge_m = tidy(s.head.bulge_m);
  s.head.roll_m = tidy(s.head.roll_m);
  s.head.cg_m = s.head.cg_m.unaryExpr(tidy);
  s.head.inertia_kg_m2 = inertia.unaryExpr(tidy);

  // Clusters: sessions of one club, or the clubs of an iron set.
  int clusters = 0;
  if (options.clusters) {
    clusters = n >= 100 ? 6 + random.below(3) : 5;
    s.cluster_column = iron ? "club" : random.chance(0.5) ? "session" : "player";
    s.split_by_cluster = random.chance(0.5);
    for (int c = 0; c < clusters; ++c)
      s.cluster_names.push_back(s.cluster_column == "club" ? std::to_string(4 + c) + "i"
                                : s.cluster_column == "session"
                                    ? "2026-0" + std::to_string(1 + c) + "-1" + std::to_string(c)
                                    : std::string(1, static_cast<char>('A' + c)));
  }
  const double speed0 = wedge ? random.uniform(27, 34) : iron ? random.uniform(34, 40) : random.uniform(39, 49);
  const double loft0 = wedge ? random.uniform(38, 50) : iron ? random.uniform(15, 26) : random.uniform(10, 14.5);
  const double attack0 = iron ? random.uniform(-5, -2) : random.uniform(-1, 3);
  const double speed_sd = random.uniform(1.5, 3.5), loft_sd = wedge  ? random.uniform(3, 6)
                                                              : iron ? random.uniform(1.5, 4)
                                                                     : random.uniform(1.3, 2.5);
  const double attack_sd = random.uniform(0.8, 1.8), path_sd = random.uniform(1.5, 3.5),
               face_sd = random.uniform(1.2, 2.8);
  const double toe_sd = (iron ? random.uniform(5, 9) : random.uniform(7, 12)) * options.impact_spread;
  const double high_sd = (iron ? random.uniform(3, 6) : random.uniform(4, 8)) * options.impact_spread;
  std::vector<double> cluster_speed, cluster_loft, cluster_mass;
  for (int c = 0; c < clusters; ++c) {
    const double step = clusters > 1 ? 2.0 * c / (clusters - 1) - 1 : 0;
    cluster_speed.push_back(s.cluster_column == "club" ? -3 * step : 2 * random.normal());
    cluster_loft.push_back(s.cluster_column == "club" ? 7 * step : random.normal());
    cluster_mass.push_back(tidy(s.head.mass_kg * (1 + 0.06 * step)));
  }
  s.mass_column = planar && s.cluster_column == "club";
  for (int i = 0; i < n; ++i) {
    const int c = clusters ? i * clusters / n : 0;
    if (clusters) s.cluster.push_back(c);
    Swing w;
    w.speed = speed0 + speed_sd * random.bounded_normal() + (clusters ? cluster_speed[c] : 0);
    w.loft = (loft0 + loft_sd * random.bounded_normal() + (clusters ? cluster_loft[c] : 0)) * deg;
    w.loft = std::max(w.loft, 5 * deg);
    w.attack = (attack0 + attack_sd * random.bounded_normal()) * deg;
    w.path = planar ? 0 : (path_sd * random.bounded_normal()) * deg;
    w.face = planar ? 0 : (face_sd * random.bounded_normal()) * deg;
    w.toe = toe_sd * random.bounded_normal() * 1e-3;
    w.high = high_sd * random.bounded_normal() * 1e-3;
    s.swings.push_back(w);
    s.head_mass_kg.push_back(s.mass_column ? cluster_mass[c] : s.head.mass_kg);
  }

  // The monitor: units, spin as two components or as rate and axis, resolution.
  const bool american = random.chance(0.3);
  const bool rate = !planar && random.chance(0.25);
  const double speed_unit = american ? mph : random.chance(0.15) ? kmh : 1.0;
  const std::string speed_name = speed_unit == mph ? "mph" : speed_unit == kmh ? "kmh" : "mps";
  const double fine = random.chance(0.5) ? 0.01 : 0.1;
  s.channels.push_back({"ball_speed_" + speed_name, Quantity::ball_speed, 0, speed_unit, 0.25 / speed_unit, 0.1});
  s.channels.push_back({"launch_angle_deg", Quantity::launch, 1, deg, 0.2, fine});
  if (!planar) s.channels.push_back({"azimuth_deg", Quantity::azimuth, 2, deg, 0.3, fine});
  if (!rate) {
    s.channels.push_back({"backspin_rpm", Quantity::backspin, 3, rpm, 60, 1});
    if (!planar) s.channels.push_back({"sidespin_rpm", Quantity::sidespin, 4, rpm, 60, 1});
  } else {
    s.channels.push_back({"spin_rate_rpm", Quantity::spin_rate, 3, rpm, 60, 1});
    s.channels.push_back({"spin_axis_deg", Quantity::spin_axis, 4, deg, 1.0, 0.1});
  }
  if (random.chance(0.15))
    s.channels[static_cast<std::size_t>(random.below(static_cast<int>(s.channels.size())))].declared = false;

  const bool all = options.input_noise && random.chance(0.5);
  const auto noisy = [&](double sd) { return all ? sd : 0.0; };
  s.inputs.push_back(
      {"club_speed_" + speed_name, &Swing::speed, speed_unit, noisy(0.15 / speed_unit), speed_unit == 1 ? 0.01 : 0.1});
  s.inputs.push_back({"attack_angle_deg", &Swing::attack, deg, noisy(0.3), fine});
  s.inputs.push_back({"dynamic_loft_deg", &Swing::loft, deg, options.input_noise ? 0.4 : 0, fine});
  if (!planar) {
    s.inputs.push_back({"club_path_deg", &Swing::path, deg, noisy(0.3), fine});
    s.inputs.push_back({"face_angle_deg", &Swing::face, deg, noisy(0.3), fine});
  }
  s.inputs.push_back({"impact_toe_mm", &Swing::toe, 1e-3, noisy(1.0), 0.1});
  s.inputs.push_back({"impact_high_mm", &Swing::high, 1e-3, noisy(1.0), 0.1});
  // What nothing depends on, to be refused as an explanation.
  if (random.chance(0.4)) {
    Extra humidity{"humidity_pct", {}};
    double level = random.uniform(35, 75);
    for (int i = 0; i < n; ++i) {
      level += 0.8 * random.normal();
      humidity.cells.push_back(std::to_string(static_cast<int>(std::round(level))));
    }
    s.extras.push_back(humidity);
  }
  if (random.chance(0.3)) {
    Extra grip{"grip_ex_x", {}};
    for (int i = 0; i < n; ++i) {
      char cell[32];
      std::snprintf(cell, sizeof cell, "%.2f", random.normal());
      grip.cells.push_back(cell);
    }
    s.extras.push_back(grip);
  }
  return s;
}

Truth base_truth(const Session& session) {
  Truth t;
  t.nature.planar = session.base == "rigid-planar";
  return t;
}

Eigen::MatrixXd predict(const Session& s, const std::vector<Swing>& swings, const Truth& truth) {
  const int n = static_cast<int>(swings.size());
  Eigen::MatrixXd out(n, static_cast<int>(s.channels.size()));
  Head head = s.head;
  for (int i = 0; i < n; ++i) {
    const double t = n > 1 ? static_cast<double>(i) / (n - 1) : 0;
    head.mass_kg = s.head_mass_kg[static_cast<std::size_t>(i)];
    Nature nature = truth.nature;
    nature.loft_bias += truth.loft_drift * t;
    nature.level += truth.level_drift * t;
    const Flight flight = strike(swings[static_cast<std::size_t>(i)], head, s.ball, nature);
    const double shape = std::pow(t, truth.drift_power);
    for (std::size_t c = 0; c < s.channels.size(); ++c) {
      const Channel& ch = s.channels[c];
      out(i, static_cast<int>(c)) = observe(flight, ch.quantity) / ch.unit + truth.drift[ch.slot] * ch.noise_sd * shape;
    }
  }
  return out;
}

std::vector<Swing> recorded_swings(const Session& s) {
  std::vector<Swing> swings(static_cast<std::size_t>(s.shots()));
  for (int i = 0; i < s.shots(); ++i)
    for (std::size_t k = 0; k < s.inputs.size(); ++k)
      swings[static_cast<std::size_t>(i)].*s.inputs[k].member = s.recorded_inputs(i, static_cast<int>(k)) *
                                                                s.inputs[k].unit;
  return swings;
}

void record_inputs(Session& s, Random& random) {
  s.recorded_inputs.resize(s.shots(), static_cast<int>(s.inputs.size()));
  for (int i = 0; i < s.shots(); ++i)
    for (std::size_t k = 0; k < s.inputs.size(); ++k) {
      const Column& c = s.inputs[k];
      const double value = s.swings[static_cast<std::size_t>(i)].*c.member / c.unit + c.noise_sd * random.normal();
      s.recorded_inputs(i, static_cast<int>(k)) = round_to(value, c.resolution);
    }
}

std::vector<Eigen::MatrixXd> whitening(const Session& s, const std::vector<Swing>& swings) {
  const int n = static_cast<int>(swings.size()), m = static_cast<int>(s.channels.size());
  const Truth base = base_truth(s);
  std::vector<Eigen::MatrixXd> sigma(static_cast<std::size_t>(n), Eigen::MatrixXd::Zero(m, m));
  for (int c = 0; c < m; ++c) {
    const Channel& ch = s.channels[static_cast<std::size_t>(c)];
    for (auto& matrix : sigma) matrix(c, c) = ch.noise_sd * ch.noise_sd + ch.resolution * ch.resolution / 12;
  }
  const Eigen::MatrixXd at = predict(s, swings, base);
  for (const Column& c : s.inputs) {
    const double variance = c.noise_sd * c.noise_sd + c.resolution * c.resolution / 12;
    const double h = 1e-4 * c.unit * (c.noise_sd + c.resolution);
    auto moved = swings;
    for (Swing& w : moved) w.*c.member += h;
    const Eigen::MatrixXd slope = (predict(s, moved, base) - at) * (c.unit / h);
    for (int i = 0; i < n; ++i)
      sigma[static_cast<std::size_t>(i)] += variance * slope.row(i).transpose() * slope.row(i);
  }
  for (auto& matrix : sigma) {
    const Eigen::MatrixXd l = matrix.llt().matrixL();
    matrix = l.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(m, m));
  }
  return sigma;
}

Fit fit(const Session& s, const std::vector<Swing>& swings, const std::vector<const Form*>& forms,
        const Eigen::MatrixXd& target, const std::vector<Eigen::MatrixXd>& w, const std::vector<int>& rows,
        bool bounded) {
  const int m = static_cast<int>(s.channels.size()), n = static_cast<int>(rows.size());
  std::vector<FormParameter> parameters;
  std::vector<int> first;
  for (const Form* f : forms) {
    first.push_back(static_cast<int>(parameters.size()));
    parameters.insert(parameters.end(), f->parameters.begin(), f->parameters.end());
  }
  const int p = static_cast<int>(parameters.size());
  const auto outputs = [&](const std::vector<double>& x) {
    Truth t = base_truth(s);
    for (std::size_t k = 0; k < forms.size(); ++k)
      forms[k]->apply(t, std::span(x).subspan(static_cast<std::size_t>(first[k]), forms[k]->parameters.size()));
    return predict(s, swings, t);
  };
  const auto whiten = [&](const Eigen::MatrixXd& difference) {
    Eigen::VectorXd r(n * m);
    for (int k = 0; k < n; ++k) {
      const int i = rows[static_cast<std::size_t>(k)];
      Eigen::VectorXd d = difference.row(i).transpose();
      // A missing channel carries nothing; the others keep their common whitening.
      d = d.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
      r.segment(k * m, m) = w[static_cast<std::size_t>(i)] * d;
    }
    return r;
  };

  std::vector<std::vector<double>> starts{std::vector<double>(static_cast<std::size_t>(p), 0.0)};
  for (std::size_t k = 0; k < forms.size(); ++k)
    if (!forms[k]->starts.empty()) {
      std::vector<std::vector<double>> more;
      for (const auto& start : starts)
        for (const double v : forms[k]->starts) {
          more.push_back(start);
          more.back()[static_cast<std::size_t>(first[k])] = v;
        }
      starts = more;
    }
  if (forms.size() == 1 && forms[0]->effect == "head-rotation") starts = {{1.0}};

  if (starts.size() > 4) {  // refine only the four nearest
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < starts.size(); ++k) order.push_back({whiten(target - outputs(starts[k])).norm(), k});
    std::sort(order.begin(), order.end());
    std::vector<std::vector<double>> near;
    for (std::size_t k = 0; k < 4; ++k) near.push_back(starts[order[k].second]);
    starts = near;
  }
  Fit best;
  best.distance = std::numeric_limits<double>::infinity();
  for (auto x : starts) {
    Eigen::MatrixXd at = outputs(x);
    Eigen::VectorXd r = whiten(target - at);
    Eigen::MatrixXd jacobian(n * m, p);
    double damping = 1e-6;
    for (int iteration = 0; iteration < 8; ++iteration) {
      for (int k = 0; k < p; ++k) {
        auto y = x;
        const double h = 1e-4 * parameters[static_cast<std::size_t>(k)].scale;
        y[static_cast<std::size_t>(k)] += h;
        jacobian.col(k) = whiten((outputs(y) - at) / h) * parameters[static_cast<std::size_t>(k)].scale;
      }
      const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
      const Eigen::VectorXd gradient = jacobian.transpose() * r;
      bool moved = false;
      for (int attempt = 0; attempt < 5 && !moved; ++attempt) {
        Eigen::MatrixXd damped = normal;
        damped.diagonal().array() += damping * (normal.diagonal().array() + 1e-9 * (1 + normal.diagonal().maxCoeff()));
        const Eigen::VectorXd step = damped.ldlt().solve(gradient);
        auto y = x;
        for (int k = 0; k < p; ++k) {
          const auto& q = parameters[static_cast<std::size_t>(k)];
          double v = y[static_cast<std::size_t>(k)] + step[k] * q.scale;
          if (bounded) {
            const double reach = 0.25 * (q.high - q.low);
            const double low = q.low >= 0 ? std::min(0.0, q.low) : q.low - reach;
            v = std::clamp(v, low, q.high + reach);
          }
          y[static_cast<std::size_t>(k)] = v;
        }
        const Eigen::MatrixXd there = outputs(y);
        const Eigen::VectorXd q = whiten(target - there);
        if (q.squaredNorm() < r.squaredNorm()) {
          moved = r.squaredNorm() - q.squaredNorm() > 1e-7 * r.squaredNorm() + 1e-9;
          x = y;
          at = there;
          r = q;
          damping *= 0.2;
          if (!moved) break;
        } else {
          damping = std::max(damping * 20, 1e-5);
        }
      }
      if (!moved) break;
    }
    if (r.norm() < best.distance) {
      best.distance = r.norm();
      best.value = x;
      best.outputs = at;
      best.sd.clear();
      const Eigen::MatrixXd inverse =
          (jacobian.transpose() * jacobian).completeOrthogonalDecomposition().pseudoInverse();
      for (int k = 0; k < p; ++k)
        best.sd.push_back(std::sqrt(std::max(0.0, inverse(k, k))) * parameters[static_cast<std::size_t>(k)].scale);
    }
  }
  return best;
}

}  // namespace examination
