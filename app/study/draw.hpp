/// A study's pictures: lines, maps, bars and a tornado, as the case asks or as its design suggests.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/compare.hpp"
#include "app/study/effects.hpp"
#include "app/study/table.hpp"

namespace hosel::app {

struct StudyFigure {
  enum class Kind { line, map, bars, tornado };
  Kind kind = Kind::line;
  std::vector<std::string> outputs;  ///< empty: all
  std::string x, y;                  ///< columns of the design; empty: those of most values
  bool difference = false;           ///< to the reference of [compare]
};
/// `[[figure]]` of a study; empty: as its design suggests.
std::vector<StudyFigure> read_study_figures(Table root, const StudyTable& table, bool compared);

/// Draws into OUT/figures. Columns that a picture does not show stand at the middle of their values where there would
/// be too many lines, and always in a map; the title says so.
void draw_study(Output& out, const StudyTable& table, const std::string& title, std::vector<StudyFigure> figures,
                const StudyEffects& effects, const std::optional<StudyReference>& reference,
                const std::vector<StudySeries>& against);

}  // namespace hosel::app
