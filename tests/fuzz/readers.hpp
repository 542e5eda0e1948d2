/// The readers of files that strangers, scripts and dying disks write, each as a function of bytes: it returns, or it
/// throws what the command turns into a sentence. Anything else is a finding.
#pragma once

#include <unistd.h>

#include <array>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>
#include "hosel/app/import/sheet.hpp"
#include "hosel/app/job.hpp"
#include "hosel/app/read_series.hpp"
#include "hosel/app/sweep_store.hpp"
#include "hosel/loop/shots/shots.hpp"
#include "hosel/post/checkpoint.hpp"
#include "hosel/post/csv.hpp"
#include "hosel/post/file.hpp"

namespace hosel::fuzz {

namespace fs = std::filesystem;

/// A file of these bytes, this process's own.
inline fs::path file_of(std::string_view bytes, const char* name) {
  const fs::path place = fs::temp_directory_path() / ("hosel_fuzz_" + std::to_string(::getpid()));
  fs::create_directories(place / "points");
  post::write_file(place / name, bytes, false);
  return place / name;
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

inline void read_points(std::string_view bytes) {
  try {
    app::read_points(file_of(bytes, "points/points.jsonl").parent_path().parent_path(), "case");
  } catch (const app::InputError&) {}
}

inline void read_checkpoint(std::string_view bytes) { post::load_checkpoint(file_of(bytes, "checkpoint.cbor"), "run"); }

struct Reader {
  const char* name;
  void (*read)(std::string_view bytes);
};
inline constexpr std::array kReaders = {Reader{"case", read_case},     Reader{"table", read_table},
                                        Reader{"export", read_export}, Reader{"series", read_series},
                                        Reader{"points", read_points}, Reader{"checkpoint", read_checkpoint}};

}  // namespace hosel::fuzz
