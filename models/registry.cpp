#include "models/registry.hpp"

#include <algorithm>
#include <array>

#include "models/rigid_eccentric.hpp"
#include "models/rigid_planar.hpp"

namespace hosel::models {
namespace {

template <class Model>
std::unique_ptr<ImpactModel> plain(const Options&) {
  return std::make_unique<Model>();
}

constexpr std::array kModels = {
    ModelEntry{"rigid-planar", "rolling rigid bodies in the plane of the loft", plain<RigidPlanar>},
    ModelEntry{"rigid-eccentric", "rolling rigid ball on a free rigid head in 3-D", plain<RigidEccentric>},
};

}  // namespace

std::span<const ModelEntry> registry() { return kModels; }

const ModelEntry* find(std::string_view name) {
  const auto it = std::ranges::find(kModels, name, &ModelEntry::name);
  return it == kModels.end() ? nullptr : &*it;
}

}  // namespace hosel::models
