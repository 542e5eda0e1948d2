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

template <class Model>
std::unique_ptr<ImpactModel> plain(const Options&) {
  return std::make_unique<Model>();
}

std::unique_ptr<ImpactModel> volumetric(const Options& o) {
  return std::make_unique<Volumetric>(o.volumetric, o.volumetric_solution);
}

std::unique_ptr<ImpactModel> hertz_maw(const Options& o) {
  return std::make_unique<HertzMaw>(o.hertz_maw, o.hertz_maw_solution);
}

std::unique_ptr<ImpactModel> shaft_coupled(const Options& o) {
  return std::make_unique<ShaftCoupled>(o.volumetric, o.volumetric_solution, o.shaft_beam, o.shaft_mount);
}
std::unique_ptr<ImpactModel> fe_free_body(const Options& o) { return std::make_unique<Impact>(o.fe); }
std::unique_ptr<ImpactModel> fe_full_club(const Options& o) { return std::make_unique<Impact>(o.fe, o.shaft_mount); }

constexpr std::array kModels = {
    ModelEntry{"rigid-planar", "rolling rigid bodies in the plane of the loft", plain<RigidPlanar>},
    ModelEntry{"rigid-eccentric", "rolling rigid ball on a free rigid head in 3-D", plain<RigidEccentric>},
    ModelEntry{"volumetric", "free head, force by volume of overlap, smooth friction, ball of core and cover",
               volumetric},
    ModelEntry{"stick-slip", "sliding then rolling along the impulse's path, with tangential restitution",
               plain<StickSlip>},
    ModelEntry{"hertz-maw", "elastic ball whose contact patch sticks and slips piecewise", hertz_maw},
    ModelEntry{"shaft-coupled", "volumetric ball, head with the shaft as a condensed beam at the hosel", shaft_coupled},
    ModelEntry{"pendulum-club", "head on a rigid rod that turns about its butt", plain<PendulumClub>},
    ModelEntry{"hinged-head", "the pendulum with a hinge at the hosel", plain<HingedHead>},
    ModelEntry{"fe-free-body", "finite-element viscoelastic ball, frictional patch, free rigid head", fe_free_body},
    ModelEntry{"fe-full-club", "the same with the flexible shaft and its grip in one system", fe_full_club},
};

}  // namespace

std::span<const ModelEntry> registry() { return kModels; }

const ModelEntry* find(std::string_view name) {
  const auto it = std::ranges::find(kModels, name, &ModelEntry::name);
  return it == kModels.end() ? nullptr : &*it;
}

}  // namespace hosel::models
