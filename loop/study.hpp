/// One pass of the loop: effects are selected, rows screened and the noise measured in turn until nothing changes.
#pragma once

#include "loop/select.hpp"

namespace hosel::loop {

struct Study {
  /// `forms`: every form that can act, outliving the study; `declared`: effects that are part of the base, their first
  /// form's parameters fitted. Throws DataError where one of them has no form.
  Study(Problem& problem, const std::vector<Parametrisation>& forms, const std::vector<std::string>& declared,
        const Rules& rules, Told told = {});

  Problem& problem;
  const Rules rules;
  std::vector<const Parametrisation*> base, candidates;
  Selection selection;

 private:
  const Told told_;
  /// What was chosen in proportion to the place in the session, though the same on every shot is likelier: nothing that
  /// acts so is a candidate then.
  const Parametrisation* even_ = nullptr;
  void select(bool deep);
  bool jumps_ = false;  // what was chosen so jumps: nothing that drifts is a candidate then
  double likeliest(const Model& model) const;
  double likeliest_placed(const std::function<double(double)>& place) const;
  const Parametrisation* likelier_at_every_shot();
  const Parametrisation* drift() const;  // of the chosen; null: none
  bool jumps_rather() const;
  void beside_drift();
  void settle();
  void refute_noise();
};

}  // namespace hosel::loop
