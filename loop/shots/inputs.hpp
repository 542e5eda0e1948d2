/// Input of the models: trials from the rows, noisy inputs replaced by their expectation.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "loop/effect.hpp"
#include "loop/shots/shots.hpp"

namespace hosel::loop {

struct Inputs {
  std::vector<Shot> trials;                 ///< one per usable row
  std::vector<int> row_of;                  ///< the row of each trial
  std::vector<Eigen::MatrixXd> covariance;  ///< of the inputs given their record, 8 x 8 SI; empty: all exact
  std::map<std::string, int> unused;        ///< reason, rows
  struct Impossible {
    int row;
    std::string column, reason;
  };
  std::vector<Impossible> impossible;  ///< values no blow can have
  std::vector<std::string> notes;
};

/// Place of some rows in the session, 0 the first, 1 the last: by the shot number where it is one, else by the row.
std::vector<double> session_order(const Shots& shots, const std::vector<int>& rows);

/// Of a recorded input [SI] whose error is declared [header's unit]: its last digit rounds besides. Zero: it is exact.
double error_of(const Column& input, double declared);

/// Rows without club speed, dynamic loft or any output are unused; a missing column is zero. `noise` by header,
/// header's unit. Regression calibration: x* = mean + S_true (S_true + S_noise)^-1 (x - mean) over what the row holds,
/// with robust moments: for an input that is missing there too. `loft_unknown`: the recorded loft is not looked at; a
/// first idea is what shows the launch angle in the closed form.
Inputs make_inputs(const Shots& shots, const Blow& blow, bool head_mass_declared,
                   const std::map<std::string, double>& noise, bool loft_unknown = false);

}  // namespace hosel::loop
