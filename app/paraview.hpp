/// `hosel open` and `hosel film`: a run's series in ParaView, and a finite-element blow as a film.
#pragma once

#include <filesystem>

namespace hosel::app {

/// Becomes ParaView, with every series of the run opened, warped by its displacement and coloured
/// (post/paraview/open.py). Throws InputError, in a plain sentence, where there are no series, no ParaView or no
/// screen.
[[noreturn]] void open_in_paraview(const std::filesystem::path& out);

/// Draws every frame of a run's series with ParaView (post/paraview/film.py) and joins them with ffmpeg to FILE, an
/// .mp4 or a .gif; OUT/film.mp4 where it is empty. Of several models the last is filmed, as it answers the case.
/// Returns what was written. Throws InputError, in a plain sentence, where FILE exists or has another ending, where
/// there are no series of a blow, or where a program is missing, with its Debian package; std::runtime_error where one
/// fails.
std::filesystem::path film(const std::filesystem::path& out, const std::filesystem::path& file);

}  // namespace hosel::app
