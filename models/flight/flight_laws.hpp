/// Drag, lift and loss of spin of a ball in flight, as data: published formula, range and source.
///
/// With the air's speed v past the ball, F_D = 1/2 rho A C_D v^2 against it and F_L = 1/2 rho A C_L v^2 along
/// spin x v (with its sine: spin along the path lifts nothing). Re = rho v d / mu; S = spin r / v of the whole spin.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace hosel::models {

template <class T>
struct Coefficients {
  T drag, lift;
};

// A law has corners where its formula changes. `piece` numbers the parts of the plane between them; `at` with a piece
// is that part's formula, also beyond its edges, so that a step up to a corner sees none.

/// C_D = d0 + d1 S + d2 S^2 + e1 Re + e2 Re^2 and C_L = l0 + l1 S + l2 S^2.
struct PolynomialLaw {
  std::array<double, 3> drag{}, lift{};
  std::array<double, 2> drag_reynolds{};

  static long piece(double, double) { return 0; }
  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin, long) const {
    return {drag[0] + spin * (drag[1] + spin * drag[2]) + reynolds * (drag_reynolds[0] + reynolds * drag_reynolds[1]),
            lift[0] + spin * (lift[1] + spin * lift[2])};
  }
};

/// C_L = (linear + quadratic S) S up to `level_from`, level beyond.
struct QuadraticLift {
  double linear, quadratic, level_from;

  long piece(double spin) const { return spin > level_from; }
  template <class T>
  T at(const T& spin, long piece) const {
    return piece ? T((linear + quadratic * level_from) * level_from) : T((linear + quadratic * spin) * spin);
  }
};

/// C_L = factor S^power.
struct PowerLift {
  double factor, power;

  static long piece(double) { return 0; }
  template <class T>
  T at(const T& spin, long) const {
    using std::pow;
    return factor * pow(spin, power);
  }
};

/// C_L = most gain S / (1 + gain S).
struct SaturatingLift {
  double most, gain;

  static long piece(double) { return 0; }
  template <class T>
  T at(const T& spin, long) const {
    return most * gain * spin / (1.0 + gain * spin);
  }
};

/// C_D = d0 + d1 S + d2 sin(pi (Re - start) / span).
struct SineLaw {
  double drag, drag_spin, drag_wave, start, span;
  PowerLift lift;

  static long piece(double, double) { return 0; }
  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin, long) const {
    using std::sin;
    return {drag + drag_spin * spin + drag_wave * sin(3.14159265358979323846 * (reynolds - start) / span),
            lift.at(spin, 0)};
  }
};

/// C_D = slow + (fast - slow) (Re - from) / (to - from) + drag_spin S, level in Re outside `from` and `to`.
struct RampLaw {
  double slow, fast, from, to, drag_spin;
  std::variant<QuadraticLift, PowerLift, SaturatingLift> lift;

  static constexpr long kPieces = 6;  ///< below, on and above the ramp, each with two of the lift
  long piece(double reynolds, double spin) const {
    return 2 * (reynolds <= from ? 0
                : reynolds >= to ? 2
                                 : 1) +
           std::visit([&](const auto& law) { return law.piece(spin); }, lift);
  }
  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin, long piece) const {
    const long of_ramp = piece / 2;
    const T share = of_ramp == 0 ? T(0.0) : of_ramp == 2 ? T(1.0) : T((reynolds - from) / (to - from));
    return {slow + (fast - slow) * share + drag_spin * spin,
            std::visit([&](const auto& law) { return law.at(spin, piece % 2); }, lift)};
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

    /// 2: inside; 1 and 3: the margins; 0 and 4: beyond them.
    long piece(double at) const { return (at > none_below) + (at >= from) + (at > to) + (at >= none_above); }
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

  long piece(double re, double s) const {
    const long a = reynolds.piece(re), b = spin.piece(s);
    return (5 * a + b) * RampLaw::kPieces + (a == 2 && b == 2 ? 0 : outside.piece(re, s));
  }
  template <class T>
  Coefficients<T> at(const T& re, const T& s, long piece) const {
    const long of_windows = piece / RampLaw::kPieces, a = of_windows / 5, b = of_windows % 5;
    const auto published = [&] { return outside.at(re, s, piece % RampLaw::kPieces); };
    if (a == 0 || a == 4 || b == 0 || b == 4) return published();
    using std::log;
    const T x = log(re / kReynolds), y = log(s / kSpin);
    const auto surface = [&](const Terms& c) {
      return T(c[0] + y * (c[1] + c[2] * y + c[5] * x) + x * (c[3] + c[4] * x));
    };
    Coefficients<T> in = {surface(drag), surface(lift)};
    if (a == 2 && b == 2) return in;
    const T share = reynolds.share(re) * spin.share(s);
    const Coefficients<T> out = published();
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

  /// The cell: how many Reynolds numbers lie below, and how many spin ratios of the rows on either side.
  long piece(double reynolds, double spin) const {
    long row = 0;
    for (const Row& r : rows) row += reynolds > r.reynolds;
    const auto place = [&](std::size_t i) {
      long n = 0;
      for (const double x : rows[i].spin) n += spin > x;
      return n;
    };
    const auto [low, high] = rows_beside(row);
    return (row * kMost + place(low)) * kMost + place(high);
  }
  template <class T>
  Coefficients<T> at(const T& reynolds, const T& spin, long piece) const {
    const auto row = [&](const Row& r, std::size_t i) {
      if (i == 0) return Coefficients<T>{T(r.drag.front()), T(r.lift.front())};
      if (i == r.spin.size()) return Coefficients<T>{T(r.drag.back()), T(r.lift.back())};
      const T share = (spin - r.spin[i - 1]) / (r.spin[i] - r.spin[i - 1]);
      return Coefficients<T>{r.drag[i - 1] + share * (r.drag[i] - r.drag[i - 1]),
                             r.lift[i - 1] + share * (r.lift[i] - r.lift[i - 1])};
    };
    const auto [below, above] = rows_beside(piece / (kMost * kMost));
    Coefficients<T> low = row(rows[below], std::size_t(piece / kMost % kMost));
    if (below == above) return low;
    const Coefficients<T> high = row(rows[above], std::size_t(piece % kMost));
    const T share = (reynolds - rows[below].reynolds) / (rows[above].reynolds - rows[below].reynolds);
    return {low.drag + share * (high.drag - low.drag), low.lift + share * (high.lift - low.lift)};
  }
  bool holds(double reynolds, double spin) const;  ///< inside what was measured
  /// Sentences on what is wrong with the table; empty where all is well.
  std::vector<std::string> faults() const;

 private:
  static constexpr long kMost = 1 << 16;  ///< more than a row has spin ratios
  /// The two rows between which a Reynolds number lies that `below` of them are under; twice the same at the ends.
  std::pair<std::size_t, std::size_t> rows_beside(long below) const {
    const auto n = std::size_t(below), last = rows.size() - 1;
    return {n == 0 ? 0 : n - 1, n > last ? last : n};
  }
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
  long piece(double re, double s) const {
    return std::visit([&](const auto& law) { return law.piece(re, s); }, form);
  }
  template <class T>
  Coefficients<T> at(const T& re, const T& s, long piece) const {
    Coefficients<T> c = std::visit([&](const auto& law) { return law.at(re, s, piece); }, form);
    c.drag *= drag_scale;
    c.lift *= lift_scale;
    return c;
  }
  Coefficients<double> at(double re, double s) const { return at(re, s, piece(re, s)); }
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
