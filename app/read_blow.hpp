/// The domain's nouns from a case's tables: each key is declared here, once, with unit and range.
#pragma once

#include "app/reader.hpp"
#include "golf/blow.hpp"

namespace hosel::app {

Ball read_ball(Table table);
/// `[head]`. `mass_kg = inf` is a rigid wall; `whole = false` reads the mass alone (rigid-planar).
Head read_head(Table table, bool whole = true);
Delivery read_delivery(Table table);
ContactLaw read_contact_law(Table table);

}  // namespace hosel::app
