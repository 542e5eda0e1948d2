/// A study's answers between its points: a Gaussian process through those of a sample, and how far it is off.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "app/study/table.hpp"
#include "solvers/kriging.hpp"

namespace hosel::app {

class StudyEmulator {
 public:
  /// Nothing where the design is not one sample alone, where the points with an answer are fewer than three for each
  /// parameter, or where it fails to predict nine tenths of the variance at points left out.
  static std::optional<StudyEmulator> of(const StudyTable& table, std::size_t series);

  /// The answer at values of the parameters, in the order and units of the design's columns.
  double operator()(const Eigen::VectorXd& x) const { return whole_(scaled(x))[0]; }
  /// Standard deviation of the error to be expected there.
  double expected_error(const Eigen::VectorXd& x) const { return std::sqrt(whole_.error(scaled(x))(0, 0)); }
  double error() const { return error_; }          ///< rms at points left out, in the answer's unit
  double predicted() const { return predicted_; }  ///< share of the variance there
  std::size_t points() const { return points_; }   ///< through which it goes

  /// Of a parameter in the process: (x - centre) / half, within -1 and 1 over a uniform range, of a normal one over two
  /// standard deviations either way.
  struct Scale {
    double centre, half;
  };
  Scale scale(std::size_t column) const;
  /// Over parameters so scaled.
  solvers::Kriging::Parts parts() const { return whole_.parts(); }

  /// Parameters whose ranks among all that may be drawn are `share`, each in (0, 1).
  Eigen::VectorXd at_shares(const Eigen::VectorXd& share) const;
  const std::vector<DrawnColumn>& columns() const { return columns_; }

  /// A share of the variance and its 95 % interval.
  struct Share {
    double value, low, high;
  };
  /// One a parameter.
  struct Shares {
    std::vector<Share> alone, together;  ///< together: with all its interactions
  };
  /// Sobol's indices (solvers::sobol_indices); intervals from groups of points left out. A share is at least 0
  /// and at most 1, whatever the estimate's own error.
  Shares shares() const;

 private:
  Eigen::VectorXd scaled(const Eigen::VectorXd& x) const;

  std::vector<DrawnColumn> columns_;
  solvers::Kriging whole_;
  std::vector<solvers::Kriging> without_;  ///< one a group of points
  double error_ = 0, predicted_ = 0;
  std::size_t points_ = 0;
};

}  // namespace hosel::app
