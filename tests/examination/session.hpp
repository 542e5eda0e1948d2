#pragma once
// A session of shots: what was declared, what happened, what was recorded.

#include <string>
#include <vector>

#include "forms.hpp"
#include "random.hpp"

namespace examination {

/// Recorded output. The slot says what it is, whatever the unit: 0 ball speed, 1 launch, 2 azimuth,
/// 3 backspin or spin rate, 4 sidespin or spin axis.
struct Channel {
  enum class Quantity { ball_speed, launch, azimuth, backspin, sidespin, spin_rate, spin_axis };
  std::string header;
  Quantity quantity;
  int slot;
  double unit;           ///< SI per recorded unit
  double noise_sd;       ///< recorded units
  double resolution;     ///< recorded units
  bool declared = true;  ///< whether the case tells the noise
};

/// Recorded input.
struct Column {
  std::string header;
  double Swing::*member;
  double unit, noise_sd, resolution;
};

/// A further column, as text; offered to the loop, used by no base model.
struct Extra {
  std::string header;
  std::vector<std::string> cells;
};

struct Session {
  std::string base;  ///< rigid-planar or rigid-eccentric
  Head head;
  Ball ball;
  std::vector<Channel> channels;
  std::vector<Column> inputs;
  std::vector<Extra> extras;
  std::vector<Swing> swings;         ///< what happened
  std::vector<double> head_mass_kg;  ///< per shot; all the head's own where no column tells it
  bool mass_column = false;          ///< per club, in club_means.csv
  std::vector<int> cluster;          ///< per shot; empty without clusters
  std::string cluster_column;
  std::vector<std::string> cluster_names;
  bool split_by_cluster = false;
  Eigen::MatrixXd recorded_inputs;   ///< shots x inputs, recorded units
  Eigen::MatrixXd recorded_outputs;  ///< shots x channels, recorded units; NaN = missing
  int shots() const { return static_cast<int>(swings.size()); }
};

struct SessionOptions {
  std::string base;
  int shots;
  bool input_noise = false;
  bool clusters = false;
  bool wedge = false;        ///< an iron of high loft, where a real ball slides
  double impact_spread = 1;  ///< factor on the spread of the impact point
};

/// A random head, golfer, monitor and plan of shots; nothing recorded yet.
Session draw_session(const SessionOptions& options, Random& random);

/// Outputs of the given swings under a truth, shots x channels, recorded units, without noise or rounding.
Eigen::MatrixXd predict(const Session& session, const std::vector<Swing>& swings, const Truth& truth);
/// The base as declared in the case.
Truth base_truth(const Session& session);
/// The swings as recorded.
std::vector<Swing> recorded_swings(const Session& session);
/// Records the inputs: noise, then rounding to the resolution.
void record_inputs(Session& session, Random& random);
double round_to(double value, double resolution);

/// Per shot, the inverse Cholesky factor of S_y + J_x S_x J_x' (noise and rounding of outputs and inputs).
std::vector<Eigen::MatrixXd> whitening(const Session& session, const std::vector<Swing>& swings);

struct Fit {
  std::vector<double> value, sd;  ///< of all forms' parameters, in order
  double distance = 0;            ///< whitened norm of what is left
  Eigen::MatrixXd outputs;        ///< of all shots
};

/// Fits the forms together to `target` (shots x channels) on the chosen rows by damped Gauss-Newton from every
/// start, within the plausible range widened by half.
Fit fit(const Session& session, const std::vector<Swing>& swings, const std::vector<const Form*>& forms,
        const Eigen::MatrixXd& target, const std::vector<Eigen::MatrixXd>& whitening, const std::vector<int>& rows,
        bool bounded = true);

}  // namespace examination
