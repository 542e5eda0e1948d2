/// Whether what the columns hold can be: a wrong unit or sign shows in the size of numbers and between columns.
#pragma once

#include "app/import/reading.hpp"

namespace hosel::app {

/// The median of a quantity, whose cells were in the unit `given`, can be one. Throws InputError.
void check_range(const Reading& r, const MonitorQuantity& q, std::size_t column, const Understood& u,
                 const std::string& given);

/// A spin that curves the shots to the other side than the one to which the file says they curve.
void compare_with_landing(Reading& r);

/// Two speeds check each other, and the carry in the file checks the ball's.
void check_speeds(Reading& r);

}  // namespace hosel::app
