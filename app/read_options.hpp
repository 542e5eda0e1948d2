/// How the models of a case are solved: `[volumetric]`, `[hertz_maw]`, and for FE `[contact]`, `[mesh]`, `[time]`.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/reader.hpp"
#include "models/options.hpp"
#include "post/impact_recorder.hpp"

namespace hosel::app {

/// Reads the tables that the named models look at, and no others. What of them is the blow's goes there: the compliance
/// of the head's face, friction on the patch of a deformable ball.
models::Options read_options(Table root, const std::vector<std::string>& models, Blow& blow);

/// Constants of the reduced models; without a standard each is required.
models::VolumetricLaw read_volumetric_law(Table table, const std::optional<models::VolumetricLaw>& standard);
models::HertzMawLaw read_hertz_maw_law(Table table, const std::optional<models::HertzMawLaw>& standard);

/// `[mesh]` and `[time]` of a ball by finite elements, as far as a blow on a wall has them.
void read_ball_mesh(Table& table, mesh::MeridianOptions& mesh);
void read_steps(Table& table, models::FeImpactOptions& options);

/// "look", "default" or "reference", as a case has it.
models::Accuracy accuracy_named(std::string_view name);

/// `[grip]`: what the hands do during the impact, and the wrench (`force`, `moment`, grip axes) with which they load
/// the shaft before it; without one the shaft is straight and moves with the head. `swung`: mesh and wrench are those
/// of a swing.
void read_grip(Table& table, models::ShaftMount& mount, bool swung = false);

/// `[output]`: what is written of a finite-element impact for ParaView.
post::RecorderOptions read_recorder(Table root);

}  // namespace hosel::app
