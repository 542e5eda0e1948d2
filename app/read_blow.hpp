/// The domain's nouns from a case's tables: each key is declared here, once, with unit and range.
#pragma once

#include <string>
#include <vector>

#include "hosel/app/reader.hpp"
#include "hosel/golf/blow.hpp"

namespace hosel::app {

Ball read_ball(Table table);
/// `[head]`. `mass_kg = inf` is a rigid wall; `whole = false` reads the mass alone (rigid-planar).
Head read_head(Table table, bool whole = true);
Delivery read_delivery(Table table);
ContactLaw read_contact_law(Table table);

/// `models = [...]`: names from the registry, at least one.
std::vector<std::string> read_models(Table root);
/// Everything that the models of a case are asked about, from its tables.
Blow read_blow(Table root, const std::vector<std::string>& models);

}  // namespace hosel::app
