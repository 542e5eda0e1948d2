/// Measured flights as a Problem of the engine. The unknowns of a shot and of its group are Gaussian about zero and
/// integrated out of the likelihood: with the slopes J of the readings by the unknowns u about their most likely values
/// u0,
///   z = L^-1 (f(u0) - J u0 - y),  L L^T = N + J D J^T
/// over all readings of a group, N the noise, D the variances of the unknowns. u0 is computed again in every pass.
#pragma once

#include <map>
#include <set>

#include "loop/flights/case.hpp"
#include "loop/problem.hpp"
#include "loop/result.hpp"
#include "loop/shots/structure.hpp"

namespace hosel::loop {

class FlightProblem final : public Problem {
 public:
  /// The value of the unknowns about which a flight is linear: the likeliest, or as recorded.
  enum class About { likeliest, record };
  /// Throws DataError where no row holds a launch and a reading of its flight.
  explicit FlightProblem(const FlightCase& c, About about = About::likeliest);

  /// The same launches with the readings of another case, whose rows are the same; it refers to this problem's case.
  FlightProblem with_readings(const FlightCase& c) const;
  /// Noise that is not declared is that of a problem with the same channels: that of a few readings would be the less
  /// the better they happen to fit.
  void hold_noise(const FlightProblem& as);

  /// Every form that acts on a flight alone.
  std::vector<Parametrisation> forms() const;
  static constexpr const char* kNoFlight = "no flight from this launch";  ///< a reason
  const std::map<std::string, int>& unused() const { return unused_; }    ///< reason, rows

  int width() const override { return int(channels_.size()); }
  const Channel& channel(int c) const override { return channels_[std::size_t(c)]; }
  void refute(int c, bool refuted) override { channels_[std::size_t(c)].refute(refuted); }
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
  std::vector<Stage> stages() const override { return stages_of_shots(width()); }

  bool screen(const Selection& selection) override;
  Scatter scatter(int channel, const Eigen::MatrixXd& residuals, int fitted) const override;
  /// Everything unknown included.
  double sigma(int trial, int channel) const override;
  double update_noise(const Fit& selected, const Fit& richest) override;

  StructureMap structure(const Fit& fit, const Fit& near, const Eigen::MatrixXd& directions,
                         const Rules& rules) const override;
  std::vector<Location> places(const Selection& selection) const override;
  std::vector<Location> shapes(const Selection& selection) const override;
  std::vector<Location> doubts(const Selection& selection) const override;
  NextExperiment next_experiment(const LoopResult& so_far) const override;

 private:
  static constexpr int kGroup = 3;  ///< wind along, wind to the right, slope
  using GroupUnknowns = Eigen::Matrix<double, kGroup, 1>;

  struct Reading {
    int answer = -1;  ///< FlightAnswer, or
    PathPoint point{0, 0};

    bool aside() const;  ///< it hangs on the direction of the launch
  };
  struct Trial {
    models::MeasuredPath shot;  ///< launch, air, group, deviations of the unknowns
    int row = 0;                ///< of the file
    double order = 0;
    models::ShotUnknowns own = models::ShotUnknowns::Zero();  ///< u0
    Eigen::MatrixXd by_own, by_group;                         ///< channels x unknowns, header's units
  };
  /// The rows of a part that belong to one group, their observed readings, and the factor of their covariance.
  struct Block {
    std::vector<int> trials;
    std::vector<Eigen::Index> place;            ///< of each trial among those of the part
    std::vector<std::pair<int, int>> readings;  ///< place in `trials`, channel
    Eigen::MatrixXd factor;                     ///< L

    Eigen::VectorXd of(const Eigen::MatrixXd& e) const;  ///< these readings of the part's errors
  };

  void read();
  void split();
  void expand(const Model& model, const Eigen::VectorXd& p);
  void slopes(const Model& model, const Eigen::VectorXd& p);
  void slopes(Trial& t, const GroupUnknowns& group, const Model& model, const Eigen::VectorXd& p) const;
  std::vector<Block> blocks(const std::vector<int>& trials) const;
  void factor();
  /// Header's units; NaN: the shot has no such flight.
  Eigen::VectorXd predict(const Trial& t, const Model& model, const double* p, const models::ShotUnknowns& own,
                          const GroupUnknowns& group) const;
  /// Of the trials of a part, one after the other: f(u0) - J u0 - y, NaN where nothing is measured.
  bool errors(const std::vector<int>& trials, const Model& model, const Eigen::VectorXd& p, Eigen::MatrixXd& e) const;
  const std::vector<int>& trials(Part part) const { return part == Part::holdout ? holdout_ : train_; }
  const std::vector<Block>& blocks(Part part) const { return part == Part::holdout ? held_blocks_ : train_blocks_; }
  Eigen::VectorXd whiten(Part part, const Eigen::MatrixXd& e) const;
  std::optional<std::pair<std::string, std::string>> slip_of(int trial, const Fit& at) const;
  std::optional<Location> wide_winds() const;
  std::set<int> groups_with_flights() const;
  void estimate_noise(const Fit* at);
  GroupUnknowns group_sd() const { return {case_.unknown.wind, case_.unknown.wind, case_.unknown.slope}; }

  const FlightCase& case_;
  std::vector<Channel> channels_;
  std::vector<Reading> readings_;
  std::vector<double> instants_;  ///< of the path's channels [s]
  std::vector<Trial> trials_;
  std::vector<std::string> groups_;
  std::vector<GroupUnknowns> group_;  ///< u0
  Eigen::MatrixXd measured_;          ///< trials x channels, header's units
  std::vector<int> train_, holdout_;
  std::vector<Block> train_blocks_, held_blocks_;
  std::set<int> out_;  ///< trials that are flagged
  std::vector<Flag> flags_;
  std::map<std::string, int> unused_;
  int unaimed_ = 0;  ///< rows with such a reading and no azimuth
  std::vector<Regressor> regressors_;
  bool updated_ = false;
};

/// Throws DataError where nothing can be compared.
LoopResult run(const FlightCase& c);

}  // namespace hosel::loop
