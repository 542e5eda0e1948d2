/// Records of a club test as a Problem of the engine: readings whitened by coloured noise, unknown initial states
/// eliminated, intervals of time held out, fits that begin with a few periods.
#pragma once

#include "loop/case.hpp"
#include "loop/history/test_setup.hpp"
#include "loop/result.hpp"

namespace hosel::loop {

struct HistoryRecord {
  std::string name;           ///< of the file
  std::vector<double> times;  ///< [s]
  Eigen::MatrixXd measured;   ///< samples x channels, header's unit; NaN where missing
  std::vector<char> train;    ///< per sample; filled by the split
};

class HistoryProblem final : public Problem {
 public:
  /// `model` must outlive the problem. Whole records are held out where there are enough and none needs a start of its
  /// own, else stretches of time. `notes` about the case; `own`: effects beside the library's.
  HistoryProblem(const HistoryModel& model, const HistorySetting& setting, std::vector<HistoryRecord> records,
                 const Split& split, std::vector<std::string> notes = {}, std::vector<EffectEntry> own = {});

  /// Every form that can act on this test.
  std::vector<Parametrisation> forms() const;
  const std::vector<HistoryRecord>& records() const { return records_; }

  int width() const override { return int(setting_.channels.size()); }
  const HistoryChannel& channel(int c) const override { return setting_.channels[c]; }
  void refute(int c, bool refuted) override { setting_.channels[c].refute(refuted); }
  std::vector<Row> rows() const override;
  const Eigen::MatrixXd& measured() const override { return measured_; }
  std::vector<Flag> flags() const override { return flags_; }
  std::vector<std::string> notes() const override;
  std::optional<std::string> too_few() const override;

  bool whitened(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                double window = Stage::kWhole) const override;
  bool linearise(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z, Eigen::MatrixXd& jacobian,
                 double window) const override;
  Eigen::MatrixXd jacobian(Part part, const Model& model, const Eigen::VectorXd& p) const override;
  Eigen::MatrixXd residuals(const Model& model, const Eigen::VectorXd& p) const override;
  Density density(Part part) const override;
  std::vector<Stage> stages() const override;
  Effort effort() const override;

  bool screen(const Selection& selection) override;
  Scatter scatter(int channel, const Eigen::MatrixXd& residuals, int fitted) const override;
  double update_noise(const Fit& selected, const Fit& richest) override;

  StructureMap structure(const Fit& fit, const Fit& near, const Eigen::MatrixXd& directions,
                         const Rules& rules) const override;
  std::vector<Location> places(const Selection& selection) const override;
  NextExperiment next_experiment(const LoopResult& so_far) const override;

 private:
  struct Solution {
    std::vector<Prediction> answers;        ///< per record, header's units
    std::vector<Eigen::VectorXd> unknowns;  ///< of the start, at their best on the training readings
  };
  void split(const Split& how);
  /// Whitened entries of one column of one record, those outside `window` or of the other set zero. Returns the sum of
  /// the logarithms of their factors.
  double whiten(const HistoryRecord& record, const Eigen::MatrixXd& column, bool train, double window,
                double* out) const;
  bool solve(const Model& model, const Eigen::VectorXd& p, double window, Solution& out, Eigen::VectorXd* z) const;

  const HistoryModel& model_;
  HistorySetting setting_;  ///< its channels with their noise as known by now
  std::vector<HistoryRecord> records_;
  Eigen::MatrixXd measured_;  ///< of all records, one below the other
  std::vector<Flag> flags_;
  std::vector<EffectEntry> own_;
  std::vector<std::string> notes_;
};

}  // namespace hosel::loop
