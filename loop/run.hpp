/// The loop itself: from measured shots and a base model to a verdict.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hosel/loop/absorption.hpp"
#include "hosel/loop/audit.hpp"
#include "hosel/loop/balances.hpp"
#include "hosel/loop/screen.hpp"
#include "hosel/loop/select.hpp"

namespace hosel::loop {

struct Split {
  double holdout_fraction = 1.0 / 3.0;
  unsigned long seed = 1;
  std::string by;              ///< column whose clusters are held out whole; empty: rows
  bool leave_one_out = false;  ///< every cluster is the holdout once
};

struct LoopCase {
  std::string title;
  std::string base;  ///< name of the model
  const models::ImpactModel* model = nullptr;
  bool direct = true;                ///< see Problem
  bool head_turns = true;            ///< the base lets the head rotate
  std::vector<std::string> effects;  ///< declared part of the base; their parameters are fitted
  Blow blow;                         ///< ball, head, contact law; the delivery comes from the shots
  bool head_mass_declared = false;
  bool inertia_declared = false;
  Shots shots;
  std::map<std::string, double> noise;        ///< by header, header's unit
  std::map<std::string, double> input_noise;  ///< the same for inputs
  Split split;
  Rules rules;
  std::vector<std::string> notes;  ///< about the case itself
};

enum class Verdict { no_residual, explained, ambiguous, unexplained, insufficient, noise_contradicted };
std::string_view name(Verdict verdict);

struct Errors {
  double train_rmse = 0, holdout_rmse = 0, holdout_bias = 0;
  int train = 0, holdout = 0;
};

struct ChannelResult {
  std::string name;
  double noise = 0;
  std::string noise_source;  ///< declared, estimated
  double scatter = 0;        ///< what the residual of the final model shows, over `noise`
  Errors before, after;
};

struct Detectable {
  std::string effect, parameter, unit;
  double value = 0;  ///< printed unit
};

struct Location {
  std::string channel, regressor, detail;
};

struct DesignedShot {
  std::vector<std::pair<std::string, double>> inputs;  ///< header, header's unit
};

struct NextExperiment {
  std::string text;
  std::vector<DesignedShot> shots;
  std::optional<std::string> sensor;
};

struct ScoredCandidate {
  Candidate candidate;
  std::vector<double> sd;  ///< per parameter [SI]
  double holdout_score = 0;
};

struct UsedShot {
  int row;  ///< of the file
  std::string id;
  bool holdout;
  std::vector<double> measured, before, after;  ///< per channel, header's unit; before and after: model minus measured
};

struct LoopResult {
  LoopResult() = default;
  LoopResult(LoopResult&&) = default;  // the models below point into `forms`: moved, never copied
  LoopResult& operator=(LoopResult&&) = default;

  std::vector<Form> forms;  ///< every form that was tried
  std::string title, base;
  int read = 0, used = 0, train = 0, holdout = 0;
  unsigned long seed = 1;
  struct Flag {
    int row;
    std::string shot, column, reason;
    int finding;
  };
  std::vector<Flag> flagged;
  std::map<std::string, int> unused;  ///< reason, rows that could not be used
  std::vector<DerivedColumn> derived;
  std::vector<ChannelResult> channels;
  Selection selection;
  std::vector<std::string> channel_names;  ///< of the fit: the structure map's numbering
  std::vector<ScoredCandidate> candidates;
  double base_score = 0;
  std::vector<std::string> adopted;
  std::vector<std::vector<std::string>> ties;
  Verdict verdict = Verdict::no_residual;
  std::vector<Detectable> minimum_detectable;
  std::vector<Location> unexplained;
  NextExperiment next;
  std::vector<UsedShot> shots;
  std::vector<std::string> notes;  ///< sentences for people: assumptions, absorptions, contradictions
  Likeness likeness;               ///< of the effects to each other and to what is fitted
  std::optional<Balance> balance_before, balance_after;  ///< of the training shots; absent for time histories
  std::vector<std::pair<std::string, std::vector<std::string>>> without;  ///< doubted column, adopted without it
};

/// More rows than this are refused: everything is held in memory, and no effect needs so many.
inline constexpr std::size_t kMostShots = 200'000;

/// Throws DataError where the data cannot be used at all.
LoopResult run(const LoopCase& c);

}  // namespace hosel::loop
