/// The hosel command as a child process, for tests of what a person types.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include "build_info.hpp"

namespace hosel::test {

/// A closed-form blow that runs as it is.
inline const std::string kEccentricBlow = R"(kind = "impact"
models = ["rigid-eccentric"]
[delivery]
club_speed_mps = 45.0
dynamic_loft_deg = 10.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 0.0]
inertia_kg_m2 = [[3.7e-4, 0, 0], [0, 2.9e-4, 0], [0, 0, 4.8e-4]]
)";

/// That blow as a study, which a design and what stands in other tables may follow.
inline std::string study_of_blow(const std::string& outputs = "[\"ball_speed_mps\"]") {
  std::string text = kEccentricBlow;
  return text.replace(text.find("\"impact\""), 8, "\"study\"\noutputs = " + outputs);
}

struct Outcome {
  int status;
  std::string text;  ///< both streams
};

/// The command of this build; HOSEL_OTHER names another one, to see what it makes of the same tests.
inline std::string hosel_command() {
  const char* other = std::getenv("HOSEL_OTHER");
  return other ? other : HOSEL_COMMAND;
}

inline Outcome shell(const std::string& line) {
  FILE* pipe = popen(("{ " + line + "; } 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer;
  while (fgets(buffer.data(), int(buffer.size()), pipe)) text += buffer.data();
  return {WEXITSTATUS(pclose(pipe)), text};
}

inline Outcome command(const std::string& arguments) { return shell(hosel_command() + " " + arguments); }

/// Status 2, and this part of the sentence.
inline void expect_refused(const Outcome& o, const std::string& says) {
  EXPECT_EQ(o.status, 2) << o.text;
  EXPECT_NE(o.text.find(says), std::string::npos) << o.text;
}

/// An empty directory of this process, gone when it ends.
inline std::filesystem::path fresh_directory(const std::string& name) {
  struct Home {
    std::filesystem::path path = std::filesystem::path(testing::TempDir()) / ("hosel_test_" + std::to_string(getpid()));
    ~Home() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Home home;
  const auto dir = home.path / name;
  std::filesystem::remove_all(dir);
  std::filesystem::create_directories(dir);
  return dir;
}

inline void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace hosel::test
