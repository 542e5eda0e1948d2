/// Sentences about a study's answers, judged at every point of its design.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/study/formula.hpp"
#include "app/study/table.hpp"
#include "post/shaft_effect.hpp"

namespace hosel::app {

/// A sentence and the formula that bears it out: arithmetic, comparisons, && and || (muParser) of the design's columns,
/// the outputs, with a [compare] also reference.NAME and difference.NAME, and mean.NAME, least.NAME and largest.NAME of
/// an output over the points that are judged together (in `holds` over those that it speaks of), and the figures of a
/// face that is compared.
struct StudyStatement {
  std::string text, holds, where;  ///< where: the points that it speaks of; empty: all
  FormulaNames names;              ///< what it calls columns and outputs
  std::vector<std::string>
      variables;  ///< all that it may name; where a map has no figures, what needs them is not judged
};

/// Points that are judged together, of one model.
struct StudyGroup {
  std::string name;  ///< of the model, or of the map; empty: there is one model
  std::size_t model = 0;
  std::vector<std::size_t> points;
  std::vector<post::NamedFigure> figures = {};  ///< of all of them; empty where the map is not whole
};

/// `[[statement]]`; formulas that cannot be read, or that name something else than `names`, are errors.
std::vector<StudyStatement> read_study_statements(Table root, const std::vector<std::string>& columns,
                                                  const std::vector<std::string>& outputs,
                                                  const std::vector<std::string>& figures, bool compared);

/// Judges every statement for every group: holds in at least 95 % of the points, fails in at most 5 %,
/// else undecided. Said, shown on the page, returned for the summary.
nlohmann::json judge(Output& out, const StudyTable& table, const std::vector<StudyStatement>& statements,
                     const std::vector<StudySeries>& references, const std::vector<StudyGroup>& groups);

}  // namespace hosel::app
