/// Drag, lift and loss of spin of a ball in flight, as data: what a paper printed, where it holds, who printed it.
///
/// With the air's speed v past the ball, F_D = 1/2 rho A C_D v^2 against it and F_L = 1/2 rho A C_L v^2 along
/// spin x v (with its sine: spin along the path lifts nothing). Re = rho v d / mu; S = spin r / v of the whole spin.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hosel::models {

template <class T>
struct Coefficients {
  T drag, lift;
};

/// C_D = d0 + d1 S + d2 S^2 + e1 Re + e2 Re^2 and C_L = l0 + l1 S + l2 S^2.
struct PolynomialLaw {
  std::array<double, 3> drag{}, lift{};
  std::array<double, 2> drag_reynolds{};

  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin) const {
    return {drag[0] + spin * (drag[1] + spin * drag[2]) + reynolds * (drag_reynolds[0] + reynolds * drag_reynolds[1]),
            lift[0] + spin * (lift[1] + spin * lift[2])};
  }
};

/// C_L = (linear + quadratic S) S up to `level_from`, level beyond.
struct QuadraticLift {
  double linear, quadratic, level_from;

  template <class T>
  T at(const T& spin) const {
    return spin > level_from ? T((linear + quadratic * level_from) * level_from)
                             : T((linear + quadratic * spin) * spin);
  }
};

/// C_L = factor S^power.
struct PowerLift {
  double factor, power;

  template <class T>
  T at(const T& spin) const {
    using std::pow;
    return factor * pow(spin, power);
  }
};

/// C_L = most gain S / (1 + gain S).
struct SaturatingLift {
  double most, gain;

  template <class T>
  T at(const T& spin) const {
    return most * gain * spin / (1.0 + gain * spin);
  }
};

/// C_D = d0 + d1 S + d2 sin(pi (Re - start) / span).
struct SineLaw {
  double drag, drag_spin, drag_wave, start, span;
  PowerLift lift;

  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin) const {
    using std::sin;
    return {drag + drag_spin * spin + drag_wave * sin(3.14159265358979323846 * (reynolds - start) / span),
            lift.at(spin)};
  }
};

/// C_D = slow + (fast - slow) (Re - from) / (to - from) + drag_spin S, level in Re outside `from` and `to`.
struct RampLaw {
  double slow, fast, from, to, drag_spin;
  std::variant<QuadraticLift, PowerLift, SaturatingLift> lift;

  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin) const {
    const T share = reynolds <= from ? T(0.0) : reynolds >= to ? T(1.0) : T((reynolds - from) / (to - from));
    return {slow + (fast - slow) * share + drag_spin * spin,
            std::visit([&](const auto& law) { return law.at(spin); }, lift)};
  }
};

/// Inferred from measured flights. Inside its window, with s = ln(S / 0.1) and x = ln(Re / 1.4e5), each coefficient is
/// c0 + c1 s + c2 s^2 + c3 x + c4 x^2 + c5 s x; beyond the window's margins a published law, and across each margin a
/// quintic step between the two, so that value, slope and curvature are continuous there.
struct SurfaceLaw {
  static constexpr double kSpin = 0.1, kReynolds = 1.4e5;  ///< where s and x are zero
  using Terms = std::array<double, 6>;
  /// The surface holds between `from` and `to`, the published law below `none_below` and above `none_above`.
  struct Window {
    double none_below, from, to, none_above;

    template <class T>
    T share(const T& at) const {
      if (at <= none_below || at >= none_above) return T(0.0);
      if (at < from) return step(T((at - none_below) / (from - none_below)));
      if (at > to) return step(T((none_above - at) / (none_above - to)));
      return T(1.0);
    }

   private:
    template <class T>
    static T step(const T& t) {
      return t * t * t * (10.0 + t * (6.0 * t - 15.0));
    }
  };
  Terms drag{}, lift{};
  Window reynolds, spin;
  RampLaw outside;

