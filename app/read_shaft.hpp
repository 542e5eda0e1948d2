/// The shaft and how the head hangs on it, as tables of a case file.
#pragma once

#include <optional>

#include "app/reader.hpp"
#include "golf/blow.hpp"

namespace hosel::app {

/// `[shaft]`: by `name` from the library, by `table` (lists of station values), by `polynomial`, or by
/// `tube` geometry; with stiffness scales and damping.
Shaft read_shaft(Table table);

/// Where the shaft enters the head, as a case's [hosel] says it.
struct HoselPlace {
  Vec3 position;     ///< face frame [m]
  double lie, lean;  ///< [rad]
  ClubGeometry geometry() const;
};

/// `[hosel]`: where the shaft's tip is, and the shaft's direction, in the face frame. Without a standard all is
/// required.
HoselPlace read_hosel(Table table, const std::optional<HoselPlace>& standard);
/// `[hosel]` of a case, by default that of the head that `[head] name` names; echoed where it is wanted.
ClubGeometry read_club_geometry(Table root, bool wanted);

}  // namespace hosel::app
