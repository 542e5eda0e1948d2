#pragma once
// The strata of the examination: each set is drawn from (seed, stratum, number of shots, index) alone.

#include <nlohmann/json.hpp>

#include "session.hpp"

namespace examination {

using Json = nlohmann::ordered_json;

struct Set {
  std::string name;  ///< tells nothing of the stratum
  std::string stratum;
  std::uint64_t seed;
  int shots, index;
  Session session;
  std::vector<Form> hidden;                ///< truth, empty on nulls
  std::vector<std::vector<double>> value;  ///< its parameters
  Json key;
};

/// Names of the strata with the number of sets at full scale.
const std::vector<std::pair<std::string, int>>& strata();

/// Draws a set. Throws std::runtime_error where none of many draws meets the stratum's conditions.
Set make_set(std::uint64_t seed, const std::string& stratum, int shots, int index);

}  // namespace examination
