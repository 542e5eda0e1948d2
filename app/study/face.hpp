/// A study over the face: the launches at the places of `[grid]` as maps, and what the maps differ by.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/output.hpp"
#include "app/study/compare.hpp"
#include "app/study/table.hpp"
#include "post/face_map.hpp"
#include "post/shaft_effect.hpp"

namespace hosel::app {

/// One model over the whole grid, at one setting of the factors beside it.
struct FaceLayer {
  post::FaceMap map;
  post::FaceMap heavier;  ///< the same with the head's extra mass; empty where that is not asked
  Head head;
  std::size_t model = 0, setting = 0;
  std::vector<std::size_t> points;              ///< of the design, in the order of the grid
  std::optional<std::size_t> reference;         ///< the layer that it is compared with
  std::vector<post::NamedFigure> figures = {};  ///< of what it is minus that one, once reported
};

/// Settings x models. `blow` reads the blow of a point and model, with what was solved there; the head of the first is
/// that of the whole layer.
std::vector<FaceLayer> face_layers(const StudyTable& table, const std::vector<nlohmann::json>& points,
                                   const std::optional<StudyReference>& reference,
                                   const std::function<StudyBlow(std::size_t, std::size_t)>& blow);

/// What formulas may name of a layer that is compared.
std::vector<std::string> face_figure_names(bool with_mass);

/// `face_map.csv`, `face_differences.csv`, the face for ParaView, what each layer changes against its reference, how
/// much of that is left at other settings, and the hosel's loads where they were kept. `extra`: added to the heavier
/// head [kg]. Fills the layers' figures.
void report_face(Output& out, const StudyTable& table, const std::vector<nlohmann::json>& points,
                 std::vector<FaceLayer>& layers, double extra, bool draw, nlohmann::json& summary);

}  // namespace hosel::app
