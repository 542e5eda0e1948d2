#pragma once
// The examination on time histories: a rod on a bench, pulled aside and let go, with something that its case does
// not declare.

#include <filesystem>

#include "strata.hpp"

namespace examination {

/// Draws `sets` records of every stratum and writes keys and cases below DIR, keys first.
void make_records(std::uint64_t seed, int sets, const std::filesystem::path& dir);

/// Scores the reports under DIR/out; prints a table and writes DIR/score.json.
void score_records(const std::filesystem::path& dir);

}  // namespace examination
