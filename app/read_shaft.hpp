/// The shaft and how the head hangs on it, as tables of a case file.
#pragma once

#include "hosel/app/reader.hpp"
#include "hosel/golf/blow.hpp"

namespace hosel::app {

/// `[shaft]`: by `name` from the library, by `table` (lists of station values), by `polynomial`, or by
/// `tube` geometry; with stiffness scales and damping.
Shaft read_shaft(Table table);

/// `[hosel]`: where the shaft's tip is, and the shaft's direction, in the face frame.
ClubGeometry read_club_geometry(Table table);

}  // namespace hosel::app
