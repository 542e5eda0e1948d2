/// The data as a fit sees them: trials, measured channels, the covariance of every shot, and the base model
/// with effects on top.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hosel/loop/effect.hpp"
#include "hosel/models/impact_model.hpp"

namespace hosel::loop {

struct Channel {
  std::string name;  ///< the header
  Output output;
  double si = 1;     ///< one of the header's unit in SI
  double noise = 0;  ///< standard deviation of the instrument, header's unit
  bool declared = false;
  double resolution = 0;  ///< header's unit
};

/// An input column with noise, or with missing cells that were filled.
struct NoisyInput {
  Input input;
  double noise = 0;  ///< [SI]; 0 exact
};

/// Effects on top of the base model, in the order in which their hooks are applied.
struct Model {
  std::vector<const Form*> forms;

  int size() const;  ///< number of parameters
  std::vector<const Parameter*> parameters() const;
};

class Problem {
 public:
  /// `base` must outlive the problem. `direct`: the base answers in microseconds and honours the blow's contact
  /// law; otherwise its answers on the trials are computed once and the effects act through the difference that
  /// they make in the closed-form eccentric impact.
  Problem(const models::ImpactModel& base, bool direct, std::vector<Trial> trials, std::vector<Channel> channels,
          Eigen::MatrixXd measured);

  int shots() const { return int(trials_.size()); }
  int width() const { return int(channels_.size()); }
  const std::vector<Channel>& channels() const { return channels_; }
  const Trial& trial(int shot) const { return trials_[std::size_t(shot)]; }
  /// Measured values, header's units, NaN where missing: shots x channels.
  const Eigen::MatrixXd& measured() const { return measured_; }
  bool observed(int shot, int channel) const { return measured_(shot, channel) == measured_(shot, channel); }

  /// Channel values [header's units] of the base with effects, parameters in SI. False where the blow cannot
  /// happen.
  bool predict(const Trial& trial, int shot, const Model& model, const double* parameters, double* out) const;
  bool predict(int shot, const Model& model, const double* parameters, double* out) const {
    return predict(trial(shot), shot, model, parameters, out);
  }
  /// The same with the derivatives by the parameters, per Parameter::scale, by differences over `step` scales
  /// (one-sided, or central); what a parameter does not touch is not computed again. `derivative` is width x
  /// size, column-major. Also false where a neighbour cannot happen.
  bool linearise(int shot, const Model& model, const double* parameters, double step, bool central, double* out,
                 double* derivative) const;
  /// Everything that the base with effects says of a blow that was not measured (companion bases: without the
  /// base's own answer).
  bool launch(Trial trial, const Model& model, const double* parameters, Launch& out) const;

  void set_noise(int channel, double noise) { channels_[std::size_t(channel)].noise = noise; }
  /// Covariance of the inputs about the trial's values, per shot (8 x 8, SI); sets up the whitening
  /// Sigma_y + J_x Sigma_x J_x^T about the given model.
  void set_covariance(const std::vector<Eigen::MatrixXd>& inputs, const Model& model, const double* parameters);
  /// Lower-triangular W with W Sigma W^T = 1 over the observed channels, zero elsewhere.
  Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> whitening(int shot) const {
    return {whiten_.data() + std::ptrdiff_t(shot) * width() * width(), width(), width()};
  }
  /// Marginal standard deviation of a channel of a shot (instrument and inputs), header's unit.
  double sigma(int shot, int channel) const { return sigma_(shot, channel); }
  /// Sensitivity of the channels to the inputs about a model: width x 8, header's units per SI.
  Eigen::MatrixXd input_jacobian(int shot, const Model& model, const double* parameters, unsigned mask) const;

  /// Raw residuals model - measured, shots x channels, NaN where missing.
  Eigen::MatrixXd residuals(const Model& model, const double* parameters) const;

 private:
  Launch answer(const Trial& trial, int shot) const;
  /// The three stages of a prediction: the blow as the effects change it, the launch, the readings.
  static void change(const Model& model, const double* parameters, Trial& trial);
  static void change(const Model& model, const double* parameters, const Trial& trial, Launch& launch);
  bool read(const Trial& trial, int shot, const Model& model, const double* parameters, const Launch& launch,
            double* out) const;

  const models::ImpactModel& base_;
  bool direct_;
  std::vector<Trial> trials_;
  std::vector<Channel> channels_;
  Eigen::MatrixXd measured_;
  std::vector<double> whiten_;
  Eigen::MatrixXd sigma_;
  struct Companion;
  std::vector<Launch> offset_;  ///< base minus companion at the trials, for bases that are not direct
};

}  // namespace hosel::loop
