/// The result of a loop, as its reports contain it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/case.hpp"
#include "loop/likeness.hpp"
#include "loop/select.hpp"
#include "loop/shots/audit.hpp"
#include "loop/shots/balances.hpp"
#include "loop/wrong_columns.hpp"

namespace hosel::loop {

enum class Verdict { no_residual, explained, ambiguous, unexplained, insufficient, noise_contradicted };
std::string_view name(Verdict verdict);

struct Errors {
  double train_rmse = 0, holdout_rmse = 0, holdout_bias = 0;
  int train = 0, holdout = 0;
};

struct ChannelResult {
  std::string name;
  double noise = 0;
  std::string noise_source;       ///< declared, repeats (of which a reading is the mean), estimated
  std::optional<double> refuted;  ///< what was declared, where the data's own scatter contradicts it
  double scatter = 0;             ///< what the residual of the final model shows, over `noise`
  /// RMS of the held-out rows about the right model: by the instrument, and by what is not known of the inputs.
  double expected = 0;
  Errors before, after;
  Errors with_remainder;  ///< after, and the remainder taken away

  std::string refutation() const;  ///< in a sentence
};

/// A row that is not used, since nothing explains it.
struct Flag {
  int row;                          ///< of the table
  std::optional<std::size_t> line;  ///< in the file; absent in a record of a bench test
  std::string id;                   ///< what the file calls it
  std::string column, reason;
  int finding;  ///< rows of one cause share it
};

struct Detectable {
  std::string effect, parameter, unit;
  double value = 0;  ///< printed unit; NaN: beyond the plausible range
};

struct Location {
  std::string channel, regressor, detail;
  bool rival = false;  ///< no structure, but what says as much as a name
};
/// Where a finding in one channel is.
Location place_of(const Problem& problem, const Finding& finding);

using DesignedShot = std::vector<std::pair<std::string, double>>;  ///< header, header's unit

struct NextExperiment {
  std::string text;
  std::vector<DesignedShot> shots = {};
  std::optional<std::string> sensor = {};
};

struct ScoredCandidate {
  Candidate candidate;
  std::vector<double> sd;  ///< per parameter [SI]; infinite where the data do not show it
  double holdout_score = 0;
};

struct UsedRow {
  int row;  ///< of the file
  std::string id;
  bool holdout;
  std::vector<double> measured, before, after;  ///< per channel, header's unit; before and after: model minus measured
  std::vector<double> with_remainder = {};      ///< after, less the remainder: of a training row as others foretell it
};

/// Of a channel on the two sets of rows, where there is a value; `of`: before or after.
Errors errors(const std::vector<UsedRow>& rows, std::vector<double> UsedRow::*of, std::size_t channel);

/// A slow base itself, without a surrogate, asked about shots that were held out.
struct Corrected {
  std::vector<UsedRow> rows;  ///< with the id; before and after, both NaN where one has no answer
  /// Shots with the adopted effects in them, as the base is asked about them, and what was measured.
  struct Asked {
    std::string id;
    Shot shot;
    std::map<Output, double> measured;  ///< SI
  };
  std::vector<Asked> shots;
  std::vector<std::string> instrument;  ///< adopted effects on what the instrument shows, which no blow holds
};

struct LoopResult {
  LoopResult() = default;
  /// Of a case whose data have so many rows, before anything is found.
  LoopResult(const Case& c, std::size_t of) : title(c.title), base(c.base), read(int(of)), seed(c.split.seed) {}
  LoopResult(LoopResult&&) = default;  // the models below point into `forms`: moved, never copied
  LoopResult& operator=(LoopResult&&) = default;

  std::vector<Parametrisation> forms;  ///< every form that was tried
  std::string title, base;
  int read = 0, used = 0, train = 0, holdout = 0;
  unsigned long seed = 1;
  std::vector<Flag> flagged;
  std::map<std::string, int> unused;  ///< reason, rows that could not be used
  std::vector<DerivedColumn> derived;
  std::vector<WrongColumn> columns;  ///< whole columns that contradict their header
  std::vector<ChannelResult> channels;
  Selection selection;
  Eigen::MatrixXd covariance;  ///< of the parameters of `selection.chosen` [SI]; infinite along null vectors
  std::vector<std::string> channel_names;  ///< of the fit: the findings' numbering
  std::vector<ScoredCandidate> candidates;
  double base_score = 0;
  std::vector<std::string> adopted;
  std::vector<std::vector<std::string>> ties;
  Verdict verdict = Verdict::no_residual;
  std::vector<Detectable> minimum_detectable;
  std::vector<Location> unexplained;
  std::vector<Mechanism> functions;    ///< the likeliest; their criterion is less that of the chosen effects
  std::optional<Remainder> remainder;  ///< of the model behind `after`
  std::vector<GroupSpread> groups;     ///< of the same model, without the remainder
  NextExperiment next;
  std::vector<UsedRow> rows;
  std::string tails;               ///< that the noise is not normal, in words; empty: nothing says so
  std::string faint;               ///< the function that is likelier than no effect, not beyond doubt; empty: none
  std::vector<std::string> notes;  ///< sentences for people: assumptions, absorptions, contradictions
  Likeness likeness;               ///< of the effects to each other and to what is fitted
  std::optional<Balance> balance_before, balance_after;  ///< of the training shots; absent for time histories
  std::optional<Corrected> corrected;                    ///< of a slow base
  /// Of a surrogate: shots about which its error is no small part of the noise, and some where it is checked.
  std::vector<Shot> decisive, checks;
  std::vector<std::pair<std::string, std::vector<std::string>>> without;  ///< doubted column, adopted without it
};

}  // namespace hosel::loop
