#include "app/solution_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hosel::app {

std::string SolutionDoubt::sentence() const {
  return fmt::format("{} is {:.2g} (wanted: below {:g}): {}", what, value, limit, remedy);
}

std::vector<SolutionDoubt> solution_doubts(const Blow& blow, const models::FeOutcome& outcome) {
  const models::FeImpactResult& r = outcome.result;
  std::vector<SolutionDoubt> out;
  for (const SolutionDoubt& d :
       {SolutionDoubt{"the energy unaccounted for, of that of the relative motion,",
                      r.ledger.closure / relative_energy(blow, outcome), 0.005, "more steps_per_contact"},
        {"the penetration, of the compression,", r.penetration / r.compression, 0.02, "a higher contact.penalty"},
        {"the elastic slip, of the compression,", r.creep / r.compression, 0.02,
         "a higher contact.tangential_penalty"}})
    if (std::abs(d.value) > d.limit) out.push_back(d);
  return out;
}

double relative_energy(const Blow& blow, const models::FeOutcome& outcome) {
  const double head = blow.club.head.mass, ball = blow.ball.mass;
  return 0.5 * (std::isfinite(head) ? head * ball / (head + ball) : ball) * outcome.frame.approach.squaredNorm();
}

void note_doubt(std::vector<WorstDoubt>& worst, const std::string& kind, std::size_t blow, double size,
                const std::string& sentence) {
  auto at = std::ranges::find(worst, kind, &WorstDoubt::kind);
  if (at == worst.end()) at = worst.insert(at, {.kind = kind});
  if (at->count++ > 0 && std::abs(size) <= at->size) return;
  at->blow = blow;
  at->size = std::abs(size);
  at->sentence = sentence;
}

}  // namespace hosel::app
