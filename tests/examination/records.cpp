#include "records.hpp"

#include <fmt/format.h>
#include <fmt/os.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>

#include "files.hpp"
#include "random.hpp"

namespace examination {
namespace fs = std::filesystem;
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// A clamped rod let go, as it is. Kelvin-Voigt: damping is `relaxation` times the rod's own stiffness.
struct Rod {
  double bending = 40;       // EI [N m^2]
  double line_mass = 0.06;   // [kg/m]
  double length = 1;         // [m]
  double tip_mass = 0;       // [kg]
  double root = 0;           // compliance of the clamp [rad/(N m)]
  double relaxation = 1e-4;  // [s]: 0.5 % at 15.9155 Hz, as the case tells
  double load = 3;           // [N]
};

/// Displacement [m] at `place` [m] and `times` [s] after release, by Ritz's method with eleven polynomials.
VectorXd ring(const Rod& rod, double place, const VectorXd& times) {
  constexpr int n = 11, points = 64;
  // w_i = x^(i+2) combined as Chebyshev polynomials of 2 x / L - 1, times x^2; the last turns the root.
  const auto shape = [&](double x, int derivative) {
    VectorXd out = VectorXd::Zero(n + 1);
    const double u = x / rod.length;
    double t[3][n] = {};  // polynomial, its first and second derivative by u
    for (int i = 0; i < n; ++i) {
      if (i == 0) t[0][i] = 1;
      else if (i == 1) t[0][i] = 2 * u - 1, t[1][i] = 2;
      else
        for (int d = 0; d < 3; ++d)
          t[d][i] = 2 * (2 * u - 1) * t[d][i - 1] + (d > 0 ? 4 * d * t[d - 1][i - 1] : 0) - t[d][i - 2];
      const double w[] = {u * u * t[0][i], 2 * u * t[0][i] + u * u * t[1][i],
                          2 * t[0][i] + 4 * u * t[1][i] + u * u * t[2][i]};
      out[i] = w[derivative] / std::pow(rod.length, derivative);
    }
    const double turn[] = {x, 1, 0};
    out[n] = turn[derivative];
    return out;
  };
  const int free = rod.root > 0 ? n + 1 : n;
  MatrixXd K = MatrixXd::Zero(n + 1, n + 1), M = K;
  for (int k = 0; k < points; ++k)  // Gauss-Legendre of two points in equal pieces
    for (const double side : {-1.0, 1.0}) {
      const double x = rod.length * (k + 0.5 + side / std::sqrt(12.0)) / points, weight = rod.length / (2 * points);
      const VectorXd w = shape(x, 0), curvature = shape(x, 2);
      K += weight * rod.bending * curvature * curvature.transpose();
      M += weight * rod.line_mass * w * w.transpose();
    }
  const VectorXd tip = shape(rod.length, 0);
  M += rod.tip_mass * tip * tip.transpose();
  const MatrixXd own = K;
  if (rod.root > 0) {
    const VectorXd slope = shape(0, 1);
    K += slope * slope.transpose() / rod.root;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(K.topLeftCorner(free, free),
                                                                 M.topLeftCorner(free, free));
  const VectorXd held = K.topLeftCorner(free, free).ldlt().solve(rod.load * tip.head(free));
  const VectorXd start = modes.eigenvectors().transpose() * M.topLeftCorner(free, free) * held;
  const VectorXd reading = modes.eigenvectors().transpose() * shape(place, 0).head(free);
  VectorXd out = VectorXd::Zero(times.size());
  for (int k = 0; k < free; ++k) {
    const auto phi = modes.eigenvectors().col(k);
    const double omega = std::sqrt(modes.eigenvalues()[k]);
    const double zeta = std::min(0.99, rod.relaxation * phi.dot(own.topLeftCorner(free, free) * phi) / (2 * omega));
    const double damped = omega * std::sqrt(1 - zeta * zeta);
    for (Eigen::Index i = 0; i < times.size(); ++i) {
      const double t = std::max(0.0, times[i]);
      out[i] += reading[k] * start[k] * std::exp(-zeta * omega * t) *
                (std::cos(damped * t) + zeta / std::sqrt(1 - zeta * zeta) * std::sin(damped * t));
    }
  }
  return out;
}

/// One test on the bench; channels are lead_mm at the tip and, with two, lead_mid_mm half way.
struct Test {
  Rod rod;
  VectorXd times;
  int channels = 1;
  double noise = 0.2;  // [mm]
  bool declared = true;
};

using Record = MatrixXd;  // times x channels [mm]

Record record(const Test& test, const Rod& rod, double delay = 0, double gain = 1) {
  Record out(test.times.size(), test.channels);
  out.col(0) = 1e3 * gain * ring(rod, rod.length, (test.times.array() - delay).matrix());
  if (test.channels == 2) out.col(1) = 1e3 * ring(rod, 0.5 * rod.length, test.times);
  return out;
}

/// A mechanism with one size; `unit` turns the size into what the report calls its parameter.
struct Mechanism {
  const char* name;
  const char* parameter;  ///< as the report calls it, where it is the same number
  double unit, first;     ///< reported = unit * size; a first guess of the size
  Record (*make)(const Test&, double size);
};

Record with(const Test& test, const std::function<void(Rod&)>& change) {
  Rod rod = test.rod;
  change(rod);
  return record(test, rod);
}

const Mechanism kMechanisms[] = {
    {"shaft-stiffness", "log_factor_bending", 1, 0.02,
     [](const Test& t, double x) { return with(t, [x](Rod& r) { r.bending *= std::exp(x); }); }},
    // The loop may add damping of another form: its number is not compared.
    {"shaft-damping", nullptr, 1, 5e-5,
     [](const Test& t, double x) { return with(t, [x](Rod& r) { r.relaxation += x; }); }},
    {"clamp-compliance", "compliance", 1e3, 5e-4,
     [](const Test& t, double x) { return with(t, [x](Rod& r) { r.root = std::max(x, 1e-9); }); }},
    {"tip-mass", "mass", 1e3, 2e-3, [](const Test& t, double x) { return with(t, [x](Rod& r) { r.tip_mass = x; }); }},
    {"sensor-delay", "delay", 1e3, 2e-3, [](const Test& t, double x) { return record(t, t.rod, x); }},
    {"sensor-gain", "gain_error", 1, 0.03, [](const Test& t, double x) { return record(t, t.rod, 0, 1 + x); }},
    {"sensor-offset", "offset", 1, 0.1, [](const Test& t, double x) {
       Record y = record(t, t.rod);
       y.col(0).array() += x;
       return y;
     }}};

/// What no name tells.
struct Invention {
  const char* name;
  bool all_channels;  ///< else the first alone
  Record (*make)(const Test&, double size);
};

const Invention kInventions[] = {
    {"hum", false,
     [](const Test& t, double x) {
       Record y = record(t, t.rod);
       y.col(0).array() += x * (2 * M_PI * 37 * t.times.array()).sin();
       return y;
     }},
    {"jump of the zero", false,
     [](const Test& t, double x) {
       Record y = record(t, t.rod);
       y.col(0).array() += x * (t.times.array() > 0.6 * t.times[t.times.size() - 1]).cast<double>();
       return y;
     }},
    {"gain that grows", false,
     [](const Test& t, double x) {
       Record y = record(t, t.rod);
       y.col(0).array() *= 1 + x * t.times.array() / t.times[t.times.size() - 1];
       return y;
     }},
    {"stop on one side", true, [](const Test& t, double x) {  // what swings to one side is short by a part
       Record y = record(t, t.rod);
       return Record((y.array() < 0).select(y.array() * (1 - x), y.array()));
     }}};

double distance(const Test& test, const Record& a, const Record& b) {
  return (a - b).norm() / test.noise * std::sqrt(2.0 / 3);
}

/// What of `y` no sizes of the mechanisms together reach, their effects added: Gauss-Newton from zero.
double beyond(const Test& test, const std::vector<const Mechanism*>& mechanisms, const Record& y) {
  const Record base = record(test, test.rod);
  const auto n = Eigen::Index(mechanisms.size());
  const auto sum = [&](const VectorXd& x) {
    Record out = base;
    for (Eigen::Index k = 0; k < n; ++k) out += mechanisms[std::size_t(k)]->make(test, x[k]) - base;
    return out;
  };
  VectorXd x = VectorXd::Zero(n);
  double best = distance(test, base, y);
  for (int i = 0; i < 12; ++i) {
    const Record at = sum(x);
    MatrixXd slopes(y.size(), n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double h = 1e-3 * mechanisms[std::size_t(k)]->first;
      slopes.col(k) =
          ((mechanisms[std::size_t(k)]->make(test, x[k] + h) - mechanisms[std::size_t(k)]->make(test, x[k])) / h)
              .reshaped();
    }
    VectorXd step = slopes.colPivHouseholderQr().solve((y - at).reshaped().matrix());
    bool moved = false;
    for (int half = 0; half < 12 && !moved; ++half, step /= 2)
      if (const double d = distance(test, sum(x + step), y); d < best * (1 - 1e-4)) {
        x += step;
        best = d;
        moved = true;
      }
    if (!moved) break;
  }
  return best;
}

Test draw_test(Random& random) {
  Test t;
  t.rod.bending = std::round(10 * random.uniform(25, 60)) / 10;
  t.rod.load = std::round(10 * random.uniform(1, 4)) / 10;
  const double step = std::vector{0.0025, 0.002, 0.001}[std::size_t(random.below(3))],
               length = random.uniform(0.6, 1.5);
  t.times = VectorXd::LinSpaced(int(length / step), 0, step * (int(length / step) - 1));
  t.channels = random.chance(0.6) ? 2 : 1;
  t.declared = random.chance(0.7);
  return t;
}

/// The size at which `measure`, which grows with the size, has a value.
double size_of(const std::function<double(double)>& measure, double first, double value) {
  double x = first;
  for (int i = 0; i < 40; ++i) {
    const double d = measure(x);
    if (std::abs(d / value - 1) < 1e-2) return x;
    x *= std::clamp(value / d, 0.2, 5.0);
  }
  return NAN;
}

/// Over all other names; with `pairs`, over all pairs of them as well.
double nearest_rival(const Test& test, const Mechanism* own, const Record& y, bool pairs = false) {
  double nearest = INFINITY;
  for (const Mechanism& one : kMechanisms) {
    if (&one == own) continue;
    nearest = std::min(nearest, beyond(test, {&one}, y));
    for (const Mechanism& two : kMechanisms)
      if (pairs && &two > &one) nearest = std::min(nearest, beyond(test, {&one, &two}, y));
  }
  return nearest;
}

void write(const Test& test, const Record& truth, Json key, const std::string& name, Random& random,
           const fs::path& dir) {
  fs::create_directories(dir / "keys");
  std::ofstream(dir / "keys" / (name + ".json")) << key.dump(1) << "\n";
  fs::create_directories(dir / name);
  auto csv = fmt::output_file((dir / name / "tip.csv").string());
  csv.print("time_s,lead_mm{}\n", test.channels == 2 ? ",lead_mid_mm" : "");
  for (Eigen::Index i = 0; i < truth.rows(); ++i) {
    csv.print("{:.4f}", test.times[i]);
    for (Eigen::Index c = 0; c < truth.cols(); ++c) csv.print(",{:.2f}", truth(i, c) + test.noise * random.normal());
    csv.print("\n");
  }
  auto toml = fmt::output_file((dir / name / "case.toml").string());
  toml.print(
      "kind  = \"loop\"\ntitle = \"record {}\"\n\n[model]\nbase = \"shaft\"\n\n[bench]\nstart  = \"release\"\nload_N = "
      "[{:.1f}, 0.0, 0.0]\nshear  = false\n\n",
      name, test.rod.load);
  toml.print(
      "[shaft]\ndamping_ratio        = 0.005\ndamping_frequency_Hz = 15.9155\n[shaft.table]\narc_length_mm            "
      "= [0.0, 1000.0]\n"
      "bending_stiffness_N_m2   = [{0:.1f}, {0:.1f}]\ntorsional_stiffness_N_m2 = [40.0, 40.0]\nmass_per_length_g_per_m "
      " = [60.0, 60.0]\n"
      "mean_radius_mm           = [1.0, 1.0]\n\n[data]\nseries = \"tip.csv\"\n",
      test.rod.bending);
  if (test.declared)
    toml.print("[data.noise]\nlead_mm = {0}\n{1}", test.noise,
               test.channels == 2 ? fmt::format("lead_mid_mm = {}\n", test.noise) : "");
  if (test.channels == 2) toml.print("\n[sensors.lead_mid_mm]\narc_length_mm = 500.0\n");
}

}  // namespace

void make_records(std::uint64_t seed, int sets, const fs::path& dir) {
  for (const std::string stratum : {"null", "one-effect", "confounded", "outside"})
    for (int i = 0; i < sets; ++i) {
      Random random(mix(mix(mix(seed, "records"), stratum), std::uint64_t(i)));
      const std::string name =
          fmt::format("r{:08x}", std::uint32_t(mix(mix(seed, stratum), std::uint64_t(7919 * i + 1))));
      Json key = {{"stratum", stratum}, {"seed", seed}, {"index", i}};
      for (int attempt = 0;; ++attempt) {
        if (attempt == 100) throw std::runtime_error("records: none of 100 draws meets the conditions of " + stratum);
        const Test test = draw_test(random);
        const Record base = record(test, test.rod);
        Record truth = base;
        if (stratum == "one-effect") {
          const Mechanism& m = kMechanisms[std::size_t(i) % std::size(kMechanisms)];
          const double a = std::exp(random.uniform(std::log(5.5), std::log(40.0)));
          const double x =
              size_of([&](double size) { return nearest_rival(test, &m, m.make(test, size)); }, m.first, a);
          if (!(x < 10 * m.first)) continue;
          truth = m.make(test, x);
          key.update({{"effect", m.name}, {"s", distance(test, truth, base)}, {"a", a}});
          if (m.parameter) key.update({{"parameter", m.parameter}, {"value", m.unit * x}});
        } else if (stratum == "confounded") {
          const Mechanism& m =
              kMechanisms[std::size_t(std::array{0, 2, 3}[std::size_t(i % 3)])];  // all three change the pitch
          const double s = std::exp(random.uniform(std::log(8.0), std::log(40.0)));
          const double x = size_of([&](double size) { return distance(test, m.make(test, size), base); }, m.first, s);
          truth = m.make(test, x);
          const double a = nearest_rival(test, &m, truth);
          if (!(a < 3)) continue;
          key.update({{"effect", m.name}, {"s", s}, {"a", a}});
        } else if (stratum == "outside") {
          const Invention& v = kInventions[std::size_t(i) % std::size(kInventions)];
          const double s = std::exp(random.uniform(std::log(10.0), std::log(60.0)));
          const double x = size_of([&](double size) { return distance(test, v.make(test, size), base); }, 0.1, s);
          truth = v.make(test, x);
          const double a = nearest_rival(test, nullptr, truth, true);
          if (!(a >= 8)) continue;
          key.update({{"effect", v.name}, {"channels", v.all_channels ? "all" : "lead_mm"}, {"s", s}, {"a", a}});
        }
        write(test, truth, key, name, random, dir);
        break;
      }
    }
}

void score_records(const fs::path& dir) {
  struct Count {
    int hit = 0, of = 0;
  };
  std::map<std::string, Count> counts;
  Json sets = Json::object();
  const auto count = [&](const std::string& what, bool hit) {
    ++counts[what].of;
    if (hit) ++counts[what].hit;
  };
  for (const auto& entry : fs::directory_iterator(dir / "keys")) {
    const std::string name = entry.path().stem().string();
    const Json key = Json::parse(std::ifstream(entry.path()));
    const std::string stratum = key.at("stratum");
    Json report;
    try {
      report = Json::parse(std::ifstream(dir / "out" / name / "report.json"));
    } catch (const std::exception&) {
      count("all: no report", true);
      continue;
    }
    count("all: no report", false);
    const auto adopted = report.at("adopted").get<std::vector<std::string>>();
    sets[name] = {{"key", key}, {"verdict", report.at("verdict")}, {"adopted", adopted}, {"ties", report.at("ties")}};
    if (stratum == "null") {
      count("nothing hidden: adoptions", !adopted.empty());
    } else if (stratum == "one-effect") {
      const std::string truth = key.at("effect");
      const bool alone = adopted == std::vector{truth};
      count("one effect: named alone", alone);
      count("one effect: a wrong name", !adopted.empty() && std::ranges::find(adopted, truth) == adopted.end());
      if (!alone || !key.contains("parameter")) continue;
      for (const Json& candidate : report.at("candidates")) {
        if (candidate.at("effects") != report.at("adopted")) continue;
        for (const Json& p : candidate.at("parameters"))
          if (p.at("name") == key.at("parameter"))
            count("one effect: 95 % interval holds the truth",
                  p.at("sd").is_null() || std::abs(p.at("value").get<double>() - key.at("value").get<double>()) <=
                                              1.96 * p.at("sd").get<double>());
        break;
      }
    } else if (stratum == "confounded") {
      const std::string truth = key.at("effect");
      bool inside = std::ranges::find(adopted, truth) != adopted.end();
      for (const Json& tie : report.at("ties"))
        for (const Json& member : tie) inside = inside || member == truth;
      count("confounded: named or inside the tie", inside);
      count("confounded: a wrong name alone", adopted.size() == 1 && adopted.front() != truth);
    } else {
      bool channel = false;
      for (const Json& u : report.at("unexplained"))
        channel = channel || key.at("channels") == "all" || u.at("channel") == key.at("channels");
      count("outside: unexplained, with the channel", report.at("verdict") == "unexplained" && channel);
      count("outside: adoptions", !adopted.empty());
    }
  }
  for (const auto& [what, c] : counts) fmt::print("{:45} {:3} of {:3}\n", what, c.hit, c.of);
  std::ofstream(dir / "score.json") << sets.dump(1) << "\n";
}

}  // namespace examination
