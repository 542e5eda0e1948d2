/// Wrong columns of shots.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "loop/fit.hpp"
#include "loop/shots/case.hpp"
#include "loop/shots/model.hpp"
#include "loop/wrong_columns.hpp"

namespace hosel::loop {

/// Every slip of whole columns is tried on all rows (of long sets on some, evenly spread): none is screened away,
/// values that no blow can have count as far off. Slips compete by a deviance whose tail is logarithmic, so that a slip
/// is seen however gross it is.
class Columns {
 public:
  explicit Columns(const ShotCase& c);
  ~Columns();
  /// Those that contradict their header, where no fit among `rivals` (effects of the library inside their plausible
  /// range) does nearly as well, the column in its header's sense. `forms`: of these effects.
  std::vector<WrongColumn> contradicted(const std::vector<Fit>& rivals,
                                        const std::vector<Parametrisation>& forms) const;

 private:
  struct PartOfRows;
  struct Contact {
    Model model;
    Eigen::VectorXd size;
    double deviance = 0;  ///< with the price of its parameters
  };
  /// The base answers in microseconds itself: else only gross slips are looked for.
  bool quick() const;
  void read();
  void estimate_noise();
  Shot shot(Eigen::Index row, const Eigen::MatrixXd& values) const;
  Eigen::MatrixXd residuals(const Eigen::MatrixXd& values, const Model& model, const Eigen::VectorXd& p) const;
  Eigen::MatrixXd residuals(const ShotModel& by, const Eigen::MatrixXd& values, const Model& model,
                            const Eigen::VectorXd& p) const;
  Contact contact(const Eigen::MatrixXd& values, const Eigen::VectorXd& noise) const;
  Eigen::MatrixXd sensitivity(const Eigen::MatrixXd& values, int column) const;
  Eigen::MatrixXd sensitivity(const Parametrisation& form) const;
  double deviance(const Eigen::MatrixXd& values, const Eigen::VectorXd& noise, const Model& model,
                  const Eigen::VectorXd& p) const;
  Eigen::VectorXd losses(const Eigen::MatrixXd& residuals, const Eigen::MatrixXd& whitening) const;
  double library(const std::vector<Fit>& rivals, const std::vector<Parametrisation>& forms) const;
  double log_scale(const Eigen::MatrixXd& values, const Eigen::MatrixXd& whitening) const;
  Eigen::MatrixXd whitening(const Eigen::MatrixXd& values, const Eigen::VectorXd& noise) const;
  Eigen::VectorXd noise_of(const ColumnSlip& slip) const;
  Eigen::MatrixXd corrected(const ColumnSlip& slip) const;
  double neighbour(Eigen::Index row, int column, int rows) const;
  bool tells(const ColumnSlip& slip) const;
  void attempt(ColumnSlip slip);
  std::vector<PartOfRows> parts() const;
  std::map<std::string, double> by_contact(const Eigen::MatrixXd& z, const Eigen::MatrixXd& W,
                                           const std::vector<PartOfRows>& parts) const;
  void try_parts(const std::vector<PartOfRows>& parts);
  void try_sizes(const std::vector<PartOfRows>& parts);

  const ShotCase& case_;
  std::vector<const Column*> columns_;    ///< inputs, then channels
  std::vector<Input> inputs_;             ///< of the first columns
  std::vector<Output> outputs_;           ///< of the others
  std::vector<int> rows_;                 ///< of the file
  std::vector<double> order_;             ///< place in the session
  std::vector<double> loft_;              ///< found from the launch angle, where the case calls it unknown [rad]
  Eigen::MatrixXd values_;                ///< rows x columns as recorded, SI; missing outputs NaN
  Eigen::VectorXd noise_, input_noise_;   ///< per channel, per input [SI]
  std::unique_ptr<ShotModel> model_;      ///< the base itself
  std::unique_ptr<ShotModel> companion_;  ///< tells what effects change, where the base does not
  std::vector<ColumnSlip> slips_;         ///< the likeliest first
  Contact contact_;                       ///< as recorded
  double as_recorded_ = 0;                ///< deviance
};

}  // namespace hosel::loop
