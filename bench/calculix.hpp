/// CalculiX (`ccx`, package calculix-ccx) as a peer, on one core.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace hosel::bench {

/// A computation in a folder of its own, gone with this object; the environment's HOSEL_KEEP keeps it.
class Calculix {
 public:
  explicit Calculix(std::string name) : name_(std::move(name)) { std::filesystem::create_directories(folder_); }
  ~Calculix() {
    if (!std::getenv("HOSEL_KEEP")) std::filesystem::remove_all(folder_);
  }
  Calculix(const Calculix&) = delete;
  Calculix& operator=(const Calculix&) = delete;

  static bool installed() { return std::system("command -v ccx > /dev/null") == 0; }
  std::filesystem::path deck() const { return folder_ / (name_ + ".inp"); }
  std::filesystem::path results() const { return folder_ / (name_ + ".dat"); }
  /// Whether it came to its end.
  bool run() const {
    return std::system(
               fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx {} > log.txt 2>&1", folder_.string(), name_).c_str()) == 0;
  }

 private:
  std::string name_;
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / fmt::format("hosel_calculix_{}", getpid());
};

/// An element in a deck: its number and its nodes, nine of them in the first line.
inline std::string element_line(int number, const std::vector<int>& nodes) {
  std::string out = fmt::format("{}", number);
  for (std::size_t i = 0; i < nodes.size(); ++i) out += fmt::format("{}{}", i == 9 ? ",\n" : ", ", nodes[i]);
  return out + "\n";
}

}  // namespace hosel::bench
