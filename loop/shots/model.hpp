/// A base model with effects on recorded blows: predicted readings of the channels, their derivatives, and the
/// whitening by the covariance of every shot.
#pragma once

#include <cmath>
#include <map>

#include "loop/problem.hpp"
#include "loop/shots/averages.hpp"
#include "loop/shots/surrogate.hpp"
#include "models/flight/flight_budget.hpp"
#include "models/impact_model.hpp"

namespace hosel::loop {

/// What stands for a base that answers slowly: the closed-form eccentric impact of rigid bodies.
const models::ImpactModel& closed_form();
/// First slope of the search for a loft: launch angle per loft, about 0.8.
inline constexpr double kLaunchPerLoft = 0.8;
/// Noise units in every channel that a blow counts which cannot happen.
inline constexpr double kImpossible = 100;
/// One launch and so many times another, in every component.
Launch plus(Launch a, const Launch& b, double times);
/// Row of models::FlightAnswers.
int flight_answer(Output o);

struct ShotChannel : Channel {
  Output output;
};

/// A launch angle that was seen, from which every shot's loft is found: the recorded loft counts for nothing.
struct SeenLaunch {
  ShotChannel channel;
  Eigen::VectorXd value;  ///< per shot, header's unit
};
/// Of a whole shot: quadratic up to the 99.9 % quantile of its squared distance, then logarithmic, constant beyond
/// twelve times that.
solvers::Loss loss_of_shot(int channels);
/// Of a fit to shots: the loss without its cap sees farther.
std::vector<Stage> stages_of_shots(int channels);

class ShotModel {
 public:
  /// `base` must outlive the model. `direct`: the base answers in microseconds and honours the blow's contact
  /// law; otherwise its answers on the trials are computed once and the effects act through the difference that
  /// they make in the closed-form eccentric impact. `measured`: header's units, NaN where missing, shots x channels.
  /// With a `surrogate` that answers instead of the base, and its error joins the covariance of every shot. With a
  /// `seen` launch angle every prediction about a shot is at the loft that shows this angle, which is then no channel.
  /// `flight`: needed where a channel is of the flight, which starts from what the monitor saw of the launch.
  ShotModel(const models::ImpactModel& base, bool direct, std::vector<Shot> trials, std::vector<ShotChannel> channels,
            Eigen::MatrixXd measured, const Surrogate* surrogate = nullptr, std::optional<SeenLaunch> seen = {},
            std::optional<models::FlightConditions> flight = {});

  int shots() const { return int(trials_.size()); }
  int width() const { return int(channels_.size()); }
  const ShotChannel& channel(int c) const { return channels_[c]; }
  ShotChannel& channel(int c) { return channels_[c]; }
  const Shot& trial(int shot) const { return trials_[shot]; }
  const Eigen::MatrixXd& measured() const { return measured_; }
  /// What was measured of a shot [SI], the launch angle that its loft is found from with it.
  std::map<Output, double> seen(int shot) const;
  bool observed(int shot, int channel) const { return !std::isnan(measured_(shot, channel)); }
  int observed(int shot) const { return int((!measured_.row(shot).array().isNaN()).count()); }

  /// Channel values [header's units] of the base with effects, parameters in SI. False where the blow cannot
  /// happen.
  bool predict(const Shot& trial, int shot, const Model& model, const double* parameters, double* out) const;
  bool predict(int shot, const Model& model, const double* parameters, double* out) const {
    return predict(trial(shot), shot, model, parameters, out);
  }
  /// The same and its derivatives by the parameters, per Parameter::scale, by central or one-sided differences; what a
  /// parameter does not touch is not computed again. `derivative` is width x size, column-major. Also false where a
  /// neighbour cannot happen.
  bool differences(const Shot& trial, int shot, const Model& model, const double* parameters, bool central, double* out,
                   double* derivative) const;
  /// The shot as the base is asked about it: at its loft, with the effects in it. False where there is none.
  bool asked(int shot, const Model& model, const double* parameters, Shot& out) const;
  /// Channel values where another model answers, asked anew until the launch angle is the seen one within 0.02 deg.
  /// Throws as it does.
  bool predict_by(const Surrogate::Answer& other, int shot, const Model& model, const double* parameters,
                  double* out) const;
  /// Everything that the base with effects says of a blow that was not measured (companion bases: without the
  /// base's own answer).
  bool launch(Shot trial, const Model& model, const double* parameters, Launch& out) const;
  /// Raw residuals model - measured, shots x channels, NaN where missing; the model with what varies on average in it.
  Eigen::MatrixXd residuals(const Model& model, const double* parameters) const;

  /// The shots are means of so many rows each, which scatter about them: that is their noise from now on. As much wider
  /// as the inverse of a covariance with these `degrees` of freedom is too large on average (Wishart).
  void set_scatter(const Eigen::MatrixXd& scatter, int degrees, std::vector<int> count) {
    scatter_ = scatter * (degrees / double(degrees - width() - 1));
    count_ = std::move(count);
  }
  /// A parameter of this form differs from shot to shot by `sd` [SI], mean zero: joins the covariance of every shot,
  /// and, where it always takes away, its expectation.
  void vary(Parametrisation form, std::size_t parameter, double sd) {
    varying_.push_back({std::move(form), parameter, sd});
  }
  /// Rows in a shot's mean; 1 where it is none.
  int count(int shot) const { return count_.empty() ? 1 : count_[shot]; }

