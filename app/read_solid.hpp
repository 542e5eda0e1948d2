/// Solid materials and deformable balls from a case's tables.
#pragma once

#include <span>
#include <string_view>

#include "app/reader.hpp"
#include "models/fe/fe_ball.hpp"

namespace hosel::app {

struct NamedLaw {
  std::string_view name;
  std::string_view what;           ///< one sentence for `hosel list`
  fem::Elastic (*read)(Table& t);  ///< its constants from the material's table
};
std::span<const NamedLaw> solid_laws();

/// `law` with its moduli, and `branch_moduli_MPa`, `branch_times_ms` of the relaxation.
fem::Solid read_solid(Table table);

/// `[[ball.layers]]` from the inside, each a material with `radius_fraction`.
models::FeBall read_layers(Table table);

/// `[ball]`: either `model = "name"` of the library or `[[ball.layers]]` from the inside, each a material
/// with `radius_fraction`; `standard` where neither stands. `[ball.changes]`: what the loop finds of a ball, see
/// models::FeChange.
models::FeBall read_fe_ball(Table table, const models::FeBall& standard);

}  // namespace hosel::app
