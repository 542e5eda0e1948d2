#include "models/registry.hpp"

#include <algorithm>
#include <array>

#include "models/fe/impact.hpp"
#include "models/reduced/shaft_coupled.hpp"
#include "models/reduced/volumetric.hpp"
#include "models/rigid/jointed_club.hpp"
#include "models/rigid/rigid_eccentric.hpp"
#include "models/rigid/rigid_planar.hpp"
#include "models/rigid/stick_slip.hpp"

namespace hosel::models {
namespace {

/// A model, of the options that it reads.
template <class Model, auto... read>
std::unique_ptr<ImpactModel> made([[maybe_unused]] const Options& o) {
  return std::make_unique<Model>(o.*read...);
}

constexpr std::array kModels = {
    ModelEntry{"rigid-planar", "rolling rigid bodies in the plane of the loft", made<RigidPlanar>},
    ModelEntry{"rigid-eccentric", "rolling rigid ball on a free rigid head in 3-D", made<RigidEccentric>},
    ModelEntry{"volumetric", "free head, force by volume of overlap, smooth friction, ball of core and cover",
               made<Volumetric, &Options::volumetric, &Options::volumetric_solution>},
    ModelEntry{"stick-slip", "sliding then rolling along the impulse's path, with tangential restitution",
               made<StickSlip>},
    ModelEntry{"hertz-maw", "elastic ball whose contact patch sticks and slips piecewise",
               made<HertzMaw, &Options::hertz_maw, &Options::hertz_maw_solution>},
    ModelEntry{"shaft-coupled", "volumetric ball, head with the shaft as a condensed beam at the hosel",
               made<ShaftCoupled, &Options::volumetric, &Options::volumetric_solution, &Options::shaft_beam,
                    &Options::shaft_mount>},
    ModelEntry{"pendulum-club", "head on a rigid rod that turns about its butt", made<PendulumClub>},
    ModelEntry{"hinged-head", "the pendulum with a hinge at the hosel", made<HingedHead>},
    ModelEntry{"fe-free-body", "finite-element viscoelastic ball, frictional patch, free rigid head",
               made<Impact, &Options::fe>},
    ModelEntry{"fe-full-club", "the same with the flexible shaft and its grip in one system",
               made<Impact, &Options::fe, &Options::shaft_mount>},
};

}  // namespace

std::span<const ModelEntry> registry() { return kModels; }

const ModelEntry* find(std::string_view name) {
  const auto it = std::ranges::find(kModels, name, &ModelEntry::name);
  return it == kModels.end() ? nullptr : &*it;
}

}  // namespace hosel::models
