#include "files.hpp"

#include <fmt/format.h>

#include <sys/wait.h>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace examination {
namespace fs = std::filesystem;
namespace {

/// A TOML float, never an integer.
std::string number(double v) {
  if (std::isinf(v)) return v > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{:.7g}", v);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string cell(double value, double resolution) {
  if (std::isnan(value)) return "";
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(resolution) - 1e-9)));
  // A slipped unit may need more digits than its column has.
  const double shown = std::stod(fmt::format("{:.{}f}", value, decimals));
  return std::abs(shown - value) > 1e-3 * resolution + 1e-12 ? fmt::format("{:.3f}", value)
                                                             : fmt::format("{:.{}f}", value, decimals);
}

void put(const fs::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

void write_set(const Set& set, const fs::path& dir) {
  fs::create_directories(dir / "keys");
  put(dir / "keys" / (set.name + ".json"), set.key.dump(1) + "\n");
  const fs::path folder = dir / set.name;
  fs::create_directories(folder);
  const Session& s = set.session;

  std::string toml =
      fmt::format("kind  = \"loop\"\ntitle = \"measured set {}\"\n\n[model]\nbase = \"{}\"\n\n", set.name, s.base);
  toml += fmt::format("[ball]\nmass_kg = {}\nradius_mm = {}\ninertia_factor = {}\n\n[head]\n", number(s.ball.mass_kg),
                      number(s.ball.radius_m * 1e3), number(s.ball.inertia_factor));
  if (!s.mass_column) toml += fmt::format("mass_kg = {}\n", number(s.head.mass_kg));
  const Vector3d cg = s.head.cg_m * 1e3;
  toml += fmt::format("cg_mm = [{}, {}, {}]\n", number(cg[0]), number(cg[1]), number(cg[2]));
  const Matrix3d& i = s.head.inertia_kg_m2;
  toml += fmt::format("inertia_kg_m2 = [[{}, {}, {}], [{}, {}, {}], [{}, {}, {}]]\n", number(i(0, 0)), number(i(0, 1)),
                      number(i(0, 2)), number(i(1, 0)), number(i(1, 1)), number(i(1, 2)), number(i(2, 0)),
                      number(i(2, 1)), number(i(2, 2)));
  toml += fmt::format("bulge_mm = {}\nroll_mm = {}\n\n", number(s.head.bulge_m * 1e3), number(s.head.roll_m * 1e3));
  toml += "[data]\nshots = \"shots.csv\"\n";
  std::string noise, input;
  for (const Channel& c : s.channels)
    if (c.declared) noise += fmt::format("{} = {}\n", c.header, number(c.noise_sd));
  for (const Column& c : s.inputs)
    if (c.noise_sd > 0) input += fmt::format("{} = {}\n", c.header, number(c.noise_sd));
  if (!noise.empty()) toml += "[data.noise]\n" + noise;
  if (!input.empty()) toml += "[data.input_noise]\n" + input;
  if (s.mass_column) toml += fmt::format("[data.join]\nfile = \"club_means.csv\"\nby = \"{}\"\n", s.cluster_column);
  if (s.split_by_cluster)
    toml += fmt::format("\n[split]\nholdout_fraction = 0.3333\nseed = {}\nby = \"{}\"\n", 1 + set.index % 7,
                        s.cluster_column);
  put(folder / "case.toml", toml);

  std::string csv = "shot";
  if (!s.cluster.empty()) csv += "," + s.cluster_column;
  for (const Extra& e : s.extras) csv += "," + e.header;
  for (const Column& c : s.inputs) csv += "," + c.header;
  for (const Channel& c : s.channels) csv += "," + c.header;
  csv += "\n";
  for (int k = 0; k < s.shots(); ++k) {
    csv += std::to_string(k + 1);
    if (!s.cluster.empty())
      csv += "," + s.cluster_names[static_cast<std::size_t>(s.cluster[static_cast<std::size_t>(k)])];
    for (const Extra& e : s.extras) csv += "," + e.cells[static_cast<std::size_t>(k)];
    for (std::size_t c = 0; c < s.inputs.size(); ++c)
      csv += "," + cell(s.recorded_inputs(k, static_cast<int>(c)), s.inputs[c].resolution);
    for (std::size_t c = 0; c < s.channels.size(); ++c)
      csv += "," + cell(s.recorded_outputs(k, static_cast<int>(c)), s.channels[c].resolution);
    csv += "\n";
  }
  put(folder / "shots.csv", csv);
  if (s.mass_column) {
    std::string means = s.cluster_column + ",head_mass_kg\n";
    for (std::size_t c = 0; c < s.cluster_names.size(); ++c)
      for (int k = 0; k < s.shots(); ++k)
        if (s.cluster[static_cast<std::size_t>(k)] == static_cast<int>(c)) {
          means += fmt::format("{},{}\n", s.cluster_names[c], number(s.head_mass_kg[static_cast<std::size_t>(k)]));
          break;
        }
    put(folder / "club_means.csv", means);
  }
}

void run_sets(const fs::path& dir, const std::string& hosel, int jobs, int limit_s) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir / "keys")) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  fs::create_directories(dir / "out");
  Json runs = Json::object();
  std::mutex lock;
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t k; (k = next++) < names.size();) {
      const fs::path out = dir / "out" / names[k];
      fs::remove_all(out);
      const std::string command = fmt::format("timeout {} '{}' run '{}' --out '{}' > '{}.log' 2>&1", limit_s, hosel,
                                              (dir / names[k]).string(), out.string(), out.string());
      const auto begin = std::chrono::steady_clock::now();
      const int code = std::system(command.c_str());
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const std::lock_guard guard(lock);
      runs[names[k]] = {{"status", WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code)}, {"seconds", seconds}};
    }
  };
  std::vector<std::jthread> workers;
  for (int j = 0; j < jobs; ++j) workers.emplace_back(work);
  workers.clear();
  put(dir / "runs.json", runs.dump(1) + "\n");
}

}  // namespace examination
