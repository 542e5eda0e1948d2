/// Every impact model by its name. A new model is its file and one line in registry.cpp.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "models/impact_model.hpp"
#include "models/options.hpp"

namespace hosel::models {

struct ModelEntry {
  std::string_view name;
  std::string_view what;  ///< one sentence for `hosel list`
  std::unique_ptr<ImpactModel> (*make)(const Options&);
};

std::span<const ModelEntry> registry();
/// nullptr where no model has this name.
const ModelEntry* find(std::string_view name);

}  // namespace hosel::models
