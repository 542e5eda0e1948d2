/// The hosel command as a child process, for tests of what a person types.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace hosel::test {

struct Outcome {
  int status;
  std::string text;  ///< both streams
};

inline Outcome command(const std::string& arguments) {
  FILE* pipe = popen((std::string(HOSEL_COMMAND) + " " + arguments + " 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer;
  while (fgets(buffer.data(), int(buffer.size()), pipe)) text += buffer.data();
  return {WEXITSTATUS(pclose(pipe)), text};
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
