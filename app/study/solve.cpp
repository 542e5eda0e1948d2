#include "app/study/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <map>
#include <string_view>

#include "app/study/compare.hpp"
#include "app/study/design.hpp"
#include "solvers/errors.hpp"

namespace hosel::app {
namespace {

/// What a point has beside its outputs (StudyJob, compute_missing): no name of what was found.
constexpr std::array<std::string_view, 7> kMembers = {"doubts", "error",  "heavier", "history",
                                                      "hosel",  "launch", "skipped"};

void check_solve_name(const Table& t, const std::string& name) {
  const auto taken = [&](const auto& names) { return std::ranges::find(names, name) != names.end(); };
  if (taken(kMembers) || taken(kOwnColumns))
    t.fail("name", fmt::format("'{}' is something else of every point: give what is found another name", name));
}

}  // namespace

std::vector<StudySolve> read_solves(Table root, const std::vector<std::string>& variants, bool flies) {
  std::vector<StudySolve> out;
  std::vector<std::string> taken;
  for (Table t : root.tables("solve")) {
    StudySolve s{.name = t.name({"name", "of the column that holds what was found"}, taken),
                 .key = t.text({"key", "of the case, with its unit: found so that the output has the value"}),
                 .low = 0,
                 .high = 0,
                 .output = {},
                 .value = 0,
                 .set = {},
                 .variants = {}};
    check_solve_name(t, s.name);
    const auto range = t.numbers({"range", "of the key: the output at its ends must enclose the value"}, 2);
    if (!(range[0] < range[1])) t.fail("range", "give the lowest and the highest");
    s.low = range[0], s.high = range[1];
    s.output = find_study_output(t, "output", t.text({"output", "a quantity of blow, launch or flight"}), flies);
    s.value = t.number({"value", "wanted of the output, in its unit"});
    s.set = t.texts({"set", "keys that hold while the key is sought, table.key=value"}, std::vector<std::string>{});
    s.variants = t.texts({"variants", "of the design for which it is sought; empty: all"}, std::vector<std::string>{});
    for (const std::string& v : s.variants) number_of(t, "variants", "variant", v, variants);
    out.push_back(std::move(s));
  }
  return out;
}

double solve(const StudySolve& wanted, const std::function<std::optional<double>(double)>& answer) {
  std::map<double, double> known;
  const auto excess = [&](double x) {
    const auto y = answer(x);
    if (!y)
      throw solvers::NonConvergence(
          fmt::format("{}: no {} at {} = {:g}", wanted.name, wanted.output.name, wanted.key, x));
    return known[x] = *y - wanted.value;
  };
  const double low = excess(wanted.low), high = excess(wanted.high);
  if (low * high > 0)
    throw solvers::NonConvergence(fmt::format(
        "{}: {} is {:.5g} and {:.5g} at the ends of the range of {}: they do not enclose {:g}; a narrower range may",
        wanted.name, wanted.output.name, low + wanted.value, high + wanted.value, wanted.key, wanted.value));
  std::uintmax_t most = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(excess, wanted.low, wanted.high, low, high,
                                                        boost::math::tools::eps_tolerance<double>(30), most);
  // A bounce more or less makes a total distance jump a little: the key is found as well as it can be. A jump by more
  // passes over the value.
  constexpr double most_of_scale = 1e-3;
  const double scale = std::max(std::abs(wanted.value), std::abs(high - low)), at_a = known.at(a), at_b = known.at(b);
  if (std::min(std::abs(at_a), std::abs(at_b)) > most_of_scale * scale)
    throw solvers::NonConvergence(fmt::format("{}: no {} makes {} {:g}: at {:g} it jumps from {:.5g} to {:.5g}",
                                              wanted.name, wanted.key, wanted.output.name, wanted.value, (a + b) / 2,
                                              at_a + wanted.value, at_b + wanted.value));
  return (a + b) / 2;
}

}  // namespace hosel::app
