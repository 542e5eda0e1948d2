/// Wrong columns of flights.
#pragma once

#include "loop/flights/problem.hpp"
#include "loop/wrong_columns.hpp"

namespace hosel::loop {

/// Every slip of whole columns is tried on some of the flights, evenly spread. What is unknown of a shot and of its
/// group is integrated out about zero, and the likeliest effect stands beside it, whatever a slip says. Slips compete
/// by a deviance whose tail is logarithmic, so that a slip is seen however gross it is. Noise that is not declared is
/// that of the columns as recorded, but where a unit is tried.
class FlightColumns {
 public:
  /// `usable`: rows of the file that hold a flight.
  FlightColumns(const FlightCase& c, const std::vector<int>& usable);
  FlightColumns(const FlightColumns&) = delete;
  FlightColumns& operator=(const FlightColumns&) = delete;
  /// Those that contradict their header, where no fit among `rivals` does nearly as well.
  std::vector<WrongColumn> contradicted(const std::vector<const Fit*>& rivals) const;
  /// Those that all effects together, whatever that costs, do not do nearly as well: no name need be looked for.
  std::vector<WrongColumn> beyond_every_name() const;

 private:
  void try_constants();
  void try_sizes();
  /// Of whitened residuals about a slip of the launch or of a reading whose sizes are the first columns of J; and what
  /// those sizes add to be likeliest.
  struct Judged {
    double deviance = kInfinity;
    Eigen::VectorXd step;  ///< of the sizes, in their scales
  };
  Judged beside_one(const Eigen::VectorXd& z, const Eigen::MatrixXd& J, Eigen::Index sizes, double price) const;
  double deviance(const FlightProblem& problem, const Eigen::MatrixXd& by_effects, double price) const;
  Eigen::MatrixXd by_effects(const FlightProblem& problem) const;
  bool reads_launch(Output output) const;
  int channel_of(const Column& column) const;  ///< of a reading of the flight
  double library(const std::vector<const Fit*>& rivals) const;
  std::vector<WrongColumn> judged(double library) const;

  const FlightCase& given_;
  FlightCase case_;                       ///< the flights that are looked at, all of them trained on
  std::vector<const Column*> columns_;    ///< as given
  std::optional<FlightProblem> problem_;  ///< as recorded
  std::vector<Parametrisation> forms_;
  Model effects_;                    ///< all of these, the declared ones first,
  Eigen::Index declared_ = 0;        ///< with so many parameters
  Eigen::MatrixXd by_effects_;       ///< whitened readings by their parameters, about none of them
  std::vector<ColumnSlip> slips_;    ///< the likeliest first
  double recorded_ = 0, scale_ = 0;  ///< deviance as recorded, and what of it is the density's,
  double lost_ = 0;                  ///< and that of flights that cannot be
};

}  // namespace hosel::loop
