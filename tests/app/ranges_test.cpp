// Every range that the reader declares: a value beyond either end, no number, or infinity is refused by name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/job.hpp"
#include "app/keys.hpp"

namespace hosel::app {
namespace {

/// "layers[2].law" and "layers[1].law" are one declaration.
std::string without_numbers(std::string key) {
  for (std::size_t at; (at = key.find('[')) != std::string::npos;) key.erase(at, key.find(']') - at + 1);
  return key;
}

struct Refused {
  std::string value;  ///< in the key's unit, as TOML
  const char* says;
};

/// Values just beyond the ends, and what no range holds.
std::vector<Refused> beyond(const Declared& d) {
  std::vector<Refused> out;
  const auto add = [&](std::string text, const char* says = "out of range") {
    if (!d.whole && text.find_first_of(".en") == std::string::npos) text += ".0";
    std::string list;
    for (std::size_t i = 0; i < d.size; ++i) list += (i ? ", " : "") + text;
    out.push_back({d.size ? "[" + list + "]" : text, says});
  };
  const auto past = [&](double end, double direction) {
    const double x = end / d.si;
    add(d.whole ? fmt::format("{}", static_cast<long long>(x + direction))
                : fmt::format("{:.12g}", x + direction * (1e-6 + 1e-3 * std::abs(x))));
  };
  const double highest = std::numeric_limits<double>::max();
  if (d.range.min > -highest && std::abs(d.range.min) < 1e15) past(d.range.min, -1);
  if (d.range.max < highest && d.range.max < 1e15) past(d.range.max, 1);
  if (d.whole) return out;
  if (d.range.open_min) add(fmt::format("{:.12g}", d.range.min / d.si));
  if (d.range.max <= highest && !d.range.also_infinite) add("inf");
  if (d.range.min >= -highest) add("-inf");
  add("nan", "nan is not a value");
  return out;
}

TEST(Ranges, EveryDeclaredOneFires) {
  std::set<std::string> seen;
  int fired = 0;
  for (CaseFile& file : cases_with_every_key()) {
    const std::string kind = file.root().text("kind", "impact");
    for (const Declared& d : std::vector<Declared>(file.declared())) {
      const bool number = d.type.ends_with("number") || d.size > 0;
      const std::string name = fmt::format("{} {} {} {}", kind, without_numbers(d.key), d.range.min, d.range.max);
      if (!number || !seen.insert(name).second) continue;
      for (const auto& [value, says] : beyond(d)) {
        std::vector<std::string> set = file.overrides();
        set.push_back(d.key + "=" + value);
        try {
          CaseFile again(file, set);
          read_job(again);
          ADD_FAILURE() << file.file() << ": " << d.key << " = " << value << " is taken";
        } catch (const InputError& e) {
          const std::string said = e.what();
          EXPECT_NE(said.find(says), std::string::npos) << d.key << " = " << value << ": " << said;
          EXPECT_NE(said.find("--set " + d.key), std::string::npos) << said;
          ++fired;
        } catch (const std::exception& e) {
          ADD_FAILURE() << file.file() << ": " << d.key << " = " << value << ": " << e.what();
        }
      }
    }
  }
  EXPECT_GT(fired, 1000);
}

}  // namespace
}  // namespace hosel::app
