/// Which program this is.
#pragma once

#include <string>

namespace hosel::app {

/// The project's version and a digest of the running program: two builds that may compute differently differ in it.
std::string program_version();

}  // namespace hosel::app
