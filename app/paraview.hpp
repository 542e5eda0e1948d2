/// `hosel open`: a run's series in ParaView.
#pragma once

#include <filesystem>

namespace hosel::app {

/// Becomes ParaView, with every series of the run opened, warped by its displacement and coloured
/// (post/paraview/open.py). Throws InputError, in a plain sentence, where there are no series, no ParaView or no
/// screen.
[[noreturn]] void open_in_paraview(const std::filesystem::path& out);

}  // namespace hosel::app
