/// Several numbers side by side in vector registers, so that one formula serves a number and several of them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstring>

namespace hosel {

inline constexpr int kLanes = 4;
/// One number of each of `kLanes` points. Operators work lane by lane (an extension of GCC and Clang).
using Lanes = double __attribute__((vector_size(8 * kLanes)));

inline void load(Lanes& to, const double* from) { std::memcpy(&to, from, sizeof to); }
inline void store(double* to, const Lanes& from) { std::memcpy(to, &from, sizeof from); }

/// A function of Eigen's arrays on the lanes.
template <class F>
Lanes by_array(const Lanes& x, F f) {
  Eigen::Array<double, kLanes, 1> in;
  store(in.data(), x);
  const Eigen::Array<double, kLanes, 1> out = f(in);
  Lanes y;
  load(y, out.data());
  return y;
}

/// `Lanes` as a scalar of Eigen's matrices. A lane's result does not depend on its neighbours.
struct Pack {
  using Mask = decltype(Lanes{} < Lanes{});  ///< -1 where true, else 0

  Pack() = default;
  Pack(double x) : v(x - Lanes{}) {}  // every lane
  Pack(const Lanes& x) : v(x) {}

  Pack operator-() const { return -v; }
  friend Pack operator+(const Pack& a, const Pack& b) { return a.v + b.v; }
  friend Pack operator-(const Pack& a, const Pack& b) { return a.v - b.v; }
  friend Pack operator*(const Pack& a, const Pack& b) { return a.v * b.v; }
  friend Pack operator/(const Pack& a, const Pack& b) { return a.v / b.v; }
  Pack& operator+=(const Pack& b) { return v += b.v, *this; }
  Pack& operator-=(const Pack& b) { return v -= b.v, *this; }
  Pack& operator*=(const Pack& b) { return v *= b.v, *this; }
  Pack& operator/=(const Pack& b) { return v /= b.v, *this; }
  friend Mask operator<(const Pack& a, const Pack& b) { return a.v < b.v; }
  friend Mask operator>(const Pack& a, const Pack& b) { return a.v > b.v; }
  friend Mask operator>=(const Pack& a, const Pack& b) { return a.v >= b.v; }

  friend Pack abs(const Pack& x) { return x.v < 0.0 ? -x.v : x.v; }
  friend Pack sqrt(const Pack& x) {
    return by_array(x.v, [](const auto& a) { return a.sqrt(); });
  }
  friend Pack exp(const Pack& x) {
    return by_array(x.v, [](const auto& a) { return a.exp(); });
  }
  /// x^exponent for x > 0.
  friend Pack pow(const Pack& x, double exponent) {
    return exp(exponent * Pack(by_array(x.v, [](const auto& a) { return a.log(); })));
  }

  Lanes v;
};

/// How many lanes a scalar has, and what a comparison of two gives.
template <class T>
struct LaneTraits {
  static constexpr int count = 1;
  using Mask = bool;
};
template <>
struct LaneTraits<Pack> {
  static constexpr int count = kLanes;
  using Mask = Pack::Mask;
};

inline double lane(double x, int) { return x; }
inline double lane(const Pack& x, int l) { return x.v[l]; }
inline bool lane(bool x, int) { return x; }
inline bool lane(const Pack::Mask& x, int l) { return x[l] != 0; }
inline void set_lane(double& to, int, double x) { to = x; }
inline void set_lane(Pack& to, int l, double x) { to.v[l] = x; }
inline void set_lane(bool& to, int, bool x) { to = x; }
inline void set_lane(Pack::Mask& to, int l, bool x) { to[l] = x ? -1 : 0; }
/// One lane of a matrix of lanes.
template <class T, int R, int C>
Eigen::Matrix<double, R, C> lane(const Eigen::Matrix<T, R, C>& x, int l) {
  return x.unaryExpr([l](const T& e) { return lane(e, l); });
}
template <class T, int R, int C>
void set_lane(Eigen::Matrix<T, R, C>& to, int l, const Eigen::Matrix<double, R, C>& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) set_lane(to.data()[i], l, x.data()[i]);
}

/// a where true, else b.
inline double select(bool which, double a, double b) { return which ? a : b; }
inline Pack select(const Pack::Mask& which, const Pack& a, const Pack& b) { return which ? a.v : b.v; }
/// `to` becomes `from` where true.
template <class M, class T>
void replace(const M& which, T& to, const T& from) {
  to = select(which, from, to);
}
template <class M, class T, int R, int C>
void replace(const M& which, Eigen::Matrix<T, R, C>& to, const Eigen::Matrix<T, R, C>& from) {
  for (Eigen::Index i = 0; i < to.size(); ++i) replace(which, to.data()[i], from.data()[i]);
}
inline bool any(bool which) { return which; }
inline bool any(const Pack::Mask& which) {
  bool some = false;
  for (int l = 0; l < kLanes; ++l) some |= which[l] != 0;
  return some;
}

/// The larger one; b where a is not a number.
inline double larger(double a, double b) { return a > b ? a : b; }
inline Pack larger(const Pack& a, const Pack& b) { return select(a > b, a, b); }

}  // namespace hosel

template <>
struct Eigen::NumTraits<hosel::Pack> : Eigen::NumTraits<double> {
  using Real = hosel::Pack;
  using NonInteger = hosel::Pack;
  using Nested = hosel::Pack;
  using Literal = hosel::Pack;
  enum { RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
