/// A study's answers against a reference: one of its models, one of its variants, or what was measured.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/study/table.hpp"

namespace hosel::app {

struct StudyReference {
  std::optional<std::size_t> model;    ///< number of the model
  std::optional<std::size_t> variant;  ///< number of the variant's level
  std::string name;                    ///< in sentences: "volumetric", "measured"
  std::optional<std::size_t> by;       ///< column of the design whose cells are compared apart
};

/// The place of `name` among `names`, each a `what`; else an error at `key` with the nearest.
std::size_t number_of(const Table& table, std::string_view key, std::string_view what, const std::string& name,
                      const std::vector<std::string>& names);

/// `[compare]`; without one what was measured, if anything was; else nothing.
std::optional<StudyReference> read_compare(Table root, const StudyTable& table);

/// The point of the design with which one is compared: itself, or the same at the variant of reference.
std::size_t counterpart(const StudyTable& table, const StudyReference& reference, std::size_t point);

/// What each series is compared with, as the table's series: NaN where there is nothing. A measured range counts as its
/// end nearest to the answer, and as the answer itself inside.
std::vector<StudySeries> references(const StudyTable& table, const StudyReference& reference);

/// Mean, rms and largest difference of every model and output, where it is largest, and which quantity of the contact
/// differs most there: differences.csv, the page, and the summary.
nlohmann::json compare(Output& out, const StudyTable& table, const StudyReference& reference,
                       const std::vector<StudySeries>& references, const std::vector<bool>& causes);

}  // namespace hosel::app
