/// The interface between measured data with a base model, and the fit, the search and the verdict. Implementations:
/// shots (shots/problem), time histories (history/problem) and flights (flights/problem). Only parts that depend on the
/// kind of data are behind this interface.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "loop/effect.hpp"
#include "solvers/least_squares.hpp"

namespace hosel::loop {

struct Rules;
struct Fit;
struct Selection;
struct StructureMap;
struct Location;
struct Flag;
struct LoopResult;
struct NextExperiment;

struct Channel {
  std::string name;                ///< the header
  double si = 1;                   ///< one of the header's unit in SI
  double noise = 0;                ///< standard deviation of one reading, header's unit
  std::optional<double> declared;  ///< what the case says of it, with the rounding of its numbers
  double resolution = 0;           ///< recording step, header's unit
  bool refuted = false;            ///< the data's own scatter contradicts what is declared
  bool repeated = false;           ///< what stands as declared is the scatter of rows of which a reading is the mean

  bool trusted() const { return declared && !refuted; }
  /// What no instrument is below: its last digit.
  double least_noise() const { return std::max(rounding_deviation(resolution), kRoundOff); }
  /// Of a channel whose noise is declared.
  void refute(bool by_scatter) {
    if (refuted && !by_scatter) noise = *declared;
    refuted = by_scatter;
  }
};

/// Effects on top of the base model, in the order in which they are applied.
struct Model {
  std::vector<const Parametrisation*> forms;

  int size() const;  ///< number of parameters
  std::vector<const Parameter*> parameters() const;
  Model with(const Parametrisation* more) const;
  std::vector<std::string> effects(std::size_t first = 0) const;  ///< of its forms, from that one on
  /// `act` of every form and its own of all the parameters.
  template <class Act>
  void each(const double* p, Act&& act) const {
    for (const Parametrisation* f : forms) {
      act(*f, Sizes(p, f->parameters.size()));
      p += f->parameters.size();
    }
  }
};

/// Which of the data: those that effects are selected on (not more than needed), all that train, those held out.
enum class Part { select, train, holdout };

/// What a fit looks at in turn: an early stage sees far and is rough, the last one counts.
struct Stage {
  static constexpr double kWhole = kInfinity;
  double window = kWhole;  ///< how much of every record from its start [s]
  solvers::Loss loss;
  int iterations = 40;
};

/// How much a search may ask of the model.
struct Effort {
  std::size_t starts = 2;  ///< followed per form, the best ones
  std::size_t pairs = 36;  ///< refitted of those that linear algebra about the base promises; 0: too far from linear
  std::size_t singles_grown = 0;  ///< best single forms that pairs are grown from,
  std::size_t pairs_grown = 4;    ///< best pairs that triples are,
  std::size_t grown = 6;          ///< with so many forms each, the most promising beside them
  std::size_t reported = 25;      ///< candidates that are scored on the holdout
};

/// Scatter of a channel's residuals.
struct Scatter {
  double ratio = 1;  ///< over the noise
  double error = 1;  ///< of log ratio
};

/// One function that acts through one mechanism, as a verdict sees it.
struct Mechanism {
  std::string acts;                ///< through what, in words
  std::string along;               ///< the column that it is a function of; "shot": of the place in the session
  bool step = false;               ///< it changes at one shot of the session
  int channel = 0;                 ///< that it moves most, in noise units
  double criterion = 0;            ///< deviance with it, and what the freedom of the function costs
  std::vector<std::string> names;  ///< effects that such a function is; none: it has no name
};

/// What a model leaves that follows the inputs and has no name: a rival of every name, and what corrects a prediction
/// beside the named effects.
struct Remainder {
  /// Where it is in one channel.
  struct Place {
    int channel = 0;
    double size = 0;     ///< root mean square over the training rows, header's unit
    std::string along;   ///< the column that it follows most
    double share = 0;    ///< of its square that goes when this column stands still
    double largest = 0;  ///< header's unit
    double at = 0;       ///< value of that column there, its unit; of "shot": place in the session
  };
  /// Rows x channels, header's units: to be taken from model minus measured. Of a training row as the others foretell
  /// it.
  Eigen::MatrixXd value;
  double before = 0, after = 0;  ///< deviance of the training rows that it is judged on, without it and with it
  std::vector<Place> places;     ///< the largest in noise units first; none: it foretells nothing

  double fall() const { return before - after; }
};

/// An effect that draws the records of an input to their mean and leaves the mean where it is: noise of the records
/// does so too.
struct Attenuation {
  std::string effect, column;
  double share = 0;  ///< of noise in the variance of the records
};

/// What is left of effects beside errors that the shots of a group share.
struct Clustered {
  std::string along;  ///< the column whose values are the groups
  double fall = 0;    ///< of the deviance, by all effects together [squared noise units]
};

/// How far one quantity differs between groups of shots, if the residual comes from it alone: standard deviation and
/// its 95 % interval.
struct GroupSpread {
  std::string along;  ///< the column whose values are the groups; "shot": stretches of the session
  std::string of;     ///< restitution, tangential_restitution, or the channel whose reading is off
  std::string unit;   ///< 1: none
  int groups = 0;
  double sd = 0, low = 0, high = 0;
  double p = 1;  ///< of a difference as large, if the groups are alike
};

class Problem {
 public:
  virtual ~Problem() = default;

