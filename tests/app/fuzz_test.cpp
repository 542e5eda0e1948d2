// A short mutation run over every reader, from files that are good. Every input ends in a value or a sentence.
#include <gtest/gtest.h>

#include <random>

#include "command.hpp"
#include "tests/fuzz/readers.hpp"

namespace hosel {
namespace {

namespace fs = std::filesystem;

/// A few random changes: bits, bytes, words of the trade, pieces left out, doubled or moved.
std::string mutated(std::string text, std::mt19937_64& random) {
  static const std::array<std::string, 16> words = {
      "nan", "inf", "-", "1e308", "1e-320", "\"", "\n", "[[",
      "]",   "=",   ",", "0x1p3", "\xff",   "{",  "'",  "99999999999999999999"};
  for (std::size_t n = 1 + random() % 4; n-- > 0 && !text.empty();) {
    const std::size_t at = random() % text.size(), length = random() % std::min<std::size_t>(40, text.size() - at + 1);
    switch (random() % 6) {
      case 0: text[at] = char(text[at] ^ (1 << random() % 8)); break;
      case 1: text[at] = char(random()); break;
      case 2: text.insert(at, words[random() % words.size()]); break;
      case 3: text.replace(at, length, words[random() % words.size()]); break;
      case 4: text.erase(at, length); break;
      default: text.insert(random() % text.size(), text.substr(at, length)); break;
    }
  }
  return text;
}

std::vector<std::string> seeds(const fuzz::Reader& r) {
  const std::string reader = r.name;
  if (reader == "case")
    return {test::kEccentricBlow, test::content(fs::path(HOSEL_SOURCE_DIR) / "cases/driver-toe/case.toml")};
  if (reader == "table")
    return {"shot,club,club_speed_mps,dynamic_loft_deg,ball_speed_mps\n1,\"a, b\",45,10.5,66\n2,c,44.1,,65.2\n"};
  if (reader == "export") {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(fs::path(HOSEL_SOURCE_DIR) / "tests/app/monitors"))
      if (entry.is_regular_file()) all.push_back(test::content(entry.path()));
    std::ranges::sort(all);
    return all;
  }
  if (reader == "series") return {"time_ms,lead_mm,strain_droop_ustrain\n0,1.5,20\n0.1,1.4,\n0.2,1.3,-3e1\n"};
  return {r.good()};
}

class Readers : public testing::TestWithParam<fuzz::Reader> {};

TEST_P(Readers, AnswerInAValueOrASentence) {
  const fuzz::Reader& reader = GetParam();
  std::mt19937_64 random(20);
  for (const std::string& seed : seeds(reader)) {
    reader.read(seed);
    for (int k = 0; k < 400; ++k) {
      const std::string input = mutated(seed, random);
      try {
        reader.read(input);
      } catch (const std::exception& e) {
        ADD_FAILURE() << reader.name << ", input " << k << ": " << e.what() << '\n' << input;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers, testing::ValuesIn(fuzz::kReaders),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace hosel
