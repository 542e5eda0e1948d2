#include "app/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/of_file.hpp"
#include "app/reader.hpp"
#include "app/version.hpp"
#include "post/file.hpp"

namespace hosel::app {
namespace fs = std::filesystem;
namespace {

std::string digest_of(const fs::path& file) {
  return fs::is_regular_file(file) ? post::digest(post::read_file(file)) : "none";
}

[[noreturn]] void refuse_changed(const fs::path& file) {
  throw InputError(fmt::format("{}: has changed since this run began: its results would not belong together; run again",
                               file.string()));
}

}  // namespace

std::string not_there(const fs::path& file) {
  return fmt::format("{} is not there; HOSEL_DATA names the folder of measured files", file.string());
}

void Inputs::file(const fs::path& file, const std::string& name, const fs::path& copy) {
  static OfFile<std::string> digests;
  const std::string digest = digests.get(file, [&] { return digest_of(file); });
  const std::lock_guard lock(mutex_);
  const auto [it, fresh] = digests_.emplace(file, digest);
  if (!fresh && it->second != digest) refuse_changed(file);
  read_.insert(name + '\n' + digest + '\n');
  if (!copy.empty() && digest != "none") copies_[copy] = file;
}

void Inputs::case_file(const fs::path& file, const fs::path& copy) {
  const std::lock_guard lock(mutex_);
  if (!copy.empty()) copies_[copy] = file;
  if (std::ranges::find(cases_, file) == cases_.end()) cases_.push_back(file);
}

void Inputs::resolved(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (fingerprint_.empty()) all_ = post::digest(all_ + post::digest(text));
}

void Inputs::tell(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (!std::ranges::count(told_, text)) told_.emplace_back(text);
}

std::vector<std::string> Inputs::told() const {
  const std::lock_guard lock(mutex_);
  return told_;
}

void Inputs::doubt(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (!std::ranges::count(doubts_, text)) doubts_.emplace_back(text);
}

std::vector<std::string> Inputs::doubts() const {
  const std::lock_guard lock(mutex_);
  return doubts_;
}

std::string Inputs::fingerprint() const {
  const std::lock_guard lock(mutex_);
  if (fingerprint_.empty()) {
    std::string text = program_version() + '\n' + all_ + '\n';
    // By the name that the case has and by content: the same case elsewhere is the same run, and so is one that reads
    // copies.
    for (const std::string& one : read_) text += one;
    fingerprint_ = post::digest(text);
  }
  return fingerprint_;
}

void Inputs::verify() const {
  const std::lock_guard lock(mutex_);
  for (const auto& [file, digest] : digests_)
    if (digest_of(file) != digest) refuse_changed(file);
}

std::map<fs::path, fs::path> Inputs::copies() const {
  const std::lock_guard lock(mutex_);
  return copies_;
}

std::vector<fs::path> Inputs::files() const {
  const std::lock_guard lock(mutex_);
  std::vector<fs::path> all = cases_;
  for (const auto& [file, digest] : digests_)
    if (digest != "none") all.push_back(file);
  return all;
}

std::vector<fs::path> Inputs::missing() const {
  const std::lock_guard lock(mutex_);
  std::vector<fs::path> out;
  for (const auto& [file, digest] : digests_)
    if (digest == "none") out.push_back(file);
  return out;
}

}  // namespace hosel::app
