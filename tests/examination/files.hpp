#pragma once
// Sets as case directories, runs of the command on them, and the scorer.

#include <filesystem>

#include "strata.hpp"

namespace examination {

/// Seeds below this are for development, the others for the examination.
constexpr std::uint64_t first_examination_seed = 1000;

/// Writes DIR/keys/<set>.json, then DIR/<set>/ with case.toml, shots.csv and club_means.csv where joined.
void write_set(const Set& set, const std::filesystem::path& dir);

/// Runs `hosel run DIR/<set> --out DIR/out/<set>` for every set; notes status and wall time in DIR/runs.json.
/// A run is stopped after `limit_s` seconds.
void run_sets(const std::filesystem::path& dir, const std::string& hosel, int jobs, int limit_s);

/// Scores every set under DIR that has a key; prints a table and writes DIR/score.json. Throws
/// std::runtime_error where development and examination seeds are mixed.
Json score_sets(const std::filesystem::path& dir);

}  // namespace examination
