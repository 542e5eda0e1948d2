// Every range that the reader declares, over every shipped case: a value beyond either end is refused by name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "build_info.hpp"
#include "hosel/app/job.hpp"

namespace hosel::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> shipped() {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(fs::path(HOSEL_SOURCE_DIR) / "cases"))
    if (fs::exists(entry.path() / "case.toml")) out.push_back(entry.path());
  std::ranges::sort(out);
  return out;
}

/// "layers[2].law" and "layers[1].law" are one declaration.
std::string without_numbers(std::string key) {
  for (std::size_t at; (at = key.find('[')) != std::string::npos;) key.erase(at, key.find(']') - at + 1);
  return key;
}

/// Values just beyond the ends, in the key's unit, as TOML.
std::vector<std::string> beyond(const Declared& d) {
  std::vector<std::string> out;
  const auto add = [&](double si, double direction) {
    const double x = si / d.si;
    std::string text = d.whole ? fmt::format("{}", static_cast<long long>(x + direction))
                               : fmt::format("{:.12g}", x + direction * (1e-6 + 1e-3 * std::abs(x)));
    if (!d.whole && text.find_first_of(".e") == std::string::npos) text += ".0";
    if (d.size == 0) return out.push_back(text);
    std::string list = "[";
    for (std::size_t i = 0; i < d.size; ++i) list += (i ? ", " : "") + text;
    out.push_back(list + "]");
  };
  const double highest = std::numeric_limits<double>::max();
  if (d.range.min > -highest && std::abs(d.range.min) < 1e15) add(d.range.min, -1);
  if (d.range.max < highest && d.range.max < 1e15) add(d.range.max, 1);
  return out;
}

TEST(Ranges, EveryDeclaredOneFires) {
  std::set<std::string> seen;
  int fired = 0;
  for (const fs::path& where : shipped()) {
    CaseFile file(where);
    read_job(file);
    const std::string kind = file.root().text("kind", "impact");
    for (const Declared& d : std::vector<Declared>(file.declared())) {
      const std::string name = fmt::format("{} {} {} {}", kind, without_numbers(d.key), d.range.min, d.range.max);
      if (!seen.insert(name).second) continue;
      for (const std::string& value : beyond(d)) {
        try {
          CaseFile again(where, {d.key + "=" + value});
          read_job(again);
          ADD_FAILURE() << where.filename() << ": " << d.key << " = " << value << " is taken";
        } catch (const InputError& e) {
          const std::string said = e.what();
          EXPECT_NE(said.find("out of range"), std::string::npos) << d.key << " = " << value << ": " << said;
          EXPECT_NE(said.find("--set " + d.key), std::string::npos) << said;
          ++fired;
        } catch (const std::exception& e) {
          ADD_FAILURE() << where.filename() << ": " << d.key << " = " << value << ": " << e.what();
        }
      }
    }
  }
  EXPECT_GT(fired, 300);
}

}  // namespace
}  // namespace hosel::app