  /// Covariance of the inputs about the trial's values, per shot (8 x 8, SI; none: all exact); sets up the whitening
  /// Sigma_y + J_x Sigma_x J_x^T about the given model.
  void set_covariance(const std::vector<Eigen::MatrixXd>& inputs, const Model& model, const double* parameters);
  /// Lower-triangular W with W Sigma W^T = 1 over the observed channels, zero elsewhere.
  Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> whitening(int shot) const {
    return {whiten_.data() + std::ptrdiff_t(shot) * width() * width(), width(), width()};
  }
  /// The surrogate's error in some shots together, whitened, about a model: (shots * width) squared. Neighbours err
  /// alike, which the covariance of every shot for itself does not say.
  Eigen::MatrixXd surrogate_errors(const std::vector<int>& shots, const Model& model, const double* parameters) const;
  /// Marginal standard deviation of a channel of a shot (instrument and inputs), header's unit.
  double sigma(int shot, int channel) const { return sigma_(shot, channel); }

  /// Whitened residuals of some shots, one after the other (shots * width); a blow that cannot happen counts
  /// kImpossible.
  Eigen::VectorXd whitened(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p) const;
  /// The same with the derivatives per Parameter::scale, by one-sided or central differences; zero derivatives where
  /// the blow or a neighbour cannot happen.
  void linearise(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                 Eigen::MatrixXd& jacobian, bool central = false) const;
  /// The derivatives by central differences.
  Eigen::MatrixXd jacobian(const std::vector<int>& shots, const Model& model, const Eigen::VectorXd& p) const;

 private:
  Launch answer(const Shot& trial, int shot) const;
  /// The launch of a trial, which is left as the effects change it.
  Launch launched(Shot& trial, int shot, const Model& model, const double* parameters) const;
  /// What the instrument shows of the launch angle that the loft follows [SI].
  double seen_angle(const Shot& trial, const Model& model, const double* parameters, const Launch& launch) const;
  /// Puts the trial's loft where the model shows the launch angle that was seen.
  bool find_loft(Shot& trial, int shot, const Model& model, const double* parameters) const;
  /// What the instrument shows of `value` [SI].
  double reading(const ShotChannel& channel, const Shot& trial, const Model& model, const double* parameters,
                 double value) const;
  /// Covariance by the noise of the launch angle and by the surrogate's error, header's units.
  Eigen::MatrixXd found_covariance(int shot, const Model& model, const double* parameters) const;
  /// What the channels show of the launch angle that the loft follows (per its unit), and of an error of the answer
  /// about a shot as it is asked: width and width x 6, header's units. Throws as the base does.
  struct Shown {
    Eigen::VectorXd by_launch;
    Eigen::MatrixXd by_error;
  };
  Shown shown(int shot, const Shot& asked, const Model& model, const double* parameters) const;
  /// The stages of a prediction: the blow as the effects change it, the launch, the readings.
  static void change(const Model& model, const double* parameters, Shot& trial);
  static void change(const Model& model, const double* parameters, const Shot& trial, Launch& launch);
  bool read(const Shot& trial, int shot, const Model& model, const double* parameters, const Launch& launch,
            double* out) const;
  /// The flight of a shot whose launch was seen, without effects; where it was not, or has no flight, the shot has no
  /// readings of it.
  void follow_seen(int shot);
  /// The flight of a trial under the effects, from the launch that was seen, else from the model's.
  models::FlightAnswers follow(const Shot& trial, int shot, const Model& model, const double* parameters,
                               const Launch& launch) const;
  /// Law, air and wind as the effects change them.
  models::FlightConditions conditions(const Model& model, const double* parameters) const;
  /// What the noise of the seen launch does to the flight's readings and to their agreement with the launch's.
  void add_launch_noise(int shot, const models::FlightConditions& conditions, Eigen::MatrixXd& covariance) const;
  void whiten(int shot, const Model& model, const double* p, double* scratch, double* z) const;
  void linearise(int shot, const Model& model, const double* p, bool central, Eigen::Ref<Eigen::VectorXd> z,
                 Eigen::MatrixXd& J) const;
  /// What the mean over inputs that differ lies beyond the answer to their mean, to second order.
  Eigen::VectorXd by_curvature(int shot, const Model& model, const double* parameters,
                               const Eigen::MatrixXd& covariance) const;
  /// Sensitivity of the channels to the inputs about a model: width x 8, header's units per SI.
  Eigen::MatrixXd input_jacobian(int shot, const Model& model, const double* parameters, unsigned mask) const;
  /// What the rows' scatter does to the residual of their mean, header's units.
  Eigen::MatrixXd scattered(int shot, const Model& model, const double* parameters) const;

  struct Varying {
    Parametrisation form;
    std::size_t parameter;
    double sd;
  };
  /// What the channels show of one standard deviation of it, to second order: readings move by
  /// `linear` u + `square` u^2, u normal; by nothing where the model has no answer.
  struct Varied {
    Eigen::VectorXd linear, square;
  };
  Varied varied(int shot, const Model& model, const double* parameters, const Varying& by) const;

  const models::ImpactModel& base_;
  bool direct_;
  const Surrogate* surrogate_;
  std::optional<SeenLaunch> seen_;
  std::vector<Shot> trials_;
  std::vector<ShotChannel> channels_;
  Eigen::MatrixXd measured_;
  Eigen::MatrixXd expected_;  ///< what a model with nothing that varies should show: measured less what varying adds
  Eigen::MatrixXd scatter_;   ///< see Averages
  std::vector<int> count_;    ///< rows in every shot's mean; empty: the shots are no means
  std::vector<Varying> varying_;
  std::vector<double> whiten_;
  Eigen::MatrixXd sigma_;
  std::optional<models::FlightConditions> flight_;
  bool flies_ = false;
  std::vector<models::FlightAnswers> flights_;  ///< of the shots whose launch was seen, without effects
  std::vector<std::optional<Launch>> offset_;   ///< base minus companion at the trials, for bases that are not direct
};

}  // namespace hosel::loop
