/// The unit of a column's numbers: said by the file or an option, known by the layout, told by the carry.
#pragma once

#include <string>

#include "app/import/reading.hpp"

namespace hosel::app {

/// Of a file that names none, by what its layout is known for or --units says, as far as its carry bears it out.
void find_speed_unit(Reading& r);

/// From the header, the row of units or the cells; empty where none of them says.
std::string stated_unit(const Reading& r, const MonitorQuantity& q, std::size_t c);

/// The same, else what layout, carry or --units say. Throws InputError where there is none.
std::string unit_of_column(const Reading& r, const MonitorQuantity& q, std::size_t c);

/// Places on a face that would all be within 0.05 mm of its centre are in metres.
bool in_metres(const Reading& r, std::size_t c);

}  // namespace hosel::app
