#include "strata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "faults.hpp"

namespace examination {
namespace {

using Quantity = Channel::Quantity;
struct Redraw {};  ///< this draw does not meet the stratum's conditions

std::vector<int> all_rows(const Session& s) {
  std::vector<int> rows(static_cast<std::size_t>(s.shots()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

bool fits_base(const Form& f, const Session& s) { return s.base == "rigid-planar" ? f.planar : f.eccentric; }

/// Whitened norm of a change of the outputs.
double norm(const std::vector<Eigen::MatrixXd>& w, const Eigen::MatrixXd& d) {
  double sum = 0;
  for (int i = 0; i < d.rows(); ++i) sum += (w[static_cast<std::size_t>(i)] * d.row(i).transpose()).squaredNorm();
  return std::sqrt(sum);
}

/// Two thirds of the shots train.
const double train_share = std::sqrt(2.0 / 3.0);

struct Geometry {
  const Session& s;
  std::vector<Swing> swings;
  std::vector<Eigen::MatrixXd> w;
  std::vector<int> rows;
  Eigen::MatrixXd base;
  bool bounded = true;  ///< forms inside their plausible range

  explicit Geometry(const Session& session)
      : s(session),
        swings(session.swings),
        w(whitening(session, swings)),
        rows(all_rows(session)),
        base(predict(session, swings, base_truth(session))) {}

  Eigen::MatrixXd outputs(const std::vector<Form>& forms, const std::vector<std::vector<double>>& x) const {
    Truth t = base_truth(s);
    for (std::size_t k = 0; k < forms.size(); ++k) forms[k].apply(t, x[k]);
    return predict(s, swings, t);
  }
  /// Distance of the outputs to the family of the forms, training rows.
  double distance(const Eigen::MatrixXd& outputs, const std::vector<const Form*>& forms) const {
    return forms.empty() ? train_share * norm(w, outputs - base)
                         : train_share * fit(s, swings, forms, outputs, w, rows, bounded).distance;
  }
};

/// What a calibrated restitution may absorb beside the effect.
std::vector<const Form*> absorbed(const std::string& effect) {
  if (effect == "restitution-law") return {};
  return {&calibration()};
}

/// Parameters along a random direction of the form, scaled so that the signal is `s`; nothing where that is
/// outside the plausible range.
std::optional<std::vector<double>> scaled(const Geometry& g, const Form& f, double s,
                                          const std::vector<const Form*>& nuisance, Random& random) {
  const std::size_t p = f.parameters.size();
  std::vector<double> direction(p, 0.0);
  if (f.effect == "session-drift" && f.form == "linear") {
    const auto count = g.s.channels.size();
    const int moved = 1 + random.below(2);
    for (int k = 0; k < moved; ++k)
      direction[static_cast<std::size_t>(
          g.s.channels[static_cast<std::size_t>(random.below(static_cast<int>(count)))].slot)] = random.sign();
  } else {
    const int only = p > 1 && random.chance(0.5) ? random.below(static_cast<int>(p)) : -1;
    for (std::size_t k = 0; k < p; ++k) {
      const auto& q = f.parameters[k];
      const double sign = q.low >= 0 ? 1 : random.sign();
      direction[k] = only >= 0 && only != static_cast<int>(k) ? 0 : sign * q.scale * random.uniform(0.4, 1);
    }
  }
  const auto at = [&](double t) {
    std::vector<double> x(p);
    for (std::size_t k = 0; k < p; ++k) x[k] = t * direction[k];
    return x;
  };
  double reach = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < p; ++k) {
    const auto& q = f.parameters[k];
    if (direction[k] > 0) reach = std::min(reach, q.high / direction[k]);
    if (direction[k] < 0) reach = std::min(reach, q.low / direction[k]);
  }
  const auto signal = [&](double t) { return g.distance(g.outputs({f}, {at(t)}), nuisance); };
  if (signal(reach) < s) return std::nullopt;
  double low = 0, high = reach;
  for (int i = 0; i < 24 && high - low > 1e-4 * reach; ++i) {
    const double middle = 0.5 * (low + high);
    (signal(middle) < s ? low : high) = middle;
  }
  const auto x = at(high);
  for (std::size_t k = 0; k < p; ++k)  // a threshold effect is plausible only beyond its lower end
    if (f.parameters[k].low > 0 && p == 1 && x[k] < f.parameters[k].low) return std::nullopt;
  return x;
}

/// The form with starts about the truth: a limit that one or two shots feel is found from nearby only.
Form known(Form f, const std::vector<double>& truth) {
  if (f.starts.empty()) return f;
  f.starts.clear();
  for (const double factor : {0.92, 0.94, 0.96, 0.98, 0.99, 1.0, 1.01, 1.02, 1.04, 1.06, 1.08})
    f.starts.push_back(factor * truth[0]);
  return f;
}

struct Rival {
  std::string effect;
  double distance = std::numeric_limits<double>::infinity();
};

/// The nearest rival among the natural forms of other names, each with what calibration absorbs and `beside`.
Rival nearest(const Geometry& g, const Eigen::MatrixXd& outputs, const std::vector<std::string>& except,
              const std::vector<const Form*>& nuisance, const std::vector<const Form*>& beside, double stop_below) {
  Rival r;
  for (const Form& f : natural_forms()) {
    if (!fits_base(f, g.s) || std::find(except.begin(), except.end(), f.effect) != except.end()) continue;
    std::vector<const Form*> forms{&f};
    for (const auto* list : {&nuisance, &beside})
      for (const Form* n : *list)
        if (n->effect != f.effect && !(n->effect == "restitution-level" && f.effect == "restitution-law"))
          forms.push_back(n);
    const double d = g.distance(outputs, forms);
    if (d < r.distance) r = {f.effect, d};
    if (d < stop_below) break;
  }
  return r;
}

// ---- recording -------------------------------------------------------------------------------------------

enum class Noise { plain, heavy, growing, drifting };

void record_outputs(Session& s, const Eigen::MatrixXd& truth, Noise kind, Random& random) {
  const int n = s.shots(), m = static_cast<int>(s.channels.size());
  s.recorded_outputs.resize(n, m);
  Eigen::VectorXd speed(n);
  for (int i = 0; i < n; ++i) speed[i] = s.swings[static_cast<std::size_t>(i)].speed;
  const double power = random.uniform(3, 6);
  Eigen::VectorXd growth = (speed / speed.mean()).array().pow(power);
  growth /= std::sqrt(growth.squaredNorm() / n);
  const bool correlated = random.chance(0.5);
  const double rho = random.uniform(0.4, 0.75), widening = random.uniform(1.5, 2.5);
  for (int c = 0; c < m; ++c) {
    const Channel& ch = s.channels[static_cast<std::size_t>(c)];
    double state = random.normal();
    for (int i = 0; i < n; ++i) {
      double z = random.normal();
      if (kind == Noise::heavy) z = random.heavy();
      if (kind == Noise::growing) z *= growth[i];
      if (kind == Noise::drifting && correlated) z = state = rho * state + std::sqrt(1 - rho * rho) * z;
      if (kind == Noise::drifting && !correlated) {
        const double t = n > 1 ? static_cast<double>(i) / (n - 1) : 0;
        const double a = 2 / (1 + widening);  // sd from a to a * widening
        z *= a * (1 + (widening - 1) * t) / std::sqrt(a * a * (1 + widening + widening * widening) / 3);
      }
      s.recorded_outputs(i, c) = round_to(truth(i, c) + ch.noise_sd * z, ch.resolution);
    }
  }
}

void lose_some(Session& s, Random& random) {
  if (!random.chance(0.15)) return;
  for (int i = 0; i < s.shots(); ++i)
    for (int c = 0; c < s.recorded_outputs.cols(); ++c)
      if (random.chance(0.015)) s.recorded_outputs(i, c) = std::numeric_limits<double>::quiet_NaN();
}

// ---- bad rows --------------------------------------------------------------------------------------------

/// Swaps two neighbouring digits of a recorded number.
double transposed(double value, double resolution, Random& random) {
  const int decimals = std::max(0, static_cast<int>(std::round(-std::log10(resolution))));
  std::string text = fmt::format("{:.{}f}", value, decimals);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k + 1 < text.size(); ++k)
    if (std::isdigit(text[k]) && std::isdigit(text[k + 1]) && text[k] != text[k + 1]) places.push_back(k);
  if (places.empty()) throw Redraw{};
  const std::size_t k = places[static_cast<std::size_t>(random.below(static_cast<int>(places.size())))];
  std::swap(text[k], text[k + 1]);
  return std::stod(text);
}

int column_of(const Session& s, const std::string& start) {
  for (std::size_t k = 0; k < s.inputs.size(); ++k)
    if (s.inputs[k].header.starts_with(start)) return static_cast<int>(k);
  return -1;
}
int channel_of(const Session& s, const std::string& start) {
  for (std::size_t k = 0; k < s.channels.size(); ++k)
    if (s.channels[k].header.starts_with(start)) return static_cast<int>(k);
  return -1;
}

/// Spoils one row in a random way; true where the change is at least `least` standard deviations of that row,
/// else the row is put back.
bool spoil(Session& s, int i, Random& random, double least, Json& notes) {
  const Eigen::RowVectorXd inputs = s.recorded_inputs.row(i), outputs = s.recorded_outputs.row(i);
  const int speed = column_of(s, "club_speed"), attack = column_of(s, "attack"), loft = column_of(s, "dynamic_loft");
  const int ball = channel_of(s, "ball_speed"), launch = channel_of(s, "launch"), azimuth = channel_of(s, "azimuth");
  int spin = channel_of(s, "backspin"), side = channel_of(s, "sidespin");
  if (spin < 0) spin = channel_of(s, "spin_rate");
  std::string what;
  std::vector<std::string> columns;
  const auto input = [&](int k) -> double& {
    columns.push_back(s.inputs[static_cast<std::size_t>(k)].header);
    return s.recorded_inputs(i, k);
  };
  const auto output = [&](int k) -> double& {
    columns.push_back(s.channels[static_cast<std::size_t>(k)].header);
    return s.recorded_outputs(i, k);
  };
  switch (random.below(3)) {
    case 0: {
      what = "unit slip";
      const double other = s.channels[0].unit == 1.0 ? 1 / 0.44704 : s.channels[0].unit > 0.4 ? 0.44704 : 1 / 3.6;
      switch (random.below(5)) {
        case 0: {
          double& v = output(ball);
          v = round_to(v * other, 0.1);
          break;
        }
        case 1: {
          double& v = input(speed);
          v = round_to(v * other, 0.1);
          break;
        }
        case 2: {
          double& v = input(loft);
          v = round_to(v * M_PI / 180, 0.001);
          break;
        }
        case 3: {
          double& v = output(spin);
          v = round_to(v * M_PI / 30, 1);
          break;
        }
        default: {
          double& v = output(launch);
          v = round_to(v * M_PI / 180, 0.001);
          break;
        }
      }
      break;
    }
    case 1: {
      what = "swapped columns";
      switch (random.below(4)) {
        case 0: std::swap(input(attack), input(loft)); break;
        case 1:
          if (azimuth < 0) return false;
          std::swap(output(launch), output(azimuth));
          break;
        case 2:
          if (side < 0) return false;
          std::swap(output(spin), output(side));
          break;
        default: std::swap(input(speed), output(ball)); break;
      }
      break;
    }
    default: {
      what = "digit transposition";
      switch (random.below(4)) {
        case 0: {
          double& v = output(ball);
          v = transposed(v, 0.1, random);
          break;
        }
        case 1: {
          double& v = output(spin);
          v = transposed(v, 1, random);
          break;
        }
        case 2: {
          double& v = input(speed);
          v = transposed(v, s.inputs[static_cast<std::size_t>(speed)].resolution, random);
          break;
        }
        default: {
          double& v = input(loft);
          v = transposed(v, s.inputs[static_cast<std::size_t>(loft)].resolution, random);
          break;
        }
      }
    }
  }
  const bool finite = s.recorded_outputs.row(i).allFinite();
  // Size of the damage: the row's misfit, in units of its own noise.
  bool large = false;
  if (finite && outputs.allFinite()) {
    const auto swings = recorded_swings(s);
    const std::vector<Swing> one{swings[static_cast<std::size_t>(i)]}, was{s.swings[static_cast<std::size_t>(i)]};
    try {
      Session single = s;
      single.swings = was;
      single.head_mass_kg = {s.head_mass_kg[static_cast<std::size_t>(i)]};
      const Eigen::RowVectorXd misfit = s.recorded_outputs.row(i) - predict(single, one, base_truth(s)).row(0);
      const auto w = whitening(single, was);
      large = (w[0] * misfit.transpose()).norm() >= least;
    } catch (const std::domain_error&) {
      large = true;  // the head would recede from the ball: nothing could be plainer
    }
  }
  if (!large) {
    s.recorded_inputs.row(i) = inputs;
    s.recorded_outputs.row(i) = outputs;
    return false;
  }
  notes.push_back({{"shot", i + 1}, {"what", what}, {"columns", columns}});
  return true;
}

Json spoil_rows(Session& s, double share, double least, Random& random) {
  Json notes = Json::array();
  std::vector<int> rows = all_rows(s);
  const int wanted = std::max(1, static_cast<int>(std::round(share * s.shots())));
  for (int k = 0; k < wanted; ++k) {
    const int pick = random.below(static_cast<int>(rows.size()));
    for (int attempt = 0; attempt < 40; ++attempt)
      if (spoil(s, rows[static_cast<std::size_t>(pick)], random, least, notes)) break;
    rows.erase(rows.begin() + pick);
  }
  return notes;
}

/// A whole cluster whose column holds something else.
Json spoil_cluster(Session& s, Random& random) {
  const int club = random.below(static_cast<int>(s.cluster_names.size()));
  const int loft = column_of(s, "dynamic_loft"), speed = column_of(s, "club_speed"),
            spin = std::max(channel_of(s, "backspin"), channel_of(s, "spin_rate"));
  const int kind = random.below(4);
  std::string what, column;
  Json rows = Json::array();
  for (int i = 0; i < s.shots(); ++i) {
    if (s.cluster[static_cast<std::size_t>(i)] != club) continue;
    rows.push_back(i + 1);
    double& l = s.recorded_inputs(i, loft);
    double& v = s.recorded_inputs(i, speed);
    switch (kind) {
      case 0:
        what = "complement of the loft";
        column = s.inputs[static_cast<std::size_t>(loft)].header;
        l = round_to(90 - l, 0.1);
        break;
      case 1:
        what = "lie angle for the loft";
        column = s.inputs[static_cast<std::size_t>(loft)].header;
        l = round_to(60 + 1.0 * random.normal(), 0.1);
        break;
      case 2:
        what = "another unit of speed";
        column = s.inputs[static_cast<std::size_t>(speed)].header;
        v = round_to(v * (s.inputs[static_cast<std::size_t>(speed)].unit == 1.0 ? 2.236936 : 0.44704), 0.1);
        break;
      default:
        what = "spin a tenth";
        column = s.channels[static_cast<std::size_t>(spin)].header;
        s.recorded_outputs(i, spin) = round_to(s.recorded_outputs(i, spin) / 10, 1);
        break;
    }
  }
  return {{"what", what},
          {"columns", {column}},
          {"cluster", s.cluster_names[static_cast<std::size_t>(club)]},
          {"rows", rows}};
}

/// One column, or two, wrong from top to bottom: plainly, and where neither a slip of another column nor a name of the
/// contract, of any size, comes near.
Json spoil_column(Session& s, const Eigen::MatrixXd& outputs, int which, Random& random) {
  const auto slip = draw_slip(s, which, random);
  if (!slip) throw Redraw{};
  Json key = {{"slip", slip->slip}, {"columns", slip->columns}};
  Session misread = s;
  Eigen::MatrixXd inputs(s.shots(), static_cast<int>(s.inputs.size())), seen = outputs;
  for (int i = 0; i < s.shots(); ++i)
    for (std::size_t k = 0; k < s.inputs.size(); ++k)
      inputs(i, static_cast<int>(k)) = s.swings[static_cast<std::size_t>(i)].*s.inputs[k].member / s.inputs[k].unit;
  slip->apply(inputs, seen);
  misread.recorded_inputs = inputs;
  misread.swings = recorded_swings(misread);
  const auto w = whitening(s, s.swings);
  bool possible = true;
  try {
    const SlipDistance d = distance(misread, misread.swings, seen, w, *slip);
    if (d.base < 12 || d.other < 6) throw Redraw{};
    key["s"] = d.base;
    key["other"] = d.other;
  } catch (const std::domain_error&) { possible = false; }  // such blows miss: nothing could be plainer
  if (possible) {
    Geometry g(misread);
    g.w = w;
    g.bounded = false;
    const Rival rival = nearest(g, seen, {}, {&calibration()}, {}, 9);
    if (rival.distance < 9) throw Redraw{};
    key["a"] = rival.distance;
    key["rival"] = rival.effect;
  }
  slip->apply(s.recorded_inputs, s.recorded_outputs);
  return key;
}

// ---- outside the vocabulary ------------------------------------------------------------------------------

struct Outside {
  std::string name;
  int channel;
  std::vector<std::string> columns;  ///< any of them is right; empty where no column drives it
  double factor = 0;                 ///< size by nature; zero: scaled to the wanted signal
};

/// A change of the outputs that no name of the contract means, of unit size in noise deviations.
Outside invent(int which, Session& s, const Eigen::MatrixXd& outputs, Eigen::MatrixXd& change, Random& random) {
  const int n = s.shots(), m = static_cast<int>(s.channels.size());
  change = Eigen::MatrixXd::Zero(n, m);
  const auto sd = [&](int c) { return s.channels[static_cast<std::size_t>(c)].noise_sd; };
  const int any = random.below(m);
  int spin = channel_of(s, "backspin");
  if (spin < 0) spin = channel_of(s, "spin_rate");
  const auto extra = [&](const std::string& name) -> Extra& {
    std::erase_if(s.extras, [&](const Extra& e) { return e.header == name; });
    s.extras.push_back({name, {}});
    return s.extras.back();
  };
  switch (which) {
    case 0: {
      const double cycles = random.uniform(2, 5), phase = random.uniform(0, 2 * M_PI);
      for (int i = 0; i < n; ++i) change(i, any) = sd(any) * std::sin(2 * M_PI * cycles * i / n + phase);
      return {"oscillation with the shot", any, {"shot"}};
    }
    case 1: {
      const int at = static_cast<int>(random.uniform(0.3, 0.7) * n);
      for (int i = at; i < n; ++i) change(i, any) = sd(any);
      return {"jump at a shot", any, {"shot"}};
    }
    case 2: {
      Extra& e = extra("humidity_pct");
      for (int i = 0; i < n; ++i) {
        const double z = random.bounded_normal();
        e.cells.push_back(fmt::format("{:.0f}", 55 + 12 * z));
        change(i, spin) = -sd(spin) * z;
      }
      return {"humidity", spin, {"humidity_pct"}};
    }
    case 3: {
      // The monitor reports nothing below a threshold about the median.
      const int c = channel_of(s, "launch");
      Eigen::VectorXd y = outputs.col(c);
      std::vector<double> sorted(y.data(), y.data() + n);
      std::sort(sorted.begin(), sorted.end());
      const double centre = sorted[static_cast<std::size_t>(n / 2)];
      const double half = 0.5 * (sorted[static_cast<std::size_t>(3 * n / 4)] - sorted[static_cast<std::size_t>(n / 4)]);
      for (int i = 0; i < n; ++i)
        if (std::abs(y[i] - centre) < half) change(i, c) = centre - y[i];
      return {"dead band", c, {}, 1.0};
    }
    case 4: {
      for (int i = 0; i < n; ++i)
        if (random.chance(0.4)) change(i, spin) = sd(spin);
      return {"two kinds of ball, not recorded", spin, {}, random.sign() * random.uniform(5, 9)};
    }
    case 5: {
      const int c = m > 3 ? channel_of(s, "azimuth") : channel_of(s, "launch");
      Extra& e = extra("wind_mps");
      for (int i = 0; i < n; ++i) {
        const double gust = std::max(0.0, random.normal());
        e.cells.push_back(fmt::format("{:.1f}", 4 * gust));
        change(i, c) = sd(c) * gust;
      }
      return {"wind gusts", c, {"wind_mps"}};
    }
    case 6: {
      const int c = m > 3 ? channel_of(s, "azimuth") : channel_of(s, "launch");
      Extra& e = extra("grip_ex_x");
      for (int i = 0; i < n; ++i) {
        const double z = random.bounded_normal();
        e.cells.push_back(fmt::format("{:.2f}", z));
        change(i, c) = sd(c) * z;
      }
      return {"grip turn", c, {"grip_ex_x"}};
    }
    case 7: {
      std::vector<double> sorted(outputs.col(spin).data(), outputs.col(spin).data() + n);
      std::sort(sorted.begin(), sorted.end());
      const double knee = sorted[static_cast<std::size_t>(0.6 * n)];
      for (int i = 0; i < n; ++i) change(i, spin) = -std::max(0.0, outputs(i, spin) - knee);
      return {"saturated spin reading", spin, {}, random.uniform(0.5, 0.9)};
    }
    case 8: {
      const int c = random.chance(0.5) ? spin : channel_of(s, "launch");
      for (int i = 1; i < n; ++i) change(i, c) = outputs(i - 1, c) - outputs(i, c);
      return {"reading lags behind", c, {}, random.uniform(0.3, 0.6)};
    }
    default: {
      Extra& e = extra("ball");
      const int c = any;
      for (int i = 0; i < n; ++i) {
        const int kind = random.below(3);
        e.cells.push_back(std::string(1, static_cast<char>('A' + kind)));
        change(i, c) = sd(c) * (kind == 1 ? 1 : kind == 2 ? -0.6 : 0);
      }
      return {"kind of ball, recorded", c, {"ball"}};
    }
  }
}

// ---- derived columns -------------------------------------------------------------------------------------

/// Overwrites or adds a column computed from others, rounded to its resolution.
Json derive(Session& s, int which, Random& random) {
  const int n = s.shots();
  const int loft = column_of(s, "dynamic_loft"), speed = column_of(s, "club_speed"), attack = column_of(s, "attack");
  const int ball = channel_of(s, "ball_speed"), launch = channel_of(s, "launch");
  int spin = channel_of(s, "backspin");
  if (spin < 0) spin = channel_of(s, "spin_rate");
  const auto in = [&](int k) { return s.inputs[static_cast<std::size_t>(k)].header; };
  const auto out = [&](int k) { return s.channels[static_cast<std::size_t>(k)].header; };
  switch (which % 5) {
    case 0: {  // the loft from the launch, as a linear rule of the instrument
      const double k = random.uniform(0.045, 0.057) / s.channels[static_cast<std::size_t>(ball)].unit;
      for (int i = 0; i < n; ++i)
        s.recorded_inputs(i, loft) = round_to(
            s.recorded_outputs(i, launch) + k * s.recorded_outputs(i, spin) / s.recorded_outputs(i, ball), 0.1);
      return {{"column", in(loft)}, {"from", {out(launch), out(spin), out(ball)}}};
    }
    case 1: {  // the club speed from the ball speed and a fixed smash factor
      const double smash = random.uniform(1.36, 1.48);
      for (int i = 0; i < n; ++i) s.recorded_inputs(i, speed) = round_to(s.recorded_outputs(i, ball) / smash, 0.1);
      s.inputs[static_cast<std::size_t>(speed)].resolution = 0.1;
      return {{"column", in(speed)}, {"from", {out(ball)}}};
    }
    case 2: {  // a further column: spin loft
      Extra e{"spin_loft_deg", {}};
      for (int i = 0; i < n; ++i)
        e.cells.push_back(fmt::format("{:.1f}", s.recorded_inputs(i, loft) - s.recorded_inputs(i, attack)));
      s.extras.push_back(e);
      return {{"column", "spin_loft_deg"}, {"from", {in(loft), in(attack)}}};
    }
    case 3: {  // a further column: smash factor
      Extra e{"smash_factor", {}};
      for (int i = 0; i < n; ++i)
        e.cells.push_back(fmt::format("{:.2f}", s.recorded_outputs(i, ball) / s.recorded_inputs(i, speed)));
      s.extras.push_back(e);
      return {{"column", "smash_factor"}, {"from", {out(ball), in(speed)}}};
    }
    default: {  // the face angle from the azimuth and the path; on the planar base the launch from loft and attack
      const int face = column_of(s, "face_angle"), path = column_of(s, "club_path"), azimuth = channel_of(s, "azimuth");
      if (face < 0) {
        for (int i = 0; i < n; ++i)
          s.recorded_outputs(i, launch) =
              round_to(0.85 * s.recorded_inputs(i, loft) + 0.15 * s.recorded_inputs(i, attack), 0.1);
        return {{"column", out(launch)}, {"from", {in(loft), in(attack)}}};
      }
      const double k = random.uniform(0.78, 0.86);
      for (int i = 0; i < n; ++i)
        s.recorded_inputs(i, face) =
            round_to((s.recorded_outputs(i, azimuth) - (1 - k) * s.recorded_inputs(i, path)) / k, 0.1);
      return {{"column", in(face)}, {"from", {out(azimuth), in(path)}}};
    }
  }
}

// ---- the strata ------------------------------------------------------------------------------------------

std::vector<const Form*> applicable(const std::string& base, const std::vector<Form>& forms) {
  std::vector<const Form*> list;
  for (const Form& f : forms)
    if (base == "rigid-planar" ? f.planar : f.eccentric) list.push_back(&f);
  return list;
}

Json describe(const Form& f, const std::vector<double>& x) {
  Json p = Json::array();
  for (std::size_t k = 0; k < x.size(); ++k)
    p.push_back({{"name", f.parameters[k].name}, {"value", x[k]}, {"unit", f.parameters[k].unit}});
  return {{"effect", f.effect}, {"form", f.form}, {"parameters", p}};
}

Set attempt(std::uint64_t seed, const std::string& stratum, int shots, int index, int draw) {
  Random random(mix(mix(mix(mix(seed, stratum), static_cast<std::uint64_t>(shots)), static_cast<std::uint64_t>(index)),
                    static_cast<std::uint64_t>(draw)));
  Set set;
  set.stratum = stratum;
  set.seed = seed;
  set.shots = shots;
  set.index = index;
  set.name = fmt::format(
      "s{:08x}",
      mix(mix(mix(seed, stratum), static_cast<std::uint64_t>(shots)), static_cast<std::uint64_t>(index)) & 0xffffffffu);

  SessionOptions o{random.chance(0.35) ? "rigid-planar" : "rigid-eccentric", shots};
  o.clusters = random.chance(0.3);
  o.input_noise = stratum == "null-input-noise" ||
                  (stratum != "derived" && stratum != "mostly-computed" && random.chance(0.3));
  // Every name in turn; a name that this seed's sessions cannot separate gives way to the next.
  const Form* chosen = nullptr;
  if (stratum == "one-effect" || stratum == "confounded") {
    const auto& forms = natural_forms();
    chosen = &forms[static_cast<std::size_t>(index + draw / 6) % forms.size()];
  } else if (stratum == "other-form") {
    const auto& forms = other_forms();
    chosen = &forms[static_cast<std::size_t>(index + draw / 6) % forms.size()];
  }
  if (chosen && !(o.base == "rigid-planar" ? chosen->planar : chosen->eccentric))
    o.base = chosen->planar ? "rigid-planar" : "rigid-eccentric";
  if (chosen && chosen->effect == "head-rotation")
    o.impact_spread = random.uniform(0.05, 0.4) * std::sqrt(100.0 / shots);
  // Two names at random; friction wants the lofts where a ball slides.
  const Form *first = nullptr, *second = nullptr;
  if (stratum == "two-effects" || stratum == "two-and-outside") {
    const auto forms = applicable(o.base, natural_forms());
    first = forms[static_cast<std::size_t>(random.below(static_cast<int>(forms.size())))];
    second = forms[static_cast<std::size_t>(random.below(static_cast<int>(forms.size())))];
    if (first == second || first->effect == "head-rotation" || second->effect == "head-rotation") throw Redraw{};
  }
  for (const Form* f : {chosen, first, second})
    if (f && f->effect == "friction-limit") o.wedge = true;
  const int kind = index % 4;  // of the bad-row sets: every fourth has a whole club
  if (stratum == "null-club-effects" || (stratum == "bad-rows" && kind == 3)) o.clusters = true;

  set.session = draw_session(o, random);
  Session& s = set.session;
  if (stratum == "null-club-effects") s.split_by_cluster = true;
  Json key = {{"set", set.name}, {"stratum", stratum},          {"seed", seed}, {"shots", shots}, {"index", index},
              {"base", s.base},  {"input_noise", o.input_noise}};
  Eigen::MatrixXd outputs = predict(s, s.swings, base_truth(s));
  Noise noise = stratum == "null-heavy-tails"      ? Noise::heavy
                : stratum == "null-growing-spread" ? Noise::growing
                : stratum == "null-drifting-noise" ? Noise::drifting
                                                   : Noise::plain;

  if (stratum == "one-effect" || stratum == "other-form") {
    const Geometry g(s);
    const Form& f = *chosen;
    const auto nuisance = absorbed(f.effect);
    const double wanted = random.chance(0.5) ? 8 : 10;
    std::vector<double> x;
    if (f.effect == "head-rotation") {
      x = {1.0};
    } else {
      const auto found = scaled(g, f, wanted, nuisance, random);
      if (!found) throw Redraw{};
      x = *found;
    }
    outputs = g.outputs({f}, {x});
    const double signal = g.distance(outputs, nuisance);
    if (f.effect == "head-rotation" && (signal < 7.5 || signal > 11)) throw Redraw{};
    const double floor = 4.8;
    const Rival rival = nearest(g, outputs, {f.effect}, nuisance, {}, floor);
    if (rival.distance < floor) throw Redraw{};
    if (stratum == "other-form") {
      // Fair only where the natural form of the same name is much nearer than any other name.
      for (const Form& same : natural_forms())
        if (same.effect == f.effect) {
          std::vector<const Form*> forms{&same};
          if (f.effect != "restitution-law") forms.push_back(&calibration());
          const double own = g.distance(outputs, forms);
          if (own > 0.5 * rival.distance) throw Redraw{};
          key["own_natural_form"] = own;
        }
    }
    set.hidden = {f};
    set.value = {x};
    key["s"] = signal;
    key["a"] = rival.distance;
    key["rival"] = rival.effect;
  } else if (stratum == "confounded") {
    // Without calibration: confounded then, and the more so with it.
    const Geometry g(s);
    const auto found = scaled(g, *chosen, random.chance(0.5) ? 8 : 10, {}, random);
    if (!found) throw Redraw{};
    outputs = g.outputs({*chosen}, {*found});
    const Rival rival = nearest(g, outputs, {chosen->effect}, {}, {}, 0);
    if (rival.distance >= 3) throw Redraw{};
    set.hidden = {*chosen};
    set.value = {*found};
    key["s"] = g.distance(outputs, {});
    key["a"] = rival.distance;
    key["rival"] = rival.effect;
  } else if (stratum == "two-effects" || stratum == "two-and-outside") {
    const Geometry g(s);
    const Form *a = first, *b = second;
    std::vector<std::vector<double>> x;
    for (const Form* f : {a, b}) {
      const auto found = scaled(g, *f, 8, absorbed(f->effect), random);
      if (!found) throw Redraw{};
      x.push_back(*found);
    }
    outputs = g.outputs({*a, *b}, x);
    const Form known_a = known(*a, x[0]), known_b = known(*b, x[1]);
    Json distances = Json::array();
    const bool law = a->effect == "restitution-law" || b->effect == "restitution-law";
    const std::vector<const Form*> nuisance = law ? std::vector<const Form*>{}
                                                  : std::vector<const Form*>{&calibration()};
    for (const auto& [kept, dropped] : {std::pair{&known_a, b}, std::pair{&known_b, a}}) {
      std::vector<const Form*> alone{kept};
      alone.insert(alone.end(), nuisance.begin(), nuisance.end());
      if (g.distance(outputs, alone) < 4.8) throw Redraw{};
      const Rival rival = nearest(g, outputs, {a->effect, b->effect}, nuisance, {kept}, 4.8);
      if (rival.distance < 4.8) throw Redraw{};
      distances.push_back({{"instead of", dropped->effect}, {"rival", rival.effect}, {"a", rival.distance}});
    }
    const Rival single = nearest(g, outputs, {a->effect, b->effect}, nuisance, {}, 4.8);
    if (single.distance < 4.8) throw Redraw{};
    set.hidden = {known_a, known_b};
    set.value = x;
    key["s"] = 8;
    key["a"] = std::min(distances[0]["a"].get<double>(), distances[1]["a"].get<double>());
    key["distances"] = distances;
    if (stratum == "two-and-outside") {
      // And something that neither a further name nor other sizes of these two come near.
      Eigen::MatrixXd change;
      const Outside what = invent(index % 10, s, outputs, change, random);
      if (train_share * norm(g.w, change) < 1e-9) throw Redraw{};
      const double factor = what.factor != 0 ? what.factor : 16 / (train_share * norm(g.w, change));
      const Rival rival = nearest(g, outputs + factor * change, {}, {&calibration()}, {&known_a, &known_b}, 9);
      if (rival.distance < 9) throw Redraw{};
      outputs += factor * change;
      key["invention"] = what.name;
      key["channel"] = s.channels[static_cast<std::size_t>(what.channel)].header;
      key["columns"] = what.columns;
      key["rival"] = rival.effect;
    }
  } else if (stratum == "outside") {
    const Geometry g(s);
    Eigen::MatrixXd change;
    const Outside what = invent(index % 10, s, outputs, change, random);
    if (train_share * norm(g.w, change) < 1e-9) throw Redraw{};
    // Size: clearly seen, and no name of the contract comes near, even with a calibrated restitution.
    Rival rival;
    double factor = 0;
    for (double wanted = 12; wanted < 30; wanted *= 1.3) {
      factor = what.factor != 0 ? what.factor : wanted / (train_share * norm(g.w, change));
      rival = nearest(g, outputs + factor * change, {}, {&calibration()}, {}, 9);
      if (rival.distance >= 9 || what.factor != 0) break;
    }
    if (rival.distance < 9) throw Redraw{};
    outputs += factor * change;
    key["invention"] = what.name;
    key["channel"] = s.channels[static_cast<std::size_t>(what.channel)].header;
    key["columns"] = what.columns;
    key["s"] = train_share * norm(g.w, factor * change);
    key["a"] = rival.distance;
    key["rival"] = rival.effect;
  } else if (stratum == "mixture") {
    // Two populations without a column that tells them: another ball, player, setting.
    const Geometry g(s);
    std::vector<const Form*> forms;
    for (const Form* f : applicable(s.base, natural_forms()))
      if (f->effect != "friction-limit" && f->effect != "head-rotation" && f->effect != "session-drift")
        forms.push_back(f);
    const Form& f = *forms[static_cast<std::size_t>(random.below(static_cast<int>(forms.size())))];
    const double apart = random.uniform(4.5, 8);  // of the two, per shot, in noise units
    const auto found = scaled(g, f, apart * std::sqrt(s.shots()) * train_share, {}, random);
    if (!found) throw Redraw{};
    const Eigen::MatrixXd other = g.outputs({f}, {*found});
    int far = 0;
    for (int i = 0; i < s.shots(); ++i)
      far += (g.w[static_cast<std::size_t>(i)] * (other - outputs).row(i).transpose()).norm() > 3;
    if (far < 0.9 * s.shots()) throw Redraw{};
    const double share = random.uniform(0.3, 0.7);
    const int arrangement = random.below(3);  // at random, in runs, more and more of the second
    const int run = 2 + random.below(std::max(1, s.shots() / 8));
    int second = 0;
    bool label = false;
    for (int i = 0; i < s.shots(); ++i) {
      const double now = arrangement == 2 ? 2 * share * i / s.shots() : share;
      if (arrangement != 1 || i % run == 0) label = random.chance(now);
      if (!label) continue;
      outputs.row(i) = other.row(i);
      ++second;
    }
    if (second < 0.25 * s.shots() || second > 0.75 * s.shots()) throw Redraw{};
    key["population"] = describe(f, *found);
    key["arrangement"] =
        std::vector<std::string>{"at random", "in runs", "more and more"}[static_cast<std::size_t>(arrangement)];
    key["apart"] = apart;
    key["share"] = static_cast<double>(second) / s.shots();
  } else if (stratum == "null-club-effects") {
    // Every club has its own small offset in every channel: batches, grips, set-up.
    for (std::size_t c = 0; c < s.channels.size(); ++c) {
      std::vector<double> offset;
      for (std::size_t k = 0; k < s.cluster_names.size(); ++k)
        offset.push_back(0.5 * s.channels[c].noise_sd * random.normal());
      for (int i = 0; i < s.shots(); ++i)
        outputs(i, static_cast<int>(c)) += offset[static_cast<std::size_t>(s.cluster[static_cast<std::size_t>(i)])];
    }
  }

  record_inputs(s, random);
  record_outputs(s, outputs, noise, random);
  if (stratum == "null-bad-rows") key["bad_rows"] = spoil_rows(s, 0.05, 8, random);
  if (stratum == "bad-rows") {
    if (kind == 3) {
      const Json club = spoil_cluster(s, random);
      key["bad_cluster"] = club;
      key["bad_rows"] = Json::array();
      for (const auto& row : club["rows"])
        key["bad_rows"].push_back({{"shot", row}, {"what", club["what"]}, {"columns", club["columns"]}});
    } else {
      key["bad_rows"] = spoil_rows(s, random.uniform(0.02, 0.06), 8, random);
    }
  }
  if (stratum == "derived") key["derived"] = derive(s, index, random);
  if (stratum == "mostly-computed") {
    const auto computed = compute_mostly(s, index / 3, random);
    if (!computed) throw Redraw{};
    key["derived"] = *computed;
  }
  if (stratum == "wrong-column") key["slip"] = spoil_column(s, outputs, index / 3, random);
  lose_some(s, random);

  key["hidden"] = Json::array();
  for (std::size_t k = 0; k < set.hidden.size(); ++k) key["hidden"].push_back(describe(set.hidden[k], set.value[k]));
  set.key = key;
  return set;
}

}  // namespace

const std::vector<std::pair<std::string, int>>& strata() {
  static const std::vector<std::pair<std::string, int>> list{{"null", 400},
                                                             {"null-input-noise", 100},
                                                             {"null-heavy-tails", 100},
                                                             {"null-growing-spread", 100},
                                                             {"null-drifting-noise", 100},
                                                             {"null-bad-rows", 100},
                                                             {"null-club-effects", 100},
                                                             {"one-effect", 300},
                                                             {"other-form", 100},
                                                             {"two-effects", 100},
                                                             {"confounded", 100},
                                                             {"outside", 100},
                                                             {"bad-rows", 100},
                                                             {"derived", 50},
                                                             {"wrong-column", 200},
                                                             {"mixture", 100},
                                                             {"mostly-computed", 100},
                                                             {"two-and-outside", 100}};
  return list;
}

Set make_set(std::uint64_t seed, const std::string& stratum, int shots, int index) {
  if (std::none_of(strata().begin(), strata().end(), [&](const auto& s) { return s.first == stratum; }))
    throw std::invalid_argument("no stratum '" + stratum + "'");
  for (int draw = 0; draw < 400; ++draw) {
    try {
      return attempt(seed, stratum, shots, index, draw);
    } catch (const Redraw&) {
    } catch (const std::domain_error&) {  // a blow that misses: not a shot that anyone recorded
    }
  }
  throw std::runtime_error(fmt::format("no draw of {} {} with {} shots meets its conditions", stratum, index, shots));
}

}  // namespace examination
