/// Which program this is.
#pragma once

#include <string>

namespace hosel::app {

/// The project's version and the build ID of the running program, a digest that its linker wrote: two builds that may
/// compute differently differ in it.
std::string program_version();

}  // namespace hosel::app
