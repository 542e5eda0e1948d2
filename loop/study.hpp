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
  void select(bool deep);
  void settle();
  void refute_noise();
};

}  // namespace hosel::loop
