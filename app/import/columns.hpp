/// A sheet's columns as quantities in our units and signs, and those kept aside.
#pragma once

#include "app/import/reading.hpp"

namespace hosel::app {

void read_columns(Reading& r);

}  // namespace hosel::app
