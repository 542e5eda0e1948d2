/// Records as a fit sees them: what is measured, which readings train, the colour of the noise; and least squares of
/// effects' parameters on whitened residuals, unknowns of the start eliminated.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "hosel/loop/fit.hpp"
#include "hosel/loop/history/rig.hpp"

namespace hosel::loop {

struct HistoryRecord {
  std::string name;           ///< of the file
  std::vector<double> times;  ///< [s]
  Eigen::MatrixXd measured;   ///< samples x channels, header's unit; NaN where missing
  std::vector<char> train;    ///< per sample
};

class HistoryProblem {
 public:
  /// `forms` in the order of Form's address in `at`: what each Form of a Model does to the rig.
  HistoryProblem(const HistoryModel& model, std::vector<HistoryRecord> records, std::vector<HistoryChannel> channels,
                 const std::map<const Form*, const HistoryForm*>& forms);

  const std::vector<HistoryRecord>& records() const { return records_; }
  const std::vector<HistoryChannel>& channels() const { return channels_; }
  int width() const { return int(channels_.size()); }
  bool slow() const { return model_.slow(); }
  void set_noise(int channel, double sigma, double colour);
  void drop(int record, int sample, int channel);  ///< a reading that is none

  /// Whitened residuals (model minus measured) of the training readings up to `window` after each record's start [s],
  /// unknowns of the start at their best; zero where there is no reading. Always readings() long. False where the
  /// model has no answer.
  bool whitened(const Model& model, const double* p, double window, Eigen::VectorXd& z) const;
  int readings() const { return readings_; }  ///< records x samples x channels
  int training() const;                       ///< readings that train
  /// Number of unknowns that every fit contains.
  int unknowns(const Model& model, const double* p) const;
  /// Raw residuals, header's units, samples x channels per record (held-out readings too, unknowns from training).
  bool residuals(const Model& model, const double* p, std::vector<Eigen::MatrixXd>& out) const;
  /// Log predictive density of the held-out readings, and their number.
  std::pair<double, int> holdout_score(const Model& model, const double* p) const;

  Eigen::MatrixXd jacobian(const Model& model, const Eigen::VectorXd& p) const;  ///< whitened, per Parameter::scale
  Fit fit(const Model& model, const Eigen::VectorXd& start, double window, int iterations) const;

 private:
  Rig rig(const Model& model, const double* p) const;
  /// Whitened entries of one column of one record, those outside `window` or of the other set zero.
  void whiten(const HistoryRecord& record, const Eigen::MatrixXd& column, bool train, double window, double* out) const;
  bool solve(const Model& model, const double* p, double window, std::vector<Answer>& answers,
             std::vector<Eigen::VectorXd>& unknowns, Eigen::VectorXd* z) const;

  const HistoryModel& model_;
  std::vector<HistoryRecord> records_;
  std::vector<HistoryChannel> channels_;
  const std::map<const Form*, const HistoryForm*>& forms_;
  int readings_ = 0;
};

constexpr double kWhole = std::numeric_limits<double>::infinity();

}  // namespace hosel::loop
