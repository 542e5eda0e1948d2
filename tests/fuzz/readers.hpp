/// The readers of files that strangers, scripts and dying disks write, each as a function of bytes: it returns, or it
/// throws what the command turns into a sentence. Anything else is a finding.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>
#include "app/import/sheet.hpp"
#include "app/job.hpp"
#include "app/read_series.hpp"
#include "app/sweep_store.hpp"
#include "loop/shots/shots.hpp"
#include "post/checkpoint.hpp"
#include "post/csv.hpp"
#include "post/file.hpp"
#include "post/parse_json.hpp"

namespace hosel::fuzz {

namespace fs = std::filesystem;

/// A file of these bytes, this process's own: the same for every input of a name, overwritten.
inline fs::path file_of(std::string_view bytes, const char* name) {
  static const fs::path place = [] {
    const fs::path own = fs::temp_directory_path() / ("hosel_fuzz_" + std::to_string(::getpid()));
    fs::create_directories(own / "points");
    return own;
  }();
  fs::path file = place / name;
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool whole = descriptor >= 0 && ::write(descriptor, bytes.data(), bytes.size()) == ssize_t(bytes.size());
  if (!whole || ::close(descriptor) != 0) std::abort();  // else an older input would be read
  return file;
}

inline void read_case(std::string_view bytes) {
  try {
    app::CaseFile file(file_of(bytes, "case.toml"));
    app::read_job(file);
  } catch (const app::InputError&) {
  } catch (const std::invalid_argument&) {}
}

inline void read_table(std::string_view bytes) {
  try {
    loop::read_shots(post::read_csv(file_of(bytes, "table.csv")));
  } catch (const DataError&) {}
}

inline void read_export(std::string_view bytes) {
  static const app::Dictionary dictionary = [] {
    app::Dictionary d;
    d.read(app::shipped_dictionary());
    return d;
  }();
  try {
    app::read_sheet(file_of(bytes, "export.csv"), dictionary);
  } catch (const app::InputError&) {}
}

inline void read_series(std::string_view bytes) {
  std::vector<std::string> notes;
  try {
    app::read_series(file_of(bytes, "series.csv"), nullptr, 1.0, 0.0, 1000, notes);
  } catch (const app::InputError&) {}
}

/// As damage leaves them, and with the digests that somebody who knows how would give them: those are no obstacle.
inline void read_points(std::string_view bytes) {
  std::string sealed;
  std::istringstream lines{std::string(bytes)};
  for (std::string line; std::getline(lines, line);) {
    try {
      nlohmann::json entry = post::parse_json(line);
      entry.erase("check");
      line = app::sealed(std::move(entry)).dump();
    } catch (const std::exception&) {}
    sealed += line + '\n';
  }
  for (const std::string_view text : {bytes, std::string_view(sealed)}) {
    try {
      app::read_points(file_of(text, "points/points.jsonl").parent_path().parent_path(), "case", 9);
    } catch (const app::InputError&) {}
  }
}

inline std::string good_points() {
  std::string text = app::sealed({{"fingerprint", "case"}, {"version", "1"}}).dump() + '\n';
  for (int i : {0, 3})
    text += app::sealed({{"point", i}, {"seconds", 0.1}, {"result", {{"spin_rpm", 2500.5}, {"ball", "a"}}}}).dump() +
            '\n';
  return text;
}

inline std::string good_checkpoint() {
  post::SavedImpact saved;
  fem::State& state = saved.impact.solver.state;
  state.q = state.v = state.a = saved.impact.solver.auxiliary = fem::Vector::LinSpaced(3, -1, 0.1);
  saved.impact.solver.history = {0, 1, 2};
  saved.impact.solver.ledger.strain = {{"ball", 1.5}};
  saved.section = post::BallSection{
      .points = {{0, 0}, {1, 0}, {1, 1}}, .von_mises = {1, 2, 3}, .cells = {{0, 1, 2, 0}}, .seams = {{0, 1, 2}}};
  saved.moving.bodies = {{"face", 1, {}, {0, 0, 0}, {}}};
  saved.moving.frames = {{1e-5, 1.0, Vec3(1, 2, 3), {{{0, 0, 0}, {}, {}}}}};
  saved.series["ball"] = {{0.0, 1e-5}, "digest"};
  const fs::path file = file_of("", "good.cbor");
  post::save_checkpoint(file, "run", saved);
  return post::read_file(file);
}

inline void read_checkpoint(std::string_view bytes) {
  static const std::string format = [] {
    const std::string good = good_checkpoint();
    return good.substr(0, good.rfind(' ', good.find('\n')) + 1);
  }();
  const std::string_view body = bytes.substr(bytes.find('\n') + 1);  // without a line: all
  for (const std::string& text : {std::string(bytes), format + post::digest(body) + '\n' + std::string(body)})
    post::load_checkpoint(file_of(text, "checkpoint.cbor"), "run");
}

struct Reader {
  const char* name;
  void (*read)(std::string_view bytes);
  std::string (*good)() = nullptr;  ///< a file of the kind, where the project carries none
};
inline std::ostream& operator<<(std::ostream& out, const Reader& r) { return out << r.name; }

inline constexpr std::array kReaders = {Reader{"case", read_case},
                                        Reader{"table", read_table},
                                        Reader{"export", read_export},
                                        Reader{"series", read_series},
                                        Reader{"points", read_points, good_points},
                                        Reader{"checkpoint", read_checkpoint, good_checkpoint}};

}  // namespace hosel::fuzz
