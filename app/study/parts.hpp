/// What one variant of a study is minus another, place by place, and its band over another column of the design.
///
///     parts_over = "row"                                   a column: mean, lowest and highest over its values
///     parts_from = "as it is"                              one of them; the others are a standard deviation away
///     [[part]]     name, of = "a variant", minus = "another", per
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/study/table.hpp"

namespace hosel::app {

struct StudyParts {
  struct Part {
    std::string name;
    std::size_t of, minus;  ///< levels of the variants
    double per = 1;         ///< by which the difference is divided
  };
  std::vector<Part> all;
  std::optional<std::size_t> over;  ///< column of the design
  std::optional<std::size_t> from;  ///< of its values
};

StudyParts read_parts(Table root, const StudyTable& table);

/// parts.csv: a row for each part, model and place, a place being what the other columns of the design say. Over a
/// [grid] pictures; the mean over the places said, and for the summary with few places each of them.
nlohmann::json report_parts(Output& out, const StudyTable& table, const StudyParts& parts, bool draw);

}  // namespace hosel::app