  template <class T>
  Coefficients<T> at(const T& re, const T& s) const {
    const T share = reynolds.share(re) * spin.share(s);
    if (share <= 0.0) return outside.at(re, s);
    using std::log;
    const T x = log(re / kReynolds), y = log(s / kSpin);
    const auto surface = [&](const Terms& c) {
      return T(c[0] + y * (c[1] + c[2] * y + c[5] * x) + x * (c[3] + c[4] * x));
    };
    const Coefficients<T> in = {surface(drag), surface(lift)};
    if (share >= 1.0) return in;
    const Coefficients<T> out = outside.at(re, s);
    return {out.drag + share * (in.drag - out.drag), out.lift + share * (in.lift - out.lift)};
  }
};

/// Measured coefficients: a row a Reynolds number, each with its own spin ratios. Straight lines between; beyond the
/// outermost values these hold.
struct TableLaw {
  struct Row {
    double reynolds;
    std::vector<double> spin, drag, lift;  ///< of one length; spin ratios rise
  };
  std::vector<Row> rows;  ///< Reynolds numbers rise

  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin) const {
    const auto along = [](const std::vector<double>& x, const std::vector<double>& y, const T& where) {
      if (where <= x.front()) return T(y.front());
      if (where >= x.back()) return T(y.back());
      std::size_t i = 1;
      while (where > x[i]) ++i;
      return T(y[i - 1] + (y[i] - y[i - 1]) / (x[i] - x[i - 1]) * (where - x[i - 1]));
    };
    const auto row = [&](const Row& r) {
      return Coefficients<T>{along(r.spin, r.drag, spin), along(r.spin, r.lift, spin)};
    };
    if (reynolds <= rows.front().reynolds) return row(rows.front());
    if (reynolds >= rows.back().reynolds) return row(rows.back());
    std::size_t i = 1;
    while (reynolds > rows[i].reynolds) ++i;
    const Coefficients<T> low = row(rows[i - 1]), high = row(rows[i]);
    const T share = (reynolds - rows[i - 1].reynolds) / (rows[i].reynolds - rows[i - 1].reynolds);
    return {low.drag + share * (high.drag - low.drag), low.lift + share * (high.lift - low.lift)};
  }
  bool holds(double reynolds, double spin) const;  ///< inside what was measured
  /// Sentences on what is wrong with the table; empty where all is well.
  std::vector<std::string> faults() const;
};

/// spin' = -(rate + travel v / r + rho A d r v moment / (2 I)) spin; a published law uses one of the three.
struct SpinDecay {
  double rate = 0;    ///< [1/s]
  double travel = 0;  ///< per radius of path
  double moment = 0;  ///< of C_M = moment S, with M = 1/2 rho A d C_M v^2
};

struct FlightLaw {
  std::string name, source;
  struct Range {
    double low, high;
  };
  Range reynolds, spin;  ///< where the source has it measured
  std::variant<PolynomialLaw, SineLaw, RampLaw, TableLaw, SurfaceLaw> form;
  SpinDecay decay;
  double drag_scale = 1, lift_scale = 1;
  /// Of a law that was inferred: the covariance of its coefficients (`inferred_coefficient`), rows one after the other.
  std::vector<double> covariance = {};

  bool holds(double re, double s) const;  ///< inside what the source has measured
  template <class T>
  Coefficients<T> at(const T& re, const T& s) const {
    Coefficients<T> c = std::visit([&](const auto& law) { return law.at(re, s); }, form);
    c.drag *= drag_scale;
    c.lift *= lift_scale;
    return c;
  }
};

/// Drag's six terms, lift's six, then the decay of spin per radius of path.
inline constexpr int kInferredCoefficients = 13;
std::string_view inferred_coefficient_name(int k);
/// Of a law whose form is a SurfaceLaw; std::bad_variant_access for any other.
double& inferred_coefficient(FlightLaw& law, int k);

struct FlightLawEntry {
  std::string_view name, what;
  FlightLaw (*make)();
};
/// The published laws. Adding one: its function and a line in flight_laws.cpp.
std::span<const FlightLawEntry> flight_laws();
const FlightLawEntry* find_flight_law(std::string_view name);  ///< nullptr where there is none

}  // namespace hosel::models
