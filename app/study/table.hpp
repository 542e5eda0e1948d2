/// The answers of a study as columns of numbers.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/output.hpp"
#include "app/study/answer.hpp"
#include "app/study/design.hpp"
#include "post/table.hpp"

namespace hosel::app {

/// One output of one model, at every point of the design.
struct StudySeries {
  std::string name;    ///< as the summary has it: the output, behind its model where there are several
  std::string spoken;  ///< in words, with its unit
  std::size_t model = 0, output = 0;
  std::vector<double> y;  ///< NaN where there is no answer

  struct Spread {
    double low, mean, high;  ///< NaN where there is no answer at all
  };
  Spread spread() const;
  bool constant() const;  ///< prints as one number at all points that have an answer
};

/// A design, what was asked at each of its points, and the answers: point = design point * models + model.
struct StudyTable {
  Design design;
  std::vector<std::string> models;      ///< one empty name where another case answers, or nothing is struck
  std::vector<std::string> outputs;     ///< names with their units, or entries of a summary
  std::vector<MeasuredRange> measured;  ///< of every point; those of a variant or row come before
  std::vector<StudySeries> series;      ///< models x outputs
  std::vector<std::string> asked = {};  ///< of blows: the model of every point, as the design has it

  /// Fills `series`, and `outputs` where none is named: all numbers that the points hold.
  void fill(const std::vector<nlohmann::json>& points);
  std::string csv(const std::vector<nlohmann::json>& points) const;
  /// An empty table for files whose rows begin with the number of a point, its model and its place in the design.
  post::Table places() const;
  /// Every point in a row, for a design small enough to be read; empty else.
  post::TextTable rows() const;
  /// Whether that output is what was measured, in this or another unit.
  bool measures(const MeasuredRange& measured, std::size_t output) const;
  /// Measured values of an output at a point, in the output's unit; nothing where it was not measured.
  std::optional<MeasuredRange> seen(std::size_t point, std::size_t output) const;
  const std::string& model_of(std::size_t point) const {
    return asked.empty() ? models[point % models.size()] : asked[point];
  }
  /// Whether that column of `models` is the same named model at every point.
  bool one_model(std::size_t model) const;
  /// a minus b of an output; of a launch's angles the shorter way round.
  double difference(std::size_t output, double a, double b) const;
  const StudySeries& at(std::size_t model, std::size_t output) const { return series[model * outputs.size() + output]; }

 private:
  std::string spoken_entry(std::size_t output) const;
};

}  // namespace hosel::app
