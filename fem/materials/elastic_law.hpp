/// Elastic laws: the concepts that a law must satisfy, and `Elastic`, which holds any law as a value.
#pragma once

#include <concepts>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/materials/lanes.hpp"
#include "fem/materials/symmetric.hpp"

namespace hosel::fem {

/// Second Piola-Kirchhoff stress S = 2 dW/dC [Pa] and tangent 4 d2W/dC2 [Pa] at the right
/// Cauchy-Green tensor C.
struct Response {
  double energy = 0;  ///< [J/m^3]
  Sym stress = Sym::Zero();
  Mat6 tangent = Mat6::Zero();
};

/// The right Cauchy-Green tensor at several points, none of them inverted.
struct MetricLanes {
  SymLanes C, inverse;
  Lanes J, p;  ///< volume ratio, J^(-2/3)
};
struct ResponseLanes {
  Lanes energy{};
  SymLanes stress{};
};

/// What a material says at a point. F has rows in the global and columns in the local reference frame.
struct PointResponse {
  double energy = 0;  ///< [J/m^3]
  Mat3 stress;        ///< first Piola-Kirchhoff P = dW/dF [Pa]
  Mat9 tangent;       ///< dP/dF, index i + 3 I for component (i, I) [Pa]
};

/// What every elastic law answers beside its response.
template <class L>
concept NamedModuli = requires(L law, const L& fixed) {
  { fixed.shear() } -> std::convertible_to<double>;                     // at zero strain [Pa]
  { fixed.bulk_modulus() } -> std::convertible_to<double>;              // at zero strain [Pa]
  { fixed.faults() } -> std::convertible_to<std::vector<std::string>>;  // sentences; empty if all is well
  law.stiffen(2.0);                                                     // shear response times a factor, bulk kept
};

/// A law of finite strain: adds energy, stress and, where asked, tangent at C. May stand beside relaxation branches.
/// `static constexpr bool kBearsInversion = true` where it has an answer at det F <= 0.
template <class L>
concept MetricLaw = NamedModuli<L> && requires(const L& law, const Sym& C, Response& out) {
  law.add(C, true, out);
};

/// A MetricLaw that answers at several points at once, energy and stress alone. The others are asked point by point.
template <class L>
concept LaneLaw = requires(const L& law, const MetricLanes& at, ResponseLanes& out) {
  law.add_stress(at.C, at.inverse, at.J, at.p, out.energy, out.stress);
};

/// A law of small strain in the body's mean attitude Q: sets all of the point's response.
template <class L>
concept CorotatedLaw = NamedModuli<L> && requires(const L& law, const Mat3& F, const Mat3& Q, PointResponse& out) {
  law.evaluate(F, Q, true, out);
};

/// Any elastic law as a value. A new law is a struct that meets one of the concepts above: the compiler says what it
/// lacks, and nothing here names the laws that exist.
class Elastic {
 public:
  template <class Law>
  requires MetricLaw<Law> || CorotatedLaw<Law> Elastic(Law law)
      : self_(std::make_shared<Holder<Law>>(std::move(law))) {}  // NOLINT: a law is an Elastic

  double shear() const { return self_->shear(); }        ///< at zero strain [Pa]
  double bulk_modulus() const { return self_->bulk(); }  ///< at zero strain [Pa]
  std::vector<std::string> faults() const { return self_->faults(); }
  bool corotated() const { return self_->corotated; }        ///< a CorotatedLaw
  bool bears_inversion() const { return self_->inversion; }  ///< answers at det F <= 0
  Elastic stiffened(double factor) const { return self_->stiffened(factor); }

  /// Of a MetricLaw.
  void add(const Sym& C, bool tangent, Response& out) const { self_->add(C, tangent, out); }
  void add(const MetricLanes& at, ResponseLanes& out) const { self_->add(at, out); }
  /// Of a CorotatedLaw.
  void evaluate(const Mat3& F, const Mat3& frame, bool tangent, PointResponse& out) const {
    self_->evaluate(F, frame, tangent, out);
  }

  /// nullptr where it is another law.
  template <class Law>
  const Law* as() const {
    const auto* holder = dynamic_cast<const Holder<Law>*>(self_.get());
    return holder ? &holder->law : nullptr;
  }

 private:
  struct Base {
    Base(bool c, bool i) : corotated(c), inversion(i) {}
    virtual ~Base() = default;
    virtual double shear() const = 0;
    virtual double bulk() const = 0;
    virtual std::vector<std::string> faults() const = 0;
    virtual Elastic stiffened(double factor) const = 0;
    virtual void add(const Sym& C, bool tangent, Response& out) const = 0;
    virtual void add(const MetricLanes& at, ResponseLanes& out) const = 0;
    virtual void evaluate(const Mat3& F, const Mat3& frame, bool tangent, PointResponse& out) const = 0;
    bool corotated, inversion;
  };
  template <class Law>
  struct Holder final : Base {
    static constexpr bool kInversion = [] {
      if constexpr (requires { Law::kBearsInversion; }) return Law::kBearsInversion;
      else return CorotatedLaw<Law>;
    }();
    explicit Holder(Law l) : Base(CorotatedLaw<Law>, kInversion), law(std::move(l)) {}
    double shear() const override { return law.shear(); }
    double bulk() const override { return law.bulk_modulus(); }
    std::vector<std::string> faults() const override { return law.faults(); }
    Elastic stiffened(double factor) const override {
      Law copy = law;
      copy.stiffen(factor);
      return copy;
    }
    void add(const Sym& C, bool tangent, Response& out) const override {
      if constexpr (MetricLaw<Law>) law.add(C, tangent, out);
      else throw std::logic_error("a law of small strain has no answer to C");
    }
    void add(const MetricLanes& at, ResponseLanes& out) const override {
      if constexpr (LaneLaw<Law>) {
        law.add_stress(at.C, at.inverse, at.J, at.p, out.energy, out.stress);
      } else {
        for (int l = 0; l < kLanes; ++l) {
          Sym C;
          for (int i = 0; i < 6; ++i) C[i] = at.C[static_cast<std::size_t>(i)][l];
          Response one;
          add(C, false, one);
          out.energy[l] += one.energy;
          for (int i = 0; i < 6; ++i) out.stress[static_cast<std::size_t>(i)][l] += one.stress[i];
        }
      }
    }
    void evaluate(const Mat3& F, const Mat3& frame, bool tangent, PointResponse& out) const override {
      if constexpr (CorotatedLaw<Law>) law.evaluate(F, frame, tangent, out);
      else throw std::logic_error("a law of finite strain answers to C");
    }
    Law law;
  };
  std::shared_ptr<const Base> self_;  // laws do not change once made
};

}  // namespace hosel::fem
