/// What a run leaves of its case in OUT: the names of it.
#pragma once

namespace hosel::app {

/// A run leaves copies of what its case names beside `case.resolved.toml`, in this folder, so that this case runs again
/// wherever OUT has been taken.
inline constexpr const char* kInputsFolder = "inputs";
inline constexpr const char* kResolvedCase = "case.resolved.toml";
/// The table in which a resolved case lists what it left to its defaults: dotted keys, with the value that each has.
inline constexpr const char* kDefaultsTable = "defaults";

}  // namespace hosel::app