  // --- the data
  virtual int width() const = 0;  ///< number of channels
  virtual const Channel& channel(int c) const = 0;
  /// Of every channel.
  Eigen::ArrayXd noise() const {
    return Eigen::ArrayXd::NullaryExpr(width(), [&](Eigen::Index c) { return channel(int(c)).noise; });
  }
  virtual void refute(int channel, bool refuted) = 0;  ///< what was refuted by an early fit may hold after all
  struct Row {
    int index;       ///< row of measured() and residuals()
    int row;         ///< of the file (of all records, one after the other)
    std::string id;  ///< what the file calls it
    bool holdout;
  };
  virtual std::vector<Row> rows() const = 0;               ///< that are used
  virtual const Eigen::MatrixXd& measured() const = 0;     ///< rows x channels, header's units, NaN where missing
  virtual std::vector<Flag> flags() const = 0;             ///< rows that are not used since nothing explains them
  virtual std::vector<std::string> notes() const = 0;      ///< sentences for people about the data and their noise
  virtual std::optional<std::string> too_few() const = 0;  ///< a sentence where nothing can be tested

  // --- residuals, model minus measured
  /// Whitened, zero where nothing is measured, up to `window` after a record's start. False where the model has no
  /// answer.
  virtual bool whitened(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                        double window = Stage::kWhole) const = 0;
  /// The same with the derivatives per Parameter::scale, to the accuracy that a search needs.
  virtual bool linearise(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z,
                         Eigen::MatrixXd& jacobian, double window) const = 0;
  /// Those derivatives as accurately as differences allow.
  virtual Eigen::MatrixXd jacobian(Part part, const Model& model, const Eigen::VectorXd& p) const = 0;
  /// Raw, header's units: all rows x channels, NaN where missing.
  virtual Eigen::MatrixXd residuals(const Model& model, const Eigen::VectorXd& p) const = 0;
  /// Number of values of a part, and the sum of the logarithms of their whitening factors.
  struct Density {
    double values = 0, log_whitening = 0;
  };
  virtual Density density(Part part) const = 0;
  /// Subsets of the judged training blocks in which a true effect has one size; none: not looked at.
  virtual std::vector<std::vector<bool>> subsets() const { return {}; }
  virtual std::vector<Stage> stages() const = 0;  ///< of a fit; the loss of the last is the one that counts
  virtual Effort effort() const { return {}; }

  // --- rows and noise, measured about a fit
  /// Leaves out what neither this selection nor any other model of the family can explain. False where so many rows
  /// changed that effects must be selected anew.
  virtual bool screen(const Selection& selection) = 0;
  virtual Scatter scatter(int channel, const Eigen::MatrixXd& residuals, int fitted) const = 0;
  /// Standard deviation of a reading about the right model, header's unit: by the instrument, and by what is not known
  /// of the inputs. `row`: Row::index.
  virtual double sigma(int /*row*/, int channel) const { return this->channel(channel).noise; }
  /// Measures noise that is not known, about the selected model or the one that fits best whatever it takes. Returns
  /// the largest relative change.
  virtual double update_noise(const Fit& selected, const Fit& richest) = 0;

  // --- what is left
  /// Is there structure in the residual of a fit? `near` is the model whose residual is nearest to noise; `directions`
  /// are whitened columns, each a test of its own.
  virtual StructureMap structure(const Fit& fit, const Fit& near, const Eigen::MatrixXd& directions,
                                 const Rules& rules) const = 0;
  /// What of it follows the inputs and has no name, learnt from the training rows alone. Absent: not looked for.
  virtual std::optional<Remainder> remainder(const Fit& /*fit*/) const { return {}; }
  /// One free function through one mechanism in place of the chosen effects: the likeliest, and what is as likely.
  /// Where none is chosen, on what was held out too.
  virtual std::vector<Mechanism> mechanisms(const Selection& /*selection*/, const Rules& /*rules*/) const { return {}; }
  /// Effects of a fit that do no more than noise of a recorded input does.
  virtual std::vector<Attenuation> attenuations(const Fit& /*fit*/) const { return {}; }
  /// The effects of a fit beyond those of the base, beside errors that the shots of a group share; absent where groups
  /// differ by no more than chance lets them.
  virtual std::optional<Clustered> clustered(const Fit& /*base*/, const Fit& /*fit*/) const { return {}; }
  /// How far groups of shots differ in what a fit leaves.
  virtual std::vector<GroupSpread> between_groups(const Fit& /*fit*/) const { return {}; }
  /// Where it sits, the plainest first.
  virtual std::vector<Location> places(const Selection& selection) const = 0;
  /// What scatter alone does not do, where the scatter is not the declared: a shape, a mixture, unknowns beyond their
  /// declared size.
  virtual std::vector<Location> shapes(const Selection& selection) const;
  /// A sentence where more rows lie far off than the declared noise allows, and in no one column: its tails are
  /// heavier.
  virtual std::optional<std::string> heavy_tails(const Selection& /*selection*/) const { return {}; }
  /// Why no model that is fitted to these data is to be trusted: rows lost, or missed by many noise scales.
  virtual std::vector<Location> doubts(const Selection& selection) const;
  /// What to measure to break a tie, or to find the effect without a name.
  virtual NextExperiment next_experiment(const LoopResult& so_far) const = 0;
};

}  // namespace hosel::loop
