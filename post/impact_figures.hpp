/// What happened during a finite-element blow, as pictures inside a page.
#pragma once

#include <filesystem>
#include <string>

namespace hosel::post {

/// Normal and tangential force over time, the largest marked; from a history.csv (impact_recorder).
std::string force_svg(const std::filesystem::path& history);
/// Where the energy is over time: what the bodies have lost in motion, what the ball holds and has turned into heat.
std::string energy_svg(const std::filesystem::path& history);

}  // namespace hosel::post
