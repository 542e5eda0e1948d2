/// What a player asks of a session beside the loop's findings: each club's figures, and where its shots land.
#pragma once

#include <set>

#include "app/output.hpp"
#include "loop/result.hpp"
#include "models/flight/flight.hpp"

namespace hosel::app {

/// The rows of the flagged shots, by their numbers; where several sessions share a number, by the line of the file too.
std::set<std::size_t> flagged_rows(const std::vector<loop::Flag>& flagged, const loop::Shots& shots);

/// A line a club (column `club`; one for all without it): mean and standard deviation of ball speed, launch angle,
/// spin, carry and side. A shot flies from its measured launch. One whose launch is not whole counts in what it has;
/// one without direction or tilt has no side. Draws figures/landings with the ellipse that holds 95 % of a normal
/// distribution with each club's scatter; writes landings.csv. `left_out`: rows that count in nothing, and the page
/// says how many. `mirrored`: the shots are a left-handed player's, and the page says so.
void show_landings(Output& out, const loop::Shots& shots, const std::set<std::size_t>& left_out, const Ball& ball,
                   const models::FlightConditions& conditions, bool mirrored);

}  // namespace hosel::app
