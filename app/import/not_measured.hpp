/// Columns and cells that hold no measurement of the blow: they go to kept.csv only.
#pragma once

#include "app/import/reading.hpp"

namespace hosel::app {

/// A column whose header, or whose foot note, says that the instrument modelled it.
bool modelled_by_its_header(const Reading& r, const std::string& header);

/// `Loft` may be what is stamped on the club: the same in every shot, which no blow's loft is.
void leave_out_static_loft(Reading& r);

/// What the instrument modelled says nothing of the blow: its own model's answer would be explained.
void leave_out_modelled(Reading& r);

/// A place on the face that is face angle minus path.
void leave_out_false_place(Reading& r);

/// The face angle from path and face-to-path where it is not recorded by itself; face-to-path is kept aside.
void derive_face(Reading& r);

/// Spins that follow from rate and axis, and columns without a reading.
void leave_out_copies(Reading& r);

}  // namespace hosel::app
