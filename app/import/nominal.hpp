/// What the loop needs and a file lacks.
#pragma once

#include "app/import/reading.hpp"

namespace hosel::app {

/// What the loop needs and the file lacks It comes from the clubs' nominal figures, said as such.
void add_nominal(Reading& r);

}  // namespace hosel::app
