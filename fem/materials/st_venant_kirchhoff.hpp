/// St. Venant-Kirchhoff: stress linear in Green's strain.
#pragma once

#include "fem/materials/elastic_law.hpp"
#include "fem/materials/lame.hpp"

namespace hosel::fem {

/// W = lambda/2 tr(E)^2 + mu E:E of the Green strain E: softens and collapses in strong compression.
struct StVenantKirchhoff : Lame {
  static constexpr bool kBearsInversion = true;

  void add(const Sym& C, bool tangent, Response& out) const {
    const Sym E = 0.5 * (C - sym_identity());
    const double trace = E[0] + E[1] + E[2];
    out.energy += 0.5 * lambda * trace * trace + mu * contract(E, E);
    out.stress += lambda * trace * sym_identity() + 2 * mu * E;
    if (!tangent) return;
    out.tangent.topLeftCorner<3, 3>().array() += lambda;
    out.tangent.diagonal() += (Sym() << 2 * mu, 2 * mu, 2 * mu, mu, mu, mu).finished();
  }
};

}  // namespace hosel::fem
