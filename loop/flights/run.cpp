#include "loop/flights/run.hpp"

#include "loop/flights/problem.hpp"
#include "loop/verdict.hpp"

namespace hosel::loop {

LoopResult run(const FlightCase& c) {
  FlightProblem problem(c);
  LoopResult result(c, c.shots.rows());
  result.unused = problem.unused();
  result.forms = problem.forms();
  result.notes = c.notes;
  const Study study(problem, result.forms, c.effects, c.rules, c.told);
  conclude(study, result);
  return result;
}

}  // namespace hosel::loop
